//! The source's T-pose: how each of its joints would be turned if the body stood as the canonical body does at zero
//! rotations.
//!
//! Zero rotations of a file are seldom that pose. Where they are at least a standing body, or where some frame is a T-pose,
//! each segment is turned from there the short way into the canonical direction. Where they are nothing of the sort (all
//! segments along one axis), joint axes are read from the motion: hips from the line between the hip joints, trunk and
//! hands from the right-angled turn that they keep to their parent on average. In both cases knees and elbows get their hinge axis
//! from the motion, if they bend enough to show it.

use super::source::{SourceFrame, SourceMotion};
use footfall_core::rotation::shortest_arc;
use footfall_core::{JOINT_COUNT, Joint, Side};
use glam::{Mat3, Quat, Vec3};

/// `world_from_joint` rotation of every source joint in the T-pose that faces +Z.
pub(super) type RestRotations = [Quat; JOINT_COUNT];

/// Direction of a joint's segment on the canonical body in the T-pose.
pub(super) fn canonical_direction(joint: Joint) -> Vec3 {
    use Joint::{
        LeftFoot, LeftHand, LeftLowerArm, LeftLowerLeg, LeftShoulder, LeftToes, LeftUpperArm,
        LeftUpperLeg, RightFoot, RightHand, RightLowerArm, RightLowerLeg, RightShoulder, RightToes,
        RightUpperArm, RightUpperLeg,
    };
    match joint {
        LeftShoulder | LeftUpperArm | LeftLowerArm | LeftHand => Vec3::X,
        RightShoulder | RightUpperArm | RightLowerArm | RightHand => Vec3::NEG_X,
        LeftUpperLeg | LeftLowerLeg | RightUpperLeg | RightLowerLeg => Vec3::NEG_Y,
        LeftFoot | RightFoot => Vec3::new(0.0, -0.433, 0.9),
        LeftToes | RightToes => Vec3::Z,
        _ => Vec3::Y,
    }
}

/// Sine of the least angle between a direction and its side.
const LEAST_SIDE: f32 = 1e-3;

/// The rotation that turns `from` onto `to` and, as well as it can, `from_side` onto `to_side`.
fn aligning(from: Vec3, to: Vec3, from_side: Vec3, to_side: Vec3) -> Quat {
    let basis = |main: Vec3, side: Vec3| {
        let main = main.try_normalize()?;
        let across = main.cross(side.try_normalize()?);
        // A side that points along the main direction is none.
        let across = (across.length() > LEAST_SIDE).then(|| across.normalize())?;
        let side = across.cross(main).normalize();
        Some(Quat::from_mat3(&Mat3::from_cols(main, side, across)))
    };
    match (basis(from, from_side), basis(to, to_side)) {
        (Some(from), Some(to)) => (to * from.inverse()).normalize(),
        _ => shortest_arc(from, to),
    }
}

/// Finds the T-pose rotations. Feet and toes are preliminary: [`super::feet`] finds their zero from standing frames.
pub(super) fn rest_rotations(motion: &SourceMotion) -> RestRotations {
    let (mut rest, is_known) = match reference_pose(motion) {
        Some(reference) => (from_reference(reference), true),
        None => (from_structure(motion), false),
    };
    // A standing reference pose has the hinges as exactly as its author posed them.
    let most_change = if is_known {
        40_f32.to_radians()
    } else {
        f32::INFINITY
    };
    for side in Side::BOTH {
        let arm = side.upper_arm();
        let elbow_axis = Vec3::NEG_Y * side.sign();
        for (upper, lower, axis) in [
            (side.upper_leg(), side.lower_leg(), Vec3::X),
            (arm, Joint::ALL[arm.index() + 1], elbow_axis),
        ] {
            if let Some(hinge) = hinge(motion, upper, lower, 0.95, 0.12) {
                hinge.apply(motion, axis, most_change, &mut rest);
            }
        }
    }
    rest
}

/// A frame in which the body stands: zero rotations if they do, else a T-pose at the start of the motion.
fn reference_pose(motion: &SourceMotion) -> Option<&SourceFrame> {
    if stands(&motion.rest, 35.0, None) {
        return Some(&motion.rest);
    }
    motion
        .frames
        .iter()
        .take(motion.first_motion_frame + 1)
        .find(|frame| stands(frame, 15.0, Some(20.0)))
}

/// Returns true for the T-pose of the canonical body.
pub(super) fn is_t_pose(frame: &SourceFrame) -> bool {
    stands(frame, 5.0, Some(5.0))
}

/// Returns true when trunk and legs are upright and straight within `tolerance` degrees, and, if asked, the arms level.
fn stands(frame: &SourceFrame, tolerance: f32, arm_tolerance: Option<f32>) -> bool {
    let within = |direction: Vec3, target: Vec3, degrees: f32| {
        direction != Vec3::ZERO && direction.angle_between(target) < degrees.to_radians()
    };
    let trunk = (frame.position(Joint::Neck) - frame.position(Joint::Hips)).normalize_or_zero();
    let left = frame.left();
    let level = left != Vec3::ZERO && left.y.abs() < 0.35;
    let legs = Side::BOTH.into_iter().all(|side| {
        [side.upper_leg(), side.lower_leg()]
            .into_iter()
            .all(|joint| within(frame.direction(joint), Vec3::NEG_Y, tolerance))
    });
    let arms = [Joint::LeftUpperArm, Joint::RightUpperArm]
        .into_iter()
        .zip([left, -left])
        .all(|(joint, outward)| match arm_tolerance {
            Some(degrees) => [joint, Joint::ALL[joint.index() + 1]]
                .into_iter()
                .all(|joint| within(frame.direction(joint), outward, degrees)),
            // In any standing pose the arms point outward or hang; they do not cross the body.
            None => within(frame.direction(joint), outward - Vec3::Y, 80.0),
        });
    within(trunk, Vec3::Y, tolerance) && level && legs && arms
}

/// From a body that stands: each limb segment the short way into its canonical direction, the trunk as it stands.
fn from_reference(reference: &SourceFrame) -> RestRotations {
    let left = reference.left().with_y(0.0);
    let facing = aligning(left, Vec3::X, Vec3::Y, Vec3::Y);
    let mut rest = reference.rotations.map(|rotation| facing * rotation);
    for joint in Joint::ALL {
        if is_limb_segment(joint) {
            let direction = facing * reference.direction(joint);
            let turn = shortest_arc(direction, canonical_direction(joint));
            rest[joint.index()] = turn * rest[joint.index()];
        }
    }
    rest
}

/// Segments whose direction at zero rotations is that of the canonical body. Collar bones, trunk and head keep the
/// posture of the reference pose, hands that of the forearm.
fn is_limb_segment(joint: Joint) -> bool {
    use Joint::{
        LeftLowerArm, LeftLowerLeg, LeftUpperArm, LeftUpperLeg, RightLowerArm, RightLowerLeg,
        RightUpperArm, RightUpperLeg,
    };
    matches!(
        joint,
        LeftUpperArm
            | LeftLowerArm
            | RightUpperArm
            | RightLowerArm
            | LeftUpperLeg
            | LeftLowerLeg
            | RightUpperLeg
            | RightLowerLeg
    )
}

/// Mean direction of something in a joint's own space.
fn mean_in_joint(motion: &SourceMotion, joint: Joint, what: impl Fn(&SourceFrame) -> Vec3) -> Vec3 {
    motion
        .sampled()
        .map(|frame| frame.rotation(joint).inverse() * what(frame))
        .sum::<Vec3>()
        .normalize_or_zero()
}

/// From the motion alone.
fn from_structure(motion: &SourceMotion) -> RestRotations {
    let mut rest = [Quat::IDENTITY; JOINT_COUNT];
    let left = mean_in_joint(motion, Joint::Hips, SourceFrame::left);
    let up = mean_in_joint(motion, Joint::Hips, |frame| frame.direction(Joint::Hips));
    rest[Joint::Hips.index()] = aligning(left, Vec3::X, up, Vec3::Y);
    for joint in Joint::ALL.into_iter().skip(1) {
        let Some(parent) = joint.parent() else {
            continue;
        };
        let index = joint.index();
        let parent_rest = rest[parent.index()];
        let segment = mean_in_joint(motion, joint, |frame| frame.direction(joint));
        let canonical = canonical_direction(joint);
        rest[index] = match joint {
            Joint::LeftHand | Joint::RightHand if motion.has[index] => {
                snapped(motion, parent, joint, parent_rest)
            }
            _ if joint < Joint::LeftShoulder => snapped(motion, parent, joint, parent_rest),
            Joint::LeftShoulder | Joint::RightShoulder if motion.has[index] => {
                let trunk_up = mean_in_joint(motion, joint, |frame| {
                    frame.rotation(parent) * (parent_rest.inverse() * Vec3::Y)
                });
                aligning(segment, canonical, trunk_up, Vec3::Y)
            }
            Joint::LeftUpperLeg | Joint::RightUpperLeg => {
                let axis = mean_in_joint(motion, joint, SourceFrame::left);
                aligning(segment, canonical, axis, Vec3::X)
            }
            Joint::LeftUpperArm | Joint::RightUpperArm => {
                let trunk = Joint::UpperChest;
                let trunk_rest = rest[trunk.index()];
                let forward = mean_in_joint(motion, joint, |frame| {
                    frame.rotation(trunk) * (trunk_rest.inverse() * Vec3::Z)
                });
                aligning(segment, canonical, forward, Vec3::Z)
            }
            _ if motion.has[index] && segment != Vec3::ZERO => {
                // The same sideways axis as the segment above, on average.
                let side_axis = if canonical.x.abs() > 0.5 {
                    Vec3::Z
                } else {
                    Vec3::X
                };
                let axis = mean_in_joint(motion, joint, |frame| {
                    frame.rotation(parent) * (parent_rest.inverse() * side_axis)
                });
                aligning(segment, canonical, axis, side_axis)
            }
            _ => parent_rest,
        };
    }
    // Even weak evidence of a hinge is better than none here.
    for side in Side::BOTH {
        let upper_arm = side.upper_arm();
        let lower_arm = Joint::ALL[upper_arm.index() + 1];
        for (upper, lower, axis) in [
            (side.upper_leg(), side.lower_leg(), Vec3::X),
            (upper_arm, lower_arm, Vec3::NEG_Y * side.sign()),
        ] {
            if let Some(hinge) = hinge(motion, upper, lower, 0.7, 0.04) {
                hinge.apply(motion, axis, f32::INFINITY, &mut rest);
            }
        }
    }
    rest
}

/// The T-pose rotation of a joint whose turn against its parent is, in the T-pose, the right-angled turn nearest to
/// its mean over the motion. Where no right-angled turn is near, the mean itself.
fn snapped(motion: &SourceMotion, parent: Joint, joint: Joint, parent_rest: Quat) -> Quat {
    let mut sum = glam::Vec4::ZERO;
    for frame in motion.sampled() {
        let turn = frame.rotation(parent).inverse() * frame.rotation(joint);
        let turn = glam::Vec4::from(turn);
        sum += if sum.dot(turn) < 0.0 { -turn } else { turn };
    }
    let mean = Quat::from_vec4(sum.normalize_or(glam::Vec4::W));
    let matrix = Mat3::from_quat(mean);
    let axes = [
        Vec3::X,
        Vec3::Y,
        Vec3::Z,
        Vec3::NEG_X,
        Vec3::NEG_Y,
        Vec3::NEG_Z,
    ];
    let nearest = |column: Vec3, free: &dyn Fn(Vec3) -> bool| {
        axes.into_iter()
            .filter(|&axis| free(axis))
            .max_by(|a, b| a.dot(column).total_cmp(&b.dot(column)))
            .unwrap_or(Vec3::X)
    };
    let x = nearest(matrix.x_axis, &|_| true);
    let y = nearest(matrix.y_axis, &|axis| axis.dot(x) == 0.0);
    let snapped = Quat::from_mat3(&Mat3::from_cols(x, y, x.cross(y)));
    let turn = if snapped.angle_between(mean) < 40_f32.to_radians() {
        snapped
    } else {
        mean
    };
    (parent_rest * turn).normalize()
}

/// The axis about which a knee or an elbow bends.
struct Hinge {
    upper: Joint,
    lower: Joint,
    /// The axis in the space of the upper and of the lower joint.
    in_upper: Vec3,
    in_lower: Vec3,
}

/// Finds the hinge between two segments: the mean of their cross product. `None` where they bend too little
/// (`least_bend`, mean sine of the angle) or about no steady axis (`least_agreement`, 1 for a perfect hinge).
fn hinge(
    motion: &SourceMotion,
    upper: Joint,
    lower: Joint,
    least_agreement: f32,
    least_bend: f32,
) -> Option<Hinge> {
    let mut sums = [Vec3::ZERO; 2];
    let mut bend = 0.0;
    let mut frames = 0.0;
    for frame in motion.sampled() {
        let axis = frame.direction(upper).cross(frame.direction(lower));
        bend += axis.length();
        frames += 1.0;
        for (sum, joint) in sums.iter_mut().zip([upper, lower]) {
            *sum += frame.rotation(joint).inverse() * axis;
        }
    }
    let steady = sums[0].length() > least_agreement * bend;
    (bend > least_bend * frames && steady).then(|| Hinge {
        upper,
        lower,
        in_upper: sums[0].normalize_or_zero(),
        in_lower: sums[1].normalize_or_zero(),
    })
}

impl Hinge {
    /// Turns both segments' T-pose rotations about the segment so that the hinge is the canonical `axis`; not at all if
    /// that changes either by more than `most_change` radians.
    fn apply(&self, motion: &SourceMotion, axis: Vec3, most_change: f32, rest: &mut RestRotations) {
        let turned =
            [(self.upper, self.in_upper), (self.lower, self.in_lower)].map(|(joint, local)| {
                let segment = mean_in_joint(motion, joint, |frame| frame.direction(joint));
                (
                    joint,
                    aligning(segment, canonical_direction(joint), local, axis),
                )
            });
        let is_near = |&(joint, turned): &(Joint, Quat)| {
            most_change.is_infinite() || rest[joint.index()].angle_between(turned) < most_change
        };
        if turned.iter().all(is_near) {
            for (joint, turned) in turned {
                rest[joint.index()] = turned;
            }
        }
    }
}
