//! `GaitStyle`: a way of walking as a Godot resource.

use crate::loaded::{Loaded, sources};
use footfall_model::GaitStyle as TrainedStyle;
use godot::classes::{IResource, Resource};
use godot::prelude::*;
use std::sync::Arc;

/// Problem of a resource without a file.
const EMPTY: &str = "the gait style is empty. Load a .footstyle file instead";

/// Style of walking, made by `footfall adapt` from about a dozen steps and stored in a `.footstyle` file.
///
/// Godot loads a `.footstyle` file as this resource, without import. Add it to the `styles` of a `GaitGenerator3D` and
/// set its weight in `style_weights`. A style fits only the `GaitModel` that it was adapted from.
#[derive(GodotClass)]
#[class(tool, init, base = Resource)]
pub(crate) struct GaitStyle {
    /// Bytes of the `.footstyle` file.
    ///
    /// Plain bytes, so that a scene or `.res` file with this resource needs built-in storage only.
    #[var(set = set_data, usage_flags = [STORAGE])]
    data: PackedByteArray,

    /// Description of the style and its recordings, or the problem of its file.
    #[var(get = get_description, no_set, usage_flags = [EDITOR, READ_ONLY], hint = MULTILINE_TEXT)]
    description: PhantomVar<GString>,

    /// The style in `data`, or why there is none.
    loaded: Loaded<TrainedStyle>,
    base: Base<Resource>,
}

#[godot_api]
impl IResource for GaitStyle {}

#[godot_api]
impl GaitStyle {
    /// Creates a style from the bytes of a `.footstyle` file, for example a downloaded one.
    ///
    /// `get_error()` returns a problem if the bytes are not a style.
    #[func]
    fn from_bytes(bytes: PackedByteArray) -> Gd<Self> {
        let mut style = Self::new_gd();
        style.bind_mut().set_data(bytes);
        style
    }

    /// Replaces the style by the content of a `.footstyle` file.
    #[func]
    pub(crate) fn set_data(&mut self, data: PackedByteArray) {
        self.loaded = Loaded::read(&data, TrainedStyle::from_bytes);
        self.data = data;
        self.base_mut().emit_changed();
    }

    /// Description of the style and its recordings, or the problem of its file.
    #[func]
    fn get_description(&self) -> GString {
        self.loaded.describe(describe)
    }

    /// Returns the problem of the style's file, with what to do next; empty if there is none.
    #[func]
    fn get_error(&self) -> GString {
        self.loaded.error(EMPTY)
    }

    /// Returns the name of the style, such as `proud`. Empty for an invalid style.
    #[func]
    fn get_style_name(&self) -> GString {
        self.trained()
            .map_or_else(|_| GString::new(), |style| GString::from(&style.name))
    }

    /// Returns the speed at which people walked in this style, in metres per second. Zero for an invalid style.
    ///
    /// A character walks at its node's `speed` in any style; this speed suits the style best.
    #[func]
    fn get_usual_speed(&self) -> f64 {
        self.trained().map_or(0.0, |style| style.speed_mps)
    }
}

impl GaitStyle {
    /// The style, shared with every character that has it.
    ///
    /// # Errors
    /// Text for the user that says what is wrong with the file.
    pub(crate) fn trained(&self) -> Result<Arc<TrainedStyle>, String> {
        self.loaded.content(EMPTY)
    }
}

/// All styles of a list.
///
/// # Errors
/// Trained styles of all resources; the error names the one that is empty or broken, and what to do.
pub(crate) fn trained_all(
    styles: &Array<Option<Gd<GaitStyle>>>,
) -> Result<Vec<Arc<TrainedStyle>>, String> {
    let styles = styles.iter_shared().enumerate();
    styles
        .map(|(index, style)| {
            let style = style.ok_or_else(|| {
                format!("Style {index} is empty. Load a .footstyle file into it, or remove it from Styles.")
            })?;
            style.bind().trained().map_err(|error| {
                format!("Style {index} cannot be used ({}): {error}", style.get_path())
            })
        })
        .collect()
}

/// The style in words, for the inspector.
fn describe(style: &TrainedStyle) -> String {
    let from = &style.provenance;
    format!(
        "{}: {} steps, at {:.2} m/s and {:.0} steps a minute.\n{}",
        style.name,
        from.steps,
        style.speed_mps,
        60.0 * style.cadence_hz,
        sources(from)
    )
}
