//! The models that come with the add-on, for nodes that were given none.

use godot::classes::{Engine, GDExtensionManager, Resource, ResourceLoader};
use godot::prelude::*;
use std::cell::OnceCell;

/// The walk of nodes without a `model`.
pub(crate) const WALK: &str = "locomotion.footfall";
/// The sensor model of nodes without one.
pub(crate) const RIGHT_FOOT: &str = "right_foot.footimu";

/// End of the path of the add-on's extension file.
const EXTENSION: &str = "/footfall.gdextension";
/// Usual folder of the add-on.
const USUAL_FOLDER: &str = "res://addons/footfall";

/// Path of a shipped model.
pub(crate) fn path(name: &str) -> GString {
    GString::from(&format!("{}/models/{name}", folder()))
}

/// Folder of the add-on: that of the extension, wherever it was put.
pub(crate) fn folder() -> String {
    let extensions = GDExtensionManager::singleton().get_loaded_extensions();
    let found = extensions
        .as_slice()
        .iter()
        .map(GString::to_string)
        .find(|file| file.ends_with(EXTENSION));
    found
        .as_deref()
        .and_then(|file| file.strip_suffix(EXTENSION))
        .unwrap_or(USUAL_FOLDER)
        .to_owned()
}

/// A model, or nothing where it was removed or left out of the export.
fn load<T: Inherits<Resource>>(name: &str) -> Option<Gd<T>> {
    let path = path(name);
    let mut loader = ResourceLoader::singleton();
    if !loader.exists(&path) {
        return None;
    }
    loader.load(&path)?.try_cast().ok()
}

/// Value for a node's property. In the editor the add-on's model stands in for a new one, which nobody could fill there: that is what a
/// node gets that is added to a scene, and what *New* in the inspector gives.
pub(crate) fn instead_of_new<T: Inherits<Resource>>(
    given: Option<Gd<T>>,
    name: &str,
    is_new: impl Fn(&Gd<T>) -> bool,
) -> Option<Gd<T>> {
    let replaced = Engine::singleton().is_editor_hint() && given.as_ref().is_some_and(is_new);
    replaced.then(|| load(name)).flatten().or(given)
}

/// The add-on's model for a node that has none of its own, loaded when it is first needed.
#[derive(Debug)]
pub(crate) struct Fallback<T: GodotClass>(OnceCell<Gd<T>>);

impl<T: GodotClass> Default for Fallback<T> {
    fn default() -> Self {
        Self(OnceCell::new())
    }
}

impl<T: Inherits<Resource>> Fallback<T> {
    /// The node's own model, or else the add-on's of this name.
    pub(crate) fn model(&self, own: Option<&Gd<T>>, name: &str) -> Option<Gd<T>> {
        if own.is_some() {
            return own.cloned();
        }
        if self.0.get().is_none() {
            let loaded = load(name)?;
            return Some(self.0.get_or_init(|| loaded).clone());
        }
        self.0.get().cloned()
    }
}
