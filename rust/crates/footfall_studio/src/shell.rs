//! State that all views share: the list, the motion that is looked at, dialogs and messages.

use crate::job::{self, Job, finished};
use crate::library::{Facts, Library, ListAction};
use crate::model_file::shipped_model;
use crate::motion::Motion;
use crate::palette;
use eframe::egui::{Context, Ui};
use egui_file_dialog::FileDialog;
use footfall_core::Clip;
use footfall_model::GaitModel;
use footfall_motion::bvh::{self, clip_to_bvh};
use footfall_motion::gltf::clip_to_glb;
use footfall_train::read_model_file;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Purpose of a chosen file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Purpose {
    OpenFile,
    OpenFolder,
    /// The model that styles are made from.
    BaseModel,
    /// A style for the mixing pad.
    MixStyle,
    SaveModel,
    SaveStyle,
    /// A style that was designed.
    SaveDesigned,
    SaveMotion,
    /// A walk in the style of a sheet.
    SaveWalk,
    /// A walk of a mixture.
    SaveMix,
    /// A style sheet to begin with.
    OpenSheet,
    SaveSheet,
    /// A recording of a sensor to replay.
    OpenSensor,
    SaveSensor,
    /// Model that turns a sensor's samples into a body.
    SensorModel,
    /// The table of the recordings to judge.
    EvaluateIndex,
    /// The table of what was synthesised.
    EvaluateSynthesised,
    SaveTable,
    SaveChart,
}

/// A message about the last action.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Message {
    pub(crate) text: String,
    pub(crate) is_error: bool,
}

/// Place that a motion is being read for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Place {
    Current,
    Ghost,
}

/// A motion on its way: what for, its file, and the work.
type Reading = (Place, PathBuf, Job<Result<Motion, String>>);

/// State that all views share.
pub(crate) struct Shell {
    pub(crate) library: Library,
    pub(crate) current: Option<Motion>,
    pub(crate) ghost: Option<Motion>,
    /// Counts the motions that were opened, so that views know a new one.
    pub(crate) opened: u64,
    /// Folder of what must outlive a crash.
    pub(crate) data_folder: PathBuf,
    /// The model that styles are made from, and its file.
    pub(crate) base: Option<(PathBuf, Arc<GaitModel>)>,
    looked_for_base: bool,
    /// The last message.
    pub(crate) message: Option<Message>,
    reading: Option<Reading>,
    dialog: Option<(Purpose, FileDialog)>,
    picked: Option<(Purpose, PathBuf)>,
    /// Folder in which the next dialog begins: the one that was used last.
    folder: Option<PathBuf>,
}

impl Shell {
    pub(crate) fn new(data_folder: PathBuf) -> Self {
        Self {
            library: Library::default(),
            current: None,
            ghost: None,
            opened: 0,
            data_folder,
            base: None,
            looked_for_base: false,
            message: None,
            reading: None,
            dialog: None,
            picked: None,
            folder: None,
        }
    }

    /// The model that styles are made from: what was chosen, else the shipped walk if it is near.
    pub(crate) fn base(&mut self) -> Option<Arc<GaitModel>> {
        if self.base.is_none() && !self.looked_for_base {
            self.looked_for_base = true;
            if let Some(path) = shipped_model("locomotion.footfall") {
                self.set_base(&path);
            }
        }
        self.base.as_ref().map(|(_, model)| Arc::clone(model))
    }

    /// Chooses the model that styles are made from.
    pub(crate) fn set_base(&mut self, path: &Path) {
        match read_model_file(path, GaitModel::from_bytes).map_err(|error| error.to_string()) {
            Ok(model) => self.base = Some((path.to_owned(), Arc::new(model))),
            Err(error) => self.complain(error),
        }
    }

    /// Says that something went well.
    pub(crate) fn say(&mut self, text: String) {
        self.message = Some(Message {
            text,
            is_error: false,
        });
    }

    /// Says that something went wrong, and what to do.
    pub(crate) fn complain(&mut self, text: String) {
        self.message = Some(Message {
            text,
            is_error: true,
        });
    }

    /// Does what was asked for in the list.
    pub(crate) fn act(&mut self, context: &Context, action: ListAction) {
        let (place, path) = match action {
            ListAction::Open(path) => (Place::Current, path),
            ListAction::Compare(path) => (Place::Ghost, path),
        };
        let file = path.clone();
        let job = job::start(context, "reading", move |_| {
            Motion::read(&file).map_err(|error| error.to_string())
        });
        self.reading = Some((place, path, job));
    }

    /// Shows a motion that was made here.
    pub(crate) fn show_made(&mut self, motion: Motion) {
        self.current = Some(motion);
        self.opened += 1;
    }

    /// Takes what was read and found.
    pub(crate) fn poll(&mut self) {
        self.library.poll();
        let Some((place, path, job)) = self.reading.take() else {
            return;
        };
        let mut job = Some(job);
        let Some(read) = finished(&mut job) else {
            self.reading = job.map(|job| (place, path, job));
            return;
        };
        match read.flatten() {
            Ok(motion) => {
                self.library.update(&path, Ok(Facts::of(&motion)));
                match place {
                    Place::Current => self.show_made(motion),
                    Place::Ghost => self.ghost = Some(motion),
                }
            }
            Err(error) => {
                self.library.update(&path, Err(error.clone()));
                self.complain(error);
            }
        }
    }

    pub(crate) const fn is_reading(&self) -> bool {
        self.reading.is_some()
    }

    /// Opens a dialog; the answer comes by [`picked`](Self::picked).
    pub(crate) fn ask(&mut self, purpose: Purpose, suggestion: &str) {
        let mut dialog = FileDialog::new().default_file_name(suggestion);
        if let Some(folder) = &self.folder {
            dialog = dialog.initial_directory(folder.clone());
        }
        for (name, extensions) in filters(purpose) {
            dialog = dialog
                .add_file_filter_extensions(name, extensions.to_vec())
                .default_file_filter(name);
        }
        match purpose {
            Purpose::OpenFolder => dialog.pick_directory(),
            Purpose::SaveModel
            | Purpose::SaveStyle
            | Purpose::SaveDesigned
            | Purpose::SaveWalk
            | Purpose::SaveMix
            | Purpose::SaveMotion
            | Purpose::SaveSheet
            | Purpose::SaveSensor
            | Purpose::SaveTable
            | Purpose::SaveChart => dialog.save_file(),
            _ => dialog.pick_file(),
        }
        self.dialog = Some((purpose, dialog));
    }

    /// Shows the dialog that is open.
    pub(crate) fn show_dialog(&mut self, context: &Context) {
        let Some((purpose, dialog)) = &mut self.dialog else {
            return;
        };
        dialog.update(context);
        if let Some(path) = dialog.take_picked() {
            let purpose = *purpose;
            self.remember_folder(&path);
            self.picked = Some((purpose, path));
            self.dialog = None;
        } else if !matches!(dialog.state(), egui_file_dialog::DialogState::Open) {
            self.dialog = None;
        }
    }

    /// The next dialog begins where this file is.
    pub(crate) fn remember_folder(&mut self, path: &Path) {
        let folder = if path.is_dir() {
            Some(path)
        } else {
            path.parent()
        };
        self.folder = folder
            .filter(|folder| !folder.as_os_str().is_empty())
            .and_then(|folder| folder.canonicalize().ok());
    }

    /// Answers the dialog that is open. Whether one was.
    pub(crate) fn answer(&mut self, path: PathBuf) -> bool {
        let asked = self.dialog.take().map(|(purpose, _)| (purpose, path));
        self.picked = asked;
        self.picked.is_some()
    }

    /// The file that was chosen for a purpose.
    pub(crate) fn picked(&mut self, purpose: Purpose) -> Option<PathBuf> {
        self.picked
            .take_if(|(own, _)| *own == purpose)
            .map(|(_, path)| path)
    }

    /// Writes a motion: glTF for `.glb`, else BVH on the canonical body.
    pub(crate) fn write_motion(&mut self, path: &Path, clip: &Clip, name: &str) {
        let is_gltf = path
            .extension()
            .is_some_and(|e| e.eq_ignore_ascii_case("glb"));
        let bytes = if is_gltf {
            clip_to_glb(clip, name)
        } else {
            bvh::write(&clip_to_bvh(clip)).into_bytes()
        };
        self.write(path, &bytes);
    }

    /// Writes a file whole or not at all, and says so.
    pub(crate) fn write(&mut self, path: &Path, bytes: &[u8]) -> bool {
        match footfall_motion::files::write_atomic(path, bytes) {
            Ok(()) => {
                self.say(format!("{} written, {} bytes", path.display(), bytes.len()));
                true
            }
            Err(error) => {
                self.complain(format!(
                    "{}: {error}; check the folder's write permission",
                    path.display()
                ));
                false
            }
        }
    }

    /// The last message, in a bar.
    pub(crate) fn show_message(&mut self, ui: &mut Ui) {
        let Some(message) = &self.message else { return };
        let mut is_read = false;
        ui.horizontal_wrapped(|ui| {
            is_read = ui.small_button("✖").on_hover_text("Dismiss").clicked();
            if message.is_error {
                ui.colored_label(palette::BAD, &message.text);
            } else {
                ui.label(&message.text);
            }
        });
        if is_read {
            self.message = None;
        }
    }
}

fn filters(purpose: Purpose) -> Vec<(&'static str, &'static [&'static str])> {
    match purpose {
        Purpose::OpenFile => vec![("Motion", &["bvh", "csv"])],
        Purpose::BaseModel | Purpose::SaveModel => vec![("Models", &["footfall"])],
        Purpose::MixStyle | Purpose::SaveStyle | Purpose::SaveDesigned => {
            vec![("Styles", &["footstyle"])]
        }
        Purpose::SensorModel => vec![("Sensor models", &["footimu"])],
        Purpose::OpenSheet | Purpose::SaveSheet => vec![("Style sheets", &["toml"])],
        Purpose::OpenSensor
        | Purpose::SaveSensor
        | Purpose::EvaluateIndex
        | Purpose::EvaluateSynthesised
        | Purpose::SaveTable => vec![("Tables", &["csv"])],
        Purpose::OpenFolder
        | Purpose::SaveMotion
        | Purpose::SaveWalk
        | Purpose::SaveMix
        | Purpose::SaveChart => Vec::new(),
    }
}
