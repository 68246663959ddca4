//! Imports `.footfall` files as [`GaitModel`] resources.

use crate::gait_model::GaitModel;
use footfall_model::GaitModel as TrainedModel;
use godot::classes::{
    EditorImportPlugin, FileAccess, IEditorImportPlugin, ResourceSaver, resource_saver::SaverFlags,
};
use godot::global::Error;
use godot::prelude::*;

/// Imports `.footfall` files as `GaitModel`.
#[derive(GodotClass)]
#[class(tool, init, internal, base = EditorImportPlugin)]
pub(crate) struct FootfallImportPlugin {
    base: Base<EditorImportPlugin>,
}

/// The engine asks for all twelve of these, whatever the API calls required.
#[godot_api]
impl IEditorImportPlugin for FootfallImportPlugin {
    fn get_importer_name(&self) -> GString {
        "footfall.gait_model".into()
    }

    fn get_visible_name(&self) -> GString {
        "Gait Model".into()
    }

    fn get_preset_count(&self) -> i32 {
        1
    }

    fn get_preset_name(&self, _preset_index: i32) -> GString {
        "Default".into()
    }

    fn get_recognized_extensions(&self) -> PackedStringArray {
        PackedStringArray::from(&["footfall".into()])
    }

    fn get_import_options(&self, _path: GString, _preset_index: i32) -> Array<AnyDictionary> {
        Array::new()
    }

    fn get_option_visibility(
        &self,
        _path: GString,
        _option_name: StringName,
        _options: VarDictionary,
    ) -> bool {
        true
    }

    fn get_save_extension(&self) -> GString {
        "res".into()
    }

    fn get_resource_type(&self) -> GString {
        "GaitModel".into()
    }

    fn get_priority(&self) -> f32 {
        1.0
    }

    fn get_import_order(&self) -> i32 {
        0
    }

    fn get_format_version(&self) -> i32 {
        1
    }

    fn can_import_threaded(&self) -> bool {
        // Models are small; one after the other costs nothing and needs no thought.
        false
    }

    fn import(
        &mut self,
        source_file: GString,
        save_path: GString,
        _options: VarDictionary,
        _platform_variants: Array<GString>,
        _gen_files: Array<GString>,
    ) -> Error {
        match import(&source_file, &save_path) {
            Ok(()) => Error::OK,
            Err((code, reason)) => {
                godot_error!("{source_file}: {reason}");
                code
            }
        }
    }
}

fn import(source_file: &GString, save_path: &GString) -> Result<(), (Error, String)> {
    let bytes = FileAccess::get_file_as_bytes(source_file);
    let opened = FileAccess::get_open_error();
    if opened != Error::OK {
        return Err((opened, "cannot be read".to_owned()));
    }
    // Checked here, so that a damaged file stops at the import and not in the game.
    TrainedModel::from_bytes(bytes.as_slice())
        .map_err(|error| (Error::ERR_FILE_CORRUPT, error.to_string()))?;
    let mut model = GaitModel::new_gd();
    model.bind_mut().set_data(bytes);
    let path = format!("{save_path}.res");
    match ResourceSaver::singleton()
        .save_ex(&model)
        .path(&path)
        .flags(SaverFlags::COMPRESS)
        .done()
    {
        Error::OK => Ok(()),
        code => Err((code, format!("cannot write {path}"))),
    }
}
