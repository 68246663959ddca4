//! Behaviour of the body in each frame, from contacts and from where hips and feet go.

use super::track::{Track, flights};
use crate::contacts::Contacts;
use footfall_core::{Behaviour, FrameSpan, Side};
use glam::Vec3;

/// A foot belongs to a take-off or to a landing when its contact ends or begins this close to it, seconds.
const TOGETHER_SECS: f64 = 0.12;

/// Longest preparation of a flight, and longest recovery from it, seconds.
const AROUND_FLIGHT_SECS: f64 = 0.4;

/// Hips and feet of a body that stands move more slowly than this, m/s.
const STAND_MPS: (f32, f32) = (0.15, 0.35);

/// Speeds of standing are looked at over this time to either side, seconds.
const STAND_SECS: f64 = 0.15;

/// Directions of walking over this time to either side, seconds.
const STEP_SECS: f64 = 0.5;

/// Less speed sideways is no sidestep, m/s.
const SIDESTEP_MPS: f32 = 0.15;

/// A body that turns faster walks: a pivot carries the hips sideways of where they face, too, rad/s.
const SIDESTEP_RADPS: f32 = 0.8;

/// Least duration of a behaviour, seconds.
const LEAST_SECS: f64 = 0.2;

/// The behaviour of every frame of a clip.
pub(super) fn behaviours_of(track: &Track, contacts: &Contacts) -> Vec<Behaviour> {
    let frames_of = |secs: f64| (secs * contacts.frame_rate_hz).round() as usize;
    let mut behaviours: Vec<Behaviour> = (0..contacts.frames)
        .map(|frame| on_the_ground(track, contacts, frame, &frames_of))
        .collect();
    let flights = flights(contacts);
    for (n, flight) in flights.iter().enumerate() {
        let behaviour = in_the_air(contacts, *flight, frames_of(TOGETHER_SECS));
        // Ground between two flights is shared.
        let reach = |gap: Option<usize>| {
            let most = frames_of(AROUND_FLIGHT_SECS);
            gap.map_or(most, |gap| gap.div_ceil(2).min(most))
        };
        let before = n.checked_sub(1).map(|n| flight.first - flights[n].last);
        let after = flights.get(n + 1).map(|next| next.first - flight.last);
        let first = flight.first.saturating_sub(reach(before));
        let last = (flight.last + reach(after)).min(contacts.frames - 1);
        behaviours[first.max(contacts.first_frame)..=last].fill(behaviour);
    }
    drop_short(&mut behaviours, frames_of(LEAST_SECS));
    behaviours
}

/// Kind of a flight, by the feet that leave the ground and those that land.
fn in_the_air(contacts: &Contacts, flight: FrameSpan, together: usize) -> Behaviour {
    let leaves = |side: Side| {
        let stances = &contacts.foot(side).stances;
        let mut ends = stances.iter().map(|stance| stance.last);
        ends.any(|end| end < flight.first && end + together >= flight.first)
    };
    let lands = |side: Side| {
        let stances = &contacts.foot(side).stances;
        let mut begins = stances.iter().map(|stance| stance.first);
        begins.any(|begin| begin > flight.last && begin <= flight.last + together)
    };
    let [left, right] = Side::BOTH.map(|side| (leaves(side), lands(side)));
    match (left, right) {
        ((true, true), (false, false)) | ((false, false), (true, true)) => Behaviour::Hop,
        ((true, _), (true, _)) | ((_, true), (_, true)) | ((false, false), (false, false)) => {
            Behaviour::Jump
        }
        // A recording that begins or ends in the air shows but a take-off or a landing of one foot.
        _ => Behaviour::Run,
    }
}

fn on_the_ground(
    track: &Track,
    contacts: &Contacts,
    frame: usize,
    frames_of: &impl Fn(f64) -> usize,
) -> Behaviour {
    let (first, end) = (contacts.first_frame, contacts.frames);
    let around = |reach: usize| {
        let from = frame.saturating_sub(reach).max(first);
        let to = (frame + reach).min(end - 1).max(from);
        let secs = (to - from).max(1) as f32 / contacts.frame_rate_hz as f32;
        (from, to, secs)
    };
    let velocity = |points: &[Vec3], reach: usize| {
        let (from, to, secs) = around(reach);
        (points[to] - points[from]) / secs
    };
    let near = frames_of(STAND_SECS).max(1);
    let slow = velocity(&track.hips, near).with_y(0.0).length() < STAND_MPS.0;
    let feet_rest = Side::BOTH
        .iter()
        .all(|side| velocity(&track.ankles[side.index()], near).length() < STAND_MPS.1);
    if slow && feet_rest {
        return Behaviour::Stand;
    }
    let step = frames_of(STEP_SECS).max(1);
    let (from, to, secs) = around(step);
    let turning = track.forward[from].angle_between(track.forward[to]) / secs;
    let way = velocity(&track.hips, step);
    let forward = way.dot(track.forward[frame]);
    let sideways = way.dot(track.forward[frame].cross(Vec3::Y));
    if turning < SIDESTEP_RADPS && sideways.abs() > forward.abs().max(SIDESTEP_MPS) {
        Behaviour::Sidestep
    } else {
        Behaviour::Walk
    }
}

/// Gives runs that are too short to what comes before them.
fn drop_short(behaviours: &mut [Behaviour], least: usize) {
    let mut first = 0;
    while first < behaviours.len() {
        let behaviour = behaviours[first];
        let run = behaviours[first..].iter().take_while(|b| **b == behaviour);
        let end = first + run.count();
        if first > 0 && end - first < least {
            let previous = behaviours[first - 1];
            behaviours[first..end].fill(previous);
        }
        first = end;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contacts::FootContacts;
    use footfall_core::rotation::from_heading;

    const FRAMES: usize = 200;

    /// The behaviour in the middle of a recording of 100 Hz in which hips and feet go to the left of where the hips face at 0.6 m/s, while the
    /// hips turn at this rate, rad/s.
    fn going_sideways(turning: f32) -> Behaviour {
        let facing = |frame: usize| from_heading(turning * (frame as f32 - 100.0) / 100.0);
        let mut place = Vec3::ZERO;
        let mut hips = Vec::new();
        for frame in 0..FRAMES {
            hips.push(place);
            place += facing(frame) * Vec3::X * 0.006;
        }
        let track = Track {
            ankles: [hips.clone(), hips.clone()],
            hips,
            forward: (0..FRAMES).map(|frame| facing(frame) * Vec3::Z).collect(),
        };
        let bears = FootContacts {
            heel: vec![true; FRAMES],
            toe: vec![true; FRAMES],
            stances: vec![FrameSpan {
                first: 0,
                last: FRAMES - 1,
            }],
        };
        let contacts = Contacts {
            frame_rate_hz: 100.0,
            frames: FRAMES,
            first_frame: 0,
            feet: [bears.clone(), bears],
        };
        behaviours_of(&track, &contacts)[FRAMES / 2]
    }

    #[test]
    fn a_pivot_is_no_sidestep() {
        assert_eq!(going_sideways(0.0), Behaviour::Sidestep);
        assert_eq!(going_sideways(0.3), Behaviour::Sidestep);
        assert_eq!(going_sideways(1.5), Behaviour::Walk);
    }
}
