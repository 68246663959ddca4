//! `ReplayImuSource`: a recording of a sensor that plays in a game.

use footfall_imu::{ImuRecording, check_recording, csv};
use godot::classes::{FileAccess, IResource, Resource};
use godot::prelude::*;
use std::cell::OnceCell;
use std::path::Path;
use std::sync::Arc;

/// Replays the recording of a sensor as if the sensor were worn now.
///
/// The file has the columns `time_s,ax,ay,az,gx,gy,gz`: seconds, specific force in m/s² (including gravity) and angular rate in rad/s, as
/// `footfall imu simulate` writes it, or names and units of other programs, such as `Time (s)`, `Gyroscope X (deg/s)` and `Accelerometer X (g)`. Godot imports `.csv` files as translations: give the file another extension, such as `.imu`, and add it
/// to the export filters.
#[derive(GodotClass)]
#[class(tool, init, base = Resource)]
pub(crate) struct ReplayImuSource {
    /// The file with the recording.
    #[export(file = "*.imu,*.csv")]
    #[var(set = set_file)]
    file: GString,

    /// If `true`, the recording loops; otherwise the sensor falls silent at its end.
    #[export]
    #[init(val = true)]
    repeat: bool,

    /// Recording, once it was asked for.
    read: OnceCell<Result<Arc<ImuRecording>, String>>,
    base: Base<Resource>,
}

#[godot_api]
impl IResource for ReplayImuSource {}

#[godot_api]
impl ReplayImuSource {
    #[func]
    fn set_file(&mut self, file: GString) {
        self.file = file;
        self.read = OnceCell::new();
        self.base_mut().emit_changed();
    }

    /// Returns the problem of the recording, with what to do next; empty if there is none.
    #[func]
    fn get_error(&self) -> GString {
        self.recording()
            .map_or_else(|error| GString::from(&error), |_| GString::new())
    }

    /// Returns the length of the recording in seconds; 0 for an invalid one.
    #[func]
    fn get_length(&self) -> f64 {
        self.recording()
            .map_or(0.0, |recording| recording.duration_secs())
    }
}

impl ReplayImuSource {
    /// The recording.
    ///
    /// # Errors
    /// Text for the user that says what is wrong with it.
    pub(crate) fn recording(&self) -> Result<Arc<ImuRecording>, String> {
        self.read.get_or_init(|| read(&self.file)).clone()
    }

    pub(crate) const fn repeats(&self) -> bool {
        self.repeat
    }
}

fn read(file: &GString) -> Result<Arc<ImuRecording>, String> {
    if file.is_empty() {
        return Err("the ReplayImuSource has no recording. Set its File".to_owned());
    }
    if !FileAccess::file_exists(file) {
        return Err(format!("there is no file {file}"));
    }
    let text = FileAccess::get_file_as_string(file).to_string();
    let recording =
        csv::parse_text(&text, Path::new(&file.to_string())).map_err(|error| error.to_string())?;
    check_recording(&recording).map_err(|error| format!("{file}: {error}"))?;
    Ok(Arc::new(recording))
}
