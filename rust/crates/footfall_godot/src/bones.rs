//! Bones of a `Skeleton3D`: as they rest, as the user's bone map names them; and choice of the skeleton.

use crate::convert;
use footfall_core::Joint;
use footfall_rig::{MappedBones, RestRig};
use godot::classes::{BoneMap, Engine, Skeleton3D, SkeletonModifier3D, SkeletonProfileHumanoid};
use godot::prelude::*;

/// Skeletons that a warning names.
const MOST_NAMED: usize = 3;

/// The bones of a skeleton as they rest.
pub(crate) fn at_rest(skeleton: &Gd<Skeleton3D>) -> RestRig {
    RestRig::new((0..skeleton.get_bone_count()).map(|bone| {
        let parent = usize::try_from(skeleton.get_bone_parent(bone)).ok();
        let rest = convert::affine(skeleton.get_bone_rest(bone));
        (skeleton.get_bone_name(bone).to_string(), parent, rest)
    }))
}

/// Bones that the user's map names.
pub(crate) fn mapped(skeleton: &Gd<Skeleton3D>, bone_map: Option<&Gd<BoneMap>>) -> MappedBones {
    Joint::ALL.map(|joint| {
        let name = bone_map.map(|map| map.get_skeleton_bone_name(joint.name()))?;
        let is_named = !name.is_empty();
        // A name that the skeleton does not have is an error of the map, not for others to mend.
        is_named.then(|| usize::try_from(skeleton.find_bone(&GString::from(&name))).ok())
    })
}

/// A bone map for a property: one without a profile gets the humanoid one, so that the inspector shows the bones to fill in.
pub(crate) fn completed(mut bone_map: Option<Gd<BoneMap>>) -> Option<Gd<BoneMap>> {
    if let Some(bone_map) = &mut bone_map
        && Engine::singleton().is_editor_hint()
        && bone_map.get_profile().is_none()
    {
        bone_map.set_profile(&SkeletonProfileHumanoid::new_gd());
    }
    bone_map
}

/// The problem of a modifier that is not the child of a `Skeleton3D`, with the skeletons of its scene.
pub(crate) fn no_skeleton(modifier: &Gd<SkeletonModifier3D>) -> GString {
    const NEXT: &str = "Put this node under a Skeleton3D";
    if !modifier.is_inside_tree() {
        return GString::from(&format!("{NEXT}."));
    }
    let mut scene = modifier.clone().upcast::<Node>();
    while let Some(above) = scene.get_parent() {
        if Some(&scene) == modifier.get_owner().as_ref() {
            break;
        }
        scene = above;
    }
    let found = scene.find_children_ex("*").type_("Skeleton3D").owned(false);
    let skeletons: Vec<Gd<Node>> = found.done().iter_shared().take(MOST_NAMED).collect();
    let Some(first) = skeletons.first() else {
        return GString::from(&format!(
            "{NEXT}. This scene has none: add a character with a skeleton, such as an imported glTF file."
        ));
    };
    let paths = skeletons
        .iter()
        .map(|skeleton| scene.get_path_to(skeleton).to_string());
    let named = paths.collect::<Vec<_>>().join(" or ");
    let instance = first
        .get_owner()
        .filter(|owner| *owner != scene && !scene.is_editable_instance(owner));
    let opened = instance.map_or_else(String::new, |owner| {
        let name = owner.get_name();
        format!("right-click {name} in the Scene dock, turn on Editable Children, then ")
    });
    GString::from(&format!(
        "{NEXT}: {opened}drag it onto {named}. A reimported character may have another name for its skeleton."
    ))
}
