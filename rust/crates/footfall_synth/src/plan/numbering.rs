//! Draws of steps by their numbers: the same walker draws the same step on any machine.

use super::planner::Planner;
use super::step_draw::StepDraw;
use footfall_core::Side;

/// Mask of the count of strides, which wraps.
const STRIDES: u32 = 0x7fff;

/// Maximum number of strides drawn to reach a later one; beyond it, and for earlier ones, drawing starts from the seed.
const STRIDES_AHEAD: u32 = 64;

/// Returns the number of the step that this foot's contact begins, in the last of so many drawn strides: even ones begin with the left foot's. It wraps.
pub(crate) fn step_number(strides: u32, leading: Side) -> u16 {
    (strides as u16)
        .wrapping_mul(2)
        .wrapping_sub(u16::from(leading == Side::Right))
}

impl Planner {
    /// Advances chance to the step of this number and returns its draw. Even numbers begin with the left foot's contact. `fresh` makes the walker before its first step.
    pub(crate) fn draw_of(&mut self, number: u16, fresh: impl FnOnce() -> Self) -> StepDraw {
        let stride = u32::from(number / 2);
        let mut ahead = stride.wrapping_sub(self.strides()) & STRIDES;
        if ahead > STRIDES_AHEAD {
            *self = fresh();
            ahead = stride;
        }
        // Only the left foot draws a new stride.
        for _ in 0..ahead {
            self.draw(Side::Left);
        }
        self.draw_again(number)
    }

    /// Returns the draw of the step of this number, of the last drawn stride.
    pub(crate) fn draw_again(&mut self, number: u16) -> StepDraw {
        let side = if number.is_multiple_of(2) {
            Side::Left
        } else {
            Side::Right
        };
        StepDraw {
            side,
            ..self.draw(Side::Right)
        }
    }

    /// Returns true when the step of this number belongs to the stride before the last drawn one.
    pub(crate) fn is_one_ahead_of(&self, number: u16) -> bool {
        self.strides().wrapping_sub(u32::from(number / 2)) & STRIDES == 1
    }
}
