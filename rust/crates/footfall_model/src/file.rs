//! The container that every model file shares, and the `.footfall`, `.footstyle`, `.footdyn`, `.footimu` and `.footcal` files.
//!
//! | bytes | content |
//! | --- | --- |
//! | 8 | magic `FOOTFALL` |
//! | 4 | format version, unsigned, little endian |
//! | 4 | length of the header in bytes |
//! | … | header: JSON with `kind`, `written_by` and `provenance`; readable in every version |
//! | 8 | length of the payload in bytes |
//! | … | payload: postcard encoding of the version's own types (`v1` to `v6`) |
//! | 4 | CRC-32 of all that precedes |

mod calibration;
mod calibration_v1;
mod container;
mod dynamics_v1;
mod imu_v1;
mod style_v1;
mod style_v2;
mod v1;
mod v2;
mod v3;
mod v4;
mod v5;
mod v6;

pub use container::read_header;

use crate::check::ModelError;
use crate::dynamics::DynamicsModel;
use crate::gait_model::GaitModel;
use crate::imu_model::ImuModel;
use crate::provenance::Provenance;
use crate::style::GaitStyle;
use container::{read_container, write_container};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// The latest version that this build writes; it reads all versions up to this one. A file has the earliest version that
/// can hold its content.
pub const FORMAT_VERSION: u32 = 6;

/// The version without [`GaitModel::contexts`].
const FORMAT_1: u32 = 1;

/// The version without [`GaitModel::fine`].
const FORMAT_2: u32 = 2;

/// The version without [`GaitModel::standing`].
const FORMAT_3: u32 = 3;

/// The version without [`GaitModel::running`].
const FORMAT_4: u32 = 4;

/// The version without [`GaitModel::jump`] and [`GaitModel::crouch`].
const FORMAT_5: u32 = 5;

const GAIT_KIND: &str = "gait";
const STYLE_KIND: &str = "style";
const DYNAMICS_KIND: &str = "dynamics";
const IMU_KIND: &str = "imu";
const CALIBRATION_KIND: &str = "calibration";

/// The part of a file that every version can read.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Header {
    /// Kind of payload: `gait`, `style`, `dynamics`, `imu` or `calibration`.
    pub kind: String,
    /// The version of Footfall that wrote the file.
    pub written_by: String,
    /// Provenance of the model.
    pub provenance: Provenance,
}

/// Errors of reading a model from bytes.
#[derive(Debug, thiserror::Error)]
pub enum ModelFileError {
    /// The magic bytes are missing.
    #[error("not a Footfall model: it does not begin with FOOTFALL")]
    NotAModel,
    /// The bytes end too early.
    #[error("the model is cut short after {found} bytes; copy or train it again")]
    Truncated {
        /// Number of bytes.
        found: usize,
    },
    /// The file was written by a later version.
    #[error(
        "the model has format {version} of Footfall {written_by}, this build reads up to {FORMAT_VERSION}; update Footfall"
    )]
    Newer {
        /// The file's format version.
        version: u32,
        /// The version of Footfall that wrote it.
        written_by: String,
    },
    /// The bytes were changed after they were written.
    #[error("the model is damaged (its checksum does not match); copy or train it again")]
    Damaged,
    /// The header or payload cannot be decoded.
    #[error("the model's {part} cannot be decoded: {reason}")]
    Undecodable {
        /// `header` or `payload`.
        part: &'static str,
        /// Message of the decoder.
        reason: String,
    },
    /// The file holds another kind of model.
    #[error("the file holds a model of kind '{found}' instead of '{expected}'")]
    WrongKind {
        /// The kind that was asked for.
        expected: &'static str,
        /// The kind that the file holds.
        found: String,
    },
    /// The content makes no sense.
    #[error("the model cannot be used: {0}")]
    Content(#[from] ModelError),
}

impl GaitModel {
    /// The bytes of a `.footfall` file. Numbers are stored as f32.
    ///
    /// # Errors
    /// [`ModelFileError::Content`] when the model would not load again.
    pub fn to_bytes(&self) -> Result<Vec<u8>, ModelFileError> {
        self.check()?;
        let walk = self.encode_walk()?;
        let model = match &self.standing {
            Some(standing) => (FORMAT_4, v4::encode(walk, standing)?),
            None => walk,
        };
        let model = match &self.running {
            Some(running) => (
                FORMAT_5,
                v5::encode(model, running.encode_walk()?, &running.provenance)?,
            ),
            None => model,
        };
        let (jump, crouch) = (self.jump.as_ref(), self.crouch.as_ref());
        let (version, payload) = if jump.is_some() || crouch.is_some() {
            (FORMAT_VERSION, v6::encode(model, jump, crouch)?)
        } else {
            model
        };
        write_container(version, GAIT_KIND, &self.provenance, &payload)
    }

    /// The model in the bytes of a `.footfall` file.
    ///
    /// # Errors
    /// [`ModelFileError`] says what is wrong with the bytes; no input panics.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, ModelFileError> {
        let (version, header, payload) = read_container(bytes)?;
        check_kind(&header, GAIT_KIND)?;
        let model = match version {
            FORMAT_1..=FORMAT_5 => decode_running(version, payload, header.provenance)?,
            _ => v6::decode(payload, header.provenance)?,
        };
        model.check()?;
        Ok(model)
    }

    /// The earliest version that can hold the walk, and its payload.
    fn encode_walk(&self) -> Result<(u32, Vec<u8>), ModelFileError> {
        Ok(if let Some(fine) = &self.fine {
            (FORMAT_3, v3::encode(self, fine)?)
        } else if self.contexts.is_empty() {
            (FORMAT_1, v1::encode(self)?)
        } else {
            (FORMAT_2, v2::encode(self)?)
        })
    }

    /// A number that identifies this model: the CRC-32 of its payload in format version 1. It says nothing of the
    /// provenance, of the steps at the ends of a walk, of the fine motion, of standing, running, jumping nor crouching, and is the same before writing and after reading.
    ///
    /// # Errors
    /// [`ModelError::Value`] when the model cannot be encoded.
    pub fn fingerprint(&self) -> Result<u32, ModelError> {
        fingerprint(v1::encode(self))
    }
}

impl GaitStyle {
    /// The bytes of a `.footstyle` file. Numbers are stored as f32.
    ///
    /// # Errors
    /// [`ModelFileError::Content`] when the style would not load again.
    pub fn to_bytes(&self) -> Result<Vec<u8>, ModelFileError> {
        self.check()?;
        let payload = style_v2::encode(self)?;
        write_container(FORMAT_2, STYLE_KIND, &self.provenance, &payload)
    }

    /// The style in the bytes of a `.footstyle` file.
    ///
    /// # Errors
    /// [`ModelFileError`] says what is wrong with the bytes; no input panics.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, ModelFileError> {
        let (version, header, payload) = read_container(bytes)?;
        check_kind(&header, STYLE_KIND)?;
        let style = if version == FORMAT_1 {
            style_v1::decode(payload, header.provenance)?
        } else {
            style_v2::decode(payload, header.provenance)?
        };
        style.check()?;
        Ok(style)
    }
}

impl DynamicsModel {
    /// The bytes of a `.footdyn` file.
    ///
    /// # Errors
    /// [`ModelFileError::Content`] when the model would not load again.
    pub fn to_bytes(&self) -> Result<Vec<u8>, ModelFileError> {
        self.check()?;
        let payload = dynamics_v1::encode(self)?;
        write_container(FORMAT_1, DYNAMICS_KIND, &self.provenance, &payload)
    }

    /// The model in the bytes of a `.footdyn` file.
    ///
    /// # Errors
    /// [`ModelFileError`] says what is wrong with the bytes; no input panics.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, ModelFileError> {
        let (_, header, payload) = read_container(bytes)?;
        check_kind(&header, DYNAMICS_KIND)?;
        let model = dynamics_v1::decode(payload, header.provenance)?;
        model.check()?;
        Ok(model)
    }

    /// A number that identifies this model: the CRC-32 of its payload in format version 1.
    ///
    /// # Errors
    /// [`ModelError::Value`] when the model cannot be encoded.
    pub fn fingerprint(&self) -> Result<u32, ModelError> {
        fingerprint(dynamics_v1::encode(self))
    }
}

impl ImuModel {
    /// The bytes of a `.footimu` file. Numbers of frames are stored in 16 bits.
    ///
    /// # Errors
    /// [`ModelFileError::Content`] when the model would not load again.
    pub fn to_bytes(&self) -> Result<Vec<u8>, ModelFileError> {
        self.check()?;
        let payload = imu_v1::encode(self)?;
        write_container(FORMAT_1, IMU_KIND, &self.provenance, &payload)
    }

    /// The model in the bytes of a `.footimu` file.
    ///
    /// # Errors
    /// [`ModelFileError`] says what is wrong with the bytes; no input panics.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, ModelFileError> {
        let (_, header, payload) = read_container(bytes)?;
        check_kind(&header, IMU_KIND)?;
        let model = imu_v1::decode(payload, header.provenance)?;
        model.check()?;
        Ok(model)
    }
}

/// Any model that walks, as its file's header says.
#[derive(Clone, Debug, PartialEq)]
pub enum WalkModel {
    /// Of a `.footfall` file.
    Gait(Arc<GaitModel>),
    /// Of a `.footdyn` file.
    Dynamics(Arc<DynamicsModel>),
}

impl WalkModel {
    /// The model in the bytes of a `.footfall` or a `.footdyn` file.
    ///
    /// # Errors
    /// [`ModelFileError`] says what is wrong with the bytes; no input panics.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, ModelFileError> {
        if read_header(bytes).is_ok_and(|(_, header)| header.kind == DYNAMICS_KIND) {
            return Ok(Self::Dynamics(Arc::new(DynamicsModel::from_bytes(bytes)?)));
        }
        Ok(Self::Gait(Arc::new(GaitModel::from_bytes(bytes)?)))
    }

    /// Provenance of the model.
    pub fn provenance(&self) -> &Provenance {
        match self {
            Self::Gait(model) => &model.provenance,
            Self::Dynamics(model) => &model.provenance,
        }
    }
}

/// The model in a payload of a version that knows no jumping and no crouching.
fn decode_running(
    version: u32,
    payload: &[u8],
    provenance: Provenance,
) -> Result<GaitModel, ModelFileError> {
    match version {
        FORMAT_5 => v5::decode(payload, provenance),
        _ => decode_standing(version, payload, provenance),
    }
}

/// The model in a payload of a version that knows no running.
fn decode_standing(
    version: u32,
    payload: &[u8],
    provenance: Provenance,
) -> Result<GaitModel, ModelFileError> {
    match version {
        FORMAT_4 => v4::decode(payload, provenance),
        _ => decode_walk(version, payload, provenance),
    }
}

/// The model in a payload of a version that knows no standing.
fn decode_walk(
    version: u32,
    payload: &[u8],
    provenance: Provenance,
) -> Result<GaitModel, ModelFileError> {
    match version {
        FORMAT_1 => v1::decode(payload, provenance),
        FORMAT_2 => v2::decode(payload, provenance),
        FORMAT_3 => v3::decode(payload, provenance),
        _ => Err(undecodable(
            "payload",
            &format!("a walk of version {version} in one of version {FORMAT_VERSION}"),
        )),
    }
}

fn fingerprint(payload: Result<Vec<u8>, ModelFileError>) -> Result<u32, ModelError> {
    let payload = payload.map_err(|error| ModelError::Value {
        part: error.to_string(),
    })?;
    Ok(crc32fast::hash(&payload))
}

fn check_kind(header: &Header, expected: &'static str) -> Result<(), ModelFileError> {
    if header.kind == expected {
        return Ok(());
    }
    Err(ModelFileError::WrongKind {
        expected,
        found: header.kind.clone(),
    })
}

fn undecodable(part: &'static str, error: &dyn core::fmt::Display) -> ModelFileError {
    ModelFileError::Undecodable {
        part,
        reason: error.to_string(),
    }
}

#[cfg(test)]
pub(crate) mod tests;
