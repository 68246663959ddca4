//! What the coming steps are: how long their states last and what their means are.

use crate::detail::Detail;
use crate::planting::StepTiming;
use crate::standing::{Amplitude, START_TERMINAL};
use core::ops::Range;
use footfall_core::{Side, StepPosition};
use footfall_model::{GaitModel, OBSERVATION_COUNT, STATES_PER_STEP, StepOffset};
use multiversion::multiversion;
use rand::SeedableRng as _;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution as _, StandardNormal};
use std::sync::Arc;

/// Components of the variation that a step can hold; a model has no more.
pub(crate) const MAX_COMPONENTS: usize = 16;

/// Offsets that a step is the sum of: the speed's, the place's, the walker's and its own.
const MAX_OFFSETS: usize = 2 + 2 * MAX_COMPONENTS;

/// Weights of components stay within this many standard deviations, so that every walker is a plausible one.
const MAX_WALKER_WEIGHT: f64 = 2.0;

/// The same for steps, which are many: cut off closer, they would be too alike.
const MAX_STEP_WEIGHT: f64 = 2.5;

/// A step lasts at most this long, seconds.
pub(crate) const MAX_STEP_SECS: f64 = 3.0;

/// How fast a step is to be: what the speed response and the limits of the model make of a speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pace {
    /// Where on the model's speed response, m/s.
    pub(crate) covariate_mps: f64,
    /// Factor on the rate at which states pass.
    pub(crate) tempo: f64,
    /// Factor on the legs' reach forwards and backwards.
    pub(crate) stride: f64,
}

/// How a step is to be walked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Manner {
    pub(crate) pace: Pace,
    /// Place in the walk.
    pub(crate) position: StepPosition,
    pub(crate) detail: Detail,
}

impl Manner {
    /// Inside a walk, in full detail.
    pub(crate) const fn inside(pace: Pace) -> Self {
        Self {
            pace,
            position: StepPosition::Inside,
            detail: Detail::Full,
        }
    }
}

/// What chance decided about a step; its pace may still change.
#[derive(Clone, Debug)]
pub(crate) struct StepDraw {
    pub(crate) side: Side,
    pub(crate) weights: [f64; MAX_COMPONENTS],
}

/// What the ground has to know about a step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StepShape {
    pub(crate) timing: StepTiming,
    /// Factor on the legs' reach.
    pub(crate) stride: f64,
    /// How much of the walk there is in the step.
    pub(crate) amplitude: Amplitude,
    pub(crate) detail: Detail,
}

/// A step ready to be generated.
#[derive(Clone, Debug)]
pub(crate) struct StepPlan {
    pub(crate) shape: StepShape,
    /// Frames of each state.
    pub(crate) state_frames: [usize; STATES_PER_STEP],
    /// The means of every state, state by state.
    pub(crate) means: Vec<f64>,
}

impl StepShape {
    /// A step of the walk of so many frames; `terminal` is when the other foot leaves the ground, as a fraction of it.
    ///
    /// Frames become a whole number of those that are put on the ground.
    pub(crate) fn of_walk(
        leading: Side,
        frames: usize,
        terminal: f64,
        stride: f64,
        detail: Detail,
    ) -> Self {
        let frames = detail.whole_frames(frames);
        let terminal = (terminal.clamp(0.02, 0.6) * frames as f64).round() as usize;
        Self {
            timing: StepTiming {
                leading,
                frames,
                terminal: terminal.clamp(1, frames - 2),
                rests: false,
            },
            stride,
            amplitude: Amplitude::WALK,
            detail,
        }
    }

    /// The timing in frames that are put on the ground.
    pub(crate) fn ground_timing(&self) -> StepTiming {
        let stride = self.detail.stride();
        let frames = self.timing.frames / stride;
        StepTiming {
            frames,
            terminal: (self.timing.terminal / stride).clamp(1, frames - 2),
            ..self.timing
        }
    }

    /// Makes the step start or end a walk, or stand.
    pub(crate) fn set_amplitude(&mut self, amplitude: Amplitude) {
        self.amplitude = amplitude;
        self.timing.rests = amplitude.to <= 0.0;
        if amplitude.from < amplitude.to {
            let least = (START_TERMINAL * self.timing.frames as f64).round() as usize;
            self.timing.terminal = self.timing.terminal.max(least);
        }
    }
}

impl StepPlan {
    /// A plan that [`Planner::realise`] can fill without allocating.
    pub(crate) fn empty() -> Self {
        Self {
            shape: StepShape::of_walk(Side::Left, 1, 0.0, 1.0, Detail::Full),
            state_frames: [0; STATES_PER_STEP],
            means: vec![0.0; STATES_PER_STEP * OBSERVATION_COUNT],
        }
    }
}

/// A weighted sum of offsets that is never written down: what is wanted of it is summed when it is wanted.
struct Offsets<'a> {
    parts: [(&'a StepOffset, f64); MAX_OFFSETS],
    len: usize,
}

impl<'a> Offsets<'a> {
    /// A sum that begins with this offset.
    fn of(offset: &'a StepOffset, weight: f64) -> Self {
        Self {
            parts: [(offset, weight); MAX_OFFSETS],
            len: 1,
        }
    }

    fn add(&mut self, offset: &'a StepOffset, weight: f64) {
        self.parts[self.len] = (offset, weight);
        self.len += 1;
    }

    fn parts(&self) -> &[(&'a StepOffset, f64)] {
        &self.parts[..self.len]
    }

    /// Writes these means of a state with their offsets.
    fn add_means(&self, base: &[f64], block: Range<usize>, means: &mut [f64]) {
        let means = &mut means[block.clone()];
        means.copy_from_slice(base);
        // Four offsets at a time: each pass over the means costs as much as the sums themselves.
        for parts in self.parts().chunks(4) {
            let part = |index: usize| {
                let (offset, weight) = parts.get(index).unwrap_or(&parts[0]);
                let weight = if index < parts.len() { *weight } else { 0.0 };
                (&offset.means[block.clone()], weight)
            };
            add_rows(means, [0, 1, 2, 3].map(part));
        }
    }

    fn log_duration(&self, state: usize) -> f64 {
        let of = |(offset, weight): &(&StepOffset, f64)| weight * offset.log_durations[state];
        self.parts().iter().map(of).sum()
    }

    fn other_terminal(&self) -> f64 {
        let of = |(offset, weight): &(&StepOffset, f64)| weight * offset.other_terminal;
        self.parts().iter().map(of).sum()
    }
}

/// Adds four weighted rows.
#[multiversion(targets("x86_64+avx2", "aarch64+neon"))]
fn add_rows(sums: &mut [f64], rows: [(&[f64], f64); 4]) {
    let [(a, wa), (b, wb), (c, wc), (d, wd)] = rows;
    for (sum, (((a, b), c), d)) in sums.iter_mut().zip(a.iter().zip(b).zip(c).zip(d)) {
        *sum += (wa * a + wb * b) + (wc * c + wd * d);
    }
}

/// One walker: draws steps that vary as the corpus does.
#[derive(Clone, Debug)]
pub(crate) struct Planner {
    model: Arc<GaitModel>,
    rng: ChaCha8Rng,
    variation: f64,
    /// How this walker differs from the average: weights of the model's walker components.
    walker: [f64; MAX_COMPONENTS],
    /// The last step's weights, per side.
    weights: [[f64; MAX_COMPONENTS]; 2],
}

impl Planner {
    /// A walker drawn by `seed`; `variation` scales how far it and its steps stray from the average.
    pub(crate) fn new(model: &Arc<GaitModel>, seed: u64, variation: f64) -> Self {
        let mut planner = Self {
            model: Arc::clone(model),
            rng: ChaCha8Rng::seed_from_u64(seed),
            variation,
            walker: [0.0; MAX_COMPONENTS],
            weights: [[0.0; MAX_COMPONENTS]; 2],
        };
        for component in 0..model.variation.walker.len().min(MAX_COMPONENTS) {
            planner.walker[component] = planner.normal(MAX_WALKER_WEIGHT);
        }
        for side in 0..2 {
            for component in 0..MAX_COMPONENTS {
                planner.weights[side][component] = planner.normal(MAX_STEP_WEIGHT);
            }
        }
        planner
    }

    /// Who this walker is: weights of the model's walker components.
    pub(crate) fn walker(&self) -> &[f64; MAX_COMPONENTS] {
        &self.walker
    }

    /// Is the walker that [`new`](Self::new) made of these, in another place of its walk: see [`resume`](Self::resume).
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

    /// Wears another mixture of styles from the next step that is worked out.
    pub(crate) fn wear(&mut self, model: &Arc<GaitModel>) {
        self.model = Arc::clone(model);
    }

    /// How far chance has come.
    pub(crate) fn chance_position(&self) -> u64 {
        // No walk draws 2^64 numbers.
        self.rng.get_word_pos() as u64
    }

    /// Takes chance up where [`chance_position`](Self::chance_position) was, after these steps.
    pub(crate) fn resume(&mut self, chance_position: u64, last: &[StepDraw]) {
        self.rng.set_word_pos(u128::from(chance_position));
        for draw in last {
            self.weights[draw.side.index()] = draw.weights;
        }
    }

    /// Draws the next step that begins with this foot's initial contact.
    pub(crate) fn draw(&mut self, side: Side) -> StepDraw {
        let memory = self.model.variation.step_correlation.clamp(0.0, 0.99);
        let news = (1.0 - memory * memory).sqrt();
        for component in 0..MAX_COMPONENTS {
            let fresh = self.normal(MAX_STEP_WEIGHT);
            let weight = &mut self.weights[side.index()][component];
            *weight = (memory * *weight + news * fresh).clamp(-MAX_STEP_WEIGHT, MAX_STEP_WEIGHT);
        }
        StepDraw {
            side,
            weights: self.weights[side.index()],
        }
    }

    /// Frames of the longest step that [`realise`](Self::realise) can make.
    pub(crate) fn longest_step(model: &GaitModel) -> usize {
        let longest = (MAX_STEP_SECS * model.frame_rate_hz).ceil() as usize + STATES_PER_STEP;
        Detail::Quarter.whole_frames(longest)
    }

    /// The step of this walker without chance, for measuring.
    pub(crate) fn mean_draw(side: Side) -> StepDraw {
        StepDraw {
            side,
            weights: [0.0; MAX_COMPONENTS],
        }
    }

    /// Works out a drawn step.
    pub(crate) fn realise(&self, draw: &StepDraw, manner: Manner, plan: &mut StepPlan) {
        self.realise_from(draw, manner, 0, plan);
    }

    /// Works out how a drawn step ends: its frames, but the means of the states from this one on only.
    pub(crate) fn realise_from(
        &self,
        draw: &StepDraw,
        manner: Manner,
        from_state: usize,
        plan: &mut StepPlan,
    ) {
        let Manner {
            pace,
            position,
            detail,
        } = manner;
        let side = draw.side.index();
        let model = &self.model;
        let deviation = pace.covariate_mps - model.speed.reference_mps;
        let mut offsets = Offsets::of(&model.speed.slopes[side], deviation);
        if let Some(context) = model.context(position, draw.side) {
            // Who turns on the spot hardly sets out.
            offsets.add(context, pace.stride.min(1.0));
        }
        let drawn = [
            (&model.variation.walker, &self.walker),
            (&model.variation.step, &draw.weights),
        ];
        for (components, weights) in drawn {
            for (component, weight) in components.iter().zip(weights) {
                offsets.add(&component[side], self.variation * weight);
            }
        }

        let step = &model.steps[side];
        let mut elapsed = 0.0;
        let mut passed = 0;
        for (state, parameters) in step.states.iter().enumerate() {
            let block = state * OBSERVATION_COUNT..(state + 1) * OBSERVATION_COUNT;
            if state >= from_state {
                offsets.add_means(&parameters.mean, block, &mut plan.means);
            }
            let longest = MAX_STEP_SECS * model.frame_rate_hz / STATES_PER_STEP as f64;
            let stretch = offsets.log_duration(state).clamp(-1.5, 1.5).exp();
            let frames = parameters.duration_mean * stretch / pace.tempo;
            // Rounding the running sum keeps the step's duration true to half a frame.
            elapsed += frames.clamp(1.0, longest);
            let end = (elapsed.round() as usize).max(passed + 1);
            plan.state_frames[state] = end - passed;
            passed = end;
        }
        let whole = detail.whole_frames(passed);
        plan.state_frames[STATES_PER_STEP - 1] += whole - passed;
        let terminal = step.other_terminal + offsets.other_terminal();
        plan.shape = StepShape::of_walk(draw.side, whole, terminal, pace.stride, detail);
    }

    fn normal(&mut self, most: f64) -> f64 {
        let value: f64 = StandardNormal.sample(&mut self.rng);
        value.clamp(-most, most)
    }
}
