//! Biovision hierarchy files: the text as it stands, without any idea of what the joints mean.
//!
//! Reading is strict about structure (every error names line, column and what was expected there) and generous about
//! spelling: any case of the keywords, tabs, CRLF, blank lines, lines that start with `#`, names with spaces, any order and
//! subset of channels on any joint, several roots.

mod canonical;
mod frames;
mod parse;
mod write;

pub use canonical::clip_to_bvh;
pub use frames::{JointTransforms, rest_transforms};
pub use parse::{parse, read};
pub use write::{write, write_file};

use glam::Vec3;
use std::path::PathBuf;

/// One number of a joint that the file animates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(missing_docs, reason = "the names of the format")]
pub enum Channel {
    XPosition,
    YPosition,
    ZPosition,
    XRotation,
    YRotation,
    ZRotation,
}

impl Channel {
    /// Every channel.
    pub const ALL: [Self; 6] = [
        Self::XPosition,
        Self::YPosition,
        Self::ZPosition,
        Self::XRotation,
        Self::YRotation,
        Self::ZRotation,
    ];

    /// The name in the file, for example `Xposition`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::XPosition => "Xposition",
            Self::YPosition => "Yposition",
            Self::ZPosition => "Zposition",
            Self::XRotation => "Xrotation",
            Self::YRotation => "Yrotation",
            Self::ZRotation => "Zrotation",
        }
    }

    /// Returns true when the value is a length; otherwise it is an angle in degrees.
    pub const fn is_position(self) -> bool {
        matches!(self, Self::XPosition | Self::YPosition | Self::ZPosition)
    }

    /// 0, 1 or 2 for x, y or z.
    pub const fn axis(self) -> usize {
        match self {
            Self::XPosition | Self::XRotation => 0,
            Self::YPosition | Self::YRotation => 1,
            Self::ZPosition | Self::ZRotation => 2,
        }
    }
}

/// A joint of the file.
#[derive(Clone, Debug, PartialEq)]
pub struct BvhJoint {
    /// Name as written; several joints may share one.
    pub name: String,
    /// Position of the parent in [`BvhFile::joints`]; `None` for a root.
    pub parent: Option<usize>,
    /// `parent_from_joint` translation in the file's unit, where no position channel replaces it.
    pub offset: Vec3,
    /// Channels in the order of their values; rotations multiply from left to right.
    pub channels: Vec<Channel>,
    /// Offsets of the joint's `End Site`s, in the file's unit.
    pub end_sites: Vec<Vec3>,
}

/// A whole file.
#[derive(Clone, Debug, PartialEq)]
pub struct BvhFile {
    /// Joints, parents before children, in the order of the file (depth first).
    pub joints: Vec<BvhJoint>,
    /// Seconds from one frame to the next; above zero.
    pub frame_time_secs: f64,
    /// Number of frames; at least one.
    pub frame_count: usize,
    /// `frame_count` rows of one value per channel, joints in order. Lengths in the file's unit, angles in degrees.
    pub values: Vec<f32>,
}

impl BvhFile {
    /// Values in one frame.
    pub fn channel_count(&self) -> usize {
        self.joints.iter().map(|joint| joint.channels.len()).sum()
    }

    /// The values of one frame, empty when there is no such frame.
    pub fn frame(&self, frame: usize) -> &[f32] {
        let width = self.channel_count();
        self.values
            .get(frame * width..(frame + 1) * width)
            .unwrap_or(&[])
    }

    /// Frames per second. Frame times are rounded to six or seven digits in files, so a rate within 0.01 % of a whole
    /// number is that number.
    pub fn frame_rate_hz(&self) -> f64 {
        let rate = 1.0 / self.frame_time_secs;
        if (rate - rate.round()).abs() < 1e-4 * rate {
            rate.round()
        } else {
            rate
        }
    }

    /// The first joint with this name.
    pub fn joint_named(&self, name: &str) -> Option<usize> {
        self.joints.iter().position(|joint| joint.name == name)
    }
}

/// Errors of reading or writing a BVH file.
#[derive(Debug, thiserror::Error)]
pub enum BvhError {
    /// The text is not a BVH file, or a damaged one.
    #[error("line {line}, column {column}: expected {expected}, found {found}")]
    Syntax {
        /// Line, from 1.
        line: usize,
        /// Column in characters, from 1.
        column: usize,
        /// Expected text.
        expected: String,
        /// Text found.
        found: String,
    },
    /// The same with the file's name.
    #[error("{}: {error}", path.display())]
    InFile {
        /// The file.
        path: PathBuf,
        /// Its fault.
        error: Box<Self>,
    },
    /// The file cannot be opened, read or written.
    #[error("{}: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// Message of the system.
        source: std::io::Error,
    },
}
