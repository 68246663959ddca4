//! Clips of scenes, animations and libraries of animations.

use super::{Clip, sampler};
use godot::classes::{
    Animation, AnimationLibrary, AnimationPlayer, PackedScene, Resource, ResourceLoader, Skeleton3D,
};
use godot::prelude::*;

/// The animation that holds a scene's initial values, without a walk.
const RESET: &str = "RESET";

/// A resource of the project.
///
/// # Errors
/// The reason why there is none, for the user.
pub(super) fn load(file: &GString) -> Result<Gd<Resource>, String> {
    if !file.begins_with("res://") && !file.begins_with("uid://") {
        return Err(format!(
            "{file} is not in the project. Copy it into the project, so that Godot imports it."
        ));
    }
    let mut loader = ResourceLoader::singleton();
    if !loader.exists(file) {
        return Err(format!(
            "{file} does not exist, or Godot has not imported it. Choose a .bvh, .glb, .gltf or .fbx file, a scene or an animation."
        ));
    }
    loader
        .load(file)
        .ok_or_else(|| format!("{file} cannot be loaded. The Output panel says why."))
}

impl Clip {
    /// All clips of a scene, an animation or a library; animations move the skeleton among `skeletons` that has their bones.
    ///
    /// # Errors
    /// The reason why there is nothing in it to learn from, for the user.
    pub(in crate::editor) fn of_resource(
        resource: &Gd<Resource>,
        skeletons: &[Gd<Skeleton3D>],
    ) -> Result<Vec<Self>, String> {
        let label = label_of(resource);
        if let Ok(scene) = resource.clone().try_cast::<PackedScene>() {
            return of_scene(&scene, &label);
        }
        if let Ok(animation) = resource.clone().try_cast::<Animation>() {
            return Ok(vec![of_animation(&animation, label, skeletons)?]);
        }
        if let Ok(library) = resource.clone().try_cast::<AnimationLibrary>() {
            return of_library(&library, &label, skeletons);
        }
        Err(format!(
            "{label} is a {}. Choose a scene with a character, an Animation or an AnimationLibrary.",
            resource.get_class()
        ))
    }
}

fn of_scene(scene: &Gd<PackedScene>, label: &str) -> Result<Vec<Clip>, String> {
    if !scene.can_instantiate() {
        return Err(format!(
            "{label} is an empty scene. Choose the scene of a character."
        ));
    }
    let root = scene
        .instantiate()
        .ok_or_else(|| format!("{label} cannot be opened. The Output panel says why."))?;
    let clips = of_character(&root, label);
    root.free();
    clips
}

fn of_character(root: &Gd<Node>, label: &str) -> Result<Vec<Clip>, String> {
    let skeleton = first_below::<Skeleton3D>(root, "Skeleton3D")
        .ok_or_else(|| format!("{label} has no Skeleton3D. Choose the scene of a character."))?;
    let player = first_below::<AnimationPlayer>(root, "AnimationPlayer").ok_or_else(|| {
        format!("{label} has no AnimationPlayer. Choose a scene with the character's animations, or add the animations alone.")
    })?;
    let names = player.get_animation_list();
    let named = names.as_slice().iter().filter_map(|name| {
        let animation = player.get_animation(&StringName::from(name))?;
        Some((name.to_string(), animation))
    });
    let clips: Vec<Clip> = sampled(named, label, &skeleton).collect();
    if clips.is_empty() {
        return Err(format!(
            "No animation of {label} rotates bones of its Skeleton3D. Export the character with its animations."
        ));
    }
    Ok(clips)
}

fn of_library(
    library: &Gd<AnimationLibrary>,
    label: &str,
    skeletons: &[Gd<Skeleton3D>],
) -> Result<Vec<Clip>, String> {
    let names = library.get_animation_list();
    let named: Vec<(String, Gd<Animation>)> = names
        .iter_shared()
        .filter_map(|name| Some((name.to_string(), library.get_animation(&name)?)))
        .collect();
    let (_, first) = named
        .first()
        .ok_or_else(|| format!("{label} has no animations. Choose another library."))?;
    let skeleton = skeleton_of(first, label, skeletons)?;
    Ok(sampled(named.into_iter(), label, skeleton).collect())
}

fn of_animation(
    animation: &Gd<Animation>,
    label: String,
    skeletons: &[Gd<Skeleton3D>],
) -> Result<Clip, String> {
    let skeleton = skeleton_of(animation, &label, skeletons)?;
    let motion = sampler::sample(animation, skeleton)
        .ok_or_else(|| format!("{label} rotates no bones. Choose an animation that walks."))?;
    Ok(Clip::Sampled { label, motion })
}

/// The skeleton that has most of an animation's bones.
fn skeleton_of<'a>(
    animation: &Gd<Animation>,
    label: &str,
    skeletons: &'a [Gd<Skeleton3D>],
) -> Result<&'a Gd<Skeleton3D>, String> {
    if skeletons.is_empty() {
        return Err(format!(
            "{label} has no rest poses of its bones. Open the scene of its character (in a script: set `skeleton`), or choose the character's file."
        ));
    }
    let mut found = (0, None);
    for skeleton in skeletons {
        let bones = sampler::bones_turned(animation, skeleton);
        if bones > found.0 {
            found = (bones, Some(skeleton));
        }
    }
    found.1.ok_or_else(|| {
        format!(
            "{label} rotates no bone of the skeleton {}. Give the skeleton that it was made for.",
            skeletons[0].get_name()
        )
    })
}

fn sampled<'a>(
    animations: impl Iterator<Item = (String, Gd<Animation>)> + 'a,
    label: &'a str,
    skeleton: &'a Gd<Skeleton3D>,
) -> impl Iterator<Item = Clip> + 'a {
    animations
        .filter(|(name, _)| name != RESET)
        .filter_map(move |(name, animation)| {
            Some(Clip::Sampled {
                label: format!("{label}#{name}"),
                motion: sampler::sample(&animation, skeleton)?,
            })
        })
}

/// The file of a resource, else its name, else its class.
fn label_of(resource: &Gd<Resource>) -> String {
    let names = [resource.get_path().get_file(), resource.get_name()];
    let named = names.into_iter().find(|name| !name.is_empty());
    named.unwrap_or_else(|| resource.get_class()).to_string()
}

/// The node itself or the first below it of a class.
fn first_below<T: Inherits<Node> + GodotClass>(root: &Gd<Node>, class: &str) -> Option<Gd<T>> {
    all_below(root, class).into_iter().next()
}

/// The node itself and all below it that are of a class.
pub(in crate::editor) fn all_below<T: Inherits<Node> + GodotClass>(
    root: &Gd<Node>,
    class: &str,
) -> Vec<Gd<T>> {
    let below = root.find_children_ex("*").type_(class).owned(false).done();
    std::iter::once(root.clone())
        .chain(below.iter_shared())
        .filter_map(|node| node.try_cast().ok())
        .collect()
}
