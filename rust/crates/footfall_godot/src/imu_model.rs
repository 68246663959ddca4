//! `ImuModel`: a sensor model as a Godot resource.

use crate::loaded::{Loaded, sources};
use crate::shipped::Shipped;
use footfall_model::ImuModel as TrainedModel;
use footfall_recon::Prepared;
use godot::classes::{IResource, Resource};
use godot::prelude::*;
use std::sync::Arc;

/// Problem of a resource without a file.
const EMPTY: &str = "the sensor model is empty. Load a .footimu file instead";

/// Sensor model that maps one or two inertial sensors on a body to the whole body (`.footimu`, made by `footfall imu train`).
///
/// Godot loads the file as this resource, without import. Set it as the `model` of an `ImuReconstructor3D`. One model serves any number of
/// characters.
#[derive(GodotClass)]
#[class(tool, init, base = Resource)]
pub(crate) struct ImuModel {
    /// Bytes of the `.footimu` file.
    ///
    /// Plain bytes, so that a scene or `.res` file with this resource needs built-in storage only.
    #[var(set = set_data, usage_flags = [STORAGE])]
    data: PackedByteArray,

    /// Sensors of the model and its training recordings, or the problem of its file.
    #[var(get = get_description, no_set, usage_flags = [EDITOR, READ_ONLY], hint = MULTILINE_TEXT)]
    description: PhantomVar<GString>,

    /// The model in `data`, laid out, or why there is none.
    loaded: Loaded<Prepared>,
    base: Base<Resource>,
}

#[godot_api]
impl IResource for ImuModel {}

#[godot_api]
impl ImuModel {
    /// Creates a model from the bytes of a `.footimu` file, for example a downloaded one.
    ///
    /// `get_error()` returns a problem if the bytes are not a model.
    #[func]
    fn from_bytes(bytes: PackedByteArray) -> Gd<Self> {
        let mut model = Self::new_gd();
        model.bind_mut().set_data(bytes);
        model
    }

    /// Replaces the model by the content of a `.footimu` file.
    #[func]
    pub(crate) fn set_data(&mut self, data: PackedByteArray) {
        self.loaded = Loaded::read(&data, |bytes| {
            let model = TrainedModel::from_bytes(bytes).map_err(|error| error.to_string())?;
            Prepared::new(Arc::new(model)).map_err(|error| error.to_string())
        });
        self.data = data;
        self.base_mut().emit_changed();
    }

    /// Sensors of the model and its training recordings, or the problem of its file.
    #[func]
    fn get_description(&self) -> GString {
        self.loaded.describe(|prepared| describe(prepared.model()))
    }

    /// Returns the problem of the model's file, with what to do next; empty if there is none.
    #[func]
    fn get_error(&self) -> GString {
        self.loaded.error(EMPTY)
    }

    /// Returns the sites of the sensors, in order, for example `right_foot`. Empty for an invalid model.
    #[func]
    fn get_sites(&self) -> PackedStringArray {
        let sites = self
            .prepared()
            .map(|prepared| prepared.model().sites.clone());
        let names = sites.unwrap_or_default();
        names
            .iter()
            .map(|site| GString::from(site.name()))
            .collect()
    }
}

impl Shipped for ImuModel {
    const FILE: &'static str = "right_foot.footimu";
    const MISSING: &'static str = "There is no sensor model, and the add-on's own, models/right_foot.footimu, is missing. Unzip the add-on again, or load a .footimu file into Model.";

    fn is_new(&self) -> bool {
        self.data.is_empty()
    }
}

impl ImuModel {
    /// The model, laid out, shared with every character that it drives.
    ///
    /// # Errors
    /// Text for the user that says what is wrong with the file.
    pub(crate) fn prepared(&self) -> Result<Arc<Prepared>, String> {
        self.loaded.content(EMPTY)
    }
}

/// The model in words, for the inspector.
fn describe(model: &TrainedModel) -> String {
    let from = &model.provenance;
    let sites: Vec<&str> = model.sites.iter().map(|site| site.name()).collect();
    format!(
        "{}: {} frames of {} people in {} recordings, at {} frames a second.\n{}",
        sites.join(" and "),
        model.frame_count(),
        from.subjects,
        from.clips,
        model.frame_rate_hz,
        sources(from)
    )
}
