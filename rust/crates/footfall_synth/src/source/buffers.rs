//! Buffers for solving a step, needed only during the step, so all walkers share them.

use crate::error::SynthError;
use crate::ground::{GeneratedFrame, PlantedStep};
use crate::plan::{Planner, Statistics, StepPlan, TIE, TIE_LEN, WINDOW};
use crate::trajectory::{FineBuffers, TrajectorySolver};
use footfall_core::Joint;
use footfall_model::layout::feature_offset;
use footfall_model::{FEATURE_COUNT, GaitModel};
use std::sync::{Mutex, PoisonError};

/// Time constant with which the motion before a change of gait swings out, and the time after which it has, frames.
const SWINGING_OUT: f32 = 6.0;
const SWINGING_FRAMES: usize = 48;

/// Number of generated features: all but those of the right toes, which come last. The planter turns toes.
const WALKED: usize = feature_offset(Joint::RightToes);

/// Buffers for solving and planting a step.
#[derive(Debug)]
pub(crate) struct StepBuffers {
    solver: TrajectorySolver<f32>,
    /// Features of the window that was solved last.
    pub(crate) trajectory: Vec<f32>,
    pub(crate) fine: FineBuffers,
    /// Features of the planted step, with its fine motion.
    pub(crate) shown: Vec<f32>,
    pub(crate) generated: Vec<GeneratedFrame>,
    /// The step in the previous gait, if the gait changes.
    pub(crate) going_over: StepPlan<f32>,
}

impl StepBuffers {
    /// Makes buffers for steps of this model, in any style.
    pub(crate) fn new(model: &GaitModel) -> Self {
        let longest = Planner::longest_step(model);
        let room = WINDOW * longest + TIE;
        Self {
            solver: TrajectorySolver::new(WINDOW, room),
            trajectory: Vec::with_capacity(room * FEATURE_COUNT),
            fine: FineBuffers::new(),
            shown: vec![0.0; (longest + 1) * FEATURE_COUNT],
            generated: PlantedStep::generated(longest),
            going_over: StepPlan::empty(),
        }
    }

    /// Solves the first window of a walk.
    ///
    /// # Errors
    /// [`SynthError::Inference`] when the model gives no trajectory.
    pub(crate) fn start(
        &mut self,
        statistics: &Statistics<f32>,
        plans: &[StepPlan<f32>],
    ) -> Result<(), SynthError> {
        let frames = self.solver.load(statistics, plans, 0);
        self.trajectory.resize(frames * FEATURE_COUNT, 0.0);
        self.solver
            .solve(statistics, &mut self.trajectory, 0, WALKED)
    }

    /// Solves a window from the last frames of its first step on, which are given. There is no pull while the gait changes.
    pub(crate) fn go_on(
        &mut self,
        statistics: &Statistics<f32>,
        plans: &[StepPlan<f32>; WINDOW],
        tie: &[f32; TIE_LEN],
        changes_gait: bool,
    ) {
        self.solver.pulls = !changes_gait;
        let skip = (plans[0].shape.timing.frames + 1).saturating_sub(TIE);
        let frames = self.solver.load(statistics, plans, skip);
        self.trajectory.resize(frames * FEATURE_COUNT, 0.0);
        self.trajectory[..TIE_LEN].copy_from_slice(tie);
        let solved = self
            .solver
            .solve(statistics, &mut self.trajectory, TIE, WALKED);
        self.solver.pulls = true;
        if solved.is_err() {
            // A checked model does not get here; if it did, a rough pose would beat none.
            self.solver.fill_with_means(&mut self.trajectory, TIE);
        }
        if changes_gait {
            swing_out(&mut self.trajectory);
        }
    }

    /// Returns the frames, from this one on, that tie the next window to this one.
    pub(crate) fn tie_at(&self, frame: usize) -> [f32; TIE_LEN] {
        let mut tie = [0.0; TIE_LEN];
        tie.copy_from_slice(&self.trajectory[frame * FEATURE_COUNT..][..TIE_LEN]);
        for frame in tie.chunks_exact_mut(FEATURE_COUNT) {
            frame[WALKED..].fill(0.0);
        }
        tie
    }
}

/// Lets what moved before a change of gait swing out: the likeliest trajectory turns a trunk that went forwards back from one frame to the next.
fn swing_out(trajectory: &mut [f32]) {
    let (known, new) = trajectory.split_at_mut(TIE_LEN);
    let [before, last] = [2, 1].map(|back| &known[TIE_LEN - back * FEATURE_COUNT..][..WALKED]);
    let mut missing = [0.0; FEATURE_COUNT];
    for (dim, missing) in missing[..WALKED].iter_mut().enumerate() {
        *missing = 2.0 * last[dim] - before[dim] - new[dim];
    }
    let swinging = new.chunks_exact_mut(FEATURE_COUNT).take(SWINGING_FRAMES);
    for (index, frame) in swinging.enumerate() {
        let share = (1.0 + index as f32) * (-(index as f32) / SWINGING_OUT).exp();
        for (value, missing) in frame[..WALKED].iter_mut().zip(&missing) {
            *value += share * missing;
        }
    }
}

/// Pool of buffers that the walkers of one model share: as many as threads have ever generated steps at the same time.
#[derive(Debug, Default)]
pub(crate) struct BufferPool(Mutex<Vec<StepBuffers>>);

impl BufferPool {
    /// Runs work with one of them. Allocates only when all are in use.
    pub(crate) fn with_one<R>(
        &self,
        model: &GaitModel,
        work: impl FnOnce(&mut StepBuffers) -> R,
    ) -> R {
        let free = self.0.lock().unwrap_or_else(PoisonError::into_inner).pop();
        let mut buffers = free.unwrap_or_else(|| StepBuffers::new(model));
        let done = work(&mut buffers);
        let mut free = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        free.push(buffers);
        done
    }
}
