//! Recordings out of what a project has: motion files, and scenes and animations that move a skeleton.

mod resource;
mod sampler;

use footfall_motion::gltf::{animation_names, is_gltf};
use footfall_motion::recording::Recording;
use footfall_motion::retarget::{RetargetError, RetargetOptions};
use footfall_motion::skeletal::SkeletalMotion;
use godot::classes::{FileAccess, ProjectSettings, Skeleton3D};
use godot::prelude::*;
pub(super) use resource::all_below;
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
    /// Everything that a file holds, or the one animation that stands behind `#`. What Godot imported is sampled as it imported it, with the
    /// names of a `BoneMap`; animations without a character move the skeleton among `skeletons` that has their bones.
    ///
    /// # Errors
    /// The reason why there is nothing in it to learn from, for the user.
    pub(super) fn all_of(
        file: &GString,
        skeletons: &[Gd<Skeleton3D>],
    ) -> Result<Vec<Self>, String> {
        let settings = ProjectSettings::singleton();
        let (file, wanted) = split_name(file);
        let path = PathBuf::from(settings.globalize_path(&file).to_string());
        let extension = path.extension().unwrap_or_default().to_ascii_lowercase();
        if extension == "bvh" {
            return Ok(vec![Self::File(path)]);
        }
        let imported = resource::load(&settings.localize_path(&file))
            .and_then(|resource| Self::of_resource(&resource, skeletons));
        let clips = match imported {
            Err(_) if is_gltf(&path) => Self::of_gltf(&path)?,
            found => found?,
        };
        match wanted {
            Some(wanted) => Self::named(clips, &wanted, &file),
            None => Ok(clips),
        }
    }

    /// The animations of a glTF file.
    fn of_gltf(path: &Path) -> Result<Vec<Self>, String> {
        let names = animation_names(path).map_err(|error| error.to_string())?;
        if names.is_empty() {
            return Ok(vec![Self::File(path.to_owned())]);
        }
        let named = |name| Self::File(format!("{}#{name}", path.display()).into());
        Ok(names.iter().map(named).collect())
    }

    /// The one clip of a name.
    fn named(clips: Vec<Self>, wanted: &str, file: &GString) -> Result<Vec<Self>, String> {
        let names: Vec<String> = clips
            .iter()
            .map(|clip| {
                let label = clip.label();
                let name = label.split_once('#').map(|(_, name)| name.to_owned());
                name.unwrap_or(label)
            })
            .collect();
        let mut clips = clips.into_iter().zip(&names);
        let found = clips.find(|(_, name)| *name == wanted);
        found.map(|(clip, _)| vec![clip]).ok_or_else(|| {
            format!(
                "{file} has no animation \"{wanted}\". It has {}.",
                names.join(", ")
            )
        })
    }

    /// The name that a list shows.
    pub(super) fn label(&self) -> String {
        match self {
            Self::File(path) => {
                let name = path.file_name();
                name.map(|name| name.to_string_lossy().into_owned())
                    .unwrap_or_default()
            }
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
                Recording::of_clip(motion).map_err(|error| format!("{label}: {}", advice(&error)))
            }
        }
    }
}

/// Problem with a rig, and its remedy in the editor.
fn advice(error: &RetargetError) -> String {
    match error {
        RetargetError::UnknownSkeleton {
            missing, doubts, ..
        } => {
            let missing: Vec<&str> = missing.iter().map(|joint| joint.name()).collect();
            format!(
                "no bone is known to be {}{doubts}. Give the rig a BoneMap: double-click its file in the FileSystem dock, select the \
                 Skeleton3D, and under Retarget make a new Bone Map with the profile SkeletonProfileHumanoid.",
                missing.join(", ")
            )
        }
        other => other.to_string(),
    }
}

/// The file, and the animation's name behind `#`, unless a file has that very name.
fn split_name(file: &GString) -> (GString, Option<String>) {
    let text = file.to_string();
    match text.rsplit_once('#') {
        Some((path, name)) if !FileAccess::file_exists(file) => {
            (GString::from(path), Some(name.to_owned()))
        }
        _ => (file.clone(), None),
    }
}
