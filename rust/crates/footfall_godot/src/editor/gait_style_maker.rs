//! Styles made by scripts of the editor.

use super::clip_source::Clip;
use crate::gait_model::GaitModel;
use crate::gait_style::GaitStyle;
use footfall_model::{Provenance, WalkModel};
use footfall_train::Recordings;
use godot::classes::{Animation, PackedScene, Skeleton3D};
use godot::prelude::*;

/// Steps that are taken from the clips at most.
const MOST_STEPS: usize = 12;

/// Makes styles of walking of the clips that a game has. For scripts in the editor (`@tool`, `EditorScript`); exported games are without it.
///
/// The *Gait Style* dock does the same with a form.
#[derive(GodotClass)]
#[class(tool, init, base = RefCounted)]
pub(super) struct GaitStyleMaker {
    /// The skeleton that clips of the type `Animation` were made for. Scenes and files bring their own.
    #[var]
    skeleton: Option<Gd<Skeleton3D>>,
    message: GString,
    base: Base<RefCounted>,
}

#[godot_api]
impl GaitStyleMaker {
    /// Adapts the walk of `model` to `clips` and returns the style, or `null`; `get_message()` says why, or that the style is thin.
    ///
    /// A clip is a `PackedScene` with a `Skeleton3D` and an `AnimationPlayer`, all of whose animations are taken; an `Animation` of `skeleton`; or
    /// the path of a `.bvh`, `.glb`, `.gltf` or imported file, with `#Name` for one animation of a glTF file. Clips that walk in place get
    /// their travel from the standing foot, and loops are repeated. Takes some seconds, and the editor waits.
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

    /// The problem of the style that was asked for last, or that it is thin; empty when all is well.
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
        let mut read = Recordings::default();
        for clip in clips.iter_shared() {
            for clip in self.clips_of(&clip)? {
                read.0.push((name.to_string(), clip.read()?));
            }
        }
        if read.0.is_empty() {
            return Err("Give clips of someone who walks in the style.".to_owned());
        }
        let made_from = Provenance {
            corpus: "clips chosen by a script in the Godot editor".to_owned(),
            terms: "not stated".to_owned(),
            command: "GaitStyleMaker.make_style()".to_owned(),
            ..Provenance::default()
        };
        let adapted = read
            .adapt(base, &name.to_string(), MOST_STEPS, made_from, &mut ())
            .map_err(|error| error.to_string())?;
        let bytes = adapted.style.to_bytes();
        let bytes = bytes.map_err(|error| error.to_string())?;
        let mut style = GaitStyle::new_gd();
        style.bind_mut().set_data(PackedByteArray::from(bytes));
        Ok((style, adapted.style.thin_warning().unwrap_or_default()))
    }

    fn clips_of(&self, clip: &Variant) -> Result<Vec<Clip>, String> {
        if let Ok(scene) = clip.try_to::<Gd<PackedScene>>() {
            return Clip::of_scene(&scene, &scene.get_path());
        }
        if let Ok(animation) = clip.try_to::<Gd<Animation>>() {
            let skeleton = self.skeleton.as_ref();
            let skeleton = skeleton
                .ok_or("An Animation alone does not say how its bones rest. Set the maker's skeleton, or give the character's scene.")?;
            return Ok(vec![Clip::of_animation(&animation, skeleton)?]);
        }
        if let Ok(path) = clip.try_to::<GString>() {
            return Clip::all_of(&path);
        }
        Err(format!(
            "{clip} is no clip. Give PackedScenes, Animations or paths of files."
        ))
    }
}
