//! Phases of locomotion, named by the event that begins them.

use crate::behaviour::Behaviour;
use crate::joint::Side;

/// The event that begins a phase. Where events coincide, the one that is listed first counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(u8)]
pub enum PhaseStart {
    /// A foot comes down on the ground.
    Landing,
    /// A foot has left the ground.
    TakeOff,
    /// The ankle of a swinging foot passes the other.
    Crossing,
    /// The heel of a standing foot rises.
    HeelOff,
    /// The hips are lowest between two flights.
    Lowest,
    /// The hips are highest in a flight.
    Apex,
    /// A foot that swings sideways is fastest.
    Fastest,
    /// So much time has passed in standing.
    Interval,
}

impl PhaseStart {
    /// Every event, in order.
    pub const ALL: [Self; 8] = [
        Self::Landing,
        Self::TakeOff,
        Self::Crossing,
        Self::HeelOff,
        Self::Lowest,
        Self::Apex,
        Self::Fastest,
        Self::Interval,
    ];
}

/// What a phase is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct PhaseKind {
    /// What the body does.
    pub behaviour: Behaviour,
    /// The event that begins it.
    pub start: PhaseStart,
    /// The foot that the event is of; left where it is of none.
    pub side: Side,
}
