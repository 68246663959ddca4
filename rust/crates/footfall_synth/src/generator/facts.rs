//! Settings of a generator, and facts about its walk.

use super::GaitGenerator;
use crate::detail::Detail;
use crate::footstep::Footstep;
use crate::gait::Gait;
use crate::source::Steps;
use footfall_core::GroundTransform;

impl GaitGenerator {
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
    /// posture with its first step. A walker of a [`DynamicsModel`](footfall_model::DynamicsModel) has no styles.
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
}
