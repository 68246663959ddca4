//! Two-bone leg: hip joint, knee, ankle.

use core::f32::consts::PI;
use footfall_core::rotation::shortest_arc;
use footfall_core::{ModelPose, Pose, Side, Skeleton};
use glam::{Quat, Vec3};

/// Where a foot has to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FootTarget {
    /// Position of the ankle (the `Foot` joint) in model space, metres.
    pub ankle: Vec3,
    /// `model_from_foot` rotation.
    pub foot: Quat,
    /// `model_from_toes` rotation.
    pub toes: Quat,
}

/// Share of the straight leg that the solver uses at most: a leg that is quite straight makes the knee snap.
const MAX_EXTENSION: f32 = 0.9995;

/// Turns thigh, shank, foot and toes so that the foot meets its target, and updates `model` for these joints.
///
/// The knee stays in the plane in which the pose already bends it. Out of reach, the leg is stretched towards the
/// target and the ankle falls short; returns the distance by which it does, metres. `model` must hold the pose's forward
/// kinematics at least for the hips.
pub fn solve_leg(
    skeleton: &Skeleton,
    side: Side,
    target: &FootTarget,
    pose: &mut Pose,
    model: &mut ModelPose,
) -> f32 {
    let (hip, knee, ankle, toes) = (side.upper_leg(), side.lower_leg(), side.foot(), side.toes());
    let hips_rotation = model.rotation(footfall_core::Joint::Hips);
    let hip_position = model.point(footfall_core::Joint::Hips, skeleton.offset(hip));
    let thigh_axis = skeleton.offset(knee);
    let shank_axis = skeleton.offset(ankle);
    let (thigh, shank) = (thigh_axis.length(), shank_axis.length());

    let to_ankle = target.ankle - hip_position;
    let distance = to_ankle.length();
    let reach = distance.clamp(
        (thigh - shank).abs() + 1e-4,
        MAX_EXTENSION * (thigh + shank),
    );

    // Bend the knee to the right length about the axis that it bends about in the pose.
    let thigh_rotation = hips_rotation * pose.rotation(hip);
    let shank_rotation = thigh_rotation * pose.rotation(knee);
    let bent_thigh = thigh_rotation * thigh_axis;
    let bent_shank = shank_rotation * shank_axis;
    let hinge = knee_hinge(bent_thigh, bent_shank, thigh_rotation);
    let inner = interior_angle(thigh, shank, reach);
    let bend = PI - inner;
    let current_bend = signed_angle(bent_thigh, bent_shank, hinge);
    let shank_rotation = Quat::from_axis_angle(hinge, bend - current_bend) * shank_rotation;

    // Then aim hip-to-ankle at the target.
    let reached = bent_thigh + shank_rotation * shank_axis;
    let aim = shortest_arc(reached, to_ankle);
    let thigh_rotation = (aim * thigh_rotation).normalize();
    let shank_rotation = (aim * shank_rotation).normalize();

    model.positions[hip.index()] = hip_position;
    model.rotations[hip.index()] = thigh_rotation;
    model.positions[knee.index()] = hip_position + thigh_rotation * thigh_axis;
    model.rotations[knee.index()] = shank_rotation;
    model.positions[ankle.index()] = model.position(knee) + shank_rotation * shank_axis;
    model.rotations[ankle.index()] = target.foot;
    model.positions[toes.index()] = model.point(ankle, skeleton.offset(toes));
    model.rotations[toes.index()] = target.toes;

    pose.rotations[hip.index()] = (hips_rotation.inverse() * thigh_rotation).normalize();
    pose.rotations[knee.index()] = (thigh_rotation.inverse() * shank_rotation).normalize();
    pose.rotations[ankle.index()] = (shank_rotation.inverse() * target.foot).normalize();
    pose.rotations[toes.index()] = (target.foot.inverse() * target.toes).normalize();
    (model.position(ankle) - target.ankle).length()
}

/// The greatest height of the hips joint at which an ankle is within reach of a leg that is stretched to the fraction
/// `extension`; `None` when it is out of reach sideways at any height.
///
/// `hip_from_hips` is the hip joint's place relative to the hips in model space, `ankle` the target, and `hips` the
/// hips' place, whose height is ignored.
pub fn reach_height(
    hips: Vec3,
    hip_from_hips: Vec3,
    ankle: Vec3,
    leg_length: f32,
    extension: f32,
) -> Option<f32> {
    let hip = hips + hip_from_hips;
    let level = Vec3::new(ankle.x - hip.x, 0.0, ankle.z - hip.z).length_squared();
    let height_squared = (extension * leg_length).powi(2) - level;
    (height_squared > 0.0).then(|| ankle.y + height_squared.sqrt() - hip_from_hips.y)
}

/// The axis about which the shank turns backwards from the thigh, a unit vector.
///
/// A nearly straight leg has no plane of its own; the thigh's own x axis (the left of a leg in the T-pose) takes over
/// smoothly.
fn knee_hinge(thigh: Vec3, shank: Vec3, thigh_rotation: Quat) -> Vec3 {
    let anatomical = thigh_rotation * Vec3::X;
    let (thigh, shank) = (
        thigh.normalize_or(Vec3::NEG_Y),
        shank.normalize_or(Vec3::NEG_Y),
    );
    let bent = thigh.cross(shank);
    // A hyperextended knee must not be taken for one that bends forwards.
    let bent = bent - anatomical * bent.dot(anatomical).min(0.0);
    // Below about 6 degrees of bend the plane is mostly noise.
    let blended = bent + anatomical * 0.1 * (1.0 - bent.length() / 0.1).max(0.0);
    let across = blended - thigh * blended.dot(thigh);
    across.try_normalize().unwrap_or(anatomical)
}

/// The knee's inner angle in a triangle with these two sides and the opposite third.
fn interior_angle(thigh: f32, shank: f32, opposite: f32) -> f32 {
    let cosine = (thigh * thigh + shank * shank - opposite * opposite) / (2.0 * thigh * shank);
    cosine.clamp(-1.0, 1.0).acos()
}

/// Angle from one direction to another, positive about `axis`.
fn signed_angle(from: Vec3, to: Vec3, axis: Vec3) -> f32 {
    from.cross(to).dot(axis).atan2(from.dot(to))
}

#[cfg(test)]
mod tests {
    use super::*;
    use footfall_core::rotation::exp_map;
    use footfall_core::{Joint, forward_kinematics};
    use proptest::prelude::*;

    fn crouched(flexion: f32, lean: f32) -> Pose {
        let mut pose = Pose::rest(&Skeleton::standard());
        for side in Side::BOTH {
            pose.rotations[side.upper_leg().index()] =
                exp_map(Vec3::new(-flexion / 2.0, lean, 0.0));
            pose.rotations[side.lower_leg().index()] = exp_map(Vec3::X * flexion);
        }
        pose
    }

    proptest! {
        #[test]
        fn reaches_what_is_reachable(
            flexion in 0.05_f32..1.5, lean in -0.3_f32..0.3,
            x in -0.2_f32..0.2, y in 0.0_f32..0.3, z in -0.4_f32..0.4, pitch in -0.8_f32..0.8,
        ) {
            let skeleton = Skeleton::standard();
            for side in Side::BOTH {
                let mut pose = crouched(flexion, lean);
                let mut model = ModelPose::default();
                forward_kinematics(&skeleton, &pose, &mut model);
                let target = FootTarget {
                    ankle: Vec3::new(0.09 * side.sign() + x, 0.12 + y, z),
                    foot: Quat::from_rotation_x(pitch),
                    toes: Quat::from_rotation_x(0.5 * pitch),
                };
                let hip = model.position(side.upper_leg());
                prop_assume!(hip.distance(target.ankle) < 0.83);
                let missed = solve_leg(&skeleton, side, &target, &mut pose, &mut model);
                prop_assert!(missed < 1e-4, "missed by {missed}");
                let mut check = ModelPose::default();
                forward_kinematics(&skeleton, &pose, &mut check);
                prop_assert!(check.position(side.foot()).distance(target.ankle) < 1e-4);
                prop_assert!(check.rotation(side.foot()).angle_between(target.foot) < 2e-3);
                prop_assert!(check.rotation(side.toes()).angle_between(target.toes) < 2e-3);
                prop_assert!(model.position(side.toes()).distance(check.position(side.toes())) < 1e-4);
                // The knee never bends backwards: it lies ahead of the line from hip to ankle, in the thigh's frame.
                let knee_local = check.rotation(side.upper_leg()).inverse()
                    * (check.position(side.foot()) - check.position(side.lower_leg()));
                prop_assert!(knee_local.z < 1e-3, "{knee_local}");
            }
        }
    }

    #[test]
    fn a_met_target_changes_nothing() {
        let skeleton = Skeleton::standard();
        let mut pose = crouched(0.6, 0.1);
        let before = pose.clone();
        let mut model = ModelPose::default();
        forward_kinematics(&skeleton, &pose, &mut model);
        let target = FootTarget {
            ankle: model.position(Joint::LeftFoot),
            foot: model.rotation(Joint::LeftFoot),
            toes: model.rotation(Joint::LeftToes),
        };
        solve_leg(&skeleton, Side::Left, &target, &mut pose, &mut model);
        for (now, then) in pose.rotations.iter().zip(&before.rotations) {
            assert!(now.angle_between(*then) < 2e-3);
        }
    }

    #[test]
    fn out_of_reach_stretches_towards_the_target() {
        let skeleton = Skeleton::standard();
        let mut pose = crouched(0.6, 0.0);
        let mut model = ModelPose::default();
        forward_kinematics(&skeleton, &pose, &mut model);
        let target = FootTarget {
            ankle: Vec3::new(0.09, -1.0, 0.5),
            foot: Quat::IDENTITY,
            toes: Quat::IDENTITY,
        };
        let missed = solve_leg(&skeleton, Side::Left, &target, &mut pose, &mut model);
        assert!(missed > 0.5);
        let hip = model.position(Joint::LeftUpperLeg);
        let reached = (model.position(Joint::LeftFoot) - hip).normalize();
        assert!(reached.dot((target.ankle - hip).normalize()) > 0.9999);
    }

    #[test]
    fn reach_height_is_where_the_leg_is_stretched() {
        let hip_from_hips = Vec3::new(0.09, -0.06, 0.0);
        let ankle = Vec3::new(0.09, 0.085, 0.3);
        let height = reach_height(Vec3::ZERO, hip_from_hips, ankle, 0.84, 0.99).unwrap();
        let hip = Vec3::new(0.0, height, 0.0) + hip_from_hips;
        assert!((hip.distance(ankle) - 0.99 * 0.84).abs() < 1e-5);
        assert!(reach_height(Vec3::ZERO, hip_from_hips, Vec3::X * 3.0, 0.84, 1.0).is_none());
    }
}
