//! `ImuModel`: what sensors on a body mean, as a Godot resource.

use crate::loaded::Loaded;
use footfall_model::ImuModel as TrainedModel;
use footfall_recon::Prepared;
use godot::classes::{IResource, Resource};
use godot::prelude::*;
use std::sync::Arc;

/// Warning where there is no model.
pub(crate) const NO_MODEL: &str = "No sensor model, and the add-on's own, models/right_foot.footimu, is gone. Load a .footimu file into Model.";

/// Knows what one or two inertial sensors on a body mean for the whole body (`.footimu`, made by `footfall imu train`).
///
/// The file in the project is this resource, as it is. Give it to an `ImuReconstructor3D`'s `model`. One model serves any number of
/// characters.
#[derive(GodotClass)]
#[class(tool, init, base = Resource)]
pub(crate) struct ImuModel {
    /// The bytes of the `.footimu` file.
    ///
    /// Plain bytes, so that a scene or `.res` file that holds the resource needs nothing but built-in storage.
    #[var(set = set_data, usage_flags = [STORAGE])]
    data: PackedByteArray,

    /// Sensors that the model is for and recordings that it was trained on, or the fault of its file.
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
    /// Makes a model from the bytes of a `.footimu` file, for example one that the game downloaded.
    ///
    /// Ask `get_error()` whether the bytes were a model.
    #[func]
    fn from_bytes(bytes: PackedByteArray) -> Gd<Self> {
        let mut model = Self::new_gd();
        model.bind_mut().set_data(bytes);
        model
    }

    /// Replaces the model by the one in these bytes of a `.footimu` file.
    #[func]
    pub(crate) fn set_data(&mut self, data: PackedByteArray) {
        self.loaded = Loaded::read(&data, |bytes| {
            let model = TrainedModel::from_bytes(bytes).map_err(|error| error.to_string())?;
            Prepared::new(Arc::new(model)).map_err(|error| error.to_string())
        });
        self.data = data;
        self.base_mut().emit_changed();
    }

    /// Sensors that the model is for and recordings that it was trained on, or the fault of its file.
    #[func]
    fn get_description(&self) -> GString {
        self.loaded.describe(|prepared| describe(prepared.model()))
    }

    /// Problem of the model's file, with the next thing to do; empty without one.
    #[func]
    fn get_error(&self) -> GString {
        self.prepared()
            .map_or_else(|error| GString::from(&error), |_| GString::new())
    }

    /// Sites of the sensors, in order: for example `right_foot`. Empty for a broken model.
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

impl ImuModel {
    /// Returns whether it was made by *New* and holds nothing yet.
    pub(crate) fn is_new(&self) -> bool {
        self.data.is_empty()
    }

    /// The model, laid out, shared with every character that it drives.
    ///
    /// # Errors
    /// Text for the user that says what is wrong with the file.
    pub(crate) fn prepared(&self) -> Result<Arc<Prepared>, String> {
        self.loaded
            .content("the sensor model is empty: load a .footimu file in its place")
    }
}

/// The model in words, for the inspector.
fn describe(model: &TrainedModel) -> String {
    let from = &model.provenance;
    let sites: Vec<&str> = model.sites.iter().map(|site| site.name()).collect();
    format!(
        "{}: {} frames of {} people in {} recordings, at {} frames a second.\nCorpus: {}\nTerms: {}\nMade by: {}",
        sites.join(" and "),
        model.frame_count(),
        from.subjects,
        from.clips,
        model.frame_rate_hz,
        from.corpus,
        from.terms,
        from.command
    )
}
