//! The axes of the bones at rest: those of Godot's `SkeletonProfileHumanoid`, so that the mannequin behaves like any
//! character that was imported for it. +Y points to the next bone, a turn about +X bends the joint.

use footfall_core::Joint;
use glam::{Mat3, Vec3};

/// `model_from_bone` axes of a bone in the T-pose.
pub(super) fn model_from_bone(joint: Joint) -> Mat3 {
    let axes = |x: Vec3, y: Vec3| Mat3::from_cols(x, y, x.cross(y));
    match joint {
        Joint::Hips
        | Joint::Spine
        | Joint::Chest
        | Joint::UpperChest
        | Joint::Neck
        | Joint::Head => Mat3::IDENTITY,
        Joint::LeftShoulder => axes(Vec3::Z, Vec3::X),
        Joint::LeftUpperArm | Joint::LeftHand => axes(Vec3::NEG_Z, Vec3::X),
        Joint::LeftLowerArm => axes(Vec3::NEG_Y, Vec3::X),
        Joint::RightShoulder => axes(Vec3::NEG_Z, Vec3::NEG_X),
        Joint::RightUpperArm | Joint::RightHand => axes(Vec3::Z, Vec3::NEG_X),
        Joint::RightLowerArm => axes(Vec3::Y, Vec3::NEG_X),
        Joint::LeftUpperLeg | Joint::RightUpperLeg => axes(Vec3::NEG_X, Vec3::NEG_Y),
        Joint::LeftLowerLeg | Joint::RightLowerLeg => axes(Vec3::X, Vec3::NEG_Y),
        Joint::LeftFoot | Joint::RightFoot => axes(Vec3::NEG_X, Vec3::Z),
        Joint::LeftToes | Joint::RightToes => axes(Vec3::X, Vec3::Z),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The profile's reference pose (`scene/resources/skeleton_profile.cpp`): rows of `parent_from_bone`.
    fn profile_rows(joint: Joint) -> [[f32; 3]; 3] {
        match joint {
            Joint::LeftShoulder => [[0., 1., 0.], [0., 0., 1.], [1., 0., 0.]],
            Joint::RightShoulder => [[0., -1., 0.], [0., 0., 1.], [-1., 0., 0.]],
            Joint::LeftLowerArm | Joint::RightHand => [[0., 0., -1.], [0., 1., 0.], [1., 0., 0.]],
            Joint::RightLowerArm | Joint::LeftHand => [[0., 0., 1.], [0., 1., 0.], [-1., 0., 0.]],
            Joint::LeftUpperLeg | Joint::RightUpperLeg => {
                [[-1., 0., 0.], [0., -1., 0.], [0., 0., 1.]]
            }
            Joint::LeftUpperArm
            | Joint::RightUpperArm
            | Joint::LeftLowerLeg
            | Joint::RightLowerLeg
            | Joint::LeftToes
            | Joint::RightToes => [[-1., 0., 0.], [0., 1., 0.], [0., 0., -1.]],
            Joint::LeftFoot | Joint::RightFoot => [[-1., 0., 0.], [0., 0., -1.], [0., -1., 0.]],
            _ => [[1., 0., 0.], [0., 1., 0.], [0., 0., 1.]],
        }
    }

    #[test]
    fn axes_are_those_of_the_profile() {
        for joint in Joint::ALL {
            let parent = joint.parent().map_or(Mat3::IDENTITY, model_from_bone);
            let profile = Mat3::from_cols_array_2d(&profile_rows(joint)).transpose();
            let ours = parent.transpose() * model_from_bone(joint);
            assert!(
                ours.abs_diff_eq(profile, 1e-6),
                "{}: {ours} for {profile}",
                joint.name()
            );
            assert!((ours.determinant() - 1.0).abs() < 1e-6);
        }
    }
}
