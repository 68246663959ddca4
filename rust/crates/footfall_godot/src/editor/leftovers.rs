//! Leftovers of importers of earlier versions beside models: `.import` files, which are no longer needed and which an export would follow.

use godot::classes::{
    ConfigFile, DirAccess, EditorExportPlugin, EditorFileSystemDirectory, EditorInterface,
    FileAccess, IEditorExportPlugin, Resource,
};
use godot::global::Error;
use godot::prelude::*;

/// The classes of files that were imported once.
const ONCE_IMPORTED: [&str; 3] = ["GaitModel", "GaitStyle", "ImuModel"];
/// Prefix of the names of those importers.
const IMPORTERS: &str = "footfall.";

/// Removes the `.import` files from the whole project.
pub(super) fn remove() {
    let files = EditorInterface::singleton().get_resource_filesystem();
    if let Some(root) = files.and_then(|files| files.get_filesystem()) {
        remove_in(&root);
    }
}

fn remove_in(folder: &Gd<EditorFileSystemDirectory>) {
    for index in 0..folder.get_file_count() {
        let class = folder.get_file_type(index);
        if !ONCE_IMPORTED.iter().any(|name| class == *name) {
            continue;
        }
        let file = folder.get_file_path(index);
        let import = format!("{file}.import");
        // Scenes may refer to the file by the UID that stands in there: the editor has put it into a file of its own before.
        if is_left_over(&import)
            && FileAccess::file_exists(&format!("{file}.uid"))
            && DirAccess::remove_absolute(&import) == Error::OK
        {
            godot_print!("Removed {import}: {class} files are no longer imported.");
        }
    }
    for index in 0..folder.get_subdir_count() {
        if let Some(below) = folder.get_subdir(index) {
            remove_in(&below);
        }
    }
}

fn is_left_over(import: &str) -> bool {
    if !FileAccess::file_exists(import) {
        return false;
    }
    let mut config = ConfigFile::new_gd();
    config.load(import) == Error::OK
        && config
            .get_value("remap", "importer")
            .to_string()
            .starts_with(IMPORTERS)
}

/// Removes them before an export reads them: an export on a build server begins as soon as the editor has seen the project.
#[derive(GodotClass)]
#[class(tool, init, internal, base = EditorExportPlugin)]
pub(super) struct FootfallExportPlugin {
    base: Base<EditorExportPlugin>,
}

#[godot_api]
impl IEditorExportPlugin for FootfallExportPlugin {
    fn get_name(&self) -> GString {
        "Footfall".into()
    }

    fn export_begin(
        &mut self,
        _features: PackedStringArray,
        _is_debug: bool,
        _path: GString,
        _flags: u32,
    ) {
        remove();
    }

    // The binding asks for these three; the engine does not, as long as nothing is customised.
    fn customize_resource(
        &mut self,
        _resource: Gd<Resource>,
        _path: GString,
    ) -> Option<Gd<Resource>> {
        None
    }

    fn customize_scene(&mut self, _scene: Gd<Node>, _path: GString) -> Option<Gd<Node>> {
        None
    }

    fn get_customization_configuration_hash(&self) -> u64 {
        0
    }
}
