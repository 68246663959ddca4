//! Gait events by a published kinematic detector that looks at neither ground nor speed of the feet, to judge [`crate::contacts`] by.
//!
//! J. A. Zeni, J. G. Richards, J. S. Higginson, *Two simple methods for determining gait events during treadmill and overground
//! walking using kinematic data* (2008): a foot lands where it is farthest ahead of the pelvis and lifts where it is farthest behind.
//! Made for steady walking straight ahead; elsewhere the farthest place is not that of a contact. In runs a foot goes on back after it has
//! left the ground: of terminal contacts of one who jogs at 2 m/s (O3DE), a sixth differ from those of [`crate::contacts`] by more than 50 ms.

use crate::steps::free_falls;
use footfall_core::{Clip, EventKind, GaitEvent, Joint, ModelPose, Side, forward_kinematics};
use glam::Vec3;

/// Time before and after a frame over which the hips give the walk's direction, seconds.
const DIRECTION_SECS: f64 = 0.25;

/// Time before and after an event over which it is an extreme, seconds.
const APART_SECS: f64 = 0.3;

/// Least motion of the foot along the walk, relative to the hips, within that time, metres.
const LEAST_EXCURSION_M: f32 = 0.1;

/// Time before and after a frame from which steady walking is detected, seconds.
const STEADY_SECS: f64 = 0.5;

/// Slowest and fastest hips of a walk, metres a second.
const WALKING_SPEEDS_MPS: [f32; 2] = [0.4, 2.3];

/// Time around a free fall in which a body does not walk, seconds.
const RUNNING_SECS: f64 = 0.35;

/// More than this between the ways before and after a frame is a turn, radians.
const MOST_TURN_RAD: f32 = 0.52;

/// Events of a walking person, and where they can be trusted.
#[derive(Clone, Debug, PartialEq)]
pub struct PublishedEvents {
    /// In the order of their frames.
    pub events: Vec<GaitEvent>,
    /// Frame by frame, whether the body walks straight ahead at a steady pace there.
    pub is_steady: Vec<bool>,
}

impl PublishedEvents {
    /// Finds the events of a clip from its frame `first_frame` on. Frame numbers are the clip's.
    pub fn of(clip: &Clip, first_frame: usize) -> Self {
        let tracks = Tracks::of(clip, first_frame);
        let frames_of = |secs: f64| (secs * clip.frame_rate_hz).round() as usize;
        let mut events = Vec::new();
        for side in Side::BOTH {
            let kinds = [
                (EventKind::InitialContact, &tracks.ankles, 1.0),
                (EventKind::TerminalContact, &tracks.toes, -1.0),
            ];
            for (kind, feet, sign) in kinds {
                let along = tracks.along(&feet[side.index()], frames_of(DIRECTION_SECS), sign);
                let found = extremes(&along, frames_of(APART_SECS)).into_iter();
                events.extend(found.map(|frame| GaitEvent {
                    frame: first_frame + frame,
                    side,
                    kind,
                }));
            }
        }
        events.sort_by_key(|event| (event.frame, event.kind, event.side));
        let mut is_steady = vec![false; first_frame.min(clip.poses.len())];
        is_steady.extend(tracks.steady(frames_of(STEADY_SECS), clip.frame_rate_hz as f32));
        let (near, last) = (frames_of(RUNNING_SECS), is_steady.len().saturating_sub(1));
        let falls = free_falls(clip).into_iter().enumerate();
        for (frame, _) in falls.filter(|(_, falls)| *falls) {
            is_steady[frame.saturating_sub(near)..=(frame + near).min(last)].fill(false);
        }
        Self { events, is_steady }
    }
}

/// Points over time, from the first frame of the motion on.
#[derive(Default)]
struct Tracks {
    hips: Vec<Vec3>,
    ankles: [Vec<Vec3>; 2],
    toes: [Vec<Vec3>; 2],
}

impl Tracks {
    fn of(clip: &Clip, first_frame: usize) -> Self {
        let mut tracks = Self::default();
        let mut model = ModelPose::default();
        for pose in clip.poses.iter().skip(first_frame) {
            forward_kinematics(&clip.skeleton, pose, &mut model);
            tracks.hips.push(model.position(Joint::Hips));
            for side in Side::BOTH {
                tracks.ankles[side.index()].push(model.position(side.foot()));
                tracks.toes[side.index()].push(model.position(side.toes()));
            }
        }
        tracks
    }

    /// The hips' level way between two frames, which are brought into the clip.
    fn way(&self, from: usize, to: usize) -> Vec3 {
        let last = self.hips.len() - 1;
        (self.hips[to.min(last)] - self.hips[from.min(last)]).with_y(0.0)
    }

    /// Distance of a foot ahead of the hips, or with `sign` -1 behind, metres.
    fn along(&self, foot: &[Vec3], reach: usize, sign: f32) -> Vec<f32> {
        (0..foot.len())
            .map(|frame| {
                let way = self.way(frame.saturating_sub(reach), frame + reach);
                sign * (foot[frame] - self.hips[frame]).dot(way.normalize_or_zero())
            })
            .collect()
    }

    fn steady(&self, reach: usize, rate: f32) -> impl Iterator<Item = bool> {
        let last = self.hips.len().saturating_sub(1);
        (0..self.hips.len()).map(move |frame| {
            let (from, to) = (frame.saturating_sub(reach), (frame + reach).min(last));
            let (before, after) = (self.way(from, frame), self.way(frame, to));
            let speed = |way: Vec3, frames: usize| way.length() * rate / frames.max(1) as f32;
            let [slowest, fastest] = WALKING_SPEEDS_MPS;
            let walks = [speed(before, frame - from), speed(after, to - frame)]
                .iter()
                .all(|speed| (slowest..=fastest).contains(speed));
            walks && before.angle_between(after) <= MOST_TURN_RAD
        })
    }
}

/// The frames in which a signal is greatest within `reach`.
fn extremes(signal: &[f32], reach: usize) -> Vec<usize> {
    let mut found: Vec<usize> = Vec::new();
    for frame in 1..signal.len().saturating_sub(1) {
        let window = &signal[frame.saturating_sub(reach)..=(frame + reach).min(signal.len() - 1)];
        let highest = window.iter().copied().fold(f32::MIN, f32::max);
        let lowest = window.iter().copied().fold(f32::MAX, f32::min);
        let is_new = found.last().is_none_or(|last| frame - last > reach);
        if signal[frame] >= highest && highest - lowest > LEAST_EXCURSION_M && is_new {
            found.push(frame);
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use footfall_core::{Pose, Skeleton};

    /// Hips that go on at 1.5 m/s and bob three times a second with this share of gravity, at 60 Hz.
    fn bobbing(share: f32) -> Clip {
        let turn = core::f32::consts::TAU * 3.0;
        let poses = (0..300).map(|frame| {
            let secs = frame as f32 / 60.0;
            let bob = share * 9.81 / (turn * turn) * (turn * secs).cos();
            Pose {
                root_position: Vec3::new(0.0, 0.9 + bob, 1.5 * secs),
                ..Pose::default()
            }
        });
        Clip {
            skeleton: Skeleton::standard(),
            frame_rate_hz: 60.0,
            poses: poses.collect(),
        }
    }

    #[test]
    fn events_of_who_falls_freely_are_not_trusted() {
        let steady = |share: f32| PublishedEvents::of(&bobbing(share), 0).is_steady;
        assert!(steady(0.4)[60..240].iter().all(|steady| *steady));
        assert!(steady(1.2)[60..240].iter().all(|steady| !steady));
    }
}
