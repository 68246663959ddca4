//! `GaitModel`: a trained walk as a Godot resource.

use footfall_model::GaitModel as TrainedModel;
use godot::classes::{IResource, Resource};
use godot::prelude::*;
use std::sync::Arc;

/// A trained way of walking, made by `footfall train` and stored in a `.footfall` file.
///
/// Put a `.footfall` file into the project and it is imported as this resource. Give it to a `GaitGenerator3D`'s `model`.
/// One model serves any number of characters.
#[derive(GodotClass)]
#[class(tool, init, base = Resource)]
pub(crate) struct GaitModel {
    /// The bytes of the `.footfall` file.
    ///
    /// Plain bytes, so that loading the imported resource needs nothing but built-in storage.
    #[var(set = set_data, usage_flags = [STORAGE])]
    data: PackedByteArray,

    /// What the model is and what it was trained on, or what is wrong with its file.
    #[var(get = get_description, no_set, usage_flags = [EDITOR, READ_ONLY], hint = MULTILINE_TEXT)]
    description: PhantomVar<GString>,

    /// The model in `data`, or why there is none.
    trained: Option<Result<Arc<TrainedModel>, String>>,
    base: Base<Resource>,
}

#[godot_api]
impl IResource for GaitModel {}

#[godot_api]
impl GaitModel {
    /// Makes a model from the bytes of a `.footfall` file, for example one that the game downloaded.
    ///
    /// Ask `get_error()` whether the bytes were a model.
    #[func]
    fn from_bytes(bytes: PackedByteArray) -> Gd<Self> {
        let mut model = Self::new_gd();
        model.bind_mut().set_data(bytes);
        model
    }

    /// Replaces the model by the one in these bytes of a `.footfall` file.
    #[func]
    pub(crate) fn set_data(&mut self, data: PackedByteArray) {
        self.trained = (!data.is_empty()).then(|| {
            TrainedModel::from_bytes(data.as_slice())
                .map(Arc::new)
                .map_err(|error| error.to_string())
        });
        self.data = data;
        self.base_mut().emit_changed();
    }

    /// What the model is and what it was trained on, or what is wrong with its file.
    #[func]
    fn get_description(&self) -> GString {
        match &self.trained {
            Some(Ok(model)) => GString::from(&describe(model)),
            Some(Err(error)) => GString::from(error),
            None => GString::new(),
        }
    }

    /// What is wrong with the model's file, with the next thing to do; empty when nothing is.
    #[func]
    fn get_error(&self) -> GString {
        self.trained()
            .map_or_else(|error| GString::from(&error), |_| GString::new())
    }

    /// The slowest and the fastest walk that the model was trained on, in metres per second. Zero for a broken model.
    ///
    /// A `GaitGenerator3D` also walks outside this range, by extrapolation.
    #[func]
    fn get_speed_range(&self) -> Vector2 {
        self.trained().map_or(Vector2::ZERO, |model| {
            let [slowest, fastest] = model.speed_range();
            Vector2::new(slowest as f32, fastest as f32)
        })
    }
}

impl GaitModel {
    /// The model, shared with every character that walks with it.
    ///
    /// # Errors
    /// What is wrong with the file, for the user.
    pub(crate) fn trained(&self) -> Result<Arc<TrainedModel>, String> {
        match &self.trained {
            Some(Ok(model)) => Ok(Arc::clone(model)),
            Some(Err(error)) => Err(error.clone()),
            None => Err("the gait model is empty: load a .footfall file into it".to_owned()),
        }
    }
}

/// The model in words, for the inspector.
fn describe(model: &TrainedModel) -> String {
    let from = &model.provenance;
    let [slowest, fastest] = model.speed_range();
    format!(
        "{} steps of {} people in {} recordings, at {slowest:.2} to {fastest:.2} m/s.\nCorpus: {}\nTerms: {}\nMade by: {}",
        from.steps, from.subjects, from.clips, from.corpus, from.terms, from.command
    )
}
