//! `GaitModel`: a trained walk as a Godot resource.

use crate::loaded::{Loaded, sources};
use crate::shipped::Shipped;
use crate::walk_source::WalkSource;
use footfall_core::Side;
use footfall_model::{GaitModel as TrainedWalk, GaitStyle as TrainedStyle, WalkModel};
use footfall_synth::{GaitGenerator, GeneratorConfig, StyleSpace};
use godot::classes::{IResource, Resource};
use godot::prelude::*;
use std::cell::OnceCell;
use std::sync::{Arc, Weak};

/// Problem of a resource without a file.
const EMPTY: &str = "the gait model is empty. Load a .footfall or .footdyn file instead";

/// Problem of styles for a model that has none.
pub(crate) const NO_STYLES: &str = "A switching model (.footdyn) has no styles and walks without them. Clear Styles, or load a .footfall file into Model.";

/// Gait model learned from recordings: a trained walk (`.footfall`, made by `footfall train`) or a switching model
/// (`.footdyn`, made by `footfall dynamics fit`).
///
/// Godot loads either file as this resource, without import. Set it as the `model` of a `GaitGenerator3D`. One model serves
/// any number of characters. A trained walk knows many walkers, adapts its steps to the speed and supports styles. A switching model has a
/// hundredth of its size and one person's way of walking.
#[derive(GodotClass)]
#[class(tool, init, base = Resource)]
pub(crate) struct GaitModel {
    /// Bytes of the `.footfall` or `.footdyn` file.
    ///
    /// Plain bytes, so that a scene or `.res` file with this resource needs built-in storage only.
    #[var(set = set_data, usage_flags = [STORAGE])]
    data: PackedByteArray,

    /// Description of the model and its training recordings, or the problem of its file.
    #[var(get = get_description, no_set, usage_flags = [EDITOR, READ_ONLY], hint = MULTILINE_TEXT)]
    description: PhantomVar<GString>,

    /// The model in `data`, or why there is none.
    loaded: Loaded<WalkModel>,
    /// The slowest and the fastest walk, computed on demand: those of a switching model have to be generated.
    speeds: OnceCell<[f32; 2]>,
    /// Style spaces that characters with the same styles share.
    spaces: Vec<Weak<StyleSpace>>,
    base: Base<Resource>,
}

#[godot_api]
impl IResource for GaitModel {}

#[godot_api]
impl GaitModel {
    /// Creates a model from the bytes of a `.footfall` or `.footdyn` file, for example a downloaded one.
    ///
    /// `get_error()` returns a problem if the bytes are not a model.
    #[func]
    fn from_bytes(bytes: PackedByteArray) -> Gd<Self> {
        let mut model = Self::new_gd();
        model.bind_mut().set_data(bytes);
        model
    }

    /// Replaces the model by the content of a `.footfall` or `.footdyn` file.
    #[func]
    pub(crate) fn set_data(&mut self, data: PackedByteArray) {
        self.loaded = Loaded::read(&data, WalkModel::from_bytes);
        self.speeds = OnceCell::new();
        self.spaces.clear();
        self.data = data;
        self.base_mut().emit_changed();
    }

    /// Description of the model and its training recordings, or the problem of its file.
    #[func]
    fn get_description(&self) -> GString {
        self.loaded
            .describe(|model| describe(model, self.speeds_of(model)))
    }

    /// Returns the problem of the model's file, with what to do next; empty if there is none.
    #[func]
    fn get_error(&self) -> GString {
        self.loaded.error(EMPTY)
    }

    /// Returns the slowest and the fastest walk that the model was trained on, in metres per second. Zero for an invalid model; a switching
    /// model knows one speed.
    ///
    /// A `GaitGenerator3D` also walks outside this range, by extrapolation.
    #[func]
    fn get_speed_range(&self) -> Vector2 {
        self.trained().map_or(Vector2::ZERO, |model| {
            let [slowest, fastest] = self.speeds_of(&model);
            Vector2::new(slowest, fastest)
        })
    }

    /// Returns `true` for a switching model, which has no styles.
    #[func]
    pub(crate) fn is_switching(&self) -> bool {
        matches!(self.trained().as_deref(), Ok(WalkModel::Dynamics(_)))
    }
}

impl Shipped for GaitModel {
    const FILE: &'static str = "locomotion.footfall";
    const MISSING: &'static str = "There is no gait model, and the add-on's own, models/locomotion.footfall, is missing. Unzip the add-on again, or load a .footfall file into Model.";

    fn is_new(&self) -> bool {
        self.data.is_empty()
    }
}

impl GaitModel {
    fn speeds_of(&self, model: &WalkModel) -> [f32; 2] {
        *self.speeds.get_or_init(|| speed_range(model))
    }

    /// The model, shared with every character that walks with it.
    ///
    /// # Errors
    /// Text for the user that says what is wrong with the file.
    pub(crate) fn trained(&self) -> Result<Arc<WalkModel>, String> {
        self.loaded.content(EMPTY)
    }

    /// The model with these styles, prepared once for all characters with the same styles.
    ///
    /// # Errors
    /// Text for the user that says what is wrong with the model, or with the styles.
    pub(crate) fn source(&mut self, styles: &[Arc<TrainedStyle>]) -> Result<WalkSource, String> {
        let trained = match &*self.trained()? {
            WalkModel::Gait(model) => Arc::clone(model),
            WalkModel::Dynamics(model) if styles.is_empty() => {
                return Ok(WalkSource::Switching(Arc::clone(model)));
            }
            WalkModel::Dynamics(_) => return Err(NO_STYLES.to_owned()),
        };
        if let Some(space) = self.space_with(styles) {
            return Ok(WalkSource::Styled(space));
        }
        let space = StyleSpace::new(&trained, styles).map_err(|error| error.to_string())?;
        let space = Arc::new(space);
        self.share(&space);
        Ok(WalkSource::Styled(space))
    }

    /// The trained walk, and its style space for these styles if a character uses it already.
    ///
    /// # Errors
    /// Text for the user that says what is wrong with the model.
    pub(crate) fn prepared(
        &self,
        styles: &[Arc<TrainedStyle>],
    ) -> Result<(Arc<TrainedWalk>, Option<Arc<StyleSpace>>), String> {
        let WalkModel::Gait(model) = &*self.trained()? else {
            return Err(
                "A crowd needs a trained walk (.footfall), not a switching model. Load another Model.".to_owned(),
            );
        };
        Ok((Arc::clone(model), self.space_with(styles)))
    }

    /// Shares a model with styles, prepared elsewhere, with characters of the same styles.
    pub(crate) fn share(&mut self, space: &Arc<StyleSpace>) {
        self.spaces.retain(|space| space.strong_count() > 0);
        self.spaces.push(Arc::downgrade(space));
    }

    fn space_with(&self, styles: &[Arc<TrainedStyle>]) -> Option<Arc<StyleSpace>> {
        let holds_these = |space: &Arc<StyleSpace>| {
            let pairs = space.styles().iter().zip(styles);
            space.styles().len() == styles.len()
                && pairs.into_iter().all(|(a, b)| Arc::ptr_eq(a, b))
        };
        let mut known = self.spaces.iter().filter_map(Weak::upgrade);
        known.find(holds_these)
    }
}

fn speed_range(model: &WalkModel) -> [f32; 2] {
    match model {
        WalkModel::Gait(model) => model.speed_range().map(|speed| speed as f32),
        WalkModel::Dynamics(model) => {
            let config = GeneratorConfig {
                seed: 0,
                phase: 0.0,
                variation: 0.0,
            };
            let walker = GaitGenerator::switching(model, &model.skeleton, &config);
            [walker.map_or(0.0, |walker| walker.usual_speed_mps()); 2]
        }
    }
}

/// The model in words, for the inspector.
fn describe(model: &WalkModel, [slowest, fastest]: [f32; 2]) -> String {
    let from = model.provenance();
    let what = match model {
        WalkModel::Gait(_) => format!(
            "{} steps of {} people in {} recordings, at {slowest:.2} to {fastest:.2} m/s.",
            from.steps, from.subjects, from.clips
        ),
        WalkModel::Dynamics(model) => format!(
            "Two linear systems of order {} that switch when a foot lands, at {slowest:.2} m/s: {} steps of {} people in {} recordings.",
            model.regime(Side::Left).system.order(),
            from.steps,
            from.subjects,
            from.clips
        ),
    };
    format!("{what}\n{}", sources(from))
}
