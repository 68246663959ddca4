//! Problems of a node, reported to its developer.

use godot::classes::Engine;
use godot::prelude::*;

/// Warns in the log of a game. The editor shows problems at the node instead, where it asks for them again.
pub(crate) fn warn(node: &Gd<Node>, problem: &str) {
    let mut node = node.clone();
    if Engine::singleton().is_editor_hint() {
        node.update_configuration_warnings();
    } else {
        let path = node.get_path();
        godot_warn!("{path}: {problem}");
    }
}
