//! Streaming generator: one walker, for any length of time.
//!
//! The whole way is in [`GaitGenerator::step`]: controls become those of a step ([`StepControls`]), the source makes a request, a plan, features and the step on the ground of
//! them ([`advance`](crate::source::StepSource::advance)), and `show` reads the pose between two planted frames, with standing motion and moves on top.

mod facts;
mod footholds;
mod jumping;
mod pose;
mod run_up;
mod state;

use crate::config::{GeneratorConfig, MAX_DT_SECS, check};
use crate::controls::Controls;
use crate::detail::Detail;
use crate::error::SynthError;
use crate::footstep::Footstep;
use crate::gait::{StepControls, lifts_other_foot};
use crate::moves::Moves;
use crate::plan::StepShape;
use crate::source::{Steps, StyleSpace, StyledSteps, SwitchingSteps};
use crate::standing::Life;
use footfall_core::{GroundTransform, Pose, Side, Skeleton};
use footfall_model::DynamicsModel;
use std::sync::Arc;

pub(crate) use jumping::PendingJump;
pub use state::StateError;

/// Maximum number of initial contacts that one call of [`GaitGenerator::step`] reports.
const MAX_FOOTSTEPS: usize = 64;

/// Walks one body in real time, in styles of a [`GaitModel`](footfall_model::GaitModel) or by a [`DynamicsModel`].
///
/// All checks are in [`new`](Self::new) and [`switching`](Self::switching); [`step`](Self::step) cannot fail and does not
/// allocate. The same model, seed and sequence of calls give the same poses, bit for bit on one machine.
#[derive(Debug)]
pub struct GaitGenerator {
    pub(crate) skeleton: Skeleton,
    pub(crate) config: GeneratorConfig,
    pub(crate) steps: Steps,
    pub(crate) frame_rate_hz: f32,
    /// Level of detail of the next step.
    pub(crate) detail: Detail,
    /// Frames since the current step began.
    pub(crate) position: f32,
    pub(crate) plan_from_start: GroundTransform,
    /// Motion of the standing body; `None` where the model stands still.
    pub(crate) life: Option<Life>,
    /// Crouches and jumps; `None` with a switching model.
    pub(crate) moves: Option<Moves>,
    /// Pending jump.
    pub(crate) pending_jump: Option<PendingJump>,
    pub(crate) footsteps: Vec<Footstep>,
    /// Last requested forward speed, m/s.
    pub(crate) requested_mps: f32,
    start_from_character: GroundTransform,
    contact: [bool; 2],
    /// Controls that the current step already answers.
    pub(crate) answered: Option<Controls>,
}

impl GaitGenerator {
    /// Creates a walker with the proportions of `skeleton`, at the origin and facing +Z, in a mixture of the space's styles:
    /// weights as of [`set_style_weights`](Self::set_style_weights), none for the plain walk.
    ///
    /// # Errors
    /// [`SynthError`] when the model or the skeleton cannot be used or a setting is not finite.
    pub fn new(
        space: &Arc<StyleSpace>,
        style_weights: &[f32],
        skeleton: &Skeleton,
        config: &GeneratorConfig,
    ) -> Result<Self, SynthError> {
        let first = check(skeleton, config)?;
        let steps = StyledSteps::new(space, style_weights, skeleton, config, first)?;
        let rate = space.model().frame_rate_hz;
        let steps = Steps::Styled(Box::new(steps));
        let mut generator = Self::begin(steps, rate, skeleton, config);
        generator.life = Life::new(space.standing(), skeleton, config);
        generator.moves = Some(Moves::new(space.moves(), skeleton));
        Ok(generator)
    }

    /// Creates a walker with the proportions of `skeleton`, at the origin and facing +Z, whose steps come from two linear systems. It
    /// knows one way of walking: other speeds than the recorded one stretch its steps and their time.
    ///
    /// # Errors
    /// [`SynthError`] when the model or the skeleton cannot be used or a setting is not finite.
    pub fn switching(
        model: &Arc<DynamicsModel>,
        skeleton: &Skeleton,
        config: &GeneratorConfig,
    ) -> Result<Self, SynthError> {
        let first = check(skeleton, config)?;
        let steps = SwitchingSteps::new(model, skeleton, config, first)?;
        let rate = model.frame_rate_hz;
        Ok(Self::begin(
            Steps::Switching(Box::new(steps)),
            rate,
            skeleton,
            config,
        ))
    }

    fn begin(
        steps: Steps,
        frame_rate_hz: f64,
        skeleton: &Skeleton,
        config: &GeneratorConfig,
    ) -> Self {
        let frames = steps.source().shape().timing.frames as f32;
        let mut generator = Self {
            skeleton: skeleton.clone(),
            config: *config,
            steps,
            frame_rate_hz: frame_rate_hz as f32,
            detail: Detail::Full,
            position: (2.0 * config.phase.rem_euclid(1.0)).fract() * frames,
            plan_from_start: GroundTransform::default(),
            life: None,
            moves: None,
            pending_jump: None,
            footsteps: Vec::with_capacity(MAX_FOOTSTEPS),
            requested_mps: 0.0,
            start_from_character: GroundTransform::default(),
            contact: [true; 2],
            answered: None,
        };
        generator.plan_from_start = generator.plan_from_character();
        generator
    }

    /// Restarts at the origin, standing still.
    pub fn stand(&mut self) {
        if self.steps.source_mut().stand(self.detail) {
            self.position = self.steps.source().shape().timing.frames as f32;
            self.plan_from_start = self.plan_from_character();
            if let Some(life) = &mut self.life {
                life.stand();
            }
        }
    }

    /// Advances by `dt_secs` and writes the pose in the character's own space: above the ground point of
    /// [`start_from_character`](Self::start_from_character), facing +Z.
    ///
    /// A `dt_secs` of 0 gives the same pose again.
    pub fn step(&mut self, dt_secs: f32, controls: &Controls, out: &mut Pose) {
        let controls = &self.begin_frame(controls);
        let mut rested = self.has_ended();
        if dt_secs > 0.0 {
            self.position += dt_secs.min(MAX_DT_SECS) * self.frame_rate_hz;
        }
        while self.has_ended() {
            self.end_step(&mut rested);
            let rests = self.comes_to_rest();
            if rests && controls.is_standing() {
                self.rest();
                break;
            }
            self.leave_step();
            if rests {
                self.choose_foot(controls);
            }
            self.next_step(controls, None);
        }
        self.replan(controls);
        self.show(dt_secs, controls, out);
    }

    /// Responds to the controls of a frame.
    pub(crate) fn begin_frame(&mut self, controls: &Controls) -> Controls {
        self.footsteps.clear();
        let controls = self.steered(controls);
        self.requested_mps = controls.velocity().y.max(0.0);
        controls
    }

    /// Has the next step, from standing, lift the foot that people would lift.
    fn choose_foot(&mut self, controls: &Controls) {
        let Steps::Styled(steps) = &mut self.steps else {
            return;
        };
        let aside = self.life.as_ref().map_or(0.0, Life::aside);
        let usual = steps.window.step().timing.leading;
        if lifts_other_foot(controls, aside, usual) {
            let other = steps.number().wrapping_add(2);
            steps.go_on_with(&self.config, other);
        }
    }

    /// Generates the next step and reports its initial contact; a walker at rest has both feet on the ground. `brakes` is [that of the step's controls](StepControls::brakes).
    pub(crate) fn next_step(&mut self, controls: &Controls, brakes: Option<bool>) {
        let rested = self.comes_to_rest();
        let fastest = self.steps.source().fastest_mps();
        let (leap_m, run_up) = self.next_leap(controls);
        let step_controls = StepControls {
            leap_m,
            brakes,
            ..StepControls::after(self.shape().amplitude, *controls, fastest, self.detail)
        };
        self.steps.source_mut().advance(&step_controls);
        if let Some(run_up) = run_up {
            self.lead(&run_up);
        }
        self.answered = None;
        if !rested {
            self.report_plant(self.shape().timing.leading);
        }
    }

    /// Reports the contact of the foot that comes to rest where a step has just ended standing, and not if the walker already `rested`.
    pub(crate) fn end_step(&mut self, rested: &mut bool) {
        if self.comes_to_rest() && !*rested {
            self.report_plant(self.shape().timing.leading.other());
            let ended = self.steps.source().planted().planter_state();
            if let (Some(life), Some(ended)) = (&mut self.life, ended) {
                life.come_to_rest(&ended);
            }
        }
        *rested = false;
    }

    /// Replans a step with a foot in the air for the current controls.
    fn replan(&mut self, controls: &Controls) {
        if self.answered.as_ref() == Some(controls) {
            return;
        }
        let frame = self.position as usize;
        let fastest = self.steps.source().fastest_mps();
        let step_controls =
            StepControls::after(self.shape().amplitude, *controls, fastest, self.detail);
        let source = self.steps.source_mut();
        if source.replan(&step_controls, frame) {
            self.position -= frame as f32;
        } else if source.needs_replan(&step_controls) {
            // A later frame may allow it.
            return;
        }
        self.answered = Some(*controls);
    }

    pub(crate) fn shape(&self) -> &StepShape {
        self.steps.source().shape()
    }

    /// Returns true when the current step has ended.
    pub(crate) fn has_ended(&self) -> bool {
        self.position >= self.shape().timing.frames as f32
    }

    /// Returns true when the current step ends standing.
    pub(crate) fn comes_to_rest(&self) -> bool {
        self.shape().amplitude.to < 1.0
    }

    /// Leaves an ended step; the excess time belongs to the next one.
    pub(crate) fn leave_step(&mut self) {
        self.position -= self.shape().timing.frames as f32;
    }

    /// Rests at the end of the step.
    pub(crate) fn rest(&mut self) {
        self.position = self.shape().timing.frames as f32;
    }

    /// Reports the initial contact of a foot that stands.
    fn report_plant(&mut self, side: Side) {
        if let Some(plant) = self.steps.source().planted().plant(side) {
            self.report(Footstep::seen_from(&self.plan_from_start, side, plant));
        }
    }

    /// Reports an initial contact while there is room for it.
    pub(crate) fn report(&mut self, footstep: Footstep) {
        if self.footsteps.len() < MAX_FOOTSTEPS {
            self.footsteps.push(footstep);
        }
    }
}
