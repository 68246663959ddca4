//! Contacts, steps and switches on a timeline that can be corrected.

mod timeline;

use crate::job::{self, Job, finished};
use crate::labels::Labels;
use crate::library::Facts;
use crate::palette;
use crate::playback::Playback;
use crate::recovery::{self, UnsavedLabels};
use crate::scene::SceneView;
use crate::shell::Shell;
use crate::views::clips::scene_at;
use eframe::egui::{Context, Key, Modifiers, Panel, Ui, vec2};
use footfall_core::Side;
use footfall_motion::contact_file::ContactFile;
use footfall_motion::phases::{Phase, segment_phases};
use timeline::Timeline;

/// Length of a stance that is added by hand, seconds.
const NEW_STANCE_SECS: f64 = 0.6;

#[derive(Default)]
pub(crate) struct LabelsView {
    opened: u64,
    labels: Option<Labels>,
    timeline: Timeline,
    scene: SceneView,
    /// Corrections that were left unsaved before, by recording.
    recovered: Vec<UnsavedLabels>,
    /// Corrections that are kept already, so that they are not written in every frame.
    kept: Option<UnsavedLabels>,
    /// True when the phases are those of other contacts than the ones that are shown.
    phases_are_old: bool,
    phases: Option<Job<Vec<Phase>>>,
}

impl LabelsView {
    /// Offers corrections that were unsaved when the studio ended last.
    pub(crate) fn offer_recovery(&mut self, kept: Vec<UnsavedLabels>) {
        self.recovered = kept;
    }

    pub(crate) fn is_dirty(&self) -> bool {
        self.labels.as_ref().is_some_and(Labels::is_dirty)
    }

    /// Follows the motion that is shown; keeps what is unsaved.
    pub(crate) fn poll(&mut self, context: &Context, shell: &mut Shell) {
        if self.opened != shell.opened {
            self.opened = shell.opened;
            self.kept = None;
            self.phases = None;
            self.phases_are_old = false;
            self.timeline = Timeline::default();
            self.labels = shell.current.as_ref().map(Labels::of);
        }
        if !self.timeline.is_dragging() {
            self.keep(shell);
        }
        if let (Some(Ok(phases)), Some(motion)) = (finished(&mut self.phases), &mut shell.current) {
            motion.phases = phases;
        }
        self.renew_phases(context, shell);
    }

    /// Phases look at every pose, which takes longer than a frame of the window where there are many.
    fn renew_phases(&mut self, context: &Context, shell: &Shell) {
        let Some(motion) = &shell.current else { return };
        if !self.phases_are_old || self.phases.is_some() {
            return;
        }
        self.phases_are_old = false;
        let clip = motion.clip().clone();
        let contacts = motion.recording.contacts.clone();
        self.phases = Some(job::start(context, "finding phases", move |_| {
            segment_phases(&clip, &contacts)
        }));
    }

    pub(crate) const fn is_busy(&self) -> bool {
        self.phases.is_some()
    }

    /// Keeps unsaved labels where a crash does not reach them.
    pub(crate) fn keep(&mut self, shell: &mut Shell) {
        let (Some(labels), Some(motion)) = (&self.labels, &shell.current) else {
            return;
        };
        let Some(path) = motion.path.as_deref().filter(|_| labels.is_dirty()) else {
            return;
        };
        let kept = UnsavedLabels::new(path, motion.clip().poses.len(), labels.all());
        if self.kept.as_ref() == Some(&kept) {
            return;
        }
        if let Err(error) = recovery::keep(&shell.data_folder, &kept) {
            shell.complain(error);
        }
        self.recovered.retain(|old| old.recording != kept.recording);
        self.recovered.push(kept.clone());
        self.kept = Some(kept);
    }

    /// Writes the corrections beside the recording. Whether they are on disk.
    pub(crate) fn save(&mut self, shell: &mut Shell) -> bool {
        let (Some(labels), Some(motion)) = (&mut self.labels, &shell.current) else {
            return true;
        };
        let Some(path) = motion.path.clone() else {
            shell.complain(
                "this motion has no file yet; export it as BVH and open that file".to_owned(),
            );
            return false;
        };
        let file = ContactFile::beside(&path);
        if let Err(error) = labels.to_file(motion).write(&file) {
            shell.complain(error.to_string());
            return false;
        }
        labels.mark_saved();
        recovery::forget(&shell.data_folder, &path);
        self.recovered.retain(|old| old.recording != path);
        self.kept = None;
        let facts = Facts {
            is_corrected: true,
            ..Facts::of(motion)
        };
        shell.library.update(&path, Ok(facts));
        shell.say(format!(
            "{} written; training uses these contacts from now on",
            file.display()
        ));
        true
    }

    /// Gives up what is unsaved.
    pub(crate) fn discard(&mut self, shell: &mut Shell) {
        if let Some(path) = shell
            .current
            .as_ref()
            .and_then(|motion| motion.path.clone())
        {
            recovery::forget(&shell.data_folder, &path);
            self.recovered.retain(|old| old.recording != path);
        }
        self.kept = None;
        self.labels = shell.current.as_ref().map(Labels::of);
    }

    pub(crate) fn show(&mut self, ui: &mut Ui, shell: &mut Shell, playback: &mut Playback) {
        if shell.current.is_none() {
            ui.centered_and_justified(|ui| {
                ui.weak("Choose a recording in the list to see and correct its contacts.");
            });
            return;
        }
        self.offer(ui, shell);
        self.tools(ui, shell, playback);
        let changed = {
            let (Some(motion), Some(labels)) = (&shell.current, &mut self.labels) else {
                return;
            };
            let (start, end) = (motion.start_secs(), motion.duration_secs());
            playback.advance(ui, start, end);
            playback.keys(ui, start, 1.0 / motion.clip().frame_rate_hz);
            Panel::bottom("timeline")
                .resizable(true)
                .default_size(380.0)
                .show(ui, |ui| {
                    ui.add_space(4.0);
                    playback.controls(ui, start, end, motion.clip().frame_rate_hz);
                    self.timeline.show(ui, motion, labels, playback);
                });
            let size = vec2(ui.available_width(), ui.available_height());
            self.scene
                .show(ui, size, &scene_at(motion, None, playback.secs));
            !self.timeline.is_dragging()
                && Side::BOTH.iter().any(|side| {
                    motion.recording.contacts.foot(*side).stances != labels.stances(*side)
                })
        };
        if changed && let (Some(motion), Some(labels)) = (&mut shell.current, &self.labels) {
            // Steps and footprints follow the corrections.
            motion.recording.correct(labels.all().clone());
            self.phases_are_old = true;
        }
    }

    /// Unsaved labels of this recording from before.
    fn offer(&mut self, ui: &mut Ui, shell: &mut Shell) {
        if self.is_dirty() {
            return;
        }
        let Some(motion) = &shell.current else { return };
        let frames = motion.clip().poses.len();
        let own = |kept: &UnsavedLabels| motion.path.as_ref() == Some(&kept.recording);
        let Some(place) = self.recovered.iter().position(own) else {
            return;
        };
        let (mut takes, mut forgets) = (false, false);
        ui.horizontal(|ui| {
            ui.colored_label(
                palette::PLAYHEAD,
                "Corrections of this recording were not saved last time.",
            );
            takes = ui.button("Recover").clicked();
            forgets = ui.button("Forget").clicked();
        });
        if takes {
            let kept = self.recovered.remove(place);
            match (kept.stances(frames), &mut self.labels) {
                (Some(stances), Some(labels)) => labels.replace(stances),
                _ => shell.complain(
                    "the recording has changed; the corrections no longer fit it".to_owned(),
                ),
            }
        } else if forgets {
            let kept = self.recovered.remove(place);
            recovery::forget(&shell.data_folder, &kept.recording);
        }
    }

    fn tools(&mut self, ui: &mut Ui, shell: &mut Shell, playback: &Playback) {
        let mut saves = ui.input_mut(|i| i.consume_key(Modifiers::COMMAND, Key::S));
        let (Some(motion), Some(labels)) = (&shell.current, &mut self.labels) else {
            return;
        };
        let frame = motion.frame_at(playback.secs);
        let long = (NEW_STANCE_SECS * motion.clip().frame_rate_hz) as usize;
        let mut notice = None;
        ui.horizontal_wrapped(|ui| {
            ui.strong(&motion.name);
            if motion.recording.is_corrected {
                ui.weak("corrected");
            }
            ui.separator();
            let undo = ui.add_enabled(labels.can_undo(), eframe::egui::Button::new("Undo"));
            let redo = ui.add_enabled(labels.can_redo(), eframe::egui::Button::new("Redo"));
            let keys = |ui: &Ui, modifiers, key| ui.input_mut(|i| i.consume_key(modifiers, key));
            let both = Modifiers::COMMAND | Modifiers::SHIFT;
            if redo.on_hover_text("Ctrl+Shift+Z").clicked() || keys(ui, both, Key::Z) {
                labels.redo();
            } else if undo.on_hover_text("Ctrl+Z").clicked() || keys(ui, Modifiers::COMMAND, Key::Z)
            {
                labels.undo();
            }
            for side in Side::BOTH {
                let add = ui.button(format!("Add {} stance", side.name()));
                if add.on_hover_text("At the playhead").clicked() {
                    match labels.add(side, frame, long) {
                        Some(id) => self.timeline.selected = Some(id),
                        None => {
                            notice = Some(format!(
                                "the {} foot already stands at or next to frame {frame}",
                                side.name()
                            ));
                        }
                    }
                }
            }
            let can_remove = self.timeline.selected.is_some();
            let remove = ui.add_enabled(can_remove, eframe::egui::Button::new("Remove stance"));
            if (remove.on_hover_text("Delete").clicked() || keys(ui, Modifiers::NONE, Key::Delete))
                && let Some(id) = self.timeline.selected.take()
            {
                labels.remove(id);
            }
            let detected = ui.button("As detected");
            if detected.on_hover_text("Discard all corrections").clicked() {
                labels.replace(
                    Side::BOTH.map(|side| motion.recording.detected.foot(side).stances.clone()),
                );
            }
            let save = ui.add_enabled(labels.is_dirty(), eframe::egui::Button::new("Save"));
            saves |= save
                .on_hover_text("Beside the recording, for training (Ctrl+S)")
                .clicked();
        });
        if let Some(notice) = notice {
            shell.complain(notice);
        }
        if saves && self.is_dirty() {
            self.save(shell);
        }
    }
}
