//! Planning of steps: from chance, speed and manner to durations and means.

use super::fine_draw::FineDraw;
use super::offsets::Offsets;
use super::statistics::{Part, STEP_MEANS, Statistics};
use super::step_draw::{MAX_COMPONENTS, StepDraw};
use super::step_plan::{MAX_STEP_SECS, StepPlan, StepShape};
use crate::detail::Detail;
use crate::gait::Manner;
use crate::rows::Sum;
use footfall_core::Side;
use footfall_model::{GaitModel, OBSERVATION_COUNT, STATES_PER_STEP};
use rand::SeedableRng as _;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution as _, StandardNormal};
use std::sync::Arc;

/// Least share of a running step that is flight, however slow the runner: a step without it would be a walk on bent knees.
const LEAST_FLIGHT: f64 = 0.06;

/// Largest weight of a walker component, standard deviations, so that every walker is plausible.
const MAX_WALKER_WEIGHT: f64 = 2.0;

/// Largest weight of a step component; a lower limit would make steps too alike.
const MAX_STEP_WEIGHT: f64 = 2.5;

/// One walker: draws steps that vary as the corpus does.
#[derive(Clone, Debug)]
pub(crate) struct Planner {
    model: Arc<GaitModel>,
    rng: ChaCha8Rng,
    variation: f64,
    /// Identity of this walker: weights of the model's walker components.
    walker: [f64; MAX_COMPONENTS],
    /// The last stride's weights.
    weights: [f64; MAX_COMPONENTS],
    /// Number of strides drawn so far.
    strides: u32,
}

impl Planner {
    /// Draws a walker by `seed`; `variation` scales its deviation, and that of its steps, from the average.
    pub(crate) fn new(model: &Arc<GaitModel>, seed: u64, variation: f64) -> Self {
        let mut planner = Self {
            model: Arc::clone(model),
            rng: ChaCha8Rng::seed_from_u64(seed),
            variation,
            walker: [0.0; MAX_COMPONENTS],
            weights: [0.0; MAX_COMPONENTS],
            strides: 0,
        };
        for component in 0..model.variation.walker.len().min(MAX_COMPONENTS) {
            planner.walker[component] = planner.normal(MAX_WALKER_WEIGHT);
        }
        for component in 0..MAX_COMPONENTS {
            planner.weights[component] = planner.normal(MAX_STEP_WEIGHT);
        }
        planner
    }

    /// Identity of this walker: weights of the model's walker components.
    pub(crate) fn walker(&self) -> &[f64; MAX_COMPONENTS] {
        &self.walker
    }

    /// Returns true when both are the same walker, wherever they are in their walks.
    pub(crate) fn is_same_walker(&self, other: &Self) -> bool {
        let numbers = |planner: &Self| [planner.variation].into_iter().chain(planner.walker);
        numbers(self).eq(numbers(other))
    }

    /// Becomes the walker that [`new`](Self::new) makes of these arguments; [`resume`](Self::resume) then restores its progress.
    pub(crate) fn become_walker(
        &mut self,
        model: &Arc<GaitModel>,
        seed: u64,
        variation: f64,
        walker: [f64; MAX_COMPONENTS],
    ) {
        self.model = Arc::clone(model);
        self.rng = ChaCha8Rng::seed_from_u64(seed);
        self.variation = variation;
        self.walker = walker;
    }

    /// Sets the mixture of styles of the next planned step.
    pub(crate) fn set_model(&mut self, model: &Arc<GaitModel>) {
        self.model = Arc::clone(model);
    }

    /// Position of the random generator.
    pub(crate) fn chance_position(&self) -> u64 {
        // No walk draws 2^64 numbers.
        self.rng.get_word_pos() as u64
    }

    /// Number of strides drawn so far.
    pub(crate) const fn strides(&self) -> u32 {
        self.strides
    }

    /// Sets the number of strides drawn so far.
    pub(crate) const fn count_strides(&mut self, strides: u32) {
        self.strides = strides;
    }

    /// Restores the position of the random generator, after these steps.
    pub(crate) fn resume(&mut self, chance_position: u64, last: &[StepDraw]) {
        self.rng.set_word_pos(u128::from(chance_position));
        if let Some(draw) = last.last() {
            self.weights = draw.weights;
        }
    }

    /// Draws the next step, which begins with the initial contact of `side`. A stride begins with the left foot's, and both its steps have
    /// the same weights: independent draws would often pair a slow step with a fast one, and the walker would limp.
    pub(crate) fn draw(&mut self, side: Side) -> StepDraw {
        if side == Side::Left {
            self.strides = self.strides.wrapping_add(1);
            let memory = self.model.variation.step_correlation.clamp(0.0, 0.99);
            let news = (1.0 - memory * memory).sqrt();
            for component in 0..MAX_COMPONENTS {
                let fresh = self.normal(MAX_STEP_WEIGHT);
                let weight = &mut self.weights[component];
                *weight =
                    (memory * *weight + news * fresh).clamp(-MAX_STEP_WEIGHT, MAX_STEP_WEIGHT);
            }
        }
        StepDraw {
            side,
            weights: self.weights,
        }
    }

    /// Frames of the longest step that [`plan_step`](Self::plan_step) can make.
    pub(crate) fn longest_step(model: &GaitModel) -> usize {
        let longest = (MAX_STEP_SECS * model.frame_rate_hz).ceil() as usize + STATES_PER_STEP;
        Detail::Quarter.whole_frames(longest)
    }

    /// Returns a draw without chance, for measurements.
    pub(crate) fn mean_draw(side: Side) -> StepDraw {
        StepDraw {
            side,
            weights: [0.0; MAX_COMPONENTS],
        }
    }

    /// Plans a drawn step; `statistics` are those of the current mixture of styles.
    pub(crate) fn plan_step<R: Sum>(
        &self,
        draw: &StepDraw,
        manner: Manner,
        statistics: &Statistics<R>,
        plan: &mut StepPlan<R>,
    ) {
        self.plan_step_end(draw, manner, usize::MAX, statistics, plan);
    }

    /// Plans the end of a drawn step: its shape, and the means of the states of its last frames only.
    pub(crate) fn plan_step_end<R: Sum>(
        &self,
        draw: &StepDraw,
        manner: Manner,
        last_frames: usize,
        statistics: &Statistics<R>,
        plan: &mut StepPlan<R>,
    ) {
        let Manner {
            pace,
            position,
            detail,
        } = manner;
        let side = draw.side.index();
        let model = &self.model;
        let deviation = pace.covariate_mps - model.speed.reference_mps;
        let mut offsets = Offsets::of(Part::Speed, &model.speed.slopes[side], deviation);
        if let Some(index) = model.context(position, draw.side) {
            // A walker that turns on the spot hardly sets out.
            let context = &model.contexts[index].offset;
            offsets.add(Part::Context(index), context, pace.stride.min(1.0));
        }
        let walkers = model.variation.walker.iter().zip(&self.walker);
        for (index, (component, weight)) in walkers.enumerate() {
            let weight = self.variation * weight;
            offsets.add(Part::Walker(index), &component[side], weight);
        }
        let steps = model.variation.step.iter().zip(&draw.weights);
        for (index, (component, weight)) in steps.enumerate() {
            let weight = self.variation * weight;
            offsets.add(Part::Step(index), &component[side], weight);
        }

        let step = &model.steps[side];
        let mut elapsed = 0.0;
        let mut passed = 0;
        for (state, parameters) in step.states.iter().enumerate() {
            let longest = MAX_STEP_SECS * model.frame_rate_hz / STATES_PER_STEP as f64;
            let stretch = offsets.log_duration(state).clamp(-1.5, 1.5).exp();
            let frames = parameters.duration_mean * stretch / pace.tempo;
            // Rounding the running sum keeps the step's duration true to half a frame.
            elapsed += frames.clamp(1.0, longest);
            let end = (elapsed.round() as usize).max(passed + 1);
            plan.state_frames[state] = end - passed;
            passed = end;
        }
        let detail = detail.holding(passed);
        let whole = detail.whole_frames(passed);
        plan.state_frames[STATES_PER_STEP - 1] += whole - passed;
        let from_state = plan.state_at(whole.saturating_sub(last_frames));
        let within = from_state * OBSERVATION_COUNT..STEP_MEANS;
        offsets.add_means(statistics, draw.side, within, &mut plan.means);
        let mut terminal = step.other_terminal + offsets.other_terminal();
        if step.other_terminal < 0.0 {
            terminal = terminal.min(-LEAST_FLIGHT);
        }
        plan.shape = StepShape::of_walk(draw.side, whole, terminal, pace.stride, detail);
        plan.fine = FineDraw::new(model, &self.walker, draw, self.variation);
    }

    fn normal(&mut self, most: f64) -> f64 {
        let value: f64 = StandardNormal.sample(&mut self.rng);
        value.clamp(-most, most)
    }
}
