//! Proportions of a body from the rest pose of any character.
//!
//! Rest poses differ: A-poses, splayed legs, missing bones. The runtime needs the T-pose of [`Skeleton`]: arms along ±X, legs
//! straight down, soles flat. Limbs are rotated into it here, and the rotations are kept for the inverse.

use footfall_core::{FootShape, JOINT_COUNT, Joint, Side, Skeleton, SkeletonError, rotation};
use glam::{Quat, Vec3};

/// Positions as shares of the leg's length (hip joint to ankle), as on [`Skeleton::standard`], for points without a bone.
mod share {
    /// Ankle above the sole.
    pub(super) const ANKLE_HEIGHT: f32 = 0.101;
    /// Limits of the ankles above the origin, beyond which the origin is not the floor.
    pub(super) const PLAUSIBLE_ANKLE_HEIGHT: core::ops::Range<f32> = 0.02..0.25;
    /// Joint of the toes above the sole.
    pub(super) const BALL_HEIGHT: f32 = 0.024;
    /// Heel behind the ankle.
    pub(super) const HEEL: f32 = 0.06;
    /// End of the toes before their joint.
    pub(super) const TOES: f32 = 0.09;
    /// End of the toes before the ankle.
    pub(super) const FOOT: f32 = 0.25;
    /// Top of the head above its joint.
    pub(super) const HEAD: f32 = 0.22;
}

/// Positions of a character's joints in its rest pose, in metres: Y up, facing +Z, its left +X, the hips at x = z = 0.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct RestJoints {
    /// Position of each joint; `None` for a missing optional joint.
    pub(crate) positions: [Option<Vec3>; JOINT_COUNT],
    /// Ends of the left and the right toes, if bones mark them.
    pub(crate) toe_ends: [Option<Vec3>; 2],
    /// Height of the character's origin, which is the floor if the ankles are a little above it.
    pub(crate) origin_height: f32,
}

/// A body, and the relation of its rest pose to its T-pose.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct RestBody {
    /// Proportions in the T-pose.
    pub(crate) skeleton: Skeleton,
    /// Rotation of each joint's bone from the rest pose to the T-pose, in the axes of the model.
    pub(crate) t_pose_from_rest: [Quat; JOINT_COUNT],
    /// Joint whose rotation each joint's bone takes: its own, or the last missing one that is folded into it.
    pub(crate) turned_by: [Joint; JOINT_COUNT],
    /// Height of the floor on which the rest pose stands.
    pub(crate) floor_height: f32,
}

/// Returns true if a character needs no bone for this joint.
pub(crate) const fn is_optional(joint: Joint) -> bool {
    matches!(
        joint,
        Joint::Chest
            | Joint::UpperChest
            | Joint::Neck
            | Joint::LeftShoulder
            | Joint::RightShoulder
            | Joint::LeftToes
            | Joint::RightToes
    )
}

impl RestBody {
    /// Measures a character.
    ///
    /// # Errors
    /// [`SkeletonError`] when a segment of a leg has no length. Joints that are not optional must be present; a missing one counts as the origin.
    pub(crate) fn new(joints: &RestJoints) -> Result<Self, SkeletonError> {
        let at = |joint: Joint| joints.positions[joint.index()].unwrap_or_default();
        let leg_length = |side: Side| {
            at(side.upper_leg()).distance(at(side.lower_leg()))
                + at(side.lower_leg()).distance(at(side.foot()))
        };
        let leg = 0.5 * (leg_length(Side::Left) + leg_length(Side::Right));
        let floor_height = floor_height(joints, leg);
        let positions = with_missing(joints, floor_height, leg);
        let place = |joint: Joint| positions[joint.index()];

        let t_pose_from_rest = t_pose_from_rest(&positions);
        let mut skeleton = Skeleton::standard();
        for joint in Joint::ALL {
            if let Some(parent) = joint.parent() {
                skeleton.offsets[joint.index()] =
                    t_pose_from_rest[parent.index()] * (place(joint) - place(parent));
            }
        }
        // The hips are as high as straight legs put them, one leg for the other.
        let ankle_height = |side: Side| place(side.foot()).y - floor_height;
        let hip_height = |side: Side| {
            ankle_height(side) + skeleton.leg_length(side) - skeleton.offset(side.upper_leg()).y
        };
        let height = 0.5 * (hip_height(Side::Left) + hip_height(Side::Right));
        skeleton.offsets[Joint::Hips.index()] = Vec3::Y * height;
        for side in Side::BOTH {
            let ankle_height =
                height + skeleton.offset(side.upper_leg()).y - skeleton.leg_length(side);
            skeleton.feet[side.index()] = sole(joints, &skeleton, side, ankle_height, leg);
        }
        skeleton.head_top = Vec3::Y * share::HEAD * leg;
        skeleton.check()?;
        Ok(Self {
            skeleton,
            t_pose_from_rest,
            turned_by: turned_by(joints),
            floor_height,
        })
    }
}

/// Returns the character's origin, or a sole's height below the ankles if the origin cannot be the floor.
fn floor_height(joints: &RestJoints, leg: f32) -> f32 {
    let height = |joint: Joint| joints.positions[joint.index()].map(|position| position.y);
    let lowest = |joint: fn(Side) -> Joint| {
        Side::BOTH
            .into_iter()
            .filter_map(|side| height(joint(side)))
            .reduce(f32::min)
    };
    let ankle = lowest(Side::foot).unwrap_or_default();
    let toes = lowest(Side::toes).unwrap_or(f32::INFINITY);
    let above_origin = (ankle - joints.origin_height) / leg;
    if share::PLAUSIBLE_ANKLE_HEIGHT.contains(&above_origin) && toes >= joints.origin_height {
        joints.origin_height
    } else {
        (ankle - share::ANKLE_HEIGHT * leg).min(toes - share::BALL_HEIGHT * leg)
    }
}

/// Returns all joints: a missing one lies at the neighbour into which it is folded.
fn with_missing(joints: &RestJoints, floor_height: f32, leg: f32) -> [Vec3; JOINT_COUNT] {
    let mut positions = joints.positions.map(Option::unwrap_or_default);
    let is_missing = |joint: Joint| joints.positions[joint.index()].is_none();
    // Parents first: with two missing, the second one finds the first one's place.
    for (joint, neighbour) in [
        (Joint::Chest, Joint::Spine),
        (Joint::UpperChest, Joint::Chest),
        (Joint::Neck, Joint::Head),
        (Joint::LeftShoulder, Joint::LeftUpperArm),
        (Joint::RightShoulder, Joint::RightUpperArm),
    ] {
        if is_missing(joint) {
            positions[joint.index()] = positions[neighbour.index()];
        }
    }
    for side in Side::BOTH {
        if is_missing(side.toes()) {
            // Without toes that bend, the foot rolls over its very tip.
            let ankle = positions[side.foot().index()];
            let forward = share::FOOT * leg;
            positions[side.toes().index()] = joints.toe_ends[side.index()].unwrap_or(Vec3::new(
                ankle.x,
                floor_height + share::BALL_HEIGHT * leg,
                ankle.z + forward,
            ));
        }
    }
    positions
}

/// Returns the rotations that bring arms along ±X and legs straight down. Trunk, shoulders and feet keep their rest pose.
fn t_pose_from_rest(positions: &[Vec3; JOINT_COUNT]) -> [Quat; JOINT_COUNT] {
    let mut turns = [Quat::IDENTITY; JOINT_COUNT];
    let mut aim = |joint: Joint, towards: Joint, direction: Vec3| {
        let segment = positions[towards.index()] - positions[joint.index()];
        turns[joint.index()] = rotation::shortest_arc(segment, direction);
    };
    for side in Side::BOTH {
        let [upper_arm, lower_arm, hand] = arm(side);
        aim(upper_arm, lower_arm, Vec3::X * side.sign());
        aim(lower_arm, hand, Vec3::X * side.sign());
        aim(side.upper_leg(), side.lower_leg(), Vec3::NEG_Y);
        aim(side.lower_leg(), side.foot(), Vec3::NEG_Y);
    }
    for side in Side::BOTH {
        let [_, lower_arm, hand] = arm(side);
        turns[hand.index()] = turns[lower_arm.index()];
    }
    turns
}

/// Upper arm, lower arm, hand.
const fn arm(side: Side) -> [Joint; 3] {
    match side {
        Side::Left => [Joint::LeftUpperArm, Joint::LeftLowerArm, Joint::LeftHand],
        Side::Right => [Joint::RightUpperArm, Joint::RightLowerArm, Joint::RightHand],
    }
}

/// Returns the points on which a foot stands, all in the plane of the floor.
fn sole(
    joints: &RestJoints,
    skeleton: &Skeleton,
    side: Side,
    ankle_height: f32,
    leg: f32,
) -> FootShape {
    let to_toes = skeleton.offset(side.toes());
    let forward = Vec3::new(to_toes.x, 0.0, to_toes.z).normalize_or(Vec3::Z);
    let ball = Vec3::NEG_Y * (ankle_height + to_toes.y);
    let toes_length = match (
        joints.positions[side.toes().index()],
        joints.toe_ends[side.index()],
    ) {
        (None, _) => 0.0,
        (Some(toes), Some(end)) => forward.dot(end - toes).max(0.0),
        (Some(_), None) => share::TOES * leg,
    };
    FootShape {
        heel: Vec3::NEG_Y * ankle_height - forward * share::HEEL * leg,
        ball,
        toe_tip: ball + forward * toes_length,
    }
}

/// Folds the trunk's missing joints into the bone below them. A missing neck or shoulder needs no folding: the bone
/// above it is rotated by its own joint, which includes the missing one's rotation.
fn turned_by(joints: &RestJoints) -> [Joint; JOINT_COUNT] {
    let mut turned_by = Joint::ALL;
    let is_missing = |joint: Joint| joints.positions[joint.index()].is_none();
    if is_missing(Joint::UpperChest) {
        turned_by[Joint::Chest.index()] = Joint::UpperChest;
    }
    if is_missing(Joint::Chest) {
        turned_by[Joint::Spine.index()] = if is_missing(Joint::UpperChest) {
            Joint::UpperChest
        } else {
            Joint::Chest
        };
    }
    turned_by
}

#[cfg(test)]
mod tests {
    use super::*;
    use footfall_core::{ModelPose, Pose};

    fn standard_joints() -> RestJoints {
        let skeleton = Skeleton::standard();
        let model = ModelPose::of(&skeleton, &Pose::rest(&skeleton));
        RestJoints {
            positions: model.positions.map(Some),
            ..RestJoints::default()
        }
    }

    #[track_caller]
    fn assert_near(a: Vec3, b: Vec3, tolerance: f32) {
        assert!(a.distance(b) < tolerance, "{a} is not {b}");
    }

    #[test]
    fn the_standard_body_is_measured_as_it_is() {
        let body = RestBody::new(&standard_joints()).unwrap();
        let standard = Skeleton::standard();
        for joint in Joint::ALL {
            assert_near(body.skeleton.offset(joint), standard.offset(joint), 1e-5);
            assert!(body.t_pose_from_rest[joint.index()].angle_between(Quat::IDENTITY) < 1e-3);
            assert_eq!(body.turned_by[joint.index()], joint);
        }
        for side in Side::BOTH {
            let (foot, expected) = (body.skeleton.foot(side), standard.foot(side));
            assert_near(foot.heel, expected.heel, 2e-3);
            assert_near(foot.ball, expected.ball, 1e-5);
            assert_near(foot.toe_tip, expected.toe_tip, 2e-3);
        }
        assert!(body.floor_height.abs() < 1e-6);
    }

    #[test]
    fn an_a_pose_with_splayed_legs_gives_the_same_body() {
        let skeleton = Skeleton::standard();
        let mut pose = Pose::rest(&skeleton);
        for side in Side::BOTH {
            let [upper_arm, ..] = arm(side);
            pose.rotations[upper_arm.index()] = Quat::from_rotation_z(-0.8 * side.sign());
            let splay = Quat::from_rotation_z(0.1 * side.sign());
            pose.rotations[side.upper_leg().index()] = splay;
            pose.rotations[side.foot().index()] = splay.inverse();
        }
        let model = ModelPose::of(&skeleton, &pose);
        let lowered = model.position(Joint::LeftFoot).y - 0.085;
        let joints = RestJoints {
            positions: model.positions.map(|place| Some(place - Vec3::Y * lowered)),
            ..RestJoints::default()
        };
        let body = RestBody::new(&joints).unwrap();
        for joint in Joint::ALL {
            assert_near(body.skeleton.offset(joint), skeleton.offset(joint), 1e-4);
        }
        let turn = body.t_pose_from_rest[Joint::LeftUpperArm.index()];
        assert!(turn.angle_between(Quat::from_rotation_z(0.8)) < 1e-3);
    }

    #[test]
    fn missing_bones_are_folded_into_their_neighbours() {
        let mut joints = standard_joints();
        for joint in Joint::ALL.into_iter().filter(|joint| is_optional(*joint)) {
            joints.positions[joint.index()] = None;
        }
        let body = RestBody::new(&joints).unwrap();
        assert_eq!(body.turned_by[Joint::Spine.index()], Joint::UpperChest);
        let skeleton = &body.skeleton;
        let model = ModelPose::of(skeleton, &Pose::rest(skeleton));
        for joint in Joint::ALL.into_iter().filter(|joint| !is_optional(*joint)) {
            let expected = joints.positions[joint.index()].unwrap();
            assert_near(model.position(joint), expected, 1e-5);
        }
        // The foot ends where the standard foot does, and rolls over that end.
        let tip = model.point(Joint::LeftToes, skeleton.feet[0].toe_tip);
        assert_near(tip, Vec3::new(0.09, 0.0, 0.21), 5e-3);
        assert_eq!(skeleton.feet[0].toe_tip, skeleton.feet[0].ball);
    }

    #[test]
    fn an_origin_at_the_hips_is_not_taken_for_the_floor() {
        let mut joints = standard_joints();
        joints.origin_height = 0.985;
        let body = RestBody::new(&joints).unwrap();
        assert!(body.floor_height.abs() < 0.01, "{}", body.floor_height);
    }

    #[test]
    fn a_leg_without_length_is_refused_by_name() {
        let mut joints = standard_joints();
        joints.positions[Joint::LeftFoot.index()] = joints.positions[Joint::LeftLowerLeg.index()];
        let error = RestBody::new(&joints).unwrap_err().to_string();
        assert!(error.contains("LeftFoot"), "{error}");
    }
}
