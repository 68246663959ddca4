//! Controls of the dock.

use super::{FootfallStyleDock, GaitModel, USUAL_BASE};
use crate::editor::walker_view::FootfallWalkerView;
use footfall_synth::StyleSpace;
use footfall_train::job::JobProgress;
use godot::classes::{
    BoxContainer, Button, Control, EditorResourcePicker, FileDialog, HBoxContainer, ItemList,
    Label, LineEdit, ProgressBar, Resource, ResourceLoader, ScrollContainer, SpinBox,
    VBoxContainer, control, file_dialog, scroll_container, text_server,
};
use godot::prelude::*;
use std::sync::Arc;

/// The dock's controls.
pub(super) struct Form {
    files: Gd<ItemList>,
    dialog: Gd<FileDialog>,
    base: Gd<EditorResourcePicker>,
    name: Gd<LineEdit>,
    steps: Gd<SpinBox>,
    file: Gd<LineEdit>,
    make: Gd<Button>,
    cancel: Gd<Button>,
    progress: Gd<ProgressBar>,
    message: Gd<Label>,
    view: Gd<FootfallWalkerView>,
    give: Gd<Button>,
    /// Recordings, what is made of them, and the result: side by side or one below the other.
    parts: Gd<BoxContainer>,
}

/// Progress of a style.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum State {
    /// None was made yet.
    Empty,
    /// One is being made.
    Working,
    /// One was made.
    Made,
}

impl Form {
    /// Fills the dock and connects its controls to it.
    pub(super) fn build(dock: &Gd<FootfallStyleDock>) -> Self {
        let mut rows = VBoxContainer::new_alloc();
        let mut parts = BoxContainer::new_alloc();
        add_part(&mut parts, &rows);
        rows.add_child(&label("Recordings"));
        let mut files = ItemList::new_alloc();
        files.set_custom_minimum_size(Vector2::new(0.0, 60.0));
        files.set_v_size_flags(control::SizeFlags::EXPAND_FILL);
        files.set_tooltip_text(
            "BVH files of a walk in the style, or walk animations of characters (glTF, or any format that Godot imports). Six to twelve steps are enough",
        );
        rows.add_child(&files);
        let add = button(
            "Add\u{2026}",
            "Choose BVH and glTF files in any folder, or scenes and animations of the project",
        );
        let remove = button("Remove", "Remove the selected recording, or all of them");
        rows.add_child(&row(&[&add.clone().upcast(), &remove.clone().upcast()]));

        let mut rows = VBoxContainer::new_alloc();
        add_part(&mut parts, &rows);
        let mut base = EditorResourcePicker::new_alloc();
        base.set_base_type("GaitModel");
        base.set_tooltip_text(
            "The walk to adapt. Walkers that use the style must have it as their model",
        );
        named(&mut rows, "Base", &base.clone().upcast());
        let mut name = LineEdit::new_alloc();
        name.set_placeholder("proud");
        named(&mut rows, "Name", &name.clone().upcast());
        let mut steps = SpinBox::new_alloc();
        steps.set_min(2.0);
        steps.set_max(100.0);
        steps.set_value(12.0);
        steps.set_tooltip_text("Maximum number of steps to use from the recordings");
        named(&mut rows, "Steps", &steps.clone().upcast());
        let mut file = LineEdit::new_alloc();
        file.set_placeholder("res://styles/proud.footstyle");
        named(&mut rows, "File", &file.clone().upcast());

        let make = button(
            "Make Style",
            "Adapt the base to the recordings, in the background",
        );
        let cancel = button("Cancel", "Stop without writing a file");
        rows.add_child(&row(&[&make.clone().upcast(), &cancel.clone().upcast()]));
        let mut progress = ProgressBar::new_alloc();
        progress.set_visible(false);
        rows.add_child(&progress);
        let mut message = Label::new_alloc();
        message.set_autowrap_mode(text_server::AutowrapMode::WORD_SMART);
        rows.add_child(&message);
        let mut rows = VBoxContainer::new_alloc();
        add_part(&mut parts, &rows);
        let mut view = FootfallWalkerView::stage();
        view.set_v_size_flags(control::SizeFlags::EXPAND_FILL);
        view.set_visible(false);
        rows.add_child(&view);
        let give = button(
            "Give to Selected Walker",
            "Add the style to the GaitGenerator3D selected in the scene, with a weight of 1",
        );
        rows.add_child(&give);

        let mut dialog = FileDialog::new_alloc();
        dialog.set_access(file_dialog::Access::FILESYSTEM);
        dialog.set_file_mode(file_dialog::FileMode::OPEN_FILES);
        dialog.add_filter(
            "*.bvh, *.glb, *.gltf, *.fbx, *.blend, *.tscn, *.scn, *.tres, *.res, *.anim",
        );
        // A dock that needs height takes it from its neighbours.
        let mut scroll = ScrollContainer::new_alloc();
        scroll.set_horizontal_scroll_mode(scroll_container::ScrollMode::DISABLED);
        parts.set_h_size_flags(control::SizeFlags::EXPAND_FILL);
        parts.set_v_size_flags(control::SizeFlags::EXPAND_FILL);
        scroll.add_child(&parts);
        let mut host = dock.clone();
        host.add_child(&scroll);
        host.add_child(&dialog);

        // By name: typed connections are cut, with a warning, when the library is reloaded.
        let connect = |from: Gd<Control>, signal: &str, function: &str| {
            from.clone().connect(signal, &dock.callable(function));
        };
        connect(add.upcast(), "pressed", "choose_recordings");
        connect(remove.upcast(), "pressed", "remove_selected");
        connect(name.clone().upcast(), "text_changed", "follow_name");
        connect(make.clone().upcast(), "pressed", "make");
        connect(cancel.clone().upcast(), "pressed", "cancel");
        connect(give.clone().upcast(), "pressed", "give_to_selected");
        dialog.connect("files_selected", &dock.callable("add_recordings"));
        Self {
            files,
            dialog,
            base,
            name,
            steps,
            file,
            make,
            cancel,
            progress,
            message,
            view,
            give,
            parts,
        }
    }

    /// Puts the parts one below the other, for a narrow dock at the side, or side by side.
    pub(super) fn lay_out(&mut self, narrow: bool) {
        self.parts.set_vertical(narrow);
    }

    pub(super) fn name(&self) -> String {
        self.name.get_text().to_string().trim().to_owned()
    }

    pub(super) fn set_name(&mut self, name: &GString) {
        self.name.set_text(name);
        self.follow_name(name);
    }

    /// The file is called as the style.
    pub(super) fn follow_name(&mut self, name: &GString) {
        self.file.set_text(&file_of(&name.to_string()));
    }

    pub(super) fn choose_recordings(&mut self) {
        self.dialog.popup_centered_ratio();
    }

    /// The recording that is selected in the list.
    pub(super) fn selected(&self) -> Option<usize> {
        let selected = self.files.get_selected_items();
        usize::try_from(*selected.as_slice().first()?).ok()
    }

    pub(super) fn file(&self) -> String {
        self.file.get_text().to_string().trim().to_owned()
    }

    pub(super) fn steps(&self) -> usize {
        self.steps.get_value() as usize
    }

    /// The walk that was chosen, or else the add-on's own.
    pub(super) fn base_model(&self) -> Option<Gd<GaitModel>> {
        let usual = || ResourceLoader::singleton().load(USUAL_BASE);
        let chosen: Option<Gd<Resource>> = self.base.get_edited_resource().or_else(usual);
        chosen?.try_cast().ok()
    }

    pub(super) fn message(&self) -> GString {
        self.message.get_text()
    }

    pub(super) fn show_message(&mut self, message: &str) {
        self.message.set_text(message);
    }

    pub(super) fn show_progress(&mut self, progress: &JobProgress) {
        let total = progress.total.max(1);
        self.progress.set_max(total as f64);
        self.progress.set_value(progress.done.min(total) as f64);
        self.message.set_text(&progress.task);
    }

    pub(super) fn show_walker(&mut self, space: &Arc<StyleSpace>) {
        self.view.bind_mut().show(space);
        self.view.set_visible(true);
    }

    /// Shows which recordings there are and what can be done now.
    pub(super) fn refresh(&mut self, names: impl Iterator<Item = String>, state: State) {
        self.files.clear();
        for name in names {
            self.files.add_item(&name);
        }
        if self.base.get_edited_resource().is_none()
            && let Some(model) = self.base_model()
        {
            self.base.set_edited_resource(&model.upcast::<Resource>());
        }
        let works = state == State::Working;
        self.make.set_disabled(works);
        self.cancel.set_disabled(!works);
        self.give.set_disabled(state != State::Made);
        self.progress.set_visible(works);
    }
}

/// Path of a style of this name.
fn file_of(name: &str) -> String {
    let word = |letter: char| {
        if letter.is_alphanumeric() {
            letter
        } else {
            '_'
        }
    };
    let stem: String = name.trim().to_lowercase().chars().map(word).collect();
    format!("res://styles/{stem}.footstyle")
}

fn add_part(parts: &mut Gd<BoxContainer>, part: &Gd<VBoxContainer>) {
    let mut part = part.clone();
    part.set_h_size_flags(control::SizeFlags::EXPAND_FILL);
    part.set_v_size_flags(control::SizeFlags::EXPAND_FILL);
    parts.add_child(&part);
}

fn label(text: &str) -> Gd<Label> {
    let mut label = Label::new_alloc();
    label.set_text(text);
    label
}

fn button(text: &str, hint: &str) -> Gd<Button> {
    let mut button = Button::new_alloc();
    button.set_text(text);
    button.set_tooltip_text(hint);
    button.set_h_size_flags(control::SizeFlags::EXPAND_FILL);
    button
}

fn row(controls: &[&Gd<Control>]) -> Gd<HBoxContainer> {
    let mut row = HBoxContainer::new_alloc();
    for control in controls {
        row.add_child(*control);
    }
    row
}

/// A control with its name before it.
fn named(rows: &mut Gd<VBoxContainer>, name: &str, control: &Gd<Control>) {
    let mut name = label(name);
    name.set_custom_minimum_size(Vector2::new(56.0, 0.0));
    let mut control = control.clone();
    control.set_h_size_flags(control::SizeFlags::EXPAND_FILL);
    rows.add_child(&row(&[&name.upcast(), &control]));
}
