//! The heel of a standing foot, raised so that the leg reaches and the ankle need not bend too far.

use super::{Animated, Foot, Mode, Residual, Scene};
use crate::leg::FootTarget;
use crate::placement::terrain::Terrain;
use crate::rocker::RockerFoot;
use footfall_core::ease::smooth_step;
use glam::Vec3;

/// Greatest pitch of a standing foot with its heel raised, radians, and the number of trials that find the pitch.
pub(in crate::placement) const MAX_PITCH: f32 = 0.95;
const PITCH_TRIALS: usize = 12;
/// Pitch of a raised heel from which the foot no longer rolls onto its heel at all, radians.
const RAISED_PITCH: f32 = 0.15;

impl Foot {
    /// A locked foot with its heel raised until it lacks nothing; at most by [`MAX_PITCH`].
    pub(in crate::placement) fn rise(
        &mut self,
        rocker: &RockerFoot,
        animated: &Animated,
        lacks: impl Fn(&FootTarget) -> f32,
        target: &mut FootTarget,
    ) {
        let pitch = self.on_ball(animated.pitch);
        let highest = self.highest_pitch(pitch);
        if self.mode != Mode::Locked || highest <= pitch || lacks(target) <= 0.0 {
            return;
        }
        let [mut low, mut high] = [pitch, highest];
        for _ in 0..PITCH_TRIALS {
            let middle = 0.5 * (low + high);
            let foot = self.residual.apply(&self.standing(rocker, middle));
            if lacks(&foot) > 0.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
        let risen = self.residual.apply(&self.standing(rocker, high));
        if lacks(&risen) < lacks(target) {
            *target = risen;
            let unlocked = self.correction.apply(&animated.flat, &animated.foot);
            self.at_lock = Residual::of(target, &unlocked);
        }
    }

    /// The ankle of a locked foot at this pitch.
    pub(in crate::placement) fn ankle_at(&self, rocker: &RockerFoot, pitch: f32) -> Vec3 {
        self.residual.apply(&self.standing(rocker, pitch)).ankle
    }

    /// Returns the ankle of a locked foot with its heel as high as it goes; `None` for a foot that stands on nothing, or on its heel.
    pub(in crate::placement) fn highest_ankle<T: Terrain>(
        &self,
        scene: &mut Scene<'_, T>,
        rocker: &RockerFoot,
        pitch: f32,
    ) -> Option<Vec3> {
        let hold = self.hold.filter(|_| pitch >= 0.0)?;
        let sole = scene.sole(&hold)?;
        let risen = Self { sole, ..*self };
        Some(risen.ankle_at(rocker, self.highest_pitch(pitch)))
    }

    /// Returns the greatest pitch to which the heel can rise from a pitch of [`on_ball`](Self::on_ball), radians: that pitch for a foot on its heel.
    pub(in crate::placement) fn highest_pitch(&self, pitch: f32) -> f32 {
        let share = if pitch < 0.0 {
            self.share_raised()
        } else {
            1.0
        };
        pitch + share * (MAX_PITCH - pitch).max(0.0)
    }

    /// Returns the share of a roll onto the heel that a raised heel prevents.
    pub(super) fn share_raised(&self) -> f32 {
        smooth_step(self.raised / RAISED_PITCH)
    }
}
