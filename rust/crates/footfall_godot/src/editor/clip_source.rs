//! Recordings out of what a project has: motion files, and imported scenes whose animations move a skeleton.

mod sampler;

use footfall_motion::gltf::{animation_names, is_gltf};
use footfall_motion::recording::Recording;
use footfall_motion::retarget::RetargetOptions;
use footfall_motion::skeletal::SkeletalMotion;
use godot::classes::{
    Animation, AnimationPlayer, PackedScene, ProjectSettings, ResourceLoader, Skeleton3D,
};
use godot::prelude::*;
use std::path::{Path, PathBuf};

/// Something to learn from.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Clip {
    /// A BVH or glTF file, with `#Name` for one of several animations.
    File(PathBuf),
    /// An animation of a scene, sampled.
    Sampled {
        /// Scene and animation.
        label: String,
        /// Bones over time.
        motion: SkeletalMotion,
    },
}

impl Clip {
    /// Everything that a file holds. Scenes of the project that Godot imported, from FBX for example, are sampled.
    ///
    /// # Errors
    /// The reason why there is nothing in it to learn from, for the user.
    pub(super) fn all_of(file: &GString) -> Result<Vec<Self>, String> {
        let settings = ProjectSettings::singleton();
        let path = PathBuf::from(settings.globalize_path(file).to_string());
        let extension = path.extension().unwrap_or_default().to_ascii_lowercase();
        if extension == "bvh" {
            return Ok(vec![Self::File(path)]);
        }
        if is_gltf(&path) {
            let names = animation_names(&path).map_err(|error| error.to_string())?;
            return Ok(match names.len() {
                0 | 1 => vec![Self::File(path)],
                _ => names
                    .iter()
                    .map(|name| Self::File(format!("{}#{name}", path.display()).into()))
                    .collect(),
            });
        }
        let local = settings.localize_path(file);
        if !local.begins_with("res://") {
            return Err(format!(
                "{file}: put it into the project first, so that Godot imports it."
            ));
        }
        let scene = ResourceLoader::singleton()
            .load(&local)
            .and_then(|resource| resource.try_cast::<PackedScene>().ok())
            .ok_or_else(|| {
                format!(
                    "{local} is no scene with a character. Choose a .bvh, .glb, .gltf or .fbx file."
                )
            })?;
        Self::of_scene(&scene, &local)
    }

    /// The animations of a scene.
    ///
    /// # Errors
    /// As [`Self::all_of`].
    pub(super) fn of_scene(scene: &Gd<PackedScene>, name: &GString) -> Result<Vec<Self>, String> {
        let root = scene
            .instantiate()
            .ok_or_else(|| format!("{name} cannot be opened."))?;
        let skeleton = first_below::<Skeleton3D>(&root, "Skeleton3D");
        let player = first_below::<AnimationPlayer>(&root, "AnimationPlayer");
        let mut clips = Vec::new();
        if let (Some(skeleton), Some(player)) = (&skeleton, &player) {
            for animation_name in player.get_animation_list().as_slice() {
                let animation = player.get_animation(&StringName::from(animation_name));
                let motion = animation.and_then(|animation| sampler::sample(&animation, skeleton));
                clips.extend(motion.map(|motion| Self::Sampled {
                    label: format!("{}#{animation_name}", name.get_file()),
                    motion,
                }));
            }
        }
        let has_skeleton = skeleton.is_some();
        root.free();
        match (clips.is_empty(), has_skeleton) {
            (false, _) => Ok(clips),
            (true, false) => Err(format!(
                "{name} has no Skeleton3D. Choose the scene of a character."
            )),
            (true, true) => Err(format!(
                "{name} has no animation that moves its Skeleton3D. Choose a scene with an AnimationPlayer, as Godot imports it."
            )),
        }
    }

    /// An animation as it moves a skeleton.
    ///
    /// # Errors
    /// When no track of it is of the skeleton's bones.
    pub(super) fn of_animation(
        animation: &Gd<Animation>,
        skeleton: &Gd<Skeleton3D>,
    ) -> Result<Self, String> {
        let label = animation.get_path().get_file();
        let motion = sampler::sample(animation, skeleton).ok_or_else(|| {
            format!("The animation {label} turns no bone of the skeleton. Give the skeleton that it was made for.")
        })?;
        Ok(Self::Sampled {
            label: label.to_string(),
            motion,
        })
    }

    /// The name that a list shows.
    pub(super) fn label(&self) -> String {
        match self {
            Self::File(path) => file_name(path),
            Self::Sampled { label, .. } => label.clone(),
        }
    }

    /// Reads it.
    ///
    /// # Errors
    /// Names the file or animation.
    pub(super) fn read(&self) -> Result<Recording, String> {
        match self {
            Self::File(path) => Recording::read(path, &RetargetOptions::default())
                .map_err(|error| error.to_string()),
            Self::Sampled { label, motion } => {
                Recording::of_clip(motion).map_err(|error| format!("{label}: {error}"))
            }
        }
    }
}

fn file_name(path: &Path) -> String {
    let name = path.file_name();
    name.map(|name| name.to_string_lossy().into_owned())
        .unwrap_or_default()
}

/// The node itself or the first below it of a class.
fn first_below<T: Inherits<Node> + GodotClass>(root: &Gd<Node>, class: &str) -> Option<Gd<T>> {
    let below = root.find_children_ex("*").type_(class).owned(false).done();
    std::iter::once(root.clone())
        .chain(below.iter_shared())
        .find_map(|node| node.try_cast().ok())
}
