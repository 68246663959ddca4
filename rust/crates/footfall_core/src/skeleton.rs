//! A body's proportions.

use crate::joint::{JOINT_COUNT, Joint, Side};
use glam::Vec3;

/// A body's proportions in the T-pose.
///
/// In the T-pose every local rotation is the identity and every joint's axes are parallel to the model's: arms along
/// ±X, legs straight down, soles flat on the floor y = 0, face along +Z. All lengths in metres.
#[derive(Clone, Debug, PartialEq)]
pub struct Skeleton {
    /// `parent_from_joint` translation of each joint; for the hips, their place above the floor in the T-pose.
    pub offsets: [Vec3; JOINT_COUNT],
    /// The sole of the left and of the right foot.
    pub feet: [FootShape; 2],
    /// The top of the head, from the `Head` joint.
    pub head_top: Vec3,
}

/// The points on which a foot can stand. All of them lie in the plane of the sole.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FootShape {
    /// Back edge of the heel, from the `Foot` joint; moves with the foot.
    pub heel: Vec3,
    /// Under the ball of the foot, from the `Toes` joint; moves with the toes.
    pub ball: Vec3,
    /// Front end of the toes, from the `Toes` joint; moves with the toes.
    pub toe_tip: Vec3,
}

/// Errors of a body.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SkeletonError {
    /// A leg or foot segment has no length.
    #[error(
        "joint {joint}: its distance from {parent} is {length_m} m; give it a length in the rest pose",
        joint = joint.name(),
        parent = joint.parent().map_or("the floor", Joint::name)
    )]
    DegenerateSegment {
        /// The lower end of the segment.
        joint: Joint,
        /// Its length.
        length_m: f32,
    },
}

impl Skeleton {
    /// The canonical body: an adult of 1.77 m with a leg (hip joint to ankle) of 0.84 m.
    pub fn standard() -> Self {
        let mut offsets = [Vec3::ZERO; JOINT_COUNT];
        let mut set = |joint: Joint, x: f32, y: f32, z: f32| {
            offsets[joint.index()] = Vec3::new(x, y, z);
        };
        set(Joint::Hips, 0.0, 0.985, 0.0);
        set(Joint::Spine, 0.0, 0.09, 0.0);
        set(Joint::Chest, 0.0, 0.12, 0.0);
        set(Joint::UpperChest, 0.0, 0.12, 0.0);
        set(Joint::Neck, 0.0, 0.17, 0.0);
        set(Joint::Head, 0.0, 0.1, 0.0);
        for (side, shoulder) in [
            (Side::Left, Joint::LeftShoulder),
            (Side::Right, Joint::RightShoulder),
        ] {
            let x = side.sign();
            let arm = |n: usize| Joint::ALL[shoulder.index() + n];
            set(shoulder, 0.03 * x, 0.12, 0.0);
            set(arm(1), 0.14 * x, 0.0, 0.0);
            set(arm(2), 0.28 * x, 0.0, 0.0);
            set(arm(3), 0.25 * x, 0.0, 0.0);
            set(side.upper_leg(), 0.09 * x, -0.06, 0.0);
            set(side.lower_leg(), 0.0, -0.42, 0.0);
            set(side.foot(), 0.0, -0.42, 0.0);
            set(side.toes(), 0.0, -0.065, 0.135);
        }
        let foot = FootShape {
            heel: Vec3::new(0.0, -0.085, -0.05),
            ball: Vec3::new(0.0, -0.02, 0.0),
            toe_tip: Vec3::new(0.0, -0.02, 0.075),
        };
        Self {
            offsets,
            feet: [foot; 2],
            head_top: Vec3::new(0.0, 0.185, 0.0),
        }
    }

    /// The canonical body on soles of its own: the directions from the ankles to the toe joints of flat feet, left and right, of which the part
    /// across the foot is left out.
    pub fn with_feet(directions: [Vec3; 2]) -> Self {
        let mut skeleton = Self::standard();
        let mut lowered = 0.0;
        for side in Side::BOTH {
            let standard = skeleton.offset(side.toes());
            let direction = directions[side.index()]
                .with_x(0.0)
                .normalize_or(standard.normalize());
            let offset = direction * standard.length();
            let rise = standard.y - offset.y;
            skeleton.offsets[side.toes().index()] = offset;
            skeleton.feet[side.index()].heel.y -= rise;
            lowered += 0.5 * rise;
        }
        skeleton.offsets[Joint::Hips.index()].y += lowered;
        skeleton
    }

    /// `parent_from_joint` translation of one joint.
    pub fn offset(&self, joint: Joint) -> Vec3 {
        self.offsets[joint.index()]
    }

    /// The sole of one foot.
    pub fn foot(&self, side: Side) -> &FootShape {
        &self.feet[side.index()]
    }

    /// Thigh plus shank: hip joint to ankle with the knee straight.
    pub fn leg_length(&self, side: Side) -> f32 {
        self.offset(side.lower_leg()).length() + self.offset(side.foot()).length()
    }

    /// Mean length of the two legs, the yardstick for travel and heights.
    pub fn mean_leg_length(&self) -> f32 {
        0.5 * (self.leg_length(Side::Left) + self.leg_length(Side::Right))
    }

    /// Height of the hips above the floor in the T-pose.
    pub fn hip_height(&self) -> f32 {
        self.offset(Joint::Hips).y
    }

    /// The same body at another size.
    #[must_use]
    pub fn scaled(&self, factor: f32) -> Self {
        let mut scaled = self.clone();
        for offset in &mut scaled.offsets {
            *offset *= factor;
        }
        for foot in &mut scaled.feet {
            foot.heel *= factor;
            foot.ball *= factor;
            foot.toe_tip *= factor;
        }
        scaled.head_top *= factor;
        scaled
    }

    /// The same body with left and right changed.
    #[must_use]
    pub fn mirrored(&self) -> Self {
        const MIRROR: Vec3 = Vec3::new(-1.0, 1.0, 1.0);
        let mut mirrored = self.clone();
        for joint in Joint::ALL {
            mirrored.offsets[joint.index()] = self.offset(joint.mirrored()) * MIRROR;
        }
        mirrored.feet.swap(0, 1);
        for foot in &mut mirrored.feet {
            for point in [&mut foot.heel, &mut foot.ball, &mut foot.toe_tip] {
                *point *= MIRROR;
            }
        }
        mirrored.head_top *= MIRROR;
        mirrored
    }

    /// Checks that legs and feet have a length, so that a walk can be planted on them.
    ///
    /// # Errors
    /// [`SkeletonError::DegenerateSegment`] names the first joint at fault.
    pub fn check(&self) -> Result<(), SkeletonError> {
        for side in Side::BOTH {
            for joint in [side.lower_leg(), side.foot(), side.toes()] {
                let length_m = self.offset(joint).length();
                if !length_m.is_finite() || length_m < 1e-4 {
                    return Err(SkeletonError::DegenerateSegment { joint, length_m });
                }
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pose::{ModelPose, Pose};

    #[test]
    fn standard_body_stands_on_its_soles() {
        let skeleton = Skeleton::standard();
        skeleton.check().unwrap();
        let model = ModelPose::of(&skeleton, &Pose::rest(&skeleton));
        for side in Side::BOTH {
            let foot = skeleton.foot(side);
            let ankle = model.position(side.foot());
            let toes = model.position(side.toes());
            for point in [ankle + foot.heel, toes + foot.ball, toes + foot.toe_tip] {
                assert!(point.y.abs() < 1e-6, "{point}");
            }
            assert!(ankle.x * side.sign() > 0.0);
        }
    }

    #[test]
    fn a_leg_without_length_is_named() {
        let mut skeleton = Skeleton::standard();
        skeleton.offsets[Joint::RightFoot.index()] = Vec3::ZERO;
        let error = skeleton.check().unwrap_err().to_string();
        assert!(
            error.contains("RightFoot") && error.contains("RightLowerLeg"),
            "{error}"
        );
    }
}
