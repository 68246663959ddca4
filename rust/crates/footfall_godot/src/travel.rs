//! The node that travels, and how it does.

use crate::convert;
use crate::skeleton_binding::SkeletonBinding;
use footfall_core::rotation;
use footfall_synth::GroundTransform;
use glam::{Affine3A, Quat};
use godot::classes::Skeleton3D;
use godot::prelude::*;

/// A body on a skeleton, and the character that it carries along.
pub(crate) struct Traveller {
    character: Gd<Node3D>,
    pub(crate) binding: SkeletonBinding,
    start_from_ground: GroundTransform,
}

/// What one frame did to the ground under the character.
pub(crate) struct Travel {
    /// `previous_from_current` of the ground under the body.
    pub(crate) ground: Affine3A,
    /// Its rotation alone: about +Y, exactly 0 when the character does not turn.
    turn: f32,
    /// Global transform of that ground before the character was moved, without any scale.
    pub(crate) world_from_ground: Affine3A,
}

impl Traveller {
    /// A character that is where `start_from_ground` says.
    pub(crate) const fn new(
        character: Gd<Node3D>,
        binding: SkeletonBinding,
        start_from_ground: GroundTransform,
    ) -> Self {
        Self {
            character,
            binding,
            start_from_ground,
        }
    }

    /// Whether this still is the character and its skeleton as they were.
    pub(crate) fn is_for(&self, skeleton: &Gd<Skeleton3D>) -> bool {
        self.character.is_instance_valid()
            && self.character.is_inside_tree()
            && self.binding.fits(skeleton, &self.character)
    }

    /// Where the body is from now on, without having gone there.
    pub(crate) const fn place(&mut self, start_from_ground: GroundTransform) {
        self.start_from_ground = start_from_ground;
    }

    /// Where the body is.
    pub(crate) fn start_from_ground(&self) -> Affine3A {
        affine(&self.start_from_ground)
    }

    /// The body has gone to a place.
    pub(crate) fn go_to(&mut self, start_from_ground: GroundTransform) -> Travel {
        let turn = rotation::wrap_angle(start_from_ground.heading - self.start_from_ground.heading);
        let ground = affine(&self.start_from_ground).inverse() * affine(&start_from_ground);
        self.start_from_ground = start_from_ground;
        let world_from_character = self.character.get_global_transform().orthonormalized();
        Travel {
            ground,
            turn,
            world_from_ground: convert::affine(world_from_character)
                * self.binding.character_from_ground,
        }
    }

    /// The same travel in the axes of the character, in metres.
    fn character_delta(&self, travel: &Travel) -> Transform3D {
        let character_from_ground = self.binding.character_from_ground;
        let delta = character_from_ground * travel.ground * character_from_ground.inverse();
        convert::transform(Quat::from_rotation_y(travel.turn), delta.translation.into())
    }

    /// The same travel in the character's own space, in which a scaled character has other units than metres.
    pub(crate) fn local_delta(&self, travel: &Travel) -> Transform3D {
        let mut delta = self.character_delta(travel);
        let scale = self.character.get_global_transform().basis.get_scale();
        if scale != Vector3::ONE {
            let per_metre = |scale: f32| if scale == 0.0 { 0.0 } else { scale.recip() };
            delta.origin.x *= per_metre(scale.x);
            delta.origin.y *= per_metre(scale.y);
            delta.origin.z *= per_metre(scale.z);
        }
        delta
    }

    /// Moves the character as the ground under it moved; its scale stays.
    pub(crate) fn move_character(&mut self, travel: &Travel) {
        let delta = self.character_delta(travel);
        let before = self.character.get_global_transform();
        let frame = before.basis.orthonormalized();
        let mut after = before;
        after.origin = before.origin + frame * delta.origin;
        if travel.turn != 0.0 {
            // Rebuilt from rotation and scale, so that rounding cannot add up over a long walk.
            let turned = (frame * delta.basis).orthonormalized();
            let scale = before.basis.get_scale();
            after.basis = Basis::from_cols(
                turned.col_a() * scale.x,
                turned.col_b() * scale.y,
                turned.col_c() * scale.z,
            );
        }
        if after != before {
            self.character.set_global_transform(after);
        }
    }
}

fn affine(transform: &GroundTransform) -> Affine3A {
    Affine3A::from_rotation_translation(
        rotation::from_heading(transform.heading),
        transform.position,
    )
}
