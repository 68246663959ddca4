//! Watching how somebody else poses the skeleton.

use super::seen::{Seen, raise};
use super::session::Session;
use footfall_core::Pose;
use godot::classes::Skeleton3D;
use godot::prelude::*;

/// The motion of an animation, or of a ragdoll.
#[derive(Debug, Default)]
pub(super) struct Watch {
    /// In the world.
    pub(super) in_world: Seen,
    /// On the ground under the character: an animation that stays in place stands there, though the character travels.
    in_place: Seen,
}

impl Session {
    /// Reads the pose that the skeleton has, on the ground under the character, and which feet stand in it.
    pub(super) fn watch(&mut self, skeleton: &Gd<Skeleton3D>, dt_secs: f32) -> (Pose, [bool; 2]) {
        let mut pose = Pose::default();
        self.traveller.binding.read(skeleton, &mut pose);
        let body = &self.traveller.binding.body;
        let scale = self.traveller.scale();
        let mut in_world = pose.clone();
        in_world.root_position *= scale;
        raise(&self.traveller.world_from_ground(), &mut in_world);
        let watched = &mut self.watched;
        if dt_secs > 0.0 {
            watched.in_place.see_silent(body, &pose, dt_secs);
            let stands = watched.in_place.moving().stands;
            watched.in_world.see(&in_world, stands, dt_secs);
        }
        (pose, watched.in_place.moving().stands)
    }

    /// The motion that was watched, on the ground under the character as it is now, in metres of the body.
    pub(super) fn watched_here(&self) -> Seen {
        let ground = self.traveller.world_from_ground();
        let scale = self.traveller.scale().recip();
        self.watched.in_world.seen_from(&ground, scale)
    }
}
