//! Problems of a node, reported to its developer.

use godot::classes::{Engine, SkeletonModifier3D};
use godot::prelude::*;

/// Warns in the log of a game. The editor shows problems at the node instead, where they are asked for anew.
pub(crate) fn tell(node: &Gd<SkeletonModifier3D>, problem: &str) {
    let mut node = node.clone();
    if Engine::singleton().is_editor_hint() {
        node.update_configuration_warnings();
    } else {
        let path = node.get_path();
        godot_warn!("{path}: {problem}");
    }
}
