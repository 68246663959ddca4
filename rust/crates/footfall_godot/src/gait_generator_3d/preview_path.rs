//! Preview of the walk's path, which the editor draws.

use super::GaitGenerator3D;
use crate::convert;
use crate::modifier::BodyModifier as _;
use footfall_core::Pose;
use footfall_synth::Footstep;
use glam::{Affine3A, Vec3};
use godot::obj::WithBaseField as _;

/// Number of steps ahead that are shown, and the longest wait for them, in frames.
const STEPS_AHEAD: usize = 12;
const MOST_FRAMES: usize = 600;
const FRAME_SECS: f32 = 1.0 / 30.0;

/// Steps to come.
pub(crate) struct PreviewPath {
    /// Places of the walker on the ground, from where it stands now.
    pub(crate) path: Vec<Vec3>,
    /// Places of its feet.
    pub(crate) footsteps: Vec<Footstep>,
    /// Global transform of the ground that it stands on now.
    pub(crate) world_from_ground: Affine3A,
}

impl GaitGenerator3D {
    /// Path of the walk from its beginning, with the current controls; `None` if the character cannot walk.
    pub(crate) fn preview_path(&self) -> Option<PreviewPath> {
        let controls = self.controls();
        let skeleton = self.base().get_skeleton()?;
        if controls.is_standing() || !skeleton.is_inside_tree() {
            return None;
        }
        let (character, binding) = self.bind(&skeleton).ok()?;
        let source = self.find_source().ok()?;
        let config = self.config();
        let weights = self.style_weights.as_slice();
        let mut generator = source.generator(weights, &binding.body, &config).ok()?;
        let mut pose = Pose::rest(&binding.body);
        let (mut path, mut footsteps) = (vec![Vec3::ZERO], Vec::new());
        for _ in 0..MOST_FRAMES {
            generator.step(FRAME_SECS, &controls, &mut pose);
            path.push(generator.start_from_character().position);
            footsteps.extend_from_slice(generator.footsteps());
            if footsteps.len() >= STEPS_AHEAD {
                break;
            }
        }
        let world_from_character = convert::unscaled(character.get_global_transform());
        Some(PreviewPath {
            path,
            footsteps,
            world_from_ground: convert::affine(world_from_character)
                * binding.character_from_ground,
        })
    }
}
