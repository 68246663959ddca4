//! One walker, step after step: planning, trajectory and planting in a row.

use crate::error::SynthError;
use crate::plan::{Pace, Planner, StepDraw, StepPlan};
use crate::planting::{PlantedFrame, Planter};
use crate::raw::RawFrame;
use crate::standing::{Amplitude, standing_features};
use crate::trajectory::TrajectorySolver;
use footfall_core::{Side, Skeleton};
use footfall_model::{FEATURE_COUNT, GaitModel};

/// Steps in a window: the one before, the one to be put on the ground, and one ahead, which shapes its end. What lies
/// beyond does not show: a frame's influence has died away after half a step.
const WINDOW: usize = 3;

/// Frames that tie a window to the one before: the longest dynamic window couples no more.
const TIE: usize = 4;

/// The stage between the planner's draws and frames on the ground; allocates nothing after it was made.
#[derive(Debug)]
pub(crate) struct Walker {
    skeleton: Skeleton,
    solver: TrajectorySolver,
    draws: [StepDraw; WINDOW],
    plans: [StepPlan; WINDOW],
    /// The pace of the steps ahead.
    pace: Option<Pace>,
    /// Features of the window, and where the current step begins in it.
    trajectory: Vec<f64>,
    current: usize,
    tie: [f64; TIE * FEATURE_COUNT],
    standing: [f64; FEATURE_COUNT],
    raw: Vec<RawFrame>,
    planter: Option<Planter>,
    frame_secs: f32,
    /// Heading under which the walk goes along +Z, radians: people hold their hips a little askew.
    pub(crate) facing: f32,
    /// The current step on the ground, one frame longer than the step.
    pub(crate) frames: Vec<PlantedFrame>,
}

impl Walker {
    pub(crate) fn new(model: &GaitModel, skeleton: &Skeleton, solver: TrajectorySolver) -> Self {
        let longest = Planner::longest_step(model);
        Self {
            skeleton: skeleton.clone(),
            solver,
            draws: [(); WINDOW].map(|()| Planner::mean_draw(Side::Left)),
            plans: [(); WINDOW].map(|()| StepPlan::empty()),
            pace: None,
            trajectory: Vec::with_capacity((WINDOW * longest + TIE) * FEATURE_COUNT),
            current: 0,
            tie: [0.0; TIE * FEATURE_COUNT],
            standing: standing_features(model),
            raw: vec![RawFrame::default(); longest + 1],
            planter: None,
            frame_secs: (1.0 / model.frame_rate_hz) as f32,
            facing: 0.0,
            frames: Vec::with_capacity(longest + 1),
        }
    }

    /// Starts over with the step that begins with this foot's initial contact. `draw` makes the steps.
    ///
    /// # Errors
    /// [`SynthError::Inference`] when the model gives no trajectory.
    pub(crate) fn start(
        &mut self,
        planner: &mut Planner,
        pace: Pace,
        first: Side,
        amplitude: Amplitude,
        draw: fn(&mut Planner, Side) -> StepDraw,
    ) -> Result<(), SynthError> {
        self.pace = (amplitude == Amplitude::WALK).then_some(pace);
        // A step before the first, never shown, brings the first into its stride.
        let mut side = first.other();
        for (slot, plan) in self.draws.iter_mut().zip(&mut self.plans) {
            *slot = draw(planner, side);
            planner.realise(slot, pace, plan);
            plan.set_amplitude(amplitude);
            side = side.other();
        }
        let frames = self.solver.load(&self.plans, 0);
        self.trajectory.resize(frames * FEATURE_COUNT, 0.0);
        self.solver.solve(&mut self.trajectory, 0)?;
        self.planter = None;
        self.current = 0;
        self.put_on_ground(0, 0.0);
        self.current = self.plans[0].timing.frames;
        self.put_on_ground(1, 0.0);
        Ok(())
    }

    /// Goes on to the next step.
    pub(crate) fn advance(
        &mut self,
        planner: &mut Planner,
        pace: Pace,
        turn_rate: f32,
        amplitude: Amplitude,
        draw: fn(&mut Planner, Side) -> StepDraw,
    ) {
        let frames = self.plans[1].timing.frames;
        let tie_at = (self.current + frames + 1 - TIE) * FEATURE_COUNT;
        self.tie
            .copy_from_slice(&self.trajectory[tie_at..tie_at + TIE * FEATURE_COUNT]);
        self.draws.rotate_left(1);
        self.plans.rotate_left(1);
        self.draws[WINDOW - 1] = draw(planner, self.draws[WINDOW - 2].side.other());
        // A new pace is taken up by every step ahead: what the controls say now takes effect at once.
        let known = if self.pace == Some(pace) {
            WINDOW - 1
        } else {
            1
        };
        self.pace = Some(pace);
        for (slot, plan) in self.draws.iter().zip(&mut self.plans).skip(known) {
            planner.realise(slot, pace, plan);
        }
        self.plans[1].set_amplitude(amplitude);
        let skip = self.plans[0].timing.frames + 1 - TIE;
        let frames = self.solver.load(&self.plans, skip);
        self.trajectory.resize(frames * FEATURE_COUNT, 0.0);
        self.trajectory[..TIE * FEATURE_COUNT].copy_from_slice(&self.tie);
        if self.solver.solve(&mut self.trajectory, TIE).is_err() {
            // A checked model does not get here; were it to, a rough pose beats none.
            self.solver.fill_with_means(&mut self.trajectory, TIE);
        }
        self.current = TIE - 1;
        self.put_on_ground(1, turn_rate);
    }

    /// The step that is on the ground now.
    pub(crate) fn step(&self) -> &StepPlan {
        &self.plans[1]
    }

    /// Where this foot was put last; `None` before [`start`](Self::start).
    pub(crate) fn planter(&self) -> Option<&Planter> {
        self.planter.as_ref()
    }

    /// Puts a step of the window, which begins at `current`, on the ground.
    fn put_on_ground(&mut self, step: usize, turn_rate: f32) {
        let plan = &self.plans[step];
        let rows = self.trajectory[self.current * FEATURE_COUNT..].chunks_exact(FEATURE_COUNT);
        let raw = &mut self.raw[..=plan.timing.frames];
        for (index, (raw, features)) in raw.iter_mut().zip(rows).enumerate() {
            if plan.amplitude == Amplitude::WALK {
                raw.decode(features, &self.skeleton, plan.stride as f32);
                continue;
            }
            let amplitude = plan.amplitude.at(index as f32 / plan.timing.frames as f32);
            let mut blended = self.standing;
            for (standing, walking) in blended.iter_mut().zip(features) {
                *standing += f64::from(amplitude) * (walking - *standing);
            }
            raw.decode(&blended, &self.skeleton, plan.stride as f32);
        }
        let planter = self.planter.get_or_insert_with(|| {
            Planter::new(
                &self.skeleton,
                self.frame_secs,
                &raw[0],
                plan.timing.leading,
                self.facing,
            )
        });
        planter.plant_step(raw, &plan.timing, turn_rate, &mut self.frames);
    }
}
