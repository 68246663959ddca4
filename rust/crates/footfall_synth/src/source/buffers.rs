//! Buffers for solving a step, needed only during the step, so all walkers share them.

use crate::error::SynthError;
use crate::ground::{GeneratedFrame, PlantedStep};
use crate::plan::{Planner, Statistics, StepPlan, TIE, TIE_LEN, WINDOW};
use crate::trajectory::{FineBuffers, TrajectorySolver};
use core::ops::Range;
use footfall_core::Joint;
use footfall_model::layout::feature_offset;
use footfall_model::{FEATURE_COUNT, GaitModel};
use std::sync::{Mutex, PoisonError};

/// Time constant with which the motion before a change swings out, and the time after which it has, frames.
const SWINGING_OUT: f32 = 6.0;
const SWINGING_FRAMES: usize = 48;

/// Number of generated features: all but those of the right toes, which come last. The planter turns toes.
const WALKED: usize = feature_offset(Joint::RightToes);

/// Features of both arms.
const ARMS: Range<usize> = feature_offset(Joint::LeftShoulder)..feature_offset(Joint::LeftUpperLeg);

/// Change from one step to the next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Change {
    None,
    /// Another pace in the same gait.
    Pace,
    Gait,
}

impl Change {
    /// Returns the features whose motion before it swings out.
    fn swinging(self) -> Range<usize> {
        match self {
            Self::None => 0..0,
            Self::Pace => ARMS,
            Self::Gait => 0..WALKED,
        }
    }
}

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
        change: Change,
    ) {
        self.solver.pulls = change != Change::Gait;
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
        swing_out(&mut self.trajectory, change.swinging());
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

/// Lets the motion of these features before a change swing out: the likeliest trajectory turns a trunk or a hand that went forwards back from one frame to the next.
fn swing_out(trajectory: &mut [f32], features: Range<usize>) {
    if features.is_empty() {
        return;
    }
    let (known, new) = trajectory.split_at_mut(TIE_LEN);
    let [before, last] = [2, 1].map(|back| &known[TIE_LEN - back * FEATURE_COUNT..]);
    let mut missing = [0.0; FEATURE_COUNT];
    for dim in features.clone() {
        missing[dim] = 2.0 * last[dim] - before[dim] - new[dim];
    }
    let swinging = new.chunks_exact_mut(FEATURE_COUNT).take(SWINGING_FRAMES);
    for (index, frame) in swinging.enumerate() {
        let share = (1.0 + index as f32) * (-(index as f32) / SWINGING_OUT).exp();
        let missing = &missing[features.clone()];
        for (value, missing) in frame[features.clone()].iter_mut().zip(missing) {
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
