//! `GaitModel`: a trained walk as a Godot resource.

use crate::loaded::Loaded;
use footfall_model::{GaitModel as TrainedModel, GaitStyle as TrainedStyle};
use footfall_synth::StyleSpace;
use godot::classes::{IResource, Resource};
use godot::prelude::*;
use std::sync::{Arc, Weak};

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
    loaded: Loaded<TrainedModel>,
    /// What characters in the same styles share.
    spaces: Vec<Weak<StyleSpace>>,
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
        self.loaded = Loaded::read(&data, TrainedModel::from_bytes);
        self.spaces.clear();
        self.data = data;
        self.base_mut().emit_changed();
    }

    /// What the model is and what it was trained on, or what is wrong with its file.
    #[func]
    fn get_description(&self) -> GString {
        self.loaded.describe(describe)
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
        self.loaded
            .content("the gait model is empty: load a .footfall file into it")
    }

    /// The model with these styles, prepared once for all characters that wear the same.
    ///
    /// # Errors
    /// What is wrong with the model or why it cannot wear the styles, for the user.
    pub(crate) fn space(
        &mut self,
        styles: &[Arc<TrainedStyle>],
    ) -> Result<Arc<StyleSpace>, String> {
        let trained = self.trained()?;
        self.spaces.retain(|space| space.strong_count() > 0);
        let holds_these = |space: &Arc<StyleSpace>| {
            let pairs = space.styles().iter().zip(styles);
            space.styles().len() == styles.len()
                && pairs.into_iter().all(|(a, b)| Arc::ptr_eq(a, b))
        };
        let known = self.spaces.iter().filter_map(Weak::upgrade);
        if let Some(space) = known.into_iter().find(holds_these) {
            return Ok(space);
        }
        let space = StyleSpace::new(&trained, styles).map_err(|error| error.to_string())?;
        let space = Arc::new(space);
        self.spaces.push(Arc::downgrade(&space));
        Ok(space)
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
