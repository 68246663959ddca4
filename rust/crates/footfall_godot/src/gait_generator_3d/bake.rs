//! Walks as animations, for platforms and tools without the add-on.

mod clip;

use super::GaitGenerator3D;
use crate::modifier::BodyModifier as _;
use crate::skeleton_binding::SkeletonBinding;
use crate::walk_source::WalkSource;
use clip::Clips;
use footfall_synth::{GaitGenerator, LoopedWalk};
use godot::classes::{Animation, AnimationLibrary, Skeleton3D};
use godot::prelude::*;

/// The walk without a style, as clips name it.
const PLAIN: &str = "neutral";
/// Metadata of an animation library that names the root's track.
const ROOT_MOTION_TRACK: &str = "root_motion_track";

#[godot_api(secondary)]
impl GaitGenerator3D {
    /// Bakes this character's walk to animations, which an `AnimationPlayer` or `AnimationTree` plays without the add-on: for platforms without
    /// a build of the add-on, for other tools, or for a crowd of your own. Returns `null` if the character cannot walk; the log gives the reason.
    ///
    /// `seconds` is the approximate length of a clip: it is rounded to whole strides, from one left initial contact to another. `styles` names some of
    /// the node's `styles`, or `neutral` for the walk without a style; if it is empty, all are baked. `speeds` are in metres per second. The clips are
    /// named `walk_<style>_<speed>`, such as `walk_sad_1.2`, and `idle_<style>`. All of them loop and use `seed`,
    /// `variation` and `standing_motion`.
    ///
    /// The root moves at exactly the constant speed in the clip's name. Its track is the topmost bone above the hips, or the `Skeleton3D`
    /// itself if the hips are topmost. Set it on the player: `player.root_motion_track = library.get_meta("root_motion_track")`.
    /// Paths start at the root of the scene that contains the skeleton, where an imported character has its `AnimationPlayer`.
    ///
    /// Baking takes some tens of milliseconds per clip. The node does not change.
    #[func]
    #[expect(clippy::needless_pass_by_value, reason = "Godot calls by value")]
    fn bake(
        &mut self,
        seconds: f64,
        styles: PackedStringArray,
        speeds: PackedFloat32Array,
    ) -> Option<Gd<AnimationLibrary>> {
        match self.baked(seconds, styles.as_slice(), speeds.as_slice()) {
            Ok(library) => Some(library),
            Err(problem) => {
                let node = self.base().get_name();
                godot_error!("{node}: nothing was baked: {problem}");
                None
            }
        }
    }
}

impl GaitGenerator3D {
    fn baked(
        &self,
        seconds: f64,
        styles: &[GString],
        speeds: &[f32],
    ) -> Result<Gd<AnimationLibrary>, String> {
        let skeleton = self
            .base()
            .get_skeleton()
            .filter(|skeleton| skeleton.is_inside_tree())
            .ok_or("Put this node under a Skeleton3D that is in the tree.")?;
        if !(seconds.is_finite() && seconds > 0.0) {
            return Err(format!(
                "{seconds} is not a valid clip length. Give a positive number of seconds."
            ));
        }
        if let Some(speed) = speeds
            .iter()
            .find(|speed| !(speed.is_finite() && **speed >= 0.2))
        {
            return Err(format!(
                "{speed} m/s is not a walking speed. Give 0.2 or more."
            ));
        }
        let source = self.find_source()?;
        let (character, binding) = self.bind(&skeleton)?;
        let mut clips = Clips::of(&skeleton, &character, binding);
        let mut library = AnimationLibrary::new_gd();
        for (name, weights) in worn(&source, styles)? {
            let mut standing = self.generator(&source, &weights, clips.binding())?;
            standing.set_standing_motion(self.standing_motion as f32);
            let still = LoopedWalk::standing(standing, seconds as f32);
            add(
                &mut library,
                &format!("idle_{name}"),
                &clips.animation(&still),
            );
            for &speed in speeds {
                let make = || self.generator(&source, &weights, clips.binding()).ok();
                let walk = LoopedWalk::record(make, speed, seconds as f32).ok_or_else(|| {
                    format!("No whole stride at {speed} m/s in style {name}. Give another speed.")
                })?;
                let off = walk.speed_mps / speed - 1.0;
                if off.abs() > 0.001 {
                    godot_warn!(
                        "walk_{name}_{speed}: the model walks at {:.2} m/s at most",
                        walk.speed_mps
                    );
                }
                add(
                    &mut library,
                    &format!("walk_{name}_{speed}"),
                    &clips.animation(&walk),
                );
            }
        }
        library.set_meta(ROOT_MOTION_TRACK, &clips.root_path().to_variant());
        Ok(library)
    }

    fn generator(
        &self,
        source: &WalkSource,
        weights: &[f32],
        binding: &SkeletonBinding,
    ) -> Result<GaitGenerator, String> {
        source
            .generator(weights, &binding.body, &self.config())
            .map_err(|error| format!("The walk cannot start: {error}"))
    }
}

/// Styles to bake by name, with the weights of each.
fn worn(source: &WalkSource, names: &[GString]) -> Result<Vec<(String, Vec<f32>)>, String> {
    let known: Vec<&str> = source
        .styles()
        .iter()
        .map(|style| style.name.as_str())
        .collect();
    let wearing = |index: Option<usize>| {
        let mut weights = vec![0.0; known.len()];
        if let Some(index) = index {
            weights[index] = 1.0;
        }
        weights
    };
    if names.is_empty() {
        let plain = (PLAIN.to_owned(), wearing(None));
        let styled = known
            .iter()
            .enumerate()
            .map(|(index, name)| ((*name).to_owned(), wearing(Some(index))));
        return Ok(core::iter::once(plain).chain(styled).collect());
    }
    names
        .iter()
        .map(|name| {
            let name = name.to_string();
            let index = known.iter().position(|known| *known == name);
            if index.is_none() && name != PLAIN {
                return Err(format!(
                    "Styles has no style {name}. It has {PLAIN}, {}.",
                    known.join(", ")
                ));
            }
            Ok((name, wearing(index)))
        })
        .collect()
}

fn add(library: &mut Gd<AnimationLibrary>, name: &str, animation: &Gd<Animation>) {
    library.add_animation(name, animation);
}

/// The scene's root that paths of clips begin at: that of the scene that the skeleton came in, else the node above it.
fn stage(skeleton: &Gd<Skeleton3D>) -> Option<Gd<Node>> {
    skeleton.get_owner().or_else(|| skeleton.get_parent())
}
