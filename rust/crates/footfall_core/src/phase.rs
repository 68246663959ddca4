//! Phases of locomotion, named by the event that begins them.

use crate::behaviour::Behaviour;
use crate::joint::Side;
use core::fmt;

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
    /// A time has passed in standing.
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

    /// Name for reports.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Landing => "landing",
            Self::TakeOff => "take-off",
            Self::Crossing => "crossing",
            Self::HeelOff => "heel off",
            Self::Lowest => "lowest",
            Self::Apex => "apex",
            Self::Fastest => "fastest",
            Self::Interval => "interval",
        }
    }

    /// Returns true when it is an event of one foot.
    pub const fn has_side(self) -> bool {
        !matches!(self, Self::Lowest | Self::Apex | Self::Interval)
    }
}

/// Kind of a phase: behaviour, event and foot.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct PhaseKind {
    /// Behaviour of the body.
    pub behaviour: Behaviour,
    /// The event that begins it.
    pub start: PhaseStart,
    /// The foot that the event is of; left where it is of none.
    pub side: Side,
}

impl fmt::Display for PhaseKind {
    /// For example `walk, left landing`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (behaviour, start) = (self.behaviour.name(), self.start.name());
        if self.start.has_side() {
            return write!(f, "{behaviour}, {} {start}", self.side.name());
        }
        write!(f, "{behaviour}, {start}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_phase_is_told_by_what_begins_it() {
        let mut kind = PhaseKind {
            behaviour: Behaviour::Walk,
            start: PhaseStart::TakeOff,
            side: Side::Right,
        };
        assert_eq!(kind.to_string(), "walk, right take-off");
        kind.start = PhaseStart::Apex;
        assert_eq!(kind.to_string(), "walk, apex");
    }
}
