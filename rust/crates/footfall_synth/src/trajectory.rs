//! Trajectories: from plans to smooth features, joints and fine detail.
//!
//! Maximum-likelihood parameter generation with the corpus' global variance preserved ([`variance`]); [`fine_motion`] then adds the detail that states average away, and [`leap`] the posture of a leap.

mod fine_motion;
mod leap;
pub(crate) mod variance;

use crate::error::SynthError;
use crate::plan::{Statistics, StepPlan};
pub(crate) use fine_motion::{FineBuffers, FineTables, Scale, neighbours};
use footfall_model::{FEATURE_COUNT, OBSERVATION_COUNT, STATES_PER_STEP};
use footfall_prob::mlpg::{MlpgProblem, MlpgWorkspace, Pull, Real, mlpg_part};
pub(crate) use leap::add_leap;

/// Solver of trajectories, with all of its buffers.
#[derive(Debug)]
pub(crate) struct TrajectorySolver<R: Real> {
    /// True when the pull that preserves variance is applied.
    pub(crate) pulls: bool,
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
            pulls: true,
            pull_towards: vec![R::default(); FEATURE_COUNT],
            workspace: MlpgWorkspace::with_capacity(frames),
            window_means: Vec::with_capacity(room),
            window_precisions: Vec::with_capacity(room),
            state_of_frame: Vec::with_capacity(frames),
        }
    }

    /// Loads the states of consecutive steps without their first `skip` frames; returns the number of frames.
    pub(crate) fn load(
        &mut self,
        statistics: &Statistics<R>,
        plans: &[StepPlan<R>],
        skip: usize,
    ) -> usize {
        self.window_means.clear();
        self.window_precisions.clear();
        self.state_of_frame.clear();
        for (step, plan) in plans.iter().enumerate() {
            self.window_means.extend_from_slice(&plan.means);
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
    fn centre(&mut self, stride: Option<&[StepPlan<R>; 2]>) {
        let mut centre = [0.0; FEATURE_COUNT];
        if let Some(stride) = stride {
            let frames: usize = stride.iter().map(|plan| plan.shape.timing.frames).sum();
            for plan in stride {
                let means = plan.means.chunks_exact(OBSERVATION_COUNT);
                for (mean, duration) in means.zip(plan.state_frames) {
                    let share = duration as f64 / frames as f64;
                    for (centre, value) in centre.iter_mut().zip(mean) {
                        *centre += share * value.widen();
                    }
                }
            }
        }
        for (towards, centre) in self.pull_towards.iter_mut().zip(centre) {
            *towards = R::narrow(centre);
        }
    }

    /// Returns the loaded states as a problem without pull, whose first `n_fixed` frames are given.
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

    /// Solves at least the first `wanted` features. `trajectory` (T × [`FEATURE_COUNT`]) already holds the given frames.
    pub(crate) fn solve(
        &mut self,
        statistics: &Statistics<R>,
        trajectory: &mut [R],
        n_fixed: usize,
        wanted: usize,
    ) -> Result<(), SynthError> {
        let mut workspace = core::mem::take(&mut self.workspace);
        let problem = MlpgProblem {
            pull: self.pulls.then_some(Pull {
                strength: &statistics.pull_strength,
                towards: &self.pull_towards,
            }),
            ..self.problem(statistics, n_fixed)
        };
        let solved = mlpg_part(&problem, wanted, &mut workspace, trajectory);
        self.workspace = workspace;
        Ok(solved?)
    }

    /// Fills the other frames with the means of their states: a rough fallback that cannot fail.
    pub(crate) fn fill_with_means(&self, trajectory: &mut [R], n_fixed: usize) {
        let rows = trajectory.chunks_exact_mut(FEATURE_COUNT);
        for (row, state) in rows.zip(&self.state_of_frame).skip(n_fixed) {
            let mean = &self.window_means[*state as usize * OBSERVATION_COUNT..][..FEATURE_COUNT];
            row.copy_from_slice(mean);
        }
    }
}
