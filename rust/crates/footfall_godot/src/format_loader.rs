//! Loads `.footfall`, `.footdyn`, `.footstyle` and `.footimu` files as they are, in the editor and in games: there is nothing to import.

use crate::gait_model::GaitModel;
use crate::gait_style::GaitStyle;
use crate::imu_model::ImuModel;
use godot::classes::{
    FileAccess, IResourceFormatLoader, Resource, ResourceFormatLoader, ResourceLoader,
};
use godot::global::Error;
use godot::prelude::*;
use std::sync::atomic::{AtomicI64, Ordering};

/// Resources that files become.
#[derive(Clone, Copy, Debug, Default)]
enum Kind {
    #[default]
    Model,
    Style,
    Imu,
}

impl Kind {
    const ALL: [Self; 3] = [Self::Model, Self::Style, Self::Imu];

    /// The resource's class.
    fn class(self) -> &'static str {
        match self {
            Self::Model => "GaitModel",
            Self::Style => "GaitStyle",
            Self::Imu => "ImuModel",
        }
    }

    /// Extensions of such files.
    fn extensions(self) -> &'static [&'static str] {
        match self {
            Self::Model => &["footfall", "footdyn"],
            Self::Style => &["footstyle"],
            Self::Imu => &["footimu"],
        }
    }

    /// The resource of a file's bytes, and what is wrong with them.
    fn resource(self, bytes: PackedByteArray) -> (Gd<Resource>, Option<String>) {
        match self {
            Self::Model => {
                let mut model = GaitModel::new_gd();
                model.bind_mut().set_data(bytes);
                let problem = model.bind().trained().err();
                (model.upcast(), problem)
            }
            Self::Style => {
                let mut style = GaitStyle::new_gd();
                style.bind_mut().set_data(bytes);
                let problem = style.bind().trained().err();
                (style.upcast(), problem)
            }
            Self::Imu => {
                let mut model = ImuModel::new_gd();
                model.bind_mut().set_data(bytes);
                let problem = model.bind().prepared().err();
                (model.upcast(), problem)
            }
        }
    }
}

/// Loads the files of one kind. Paths get their UIDs from `.uid` files, which the editor writes for loaders that name none.
#[derive(GodotClass)]
#[class(tool, init, internal, base = ResourceFormatLoader)]
struct FootfallFormatLoader {
    kind: Kind,
    base: Base<ResourceFormatLoader>,
}

#[godot_api]
impl IResourceFormatLoader for FootfallFormatLoader {
    fn get_recognized_extensions(&self) -> PackedStringArray {
        let extensions = self.kind.extensions().iter();
        extensions.map(|name| GString::from(*name)).collect()
    }

    fn handles_type(&self, type_: StringName) -> bool {
        type_ == self.kind.class() || type_ == "Resource"
    }

    fn get_resource_type(&self, path: GString) -> GString {
        let extension = path.get_extension().to_lower().to_string();
        if self.kind.extensions().contains(&extension.as_str()) {
            self.kind.class().into()
        } else {
            GString::new()
        }
    }

    fn load(
        &self,
        path: GString,
        _original_path: GString,
        _use_sub_threads: bool,
        _cache_mode: i32,
    ) -> Variant {
        let bytes = FileAccess::get_file_as_bytes(&path);
        let opened = FileAccess::get_open_error();
        if opened != Error::OK {
            return opened.to_variant();
        }
        let (resource, problem) = self.kind.resource(bytes);
        if let Some(problem) = problem {
            // Loaded all the same: a scene that refers to a damaged file opens, and its nodes say what is wrong.
            godot_error!("{path}: {problem}");
        }
        resource.to_variant()
    }
}

/// The loaders that the engine has from us, by instance; 0 where there is none.
///
/// Only their numbers: when the library is loaded anew, what Rust knows of its objects is gone before they are taken back.
static REGISTERED: [AtomicI64; Kind::ALL.len()] = [const { AtomicI64::new(0) }; Kind::ALL.len()];

/// Registers the loader of Footfall's files.
///
/// Before all other loaders, so that no `.import` file of the days when they were imported stands before the file itself.
pub(crate) fn register() {
    for (kind, registered) in Kind::ALL.into_iter().zip(&REGISTERED) {
        let loader = Gd::from_init_fn(|base| FootfallFormatLoader { kind, base });
        ResourceLoader::singleton()
            .add_resource_format_loader_ex(&loader)
            .at_front(true)
            .done();
        registered.store(loader.instance_id().to_i64(), Ordering::Relaxed);
    }
}

/// Takes the loaders back before the library goes.
pub(crate) fn unregister() {
    for registered in &REGISTERED {
        let id = InstanceId::try_from_i64(registered.swap(0, Ordering::Relaxed));
        let loader: Option<Gd<ResourceFormatLoader>> =
            id.and_then(|id| Gd::try_from_instance_id(id).ok());
        if let Some(loader) = loader {
            ResourceLoader::singleton().remove_resource_format_loader(&loader);
        }
    }
}
