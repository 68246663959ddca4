//! The models that come with the add-on, for nodes that were given none.

use godot::classes::{Engine, GDExtensionManager, Resource, ResourceLoader};
use godot::obj::WithBaseField;
use godot::prelude::*;
use std::cell::OnceCell;

/// A kind of model of which the add-on ships one, for nodes without a `model`.
pub(crate) trait Shipped: WithBaseField + Inherits<Resource> {
    /// Name of the shipped file.
    const FILE: &'static str;
    /// Problem of a node whose add-on lacks that file, with what to do.
    const MISSING: &'static str;

    /// Returns whether it was made by *New* in the inspector and holds nothing yet.
    fn is_new(&self) -> bool;
}

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

/// Value for a node's property. In the editor the add-on's model replaces a new, empty one, which cannot be filled there: a node that is
/// added to a scene gets one, and *New* in the inspector creates one.
pub(crate) fn instead_of_new<T: Shipped>(given: Option<Gd<T>>) -> Option<Gd<T>> {
    let is_new = |model: &Gd<T>| model.bind().is_new();
    let replaced = Engine::singleton().is_editor_hint() && given.as_ref().is_some_and(is_new);
    replaced.then(|| load(T::FILE)).flatten().or(given)
}

/// The add-on's model for a node that has none of its own, loaded when it is first needed.
#[derive(Debug)]
pub(crate) struct Fallback<T: GodotClass>(OnceCell<Gd<T>>);

impl<T: GodotClass> Default for Fallback<T> {
    fn default() -> Self {
        Self(OnceCell::new())
    }
}

impl<T: Shipped> Fallback<T> {
    /// The node's own model, or else the add-on's.
    ///
    /// # Errors
    /// Text for the user when the node has none and the add-on's is missing.
    pub(crate) fn model(&self, own: Option<&Gd<T>>) -> Result<Gd<T>, String> {
        if let Some(model) = own.or(self.0.get()) {
            return Ok(model.clone());
        }
        let loaded = load(T::FILE).ok_or(T::MISSING)?;
        Ok(self.0.get_or_init(|| loaded).clone())
    }
}
