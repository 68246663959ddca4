//! A generated walk, and its settings.

use crate::controls::GaitChoice;
use footfall_core::{Clip, EventKind, FrameSpan, GaitEvent, Side};

/// Settings of a walk.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WalkConfig {
    /// Number of steps.
    pub steps: usize,
    /// Seed of the walker and of the variation of its steps.
    pub seed: u64,
    /// Deviation of walkers and steps from the average: 0 none, 1 as in the recordings.
    pub variation: f32,
    /// Speed over the ground, m/s; the corpus' mean when absent.
    pub speed_mps: Option<f32>,
    /// Turn rate, rad/s, positive to the left.
    pub turn_rate_radps: f32,
    /// Frames per second of the clip; the model's when absent.
    pub frame_rate_hz: Option<f64>,
    /// Direction of travel relative to the facing direction, as of [`Controls::direction_rad`](crate::Controls::direction_rad).
    pub direction_rad: f32,
    /// Choice between walking and running, if the model has both.
    pub gait: GaitChoice,
    /// True when the walk begins and ends standing, as does any walk that does not go forwards; otherwise it is cut from a longer
    /// one.
    pub from_standing: bool,
}

/// A generated walk.
#[derive(Clone, Debug)]
pub struct SynthesizedWalk {
    /// Motion: first frame at the origin and facing +Z, an initial contact of the left foot or standing.
    pub clip: Clip,
    /// Contacts of the left and the right foot, from the frame in which the foot is at rest to the one in which its toes leave the ground. The shipped walk's feet touch the
    /// ground 25 ms before they rest.
    pub contacts: [Vec<FrameSpan>; 2],
}

impl SynthesizedWalk {
    /// Returns the ends of the contacts, except those at the clip's own ends.
    pub fn events(&self) -> Vec<GaitEvent> {
        let last = self.clip.poses.len() - 1;
        let mut events = Vec::new();
        for side in Side::BOTH {
            for span in &self.contacts[side.index()] {
                let ends = [
                    (span.first, EventKind::InitialContact, 0),
                    (span.last, EventKind::TerminalContact, last),
                ];
                for (frame, kind, edge) in ends {
                    if frame != edge {
                        events.push(GaitEvent { frame, side, kind });
                    }
                }
            }
        }
        events.sort_by_key(|event| (event.frame, event.kind, event.side));
        events
    }
}
