//! Balance: legs turn under the hips so that, at a landing, both feet are on the ground without bending a knee.
//!
//! Independently generated angles leave one foot a centimetre or two above the other when it lands. Both are put on the ground by turning
//! the legs about the hips, which moves the body over its feet, and not by bending a knee. Where legs keep their lengths, the leg behind raises its heel instead (`hip_height.rs`).

use super::course::Course;
use super::generated::GeneratedFrame;
use super::planter::Planter;
use crate::plan::StepTiming;
use footfall_core::ease::smooth_step;
use glam::{Vec2, Vec3Swizzles as _};

/// Greatest shift of the feet, as a share of the leg's length.
const MOST_SHIFT: f32 = 0.07;

/// Feet that stand closer together than this are hardly levelled by a shift, as a share of the leg's length.
const NEAR: f32 = 0.15;

/// Share of the imbalance that is corrected by the landing: a full correction would sway a walker whose left and right steps differ.
const TAKEN_UP: f32 = 0.5;

impl Planter {
    /// Turns the legs over a step, from the balance at the end of the previous one to that of the landing.
    pub(super) fn balance(
        &mut self,
        generated: &mut [GeneratedFrame],
        timing: &StepTiming,
        course: Course,
    ) {
        let from = self.state.balance;
        let to = match timing.take_off {
            Some(_) => Vec2::ZERO,
            // The leg behind raises its heel instead, and no foot lands too far ahead.
            None if course.keeps_lengths => Vec2::ZERO,
            None => from.lerp(self.balancing(&generated[timing.frames], timing), TAKEN_UP),
        };
        self.state.balance = to;
        if [from, to] == [Vec2::ZERO; 2] {
            return;
        }
        for (index, frame) in generated[..=timing.frames].iter_mut().enumerate() {
            let shift = from.lerp(to, smooth_step(index as f32 / timing.frames as f32));
            for leg in &mut frame.legs {
                leg.shift(shift);
            }
        }
    }

    /// Returns the shift of both feet over the ground at which their legs give the hips the same height.
    fn balancing(&self, landing: &GeneratedFrame, timing: &StepTiming) -> Vec2 {
        let sides = [timing.leading.other(), timing.leading];
        let [ahead, behind] = sides.map(|side| landing.legs[side.index()].ankle);
        let [high, low] = sides.map(|side| self.landing_height(landing, side));
        let length = self.leg_lengths[timing.leading.index()];
        let apart = (ahead - behind).xz();
        let height = -0.5 * (ahead.y + behind.y);
        let near = NEAR * length;
        let forwards = self.state.strafe.uprightness();
        let shift =
            apart * (forwards * (high - low) * height / (apart.length_squared() + near * near));
        shift.clamp_length_max(MOST_SHIFT * length)
    }
}
