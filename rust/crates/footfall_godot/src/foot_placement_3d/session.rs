//! The feet of one skeleton, and the floor under it.

use crate::convert;
use crate::physics_ground::PhysicsGround;
use crate::skeleton_binding::SkeletonBinding;
use footfall_core::Pose;
use footfall_ik::placement::{FootPlacer, Frame};
use glam::Affine3A;
use godot::classes::Node3D;
use godot::prelude::*;

/// The feet of one skeleton.
pub(crate) struct PlacementSession {
    pub(super) binding: SkeletonBinding,
    pub(super) character: Gd<Node3D>,
    pub(super) placer: FootPlacer,
    pub(super) ground: PhysicsGround,
    pub(super) pose: Pose,
}

impl PlacementSession {
    /// The floor of the animation in the world.
    pub(super) fn world_from_floor(&self) -> Frame {
        let world = convert::frame(self.character.get_global_transform());
        let ground: Affine3A = self.binding.character_from_ground;
        world.child(&Frame {
            position: ground.translation.into(),
            rotation: convert::rotation(&ground),
        })
    }
}
