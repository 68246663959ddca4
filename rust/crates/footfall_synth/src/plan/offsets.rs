//! Offsets from a model's average step.

use super::statistics::{Part, Statistics};
use super::step_draw::MAX_COMPONENTS;
use crate::rows::Sum;
use core::ops::Range;
use footfall_core::Side;
use footfall_model::StepOffset;

/// Maximum number of offsets of a step: those of speed, position, walker and the step itself.
const MAX_OFFSETS: usize = 2 + 2 * MAX_COMPONENTS;

/// A weighted sum of offsets, evaluated in parts on demand.
pub(super) struct Offsets<'a> {
    parts: [(Part, &'a StepOffset, f64); MAX_OFFSETS],
    len: usize,
}

impl<'a> Offsets<'a> {
    /// A sum that begins with this offset.
    pub(super) fn of(part: Part, offset: &'a StepOffset, weight: f64) -> Self {
        Self {
            parts: [(part, offset, weight); MAX_OFFSETS],
            len: 1,
        }
    }

    pub(super) fn add(&mut self, part: Part, offset: &'a StepOffset, weight: f64) {
        self.parts[self.len] = (part, offset, weight);
        self.len += 1;
    }

    fn parts(&self) -> &[(Part, &'a StepOffset, f64)] {
        &self.parts[..self.len]
    }

    /// Writes means of a step with their offsets.
    pub(super) fn add_means<R: Sum>(
        &self,
        statistics: &Statistics<R>,
        side: Side,
        within: Range<usize>,
        means: &mut [R],
    ) {
        let row = |part: Part| statistics.means(side, part, within.clone());
        let means = &mut means[within.clone()];
        means.copy_from_slice(row(Part::Average));
        // Four offsets at a time: each pass over the means costs as much as the sums themselves.
        for parts in self.parts().chunks(4) {
            let part = |index: usize| match parts.get(index) {
                Some((part, _, weight)) => (row(*part), R::narrow(*weight)),
                None => (row(Part::Average), R::default()),
            };
            R::add_rows(means, [part(0), part(1), part(2), part(3)]);
        }
    }

    pub(super) fn log_duration(&self, state: usize) -> f64 {
        let parts = self.parts().iter();
        parts
            .map(|(_, offset, weight)| weight * offset.log_durations[state])
            .sum()
    }

    pub(super) fn other_terminal(&self) -> f64 {
        let parts = self.parts().iter();
        parts
            .map(|(_, offset, weight)| weight * offset.other_terminal)
            .sum()
    }
}
