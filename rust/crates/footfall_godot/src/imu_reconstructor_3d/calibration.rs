//! Calibration and problems of the sensors, for scripts and players.

use super::ImuReconstructor3D;
use super::session::SensorSession;
use footfall_model::SensorCalibration;
use footfall_model::imu_model::MAX_SENSORS;
use footfall_recon::{CalibrationGuide, GuideStep, SensorProblem};
use godot::classes::file_access::ModeFlags;
use godot::classes::{DirAccess, FileAccess};
use godot::global::Error;
use godot::prelude::*;

/// Changes since the last frame.
pub(super) struct Changes {
    /// Problems of the sensors now, and whether each is another than before.
    problems: [(Option<SensorProblem>, bool); MAX_SENSORS],
    step: Option<GuideStep>,
}

impl SensorSession {
    /// Changes since the last frame, to be emitted.
    pub(super) fn changes(&mut self) -> Changes {
        let mut changes = Changes {
            problems: [(None, false); MAX_SENSORS],
            step: None,
        };
        for (n, emitted) in self.problems.iter_mut().enumerate() {
            let problem = self.reconstructor.problem(n);
            let alike = match (&problem, &*emitted) {
                (Some(now), Some(emitted)) => now.is_alike(emitted),
                (now, emitted) => now.is_none() && emitted.is_none(),
            };
            changes.problems[n] = (problem, !alike);
            *emitted = problem;
        }
        let step = self.guide.map(|guide| guide.step());
        changes.step = step.filter(|_| step != self.asked);
        self.asked = step;
        changes
    }
}

impl ImuReconstructor3D {
    /// Emits the signals of what has changed.
    pub(super) fn emit_changes(&mut self, changes: &Changes) {
        for (sensor, (problem, is_news)) in (0_i64..).zip(&changes.problems) {
            if *is_news {
                let name = problem.map_or("", |problem| problem.name());
                let message = problem.map_or_else(String::new, |problem| problem.to_string());
                self.signals().sensor_problem_changed().emit(
                    sensor,
                    &StringName::from(name),
                    &GString::from(&message),
                );
            }
        }
        if let Some(step) = changes.step {
            self.signals().calibration_changed().emit(
                &StringName::from(step.name()),
                &GString::from(step.message()),
            );
        }
    }

    fn sensor_problem(&self, sensor: i64) -> Option<SensorProblem> {
        let sensor = usize::try_from(sensor).ok()?;
        self.session.as_ref()?.reconstructor.problem(sensor)
    }

    fn guide(&self) -> Option<CalibrationGuide> {
        self.session.as_ref()?.guide
    }
}

#[godot_api(secondary)]
impl ImuReconstructor3D {
    /// Returns the problem with a sensor or its mounting; empty if there is none. Meanwhile the body stands or continues as is probable.
    ///
    /// `silent`: no samples. `force_in_g`, `gravity`, `rate_in_degrees`: wrong units or scale. `stuck_axis`, `saturated`: an axis keeps one value, or reaches the end of the sensor's range. `slow`, `pace`: too few samples
    /// for a gait, or far fewer or more than at first. `lies`, `rides`: the sensor lies still, or moves without steps. `unexplained`: motion that the model does not know. `other_side`: worn on the other side
    /// of the body. `turned`: the mounting differs from the calibration or from `mounting`.
    #[func]
    fn get_sensor_problem(&self, #[opt(default = 0)] sensor: i64) -> StringName {
        let problem = self.sensor_problem(sensor);
        StringName::from(problem.map_or("", |problem| problem.name()))
    }

    /// Returns the message for the player about the problem with a sensor, with what to do next; empty if there is none.
    #[func]
    fn get_sensor_message(&self, #[opt(default = 0)] sensor: i64) -> GString {
        let problem = self.sensor_problem(sensor);
        problem.map_or_else(GString::new, |problem| GString::from(&problem.to_string()))
    }

    /// Sets the sample rate that a sensor should deliver, in samples per second; fewer or more are a problem. By default, fewer than at first are.
    #[func]
    fn promise_rate(&mut self, rate: f64, #[opt(default = 0)] sensor: i64) {
        if let (Some(session), Ok(sensor)) = (&mut self.session, usize::try_from(sensor)) {
            session.reconstructor.promise_rate(sensor, rate);
        }
    }

    /// Begins a calibration of about five seconds: the player stands for two seconds and takes four steps. Discards the mounting of the sensors.
    ///
    /// `calibration_changed` reports what to do next. With `mounting` `ALIGNED` there is nothing to calibrate.
    #[func]
    fn start_calibration(&mut self) {
        let Some(session) = &mut self.session else {
            self.calibrates = true;
            return;
        };
        session.forget_mountings();
        session.guide = session.finds_mountings.then(CalibrationGuide::default);
        session.asked = None;
    }

    /// Returns the step of the calibration: `connect`, `stand`, `walk`, `walk_on` or `done`; empty if none was started.
    #[func]
    fn get_calibration_step(&self) -> StringName {
        StringName::from(self.guide().map_or("", |guide| guide.step().name()))
    }

    /// Returns the message for the player about the current step of the calibration.
    #[func]
    fn get_calibration_message(&self) -> GString {
        GString::from(self.guide().map_or("", |guide| guide.step().message()))
    }

    /// Returns the progress of the current step of the calibration, 0 to 1.
    #[func]
    fn get_calibration_progress(&self) -> f64 {
        self.guide()
            .map_or(0.0, |guide| f64::from(guide.progress()))
    }

    /// Saves the mounting of the sensors, their values at rest and the length of the player's steps to a small file for the next session. Returns the problem, or an empty string.
    #[func]
    fn save_calibration(&self, path: GString) -> GString {
        let path = String::from(path);
        let Some(calibration) = self.session.as_ref().and_then(SensorSession::calibration) else {
            return "The mounting of the sensors is not known yet. Calibrate first.".into();
        };
        let bytes = match calibration.to_bytes() {
            Ok(bytes) => PackedByteArray::from(bytes),
            Err(error) => return GString::from(&error.to_string()),
        };
        if written(&path, &bytes) {
            return GString::new();
        }
        GString::from(&format!("Cannot write {path}. Save to user://."))
    }

    /// Loads a saved calibration instead of calibrating. Call it when the sensors are connected. Returns the problem, or an empty string: a file of a later version, for sites other
    /// than the model's or of a sensor other than the connected one is refused.
    #[func]
    fn load_calibration(&mut self, path: GString) -> GString {
        let path = String::from(path);
        let Some(session) = &mut self.session else {
            return "The sensors do not drive the character yet. Load the calibration after the first frame."
                .into();
        };
        if !FileAccess::file_exists(path.as_str()) {
            return GString::from(&format!(
                "There is no file {path}. Calibrate, and save the calibration."
            ));
        }
        let bytes = FileAccess::get_file_as_bytes(path.as_str());
        let read = SensorCalibration::from_bytes(bytes.as_slice());
        let taken = read.and_then(|calibration| session.calibrate(&calibration));
        taken.map_or_else(
            |error| GString::from(&format!("{path}: {error}")),
            |()| GString::new(),
        )
    }

    /// Returns the length of the player's steps relative to those of the people in the model; a foot sensor measures it as they walk.
    #[func]
    fn get_step_scale(&self) -> f64 {
        let session = self.session.as_ref();
        session.map_or(1.0, |session| f64::from(session.reconstructor.stride()))
    }

    /// Sets the length of the player's steps relative to those of the people in the model, 0.7 to 1.4: for a phone in the pocket, which cannot measure it.
    #[func]
    fn set_step_scale(&mut self, scale: f64) {
        if let Some(session) = &mut self.session {
            session.reconstructor.set_stride(scale as f32);
        }
    }
}

/// Writes a file of the game beside its place and then moves it there, so that one that was there is never lost; returns true when it is there.
fn written(path: &str, bytes: &PackedByteArray) -> bool {
    let fresh = format!("{path}.new");
    let file = FileAccess::open(fresh.as_str(), ModeFlags::WRITE);
    let stored = file.is_some_and(|mut file| file.store_buffer(bytes));
    stored && DirAccess::rename_absolute(fresh.as_str(), path) == Error::OK
}
