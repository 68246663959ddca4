//! Guard against what no honest peer sends: other walkers, the past, floods, and places that nobody walks to.

use super::ReplicaError;
use super::clock::HALF_ROUND_SECS;
use super::update::WalkUpdate;
use glam::Vec3;

/// Updates that are heard in a second, and at once.
const MOST_A_SECOND: u32 = 100;
const MOST_AT_ONCE: f32 = 30.0;

/// Speed that is believed, m/s, above that of runners; and the way that is believed at once and after silence, metres: a step that is planned anew ends elsewhere
/// all at once.
const MOST_MPS: f32 = 8.0;
const WAY_AT_ONCE_M: f32 = 5.0;
const WAY_AFTER_SILENCE_M: f32 = 40.0;

/// Share of that by which a sender knows that it will not be believed.
const SURE: f32 = 0.8;

/// Identities that are taken in a second, and at once.
const IDENTITIES_A_SECOND: f32 = 1.0;
const IDENTITIES_AT_ONCE: f32 = 4.0;

/// Allowance that grows with time and is used up.
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

/// Way that a walker is believed to have come.
#[derive(Clone, Copy, Debug)]
pub(super) struct Way {
    allowance: Allowance,
    last: Option<Vec3>,
}

impl Way {
    /// As others believe it.
    pub(super) const fn believed() -> Self {
        Self {
            allowance: Allowance::new(WAY_AT_ONCE_M, MOST_MPS, WAY_AFTER_SILENCE_M),
            last: None,
        }
    }

    /// As the walker itself can be sure that others do.
    pub(super) const fn sure() -> Self {
        let most = SURE * WAY_AT_ONCE_M;
        Self {
            allowance: Allowance::new(most, SURE * MOST_MPS, most),
            last: None,
        }
    }

    /// Lets time pass.
    pub(super) fn pass(&mut self, secs: f32) {
        self.allowance.grow(secs);
    }

    /// Goes on to a place.
    ///
    /// # Errors
    /// The distance, when it is too far.
    pub(super) fn go_on(&mut self, place: Vec3) -> Result<(), f32> {
        let way = self.last.map_or(0.0, |last| last.distance(place));
        if !self.allowance.take(way) {
            return Err(way);
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
    way: Way,
    last_time: Option<u16>,
    silent_secs: f32,
}

impl Gate {
    pub(super) const fn new(tag: u16) -> Self {
        Self {
            tag,
            messages: Allowance::new(MOST_AT_ONCE, MOST_A_SECOND as f32, MOST_AT_ONCE),
            identities: Allowance::new(IDENTITIES_AT_ONCE, IDENTITIES_A_SECOND, IDENTITIES_AT_ONCE),
            way: Way::believed(),
            last_time: None,
            silent_secs: 0.0,
        }
    }

    /// Lets time pass.
    pub(super) fn pass(&mut self, secs: f32) {
        self.messages.grow(secs);
        self.identities.grow(secs);
        self.way.pass(secs);
        self.silent_secs += secs;
    }

    /// Takes an identity, with which a walker that is another may be anywhere; whether it is.
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
            self.way = Way::believed();
        }
        Ok(another)
    }

    /// Lets an update in.
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
        self.way
            .go_on(update.aim.position)
            .map_err(ReplicaError::TooFar)?;
        self.last_time = Some(update.time);
        self.silent_secs = 0.0;
        Ok(())
    }
}
