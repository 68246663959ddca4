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

/// Makes styles of walking of the clips that a game has. For scripts in the editor (`@tool`, `EditorScript`); exported games are without it.
///
/// The *Gait Style* dock does the same with a form.
#[derive(GodotClass)]
#[class(tool, init, base = RefCounted)]
pub(super) struct GaitStyleMaker {
    /// The skeleton that animations without a character were made for. Scenes and files of characters bring their own.
    #[var]
    skeleton: Option<Gd<Skeleton3D>>,
    message: GString,
    base: Base<RefCounted>,
}

#[godot_api]
impl GaitStyleMaker {
    /// Adapts the walk of `model` to `clips` and returns the style, or `null`; `get_message()` says why, or that the style is thin.
    ///
    /// A clip is a `PackedScene` with a `Skeleton3D` and an `AnimationPlayer`, all of whose animations are taken; an `Animation` or an
    /// `AnimationLibrary` of `skeleton`; or the path of a `.bvh`, `.glb`, `.gltf`, imported or saved file, with `#Name` behind it for one
    /// of its animations. Clips that walk in place get their travel from the standing foot, and loops are repeated. Takes some seconds,
    /// and the editor waits.
    ///
    /// Save the style's `data` as a `.footstyle` file to use it in the game.
    #[func]
    #[expect(clippy::needless_pass_by_value, reason = "Godot calls by value")]
    fn make_style(
        &mut self,
        model: Option<Gd<GaitModel>>,
        clips: VarArray,
        name: GString,
    ) -> Option<Gd<GaitStyle>> {
        match self.made(model, &clips, &name) {
            Ok((style, told)) => {
                self.message = GString::from(&told);
                Some(style)
            }
            Err(problem) => {
                self.message = GString::from(&problem);
                None
            }
        }
    }

    /// The problem of the style that was asked for last, or what there is to be said about it: that it is thin, and which clips show no steps. Empty
    /// when all is well.
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
        let model = model.ok_or("Give the GaitModel that is to wear the style.")?;
        let trained = model.bind().trained()?;
        let WalkModel::Gait(base) = &*trained else {
            return Err(
                "A switching model (.footdyn) wears no styles. Give a .footfall file.".into(),
            );
        };
        let mut all = Vec::new();
        for clip in clips.iter_shared() {
            all.extend(self.clips_of(&clip)?);
        }
        if all.is_empty() {
            return Err("Give clips of someone who walks in the style.".to_owned());
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
            "{clip} is no clip. Give scenes, animations, libraries of animations or paths of files."
        ))
    }
}
