//! Streaming generator: one walker, for any length of time.

mod footholds;
mod jumping;
mod state;

use crate::config::{GeneratorConfig, MAX_DT_SECS, check};
use crate::controls::Controls;
use crate::detail::Detail;
use crate::error::SynthError;
use crate::footstep::Footstep;
use crate::gait::{Gait, StepControls};
use crate::ground::PlantedFrame;
use crate::moves::{Leap, Moves};
use crate::plan::StepShape;
use crate::source::{Steps, StyleSpace, StyledSteps, SwitchingSteps};
use crate::standing::Life;
use footfall_core::rotation::{blend_near, from_heading};
use footfall_core::{GroundTransform, Joint, Pose, Skeleton};
use footfall_model::DynamicsModel;
use glam::Quat;
use std::sync::Arc;

pub use state::StateError;

/// Maximum number of initial contacts that one call of [`GaitGenerator::step`] reports.
const MAX_FOOTSTEPS: usize = 64;

/// Share of a frame within which a time counts as on the frame: time adds up with rounding.
const SAME_FRAME: f32 = 1e-2;

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
    /// Of the next step.
    pub(crate) detail: Detail,
    /// Frames since the current step began.
    pub(crate) position: f32,
    pub(crate) plan_from_start: GroundTransform,
    /// Motion of the standing body; `None` where the model stands still.
    pub(crate) life: Option<Life>,
    /// Crouches and jumps; `None` with a switching model.
    pub(crate) moves: Option<Moves>,
    /// Pending jump.
    pub(crate) pending_jump: Option<Leap>,
    pub(crate) footsteps: Vec<Footstep>,
    /// Last requested forward speed, m/s.
    pub(crate) requested_mps: f32,
    start_from_character: GroundTransform,
    contact: [bool; 2],
    /// Controls to which the current step already responds.
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

    /// Sets the amount of standing motion: 0 is a still pose, 1 as the model's people move, 2 at most. A model without standing motion
    /// stands still.
    pub fn set_standing_motion(&mut self, amount: f32) {
        if let Some(life) = &mut self.life {
            life.set_amount(amount);
        }
    }

    /// Sets the mixture of the space's styles from the next step on, one weight each: weights as of
    /// [`GaitModel::styled`](footfall_model::GaitModel::styled). Missing and non-finite weights count as 0.
    ///
    /// Takes about a millisecond when weights change, and nothing otherwise. A standing walker adopts the new
    /// posture with its first step. A walker of a [`DynamicsModel`] has no styles.
    pub fn set_style_weights(&mut self, weights: &[f32]) {
        if let Steps::Styled(steps) = &mut self.steps {
            steps.set_style_weights(&self.skeleton, weights);
        }
    }

    /// Returns the seed in use: the initial one, or that of a restored state.
    pub fn seed(&self) -> u64 {
        self.config.seed
    }

    /// Returns the weights of the styles from the next step on.
    pub fn style_weights(&self) -> &[f32] {
        match &self.steps {
            Steps::Styled(steps) => &steps.blend().weights,
            Steps::Switching(_) => &[],
        }
    }

    /// Returns the speed that suits the model and this body best, that of its recordings, m/s.
    pub fn usual_speed_mps(&self) -> f32 {
        match &self.steps {
            Steps::Styled(steps) => steps.blend().model.speed.reference_mps as f32,
            Steps::Switching(steps) => steps.own_speed_mps as f32,
        }
    }

    /// Sets the level of detail, from the next step on.
    pub fn set_detail(&mut self, detail: Detail) {
        self.detail = detail;
    }

    /// Advances by `dt_secs` and writes the pose in the character's own space: above the ground point of
    /// [`start_from_character`](Self::start_from_character), facing +Z.
    ///
    /// A `dt_secs` of 0 gives the same pose again.
    pub fn step(&mut self, dt_secs: f32, controls: &Controls, out: &mut Pose) {
        let controls = &self.begin_frame(controls);
        if dt_secs > 0.0 {
            self.position += dt_secs.min(MAX_DT_SECS) * self.frame_rate_hz;
        }
        while self.position >= self.shape().timing.frames as f32 {
            let frames = self.shape().timing.frames as f32;
            if self.shape().amplitude.to < 1.0 && controls.is_standing() {
                self.position = frames;
                break;
            }
            self.position -= frames;
            self.next_step(controls);
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

    /// Writes the current pose, with all motion above the steps; `dt_secs` have passed.
    pub(crate) fn show(&mut self, dt_secs: f32, controls: &Controls, out: &mut Pose) {
        let between = self.frames();
        let plan_from_character = ground_between(between);
        let (frame, next, weight) = between;
        let (facing, _) = blend_near(frame.plan_from_ground, next.plan_from_ground, weight);
        let character_from_plan = facing.conjugate();
        // Between two frames a foot stands only if it does in both.
        let contact = core::array::from_fn(|side| {
            (frame.contact[side] || weight > 1.0 - SAME_FRAME)
                && (next.contact[side] || weight < SAME_FRAME)
        });
        frame.pose.interpolate_near(&next.pose, weight, out);
        out.root_position =
            character_from_plan * (out.root_position - plan_from_character.position);
        let root = Joint::Hips.index();
        out.rotations[root] = (character_from_plan * out.rotations[root]).normalize();
        self.live(dt_secs, out);
        self.contact = contact;
        self.pass_moves(dt_secs.clamp(0.0, MAX_DT_SECS), controls);
        self.start_from_character = self.plan_from_start.local(&plan_from_character);
        if let Some(flown) = self.moves.as_ref().and_then(|moves| moves.move_pose(out)) {
            let faced = from_heading(self.start_from_character.heading);
            self.start_from_character.position += faced * flown.place;
            self.contact = contact.map(|bears| bears && flown.bears);
        }
    }

    /// Adds the motion of a walker that stands, or has just begun to walk.
    fn live(&mut self, dt_secs: f32, out: &mut Pose) {
        let stands = self.is_standing();
        let Some(life) = &mut self.life else { return };
        if dt_secs > 0.0 {
            life.step(dt_secs.min(MAX_DT_SECS), stands);
        }
        if !life.is_still() {
            life.move_pose(&life.moment, Quat::IDENTITY, out);
        }
    }

    /// Updates the character's place without advancing time.
    pub(crate) fn tell_place(&mut self) {
        self.footsteps.clear();
        self.start_from_character = self.plan_from_start.local(&self.plan_from_character());
    }

    /// Returns the place and heading of the character relative to its start.
    pub fn start_from_character(&self) -> GroundTransform {
        self.start_from_character
    }

    /// Returns the initial contacts during the last [`step`](Self::step), oldest first.
    pub fn footsteps(&self) -> &[Footstep] {
        &self.footsteps
    }

    /// Returns the next landing of the swinging foot, in the character's current space, and the seconds until then, if the
    /// controls stay as they are. `None` for a walker that rests.
    pub fn next_footstep(&self) -> Option<(Footstep, f32)> {
        if self.is_standing() {
            return None;
        }
        let timing = &self.shape().timing;
        let side = timing.leading.other();
        let plant = self.steps.source().planted().plant(side)?;
        let footstep = Footstep::seen_from(&self.plan_from_character(), side, plant);
        let secs = (timing.frames as f32 - self.position) / self.frame_rate_hz;
        Some((footstep, secs.max(0.0)))
    }

    /// Returns true when the walker has stopped and rests.
    pub fn is_standing(&self) -> bool {
        let step = self.shape();
        step.amplitude.to < 1.0 && self.position >= step.timing.frames as f32
    }

    /// Returns the share of the current step that has passed; for a replanned step, of its rest.
    pub(crate) fn share_of_step(&self) -> f32 {
        self.position / self.shape().timing.frames as f32
    }

    /// Returns the gait of the current step.
    pub fn gait(&self) -> Gait {
        self.steps.source().gait()
    }

    /// Returns the contacts of the left and the right foot; both are false in the flight of a run.
    pub fn feet_in_contact(&self) -> [bool; 2] {
        self.contact
    }

    pub(crate) fn shape(&self) -> &StepShape {
        self.steps.source().shape()
    }

    pub(crate) fn next_step(&mut self, controls: &Controls) {
        let fastest = self.steps.source().fastest_mps();
        let step_controls = StepControls {
            leap_m: self.next_leap(controls),
            ..StepControls::after(self.shape().amplitude, *controls, fastest, self.detail)
        };
        self.steps.source_mut().advance(&step_controls);
        self.answered = None;
        let side = self.shape().timing.leading;
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

    /// Lets a step with a foot in the air respond to the current controls.
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
            // It may be obeyed a few frames later.
            return;
        }
        self.answered = Some(*controls);
    }

    /// Returns the frames before and after the current time, and the weight of the later one.
    fn frames(&self) -> (&PlantedFrame, &PlantedFrame, f32) {
        let frames = &self.steps.source().planted().frames;
        let step = self.shape();
        let last = step.ground_frames() - 1;
        let position = self.position / step.detail.stride() as f32;
        // A cast rounds towards zero, and a position is not below it.
        let first = (position as usize).min(last);
        let weight = position - first as f32;
        (&frames[first], &frames[first + 1], weight)
    }

    pub(crate) fn plan_from_character(&self) -> GroundTransform {
        ground_between(self.frames())
    }
}

/// Returns the place of the walker between two frames, with the weight of the later one.
fn ground_between((frame, next, weight): (&PlantedFrame, &PlantedFrame, f32)) -> GroundTransform {
    GroundTransform {
        position: frame.ground_position.lerp(next.ground_position, weight),
        heading: frame.ground_heading + weight * (next.ground_heading - frame.ground_heading),
    }
}
