//! Findings and errors of bringing a recording onto the canonical skeleton.

use crate::skeleton_fit::FitFinding;
use footfall_core::{JOINT_COUNT, Joint};

/// Findings of retargeting about a file.
#[derive(Clone, Debug)]
pub struct RetargetReport {
    /// Label of the joint map.
    pub map: String,
    /// Name in the file of each canonical joint that it has, in the order of [`Joint::ALL`].
    pub source_joints: [Option<String>; JOINT_COUNT],
    /// Metres of the canonical body for one unit of the file.
    pub scale: f32,
    /// Frames in which the left and the right foot lay flat, from which the foot's zero was learned.
    pub flat_foot_frames: [usize; 2],
    /// True when the body walked in place, and its way was taken [from the standing foot](crate::game_clip).
    pub in_place: bool,
    /// Frames of one round, for a clip that is a loop.
    pub cycle_frames: Option<usize>,
    /// Number of times that the clip shows the same steps: more than once for a loop that was unrolled.
    pub repeats: usize,
    /// The findings about hip joints and head.
    pub fit: FitFinding,
}

/// Errors of retargeting a file.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum RetargetError {
    /// The joints' names fit no map.
    #[error(
        "the file has no known joint for {missing}; the closest map is \"{map}\"{doubts}; write a map with lines such as \
         `{example} = \"name in the file\"` and pass it as --map; the file's joints are {joints}",
        missing = missing.iter().map(|joint| joint.name()).collect::<Vec<_>>().join(", "),
        example = missing.first().map_or("Hips", |joint| joint.name()),
        joints = joints.join(", ")
    )]
    UnknownSkeleton {
        /// Needed canonical joints that were not found.
        missing: Vec<Joint>,
        /// The map that fits best.
        map: String,
        /// Reasons for leaving out joints with bones of their names, each preceded by `; `.
        doubts: String,
        /// All joints of the file.
        joints: Vec<String>,
    },
    /// The joint map cannot be used.
    #[error("joint map: {0}")]
    Map(String),
    /// The legs have no length, so there is no scale.
    #[error(
        "the legs of the file are {length} units long in all frames; check that {knee} and {ankle} are knee and ankle"
    )]
    NoLegs {
        /// Thigh plus shank.
        length: f32,
        /// The file's joint at the left knee.
        knee: String,
        /// The file's joint at the left ankle.
        ankle: String,
    },
    /// The numbers of the file are too large to place the body.
    #[error(
        "frame {frame}: the body cannot be placed; its lengths or positions are out of range; export the file again"
    )]
    NotFinite {
        /// The first such frame.
        frame: usize,
    },
    /// The rate asked for is no rate.
    #[error("{0} frames per second is not a frame rate; give a number above zero")]
    FrameRate(f64),
}
