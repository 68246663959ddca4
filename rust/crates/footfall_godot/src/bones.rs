//! Assignment of a `Skeleton3D`'s bones to joints: by the user's bone map, by the profile's names, or as recognised; and choice of the skeleton.

use crate::rest_body::is_optional;
use footfall_core::rig::{Placement, Recognition, recognise};
use footfall_core::{JOINT_COUNT, Joint, Rig};
use godot::classes::{BoneMap, Engine, Skeleton3D, SkeletonModifier3D, SkeletonProfileHumanoid};
use godot::prelude::*;

/// Skeletons that a warning names.
const MOST_NAMED: usize = 3;

/// Joints that no bone was found for.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error(
    "The skeleton lacks {joints}; its bones look most like those of {family} rigs{doubts}. Give this node a Bone Map that tells which \
     bones these are (Bone Map, New BoneMap), or reimport the character with a BoneMap (Advanced Import Settings, Skeleton3D, \
     Retarget)."
)]
pub(crate) struct MissingBones {
    joints: String,
    family: String,
    /// Why bones of these names were left out, each with `; ` before it.
    doubts: String,
}

/// The bone of each joint. Joints that may be missing are `None`.
///
/// Names in the bone map hold. The others have the profile's names, if all that are needed do; else the whole rig is looked at, for in many
/// families a `Spine` is not the profile's.
///
/// # Errors
/// Joints that are needed and missing.
pub(crate) fn of_joints(
    skeleton: &Gd<Skeleton3D>,
    bone_map: Option<&Gd<BoneMap>>,
) -> Result<[Option<i32>; JOINT_COUNT], MissingBones> {
    let found = |name: &GString| Some(skeleton.find_bone(name)).filter(|bone| *bone >= 0);
    let mapped = Joint::ALL.map(|joint| {
        let name = bone_map.map(|map| map.get_skeleton_bone_name(joint.name()))?;
        let is_named = !name.is_empty();
        // A name that the skeleton does not have is an error of the map, not for others to mend.
        is_named.then(|| found(&GString::from(&name)))
    });
    let with = |others: &[Option<i32>; JOINT_COUNT]| {
        let mut bones = mapped.map(Option::flatten);
        for joint in Joint::ALL {
            let (index, other) = (joint.index(), others[joint.index()]);
            if mapped[index].is_none() && other.is_some() && !bones.contains(&other) {
                bones[index] = other;
            }
        }
        bones
    };
    let named = with(&Joint::ALL.map(|joint| found(&GString::from(joint.name()))));
    if missing(&named).is_empty() {
        return Ok(named);
    }
    let rig = rig_of(skeleton);
    let Recognition {
        family,
        placement,
        doubts,
    } = recognise(&rig);
    let mut joints = placement.joints;
    if arms_hang_from_neck(&rig, &placement) {
        joints[Joint::Neck.index()] = None;
    }
    let bones = with(&joints.map(|bone| bone.and_then(|bone| i32::try_from(bone).ok())));
    let missing = missing(&bones);
    if missing.is_empty() {
        return Ok(bones);
    }
    let doubts = doubts.iter().map(|doubt| doubt.describe(&rig));
    let told: Vec<String> = std::iter::once(String::new()).chain(doubts).collect();
    Err(MissingBones {
        joints: missing.join(", "),
        family,
        doubts: told.join("; "),
    })
}

/// Gives a bone map without a profile the humanoid one, so that the inspector shows what there is to fill in.
pub(crate) fn complete(bone_map: Option<&Gd<BoneMap>>) {
    if let Some(bone_map) = bone_map
        && Engine::singleton().is_editor_hint()
        && bone_map.get_profile().is_none()
    {
        bone_map
            .clone()
            .set_profile(&SkeletonProfileHumanoid::new_gd());
    }
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
            "{NEXT}: there is none in this scene. Add a character with a skeleton, such as an imported glTF file."
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
        "{NEXT}: {opened}drag it onto {named}. A character that was imported anew may have another name for its skeleton."
    ))
}

/// Returns whether the neck carries the arms, as in 3ds Max's Biped: then it is a part of the trunk, for a neck that turns must not turn them.
fn arms_hang_from_neck(rig: &Rig, placement: &Placement) -> bool {
    let neck = placement.joint(Joint::Neck);
    let arms = [Joint::LeftUpperArm, Joint::RightUpperArm].map(|arm| placement.joint(arm));
    neck.is_some_and(|neck| {
        arms.into_iter()
            .flatten()
            .any(|arm| rig.is_below(arm, neck))
    })
}

/// Required joints without a bone, by name.
fn missing(bones: &[Option<i32>; JOINT_COUNT]) -> Vec<&'static str> {
    let needed = Joint::ALL.into_iter().filter(|joint| !is_optional(*joint));
    needed
        .filter(|joint| bones[joint.index()].is_none())
        .map(Joint::name)
        .collect()
}

fn rig_of(skeleton: &Gd<Skeleton3D>) -> Rig {
    Rig::new((0..skeleton.get_bone_count()).map(|bone| {
        let parent = usize::try_from(skeleton.get_bone_parent(bone)).ok();
        (skeleton.get_bone_name(bone).to_string(), parent)
    }))
}
