//! Draws of steps by their numbers: the same walker draws the same step on any machine.

use super::planner::Planner;
use super::step_draw::StepDraw;
use footfall_core::Side;

/// Strides are counted so far; then the count begins anew.
const STRIDES: u32 = 0x7fff;

/// Strides of chance that are drawn one by one to get to a later one; for more, and for earlier ones, chance begins anew.
const STRIDES_AHEAD: u32 = 64;

impl Planner {
    /// Takes chance to where it draws the step of this number; returns that. Even ones begin with the left foot's contact. `fresh` is the walker before its first step.
    pub(crate) fn draw_of(&mut self, number: u16, fresh: impl FnOnce() -> Self) -> StepDraw {
        let stride = u32::from(number / 2);
        let mut ahead = stride.wrapping_sub(self.strides()) & STRIDES;
        if ahead > STRIDES_AHEAD {
            *self = fresh();
            ahead = stride;
        }
        // Every stride begins with the left foot; the right one draws nothing new.
        for _ in 0..ahead {
            self.draw(Side::Left);
        }
        self.draw_again(number)
    }

    /// The step of this number, of the stride that was drawn last.
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

    /// Returns whether a step of this number belongs to the stride before the last one that was drawn.
    pub(crate) fn is_one_ahead_of(&self, number: u16) -> bool {
        self.strides().wrapping_sub(u32::from(number / 2)) & STRIDES == 1
    }
}
