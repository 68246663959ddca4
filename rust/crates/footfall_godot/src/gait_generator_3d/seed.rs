//! The walk of a node that was given none: seed 0 stands for one of its own.

use super::GaitGenerator3D;
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
        // 0 is nobody's own.
        fnv1a(&self.place_in_scene()).max(1)
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

/// The 64-bit hash of Fowler, Noll and Vo, which never changes between versions and platforms.
fn fnv1a(text: &str) -> u64 {
    text.bytes().fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_hash_is_the_published_one() {
        assert_eq!(fnv1a(""), 0xcbf2_9ce4_8422_2325);
        assert_eq!(fnv1a("a"), 0xaf63_dc4c_8601_ec8c);
        assert_eq!(fnv1a("foobar"), 0x8594_4171_f739_67e8);
    }
}
