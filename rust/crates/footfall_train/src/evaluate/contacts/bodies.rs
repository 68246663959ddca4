//! Contacts of the bodies that a sensor on a foot drives, against the events of a reference.

use super::ContactsError;
use crate::read_model_file;
use footfall_core::{EventKind, Side};
use footfall_imu::events::Swing;
use footfall_imu::{ContactMeter, ImuRecording, ImuSample};
use footfall_model::ImuModel;
use footfall_motion::contacts::{ContactConfig, detect_contacts};
use footfall_recon::{Prepared, ReconConfig, find_mounting, reconstruct_recording};
use glam::Vec3;
use std::path::Path;
use std::sync::Arc;

/// Rate at which bodies are sampled, hertz: they are interpolated between frames.
const LOOK_RATE_HZ: f64 = 100.0;

/// Contact of one foot of a body, on the recording's clock.
#[derive(Clone, Copy, Debug)]
pub(super) struct BodyEvent {
    pub(super) time_secs: f64,
    pub(super) side: Side,
    pub(super) kind: EventKind,
}

/// Contacts of both feet, from a recording of a sensor on one.
pub(super) struct SensorEvents {
    /// Swings of the foot that wears it, as samples come.
    pub(super) swings: Vec<Swing>,
    /// Contacts of the body, live and with what comes later.
    pub(super) live: Vec<BodyEvent>,
    pub(super) whole: Vec<BodyEvent>,
}

/// Model that reconstructs bodies from a sensor on one foot.
pub(super) struct Bodies {
    prepared: Arc<Prepared>,
    worn: Side,
}

impl Bodies {
    /// Reads the model.
    ///
    /// # Errors
    /// [`ContactsError`] for a file that is no model of one sensor on a foot.
    pub(super) fn read(path: &Path) -> Result<Self, ContactsError> {
        let model = read_model_file(path, ImuModel::from_bytes)?;
        let side = match model.sites[..] {
            [site] if site.is_foot() => site.side(),
            _ => None,
        };
        let Some(worn) = side else {
            return Err(ContactsError::file(
                path,
                "the model is not for one sensor on a foot; give one that `footfall imu train --site right_foot` wrote",
            ));
        };
        let prepared =
            Prepared::new(Arc::new(model)).map_err(|error| ContactsError::file(path, error))?;
        Ok(Self {
            prepared: Arc::new(prepared),
            worn,
        })
    }

    /// Swings and bodies that a recording of the sensor on a foot gives, whose mounting is found. Recordings of the model's other foot are mirrored,
    /// and so are their bodies. Errors name `path`, the recording's file.
    pub(super) fn events(
        &self,
        path: &Path,
        recording: &ImuRecording,
        foot: Side,
    ) -> Result<SensorEvents, ContactsError> {
        let mirrored = foot != self.worn;
        let recording = if mirrored {
            mirrored_recording(recording)
        } else {
            recording.clone()
        };
        let config = ReconConfig::default();
        let mounting = find_mounting(&self.prepared, 0, &recording, &config.tracker)
            .map_err(|error| ContactsError::file(path, error))?;
        let turned = [recording.turned(mounting.site_from_sensor)];
        let skeleton = &self.prepared.model().skeleton;
        let body = |live: bool| -> Result<Vec<BodyEvent>, ContactsError> {
            let made = reconstruct_recording(&self.prepared, &turned, skeleton, &config, live)
                .map_err(|error| ContactsError::file(path, error))?;
            if made.clip.poses.len() < 2 {
                return Err(ContactsError::file(
                    path,
                    "the recording is too short for a motion; record some steps",
                ));
            }
            let clip = made.clip.resampled(LOOK_RATE_HZ);
            let contacts = detect_contacts(&clip, &ContactConfig::from_frame(0));
            let events = contacts.events().into_iter().map(|event| BodyEvent {
                time_secs: made.start_secs + event.frame as f64 / LOOK_RATE_HZ,
                side: if mirrored {
                    event.side.other()
                } else {
                    event.side
                },
                kind: event.kind,
            });
            Ok(events.collect())
        };
        Ok(SensorEvents {
            swings: ContactMeter::swings_of(&turned[0]),
            live: body(true)?,
            whole: body(false)?,
        })
    }
}

/// Measurements of the same sensor on the other side of a mirrored body: in a mirror rates turn the other way.
fn mirrored_recording(recording: &ImuRecording) -> ImuRecording {
    let mirror = Vec3::new(-1.0, 1.0, 1.0);
    let samples = recording.samples.iter().map(|sample| ImuSample {
        force: mirror * sample.force,
        rate: -mirror * sample.rate,
        ..*sample
    });
    ImuRecording {
        samples: samples.collect(),
    }
}
