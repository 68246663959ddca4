//! Height of the hips in a walk: the standing leg keeps the length that was generated for it.
//!
//! The travel of the hips is evened, and a planted foot does not creep as captured ones do, so the direction of the standing leg differs from the generated
//! one. Its length is visible as the bend of the knee. Therefore this length determines the height of the hips, which approach the height of the landing leg by
//! the end of the step. Steps to the side and backwards keep the direction of the leg, too. A leg that is too short for that raises its heel (`heel_rise.rs`).

use super::frame::PlantedFrame;
use super::generated::GeneratedFrame;
use super::planter::Planter;
use crate::plan::StepTiming;
use footfall_core::ease::{settled, smooth_step};
use glam::Vec3Swizzles as _;

/// Least share of a leg's squared length that is left of it from the side.
const LEAST_HEIGHT: f32 = 0.25;

/// Part of a step from which on the hips come to the height of the leg that lands.
pub(super) const MEETING_FROM: f32 = 0.15;

impl Planter {
    /// Moves the hips in every frame of a walked step to the height at which the standing leg has its generated length.
    pub(super) fn keep_lengths(
        &self,
        generated: &[GeneratedFrame],
        timing: &StepTiming,
        out: &mut [PlantedFrame],
    ) {
        let height = |index: usize| height_by_length(&generated[index], timing, &out[index]);
        let [start, follow, last] = [0, 1, timing.frames].map(height);
        let offset = self.state.hips.y - start;
        let velocity = self.state.hips_velocity.map_or(0.0, |velocity| {
            velocity.y * self.frame_secs - (follow - start)
        });
        let decay = self.frame_secs / self.settle_secs();
        let rise = self.landing_height(&generated[timing.frames], timing.leading.other()) - last;
        for (index, (generated, frame)) in generated
            .iter()
            .zip(out)
            .take(timing.frames + 1)
            .enumerate()
        {
            let time = index as f32;
            let part = (time / timing.frames as f32 - MEETING_FROM) / (1.0 - MEETING_FROM);
            let (settling, _) = settled(offset, velocity, decay, time);
            frame.pose.root_position.y =
                height_by_length(generated, timing, frame) + smooth_step(part) * rise + settling;
        }
    }
}

/// Height of the hips at which the standing leg has its generated length.
fn height_by_length(generated: &GeneratedFrame, timing: &StepTiming, frame: &PlantedFrame) -> f32 {
    let leg = &generated.legs[timing.leading.index()];
    let hip = frame.level * leg.hip;
    let squared = leg.ankle.distance_squared(leg.hip);
    let over = (frame.pose.root_position + hip - leg.target.ankle).xz();
    let height = (squared - over.length_squared()).max(LEAST_HEIGHT * squared);
    leg.target.ankle.y + height.sqrt() - hip.y
}
