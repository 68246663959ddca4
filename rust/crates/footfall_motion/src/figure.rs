//! A body as tapered capsules, for code that draws motion.

use footfall_core::{Joint, ModelPose, Side, Skeleton};
use glam::Vec3;

/// Half-widths of the limbs on a body whose leg is one metre long, metres: proximal end, distal end.
const THIGH: [f32; 2] = [0.085, 0.055];
const SHANK: [f32; 2] = [0.055, 0.036];
const ARM: [f32; 2] = [0.048, 0.036];
const FOREARM: [f32; 2] = [0.036, 0.026];
const HAND: f32 = 0.036;
const FOOT: [f32; 2] = [0.034, 0.022];
const TRUNK_HALF_WIDTHS: [f32; 2] = [0.095, 0.115];

/// Part of the body that a limb belongs to, for its colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// Hips to head.
    Trunk,
    /// An arm.
    Arm(Side),
    /// A leg.
    Leg(Side),
}

/// A tapered capsule in model space, metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limb {
    /// The two centres.
    pub ends: [Vec3; 2],
    /// The radii around them.
    pub radii: [f32; 2],
    /// Part of the body that it belongs to.
    pub part: Part,
}

/// Heel, ball and toe tip of one foot in model space.
pub fn sole_points(skeleton: &Skeleton, pose: &ModelPose, side: Side) -> [Vec3; 3] {
    let foot = skeleton.foot(side);
    [
        pose.point(side.foot(), foot.heel),
        pose.point(side.toes(), foot.ball),
        pose.point(side.toes(), foot.toe_tip),
    ]
}

/// The limbs of a pose.
pub fn limbs(skeleton: &Skeleton, pose: &ModelPose) -> Vec<Limb> {
    let size = skeleton.mean_leg_length();
    let at = |joint: Joint| pose.position(joint);
    let mut limbs = Vec::with_capacity(24);
    let mut limb = |ends: [Vec3; 2], radii: [f32; 2], part: Part| {
        let radii = radii.map(|radius| radius * size);
        limbs.push(Limb { ends, radii, part });
    };
    let head_top = pose.point(Joint::Head, skeleton.head_top);
    let head_length = at(Joint::Head).distance(head_top);
    let head_radius = (0.55 * head_length / size).clamp(0.05, 0.16);
    let head_centre = at(Joint::Head).lerp(head_top, 0.5);
    let nose = head_centre + pose.rotation(Joint::Head) * Vec3::Z * (head_radius * size);
    let waist = at(Joint::Hips).lerp(at(Joint::Spine), 0.5);
    limb(
        [waist, at(Joint::UpperChest)],
        TRUNK_HALF_WIDTHS,
        Part::Trunk,
    );
    limb(
        [at(Joint::LeftUpperLeg), at(Joint::RightUpperLeg)],
        [0.08, 0.08],
        Part::Trunk,
    );
    limb(
        [at(Joint::LeftUpperArm), at(Joint::RightUpperArm)],
        [0.052, 0.052],
        Part::Trunk,
    );
    limb(
        [at(Joint::Neck), at(Joint::Head)],
        [0.045, 0.045],
        Part::Trunk,
    );
    limb([head_centre, nose], [head_radius, 0.022], Part::Trunk);
    for side in Side::BOTH {
        let shoulder = match side {
            Side::Left => Joint::LeftShoulder,
            Side::Right => Joint::RightShoulder,
        };
        let (arm_part, leg) = (Part::Arm(side), Part::Leg(side));
        let arm = |n: usize| Joint::ALL[shoulder.index() + n];
        limb([at(arm(1)), at(arm(2))], ARM, arm_part);
        limb([at(arm(2)), at(arm(3))], FOREARM, arm_part);
        // The hand has no joint beyond it: it goes on a little along the hand's own arm axis.
        let palm = at(arm(3)) + pose.rotation(arm(3)) * Vec3::X * (side.sign() * 0.08 * size);
        limb([at(arm(3)), palm], [0.8 * HAND, HAND], arm_part);
        limb([at(side.upper_leg()), at(side.lower_leg())], THIGH, leg);
        limb([at(side.lower_leg()), at(side.foot())], SHANK, leg);
        let raise = Vec3::Y * (FOOT[1] * size);
        let [heel, ball, tip] = sole_points(skeleton, pose, side);
        let foot_up = pose.rotation(side.foot()) * raise;
        let toes_up = pose.rotation(side.toes()) * raise;
        limb([at(side.foot()), heel + foot_up], FOOT, leg);
        limb([at(side.foot()), ball + toes_up], FOOT, leg);
        limb([heel + foot_up, ball + toes_up], [FOOT[1]; 2], leg);
        limb([ball + toes_up, tip + toes_up], [FOOT[1]; 2], leg);
    }
    limbs
}
