//! Plugin that Godot starts by itself as soon as the library is loaded in the editor.

use super::installation;
use super::leftovers::{self, FootfallExportPlugin};
use super::preview_bar::FootfallPreviewInspector;
use super::style_dock::FootfallStyleDock;
use super::walk_gizmo::FootfallWalkGizmo;
use crate::gait_model::GaitModel;
use crate::shipped::{self, Shipped as _};
use godot::classes::{EditorFileSystem, EditorInterface, EditorPlugin, IEditorPlugin};
use godot::prelude::*;

/// Signal of the file system after it has looked through the project.
const SCANNED: &str = "filesystem_changed";

/// Brings the editor its dock, gizmos and preview bar, and has it look at a project in which the add-on is new.
#[derive(GodotClass)]
#[class(tool, init, internal, base = EditorPlugin)]
struct FootfallEditorPlugin {
    tools: Option<Tools>,
    base: Base<EditorPlugin>,
}

/// Tools that the plugin adds.
struct Tools {
    dock: Gd<FootfallStyleDock>,
    gizmo: Gd<FootfallWalkGizmo>,
    inspector: Gd<FootfallPreviewInspector>,
    export: Gd<FootfallExportPlugin>,
}

#[godot_api]
impl IEditorPlugin for FootfallEditorPlugin {
    fn enter_tree(&mut self) {
        let tools = Tools {
            dock: FootfallStyleDock::titled(),
            gizmo: FootfallWalkGizmo::with_materials(),
            inspector: FootfallPreviewInspector::new_gd(),
            export: FootfallExportPlugin::new_gd(),
        };
        let mut plugin = self.base_mut();
        plugin.add_dock(&tools.dock);
        plugin.add_node_3d_gizmo_plugin(&tools.gizmo);
        plugin.add_inspector_plugin(&tools.inspector);
        plugin.add_export_plugin(&tools.export);
        drop(plugin);
        self.tools = Some(tools);
        if let Some(mut files) = file_system() {
            files.connect(SCANNED, &self.base().callable("look_at_project"));
        }
    }

    /// Until the editor has come to rest after the add-on was loaded.
    fn process(&mut self, _delta: f64) {
        let Some(mut files) = file_system().filter(|files| !files.is_scanning()) else {
            return;
        };
        self.base_mut().set_process(false);
        installation::check();
        // An editor that ran when the add-on was unzipped went through the project before it knew the library: our files were nothing to it.
        if files
            .get_file_type(&shipped::path(GaitModel::FILE))
            .is_empty()
        {
            files.scan();
        }
    }

    fn exit_tree(&mut self) {
        self.stop_looking();
        if let Some(tools) = self.tools.take() {
            let mut plugin = self.base_mut();
            plugin.remove_dock(&tools.dock);
            plugin.remove_node_3d_gizmo_plugin(&tools.gizmo);
            plugin.remove_inspector_plugin(&tools.inspector);
            plugin.remove_export_plugin(&tools.export);
            tools.dock.free();
        }
    }
}

#[godot_api]
impl FootfallEditorPlugin {
    /// Comes once, when the editor has gone through the project.
    #[func]
    fn look_at_project(&mut self) {
        self.stop_looking();
        leftovers::remove();
    }
}

impl FootfallEditorPlugin {
    fn stop_looking(&mut self) {
        let callable = self.base().callable("look_at_project");
        if let Some(mut files) = file_system()
            && files.is_connected(SCANNED, &callable)
        {
            files.disconnect(SCANNED, &callable);
        }
    }
}

fn file_system() -> Option<Gd<EditorFileSystem>> {
    EditorInterface::singleton().get_resource_filesystem()
}
