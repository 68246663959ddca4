//! Two-bone leg: hip joint, knee, ankle.

use footfall_core::rotation::shortest_arc;
use footfall_core::{Joint, ModelPose, Pose, Side, Skeleton};
use glam::{Quat, Vec2, Vec3, Vec3A};

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

/// One leg of a body, with what its solution needs of the skeleton.
#[derive(Clone, Copy, Debug)]
pub struct Leg {
    side: Side,
    hip_from_hips: Vec3A,
    thigh_axis: Vec3A,
    shank_axis: Vec3A,
    thigh: f32,
    shank: f32,
}

/// What a leg does to meet its target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LegSolution {
    /// Position of the hip joint in model space, metres.
    pub hip: Vec3,
    /// `model_from_thigh` rotation.
    pub thigh: Quat,
    /// `model_from_shank` rotation.
    pub shank: Quat,
    /// Where the ankle is in the end, metres.
    pub ankle: Vec3,
}

impl Leg {
    /// One leg of a body.
    pub fn new(skeleton: &Skeleton, side: Side) -> Self {
        let thigh_axis = skeleton.offset(side.lower_leg());
        let shank_axis = skeleton.offset(side.foot());
        Self {
            side,
            hip_from_hips: skeleton.offset(side.upper_leg()).into(),
            thigh_axis: thigh_axis.into(),
            shank_axis: shank_axis.into(),
            thigh: thigh_axis.length(),
            shank: shank_axis.length(),
        }
    }

    /// The way from the hip joint to the ankle of a leg that is turned so in model space, metres.
    pub fn ankle_from_hip(&self, thigh: Quat, shank: Quat) -> Vec3 {
        (thigh * self.thigh_axis + shank * self.shank_axis).into()
    }

    /// Turns thigh, shank, foot and toes of a pose so that the foot meets its target. `hips_rotation` is the hips' in
    /// model space.
    ///
    /// The knee stays in the plane in which the pose already bends it. Out of reach, the leg is stretched towards the
    /// target and the ankle falls short.
    pub fn solve(
        &self,
        hips: Vec3,
        hips_rotation: Quat,
        target: &FootTarget,
        pose: &mut Pose,
    ) -> LegSolution {
        let side = self.side;
        let (hip_joint, knee_joint) = (side.upper_leg().index(), side.lower_leg().index());
        let hip = Vec3A::from(hips) + hips_rotation * self.hip_from_hips;
        let to_ankle = Vec3A::from(target.ankle) - hip;
        let reach = to_ankle.length().clamp(
            (self.thigh - self.shank).abs() + 1e-4,
            MAX_EXTENSION * (self.thigh + self.shank),
        );

        // Bend the knee to the right length about the axis that it bends about in the pose.
        let thigh = hips_rotation * pose.rotations[hip_joint];
        let shank = thigh * pose.rotations[knee_joint];
        let bent_thigh = thigh * self.thigh_axis;
        let bent_shank = shank * self.shank_axis;
        let lengths = self.thigh * self.shank;
        let across = bent_thigh.cross(bent_shank);
        let hinge = knee_hinge(bent_thigh / self.thigh, across / lengths, thigh);
        let current = Vec2::new(bent_thigh.dot(bent_shank), across.dot(hinge));
        let bend = bend_between(self.thigh, self.shank, reach);
        let change = bend.rotate(Vec2::new(current.x, -current.y).normalize_or(Vec2::X));
        let shank = turn(hinge, change) * shank;

        // Then aim hip-to-ankle at the target.
        let reached = bent_thigh + shank * self.shank_axis;
        let aim = shortest_arc(reached.into(), to_ankle.into());
        let (thigh, shank) = (aim * thigh, aim * shank);

        // Products of unit quaternions are unit quaternions, to within what a pose is rounded to anyway.
        pose.rotations[hip_joint] = hips_rotation.conjugate() * thigh;
        pose.rotations[knee_joint] = thigh.conjugate() * shank;
        pose.rotations[side.foot().index()] = shank.conjugate() * target.foot;
        pose.rotations[side.toes().index()] = target.foot.conjugate() * target.toes;
        LegSolution {
            hip: hip.into(),
            thigh,
            shank,
            ankle: (hip + thigh * self.thigh_axis + shank * self.shank_axis).into(),
        }
    }
}

/// [`Leg::solve`] that also updates `model` for the leg's joints. `model` must hold the pose's forward kinematics at least
/// for the hips. Returns the distance by which the ankle falls short, metres.
pub fn solve_leg(
    skeleton: &Skeleton,
    side: Side,
    target: &FootTarget,
    pose: &mut Pose,
    model: &mut ModelPose,
) -> f32 {
    let leg = Leg::new(skeleton, side);
    let (hips, hips_rotation) = (model.position(Joint::Hips), model.rotation(Joint::Hips));
    let solution = leg.solve(hips, hips_rotation, target, pose);
    let knee = solution.hip + solution.thigh * skeleton.offset(side.lower_leg());
    let toes = solution.ankle + target.foot * skeleton.offset(side.toes());
    let joints = [
        (side.upper_leg(), solution.hip, solution.thigh),
        (side.lower_leg(), knee, solution.shank),
        (side.foot(), solution.ankle, target.foot),
        (side.toes(), toes, target.toes),
    ];
    for (joint, position, rotation) in joints {
        model.positions[joint.index()] = position;
        model.rotations[joint.index()] = rotation;
    }
    solution.ankle.distance(target.ankle)
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
/// `thigh` is the thigh's direction and `bent` its cross product with the shank's. A nearly straight leg has no plane of
/// its own; the thigh's own x axis (the left of a leg in the T-pose) takes over smoothly.
fn knee_hinge(thigh: Vec3A, bent: Vec3A, thigh_rotation: Quat) -> Vec3A {
    let anatomical = thigh_rotation * Vec3A::X;
    // A hyperextended knee must not be taken for one that bends forwards.
    let bent = bent - anatomical * bent.dot(anatomical).min(0.0);
    // Below about 6 degrees of bend the plane is mostly noise.
    let blended = bent + anatomical * 0.1 * (1.0 - bent.length() / 0.1).max(0.0);
    let across = blended - thigh * blended.dot(thigh);
    across.try_normalize().unwrap_or(anatomical)
}

/// Cosine and sine of the knee's bend (0 when straight) in a triangle with these two sides and the opposite third.
fn bend_between(thigh: f32, shank: f32, opposite: f32) -> Vec2 {
    let cosine = (opposite * opposite - thigh * thigh - shank * shank) / (2.0 * thigh * shank);
    let cosine = cosine.clamp(-1.0, 1.0);
    Vec2::new(cosine, (1.0 - cosine * cosine).sqrt())
}

/// The rotation about a unit axis by an angle of which cosine and sine are given.
fn turn(axis: Vec3A, angle: Vec2) -> Quat {
    let cosine = (0.5 + 0.5 * angle.x).max(0.0).sqrt();
    // The sine of half an angle from its own side of the formula that keeps its digits.
    let sine = if cosine > 0.5 {
        0.5 * angle.y / cosine
    } else {
        (0.5 - 0.5 * angle.x).max(0.0).sqrt().copysign(angle.y)
    };
    Quat::from_vec4(Vec3::from(axis * sine).extend(cosine))
}

#[cfg(test)]
mod tests {
    use super::*;
    use footfall_core::forward_kinematics;
    use footfall_core::rotation::exp_map;
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
