//! A walk under way: one generator on one skeleton.

use crate::convert;
use crate::skeleton_binding::SkeletonBinding;
use crate::walk_source::WalkSource;
use footfall_core::{Pose, Side, rotation};
use footfall_synth::{Controls, GaitGenerator, GeneratorConfig, GroundTransform};
use glam::{Affine3A, Quat};
use godot::classes::Skeleton3D;
use godot::prelude::*;

/// A generator, the skeleton that it poses and the node that travels.
pub(super) struct Session {
    pub(super) generator: GaitGenerator,
    source: WalkSource,
    character: Gd<Node3D>,
    binding: SkeletonBinding,
    pose: Pose,
    start_from_ground: GroundTransform,
}

/// What one frame did to the ground under the character.
pub(super) struct Travel {
    /// `previous_from_current` of the ground under the body.
    ground: Affine3A,
    /// Its rotation alone: about +Y, exactly 0 when the character does not turn.
    turn: f32,
    /// Global transform of that ground before the character was moved, without any scale.
    world_from_ground: Affine3A,
}

impl Session {
    /// Starts a walk where the character stands; when `controls` ask for none, it stands there.
    ///
    /// # Errors
    /// Why the generator refuses, for the user.
    pub(super) fn new(
        source: &WalkSource,
        style_weights: &[f32],
        character: Gd<Node3D>,
        binding: SkeletonBinding,
        config: &GeneratorConfig,
        controls: Controls,
    ) -> Result<Self, String> {
        let mut generator = source
            .generator(style_weights, &binding.body, config)
            .map_err(|error| format!("The walk cannot start: {error}"))?;
        if controls.is_standing() {
            generator.stand();
        }
        let start_from_ground = generator.start_from_character();
        Ok(Self {
            pose: Pose::rest(&binding.body),
            generator,
            source: source.clone(),
            character,
            binding,
            start_from_ground,
        })
    }

    /// Whether this walk still is one of the model, its styles, the skeleton and the character.
    pub(super) fn is_for(&self, source: &WalkSource, skeleton: &Gd<Skeleton3D>) -> bool {
        self.source.is(source)
            && self.character.is_instance_valid()
            && self.character.is_inside_tree()
            && self.binding.fits(skeleton, &self.character)
    }

    /// Goes on from a saved state; the character stays where it is.
    ///
    /// # Errors
    /// Why the state cannot be taken up, for the user.
    pub(super) fn restore(&mut self, state: &[u8]) -> Result<(), String> {
        self.generator
            .restore(state)
            .map_err(|error| error.to_string())?;
        self.start_from_ground = self.generator.start_from_character();
        Ok(())
    }

    /// Lets time pass. With `dt_secs` 0 the pose stays and nothing travels.
    pub(super) fn advance(&mut self, dt_secs: f32, controls: Controls) -> Travel {
        self.generator.step(dt_secs, &controls, &mut self.pose);
        let start_from_ground = self.generator.start_from_character();
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
    pub(super) fn local_delta(&self, travel: &Travel) -> Transform3D {
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
    pub(super) fn move_character(&mut self, travel: &Travel) {
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

    /// Poses the skeleton.
    pub(super) fn write(&mut self, skeleton: &mut Gd<Skeleton3D>) {
        self.binding.write(skeleton, &self.pose);
    }

    /// The foot that lands next, where in global space, and the seconds until then.
    pub(super) fn next_foothold(&self, travel: &Travel) -> Option<(Side, Vector3, f32)> {
        let (footstep, secs) = self.generator.next_footstep()?;
        let world_from_ground = travel.world_from_ground * travel.ground;
        let position = world_from_ground.transform_point3(footstep.position);
        Some((footstep.side, convert::vector3(position), secs))
    }

    /// The initial contacts of the last frame, in global space.
    ///
    /// The same whether this node moved the character or the game will by the delta.
    pub(super) fn footsteps(&self, travel: &Travel) -> Vec<(Side, Vector3)> {
        let now = affine(&self.start_from_ground);
        let world_from_start = travel.world_from_ground * travel.ground * now.inverse();
        self.generator
            .footsteps()
            .iter()
            .map(|footstep| {
                let position = world_from_start.transform_point3(footstep.position);
                (footstep.side, convert::vector3(position))
            })
            .collect()
    }
}

fn affine(transform: &GroundTransform) -> Affine3A {
    Affine3A::from_rotation_translation(
        rotation::from_heading(transform.heading),
        transform.position,
    )
}
