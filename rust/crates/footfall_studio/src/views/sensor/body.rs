//! The body that a sensor moves.

use crate::job::{self, Job, finished};
use crate::model_file::shipped_model;
use crate::palette;
use crate::shell::{Purpose, Shell};
use eframe::egui::{Context, Ui};
use footfall_core::{Behaviour, PhaseKind, Pose, Skeleton};
use footfall_imu::{ImuRecording, ImuSample};
use footfall_model::ImuModel;
use footfall_recon::{
    Mounting, Prepared, ReconConfig, Reconstructor, TrackerConfig, find_mounting,
};
use footfall_train::read_model_file;
use glam::Quat;
use std::path::Path;
use std::sync::Arc;

/// Length of the recording that is kept for finding the mounting, seconds.
const REMEMBERED_SECS: f64 = 8.0;

/// Length of the measurement after which the mounting is estimated.
const LEAST_SECS: f64 = 6.0;

/// Less certain than this, the mounting is looked for again.
const CERTAIN: f32 = 0.8;

#[derive(Default)]
pub(super) struct LiveBody {
    name: String,
    prepared: Option<Arc<Prepared>>,
    reconstructor: Option<Reconstructor>,
    pose: Option<Pose>,
    mounting: Option<Mounting>,
    heard: Vec<ImuSample>,
    finding: Option<Job<Result<Mounting, String>>>,
    /// When it was looked for last, on the sensor's clock.
    looked_secs: f64,
    problem: Option<String>,
    /// Probability of each phase of the model.
    phases: Vec<f32>,
}

impl LiveBody {
    pub(super) const fn is_busy(&self) -> bool {
        self.finding.is_some()
    }

    pub(super) const fn is_mounted(&self) -> bool {
        self.mounting.is_some()
    }

    /// The shipped model of a phone in a pocket, where nothing was chosen.
    pub(super) fn load_shipped(&mut self, shell: &mut Shell) {
        if self.prepared.is_none()
            && let Some(path) = ["right_thigh.footimu", "right_foot.footimu"]
                .into_iter()
                .find_map(shipped_model)
        {
            self.load(shell, &path);
        }
    }

    pub(super) fn load(&mut self, shell: &mut Shell, path: &Path) {
        let made = read_model_file(path, ImuModel::from_bytes)
            .map_err(|error| error.to_string())
            .and_then(|model| {
                if model.sites.len() != 1 {
                    return Err(format!(
                        "{}: the model is for {} sensors; the studio connects one at a time",
                        path.display(),
                        model.sites.len()
                    ));
                }
                let prepared = Prepared::new(Arc::new(model));
                prepared.map_err(|error| format!("{}: {error}", path.display()))
            });
        match made {
            Ok(prepared) => {
                self.prepared = Some(Arc::new(prepared));
                let name = path.file_name().unwrap_or_default().to_string_lossy();
                self.name = name.into_owned();
                self.mounting = None;
                self.restart();
            }
            Err(error) => shell.complain(error),
        }
    }

    /// Another sensor: what was heard says nothing any more.
    pub(super) fn restart(&mut self) {
        self.heard.clear();
        self.finding = None;
        self.problem = None;
        self.looked_secs = f64::NEG_INFINITY;
        self.reconstructor = self.prepared.as_ref().and_then(|prepared| {
            let skeleton = &prepared.model().skeleton;
            let mut made = Reconstructor::new(prepared, skeleton, &ReconConfig::default()).ok()?;
            if let Some(mounting) = self.mounting {
                made.set_mounting(0, mounting.site_from_sensor);
            }
            Some(made)
        });
        self.pose = self
            .prepared
            .as_ref()
            .map(|prepared| Pose::rest(&prepared.model().skeleton));
    }

    pub(super) fn push(&mut self, sample: ImuSample) {
        if !sample.is_finite() {
            return;
        }
        if let Some(reconstructor) = self
            .reconstructor
            .as_mut()
            .filter(|_| self.mounting.is_some())
        {
            reconstructor.push(0, sample);
        }
        self.heard.push(sample);
        let begin = sample.time_secs - REMEMBERED_SECS;
        // Now and then, not with every sample: the rest moves up each time.
        if self
            .heard
            .first()
            .is_some_and(|first| first.time_secs < begin - 2.0)
        {
            self.heard.retain(|old| old.time_secs >= begin);
        }
    }

    pub(super) fn step(&mut self, dt_secs: f32) {
        if let (Some(reconstructor), Some(pose)) = (&mut self.reconstructor, &mut self.pose)
            && self.mounting.is_some()
        {
            reconstructor.step(dt_secs, pose);
        }
    }

    pub(super) fn poll(&mut self) {
        match finished(&mut self.finding).map(Result::flatten) {
            Some(Ok(mounting)) => {
                self.problem = None;
                let is_better = self
                    .mounting
                    .is_none_or(|old| mounting.certainty >= old.certainty);
                if is_better {
                    self.set_mounting(mounting);
                }
            }
            Some(Err(error)) => self.problem = Some(error),
            None => {}
        }
    }

    fn set_mounting(&mut self, mounting: Mounting) {
        self.mounting = Some(mounting);
        if let Some(reconstructor) = &mut self.reconstructor {
            reconstructor.set_mounting(0, mounting.site_from_sensor);
        }
    }

    pub(super) fn shown(&self) -> Option<(&Skeleton, Pose)> {
        let prepared = self.prepared.as_ref()?;
        Some((&prepared.model().skeleton, self.pose.clone()?))
    }

    pub(super) fn behaviours(&self) -> [f32; Behaviour::ALL.len()] {
        self.reconstructor
            .as_ref()
            .map_or([0.0; Behaviour::ALL.len()], |made| *made.behaviours())
    }

    /// The most probable phases, the most probable first.
    pub(super) fn phases(&mut self, most: usize) -> Vec<(PhaseKind, f32)> {
        let (Some(prepared), Some(reconstructor)) = (&self.prepared, &self.reconstructor) else {
            return Vec::new();
        };
        reconstructor.phase_probabilities(&mut self.phases);
        let kinds = prepared.model().phases.iter().copied();
        let mut phases: Vec<(PhaseKind, f32)> = kinds.zip(self.phases.iter().copied()).collect();
        phases.sort_by(|a, b| b.1.total_cmp(&a.1));
        phases.truncate(most);
        phases
    }

    pub(super) fn settings(&mut self, ui: &mut Ui, shell: &mut Shell) {
        ui.horizontal(|ui| {
            if ui.button("Sensor model…").clicked() {
                shell.ask(Purpose::SensorModel, "");
            }
            ui.weak(if self.name.is_empty() {
                "none"
            } else {
                &self.name
            });
        });
        let Some(prepared) = &self.prepared else {
            return;
        };
        let sites: Vec<&str> = prepared
            .model()
            .sites
            .iter()
            .map(|site| site.name())
            .collect();
        ui.label(format!("Worn at: {}", sites.join(", ").replace('_', " ")));
        let secs = match (self.heard.first(), self.heard.last()) {
            (Some(first), Some(last)) => last.time_secs - first.time_secs,
            _ => 0.0,
        };
        let now = self.heard.last().map_or(0.0, |last| last.time_secs);
        match (self.mounting, &self.finding) {
            (_, Some(job)) => job::show(job, ui),
            (Some(mounting), None) => {
                ui.colored_label(
                    if mounting.certainty < CERTAIN {
                        palette::PLAYHEAD
                    } else {
                        palette::GOOD
                    },
                    format!(
                        "mounting known, {:.0} % certain",
                        100.0 * mounting.certainty
                    ),
                );
            }
            (None, None) => {
                ui.label(format!(
                    "Wear it, stand for a moment, then walk: {:.0} of {LEAST_SECS:.0} s heard",
                    secs.min(LEAST_SECS)
                ));
            }
        }
        if let Some(problem) = &self.problem {
            ui.colored_label(palette::BAD, problem);
        }
        let is_uncertain = self
            .mounting
            .is_none_or(|mounting| mounting.certainty < CERTAIN);
        let is_due = is_uncertain && secs >= LEAST_SECS && now - self.looked_secs > LEAST_SECS;
        let mut looks = is_due && self.finding.is_none();
        ui.horizontal(|ui| {
            let can = self.finding.is_none() && secs >= 2.0;
            looks |= ui
                .add_enabled(can, eframe::egui::Button::new("Find mounting"))
                .on_hover_text("From the last seconds; walk a few steps first")
                .clicked();
            if ui
                .button("Aligned")
                .on_hover_text(
                    "The sensor's axes are the body's: x left, y up, z forward in the T-pose",
                )
                .clicked()
            {
                self.set_mounting(Mounting {
                    site_from_sensor: Quat::IDENTITY,
                    certainty: 1.0,
                });
            }
            if ui
                .button("Face ahead")
                .on_hover_text("Take the body's current direction as straight ahead")
                .clicked()
                && let Some(reconstructor) = &mut self.reconstructor
            {
                reconstructor.reset_heading(0.0);
            }
        });
        if looks {
            self.look(ui.ctx(), now);
        }
    }

    fn look(&mut self, context: &Context, now: f64) {
        let Some(prepared) = self.prepared.clone() else {
            return;
        };
        self.looked_secs = now;
        let recording = ImuRecording {
            samples: self.heard.clone(),
        };
        self.finding = Some(job::start(context, "finding the mounting", move |_| {
            find_mounting(&prepared, 0, &recording, &TrackerConfig::default())
                .map_err(|error| error.to_string())
        }));
    }
}
