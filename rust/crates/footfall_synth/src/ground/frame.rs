//! Planted frames.

use footfall_core::Pose;
use glam::{Quat, Vec3};

/// One frame of a walk on the ground.
#[derive(Clone, Debug, Default)]
pub(crate) struct PlantedFrame {
    /// The pose in the space where the walk began.
    pub(crate) pose: Pose,
    /// Place of the walker on the ground: its travel without sway.
    pub(crate) ground_position: Vec3,
    /// Heading of the walker, radians, and the rotation by it; continuous within a step.
    pub(crate) ground_heading: f32,
    pub(crate) plan_from_ground: Quat,
    /// Heading of the generated features, radians, and the rotation by it.
    pub(crate) heading: f32,
    pub(crate) level: Quat,
    /// Contacts of the left and the right foot.
    pub(crate) contact: [bool; 2],
}

/// Cosines of half of the angles by which a body and a joint may turn from frame to frame. Blends of headings are unit quaternions to a ten-thousandth up to there.
const NEAR: f32 = 0.968;
const JOINTS_NEAR: f32 = 0.64;

impl PlantedFrame {
    /// Returns true when place and pose are finite.
    pub(crate) fn is_finite(&self) -> bool {
        self.ground_position.is_finite() && self.pose.is_finite()
    }

    /// Returns true when the body turns by less than 29° to the next frame, and no joint by more than 100°.
    pub(crate) fn is_near(&self, next: &Self) -> bool {
        let mut joints = self.pose.rotations.iter().zip(&next.pose.rotations);
        self.level.dot(next.level) > NEAR
            && self.plan_from_ground.dot(next.plan_from_ground) > NEAR
            && joints.all(|(from, to)| from.dot(*to) > JOINTS_NEAR)
    }
}

impl AsRef<Pose> for PlantedFrame {
    fn as_ref(&self) -> &Pose {
        &self.pose
    }
}

impl AsMut<Pose> for PlantedFrame {
    fn as_mut(&mut self) -> &mut Pose {
        &mut self.pose
    }
}
