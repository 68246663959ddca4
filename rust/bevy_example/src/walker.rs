//! A component that walks the bones below its entity.

use crate::bones::{Posed, Transforms};
use anyhow::Result;
use bevy::prelude::*;
use footfall::body::{JOINT_COUNT, Pose};
use footfall::gait::{Controls, GaitGenerator, GeneratorConfig, StyleSpace};
use footfall::glam::Affine3A;
use footfall::ground::Frame;
use footfall::rig::{BindingError, RestRig, RigBinding, joint_bones};
use std::sync::Arc;

/// A humanoid that walks from where its entity is.
#[derive(Component)]
pub(crate) struct Walker {
    /// The walk that is requested.
    pub(crate) controls: Controls,
    pub(crate) gait: GaitGenerator,
    pub(crate) binding: RigBinding,
    pub(crate) pose: Pose,
    /// The entity of each bone of the rig.
    pub(crate) bones: Vec<Entity>,
    /// Ground that the character stood on when the walk began.
    pub(crate) world_from_start: Frame,
}

impl Walker {
    /// Measures a character, which then walks with proportions of its own.
    ///
    /// # Errors
    /// A rig without joints that are needed, or one that cannot stand.
    pub(crate) fn new(
        styles: &Arc<StyleSpace>,
        rig: &RestRig,
        bones: Vec<Entity>,
        world_from_character: &Transform,
    ) -> Result<Self> {
        let joints = joint_bones(rig.rig(), &[None; JOINT_COUNT]).map_err(BindingError::from)?;
        let metres = Affine3A::from_scale(world_from_character.scale);
        let binding = RigBinding::new(rig, &joints, &metres)?;
        let config = GeneratorConfig {
            seed: 1,
            phase: 0.0,
            variation: 1.0,
        };
        let mut gait = GaitGenerator::new(styles, &[], &binding.body, &config)?;
        gait.stand();
        let world_from_start = binding.world_from_ground(&Frame {
            position: world_from_character.translation,
            rotation: world_from_character.rotation,
        });
        Ok(Self {
            controls: Controls::STAND,
            pose: Pose::rest(&binding.body),
            gait,
            binding,
            bones,
            world_from_start,
        })
    }
}

/// Moves every walker on by the time that has passed: its entity over the ground, and its bones.
pub(crate) fn walk(
    time: Res<Time>,
    mut walkers: Query<(&mut Walker, &mut Transform)>,
    mut transforms: Transforms,
) {
    for (mut walker, mut transform) in &mut walkers {
        let walker = &mut *walker;
        walker
            .gait
            .step(time.delta_secs(), &walker.controls, &mut walker.pose);
        let start_from_ground = Frame::from(walker.gait.start_from_character());
        let world_from_ground = walker.world_from_start.child(&start_from_ground);
        let place = walker.binding.world_from_character(&world_from_ground);
        transform.translation = place.position;
        transform.rotation = place.rotation;
        let mut bones = Posed {
            entities: &walker.bones,
            transforms: &mut transforms,
        };
        walker.binding.write(&mut bones, &walker.pose);
    }
}
