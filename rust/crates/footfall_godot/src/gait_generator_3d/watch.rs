//! Observation of other animation on the skeleton.

use super::observed_motion::{ObservedMotion, raise};
use super::session::WalkSession;
use footfall_core::Pose;
use footfall_ik::placement::Frame;
use godot::classes::Skeleton3D;
use godot::prelude::*;

/// The motion of an animation, or of a ragdoll.
#[derive(Debug, Default)]
pub(super) struct Watch {
    /// In the world. A foot of an animation that travels with its character stands here.
    pub(super) in_world: ObservedMotion,
    /// On the ground under the character. A foot of an animation that stays in place stands here, though the character still travels.
    in_place: ObservedMotion,
}

impl WalkSession {
    /// Reads the pose that the skeleton has, on the ground under the character, and which feet stand in it.
    pub(super) fn watch(&mut self, skeleton: &Gd<Skeleton3D>, dt_secs: f32) -> (Pose, [bool; 2]) {
        let mut pose = Pose::default();
        self.traveller.binding.read(skeleton, &mut pose);
        let body = &self.traveller.binding.body;
        let (scale, ground) = (self.traveller.scale(), self.traveller.world_from_ground());
        let mut in_world = pose.clone();
        in_world.root_position *= scale;
        raise(&ground, &mut in_world);
        let Watch {
            in_world: world,
            in_place: place,
        } = &mut self.watched;
        if dt_secs > 0.0 {
            place.observe_without_contacts(body, &pose, dt_secs, &Frame::IDENTITY, 1.0);
            world.observe_without_contacts(body, &in_world, dt_secs, &ground, scale.recip());
        }
        (pose, self.stands_in_place())
    }

    /// Feet that stand on ground that the character takes along.
    pub(super) fn stands_in_place(&self) -> [bool; 2] {
        self.watched.in_place.moving().stands
    }

    /// The motion that was watched, on the ground under the character as it is now, in metres of the body; its feet stand in the world.
    pub(super) fn watched_here(&self) -> ObservedMotion {
        let ground = self.traveller.world_from_ground();
        let scale = self.traveller.scale().recip();
        self.watched.in_world.relative_to(&ground, scale)
    }
}
