//! A walk under way: one generator on one skeleton.

use crate::convert;
use crate::skeleton_binding::SkeletonBinding;
use crate::travel::{Travel, Traveller};
use crate::walk_source::WalkSource;
use footfall_core::{Pose, Side};
use footfall_synth::{Controls, GaitGenerator, GeneratorConfig};
use godot::classes::Skeleton3D;
use godot::prelude::*;

/// A generator, the skeleton that it poses and the node that travels.
pub(super) struct Session {
    pub(super) generator: GaitGenerator,
    pub(super) traveller: Traveller,
    /// Since the walk began.
    pub(super) elapsed_secs: f64,
    source: WalkSource,
    pose: Pose,
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
            elapsed_secs: 0.0,
            source: source.clone(),
            traveller: Traveller::new(character, binding, start_from_ground),
        })
    }

    /// Whether this walk still is one of the model, its styles, the skeleton and the character.
    pub(super) fn is_for(&self, source: &WalkSource, skeleton: &Gd<Skeleton3D>) -> bool {
        self.source.is(source) && self.traveller.is_for(skeleton)
    }

    /// Goes on from a saved state; the character stays where it is.
    ///
    /// # Errors
    /// Why the state cannot be taken up, for the user.
    pub(super) fn restore(&mut self, state: &[u8]) -> Result<(), String> {
        self.generator
            .restore(state)
            .map_err(|error| error.to_string())?;
        self.traveller.place(self.generator.start_from_character());
        Ok(())
    }

    /// Lets time pass. With `dt_secs` 0 the pose stays and nothing travels.
    pub(super) fn advance(&mut self, dt_secs: f64, controls: Controls) -> Travel {
        self.elapsed_secs += dt_secs;
        self.generator
            .step(dt_secs as f32, &controls, &mut self.pose);
        self.traveller.go_to(self.generator.start_from_character())
    }

    /// Lets time pass without travelling.
    pub(super) fn skip(&mut self, secs: f64, controls: Controls) {
        // The generator takes no more of it at once.
        const MOST_SECS: f64 = 5.0;
        let mut left = secs;
        while left > 0.0 {
            let passes = left.min(MOST_SECS);
            self.generator
                .step(passes as f32, &controls, &mut self.pose);
            left -= passes;
        }
        self.elapsed_secs += secs;
        self.traveller.place(self.generator.start_from_character());
    }

    /// Poses the skeleton.
    pub(super) fn write(&mut self, skeleton: &mut Gd<Skeleton3D>) {
        self.traveller.binding.write(skeleton, &self.pose);
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
        let now = self.traveller.start_from_ground();
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
