//! A walk that another peer leads.

use super::observed_motion::{ObservedMotion, raise};
use super::session::WalkSession;
use crate::travel::Travel;
use footfall_ik::handover::Handover;
use footfall_ik::placement::Frame;
use footfall_synth::GroundTransform;
use footfall_synth::replica::{Followed, WalkFollower};

/// A walk that is set anew goes over from what was shown within this time, seconds.
const FADE_SECS: f32 = 0.4;

impl WalkSession {
    /// Start of the walk, in the space of the travelling node's parent.
    pub(super) fn shared_from_start(&self) -> GroundTransform {
        let ground = self.traveller.ground_place();
        let ground_from_start = ground.local(&GroundTransform::default());
        self.traveller
            .parent_from_ground()
            .global(&ground_from_start)
    }

    /// Advances the walk in the steps of another peer's walker. With `dt_secs` 0 the pose stays and nothing travels.
    pub(super) fn follow(&mut self, dt_secs: f64, follower: &mut WalkFollower) -> Travel {
        self.elapsed_secs += dt_secs;
        let dt_secs = dt_secs as f32;
        let start = self.shared_from_start();
        let before = self.shown.is_known().then(|| self.shown_here());
        let followed = follower.step(dt_secs, &mut self.generator, &start, &mut self.pose);
        if let Followed::Anew(place) = followed {
            let here = self.generator.start_from_character();
            self.traveller.place(here);
            self.traveller.put(&place.global(&here));
            self.shown = ObservedMotion::default();
            self.handover = before.map(|before| self.fade_from(before));
        }
        self.go_to_place(dt_secs)
    }

    /// Handover from a motion on the ground under the character to the pose of now.
    fn fade_from(&self, before: ObservedMotion) -> Handover {
        let place = Frame::from(self.traveller.ground_place());
        let (mut pose, mut seen) = (self.pose.clone(), ObservedMotion::default());
        raise(&place, &mut pose);
        for _ in 0..2 {
            seen.observe(&pose, self.generator.feet_in_contact(), before.dt_secs);
        }
        let body = &self.traveller.binding.body;
        let before = before.raised(&place);
        Handover::new(
            body,
            &before.moving(),
            &seen.moving(),
            before.dt_secs,
            FADE_SECS,
        )
    }
}
