//! The ankle of a placed foot: it bends no further than ankles do, so that heels rise before knees go on over the toes, and swinging feet hang.

use super::{Foot, Mode};
use crate::leg::{FootTarget, Leg};
use crate::rocker::foot_attitude;
use footfall_core::ease::smooth_step;
use glam::{Quat, Vec3};

/// Greatest flexion of the ankle of a standing foot and of a swinging one, toes towards the shin, unless the animation bends it further, radians; and
/// the time in which a foot that has left the ground comes from one to the other, seconds.
const STANDING_FLEXION: f32 = 0.5;
const HANGING_FLEXION: f32 = 0.35;
const RELAX_SECS: f32 = 0.15;
/// Excess over which a swinging foot begins to hang, radians.
const SOFT_EXCESS: f32 = 0.1;
/// Times before its landing at which a hanging foot begins to come up to its landing's pitch, and has, seconds.
const HANG_SECS: [f32; 2] = [0.17, 0.04];

/// A leg from its hip joint down, and the flexion that its ankle has in the animation.
pub(in crate::placement) struct Ankle<'a> {
    leg: &'a Leg,
    hip: Vec3,
    animated: f32,
}

impl<'a> Ankle<'a> {
    /// The ankle of a leg below a hip joint, which is at `animated_hip` in the animation.
    pub(in crate::placement) fn below(
        leg: &'a Leg,
        hip: Vec3,
        animated: &FootTarget,
        animated_hip: Vec3,
    ) -> Self {
        let in_animation = Self {
            leg,
            hip: animated_hip,
            animated: 0.0,
        };
        Self {
            leg,
            hip,
            animated: in_animation.flexion(animated),
        }
    }

    /// Flexion of a standing foot's ankle beyond what is allowed, radians.
    pub(in crate::placement) fn excess(&self, foot: &FootTarget) -> f32 {
        self.flexion(foot) - STANDING_FLEXION.max(self.animated)
    }

    /// Flexion of the ankle, toes towards the shin, radians.
    fn flexion(&self, foot: &FootTarget) -> f32 {
        let [lean, pitch] = self.lean_and_pitch(foot);
        lean - pitch
    }

    /// Angle from upright by which the shank leans over the toes, and the pitch of the foot, radians.
    fn lean_and_pitch(&self, foot: &FootTarget) -> [f32; 2] {
        let (heading, pitch) = foot_attitude(foot.foot);
        let (x, z) = heading.sin_cos();
        let forward = Vec3::new(x, 0.0, z);
        [self.leg.shank_lean(self.hip - foot.ankle, forward), pitch]
    }
}

impl Foot {
    /// Takes note of the pitch from which the foot has to hang in the next frame, should it swing.
    pub(in crate::placement) fn note_lean(&mut self, ankle: &Ankle<'_>, target: &FootTarget) {
        let relaxed = if self.mode == Mode::Locked {
            0.0
        } else {
            smooth_step(self.swing_secs / RELAX_SECS)
        };
        let most = STANDING_FLEXION + relaxed * (HANGING_FLEXION - STANDING_FLEXION);
        let [lean, _] = ankle.lean_and_pitch(target);
        self.hangs_from = lean - most.max(ankle.animated);
    }

    /// Lowers the toes of a swinging foot as its ankle gives way, this share of it and this long before its landing.
    pub(in crate::placement) fn hang(&self, share: f32, secs: f32, foot: &mut FootTarget) {
        let shown = self.residual.apply(foot);
        let (_, pitch) = foot_attitude(shown.foot);
        let excess = (self.hangs_from - pitch).max(0.0);
        let [from, until] = HANG_SECS;
        let share = share * smooth_step((secs - until) / (from - until));
        let turn = Quat::from_rotation_x(share * excess * excess / (excess + SOFT_EXCESS));
        foot.foot = (foot.foot * turn).normalize();
        foot.toes = (foot.toes * turn).normalize();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use footfall_core::rotation::exp_map;
    use footfall_core::{ModelPose, Pose, Side, Skeleton};

    #[test]
    fn an_ankle_is_as_bent_as_in_the_pose_whatever_its_leg_does() {
        let skeleton = Skeleton::standard();
        for (hip, knee, bent) in [(0.3, 0.6, 0.0), (0.9, 1.7, 0.8), (-0.2, 0.1, -0.4)] {
            for side in Side::BOTH {
                let mut pose = Pose::rest(&skeleton);
                let turns = [
                    (side.upper_leg(), -hip),
                    (side.lower_leg(), knee),
                    (side.foot(), -bent),
                ];
                for (joint, angle) in turns {
                    pose.rotations[joint.index()] = exp_map(Vec3::X * angle);
                }
                let model = ModelPose::of(&skeleton, &pose);
                let leg = Leg::new(&skeleton, side);
                let (at, foot) = (model.position(side.upper_leg()), leg.foot_of(&pose));
                let ankle = Ankle::below(&leg, at, &foot, at);
                assert!((ankle.animated - bent).abs() < 0.02, "{}", ankle.animated);
                let excess = (bent - STANDING_FLEXION).min(0.0);
                assert!((ankle.excess(&foot) - excess).abs() < 0.02);
            }
        }
    }
}
