//! Turning: feet keep clear of each other.
//!
//! Generated feet land nearly in one line, as those of a walk straight ahead. Under a body that turns, one would be put across the other. Therefore the legs are spread and the toes
//! turned out: on the spot as people's are, and less the longer the steps are, for then the feet are hardly ever side by side.

use super::course::Course;
use super::generated::GeneratedFrame;
use super::planter::Planter;
use super::planter_state::PlanterState;
use crate::plan::StepTiming;
use footfall_core::Side;
use footfall_core::ease::smooth_step;
use glam::Vec2;

/// Outward shift of each foot on the spot, as a share of the leg's length, and the turn rate from which it is complete, rad/s.
const SPOT_SHARE: f32 = 0.055;
const SPOT_RADPS: f32 = 0.6;

/// The same in steps as long as a walk's, and the turn rates from which it begins and at which it is complete, rad/s.
const WALK_SHARE: f32 = 0.03;
const WALK_RADPS: [f32; 2] = [0.4, 1.4];

/// Share of a step's turn by which a foot points outwards on the spot, and the largest such turn, radians.
const TOES_OUT: f32 = 0.3;
const MOST_TOES_OUT: f32 = 0.27;

impl Planter {
    /// Spreads the legs of a step that ends with this turn rate.
    pub(crate) fn spread_turning(
        &self,
        generated: &mut [GeneratedFrame],
        timing: &StepTiming,
        turn_rate: f32,
    ) {
        let begins = self.state.spread;
        let ends = spread(&PlanterState {
            turn_rate,
            ..self.state
        });
        if begins.max(ends) <= 0.0 {
            return;
        }
        for (index, frame) in generated.iter_mut().enumerate() {
            let s = index as f32 / timing.frames as f32;
            let share = begins + smooth_step(s) * (ends - begins);
            for side in Side::BOTH {
                let shift = share * self.leg_lengths[side.index()];
                frame.legs[side.index()].shift(side.sign() * shift * Vec2::X);
            }
        }
    }

    /// Returns the outward turn of a landing foot, radians, positive to the left.
    pub(super) fn toes_out(&self, side: Side, course: Course) -> f32 {
        let turn = (course.turn_rate * course.step_secs).abs();
        let out = (TOES_OUT * turn).min(MOST_TOES_OUT);
        side.sign() * on_the_spot(self.state.stride) * out
    }
}

/// Returns the outward shift of each foot at the end of a step, as a share of the leg's length.
pub(crate) fn spread(state: &PlanterState) -> f32 {
    let rate = state.turn_rate.abs();
    let [from, to] = WALK_RADPS;
    let walking = WALK_SHARE * ((rate - from) / (to - from)).clamp(0.0, 1.0);
    let spot = SPOT_SHARE * smooth_step(rate / SPOT_RADPS);
    let share = walking + on_the_spot(state.stride) * (spot - walking);
    share * state.strafe.uprightness()
}

/// Returns the likeness of steps of this reach to steps on the spot.
pub(super) fn on_the_spot(stride: f32) -> f32 {
    1.0 - smooth_step(stride)
}
