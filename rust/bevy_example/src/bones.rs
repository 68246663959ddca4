//! Entities of a glTF scene as the bones of a rig.

use crate::walker::Walker;
use bevy::ecs::system::SystemParam;
use bevy::prelude::*;
use footfall::glam::{Affine3A, Quat, Vec3};
use footfall::rig::{Bones, RestRig};

/// Nodes of all scenes: a transform, the node above, and a name.
#[derive(SystemParam)]
pub(crate) struct Nodes<'w, 's> {
    children: Query<'w, 's, &'static Children>,
    nodes: Query<'w, 's, (&'static Transform, &'static ChildOf, Option<&'static Name>)>,
}

impl Nodes<'_, '_> {
    /// The nodes below a character as bones at rest, and the entity of each. Their names decide later which of them are joints.
    pub(crate) fn at_rest(&self, character: Entity) -> (RestRig, Vec<Entity>) {
        let below = self.children.iter_descendants(character);
        let entities: Vec<Entity> = below
            .filter(|entity| self.nodes.contains(*entity))
            .collect();
        let nodes = self.nodes.iter_many(&entities);
        let rig = RestRig::new(nodes.map(|(transform, above, name)| {
            let above = entities.iter().position(|entity| *entity == above.parent());
            let name = name.map_or_else(String::new, |name| name.as_str().to_owned());
            (name, above, transform.compute_affine())
        }));
        (rig, entities)
    }
}

/// Transforms of all that a walker may pose.
pub(crate) type Transforms<'w, 's> = Query<'w, 's, &'static mut Transform, Without<Walker>>;

/// Bones of one walker, for the library to read and write.
pub(crate) struct Posed<'a, 'w, 's> {
    pub(crate) entities: &'a [Entity],
    pub(crate) transforms: &'a mut Transforms<'w, 's>,
}

impl Posed<'_, '_, '_> {
    /// The transform of a bone. One that the game has taken away counts as unmoved.
    fn get(&self, bone: usize) -> Transform {
        let transform = self.transforms.get(self.entities[bone]);
        transform.copied().unwrap_or_default()
    }

    fn set(&mut self, bone: usize, change: impl FnOnce(&mut Transform)) {
        if let Ok(mut transform) = self.transforms.get_mut(self.entities[bone]) {
            change(&mut transform);
        }
    }
}

impl Bones for Posed<'_, '_, '_> {
    fn transform(&self, bone: usize) -> Affine3A {
        self.get(bone).compute_affine()
    }

    fn rotation(&self, bone: usize) -> Quat {
        self.get(bone).rotation
    }

    fn position(&self, bone: usize) -> Vec3 {
        self.get(bone).translation
    }

    fn set_rotation(&mut self, bone: usize, rotation: Quat) {
        self.set(bone, |transform| transform.rotation = rotation);
    }

    fn set_position(&mut self, bone: usize, position: Vec3) {
        self.set(bone, |transform| transform.translation = position);
    }
}
