//! The editor's half of the add-on. Godot starts it by itself as soon as the library is loaded.

use crate::import_plugin::FootfallImportPlugin;
use godot::classes::{EditorPlugin, IEditorPlugin};
use godot::prelude::*;

/// Teaches the editor to import `.footfall` files.
#[derive(GodotClass)]
#[class(tool, init, internal, base = EditorPlugin)]
struct FootfallEditorPlugin {
    importer: Option<Gd<FootfallImportPlugin>>,
    base: Base<EditorPlugin>,
}

#[godot_api]
impl IEditorPlugin for FootfallEditorPlugin {
    fn enter_tree(&mut self) {
        let importer = FootfallImportPlugin::new_gd();
        self.base_mut().add_import_plugin(&importer);
        self.importer = Some(importer);
    }

    fn exit_tree(&mut self) {
        if let Some(importer) = self.importer.take() {
            self.base_mut().remove_import_plugin(&importer);
        }
    }
}
