//! Versions of the layout of saved states.

use serde::de::DeserializeOwned;

/// Version of the layout that this build writes, and the oldest that it reads.
pub(super) const VERSION: u8 = since::BODIES_RIGHT;
pub(super) const OLDEST: u8 = 4;

/// Versions from which states have a part.
pub(super) mod since {
    pub(in super::super) const STANDING: u8 = 5;
    pub(in super::super) const RUNNING: u8 = 6;
    /// Steps that change in their middle, and jumps.
    pub(in super::super) const MOVING: u8 = 7;
    pub(in super::super) const BALANCE: u8 = 8;
    pub(in super::super) const CLIMBING: u8 = 9;
    /// Corrections of the way.
    pub(in super::super) const LED: u8 = 10;
    /// Pending jumps relative to the start of the walk; relative to the character before.
    pub(in super::super) const JUMPS_FROM_START: u8 = 11;
    pub(in super::super) const LEGS_LEAN: u8 = 12;
    pub(in super::super) const PUSHES_BUILD_UP: u8 = 13;
    pub(in super::super) const FEET_SPREAD: u8 = 14;
    pub(in super::super) const HEADS_TURN: u8 = 15;
    /// Bodies that come to rest leaning.
    pub(in super::super) const BODIES_RIGHT: u8 = 16;
}

/// Parts that follow a [`State`](super::State), of which earlier versions have the first ones.
pub(super) struct Parts<'a> {
    pub(super) version: u8,
    rest: &'a [u8],
}

impl<'a> Parts<'a> {
    pub(super) fn new(version: u8, rest: &'a [u8]) -> Self {
        Self { version, rest }
    }

    /// Reads the next part, which states have `since` this version; that of `earlier` ones is given.
    pub(super) fn next<T: DeserializeOwned>(
        &mut self,
        since: u8,
        earlier: T,
    ) -> postcard::Result<T> {
        if self.version < since {
            return Ok(earlier);
        }
        let (part, rest) = postcard::take_from_bytes(self.rest)?;
        self.rest = rest;
        Ok(part)
    }
}
