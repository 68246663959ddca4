//! Layers: bones with the gait's pose, and bones with the pose of other animation.

use super::bones::turned_by_links;
use super::{Bones, RigBinding};
use footfall_core::rotation::{exp_map, log_map, of_transform};
use footfall_core::{JOINT_COUNT, Joint, Pose, forward_kinematics};
use glam::Quat;

/// Share of the gait in each part of the body: 0 none, 1 all. Hips and legs take all.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LayerWeights {
    /// Weight of the spine.
    pub spine: f32,
    /// Weight of neck and head.
    pub head: f32,
    /// Weight of the left arm, from the shoulder on.
    pub left_arm: f32,
    /// Weight of the right arm.
    pub right_arm: f32,
}

impl LayerWeights {
    /// Gait in all parts of the body.
    fn is_gait(&self) -> bool {
        [self.spine, self.head, self.left_arm, self.right_arm]
            .iter()
            .all(|weight| *weight >= 1.0)
    }

    fn of(&self, joint: Joint) -> f32 {
        match Part::of(joint) {
            Part::Legs => 1.0,
            Part::Spine => self.spine,
            Part::Head => self.head,
            Part::LeftArm => self.left_arm,
            Part::RightArm => self.right_arm,
        }
    }
}

/// Part of the body with one weight.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Part {
    /// Moves with the hips.
    Legs,
    Spine,
    Head,
    LeftArm,
    RightArm,
}

impl Part {
    fn of(joint: Joint) -> Self {
        match joint {
            Joint::Spine | Joint::Chest | Joint::UpperChest => Self::Spine,
            Joint::Neck | Joint::Head => Self::Head,
            Joint::LeftShoulder | Joint::LeftUpperArm | Joint::LeftLowerArm | Joint::LeftHand => {
                Self::LeftArm
            }
            Joint::RightShoulder
            | Joint::RightUpperArm
            | Joint::RightLowerArm
            | Joint::RightHand => Self::RightArm,
            _ => Self::Legs,
        }
    }
}

/// Rotations of the bound bones, in the order of the binding.
type Rotations = [Quat; JOINT_COUNT];

impl RigBinding {
    /// Writes a pose as [`write`](Self::write), but parts of the body keep the rig's pose by their weights.
    ///
    /// Arms follow the chest, posed by the animation. Spine and head start from the animation's orientation relative to the
    /// character, whatever the hips and the chest below them do; otherwise every step would shake an aim or a gaze.
    pub fn write_layered(&mut self, bones: &mut impl Bones, pose: &Pose, weights: &LayerWeights) {
        if weights.is_gait() {
            self.write(bones, pose);
            return;
        }
        forward_kinematics(&self.body, pose, &mut self.model_pose);
        let (own, directions) = self.animated(bones);
        let mut gait: Rotations = [Quat::IDENTITY; JOINT_COUNT];
        let mut shown: Rotations = [Quat::IDENTITY; JOINT_COUNT];
        for (index, bound) in self.bones.iter().enumerate() {
            let [above_in_gait, above] = match bound.parent {
                Some(parent) => [gait[parent], shown[parent]]
                    .map(|above| turned_by_links(bones, above, &bound.links)),
                None => [self.write_hips(bones, bound); 2],
            };
            gait[index] = self.model_pose.rotation(bound.turned_by) * bound.ground_from_bone;
            let of_gait = (above_in_gait.conjugate() * gait[index]).normalize();
            let weight = weights.of(bound.joint);
            let local = if weight >= 1.0 {
                of_gait
            } else {
                let of_animation = if self.begins_part(index) {
                    (above.conjugate() * directions[index]).normalize()
                } else {
                    own[index]
                };
                blend_about(bound.rest, of_animation, of_gait, weight)
            };
            shown[index] = (above * local).normalize();
            if weight > 0.0 || self.begins_part(index) {
                bones.set_rotation(bound.bone, local);
            }
        }
    }

    /// Returns the pose of the rig: each bone's own rotation, and for hips, spine and head the rotation on the ground.
    fn animated(&self, bones: &impl Bones) -> (Rotations, Rotations) {
        let mut own = [Quat::IDENTITY; JOINT_COUNT];
        let mut directions = own;
        for (index, bound) in self.bones.iter().enumerate() {
            let part = Part::of(bound.joint);
            if part == Part::Legs && bound.parent.is_some() {
                continue;
            }
            own[index] = bones.rotation(bound.bone);
            if part == Part::LeftArm || part == Part::RightArm {
                continue;
            }
            let above = match bound.parent {
                Some(parent) => turned_by_links(bones, directions[parent], &bound.links),
                None => of_transform(&self.above_hips(bones, &bound.links)),
            };
            directions[index] = (above * own[index]).normalize();
        }
        (own, directions)
    }

    /// Returns true for the lowest bone of the spine or of the head.
    fn begins_part(&self, index: usize) -> bool {
        let part = Part::of(self.bones[index].joint);
        let below = self.bones[index].parent;
        matches!(part, Part::Spine | Part::Head)
            && below.is_some_and(|below| Part::of(self.bones[below].joint) != part)
    }
}

/// Blends by way of the rest pose: always on the same path, however far the two are apart.
///
/// The shortest path from a raised arm to a hanging one changes sides from frame to frame.
fn blend_about(rest: Quat, from: Quat, to: Quat, weight: f32) -> Quat {
    if weight <= 0.0 {
        return from;
    }
    let back = rest.conjugate();
    let blend = log_map(back * from).lerp(log_map(back * to), weight);
    (rest * exp_map(blend)).normalize()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    #[test]
    fn a_blend_begins_and_ends_where_it_should_and_never_jumps() {
        let rest = Quat::from_rotation_y(0.4);
        let hanging = rest * Quat::from_rotation_z(-1.4);
        let mut before = None;
        // An arm that is raised, and sways: half a turn from the other one, and to both sides of it.
        for step in -20..=20 {
            let raised =
                rest * Quat::from_rotation_z(1.6) * Quat::from_rotation_x(0.02 * step as f32);
            let at = |weight: f32| blend_about(rest, raised, hanging, weight);
            assert!(at(0.0).angle_between(raised) < 1e-3);
            assert!(at(1.0).angle_between(hanging) < 1e-3);
            let halfway = at(0.5);
            if let Some(before) = before {
                assert!(halfway.angle_between(before) < 0.03, "it jumps at {step}");
            }
            before = Some(halfway);
            assert!((halfway * Vec3::X).is_finite());
        }
    }

    #[test]
    fn every_joint_belongs_to_one_part() {
        let count = |part: Part| {
            Joint::ALL
                .iter()
                .filter(|joint| Part::of(**joint) == part)
                .count()
        };
        let counts = [
            Part::Legs,
            Part::Spine,
            Part::Head,
            Part::LeftArm,
            Part::RightArm,
        ]
        .map(count);
        assert_eq!(counts, [9, 3, 2, 4, 4]);
    }
}
