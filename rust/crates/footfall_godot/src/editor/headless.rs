//! Keeps headless editors from crashing as they quit, an error of the engine: godotengine/godot#111048.
//!
//! An editor that meets an extension for the first time makes its class reference anew, on a thread whose last act is to call the main
//! thread. A headless editor has imported or exported by then, and deleted the reference: the call ends it with exit code 134, when all is
//! done. It needs no class reference.

use godot::classes::{DisplayServer, GDExtensionManager};
use godot::init::is_singleton_available;
use godot::prelude::*;

/// Signal of the engine after extensions were added.
const ADDED: &str = "extensions_reloaded";

/// Keeps a headless editor from making its class reference anew for the extension that is being loaded.
pub(crate) fn skip_class_reference() {
    // An editor that knew the extension before it started has no display yet, and makes its reference once.
    if !is_singleton_available::<DisplayServer>()
        || DisplayServer::singleton().get_name() != "headless"
    {
        return;
    }
    let mut extensions = GDExtensionManager::singleton();
    for connection in extensions.get_signal_connection_list(ADDED).iter_shared() {
        let Some(callable) = connection
            .get("callable")
            .and_then(|callable| callable.try_to::<Callable>().ok())
        else {
            continue;
        };
        let is_editor = |object: Gd<Object>| object.get_class() == "EditorNode";
        if callable.object().is_some_and(is_editor) {
            extensions.disconnect(ADDED, &callable);
        }
    }
}
