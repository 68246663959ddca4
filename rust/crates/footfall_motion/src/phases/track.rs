//! Ankles and hips over time, as the phases need them.

use crate::contacts::Contacts;
use footfall_core::rotation::{from_heading, heading};
use footfall_core::{Clip, FrameSpan, Joint, ModelPose, Side, forward_kinematics};
use glam::Vec3;

/// Least duration of a flight, with both feet off the ground, seconds.
const LEAST_FLIGHT_SECS: f64 = 0.04;

/// Positions in the clip's space, frame by frame.
pub(super) struct Track {
    pub(super) hips: Vec<Vec3>,
    pub(super) ankles: [Vec<Vec3>; 2],
    /// The direction that the hips face along the ground.
    pub(super) forward: Vec<Vec3>,
}

impl Track {
    pub(super) fn of(clip: &Clip, contacts: &Contacts) -> Self {
        let mut track = Self {
            hips: Vec::with_capacity(contacts.frames),
            ankles: [Vec::new(), Vec::new()],
            forward: Vec::with_capacity(contacts.frames),
        };
        let mut model = ModelPose::default();
        for pose in &clip.poses {
            forward_kinematics(&clip.skeleton, pose, &mut model);
            track.hips.push(model.position(Joint::Hips));
            for side in Side::BOTH {
                track.ankles[side.index()].push(model.position(side.foot()));
            }
            let facing = from_heading(heading(pose.rotation(Joint::Hips)));
            track.forward.push(facing * Vec3::Z);
        }
        track
    }

    /// The frame of a swing in which its ankle passes the other.
    pub(super) fn crossing(&self, side: Side, swing: FrameSpan) -> Option<usize> {
        let ahead = |frame: usize| {
            let way = self.ankles[side.index()][frame] - self.ankles[side.other().index()][frame];
            way.dot(self.forward[frame])
        };
        (swing.first + 1..=swing.last)
            .find(|&frame| (ahead(frame) >= 0.0) != (ahead(frame - 1) >= 0.0))
    }

    /// The frame of a swing in which its ankle is fastest.
    pub(super) fn fastest(&self, side: Side, swing: FrameSpan) -> usize {
        let ankle = &self.ankles[side.index()];
        let speed = |frame: usize| {
            let before = frame.saturating_sub(1);
            let after = (frame + 1).min(ankle.len() - 1);
            ankle[after].distance(ankle[before])
        };
        (swing.first..=swing.last)
            .max_by(|a, b| speed(*a).total_cmp(&speed(*b)))
            .unwrap_or(swing.first)
    }

    pub(super) fn highest(&self, span: FrameSpan) -> usize {
        (span.first..=span.last)
            .max_by(|a, b| self.hips[*a].y.total_cmp(&self.hips[*b].y))
            .unwrap_or(span.first)
    }

    pub(super) fn lowest(&self, span: FrameSpan) -> usize {
        (span.first..=span.last)
            .min_by(|a, b| self.hips[*a].y.total_cmp(&self.hips[*b].y))
            .unwrap_or(span.first)
    }
}

/// Runs of frames in which no foot bears, between stances.
pub(super) fn flights(contacts: &Contacts) -> Vec<FrameSpan> {
    let aloft: Vec<bool> = (0..contacts.frames)
        .map(|frame| {
            frame >= contacts.first_frame
                && !Side::BOTH.iter().any(|side| contacts.bears(*side, frame))
        })
        .collect();
    let least = (LEAST_FLIGHT_SECS * contacts.frame_rate_hz)
        .round()
        .max(1.0) as usize;
    let mut flights = FrameSpan::runs(&aloft);
    flights.retain(|flight| flight.frames() >= least);
    flights
}

/// The foot that stood last before a frame.
pub(super) fn last_standing(contacts: &Contacts, frame: usize) -> Side {
    let last = |side: Side| {
        let stances = &contacts.foot(side).stances;
        let before = stances.iter().rev().find(|stance| stance.first < frame);
        before.map_or(0, |stance| stance.last)
    };
    if last(Side::Left) > last(Side::Right) {
        Side::Left
    } else {
        Side::Right
    }
}
