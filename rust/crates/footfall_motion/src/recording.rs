//! A recording as everyone needs it: read, on the canonical body, with its contacts and walks.

use crate::bvh::{self, BvhError, BvhFile};
use crate::contact_file::{ContactFile, ContactFileError};
use crate::contacts::{ContactConfig, Contacts, detect_contacts};
use crate::game_clip;
use crate::gltf::{self, GltfError};
use crate::hip_centres::WalkingEvidence;
use crate::retarget::{RetargetError, RetargetOptions, Retargeted, retarget, retarget_as_recorded};
use crate::skeletal::SkeletalMotion;
use crate::steps::{Walk, segment_walks};
use std::path::{Path, PathBuf};

/// A recording, ready for training and to be looked at.
#[derive(Clone, Debug)]
pub struct Recording {
    /// The motion on the canonical body.
    pub retargeted: Retargeted,
    /// Contacts of its feet: as a person corrected them where there is a [file of corrections](ContactFile::beside), else as
    /// detected.
    pub contacts: Contacts,
    /// Contacts as detected, whatever was corrected.
    pub detected: Contacts,
    /// Its walks, by its contacts.
    pub walks: Vec<Walk>,
    /// Whether the contacts are a person's.
    pub is_corrected: bool,
}

/// Why a recording cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum RecordingError {
    /// The file is no BVH file.
    #[error(transparent)]
    Bvh(#[from] BvhError),
    /// The file is no glTF file with an animation that can be used.
    #[error(transparent)]
    Gltf(#[from] GltfError),
    /// The motion cannot be put on the canonical body.
    #[error("{}: {source}", path.display())]
    Retarget {
        /// The file.
        path: PathBuf,
        /// Fault.
        source: RetargetError,
    },
    /// The corrections beside it do not fit.
    #[error(transparent)]
    Corrections(#[from] ContactFileError),
}

/// Reads a BVH or glTF file and puts its motion on the canonical body. Frames are the file's.
///
/// Clips in glTF files are [those of games](game_clip::retarget): if they walk in place they travel, and loops are found.
///
/// # Errors
/// [`RecordingError`] names the file.
pub fn read_motion(
    path: &Path,
    options: &RetargetOptions,
) -> Result<(BvhFile, Retargeted), RecordingError> {
    let (file, retargeted) = if gltf::is_gltf(path) {
        let file = gltf::read(path)?;
        let retargeted = game_clip::retarget(&file, options);
        (file, retargeted)
    } else {
        let file = bvh::read(path)?;
        let retargeted = retarget(&file, options);
        (file, retargeted)
    };
    let retargeted = retargeted.map_err(|source| RecordingError::Retarget {
        path: path.to_owned(),
        source,
    })?;
    Ok((file, retargeted))
}

/// The same with hip joints as the file has them, and its evidence about them.
pub(crate) fn read_as_recorded(
    path: &Path,
    options: &RetargetOptions,
) -> Result<(Retargeted, WalkingEvidence), RecordingError> {
    let read = if gltf::is_gltf(path) {
        game_clip::retarget_as_recorded(&gltf::read(path)?, options)
    } else {
        retarget_as_recorded(&bvh::read(path)?, options, |_, _| None)
    };
    read.map_err(|source| RecordingError::Retarget {
        path: path.to_owned(),
        source,
    })
}

impl Recording {
    /// Reads a file and what was corrected about it. Loops are [unrolled](game_clip::unroll).
    ///
    /// # Errors
    /// [`RecordingError`] names the file.
    pub fn read(path: &Path, options: &RetargetOptions) -> Result<Self, RecordingError> {
        let (_, retargeted) = read_motion(path, options)?;
        Self::of_file(path, options, retargeted)
    }

    /// Reads a file and what was corrected about it. A loop stays one round, as the file has it.
    ///
    /// # Errors
    /// [`RecordingError`] names the file.
    pub fn read_one_round(path: &Path, options: &RetargetOptions) -> Result<Self, RecordingError> {
        let (_, retargeted) = read_motion(path, options)?;
        Self::labelled(path, options, retargeted)
    }

    /// The motion of a file that was read under these options.
    pub(crate) fn of_file(
        path: &Path,
        options: &RetargetOptions,
        mut retargeted: Retargeted,
    ) -> Result<Self, RecordingError> {
        game_clip::unroll(&mut retargeted);
        Self::labelled(path, options, retargeted)
    }

    /// A motion with what was corrected about its file, else with what the detector finds.
    fn labelled(
        path: &Path,
        options: &RetargetOptions,
        retargeted: Retargeted,
    ) -> Result<Self, RecordingError> {
        let mut recording = Self::detected(retargeted);
        // Frame numbers of the corrections are the file's.
        let labels = ContactFile::beside(path);
        if options.frame_rate_hz.is_none() && labels.is_file() {
            let stances = ContactFile::read(&labels, &recording.retargeted.clip)?.stances();
            recording.correct(stances);
        }
        Ok(recording)
    }

    /// Puts a clip of any engine on the canonical body, [with its travel](game_clip::retarget) and [unrolled](game_clip::unroll).
    ///
    /// # Errors
    /// [`RetargetError`] for a skeleton that is not recognised and numbers beyond all measure.
    pub fn of_clip(motion: &SkeletalMotion) -> Result<Self, RetargetError> {
        let options = RetargetOptions::default();
        let mut retargeted = game_clip::retarget(&motion.to_recording(), &options)?;
        game_clip::unroll(&mut retargeted);
        Ok(Self::detected(retargeted))
    }

    /// A motion with what the detector finds.
    pub fn detected(retargeted: Retargeted) -> Self {
        let config = ContactConfig::from_frame(retargeted.first_frame);
        let contacts = detect_contacts(&retargeted.clip, &config);
        Self {
            walks: segment_walks(&retargeted.clip, &contacts),
            retargeted,
            detected: contacts.clone(),
            contacts,
            is_corrected: false,
        }
    }

    /// Number of steps in all its walks.
    pub fn step_count(&self) -> usize {
        self.walks.iter().map(|walk| walk.steps.len()).sum()
    }

    /// Takes stances of the left and of the right foot for true, instead of whatever was corrected before.
    pub fn correct(&mut self, stances: [Vec<footfall_core::FrameSpan>; 2]) {
        self.contacts = self.detected.with_stances(stances);
        self.walks = segment_walks(&self.retargeted.clip, &self.contacts);
        self.is_corrected = true;
    }
}
