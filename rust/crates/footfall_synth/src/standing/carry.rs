//! Sway of a body over feet that stay in place.

use super::sway::Sway;
use footfall_core::ease::soft_min;
use footfall_core::rotation::exp_maps;
use footfall_core::{JOINT_COUNT, Joint, Pose, Side, Skeleton};
use footfall_ik::{FootTarget, Leg, reach_height};
use footfall_model::FEATURE_COUNT;
use glam::{Quat, Vec3};

/// Largest stretch of a leg, beyond which its foot would leave its place.
const MOST_STRETCHED: f32 = 0.9993;

/// Stretch before which the hips of a walking body yield, and the distance over which they do, metres: the leg would snap straight.
const STRETCHED: f32 = 0.998;
const YIELDING_M: f32 = 0.003;

/// Largest tilt of the pelvis when one foot is farther away, radians.
const MOST_TILT: f32 = 0.06;

/// Share of the difference between the legs that the tilt evens out; the leg with less weight bends a little.
const TILT_SHARE: f32 = 0.8;

/// Distance over which the pelvis changes from one leg's reach to the other's, metres.
const REACH_SOFTNESS_M: f32 = 0.001;

/// Legs of one body.
#[derive(Clone, Debug)]
pub(crate) struct Carrier {
    legs: [Leg; 2],
    hip_from_hips: [Vec3; 2],
    lengths: [f32; 2],
    /// Fraction of the straight leg that the leg with more weight uses.
    extension: f32,
}

/// One foot and its hip joint.
struct Foot {
    target: FootTarget,
    /// The hip joint relative to the hips, in the pose's space.
    hip: Vec3,
}

impl Carrier {
    /// Makes the legs of a body whose knees are bent by `knee` radians in standing.
    pub(crate) fn new(skeleton: &Skeleton, knee: f32) -> Self {
        Self {
            extension: (0.5 * knee).cos().min(MOST_STRETCHED),
            legs: Side::BOTH.map(|side| Leg::new(skeleton, side)),
            hip_from_hips: Side::BOTH.map(|side| skeleton.offset(side.upper_leg())),
            lengths: Side::BOTH.map(|side| skeleton.leg_length(side)),
        }
    }

    /// Adds a sway to a pose: joints turn, the hips move over the ground, relative to the rotation `level`, and both feet stay in place. By the share `upright`
    /// (0 to 1) the hips move to the height at which the legs are bent as in standing, and tilt to the side of the farther foot.
    pub(crate) fn carry(&self, sway: &Sway, upright: f32, level: Quat, pose: &mut Pose) {
        let feet = Side::BOTH.map(|side| self.foot(pose, side));
        let mut turns = [Quat::IDENTITY; JOINT_COUNT];
        exp_maps(&sway[..FEATURE_COUNT], &mut turns);
        let upper = Joint::LeftUpperLeg.index();
        for (rotation, turn) in pose.rotations[..upper].iter_mut().zip(turns) {
            *rotation *= turn;
        }
        let leg = 0.5 * (self.lengths[0] + self.lengths[1]);
        let way = leg * Vec3::new(sway[FEATURE_COUNT], 0.0, sway[FEATURE_COUNT + 1]);
        let mut hips = pose.root_position + level * way;
        let mut feet = feet;
        let lacked = self.lacks(pose.root_position, &feet);
        self.hang(pose.rotation(Joint::Hips), &mut feet);
        let tilt = Quat::from_rotation_z(upright * self.tilt(hips, &feet));
        pose.rotations[Joint::Hips.index()] *= tilt;
        let spine = &mut pose.rotations[Joint::Spine.index()];
        *spine = tilt.conjugate() * *spine;
        let hips_rotation = pose.rotation(Joint::Hips);
        self.hang(hips_rotation, &mut feet);
        if let Some(height) = self.reach(hips, &feet) {
            hips.y += upright * (height - hips.y);
        }
        hips.y -= (1.0 - upright) * (self.lacks(hips, &feet) - lacked).max(0.0);
        for side in Side::BOTH {
            if let Some(limit) = self.height(hips, side, &feet[side.index()], MOST_STRETCHED) {
                hips.y = hips.y.min(limit);
            }
        }
        pose.root_position = hips;
        for side in Side::BOTH {
            let target = &feet[side.index()].target;
            self.legs[side.index()].solve(hips, hips_rotation, target, pose);
        }
    }

    /// Returns the distance by which the hips of a body on these feet yield, metres.
    fn lacks(&self, hips: Vec3, feet: &[Foot; 2]) -> f32 {
        Side::BOTH
            .into_iter()
            .filter_map(|side| self.height(hips, side, &feet[side.index()], STRETCHED))
            .map(|limit| hips.y - soft_min(hips.y, limit, YIELDING_M))
            .fold(0.0, f32::max)
    }

    /// Updates the hip joints.
    fn hang(&self, hips: Quat, feet: &mut [Foot; 2]) {
        for (foot, hip) in feet.iter_mut().zip(self.hip_from_hips) {
            foot.hip = hips * hip;
        }
    }

    /// Returns the tilt of the pelvis at which both legs are equally stretched, positive with the left side up, radians.
    fn tilt(&self, hips: Vec3, feet: &[Foot; 2]) -> f32 {
        let [left, right] =
            Side::BOTH.map(|side| self.height(hips, side, &feet[side.index()], self.extension));
        let (Some(left), Some(right)) = (left, right) else {
            return 0.0;
        };
        let apart = self.hip_from_hips[0].distance(self.hip_from_hips[1]);
        let tilt = TILT_SHARE * (left - right) / apart.max(f32::MIN_POSITIVE);
        MOST_TILT * (tilt / MOST_TILT).tanh()
    }

    fn foot(&self, pose: &Pose, side: Side) -> Foot {
        Foot {
            target: self.legs[side.index()].foot_of(pose),
            hip: pose.rotation(Joint::Hips) * self.hip_from_hips[side.index()],
        }
    }

    /// Returns the height of the hips: a smooth minimum of the heights that the legs allow. `None` if no leg reaches its foot.
    fn reach(&self, hips: Vec3, feet: &[Foot; 2]) -> Option<f32> {
        let heights =
            Side::BOTH.map(|side| self.height(hips, side, &feet[side.index()], self.extension));
        match heights {
            [Some(left), Some(right)] => {
                let apart = (left - right).abs() / REACH_SOFTNESS_M;
                Some(left.min(right) - REACH_SOFTNESS_M * (-apart).exp().ln_1p())
            }
            [one, other] => one.or(other),
        }
    }

    fn height(&self, hips: Vec3, side: Side, foot: &Foot, extension: f32) -> Option<f32> {
        let length = self.lengths[side.index()];
        reach_height(hips, foot.hip, foot.target.ankle, length, extension)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use footfall_core::{ModelPose, forward_kinematics};
    use footfall_model::SWAY_COUNT;

    fn standing(skeleton: &Skeleton) -> Pose {
        let mut pose = Pose::rest(skeleton);
        pose.root_position.y -= 0.0012;
        for side in Side::BOTH {
            pose.rotations[side.upper_leg().index()] = Quat::from_rotation_x(-0.05);
            pose.rotations[side.lower_leg().index()] = Quat::from_rotation_x(0.1);
            pose.rotations[side.foot().index()] = Quat::from_rotation_x(-0.05);
        }
        pose
    }

    #[test]
    fn feet_stay_and_knees_hardly_bend() {
        let skeleton = Skeleton::standard();
        let carrier = Carrier::new(&skeleton, 0.1);
        let still = standing(&skeleton);
        let mut before = ModelPose::default();
        forward_kinematics(&skeleton, &still, &mut before);
        for (left, forwards, turn) in [(0.06, 0.0, 0.1), (-0.08, 0.03, 0.0), (0.0, -0.04, -0.2)] {
            let mut sway = [0.0; SWAY_COUNT];
            sway[1] = turn;
            sway[3] = 0.05;
            sway[FEATURE_COUNT] = left;
            sway[FEATURE_COUNT + 1] = forwards;
            for level in [Quat::IDENTITY, Quat::from_rotation_y(0.8)] {
                let mut pose = still.clone();
                carrier.carry(&sway, 1.0, level, &mut pose);
                let mut after = ModelPose::default();
                forward_kinematics(&skeleton, &pose, &mut after);
                for side in Side::BOTH {
                    for joint in [side.foot(), side.toes()] {
                        let moved = after.position(joint).distance(before.position(joint));
                        assert!(moved < 1e-4, "{joint:?} by {moved} m");
                        let turned = after.rotation(joint).angle_between(before.rotation(joint));
                        assert!(turned < 2e-3, "{joint:?} by {turned}");
                    }
                    let knee = pose.rotation(side.lower_leg()).to_scaled_axis().length();
                    assert!(knee < 0.2, "{knee}");
                }
                let way = level.inverse() * (pose.root_position - still.root_position);
                assert!(
                    (way.x - 0.84 * left).abs() < 1e-4 && (way.z - 0.84 * forwards).abs() < 1e-4
                );
            }
        }
    }

    #[test]
    fn a_crouched_body_stands_up() {
        let skeleton = Skeleton::standard();
        let mut pose = standing(&skeleton);
        pose.root_position.y -= 0.03;
        let carrier = Carrier::new(&skeleton, 0.1);
        let feet = Side::BOTH.map(|side| carrier.foot(&standing(&skeleton), side));
        for side in Side::BOTH {
            let (hips, rotation) = (pose.root_position, pose.rotations[0]);
            carrier.legs[side.index()].solve(hips, rotation, &feet[side.index()].target, &mut pose);
        }
        carrier.carry(&[0.0; SWAY_COUNT], 1.0, Quat::IDENTITY, &mut pose);
        for side in Side::BOTH {
            let knee = pose.rotation(side.lower_leg()).to_scaled_axis().length();
            assert!((0.09..0.15).contains(&knee), "{knee}");
        }
    }

    #[test]
    fn no_sway_changes_nothing() {
        let skeleton = Skeleton::standard();
        let mut pose = standing(&skeleton);
        Carrier::new(&skeleton, 0.1).carry(&[0.0; SWAY_COUNT], 0.0, Quat::IDENTITY, &mut pose);
        let still = standing(&skeleton);
        assert!(pose.root_position.distance(still.root_position) < 1e-5);
        for (now, then) in pose.rotations.iter().zip(still.rotations) {
            assert!(now.angle_between(then) < 2e-3);
        }
    }
}
