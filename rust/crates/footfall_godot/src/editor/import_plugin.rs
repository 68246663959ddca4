//! Imports `.footfall` and `.footdyn` files as [`GaitModel`] resources, `.footstyle` files as [`GaitStyle`] and `.footimu` files as [`ImuModel`].

use crate::gait_model::GaitModel;
use crate::gait_style::GaitStyle;
use crate::imu_model::ImuModel;
use footfall_model::{GaitStyle as TrainedStyle, ImuModel as TrainedImuModel, WalkModel};
use godot::classes::{
    EditorImportPlugin, FileAccess, IEditorImportPlugin, Resource, ResourceSaver,
    resource_saver::SaverFlags,
};
use godot::global::Error;
use godot::prelude::*;

/// What a file holds.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) enum Kind {
    #[default]
    Model,
    Style,
    Imu,
}

/// Imports `.footfall` and `.footdyn` files as `GaitModel`, `.footstyle` files as `GaitStyle`, or `.footimu` files as `ImuModel`.
#[derive(GodotClass)]
#[class(tool, init, internal, base = EditorImportPlugin)]
pub(crate) struct FootfallImportPlugin {
    kind: Kind,
    base: Base<EditorImportPlugin>,
}

impl FootfallImportPlugin {
    /// The importer of one kind of files.
    pub(crate) fn of(kind: Kind) -> Gd<Self> {
        Gd::from_init_fn(|base| Self { kind, base })
    }

    fn by_kind<T>(&self, model: T, style: T, imu: T) -> T {
        match self.kind {
            Kind::Model => model,
            Kind::Style => style,
            Kind::Imu => imu,
        }
    }
}

/// The engine asks for all twelve of these, whatever the API calls required.
#[godot_api]
impl IEditorImportPlugin for FootfallImportPlugin {
    fn get_importer_name(&self) -> GString {
        self.by_kind(
            "footfall.gait_model",
            "footfall.gait_style",
            "footfall.imu_model",
        )
        .into()
    }

    fn get_visible_name(&self) -> GString {
        self.by_kind("Gait Model", "Gait Style", "IMU Model").into()
    }

    fn get_preset_count(&self) -> i32 {
        1
    }

    fn get_preset_name(&self, _preset_index: i32) -> GString {
        "Default".into()
    }

    fn get_recognized_extensions(&self) -> PackedStringArray {
        let extensions: &[&str] =
            self.by_kind(&["footfall", "footdyn"], &["footstyle"], &["footimu"]);
        extensions.iter().map(|name| GString::from(*name)).collect()
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
        self.by_kind("GaitModel", "GaitStyle", "ImuModel").into()
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
        match import(self.kind, &source_file, &save_path) {
            Ok(()) => Error::OK,
            Err((code, reason)) => {
                godot_error!("{source_file}: {reason}");
                code
            }
        }
    }
}

fn import(kind: Kind, source_file: &GString, save_path: &GString) -> Result<(), (Error, String)> {
    let bytes = FileAccess::get_file_as_bytes(source_file);
    let opened = FileAccess::get_open_error();
    if opened != Error::OK {
        return Err((opened, "cannot be read".to_owned()));
    }
    // Checked here, so that a damaged file stops at the import and not in the game.
    let damaged =
        |error: footfall_model::ModelFileError| (Error::ERR_FILE_CORRUPT, error.to_string());
    let resource: Gd<Resource> = match kind {
        Kind::Model => {
            WalkModel::from_bytes(bytes.as_slice()).map_err(damaged)?;
            let mut model = GaitModel::new_gd();
            model.bind_mut().set_data(bytes);
            model.upcast()
        }
        Kind::Style => {
            TrainedStyle::from_bytes(bytes.as_slice()).map_err(damaged)?;
            let mut style = GaitStyle::new_gd();
            style.bind_mut().set_data(bytes);
            style.upcast()
        }
        Kind::Imu => {
            TrainedImuModel::from_bytes(bytes.as_slice()).map_err(damaged)?;
            let mut model = ImuModel::new_gd();
            model.bind_mut().set_data(bytes);
            model.upcast()
        }
    };
    let path = format!("{save_path}.res");
    match ResourceSaver::singleton()
        .save_ex(&resource)
        .path(&path)
        .flags(SaverFlags::COMPRESS)
        .done()
    {
        Error::OK => Ok(()),
        code => Err((code, format!("cannot write {path}"))),
    }
}
