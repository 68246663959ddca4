//! A walk's place in the space of its crowd.

use crate::crowd::agent::Agent;
use footfall_core::rotation::from_heading;
use footfall_synth::GroundTransform;
use glam::Vec3;

/// The place where a walk began, and the size of who walks.
#[derive(Clone, Copy, Debug)]
pub(super) struct Start {
    crowd_from_start: GroundTransform,
    pub(super) size: f32,
}

impl Start {
    /// A place of the crowd's space, as seen from where the walk began.
    pub(super) fn local(&self, place: &GroundTransform) -> GroundTransform {
        let seen = self.crowd_from_start.local(place);
        GroundTransform {
            position: seen.position / self.size,
            ..seen
        }
    }

    pub(super) fn global(&self, seen: &GroundTransform) -> GroundTransform {
        self.crowd_from_start.global(&GroundTransform {
            position: seen.position * self.size,
            ..*seen
        })
    }
}

impl Agent {
    /// Place of its walk in the crowd's space.
    pub(super) fn start(&self) -> Start {
        let heading = self.heading - self.walked.heading;
        let from_start = from_heading(heading) * (self.walked.position * self.size);
        Start {
            crowd_from_start: GroundTransform {
                position: (self.place - from_start) * Vec3::new(1.0, 0.0, 1.0),
                heading,
            },
            size: self.size,
        }
    }
}
