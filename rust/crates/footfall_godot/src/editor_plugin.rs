//! The editor's half of the add-on. Godot starts it by itself as soon as the library is loaded.

use crate::import_plugin::{FootfallImportPlugin, Kind};
use godot::classes::{EditorPlugin, IEditorPlugin};
use godot::prelude::*;

/// Teaches the editor to import `.footfall`, `.footstyle` and `.footimu` files.
#[derive(GodotClass)]
#[class(tool, init, internal, base = EditorPlugin)]
struct FootfallEditorPlugin {
    importers: Vec<Gd<FootfallImportPlugin>>,
    base: Base<EditorPlugin>,
}

#[godot_api]
impl IEditorPlugin for FootfallEditorPlugin {
    fn enter_tree(&mut self) {
        for kind in [Kind::Model, Kind::Style, Kind::Imu] {
            let importer = FootfallImportPlugin::of(kind);
            self.base_mut().add_import_plugin(&importer);
            self.importers.push(importer);
        }
    }

    fn exit_tree(&mut self) {
        for importer in core::mem::take(&mut self.importers) {
            self.base_mut().remove_import_plugin(&importer);
        }
    }
}
