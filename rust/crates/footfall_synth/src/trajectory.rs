//! From planned steps to smooth features: maximum-likelihood parameter generation with the global variance kept.

use crate::error::SynthError;
use crate::plan::StepPlan;
use footfall_core::Side;
use footfall_model::{FEATURE_COUNT, GaitModel, OBSERVATION_COUNT, STATES_PER_STEP};
use footfall_prob::mlpg::{MlpgProblem, MlpgWorkspace, Pull, Real, mlpg};
use footfall_prob::windows::Windows;

/// How far below zero the pull that restores variance may go, as a fraction of the least static precision: beyond 1
/// a trajectory need not be determined.
const MAX_PUSH: f64 = 0.9;

/// What all trajectories of one model share.
#[derive(Clone, Debug)]
pub(crate) struct Statistics<R> {
    windows: Windows,
    /// Per side, the precisions of the five states.
    precisions: [Vec<R>; 2],
    pull_strength: Vec<R>,
}

impl<R: Real> Statistics<R> {
    /// Those of a model, without any pull.
    pub(crate) fn new(model: &GaitModel) -> Self {
        let precisions = Side::BOTH.map(|side| {
            let states = &model.step(side).states;
            let variances = states.iter().flat_map(|state| &state.variance);
            variances
                .map(|variance| R::narrow(variance.recip()))
                .collect()
        });
        Self {
            windows: model.windows,
            precisions,
            pull_strength: vec![R::default(); FEATURE_COUNT],
        }
    }

    /// Sets the strength of the pull that keeps variance. It acts about the mean of what is loaded.
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
}

/// Solves trajectories; owns every buffer that this takes.
#[derive(Debug)]
pub(crate) struct TrajectorySolver<R: Real> {
    pull_towards: Vec<R>,
    workspace: MlpgWorkspace<R>,
    window_means: Vec<R>,
    window_precisions: Vec<R>,
    state_of_frame: Vec<u32>,
}

impl<R: Real> TrajectorySolver<R> {
    /// A solver with room for `steps` steps and `frames` frames.
    pub(crate) fn new(steps: usize, frames: usize) -> Self {
        let room = steps * STATES_PER_STEP * OBSERVATION_COUNT;
        Self {
            pull_towards: vec![R::default(); FEATURE_COUNT],
            workspace: MlpgWorkspace::with_capacity(frames),
            window_means: Vec::with_capacity(room),
            window_precisions: Vec::with_capacity(room),
            state_of_frame: Vec::with_capacity(frames),
        }
    }

    /// Loads the states of steps in a row without their first `skip` frames; returns the number of frames.
    pub(crate) fn load(
        &mut self,
        statistics: &Statistics<R>,
        plans: &[StepPlan],
        skip: usize,
    ) -> usize {
        self.window_means.clear();
        self.window_precisions.clear();
        self.state_of_frame.clear();
        for (step, plan) in plans.iter().enumerate() {
            self.window_means
                .extend(plan.means.iter().map(|mean| R::narrow(*mean)));
            self.window_precisions
                .extend_from_slice(&statistics.precisions[plan.shape.timing.leading.index()]);
            for (state, frames) in plan.state_frames.iter().enumerate() {
                let state = (step * STATES_PER_STEP + state) as u32;
                self.state_of_frame
                    .extend(core::iter::repeat_n(state, *frames));
            }
        }
        self.state_of_frame.drain(..skip);
        self.centre(plans.last_chunk());
        self.state_of_frame.len()
    }

    /// Moves the centre of the pull to the mean of a stride: a left and a right step.
    fn centre(&mut self, stride: Option<&[StepPlan; 2]>) {
        let mut centre = [0.0; FEATURE_COUNT];
        if let Some(stride) = stride {
            let frames: usize = stride.iter().map(|plan| plan.shape.timing.frames).sum();
            for plan in stride {
                let means = plan.means.chunks_exact(OBSERVATION_COUNT);
                for (mean, duration) in means.zip(plan.state_frames) {
                    let share = duration as f64 / frames as f64;
                    for (centre, value) in centre.iter_mut().zip(mean) {
                        *centre += share * value;
                    }
                }
            }
        }
        for (towards, centre) in self.pull_towards.iter_mut().zip(centre) {
            *towards = R::narrow(centre);
        }
    }

    /// What is loaded, as a problem whose first `n_fixed` frames are given, without the pull.
    pub(crate) fn problem(&self, statistics: &Statistics<R>, n_fixed: usize) -> MlpgProblem<'_, R> {
        MlpgProblem {
            windows: statistics.windows,
            dim: FEATURE_COUNT,
            means: &self.window_means,
            precisions: &self.window_precisions,
            state_of_frame: &self.state_of_frame,
            n_fixed,
            pull: None,
        }
    }

    /// Solves what is loaded. `trajectory` (T × [`FEATURE_COUNT`]) holds the given frames already.
    pub(crate) fn solve(
        &mut self,
        statistics: &Statistics<R>,
        trajectory: &mut [R],
        n_fixed: usize,
    ) -> Result<(), SynthError> {
        let mut workspace = core::mem::take(&mut self.workspace);
        let problem = MlpgProblem {
            pull: Some(Pull {
                strength: &statistics.pull_strength,
                towards: &self.pull_towards,
            }),
            ..self.problem(statistics, n_fixed)
        };
        let solved = mlpg(&problem, &mut workspace, trajectory);
        self.workspace = workspace;
        Ok(solved?)
    }

    /// Fills the frames that are not given with the means of their states: rough, but always there.
    pub(crate) fn fill_with_means(&self, trajectory: &mut [R], n_fixed: usize) {
        let rows = trajectory.chunks_exact_mut(FEATURE_COUNT);
        for (row, state) in rows.zip(&self.state_of_frame).skip(n_fixed) {
            let mean = &self.window_means[*state as usize * OBSERVATION_COUNT..][..FEATURE_COUNT];
            row.copy_from_slice(mean);
        }
    }
}
