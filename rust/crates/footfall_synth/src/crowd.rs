//! Crowds: thousands of walkers that share the buffers of step generation and, far away, the steps themselves.
//!
//! A [`GaitGenerator`](crate::GaitGenerator) owns the buffers in which its steps are solved, some hundred kilobytes. A
//! [`CrowdWalker`] borrows them from a [`Workshop`], one a thread, for a moment about twice a second, and keeps the result: the place of every
//! joint in each frame of its step. Between two steps it costs an interpolation. A distant one walks in steps that were generated once for all walkers
//! ([`shared`]), and only keeps its place among them ([`stroll`]).

mod alone;
mod ending;
mod feet;
mod frames;
mod led;
mod led_step;
mod own;
mod own_step;
mod recorded;
mod rest;
mod shared;
mod stroll;
mod styled_body;
mod tools;
mod workshop;

use crate::config::{GeneratorConfig, MAX_DT_SECS};
use crate::controls::Controls;
use crate::detail::Detail;
use crate::error::SynthError;
use crate::footstep::Footstep;
use ending::Chance;
use footfall_core::GroundTransform;
pub use frames::CrowdPose;
pub use led_step::{LedAim, LedBeginning, LedStep};
use own::OwnWalk;
pub use stroll::SharedPose;
use stroll::Stroll;
pub use styled_body::StyledBody;
pub use workshop::Workshop;

/// One walker of a crowd: walks as a [`GaitGenerator`](crate::GaitGenerator) of its seed would, in a hundredth of the memory, or in steps that it shares with others, in a hundredth of
/// that.
///
/// Its paces are those of the average walker of its styles: with the same requested speed, the speeds of people in a crowd differ by a few
/// percent.
#[derive(Debug)]
pub struct CrowdWalker {
    config: GeneratorConfig,
    styled: StyledBody,
    /// Own steps: the current ones or, in shared steps, the previous ones as long as their last pose still shows.
    own: Option<Box<OwnWalk>>,
    /// Place among the shared steps, while it walks in them.
    stroll: Option<Stroll>,
    /// True when it shares steps from the next one on.
    repeating: bool,
    detail: Detail,
    standing_motion: f32,
    /// Progress of chance at its next own step.
    chance: Chance,
    start_from_character: GroundTransform,
    footstep: Option<Footstep>,
}

/// Time in which the last own pose of a standing walker fades, seconds.
const LEAVING_SECS: f32 = 0.5;

impl CrowdWalker {
    /// Creates a walker at the origin, facing +Z, that walks at its usual speed or stands.
    ///
    /// # Errors
    /// [`SynthError`] when a setting is not finite or the model gives no trajectory.
    pub fn new(
        styled: &StyledBody,
        config: &GeneratorConfig,
        standing: bool,
        workshop: &mut Workshop,
    ) -> Result<Self, SynthError> {
        let own = OwnWalk::new(styled, config, standing, &mut workshop.tools)?;
        Ok(Self {
            own: Some(Box::new(own)),
            stroll: None,
            repeating: false,
            ..Self::sharing(styled, config)
        })
    }

    /// Creates a walker in shared steps, at almost no cost.
    pub fn sharing(styled: &StyledBody, config: &GeneratorConfig) -> Self {
        let phase = if config.phase.is_finite() {
            config.phase
        } else {
            0.0
        };
        let mut stroll = Stroll::new(config.seed, styled.usual_speed_mps(), phase);
        stroll.be_at(&GroundTransform::default(), styled.0.shared());
        Self {
            config: *config,
            styled: styled.clone(),
            own: None,
            stroll: Some(stroll),
            repeating: true,
            detail: Detail::Full,
            standing_motion: 1.0,
            chance: Chance::default(),
            start_from_character: GroundTransform::default(),
            footstep: None,
        }
    }

    /// Lets the walker stand, instead of beginning in the middle of a step. Call it before its first [`step`](Self::step).
    pub fn stand(&mut self) {
        let mut stroll = Stroll::standing(self.config.seed, self.phase());
        stroll.be_at(&self.start_from_character, self.styled.0.shared());
        self.stroll = Some(stroll);
        self.own = None;
    }

    /// Sets the amount of standing motion, as of [`GaitGenerator::set_standing_motion`](crate::GaitGenerator::set_standing_motion). Takes effect within a second. In shared steps the amount is 1
    /// or 0.
    pub fn set_standing_motion(&mut self, amount: f32) {
        self.standing_motion = amount;
        let life = self.own.as_mut().and_then(|own| own.life.as_mut());
        if let Some(life) = life {
            life.set_amount(amount);
        }
    }

    /// Changes the styles from the next step on. They must be of the same model and body.
    pub fn wear(&mut self, styled: &StyledBody) {
        self.styled = styled.clone();
        if let Some(own) = &mut self.own {
            own.styled = styled.clone();
        }
    }

    /// Sets the level of detail of its own steps, from the next one on.
    pub fn set_detail(&mut self, detail: Detail) {
        self.detail = detail;
        if let Some(own) = &mut self.own {
            own.detail = detail;
        }
    }

    /// Switches between own steps and steps shared by all walkers of its [`StyledBody`], for distant walkers, from the next step on. Shared steps have one of two dozen speeds and are
    /// those of two people. The memory for own steps is handed on to other walkers.
    pub fn set_repeating(&mut self, repeating: bool) {
        self.repeating = repeating;
    }

    /// Advances by `dt_secs`. Allocates only for a step longer than all previous ones, for the first rest, and for own steps of more walkers than before.
    pub fn step(&mut self, dt_secs: f32, controls: Controls, workshop: &mut Workshop) {
        self.footstep = None;
        let passes = dt_secs > 0.0;
        let mut left = Some(if passes {
            dt_secs.min(MAX_DT_SECS)
        } else {
            0.0
        });
        while let Some(secs) = left {
            left = if self.stroll.is_some() {
                self.step_shared(secs, controls, workshop)
            } else {
                self.step_own(secs, controls, workshop)
            };
        }
        self.start_from_character = match (&self.stroll, &self.own) {
            (Some(stroll), _) => stroll.place(self.styled.0.shared()),
            (None, Some(own)) => own.start_from_character(),
            (None, None) => self.start_from_character,
        };
    }

    /// Advances in its own steps; returns the remaining time if shared steps are to follow, seconds.
    fn step_own(&mut self, secs: f32, controls: Controls, workshop: &mut Workshop) -> Option<f32> {
        let own = self.own.as_mut()?;
        let left = own.step(secs, controls, self.repeating, &mut workshop.tools);
        self.footstep = own.footstep.or(self.footstep);
        let left = left?;
        let end = own.start_from_character();
        let step = (own.side(), own.speed_mps());
        let steps = self.styled.0.shared();
        self.stroll = Some(Stroll::after(self.config.seed, &end, step, steps));
        self.chance = own.chance;
        Some(left)
    }

    /// Advances in a shared step; returns the remaining time after its end, seconds.
    fn step_shared(
        &mut self,
        secs: f32,
        controls: Controls,
        workshop: &mut Workshop,
    ) -> Option<f32> {
        let stroll = self.stroll.as_mut()?;
        let steps = self.styled.0.shared();
        let left = stroll.pass(secs, self.standing_motion > 0.0, steps);
        if self.own.is_some() && stroll.leaving(LEAVING_SECS) <= 0.0 {
            workshop.spare(self.own.take());
        }
        let left = left?;
        if !self.repeating && self.go_alone(workshop).is_some() {
            return Some(left);
        }
        let stroll = self.stroll.as_mut()?;
        let steps = self.styled.0.shared();
        self.footstep = Some(stroll.next(controls, steps)?);
        Some(left)
    }

    /// Continues in own steps from the end of a shared one, if possible.
    fn go_alone(&mut self, workshop: &mut Workshop) -> Option<()> {
        let stroll = self.stroll.as_ref()?;
        let steps = self.styled.0.shared();
        let shared = steps.step(stroll.ending())?;
        let own = self.own.take().or_else(|| workshop.spares.pop());
        let mut own = own
            .unwrap_or_else(|| Box::new(OwnWalk::from_shared(&self.styled, &self.config, shared)));
        own.go_on_from(
            (&self.styled, &self.config),
            (shared, steps.last_pose(stroll.ending())),
            &stroll.place(steps),
            (self.chance, stroll.rest_secs()),
        );
        own.detail = self.detail;
        if let Some(life) = &mut own.life {
            life.set_amount(self.standing_motion);
        }
        own.live(0.0, &mut workshop.tools);
        self.own = Some(own);
        self.stroll = None;
        Some(())
    }

    /// Returns the place and heading of the character relative to its start.
    pub fn start_from_character(&self) -> GroundTransform {
        self.start_from_character
    }

    /// Returns the time until the next step begins, seconds; 0 for a resting walker.
    pub fn secs_to_next_step(&self) -> f32 {
        match (&self.stroll, &self.own) {
            (Some(stroll), _) => stroll.secs_to_next_step(self.styled.0.shared()),
            (None, own) => own.as_ref().map_or(0.0, |own| own.secs_to_next_step()),
        }
    }

    /// Returns the time since the current step began, seconds; for a resting walker its duration.
    pub fn secs_of_step(&self) -> f32 {
        match (&self.stroll, &self.own) {
            (Some(stroll), _) => stroll.secs_of_step(self.styled.0.shared()),
            (None, own) => own.as_ref().map_or(0.0, |own| own.secs_of_step()),
        }
    }

    /// Returns true when the walker has stopped and rests.
    pub fn is_standing(&self) -> bool {
        match (&self.stroll, &self.own) {
            (Some(stroll), _) => stroll.is_standing(),
            (None, own) => own.as_ref().is_none_or(|own| own.is_standing()),
        }
    }

    /// Returns the phase of the stride: 0 at the left foot's landing, 0.5 at the right one's.
    pub fn phase(&self) -> f32 {
        match (&self.stroll, &self.own) {
            (Some(stroll), _) => stroll.phase(),
            (None, own) => own.as_ref().map_or(0.0, |own| own.phase()),
        }
    }

    /// Prefetches the memory that [`pose`](Self::pose) reads. Useful for several walkers in a row, whose poses are then read in the same
    /// order and are in no cache.
    pub fn fetch_pose(&self) {
        if let Some(own) = &self.own {
            own.fetch_pose();
        }
    }

    /// Prefetches the memory that a [`step`](Self::step) without a new step reads.
    pub fn fetch_place(&self) {
        if let Some(own) = &self.own {
            own.fetch_place();
        }
    }

    /// Writes the pose in the character's own space.
    pub fn pose(&self, out: &mut CrowdPose) {
        let Some(stroll) = &self.stroll else {
            if let Some(own) = &self.own {
                own.pose(out);
            }
            return;
        };
        let steps = self.styled.0.shared();
        steps.write(&stroll.look(0.0, steps), out);
        if let Some(last) = self.own.as_ref().and_then(|own| own.frames.last_pose()) {
            // The difference from the shared step at its beginning fades.
            steps.shift(out, stroll.first_pose(), last, stroll.leaving(LEAVING_SECS));
        }
    }

    /// Returns the pose among the [shared](StyledBody::shared_pose) ones a number of seconds ago, less than a step, and the number of the [`StyledBody`]; `None` while it
    /// walks in own steps.
    pub fn shared_pose(&self, ago_secs: f32) -> Option<(u32, SharedPose)> {
        let stroll = self.stroll.as_ref()?;
        let look = stroll.look(ago_secs, self.styled.0.shared());
        Some((self.styled.1, look))
    }

    /// Returns true when it walks in own steps, or still shows a pose of one.
    pub fn has_own_steps(&self) -> bool {
        self.own.is_some()
    }
}
