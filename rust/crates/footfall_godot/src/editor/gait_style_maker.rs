//! Styles made by scripts of the editor.

use super::clip_source::Clip;
use super::style_maker::Walks;
use crate::gait_model::GaitModel;
use crate::gait_style::GaitStyle;
use footfall_model::{Provenance, WalkModel};
use footfall_train::{AdaptConfig, adapt_style};
use godot::classes::{Resource, Skeleton3D};
use godot::prelude::*;

/// Steps that are taken from the clips at most.
const MOST_STEPS: usize = 12;

/// Makes styles of walking from a game's clips. For scripts in the editor (`@tool`, `EditorScript`); exported games do not have this class.
///
/// The *Gait Style* dock does the same with a form.
#[derive(GodotClass)]
#[class(tool, init, base = RefCounted)]
pub(super) struct GaitStyleMaker {
    /// Skeleton of animations without a character. Scenes and character files have their own.
    #[var]
    skeleton: Option<Gd<Skeleton3D>>,
    message: GString,
    base: Base<RefCounted>,
}

#[godot_api]
impl GaitStyleMaker {
    /// Adapts the walk of `model` to `clips` and returns the style, or `null`. `get_message()` returns the reason, or warns that the style is thin.
    ///
    /// A clip is a `PackedScene` with a `Skeleton3D` and an `AnimationPlayer`, whose animations are all used; an `Animation` or an
    /// `AnimationLibrary` for `skeleton`; or the path of a `.bvh`, `.glb`, `.gltf`, imported or saved file, followed by `#Name` for one
    /// of its animations. In-place clips get their travel from the standing foot, and loops are repeated. The call blocks the editor for some
    /// seconds.
    ///
    /// To use the style in a game, save its `data` as a `.footstyle` file.
    #[func]
    #[expect(clippy::needless_pass_by_value, reason = "Godot calls by value")]
    fn make_style(
        &mut self,
        model: Option<Gd<GaitModel>>,
        clips: VarArray,
        name: GString,
    ) -> Option<Gd<GaitStyle>> {
        match self.made(model, &clips, &name) {
            Ok((style, message)) => {
                self.message = GString::from(&message);
                Some(style)
            }
            Err(problem) => {
                self.message = GString::from(&problem);
                None
            }
        }
    }

    /// Returns the problem of the last style, or a remark: that it is thin, and which clips show no steps. Empty
    /// if there is none.
    #[func]
    fn get_message(&self) -> GString {
        self.message.clone()
    }
}

impl GaitStyleMaker {
    fn made(
        &self,
        model: Option<Gd<GaitModel>>,
        clips: &VarArray,
        name: &GString,
    ) -> Result<(Gd<GaitStyle>, String), String> {
        let model = model.ok_or("Give the GaitModel for which to make the style.")?;
        let trained = model.bind().trained()?;
        let WalkModel::Gait(base) = &*trained else {
            return Err(
                "A switching model (.footdyn) has no styles. Give a .footfall file.".into(),
            );
        };
        let mut all = Vec::new();
        for clip in clips.iter_shared() {
            all.extend(self.clips_of(&clip)?);
        }
        if all.is_empty() {
            return Err("Give at least one clip of a walk in the style.".to_owned());
        }
        let walks = Walks::read(&all, &name.to_string(), &mut ())?;
        let made_from = Provenance {
            corpus: "clips chosen by a script in the Godot editor".to_owned(),
            terms: "not stated".to_owned(),
            command: "GaitStyleMaker.make_style()".to_owned(),
            ..Provenance::default()
        };
        let (name, config) = (name.to_string(), AdaptConfig::first_steps(MOST_STEPS));
        let adapted = adapt_style(base, &walks.recordings, &name, &config, made_from, &mut ())
            .map_err(|error| error.to_string())?;
        let bytes = adapted.style.to_bytes();
        let bytes = bytes.map_err(|error| error.to_string())?;
        let mut style = GaitStyle::new_gd();
        style.bind_mut().set_data(PackedByteArray::from(bytes));
        Ok((style, walks.remarks(&adapted.style)))
    }

    fn clips_of(&self, clip: &Variant) -> Result<Vec<Clip>, String> {
        let skeletons = self.skeleton.as_slice();
        if let Ok(resource) = clip.try_to::<Gd<Resource>>() {
            return Clip::of_resource(&resource, skeletons);
        }
        if let Ok(path) = clip.try_to::<GString>() {
            return Clip::all_of(&path, skeletons);
        }
        Err(format!(
            "{clip} is not a clip. Give scenes, animations, animation libraries or file paths."
        ))
    }
}
