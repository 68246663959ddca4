//! What Godot starts by itself as soon as the library is loaded in the editor.

use super::import_plugin::{FootfallImportPlugin, Kind};
use super::preview_bar::FootfallPreviewInspector;
use super::style_dock::FootfallStyleDock;
use super::walk_gizmo::FootfallWalkGizmo;
use godot::classes::{EditorPlugin, IEditorPlugin};
use godot::prelude::*;

/// Teaches the editor to import `.footfall`, `.footstyle` and `.footimu` files, and brings its dock, gizmos and preview bar.
#[derive(GodotClass)]
#[class(tool, init, internal, base = EditorPlugin)]
struct FootfallEditorPlugin {
    importers: Vec<Gd<FootfallImportPlugin>>,
    tools: Option<Tools>,
    base: Base<EditorPlugin>,
}

/// What the plugin adds besides importers.
struct Tools {
    dock: Gd<FootfallStyleDock>,
    gizmo: Gd<FootfallWalkGizmo>,
    inspector: Gd<FootfallPreviewInspector>,
}

#[godot_api]
impl IEditorPlugin for FootfallEditorPlugin {
    fn enter_tree(&mut self) {
        for kind in [Kind::Model, Kind::Style, Kind::Imu] {
            let importer = FootfallImportPlugin::of(kind);
            self.base_mut().add_import_plugin(&importer);
            self.importers.push(importer);
        }
        let tools = Tools {
            dock: FootfallStyleDock::titled(),
            gizmo: FootfallWalkGizmo::with_materials(),
            inspector: FootfallPreviewInspector::new_gd(),
        };
        let mut plugin = self.base_mut();
        plugin.add_dock(&tools.dock);
        plugin.add_node_3d_gizmo_plugin(&tools.gizmo);
        plugin.add_inspector_plugin(&tools.inspector);
        drop(plugin);
        self.tools = Some(tools);
    }

    fn exit_tree(&mut self) {
        for importer in core::mem::take(&mut self.importers) {
            self.base_mut().remove_import_plugin(&importer);
        }
        if let Some(tools) = self.tools.take() {
            let mut plugin = self.base_mut();
            plugin.remove_dock(&tools.dock);
            plugin.remove_node_3d_gizmo_plugin(&tools.gizmo);
            plugin.remove_inspector_plugin(&tools.inspector);
            tools.dock.free();
        }
    }
}
