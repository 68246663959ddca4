//! Tool: Footfall Studio, a desktop application for motion and styles.
//!
//! Data flow: `library` finds recordings, `motion` is the selected one, `shell` holds the shared state of all `views`, and `app` is
//! the window. `scene` draws bodies, `playback` is the playhead, `curves` the joint angles over time, `labels` the editable
//! contacts. Work that takes longer than a frame is a `job` on a thread of its own.

mod app;
mod curves;
mod evaluation;
mod job;
mod labels;
mod library;
mod model_file;
mod motion;
mod palette;
mod playback;
mod recovery;
mod scene;
mod shell;
mod table;
mod views;

pub use app::{Studio, Tab};

use std::path::PathBuf;

/// Settings of the studio at its start.
#[derive(Clone, Debug, Default)]
pub struct StudioOptions {
    /// Files and folders to open.
    pub paths: Vec<PathBuf>,
    /// Folder of what must outlive a crash; the user's data folder when absent.
    pub data_folder: Option<PathBuf>,
}

/// Opens the window and returns when it is closed.
///
/// # Errors
/// Error of opening the window, with what to do.
pub fn run(options: StudioOptions) -> Result<(), String> {
    let native = eframe::NativeOptions {
        viewport: eframe::egui::ViewportBuilder::default()
            .with_app_id("footfall_studio")
            .with_inner_size([1280.0, 800.0])
            .with_min_inner_size([900.0, 600.0])
            .with_drag_and_drop(true),
        // Smooth edges cost a software renderer half its frames.
        multisampling: if has_graphics_device() { 4 } else { 0 },
        dithering: false,
        ..eframe::NativeOptions::default()
    };
    eframe::run_native(
        "Footfall Studio",
        native,
        Box::new(move |creation| Ok(Box::new(Studio::new(&creation.egui_ctx, options)))),
    )
    .map_err(|error| {
        format!(
            "cannot open a window: {error}; on a machine without a display use `xvfb-run`, and see `footfall doctor`"
        )
    })
}

/// Returns true when pictures are painted by more than the processor, as far as that is known before a window opens.
fn has_graphics_device() -> bool {
    cfg!(not(target_os = "linux")) || std::path::Path::new("/dev/dri").exists()
}
