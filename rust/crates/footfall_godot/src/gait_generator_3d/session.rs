//! A walk under way: one generator on one skeleton.

use super::fit::{Fitting, Maker};
use super::leaving::Leaving;
use super::observed_motion::{ObservedMotion, lower, raise};
use crate::convert;
use crate::skeleton_binding::{LayerWeights, SkeletonBinding};
use crate::travel::{Travel, Traveller};
use crate::walk_source::WalkSource;
use footfall_core::{Pose, Side};
use footfall_ik::handover::Handover;
use footfall_ik::placement::Frame;
use footfall_synth::{Controls, GaitGenerator, GeneratorConfig};
use godot::classes::Skeleton3D;
use godot::prelude::*;

/// Number of frames after which a body of a new size is measured again.
const SETTLED_FRAMES: u8 = 12;

/// A generator, the skeleton that it poses and the node that travels.
pub(crate) struct WalkSession {
    pub(super) generator: GaitGenerator,
    pub(super) traveller: Traveller,
    /// Since the walk began.
    pub(super) elapsed_secs: f64,
    source: WalkSource,
    /// In the space above the ground under the character.
    pub(super) pose: Pose,
    /// Last motion of the skeleton, in the space where the walk began.
    pub(super) shown: ObservedMotion,
    /// Handover from the motion before.
    pub(super) handover: Option<Handover>,
    /// Observed motion since other animation began to pose the skeleton.
    pub(super) watched: super::watch::Watch,
    pub(super) leaving: Option<Leaving>,
    size: Size,
}

/// Size of a character, and the time that it has had it.
#[derive(Debug, Default)]
struct Size {
    scale: f32,
    frames: u8,
}

impl WalkSession {
    /// Starts a walk at the character's place; the character stands if `controls` request no motion.
    ///
    /// # Errors
    /// Reason of the generator's refusal, for the user.
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
            shown: ObservedMotion::default(),
            handover: None,
            watched: super::watch::Watch::default(),
            leaving: None,
            size: Size::default(),
        })
    }

    /// Returns whether the walk still has this model with its styles, this skeleton and its character.
    pub(super) fn is_for(&mut self, source: &WalkSource, skeleton: &Gd<Skeleton3D>) -> bool {
        self.source.is(source) && self.traveller.is_for(skeleton)
    }

    /// Returns whether the character has changed its size and keeps the new one.
    pub(super) fn has_new_size(&mut self) -> bool {
        let scale = self.traveller.scale();
        let kept = (scale - self.size.scale).abs() < 1e-4 * scale;
        self.size.frames = if kept {
            self.size.frames.saturating_add(1)
        } else {
            0
        };
        self.size.scale = scale;
        self.traveller.has_grown() && self.size.frames >= SETTLED_FRAMES
    }

    /// Goes on from a saved state; the character stays where it is.
    ///
    /// # Errors
    /// Reason why the state cannot be restored, for the user.
    pub(super) fn restore(&mut self, state: &[u8]) -> Result<(), String> {
        self.generator
            .restore(state)
            .map_err(|error| error.to_string())?;
        self.traveller.place(self.generator.start_from_character());
        self.handover = None;
        Ok(())
    }

    /// Continues from another motion, given on the ground under the character in metres of the body: begins at the best matching phase
    /// and lets the difference fade out.
    ///
    /// # Errors
    /// Reason of the generator's refusal, for the user.
    pub(super) fn go_on_from(
        &mut self,
        from: &ObservedMotion,
        style_weights: &[f32],
        config: &GeneratorConfig,
        controls: Controls,
        secs: f64,
    ) -> Result<(), String> {
        let body = &self.traveller.binding.body;
        let maker = Maker {
            source: &self.source,
            style_weights,
            body,
            config: *config,
            controls: self.in_own_metres(controls),
        };
        let Fitting { generator, seen } = maker
            .fitting(from)
            .map_err(|error| format!("The walk cannot start: {error}"))?;
        let place = generator.start_from_character();
        let from = from.clone().raised(&Frame::from(place));
        let handover = Handover::new(
            body,
            &from.moving(),
            &seen.moving(),
            from.dt_secs,
            secs as f32,
        );
        self.handover = Some(handover);
        self.generator = generator;
        self.elapsed_secs = 0.0;
        self.traveller.place(place);
        Ok(())
    }

    /// Last motion of the skeleton, on the ground under the character, in metres of the world.
    pub(super) fn shown_here(&self) -> ObservedMotion {
        let place = Frame::from(self.traveller.ground_place());
        self.shown.relative_to(&place, self.traveller.scale())
    }

    /// Height of the hips above the floor in the rest pose, metres of the world.
    pub(super) fn hip_height(&self) -> f32 {
        self.traveller.binding.body.hip_height() * self.traveller.scale()
    }

    /// Controls in metres of the body as it was measured.
    fn in_own_metres(&self, mut controls: Controls) -> Controls {
        controls.speed_mps /= self.traveller.scale();
        controls
    }

    /// Advances the walk. With `dt_secs` 0 the pose stays and nothing travels.
    pub(super) fn advance(&mut self, dt_secs: f64, controls: Controls) -> Travel {
        self.elapsed_secs += dt_secs;
        let dt_secs = dt_secs as f32;
        let controls = self.in_own_metres(controls);
        self.generator.step(dt_secs, &controls, &mut self.pose);
        self.go_to_place(dt_secs)
    }

    /// Travels to where the generator is, and hands over from the motion before.
    pub(super) fn go_to_place(&mut self, dt_secs: f32) -> Travel {
        let place = self.generator.start_from_character();
        let travel = self.traveller.go_to(place);
        let ground = Frame::from(place);
        let stands = self.generator.feet_in_contact();
        raise(&ground, &mut self.pose);
        if let Some(handover) = &mut self.handover {
            handover.step(
                dt_secs,
                stands,
                self.generator.is_standing(),
                &mut self.pose,
            );
        }
        if dt_secs > 0.0 {
            self.shown.observe(&self.pose, stands, dt_secs);
        }
        lower(&ground, &mut self.pose);
        travel
    }

    /// Returns whether the previous motion has just faded out.
    pub(super) fn has_arrived(&mut self) -> bool {
        self.handover
            .take_if(|handover| handover.is_over())
            .is_some()
    }

    /// Advances the walk without travelling.
    pub(super) fn skip(&mut self, secs: f64, controls: Controls) {
        // The generator limits a single step to this.
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

    /// Poses the skeleton, except for the parts that the weights leave to other animation.
    pub(super) fn write(&mut self, skeleton: &mut Gd<Skeleton3D>, weights: &LayerWeights) {
        self.traveller
            .binding
            .write_layered(skeleton, &self.pose, weights);
    }

    /// The foot that lands next, where in global space, and the seconds until then.
    pub(super) fn next_foothold(&self, travel: &Travel) -> Option<(Side, Vector3, f32)> {
        let (footstep, secs) = self.generator.next_footstep()?;
        let position = travel
            .world_from_current()
            .transform_point3(footstep.position);
        Some((footstep.side, convert::vector3(position), secs))
    }

    /// The initial contacts of the last frame, in global space.
    ///
    /// The same whether this node moved the character or the game will by the delta.
    pub(super) fn footsteps(&self, travel: &Travel) -> Vec<(Side, Vector3)> {
        let now = self.traveller.start_from_ground();
        let world_from_start = travel.world_from_current() * now.inverse();
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
