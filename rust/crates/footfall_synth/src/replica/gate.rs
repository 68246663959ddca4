//! Gate against messages that no honest peer sends: other walkers, the past, floods, and places out of walking range.

use super::ReplicaError;
use super::clock::HALF_ROUND_SECS;
use super::update::WalkUpdate;
use glam::Vec3;

/// Accepted updates per second, and at once.
const MOST_A_SECOND: u32 = 100;
const MOST_AT_ONCE: f32 = 30.0;

/// Accepted speed, m/s, above that of runners; and accepted distance at once and after silence, metres: a replanned step changes its end
/// suddenly.
const MOST_MPS: f32 = 8.0;
const WAY_AT_ONCE_M: f32 = 5.0;
const WAY_AFTER_SILENCE_M: f32 = 40.0;

/// Share of these limits beyond which a sender expects to be refused.
const SURE: f32 = 0.8;

/// Accepted identities per second, and at once.
const IDENTITIES_A_SECOND: f32 = 1.0;
const IDENTITIES_AT_ONCE: f32 = 4.0;

/// Allowance that grows with time and is consumed.
#[derive(Clone, Copy, Debug)]
struct Allowance {
    left: f32,
    by_second: f32,
    most: f32,
}

impl Allowance {
    const fn new(left: f32, by_second: f32, most: f32) -> Self {
        Self {
            left,
            by_second,
            most,
        }
    }

    fn grow(&mut self, secs: f32) {
        self.left = (self.left + secs * self.by_second).min(self.most);
    }

    fn take(&mut self, much: f32) -> bool {
        let enough = much <= self.left;
        if enough {
            self.left -= much;
        }
        enough
    }
}

/// Distance that a walker may have covered.
#[derive(Clone, Copy, Debug)]
pub(super) struct TravelLimit {
    allowance: Allowance,
    last: Option<Vec3>,
}

impl TravelLimit {
    /// Creates the limits of a receiver.
    pub(super) const fn believed() -> Self {
        Self {
            allowance: Allowance::new(WAY_AT_ONCE_M, MOST_MPS, WAY_AFTER_SILENCE_M),
            last: None,
        }
    }

    /// Creates the stricter limits of a sender.
    pub(super) const fn sure() -> Self {
        let most = SURE * WAY_AT_ONCE_M;
        Self {
            allowance: Allowance::new(most, SURE * MOST_MPS, most),
            last: None,
        }
    }

    /// Advances by a time.
    pub(super) fn pass(&mut self, secs: f32) {
        self.allowance.grow(secs);
    }

    /// Moves to a place.
    ///
    /// # Errors
    /// The distance, when it is too far.
    pub(super) fn go_on(&mut self, place: Vec3) -> Result<(), f32> {
        let distance = self.last.map_or(0.0, |last| last.distance(place));
        if !self.allowance.take(distance) {
            return Err(distance);
        }
        self.last = Some(place);
        Ok(())
    }
}

/// Guard of one walker.
#[derive(Clone, Copy, Debug)]
pub(super) struct Gate {
    tag: u16,
    messages: Allowance,
    identities: Allowance,
    travel: TravelLimit,
    last_time: Option<u16>,
    silent_secs: f32,
}

impl Gate {
    pub(super) const fn new(tag: u16) -> Self {
        Self {
            tag,
            messages: Allowance::new(MOST_AT_ONCE, MOST_A_SECOND as f32, MOST_AT_ONCE),
            identities: Allowance::new(IDENTITIES_AT_ONCE, IDENTITIES_A_SECOND, IDENTITIES_AT_ONCE),
            travel: TravelLimit::believed(),
            last_time: None,
            silent_secs: 0.0,
        }
    }

    /// Advances by a time.
    pub(super) fn pass(&mut self, secs: f32) {
        self.messages.grow(secs);
        self.identities.grow(secs);
        self.travel.pass(secs);
        self.silent_secs += secs;
    }

    /// Accepts an identity; a different walker may be anywhere. Returns true if it is different.
    ///
    /// # Errors
    /// [`ReplicaError::Flood`].
    pub(super) fn become_walker(&mut self, tag: u16) -> Result<bool, ReplicaError> {
        if !self.identities.take(1.0) {
            return Err(ReplicaError::Flood(IDENTITIES_A_SECOND as u32));
        }
        let another = tag != self.tag;
        if another {
            self.tag = tag;
            self.travel = TravelLimit::believed();
        }
        Ok(another)
    }

    /// Accepts an update.
    ///
    /// # Errors
    /// Reason to refuse it.
    pub(super) fn check(&mut self, update: &WalkUpdate) -> Result<(), ReplicaError> {
        if !self.messages.take(1.0) {
            return Err(ReplicaError::Flood(MOST_A_SECOND));
        }
        if update.tag != self.tag {
            return Err(ReplicaError::OtherWalker);
        }
        if let Some(last) = self.last_time
            && update.time.wrapping_sub(last).cast_signed() <= 0
            && f64::from(self.silent_secs) < HALF_ROUND_SECS
        {
            return Err(ReplicaError::Old);
        }
        self.travel
            .go_on(update.aim.position)
            .map_err(ReplicaError::TooFar)?;
        self.last_time = Some(update.time);
        self.silent_secs = 0.0;
        Ok(())
    }
}
