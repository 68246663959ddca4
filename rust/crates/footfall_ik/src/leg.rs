//! Two-bone leg: hip joint, knee, ankle.

mod knee;
mod target;

use footfall_core::lanes::{LANES, Quatx8, Vec3x8, f32x8};
use footfall_core::{Joint, ModelPose, Pose, Side, Skeleton};
use glam::{Quat, Vec3};
use knee::{Angle, knee_hinge};
pub use target::{FootTarget, FootTargetx8};

/// Largest share of the straight leg that the solver uses: the knee of a completely straight leg snaps.
const MAX_EXTENSION: f32 = 0.9995;

/// One leg of a body, with the measures that its solution needs.
#[derive(Clone, Copy, Debug)]
pub struct Leg {
    side: Side,
    hip_from_hips: Vec3,
    thigh_axis: Vec3,
    shank_axis: Vec3,
    thigh: f32,
    shank: f32,
}

/// Solution of a leg: positions and rotations of its joints.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LegSolution {
    /// Position of the hip joint in model space, metres.
    pub hip: Vec3,
    /// `model_from_thigh` rotation.
    pub thigh: Quat,
    /// `model_from_shank` rotation.
    pub shank: Quat,
    /// Resulting position of the ankle, metres.
    pub ankle: Vec3,
}

impl Leg {
    /// One leg of a body.
    pub fn new(skeleton: &Skeleton, side: Side) -> Self {
        let thigh_axis = skeleton.offset(side.lower_leg());
        let shank_axis = skeleton.offset(side.foot());
        Self {
            side,
            hip_from_hips: skeleton.offset(side.upper_leg()),
            thigh_axis,
            shank_axis,
            thigh: thigh_axis.length(),
            shank: shank_axis.length(),
        }
    }

    /// Place and rotations of the foot in a pose.
    pub fn foot_of(&self, pose: &Pose) -> FootTarget {
        let hips = pose.rotation(Joint::Hips);
        let thigh = hips * pose.rotation(self.side.upper_leg());
        let shank = thigh * pose.rotation(self.side.lower_leg());
        let foot = shank * pose.rotation(self.side.foot());
        let hip = hips * self.hip_from_hips;
        FootTarget {
            ankle: pose.root_position + hip + self.ankle_from_hip(thigh, shank),
            foot,
            toes: foot * pose.rotation(self.side.toes()),
        }
    }

    /// Vector from the hip joint to the ankle of a leg with these rotations in model space, metres.
    pub fn ankle_from_hip(&self, thigh: Quat, shank: Quat) -> Vec3 {
        thigh * self.thigh_axis + shank * self.shank_axis
    }

    /// Angle from upright by which the shank leans to a horizontal direction, knee first, when the hip joint is `to_hip` from the ankle, radians.
    pub(crate) fn shank_lean(&self, to_hip: Vec3, forward: Vec3) -> f32 {
        let distance = to_hip.length();
        let squares = distance * distance + self.shank * self.shank - self.thigh * self.thigh;
        let between = squares / (2.0 * self.shank * distance.max(f32::MIN_POSITIVE));
        to_hip.dot(forward).atan2(to_hip.y) + between.clamp(-1.0, 1.0).acos()
    }

    /// Rotates thigh, shank, foot and toes of a pose so that the foot meets its target. `hips_rotation` is the hips' in
    /// model space.
    ///
    /// The knee stays in the plane in which the pose bends it. If the target is out of reach, the leg stretches towards
    /// it and the ankle falls short.
    pub fn solve(
        &self,
        hips: Vec3,
        hips_rotation: Quat,
        target: &FootTarget,
        pose: &mut Pose,
    ) -> LegSolution {
        let of_pose = |joint: Joint| Quatx8::splat(pose.rotation(joint));
        let solved = self.solve_lanes(&Task {
            hips: Vec3x8::splat(hips),
            hips_rotation: Quatx8::splat(hips_rotation),
            thigh: of_pose(self.side.upper_leg()),
            shank: of_pose(self.side.lower_leg()),
            target: FootTargetx8::splat(target),
        });
        for (joint, rotations) in self.joints().into_iter().zip(&solved.local) {
            pose.rotations[joint.index()] = rotations.lane(0);
        }
        let (hip, thigh, shank) = (
            solved.hip.lane(0),
            solved.thigh.lane(0),
            solved.shank.lane(0),
        );
        LegSolution {
            hip,
            thigh,
            shank,
            ankle: hip + self.ankle_from_hip(thigh, shank),
        }
    }

    /// As [`solve`](Self::solve) for the poses of many frames, whose hips stay as they are; `target` of a frame's index is where the foot
    /// has to be. Works on eight frames at a time.
    pub fn solve_many<'a, F: AsRef<Pose> + AsMut<Pose>>(
        &self,
        frames: &mut [F],
        target: impl Fn(usize) -> &'a FootTarget,
    ) {
        for (block, frames) in frames.chunks_mut(LANES).enumerate() {
            // What is short of eight frames is filled with the last.
            let within = |lane: usize| lane.min(frames.len() - 1);
            let target = |lane: usize| target(block * LANES + within(lane));
            let of_poses =
                |joint: Joint| Quatx8::gather(|lane| frames[within(lane)].as_ref().rotation(joint));
            let solved = self.solve_lanes(&Task {
                hips: Vec3x8::gather(|lane| frames[within(lane)].as_ref().root_position),
                hips_rotation: of_poses(Joint::Hips),
                thigh: of_poses(self.side.upper_leg()),
                shank: of_poses(self.side.lower_leg()),
                target: FootTargetx8 {
                    ankle: Vec3x8::gather(|lane| target(lane).ankle),
                    foot: Quatx8::gather(|lane| target(lane).foot),
                    toes: Quatx8::gather(|lane| target(lane).toes),
                },
            });
            for (joint, rotations) in self.joints().into_iter().zip(&solved.local) {
                for (frame, rotation) in frames.iter_mut().zip(rotations.lanes()) {
                    frame.as_mut().rotations[joint.index()] = rotation;
                }
            }
        }
    }

    /// The joints that are turned, from the hip down.
    const fn joints(&self) -> [Joint; 4] {
        let side = self.side;
        [side.upper_leg(), side.lower_leg(), side.foot(), side.toes()]
    }

    /// Turns legs so that their feet are where they have to be.
    fn solve_lanes(&self, task: &Task) -> Turned {
        let hip = task.hips + task.hips_rotation * Vec3x8::splat(self.hip_from_hips);
        let to_ankle = task.target.ankle - hip;
        let (least, most) = (
            (self.thigh - self.shank).abs() + 1e-4,
            MAX_EXTENSION * (self.thigh + self.shank),
        );
        let reach = to_ankle.length();
        let reach = reach
            .fast_max(f32x8::splat(least))
            .fast_min(f32x8::splat(most));

        // Bend the knee to the right length about the axis that it bends about in the pose.
        let thigh = task.hips_rotation * task.thigh;
        let shank = thigh * task.shank;
        let [thigh_axis, shank_axis] = [self.thigh_axis, self.shank_axis].map(Vec3x8::splat);
        let bent_thigh = thigh * thigh_axis;
        let bent_shank = shank * shank_axis;
        let across = bent_thigh.cross(bent_shank);
        let hinge = knee_hinge(
            bent_thigh * f32x8::splat(self.thigh.recip()),
            across * f32x8::splat((self.thigh * self.shank).recip()),
            thigh,
        );
        let current = Angle {
            cosine: bent_thigh.dot(bent_shank),
            sine: across.dot(hinge),
        };
        let bend = Angle::between(self.thigh, self.shank, reach);
        let shank = bend.less(current.normalize()).about(hinge) * shank;

        // Then aim hip-to-ankle at the target.
        let aim = Quatx8::shortest_arc(bent_thigh + shank * shank_axis, to_ankle);
        // Products of unit quaternions are unit quaternions, to within what a pose is rounded to anyway.
        let (thigh, shank) = (aim * thigh, aim * shank);
        let FootTargetx8 { foot, toes, .. } = task.target;
        Turned {
            hip,
            thigh,
            shank,
            local: [
                task.hips_rotation.conjugate() * thigh,
                thigh.conjugate() * shank,
                shank.conjugate() * foot,
                foot.conjugate() * toes,
            ],
        }
    }
}

/// Eight legs of which the ankle has to be elsewhere.
struct Task {
    hips: Vec3x8,
    hips_rotation: Quatx8,
    /// Local rotations of the pose.
    thigh: Quatx8,
    shank: Quatx8,
    target: FootTargetx8,
}

/// The same legs in the end.
struct Turned {
    /// In model space.
    hip: Vec3x8,
    thigh: Quatx8,
    shank: Quatx8,
    /// Local rotations from thigh to toes.
    local: [Quatx8; 4],
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

#[cfg(test)]
mod tests {
    use super::*;
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
                let mut model = ModelPose::of(&skeleton, &pose);
                let target = FootTarget {
                    ankle: Vec3::new(0.09 * side.sign() + x, 0.12 + y, z),
                    foot: Quat::from_rotation_x(pitch),
                    toes: Quat::from_rotation_x(0.5 * pitch),
                };
                let hip = model.position(side.upper_leg());
                prop_assume!(hip.distance(target.ankle) < 0.83);
                let missed = solve_leg(&skeleton, side, &target, &mut pose, &mut model);
                prop_assert!(missed < 1e-4, "missed by {missed}");
                let check = ModelPose::of(&skeleton, &pose);
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
    fn legs_of_many_frames_are_those_of_each() {
        let leg = Leg::new(&Skeleton::standard(), Side::Right);
        // A block of eight and one that is not full.
        let mut frames: Vec<Pose> = (0..11)
            .map(|frame| {
                let mut pose = crouched(0.1 * frame as f32, 0.02 * frame as f32);
                pose.root_position.x = 0.03 * frame as f32;
                pose.rotations[0] = exp_map(Vec3::new(0.1, 0.3 * frame as f32, -0.1));
                pose
            })
            .collect();
        let targets: Vec<FootTarget> = (0..11)
            .map(|frame| FootTarget {
                ankle: Vec3::new(0.02 * frame as f32, 0.2, 0.05 * frame as f32 - 0.3),
                foot: Quat::from_rotation_x(0.1 * frame as f32),
                toes: Quat::from_rotation_x(0.05 * frame as f32),
            })
            .collect();
        let mut each = frames.clone();
        for (pose, target) in each.iter_mut().zip(&targets) {
            leg.solve(pose.root_position, pose.rotations[0], target, pose);
        }
        leg.solve_many(&mut frames, |frame| &targets[frame]);
        assert_eq!(frames, each);
    }

    #[test]
    fn a_met_target_changes_nothing() {
        let skeleton = Skeleton::standard();
        let mut pose = crouched(0.6, 0.1);
        let before = pose.clone();
        let mut model = ModelPose::of(&skeleton, &pose);
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
        let mut model = ModelPose::of(&skeleton, &pose);
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
