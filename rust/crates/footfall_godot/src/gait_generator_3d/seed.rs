//! The walk of a node that was given none: seed 0 stands for one of its own.

use super::GaitGenerator3D;
use footfall_core::hash::fnv1a;
use godot::prelude::*;

impl GaitGenerator3D {
    /// The seed of the walk that goes on or would begin.
    pub(super) fn effective_seed(&self) -> u64 {
        match (&self.session, self.seed) {
            (Some(session), _) => session.generator.seed(),
            (None, 0) => self.own_seed(),
            (None, seed) => seed.cast_unsigned(),
        }
    }

    /// A seed from the node's place in its scene: the same whenever the scene is run, and another for every node.
    pub(super) fn own_seed(&self) -> u64 {
        // 0 means that the node has no seed of its own.
        fnv1a(self.place_in_scene().bytes()).max(1)
    }

    /// Phase of the stride, 0 to 1, at which a node with a seed of its own begins.
    pub(super) fn own_phase(&self) -> f32 {
        // The high bits of the product are mixed best.
        let mixed = self.own_seed().wrapping_mul(0x9e37_79b9_7f4a_7c15);
        (mixed >> 40) as f32 / (1 << 24) as f32
    }

    /// The path from the root of the running or edited scene; from the tree's root for a node outside of it.
    ///
    /// Path of the node in its scene. The index among the children stands for a name that the engine made up, which differs whenever a scene is run.
    fn place_in_scene(&self) -> String {
        let mut node = self.base().clone().upcast::<Node>();
        let stage: Vec<Gd<Node>> = if node.is_inside_tree() {
            let tree = node.get_tree();
            [tree.get_current_scene(), tree.get_edited_scene_root()]
                .into_iter()
                .flatten()
                .collect()
        } else {
            Vec::new()
        };
        let mut path = String::new();
        while !stage.contains(&node) {
            let name = node.get_name().to_string();
            let place = if name.starts_with('@') {
                format!("{}#{}", node.get_class(), node.get_index())
            } else {
                name
            };
            path.push('/');
            path.push_str(&place);
            let Some(parent) = node.get_parent() else {
                break;
            };
            node = parent;
        }
        path
    }
}
