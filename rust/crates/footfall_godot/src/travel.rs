//! The node that travels, and its motion.

use crate::skeleton_binding::SkeletonBinding;
use crate::{character, convert};
use footfall_core::rotation;
use footfall_ik::placement::Frame;
use footfall_synth::GroundTransform;
use glam::{Affine3A, Quat, Vec3};
use godot::classes::Skeleton3D;
use godot::prelude::*;

/// Change of size that is rounding, not growth.
const LEAST_GROWTH: f32 = 1e-3;

/// A character that is put elsewhere by less than this up or down stays on its floor, metres.
const SAME_FLOOR_M: f32 = 0.3;

/// A body on a skeleton, and the character that it carries along.
pub(crate) struct Traveller {
    character: Gd<Node3D>,
    /// The physics body around the character, or the character itself: the node that is teleported.
    carrier: Gd<Node3D>,
    pub(crate) binding: SkeletonBinding,
    start_from_ground: GroundTransform,
    /// Size of the character relative to its size when it was measured.
    scale: f32,
}

/// Motion of the ground under the character in one frame.
pub(crate) struct Travel {
    /// `previous_from_current` of the ground under the body.
    pub(crate) ground: Affine3A,
    /// Its rotation alone: about +Y, exactly 0 when the character does not turn.
    turn: f32,
    /// Global transform of that ground before the character was moved, without any scale.
    pub(crate) world_from_ground: Affine3A,
    /// Metres of the world by metres of the body as it was measured.
    scale: f32,
}

impl Travel {
    /// A part of the travel.
    #[must_use]
    pub(crate) fn scaled(mut self, share: f32) -> Self {
        if share < 1.0 {
            self.turn *= share;
            self.ground = Affine3A::from_rotation_translation(
                Quat::from_rotation_y(self.turn),
                Vec3::from(self.ground.translation) * share,
            );
        }
        self
    }

    /// Velocity of that motion, in the axes of the ground: metres of the body and radians a second.
    pub(crate) fn per_second(&self, dt_secs: f32) -> (Vec3, f32) {
        let way = Vec3::from(self.ground.translation) / self.scale;
        (way / dt_secs, self.turn / dt_secs)
    }

    /// Global transform of the space above the ground under the body after the travel.
    pub(crate) fn world_from_current(&self) -> Affine3A {
        self.world_from_ground * self.ground * Affine3A::from_scale(Vec3::splat(self.scale))
    }
}

impl Traveller {
    /// A character that is where `start_from_ground` says.
    pub(crate) fn new(
        character: Gd<Node3D>,
        binding: SkeletonBinding,
        start_from_ground: GroundTransform,
    ) -> Self {
        Self {
            carrier: character::carrier(&character),
            character,
            binding,
            start_from_ground,
            scale: 1.0,
        }
    }

    /// Returns whether this still is the character and its skeleton as they were, but for the size.
    pub(crate) fn is_for(&mut self, skeleton: &Gd<Skeleton3D>) -> bool {
        let nodes = [&self.character, &self.carrier];
        if !nodes
            .into_iter()
            .all(|node| node.is_instance_valid() && node.is_inside_tree())
        {
            return false;
        }
        let Some(scale) = self.binding.scale_to(skeleton, &self.character) else {
            return false;
        };
        // What rounding makes of a walk through a large world is no other size.
        self.scale = if (scale - 1.0).abs() < LEAST_GROWTH {
            1.0
        } else {
            scale
        };
        true
    }

    /// Returns whether this is the character, in the same physics body.
    pub(crate) fn carries(&self, character: &Gd<Node3D>) -> bool {
        self.character == *character && self.carrier == character::carrier(character)
    }

    /// Returns whether the character has another size than when it was measured.
    pub(crate) fn has_grown(&self) -> bool {
        (self.scale - 1.0).abs() >= LEAST_GROWTH
    }

    /// Size of the character relative to its size when it was measured.
    pub(crate) const fn scale(&self) -> f32 {
        self.scale
    }

    /// The node that is the character.
    pub(crate) const fn character(&self) -> &Gd<Node3D> {
        &self.character
    }

    /// The skeleton that is posed.
    pub(crate) fn skeleton(&self) -> InstanceId {
        self.binding.skeleton()
    }

    /// Puts the body somewhere else without travel.
    pub(crate) const fn place(&mut self, start_from_ground: GroundTransform) {
        self.start_from_ground = start_from_ground;
    }

    /// Place of the body.
    pub(crate) fn start_from_ground(&self) -> Affine3A {
        affine(&self.start_from_ground)
    }

    /// Place and heading of the body.
    pub(crate) const fn ground_place(&self) -> GroundTransform {
        self.start_from_ground
    }

    /// The ground under the body in the world.
    pub(crate) fn world_from_ground(&self) -> Frame {
        let character = convert::frame(self.character.get_global_transform());
        let ground = self.character_from_ground();
        character.child(&Frame {
            position: ground.translation.into(),
            rotation: convert::rotation(&ground),
        })
    }

    /// Puts the character elsewhere, as seen from the ground under it, in metres of the world.
    pub(crate) fn shift(&mut self, away: Vec3) {
        let way = self.world_from_ground().rotation * away;
        let place = self.character.get_global_position() + convert::vector3(way);
        self.character.set_global_position(place);
    }

    /// The ground under the body in the space of the carrier's parent.
    pub(crate) fn parent_from_ground(&self) -> GroundTransform {
        let ground = self.parent().local(&self.world_from_ground());
        let ahead = ground.rotation * Vec3::Z;
        GroundTransform {
            position: ground.position,
            heading: ahead.x.atan2(ahead.z),
        }
    }

    /// Puts the carrier elsewhere: the ground under the body to a place of the space of its parent. A body that is only slightly higher or lower stays on the floor.
    pub(crate) fn put(&mut self, parent_from_ground: &GroundTransform) {
        let parent = self.parent();
        let before = self.parent_from_ground();
        let mut after = *parent_from_ground;
        if (after.position.y - before.position.y).abs() < SAME_FLOOR_M {
            after.position.y = before.position.y;
        }
        let turn = rotation::from_heading(after.heading - before.heading);
        let shift = after.position - turn * before.position;
        let after_from_before = Affine3A::from_rotation_translation(turn, shift);
        let world_from_parent =
            Affine3A::from_rotation_translation(parent.rotation, parent.position);
        let moved = world_from_parent * after_from_before * world_from_parent.inverse();
        let moved = convert::transform(convert::rotation(&moved), moved.translation.into());
        let place = moved * self.carrier.get_global_transform();
        self.carrier.set_global_transform(place);
        self.carrier.reset_physics_interpolation();
    }

    /// The axes that the carrier's place is given in, without any scale.
    fn parent(&self) -> Frame {
        let parent = self.carrier.get_parent_node_3d();
        let parent = parent.filter(|_| !self.carrier.is_set_as_top_level());
        let transform = parent.map_or(Transform3D::IDENTITY, |node| node.get_global_transform());
        convert::frame(convert::unscaled(transform))
    }

    /// The body has gone to a place.
    pub(crate) fn go_to(&mut self, start_from_ground: GroundTransform) -> Travel {
        let turn = rotation::wrap_angle(start_from_ground.heading - self.start_from_ground.heading);
        let mut ground = affine(&self.start_from_ground).inverse() * affine(&start_from_ground);
        ground.translation *= self.scale;
        self.start_from_ground = start_from_ground;
        let world_from_character = convert::unscaled(self.character.get_global_transform());
        Travel {
            ground,
            turn,
            world_from_ground: convert::affine(world_from_character) * self.character_from_ground(),
            scale: self.scale,
        }
    }

    fn character_from_ground(&self) -> Affine3A {
        let mut ground = self.binding.character_from_ground;
        ground.translation *= self.scale;
        ground
    }

    /// The same travel in the axes of the character, in metres.
    fn character_delta(&self, travel: &Travel) -> Transform3D {
        let character_from_ground = self.character_from_ground();
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
        let frame = convert::unscaled(before).basis;
        let mut after = before;
        after.origin = before.origin + frame * delta.origin;
        if travel.turn != 0.0 {
            // Rebuilt from rotation and scale, so that rounding cannot add up over a long walk.
            let turned = (frame * delta.basis).orthonormalized();
            after.basis = Basis::from_cols(
                as_long(turned.col_a(), before.basis.col_a()),
                as_long(turned.col_b(), before.basis.col_b()),
                as_long(turned.col_c(), before.basis.col_c()),
            );
        }
        if after != before {
            self.character.set_global_transform(after);
        }
    }
}

/// A direction with another vector's length, in double precision: single rounds the same way every frame.
fn as_long(direction: Vector3, other: Vector3) -> Vector3 {
    let length = |vector: Vector3| {
        let [x, y, z] = [vector.x, vector.y, vector.z].map(f64::from);
        (x * x + y * y + z * z).sqrt()
    };
    let factor = length(other) / length(direction).max(f64::MIN_POSITIVE);
    let [x, y, z] =
        [direction.x, direction.y, direction.z].map(|part| (f64::from(part) * factor) as f32);
    Vector3::new(x, y, z)
}

fn affine(transform: &GroundTransform) -> Affine3A {
    Affine3A::from_rotation_translation(
        rotation::from_heading(transform.heading),
        transform.position,
    )
}
