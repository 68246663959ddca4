//! The walk's end: another animation takes the body over, and the character comes to rest.

use super::observed_motion::{lower, raise};
use super::session::WalkSession;
use crate::travel::Travel;
use footfall_core::rotation::from_heading;
use footfall_ik::handover::Handover;
use footfall_ik::placement::Frame;
use footfall_synth::GroundTransform;
use glam::Vec3;
use godot::classes::Skeleton3D;
use godot::prelude::*;

/// Time after the end at which a foot that cannot reach its place is released, seconds.
const PATIENCE_SECS: f32 = 2.0;

/// Remaining motion of a character whose walk gives the body away: it dies away.
#[derive(Clone, Copy, Debug)]
pub(super) struct Leaving {
    /// At the beginning, in the axes of the ground.
    velocity_mps: Vec3,
    turn_rate: f32,
    secs: f32,
    age_secs: f32,
}

impl WalkSession {
    /// Begins to leave the body to the animation that was watched.
    pub(super) fn leave(&mut self, secs: f64, velocity_mps: Vec3, turn_rate: f32) {
        let place = Frame::from(self.traveller.ground_place());
        let stands = self.stands_in_place();
        let to = self.watched_here().with_standing(stands).raised(&place);
        let from = self.shown.moving();
        let body = &self.traveller.binding.body;
        let secs = secs as f32;
        self.handover = Some(Handover::new(body, &from, &to.moving(), to.dt_secs, secs));
        self.leaving = Some(Leaving {
            velocity_mps,
            turn_rate,
            secs,
            age_secs: 0.0,
        });
    }

    /// Advances the transition to other animation. Returns the travel, and whether the animation now has the whole body.
    pub(super) fn go_out(&mut self, skeleton: &Gd<Skeleton3D>, dt_secs: f64) -> (Travel, bool) {
        let dt_secs = dt_secs as f32;
        let mut place = self.traveller.ground_place();
        if let Some(leaving) = &mut self.leaving {
            leaving.age_secs += dt_secs;
            leaving.travel(dt_secs, &mut place);
        }
        let travel = self.traveller.go_to(place);
        let (mut pose, stands) = self.watch(skeleton, dt_secs);
        let ground = Frame::from(place);
        raise(&ground, &mut pose);
        if let Some(handover) = &mut self.handover {
            handover.step(dt_secs, stands, stands == [true; 2], &mut pose);
        }
        if dt_secs > 0.0 {
            self.shown.observe(&pose, stands, dt_secs);
        }
        lower(&ground, &mut pose);
        self.pose = pose;
        let over = self.handover.as_ref().is_none_or(Handover::is_over);
        let out = self.leaving.is_none_or(|leaving| {
            let late = leaving.age_secs - leaving.secs;
            late >= PATIENCE_SECS || over && late >= 0.0
        });
        if out {
            (self.handover, self.leaving) = (None, None);
        }
        (travel, out)
    }
}

impl Leaving {
    /// Moves a place on, ever more slowly.
    fn travel(&self, dt_secs: f32, place: &mut GroundTransform) {
        let left = (1.0 - self.age_secs / self.secs.max(f32::MIN_POSITIVE)).max(0.0);
        let secs = left * left * dt_secs;
        place.position += from_heading(place.heading) * self.velocity_mps * secs;
        place.heading += self.turn_rate * secs;
    }
}
