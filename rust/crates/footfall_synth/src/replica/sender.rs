//! Messages of a walker to others.

use super::clock::ReplicaClock;
use super::gate::Way;
use super::identity::tag;
use super::update::{Planned, UPDATE_BYTES, WalkUpdate};
use super::{ReplicaError, WalkIdentity};
use crate::controls::{Controls, GaitChoice};
use crate::gait::{AppliedControls, Gait};
use crate::generator::GaitGenerator;
use crate::moves::{Leap, Moves};
use crate::source::{Steps, StyledSteps};
use footfall_core::GroundTransform;
use footfall_core::rotation::from_heading;

/// Sender of one walker's identity and updates.
#[derive(Clone, Copy, Debug)]
pub struct WalkSender {
    secs: f64,
    way: Way,
    /// Times that the walker was put elsewhere.
    epoch: u8,
}

impl Default for WalkSender {
    fn default() -> Self {
        Self::new()
    }
}

impl WalkSender {
    /// One that has told nothing yet.
    pub const fn new() -> Self {
        Self {
            secs: 0.0,
            way: Way::sure(),
            epoch: 0,
        }
    }

    /// Lets time pass; call it in every frame.
    pub fn step(&mut self, dt_secs: f32) {
        if dt_secs > 0.0 && dt_secs.is_finite() {
            self.secs += f64::from(dt_secs);
            self.way.pass(dt_secs);
        }
    }

    /// Identity of the walker, for whoever is to follow it. Send it reliably, and again when it changes: after [`update`](Self::update) found the walker far from
    /// where it was, as after a jump through the level, when its styles change, and when it was restored from another walker's state.
    ///
    /// # Errors
    /// [`ReplicaError::Switching`].
    pub fn identity(&self, generator: &GaitGenerator) -> Result<WalkIdentity, ReplicaError> {
        WalkIdentity::of(generator, self.epoch)
    }

    /// An update about the walker, whose start is at `shared_from_start` in the space that all machines share. Any may be lost; send 15 to 30 a second.
    ///
    /// # Errors
    /// [`ReplicaError::Switching`] or [`ReplicaError::OutOfRange`].
    pub fn update(
        &mut self,
        generator: &GaitGenerator,
        shared_from_start: &GroundTransform,
    ) -> Result<[u8; UPDATE_BYTES], ReplicaError> {
        let Steps::Styled(steps) = &generator.steps else {
            return Err(ReplicaError::Switching);
        };
        let rests = generator.is_standing();
        let mut aim = generator.start_from_aim(rests);
        if let Some((leap, _)) = jump(generator) {
            // Where it lands.
            aim.position += from_heading(aim.heading) * leap.way;
        }
        let aim = shared_from_start.global(&aim);
        let mut update = WalkUpdate {
            tag: 0,
            time: ReplicaClock::ticks(self.secs),
            planned: Planned::of(steps.number(), steps.passed()),
            age_frames: generator.position as u8,
            controls: controls(steps, generator),
            rests,
            rise_m: rise_m(steps, generator),
            aim,
        };
        // A place that nobody can be told is none that the walker went to.
        update.pack()?;
        if self.way.go_on(aim.position).is_err() {
            self.epoch = self.epoch.wrapping_add(1);
            self.way = Way::sure();
        }
        update.tag = tag(steps.space.fingerprint(), &generator.config, self.epoch);
        update.pack()
    }
}

/// Controls that the current step obeys.
fn controls(steps: &StyledSteps, generator: &GaitGenerator) -> Controls {
    let AppliedControls {
        velocity_mps,
        turn_rate,
        stops,
        ..
    } = steps.applied;
    let crouch = generator.moves.as_ref().map(Moves::moment);
    let (velocity, turn_rate_radps) = if stops {
        (glam::Vec2::ZERO, 0.0)
    } else if steps.applied == AppliedControls::default() {
        // The first step was not asked to be anything.
        (steps.velocity_mps, 0.0)
    } else {
        (velocity_mps, turn_rate)
    };
    Controls {
        speed_mps: velocity.length(),
        turn_rate_radps,
        direction_rad: velocity.x.atan2(velocity.y),
        gait: match generator.gait() {
            Gait::Walk => GaitChoice::Walk,
            Gait::Run => GaitChoice::Run,
        },
        crouch: crouch.map_or(0.0, |(crouch, ..)| crouch.amount),
    }
}

/// Rise of the jump that is made.
fn rise_m(steps: &StyledSteps, generator: &GaitGenerator) -> f32 {
    let leap = steps.window.origin().request.leap_m;
    leap.or(jump(generator).map(|(leap, _)| leap.rise_m))
        .unwrap_or(0.0)
}

/// The jump off both feet that is made, and the time since it began.
fn jump(generator: &GaitGenerator) -> Option<(Leap, f32)> {
    generator.moves.as_ref()?.moment().2
}
