//! Evidence of a recording about its skeleton, from which [hip joints](crate::hip_centres) and [heads](crate::head_carriage) are put right.

use footfall_core::Side;
use glam::{EulerRot, Quat, Vec3};

/// Points of a stance that are compared.
pub const PHASES: usize = 12;

/// Their times: shares of the stride that begins with the foot's own initial contact. Later the knee bends for the swing,
/// and hardly constrains the hip. The time of [`FARTHEST`] is where it is usually.
pub const STRIDE_SHARES: [f32; PHASES] = [
    -0.04, 0.0, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4, 0.45, 0.5,
];

/// The point at which the leg reaches farthest about its landing, whenever that is: there a joint that is placed too high shows first.
pub const FARTHEST: usize = 0;

/// One stance of a walk: the hip joint's place over the ankle.
#[derive(Clone, Debug, PartialEq)]
pub struct Stance {
    /// The leg that stands.
    pub side: Side,
    /// From ankle to hip joint in the axes of the pelvis, in leg lengths, at each of [`STRIDE_SHARES`].
    pub hip_from_ankle: [Vec3; PHASES],
}

/// Mean attitude of neck and head in plain walking, beside one that stands upright and looks where the way goes: degrees forwards and down
/// (x), to the left (y) and towards the right shoulder (z), turned in the order y, x, z.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct HeadCarriage {
    /// The neck.
    pub neck: Vec3,
    /// The head.
    pub head: Vec3,
}

impl HeadCarriage {
    /// Angles of rotations relative to the way ahead.
    pub(crate) fn of_rotations(neck: Quat, head: Quat) -> Self {
        let degrees = |rotation: Quat| {
            let (y, x, z) = rotation.to_euler(EulerRot::YXZ);
            Vec3::new(x, y, z).map(f32::to_degrees)
        };
        Self {
            neck: degrees(neck),
            head: degrees(head),
        }
    }

    /// The rotations of neck and head relative to the way ahead.
    pub(crate) fn rotations(&self) -> [Quat; 2] {
        [self.neck, self.head].map(|degrees| {
            let [x, y, z] = degrees.map(f32::to_radians).to_array();
            Quat::from_euler(EulerRot::YXZ, y, x, z)
        })
    }
}

/// Source of a skeleton, as far as its joints show.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Origin {
    /// A skeleton that may have been made in any way: only strong evidence moves its joints.
    #[default]
    Unknown,
    /// A skeleton of the family of the CMU library's, fitted to markers by a procedure that is known to misplace all hip
    /// joints: they are corrected unless there is strong evidence against it.
    MarkerFit,
}

impl Origin {
    /// The origin of a skeleton with joints of these names. The family has joints between pelvis and thighs of its own.
    pub fn of<'a>(names: &(impl Iterator<Item = &'a str> + Clone)) -> Self {
        let has = |own: &str| names.clone().any(|name| name.eq_ignore_ascii_case(own));
        let is_of_family = has("LHipJoint") && has("RHipJoint");
        if is_of_family {
            Self::MarkerFit
        } else {
            Self::Unknown
        }
    }
}

/// Manner of walking in a recording, as far as it is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Manner {
    /// Plain walking: labelled as such.
    Plain,
    /// Any: nobody labelled it.
    Unlabelled,
    /// An acted style: evidence of no skeleton.
    Acted,
}

/// A skeleton's legs, stances and carriage of the head, as a recording shows them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WalkingEvidence {
    /// Thigh and shank of the left and of the right leg, in leg lengths.
    pub segments: [[f32; 2]; 2],
    /// Lengths of all bones in leg lengths: persons differ in them.
    pub bones: Vec<f32>,
    /// True when the body is the canonical one, which carries corrected or generated motion.
    pub is_own_body: bool,
    /// Source of the skeleton.
    pub origin: Origin,
    /// Stances of plain walking straight ahead.
    pub stances: Vec<Stance>,
    /// Mean carriage of the head over each stride of plain walking; empty for skeletons that were not fitted to markers.
    pub heads: Vec<HeadCarriage>,
}

impl WalkingEvidence {
    /// Returns true when two recordings have one skeleton, at whatever scale.
    pub fn shares_skeleton_with(&self, other: &Self) -> bool {
        const SAME: f32 = 0.004;
        self.bones.len() == other.bones.len()
            && self
                .bones
                .iter()
                .zip(&other.bones)
                .all(|(a, b)| (a - b).abs() < SAME)
    }
}
