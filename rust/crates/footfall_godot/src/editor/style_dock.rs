//! The dock that makes a style of walking from recordings.

mod form;

use super::clip_source::{Clip, all_below};
use super::style_maker::{Made, Order};
use crate::gait_generator_3d::GaitGenerator3D;
use crate::gait_model::GaitModel;
use crate::gait_style::GaitStyle;
use footfall_model::WalkModel;
use footfall_synth::StyleSpace;
use footfall_train::job::{Job, finished};
use form::{Form, State};
use godot::classes::{
    EditorDock, EditorInterface, IEditorDock, ProjectSettings, ResourceLoader, Skeleton3D,
    editor_dock,
};
use godot::prelude::*;
use std::path::PathBuf;
use std::sync::Arc;

/// The walk that is adapted where none was chosen.
const USUAL_BASE: &str = "res://addons/footfall/models/locomotion.footfall";

/// Makes a `.footstyle` of recordings and of animations of characters, shows it, and gives it to a walker.
#[derive(GodotClass)]
#[class(tool, init, internal, base = EditorDock)]
pub(super) struct FootfallStyleDock {
    form: Option<Form>,
    recordings: Vec<Clip>,
    job: Option<Job<Result<Made, String>>>,
    /// The file of the style that was made last.
    made: Option<GString>,
    /// True when the dock is at a side of the editor.
    narrow: bool,
    base: Base<EditorDock>,
}

#[godot_api]
impl IEditorDock for FootfallStyleDock {
    fn enter_tree(&mut self) {
        if self.form.is_none() {
            let mut form = Form::build(&self.to_gd());
            form.lay_out(self.narrow);
            self.form = Some(form);
            self.refresh();
        }
    }

    fn update_layout(&mut self, layout: i32) {
        self.narrow = layout == editor_dock::DockLayout::VERTICAL.ord() as i32;
        if let Some(form) = &mut self.form {
            form.lay_out(self.narrow);
        }
    }

    fn process(&mut self, _delta: f64) {
        let Some(job) = &self.job else { return };
        let progress = job.progress();
        if let Some(form) = &mut self.form {
            form.show_progress(&progress);
        }
        let Some(ended) = finished(&mut self.job).map(Result::flatten) else {
            return;
        };
        match ended {
            Ok(made) => self.take(&made),
            Err(problem) => self.show_message(&problem),
        }
        self.refresh();
    }
}

#[godot_api]
impl FootfallStyleDock {
    /// Adds files to learn from: recordings, characters with all their animations, and animations of a character in the scene that is edited.
    #[func]
    #[expect(clippy::needless_pass_by_value, reason = "Godot calls by value")]
    fn add_recordings(&mut self, files: PackedStringArray) {
        let mut problems = Vec::new();
        let skeletons = skeletons_in_view();
        for file in files.as_slice() {
            match Clip::all_of(file, &skeletons) {
                Ok(clips) => {
                    for clip in clips {
                        if !self.recordings.contains(&clip) {
                            self.recordings.push(clip);
                        }
                    }
                }
                Err(problem) => problems.push(problem),
            }
        }
        self.show_message(&problems.join("\n"));
        self.refresh();
    }

    /// Asks for recordings to learn from.
    #[func]
    fn choose_recordings(&mut self) {
        if let Some(form) = &mut self.form {
            form.choose_recordings();
        }
    }

    /// Forgets the recording that is selected, or all when none is.
    #[func]
    fn remove_selected(&mut self) {
        match self.form.as_ref().and_then(Form::selected) {
            Some(index) if index < self.recordings.len() => {
                self.recordings.remove(index);
            }
            _ => self.recordings.clear(),
        }
        self.refresh();
    }

    #[func]
    #[expect(clippy::needless_pass_by_value, reason = "Godot calls by value")]
    fn follow_name(&mut self, name: GString) {
        if let Some(form) = &mut self.form {
            form.follow_name(&name);
        }
    }

    /// Name of the style; the file follows.
    #[func]
    #[expect(clippy::needless_pass_by_value, reason = "Godot calls by value")]
    fn set_style_name(&mut self, name: GString) {
        if let Some(form) = &mut self.form {
            form.set_name(&name);
        }
    }

    /// Starts to make the style, unless one is being made.
    #[func]
    fn make(&mut self) {
        if self.job.is_some() {
            return;
        }
        match self.order() {
            Ok(order) => {
                self.show_message("");
                self.made = None;
                self.job = Some(order.start());
            }
            Err(problem) => self.show_message(&problem),
        }
        self.refresh();
    }

    /// Asks the work to stop; nothing is written then.
    #[func]
    fn cancel(&mut self) {
        if let Some(job) = &self.job {
            job.cancel();
        }
    }

    /// Returns whether a style is being made.
    #[func]
    fn is_working(&self) -> bool {
        self.job.is_some()
    }

    /// Message shown last.
    #[func]
    fn get_message(&self) -> GString {
        let form = self.form.as_ref();
        form.map_or_else(GString::new, Form::message)
    }

    /// Gives the style that was made to the walkers among the selected nodes, as an action that can be undone.
    #[func]
    fn give_to_selected(&mut self) {
        let selected = EditorInterface::singleton().get_selection();
        let nodes = selected.map(|selection| selection.get_selected_nodes());
        let walkers: Vec<Gd<GaitGenerator3D>> = nodes
            .iter()
            .flat_map(Array::iter_shared)
            .filter_map(|node| node.try_cast().ok())
            .collect();
        let problem = if walkers.is_empty() {
            "Select a GaitGenerator3D first.".to_owned()
        } else {
            match self.made_style() {
                Ok(style) => {
                    for walker in walkers {
                        wear(&walker, &style);
                    }
                    return;
                }
                Err(problem) => problem,
            }
        };
        self.show_message(&problem);
    }
}

impl FootfallStyleDock {
    /// The dock, as the editor's layout has to know it before it is shown.
    pub(super) fn titled() -> Gd<Self> {
        let mut dock = Self::new_alloc();
        dock.set_title("Gait Style");
        dock.set_layout_key("footfall_gait_style");
        // At the bottom it is a button until it is wanted; at the side it would halve the inspector.
        dock.set_default_slot(editor_dock::DockSlot::BOTTOM);
        dock.set_available_layouts(editor_dock::DockLayout::ALL);
        dock
    }

    /// Order from the form.
    fn order(&self) -> Result<Order, String> {
        let form = self.form.as_ref().ok_or("The dock is not open.")?;
        if self.recordings.is_empty() {
            return Err(
                "Add recordings of the style first: BVH files of a walk in it, characters with animations (.glb, .fbx), or animations."
                    .to_owned(),
            );
        }
        let name = form.name();
        if name.is_empty() {
            return Err("Give the style a name.".to_owned());
        }
        let file = form.file();
        if !file.starts_with("res://") || !file.ends_with(".footstyle") {
            return Err(format!(
                "{file} is not in this project. Give a path such as res://styles/{name}.footstyle."
            ));
        }
        let model = form
            .base_model()
            .ok_or("Choose a base model: a .footfall file.")?;
        let trained = model.bind().trained()?;
        let WalkModel::Gait(base) = &*trained else {
            return Err(
                "A switching model (.footdyn) has no styles. Choose a .footfall file.".to_owned(),
            );
        };
        Ok(Order {
            base: Arc::clone(base),
            recordings: self.recordings.clone(),
            name,
            steps: form.steps(),
            file: PathBuf::from(globalized(&GString::from(&file)).to_string()),
        })
    }

    /// A style has been made: the project learns of it, and it walks on the stage.
    fn take(&mut self, made: &Made) {
        let style = &made.style;
        let Some(form) = &mut self.form else { return };
        let file = GString::from(&form.file());
        self.made = Some(file.clone());
        if let Ok(space) = StyleSpace::new(&made.base, &[Arc::clone(style)]) {
            form.show_walker(&Arc::new(space));
        }
        let steps = style.provenance.steps;
        let text = format!(
            "{file}: {steps} steps at {:.2} m/s, {:.0} steps a minute. {}",
            style.speed_mps,
            60.0 * style.cadence_hz,
            made.remarks
        );
        self.show_message(text.trim_end());
        if let Some(mut files) = EditorInterface::singleton().get_resource_filesystem() {
            files.scan();
        }
    }

    /// The style that was made, as the project has it.
    fn made_style(&self) -> Result<Gd<GaitStyle>, String> {
        let file = self.made.as_ref().ok_or("Make a style first.")?;
        let found = ResourceLoader::singleton().load(file);
        found
            .and_then(|resource| resource.try_cast().ok())
            .ok_or_else(|| format!("{file} no longer exists. Make the style again."))
    }

    fn show_message(&mut self, message: &str) {
        if let Some(form) = &mut self.form {
            form.show_message(message);
        }
    }

    fn refresh(&mut self) {
        let names = self.recordings.iter().map(Clip::label);
        if let Some(form) = &mut self.form {
            let state = match (&self.job, &self.made) {
                (Some(_), _) => State::Working,
                (None, Some(_)) => State::Made,
                (None, None) => State::Empty,
            };
            form.refresh(names, state);
        }
    }
}

/// The skeletons of the scene that is edited, those at selected nodes first.
fn skeletons_in_view() -> Vec<Gd<Skeleton3D>> {
    let editor = EditorInterface::singleton();
    let selected = editor.get_selection();
    let selected = selected.map(|selection| selection.get_selected_nodes());
    let selected = selected.iter().flat_map(Array::iter_shared);
    selected
        .chain(editor.get_edited_scene_root())
        .flat_map(|node| all_below(&node, "Skeleton3D"))
        .collect()
}

/// Adds a style to a walker, or gives it full weight if the walker has it already.
fn wear(walker: &Gd<GaitGenerator3D>, style: &Gd<GaitStyle>) {
    let Some(mut undo) = EditorInterface::singleton().get_editor_undo_redo() else {
        return;
    };
    let old: Array<Option<Gd<GaitStyle>>> = walker.get("styles").to();
    let old_weights: PackedFloat32Array = walker.get("style_weights").to();
    let mut styles = old.duplicate_shallow();
    let mut weights = old_weights.clone();
    weights.resize(styles.len());
    let path = style.get_path();
    let place = styles.iter_shared().position(|known| {
        known.is_some_and(|known| &known == style || (!path.is_empty() && known.get_path() == path))
    });
    if let Some(place) = place {
        weights.as_mut_slice()[place] = 1.0;
    } else {
        styles.push(style);
        weights.push(1.0);
    }
    undo.create_action("Wear Gait Style");
    undo.add_do_property(walker, "styles", &styles.to_variant());
    undo.add_do_property(walker, "style_weights", &weights.to_variant());
    undo.add_undo_property(walker, "styles", &old.to_variant());
    undo.add_undo_property(walker, "style_weights", &old_weights.to_variant());
    undo.commit_action();
}

/// A path of the project as one of the machine.
fn globalized(path: &GString) -> GString {
    ProjectSettings::singleton().globalize_path(path)
}
