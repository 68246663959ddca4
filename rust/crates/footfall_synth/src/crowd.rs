//! Walkers by the thousand: each near one keeps a step in a few kilobytes, those far away share theirs, and all share what works steps out.
//!
//! A [`GaitGenerator`](crate::GaitGenerator) owns the buffers in which its steps are solved, some hundred kilobytes. A
//! [`CrowdWalker`] borrows them from a [`Workshop`], one a thread, for a moment about twice a second, and keeps the result: where every
//! joint is in each frame of its step. In between it costs an interpolation. One that is far away walks in steps that were worked out once for everybody
//! ([`shared`]), and keeps no more than its place among them ([`stroll`]).

mod alone;
mod feet;
mod frames;
mod led;
mod own;
mod own_step;
mod recorded;
mod rest;
mod shared;
mod stroll;
mod workshop;

use crate::config::{GeneratorConfig, MAX_DT_SECS};
use crate::controls::Controls;
use crate::detail::Detail;
use crate::error::SynthError;
use crate::footstep::Footstep;
use footfall_core::GroundTransform;
pub use frames::CrowdPose;
pub use led::{LedAim, LedBeginning, LedStep};
use own::{Chance, OwnWalk};
pub use stroll::SharedPose;
use stroll::Stroll;
pub use workshop::{StyledBody, Workshop};

/// One walker of a crowd: walks as a [`GaitGenerator`](crate::GaitGenerator) of its seed would, in a hundredth of the memory, or in steps that it shares with others, in a hundredth of
/// that.
///
/// Its speed is that of the average walker of its styles: people of the same crowd who are asked for the same speed differ by a few
/// percent.
#[derive(Debug)]
pub struct CrowdWalker {
    config: GeneratorConfig,
    styled: StyledBody,
    /// Its own steps: those that it walks in, or, beside shared ones, those that it came from, as long as their last pose still shows.
    own: Option<Box<OwnWalk>>,
    /// Place among the shared steps that it walks in.
    stroll: Option<Stroll>,
    /// True when it is to share steps.
    repeating: bool,
    detail: Detail,
    standing_motion: f32,
    /// Place in the sequence of chance from which its next own step goes on.
    chance: Chance,
    start_from_character: GroundTransform,
    footstep: Option<Footstep>,
}

/// Time in which the last own pose of somebody who stands dies away, seconds.
const LEAVING_SECS: f32 = 0.5;

impl CrowdWalker {
    /// A walker at the origin, facing +Z, walking already at the speed that suits it; or standing.
    ///
    /// # Errors
    /// [`SynthError`] when a setting is not finite or the model gives no trajectory.
    pub fn new(
        styled: &StyledBody,
        config: &GeneratorConfig,
        standing: bool,
        workshop: &mut Workshop,
    ) -> Result<Self, SynthError> {
        let own = OwnWalk::new(styled, config, standing, workshop)?;
        Ok(Self {
            own: Some(Box::new(own)),
            stroll: None,
            repeating: false,
            ..Self::sharing(styled, config)
        })
    }

    /// A walker of the same kind who walks in shared steps from the first one on. It costs next to nothing.
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

    /// Sets how much it moves as it stands, as of [`GaitGenerator::set_standing_motion`](crate::GaitGenerator::set_standing_motion). Shows within a second. In shared steps it moves as people do,
    /// or not at all.
    pub fn set_standing_motion(&mut self, amount: f32) {
        self.standing_motion = amount;
        let life = self.own.as_mut().and_then(|own| own.life.as_mut());
        if let Some(life) = life {
            life.set_amount(amount);
        }
    }

    /// Wears other styles from the next step on. They must be of the same model and body.
    pub fn wear(&mut self, styled: &StyledBody) {
        self.styled = styled.clone();
        if let Some(own) = &mut self.own {
            own.styled = styled.clone();
        }
    }

    /// Sets the detail in which its own steps are worked out, from the next one on.
    pub fn set_detail(&mut self, detail: Detail) {
        self.detail = detail;
        if let Some(own) = &mut self.own {
            own.detail = detail;
        }
    }

    /// Sets whether it walks in steps that all who wear the same share instead of its own, for walkers far away, from the next step on. They are of one of two dozen speeds each and as alike as
    /// those of two people; its memory for own steps goes to who needs it next.
    pub fn set_repeating(&mut self, repeating: bool) {
        self.repeating = repeating;
    }

    /// Advances by `dt_secs`. Allocates nothing, but for a step that is longer than any before, for the first rest, and for own steps of more walkers than ever.
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

    /// Lets time pass in its own step; what is left where that has ended and others are to follow that it shares, seconds.
    fn step_own(&mut self, secs: f32, controls: Controls, workshop: &mut Workshop) -> Option<f32> {
        let own = self.own.as_mut()?;
        let left = own.step(secs, controls, self.repeating, workshop);
        self.footstep = own.footstep.or(self.footstep);
        let left = left?;
        let end = own.start_from_character();
        let step = (own.side(), own.speed_mps());
        let steps = self.styled.0.shared();
        self.stroll = Some(Stroll::after(self.config.seed, &end, step, steps));
        self.chance = own.chance;
        Some(left)
    }

    /// Lets time pass in a step that it shares; what is left where that has ended, seconds.
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

    /// Goes on in steps of its own from the end of one that it shared, if it can.
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
        own.live(0.0, workshop);
        self.own = Some(own);
        self.stroll = None;
        Some(())
    }

    /// Place and heading of the character, from where it began.
    pub fn start_from_character(&self) -> GroundTransform {
        self.start_from_character
    }

    /// Seconds until the next step begins, 0 for someone who rests.
    pub fn secs_to_next_step(&self) -> f32 {
        match (&self.stroll, &self.own) {
            (Some(stroll), _) => stroll.secs_to_next_step(self.styled.0.shared()),
            (None, own) => own.as_ref().map_or(0.0, |own| own.secs_to_next_step()),
        }
    }

    /// Seconds since the current step began; for one who rests, since that was over, the length of the step.
    pub fn secs_of_step(&self) -> f32 {
        match (&self.stroll, &self.own) {
            (Some(stroll), _) => stroll.secs_of_step(self.styled.0.shared()),
            (None, own) => own.as_ref().map_or(0.0, |own| own.secs_of_step()),
        }
    }

    /// Returns whether it has come to a stand and rests.
    pub fn is_standing(&self) -> bool {
        match (&self.stroll, &self.own) {
            (Some(stroll), _) => stroll.is_standing(),
            (None, own) => own.as_ref().is_none_or(|own| own.is_standing()),
        }
    }

    /// Share of its stride that is behind it: 0 when the left foot lands, 0.5 when the right one does.
    pub fn phase(&self) -> f32 {
        match (&self.stroll, &self.own) {
            (Some(stroll), _) => stroll.phase(),
            (None, own) => own.as_ref().map_or(0.0, |own| own.phase()),
        }
    }

    /// Has memory bring what [`pose`](Self::pose) reads. Worth it for several walkers in a row, whose poses are then asked for in the same
    /// order: they lie in no cache.
    pub fn fetch_pose(&self) {
        if let Some(own) = &self.own {
            own.fetch_pose();
        }
    }

    /// The same for what a [`step`](Self::step) reads that stays within a step.
    pub fn fetch_place(&self) {
        if let Some(own) = &self.own {
            own.fetch_place();
        }
    }

    /// Writes how it is posed in its own space.
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
            // What it was away from the shared step as that began dies away.
            steps.shift(out, stroll.first_pose(), last, stroll.leaving(LEAVING_SECS));
        }
    }

    /// Its pose so many seconds ago, fewer than a step takes, among those that all who wear the same [share](StyledBody::shared_pose), and the number of the [`StyledBody`]; `None` while it
    /// takes steps of its own.
    pub fn shared_pose(&self, ago_secs: f32) -> Option<(u32, SharedPose)> {
        let stroll = self.stroll.as_ref()?;
        let look = stroll.look(ago_secs, self.styled.0.shared());
        Some((self.styled.1, look))
    }

    /// Returns whether it takes steps of its own, or its pose comes from one still.
    pub fn has_own_steps(&self) -> bool {
        self.own.is_some()
    }
}
