//! Choice of the node that travels when a character walks.

use godot::classes::Skeleton3D;
use godot::prelude::*;

/// Finds the node that travels.
///
/// It is the one that `path` names, seen from `node`. Without a path it is the nearest `CharacterBody3D` above the skeleton;
/// failing that the root of the scene that the skeleton came in, for an imported character its top node. The root of the
/// running or edited scene is passed over while there is a node between it and the skeleton: that root is a level, not a character.
///
/// # Errors
/// Property to set, when there is no such `Node3D` above the skeleton.
pub(crate) fn find(
    node: &Gd<Node>,
    skeleton: &Gd<Skeleton3D>,
    path: &NodePath,
) -> Result<Gd<Node3D>, String> {
    if !path.is_empty() {
        return named(node, skeleton, path);
    }
    let ancestors = ancestors(skeleton);
    if let Some(body) = ancestors
        .iter()
        .find(|ancestor| ancestor.is_class("CharacterBody3D"))
    {
        return Ok(body.clone());
    }
    let stage = stage(skeleton);
    let owner = skeleton.get_owner();
    let reach = ancestors
        .iter()
        .position(|ancestor| owner.as_ref() == Some(&ancestor.clone().upcast::<Node>()))
        .unwrap_or(0);
    ancestors
        .iter()
        .take(reach + 1)
        .rev()
        .find(|ancestor| !stage.contains(&ancestor.instance_id()))
        .or(ancestors.first())
        .cloned()
        .ok_or_else(|| {
            "No Node3D above the Skeleton3D can travel. Put the skeleton under a Node3D, or turn Root Motion off."
                .to_owned()
        })
}

/// Finds the body of the physics that a character is in: itself or the nearest `CharacterBody3D` above it; the character itself without one.
pub(crate) fn carrier(character: &Gd<Node3D>) -> Gd<Node3D> {
    let mut node = Some(character.clone());
    while let Some(candidate) = node {
        if candidate.is_class("CharacterBody3D") {
            return candidate;
        }
        node = candidate.get_parent_node_3d();
    }
    character.clone()
}

fn named(
    node: &Gd<Node>,
    skeleton: &Gd<Skeleton3D>,
    path: &NodePath,
) -> Result<Gd<Node3D>, String> {
    let found = node
        .get_node_or_null(path)
        .and_then(|found| found.try_cast::<Node3D>().ok())
        .ok_or_else(|| {
            format!("Character is set to {path}, which is not a Node3D. Choose a Node3D above the Skeleton3D.")
        })?;
    if found.clone().upcast::<Node>() == skeleton.clone().upcast::<Node>()
        || found.is_ancestor_of(skeleton)
    {
        Ok(found)
    } else {
        Err(format!(
            "Character is set to {path}, which does not contain the Skeleton3D. Choose a Node3D above the Skeleton3D."
        ))
    }
}

/// Every `Node3D` above the skeleton without a gap, nearest first.
fn ancestors(skeleton: &Gd<Skeleton3D>) -> Vec<Gd<Node3D>> {
    let mut ancestors = Vec::new();
    let mut parent = skeleton.get_parent_node_3d();
    while let Some(ancestor) = parent {
        parent = ancestor.get_parent_node_3d();
        ancestors.push(ancestor);
    }
    ancestors
}

/// The roots of the running and of the edited scene.
fn stage(skeleton: &Gd<Skeleton3D>) -> Vec<InstanceId> {
    if !skeleton.is_inside_tree() {
        return Vec::new();
    }
    let tree = skeleton.get_tree();
    [tree.get_current_scene(), tree.get_edited_scene_root()]
        .into_iter()
        .flatten()
        .map(|root| root.instance_id())
        .collect()
}
