//! Names of joints, and where they were found.

use super::families;
use crate::{JOINT_COUNT, Joint};

/// Names that the joints of the canonical body go by in a family of skeletons.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct JointMap {
    /// The family's name, for reports and errors.
    pub label: String,
    /// Names of each joint in the order of [`Joint::ALL`], the preferred one first; empty where the family has no such joint.
    ///
    /// Compared without case, blanks, dots, dashes and underscores, and without whatever prefix all the body's bones have
    /// (`mixamorig:Hips` is `Hips`).
    pub names: [Vec<String>; JOINT_COUNT],
}

impl JointMap {
    /// The maps of the skeletons that are known by name.
    pub fn known() -> Vec<Self> {
        families::known()
    }
}

/// Placement of the canonical joints in one rig.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Placement {
    /// The bone of each canonical joint, where there is one.
    pub joints: [Option<usize>; JOINT_COUNT],
}

impl Placement {
    /// The bone of a joint, where there is one.
    pub fn joint(&self, joint: Joint) -> Option<usize> {
        self.joints[joint.index()]
    }

    /// Joints without which nothing can be said about a body's motion and that are not placed. `Neck` stands for itself or the
    /// `Head`.
    pub fn missing(&self) -> Vec<Joint> {
        REQUIRED
            .into_iter()
            .filter(|&joint| self.joint(joint).is_none())
            .filter(|&joint| joint != Joint::Neck || self.joint(Joint::Head).is_none())
            .collect()
    }

    /// Number of joints that are placed.
    pub fn count(&self) -> usize {
        self.joints.iter().flatten().count()
    }
}

const REQUIRED: [Joint; 12] = [
    Joint::Hips,
    Joint::Neck,
    Joint::LeftUpperArm,
    Joint::LeftLowerArm,
    Joint::RightUpperArm,
    Joint::RightLowerArm,
    Joint::LeftUpperLeg,
    Joint::LeftLowerLeg,
    Joint::LeftFoot,
    Joint::RightUpperLeg,
    Joint::RightLowerLeg,
    Joint::RightFoot,
];
