//! Locomotion of any kind cut into phases at contacts, crossings and extremes.
//!
//! Walking has the eight phases of Mousas 2017, table 1: each half of the cycle begins with an initial contact (loading response), goes on when
//! the other foot leaves the ground (mid-stance), when the ankles pass each other (terminal stance) and when the standing heel rises
//! (until the other foot lands); seen from the other leg the same four are pre-swing, initial, mid- and terminal swing. A phase is named by
//! the event that begins it, so that running, where the order differs, needs no rules of its own. Jumps and hops are cut where
//! the hips are highest in the air and lowest on the ground, sidesteps where the swinging foot is fastest, standing at equal intervals.

mod behaviours;
mod track;

use crate::contacts::Contacts;
use behaviours::behaviours_of;
use footfall_core::{Behaviour, Clip, FrameSpan, PhaseKind, PhaseStart, Side};
use track::{Track, flights, last_standing};

/// Least duration of a phase, seconds: an event that follows another more closely begins none.
const LEAST_SECS: f64 = 0.05;

/// Standing is cut at this interval, seconds.
const STAND_SECS: f64 = 0.4;

/// A phase of a clip.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Phase {
    /// Kind of phase.
    pub kind: PhaseKind,
    /// First frame.
    pub first: usize,
    /// One past the last frame.
    pub end: usize,
}

/// Cuts a clip from `contacts.first_frame` to its end into phases without gaps.
pub fn segment_phases(clip: &Clip, contacts: &Contacts) -> Vec<Phase> {
    let first = contacts.first_frame;
    let track = Track::of(clip, contacts);
    let behaviours = behaviours_of(&track, contacts);
    let mut starts = phase_starts(&track, contacts, &behaviours);
    // Of events that are close together the one that is listed first counts: contacts before all others.
    starts.sort_by_key(|start| (start.what, start.frame));
    let least = (LEAST_SECS * clip.frame_rate_hz).round().max(1.0) as usize;
    let mut kept: Vec<Start> = Vec::with_capacity(starts.len());
    for start in starts {
        let inside = start.frame >= first + least && start.frame + least <= contacts.frames;
        if inside
            && kept
                .iter()
                .all(|other| other.frame.abs_diff(start.frame) >= least)
        {
            kept.push(start);
        }
    }
    kept.sort_by_key(|start| start.frame);
    let ends = kept.iter().skip(1).map(|start| start.frame);
    let ends = ends.chain([contacts.frames]);
    let mut phases: Vec<Phase> = kept
        .iter()
        .zip(ends)
        .map(|(start, end)| Phase {
            kind: PhaseKind {
                behaviour: Behaviour::Stand,
                start: start.what,
                side: start.side,
            },
            first: start.frame,
            end,
        })
        .collect();
    complete(&mut phases, first, contacts.frames, &behaviours);
    phases
}

/// Names behaviours, and fills the time before the first event with what comes before it.
fn complete(phases: &mut Vec<Phase>, first: usize, frames: usize, behaviours: &[Behaviour]) {
    let begin = phases.first().map_or(frames, |phase| phase.first);
    if begin > first {
        let kind = phases.first().map_or(
            PhaseKind {
                behaviour: Behaviour::Stand,
                start: PhaseStart::Interval,
                side: Side::Left,
            },
            |phase| before(phase.kind),
        );
        let lead = Phase {
            kind,
            first,
            end: begin,
        };
        phases.insert(0, lead);
    }
    for phase in phases {
        let middle = usize::midpoint(phase.first, phase.end);
        phase.kind.behaviour = behaviours.get(middle).copied().unwrap_or(Behaviour::Stand);
    }
}

/// Stretch of a walk before an event.
fn before(kind: PhaseKind) -> PhaseKind {
    use PhaseStart::{Apex, Crossing, Fastest, HeelOff, Interval, Landing, Lowest, TakeOff};
    let (start, side) = match kind.start {
        Landing => (HeelOff, kind.side.other()),
        TakeOff => (Landing, kind.side.other()),
        HeelOff => (Crossing, kind.side.other()),
        Lowest => (Landing, kind.side),
        Crossing | Apex | Fastest => (TakeOff, kind.side),
        Interval => (Interval, kind.side),
    };
    PhaseKind {
        start,
        side,
        ..kind
    }
}

/// A possible beginning of a phase.
#[derive(Clone, Copy, Debug)]
struct Start {
    frame: usize,
    what: PhaseStart,
    side: Side,
}

fn phase_starts(track: &Track, contacts: &Contacts, behaviours: &[Behaviour]) -> Vec<Start> {
    let mut starts = Vec::new();
    let mut begin = |frame: usize, what: PhaseStart, side: Side| {
        starts.push(Start { frame, what, side });
    };
    for side in Side::BOTH {
        let foot = contacts.foot(side);
        for stance in &foot.stances {
            begin(stance.first, PhaseStart::Landing, side);
            begin(stance.last + 1, PhaseStart::TakeOff, side);
            let heel_off = (stance.first..stance.last)
                .rev()
                .take_while(|&frame| !foot.heel[frame + 1] || frame + 1 == stance.last)
                .find(|&frame| foot.heel[frame]);
            if let Some(frame) = heel_off {
                begin(frame + 1, PhaseStart::HeelOff, side);
            }
        }
        for swing in swings(&foot.stances) {
            let sidestep =
                behaviours[usize::midpoint(swing.first, swing.last)] == Behaviour::Sidestep;
            if sidestep {
                let fastest = track.fastest(side, swing);
                begin(fastest, PhaseStart::Fastest, side);
            } else if let Some(frame) = track.crossing(side, swing) {
                begin(frame, PhaseStart::Crossing, side);
            }
        }
    }
    let flights = flights(contacts);
    for flight in &flights {
        if matches!(
            behaviours[usize::midpoint(flight.first, flight.last)],
            Behaviour::Jump | Behaviour::Hop
        ) {
            let side = last_standing(contacts, flight.first);
            begin(track.highest(*flight), PhaseStart::Apex, side);
        }
    }
    for pair in flights.windows(2) {
        let ground = FrameSpan {
            first: pair[0].last,
            last: pair[1].first,
        };
        let lowest = track.lowest(ground);
        if matches!(behaviours[lowest], Behaviour::Jump | Behaviour::Hop) {
            let side = last_standing(contacts, pair[1].first);
            begin(lowest, PhaseStart::Lowest, side);
        }
    }
    let interval = (STAND_SECS * contacts.frame_rate_hz).round().max(1.0) as usize;
    for run in FrameSpan::runs(
        &behaviours
            .iter()
            .map(|behaviour| *behaviour == Behaviour::Stand)
            .collect::<Vec<_>>(),
    ) {
        for frame in (run.first..=run.last).step_by(interval) {
            begin(frame, PhaseStart::Interval, Side::Left);
        }
    }
    starts
}

/// Runs of frames between two stances of a foot.
fn swings(stances: &[FrameSpan]) -> impl Iterator<Item = FrameSpan> + '_ {
    stances.windows(2).filter_map(|pair| {
        let (first, last) = (pair[0].last + 1, pair[1].first.checked_sub(1)?);
        (first <= last).then_some(FrameSpan { first, last })
    })
}
