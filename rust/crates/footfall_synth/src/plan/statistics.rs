//! Statistics of a model, in the precision in which trajectories are solved.

use core::ops::Range;
use footfall_core::Side;
use footfall_model::{FEATURE_COUNT, GaitModel, OBSERVATION_COUNT, STATES_PER_STEP, StepOffset};
use footfall_prob::mlpg::Real;
use footfall_prob::windows::Windows;

/// Bound below zero of the pull that restores variance, as a fraction of the least static precision: beyond 1
/// a trajectory need not be determined.
const MAX_PUSH: f64 = 0.9;

/// Means of all states of a step.
pub(crate) const STEP_MEANS: usize = STATES_PER_STEP * OBSERVATION_COUNT;

/// Terms whose sum is the means of a step.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Part {
    /// The model's own.
    Average,
    /// Change with the speed.
    Speed,
    /// A component in which walkers differ.
    Walker(usize),
    /// A component in which steps differ.
    Step(usize),
    /// Position in the walk: its index among the model's contexts.
    Context(usize),
}

/// Means, precisions and pull of a model.
#[derive(Clone, Debug)]
pub(crate) struct Statistics<R> {
    pub(crate) windows: Windows,
    /// Per side, the precisions of the five states.
    pub(crate) precisions: [Vec<R>; 2],
    pub(crate) pull_strength: Vec<R>,
    /// Per side, rows of [`STEP_MEANS`] in the order of [`Part`].
    means: [Vec<R>; 2],
    walker_components: usize,
    step_components: usize,
}

impl<R: Real> Statistics<R> {
    /// Collects the statistics of a model, without pull.
    pub(crate) fn new(model: &GaitModel) -> Self {
        let narrow = |value: &f64| R::narrow(*value);
        let precisions = Side::BOTH.map(|side| {
            let states = &model.step(side).states;
            let variances = states.iter().flat_map(|state| &state.variance);
            variances
                .map(|variance| narrow(&variance.recip()))
                .collect()
        });
        let variation = &model.variation;
        let means = Side::BOTH.map(|side| {
            let index = side.index();
            let states = model.step(side).states.iter();
            let components = variation.walker.iter().chain(&variation.step);
            let offsets = core::iter::once(&model.speed.slopes[index])
                .chain(components.map(|component| &component[index]))
                .chain(model.contexts.iter().map(|context| &context.offset));
            states
                .flat_map(|state| &state.mean)
                .chain(offsets.flat_map(|offset: &StepOffset| &offset.means))
                .map(narrow)
                .collect()
        });
        Self {
            windows: model.windows,
            precisions,
            pull_strength: vec![R::default(); FEATURE_COUNT],
            means,
            walker_components: variation.walker.len(),
            step_components: variation.step.len(),
        }
    }

    /// Sets the strength of the pull that preserves variance. It acts about the mean of the planned steps.
    pub(crate) fn set_pull(&mut self, strength: &[f64]) {
        let mut least = vec![f64::INFINITY; FEATURE_COUNT];
        let states = self.precisions.iter();
        for state in states.flat_map(|side| side.chunks_exact(OBSERVATION_COUNT)) {
            for (least, precision) in least.iter_mut().zip(state) {
                *least = least.min(precision.widen());
            }
        }
        for (dim, pull) in self.pull_strength.iter_mut().enumerate() {
            *pull = R::narrow(strength[dim].max(-MAX_PUSH * least[dim]));
        }
    }

    /// Returns a range of the means of one part, for a step that begins with this foot.
    pub(crate) fn means(&self, side: Side, part: Part, within: Range<usize>) -> &[R] {
        let row = match part {
            Part::Average => 0,
            Part::Speed => 1,
            Part::Walker(component) => 2 + component,
            Part::Step(component) => 2 + self.walker_components + component,
            Part::Context(index) => 2 + self.walker_components + self.step_components + index,
        };
        &self.means[side.index()][row * STEP_MEANS..][within]
    }
}
