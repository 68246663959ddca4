//! Sender of a walker's messages.

use super::clock::ReplicaClock;
use super::gate::TravelLimit;
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
    travel: TravelLimit,
    /// Number of times the walker was moved elsewhere.
    epoch: u8,
}

impl Default for WalkSender {
    fn default() -> Self {
        Self::new()
    }
}

impl WalkSender {
    /// Creates a sender.
    pub const fn new() -> Self {
        Self {
            secs: 0.0,
            travel: TravelLimit::sure(),
            epoch: 0,
        }
    }

    /// Advances by a time; call it in every frame.
    pub fn step(&mut self, dt_secs: f32) {
        if dt_secs > 0.0 && dt_secs.is_finite() {
            self.secs += f64::from(dt_secs);
            self.travel.pass(dt_secs);
        }
    }

    /// Returns the identity of the walker for its followers. Send it reliably, and again when it changes: after [`update`](Self::update) found the walker far from
    /// its last place, as after a teleport, when its styles change, and after a restore of another walker's state.
    ///
    /// # Errors
    /// [`ReplicaError::Switching`].
    pub fn identity(&self, generator: &GaitGenerator) -> Result<WalkIdentity, ReplicaError> {
        WalkIdentity::of(generator, self.epoch)
    }

    /// Returns an update about the walker, whose start is at `shared_from_start` in the space that all machines share. Any may be lost; send 15 to 30 a second.
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
            // The landing place.
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
            brakes: brakes(steps, generator),
            rise_m: rise_m(steps, generator),
            aim,
        };
        // A place out of range cannot be sent, so it does not count as reached.
        update.pack()?;
        if self.travel.go_on(aim.position).is_err() {
            self.epoch = self.epoch.wrapping_add(1);
            self.travel = TravelLimit::sure();
        }
        update.tag = tag(steps.space.fingerprint(), &generator.config, self.epoch);
        update.pack()
    }
}

/// Returns the controls of the current step.
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
        // The very first step has no controls.
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

/// Returns true when the current step brings the feet together or is one of a run that slows down.
fn brakes(steps: &StyledSteps, generator: &GaitGenerator) -> bool {
    match generator.gait() {
        Gait::Walk => generator.comes_to_rest(),
        Gait::Run => steps.window.origin().request.run_slows(),
    }
}

/// Returns the rise of the current jump.
fn rise_m(steps: &StyledSteps, generator: &GaitGenerator) -> f32 {
    let leap = steps.window.origin().request.leap_m;
    leap.or(jump(generator).map(|(leap, _)| leap.rise_m))
        .unwrap_or(0.0)
}

/// Returns the two-footed jump under way, and the time since its beginning.
fn jump(generator: &GaitGenerator) -> Option<(Leap, f32)> {
    generator.moves.as_ref()?.moment().2
}
