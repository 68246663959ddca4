//! Recordings that the project's own model walks, and a studio that shows them.

use eframe::egui::{Context, Vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use footfall_core::Site;
use footfall_imu::csv;
use footfall_model::{GaitModel, GaitStyle};
use footfall_motion::bvh::{self, clip_to_bvh};
use footfall_motion::retarget::{RetargetOptions, retarget};
use footfall_motion::virtual_imu::{VirtualImuConfig, simulate};
use footfall_studio::{Studio, StudioOptions};
use footfall_synth::{WalkConfig, synthesize};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use crate::raster::Raster;

/// A folder with walks, and a data folder of its own.
pub(crate) struct World {
    pub(crate) folder: tempfile::TempDir,
}

/// A file with a pipe in its place.
#[cfg(unix)]
pub(crate) struct HeldFile {
    path: PathBuf,
    content: Vec<u8>,
    pipe: std::fs::File,
}

#[cfg(unix)]
impl HeldFile {
    /// Puts the file back. Who reads the pipe by then comes to its end.
    pub(crate) fn let_go(self) {
        let beside = self.path.with_extension("back");
        std::fs::write(&beside, &self.content).unwrap();
        std::fs::rename(&beside, &self.path).unwrap();
        drop(self.pipe);
    }
}

pub(crate) type Window = Harness<'static, Studio>;

/// The walk that comes with the add-on.
pub(crate) fn shipped(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../../addons/footfall/models")
        .join(name)
}

pub(crate) fn base() -> Arc<GaitModel> {
    let bytes = std::fs::read(shipped("locomotion.footfall")).unwrap();
    Arc::new(GaitModel::from_bytes(&bytes).unwrap())
}

impl World {
    /// Walks of two walkers and a broken file.
    pub(crate) fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let model = base();
        for (walker, speed) in [("anna", 1.1), ("ben", 1.4)] {
            let inner = folder.path().join("clips").join(walker);
            std::fs::create_dir_all(&inner).unwrap();
            for take in 1..=2_u64 {
                let path = inner.join(format!("{walker}_{take}.bvh"));
                let seed = take + walker.len() as u64;
                write_walk(&model, &path, 12, seed, Some(speed), take == 1);
            }
        }
        std::fs::write(folder.path().join("clips/broken.bvh"), "HIERARCHY\nROOT").unwrap();
        Self { folder }
    }

    pub(crate) fn clips(&self) -> PathBuf {
        self.folder.path().join("clips")
    }

    pub(crate) fn clip(&self, name: &str) -> PathBuf {
        self.clips().join(name)
    }

    /// Recording of a phone in the right pocket while somebody walks off.
    pub(crate) fn sensor(&self) -> PathBuf {
        let file = bvh::read(self.clip("anna/anna_1.bvh")).unwrap();
        let motion = retarget(&file, &RetargetOptions::default()).unwrap();
        let recording = simulate(
            &motion.clip,
            motion.first_frame,
            Site::RightThigh,
            &VirtualImuConfig::ideal(100.0),
        );
        let path = self.clip("imu.csv");
        std::fs::write(&path, csv::write(&recording)).unwrap();
        path
    }

    /// Walks in three styles, two each, and the index of them.
    fn styled_walks(&self, takes: u64) -> PathBuf {
        let base = base();
        let mut index = "path,category,style,subject\n".to_owned();
        for name in ["proud", "sad", "drunk"] {
            let bytes = std::fs::read(shipped(&format!("{name}.footstyle"))).unwrap();
            let style = GaitStyle::from_bytes(&bytes).unwrap();
            let styled = Arc::new(base.styled(&[(&style, 1.0)]).unwrap());
            for take in 1..=takes {
                let file = format!("{name}_{take}.bvh");
                write_walk(
                    &styled,
                    &self.folder.path().join(&file),
                    14,
                    take,
                    None,
                    false,
                );
                index.extend([file.as_str(), ",styled_walk,", name, ",carla\n"]);
            }
        }
        let path = self.folder.path().join("index.csv");
        std::fs::write(&path, index).unwrap();
        path
    }

    /// A window that is ready to evaluate so many walks in each of three styles.
    pub(crate) fn evaluation_window(&self, takes: u64) -> Window {
        let index = self.styled_walks(takes);
        let mut window = self.window(&[]);
        click(&mut window, "Evaluate");
        click(&mut window, "Index…");
        assert!(window.state_mut().answer_dialog(index));
        window.run_steps(2);
        window
    }

    /// Holds back a file: whoever reads it waits until it is let go.
    #[cfg(unix)]
    pub(crate) fn hold(&self, file: &str) -> HeldFile {
        let path = self.folder.path().join(file);
        let content = std::fs::read(&path).unwrap();
        std::fs::remove_file(&path).unwrap();
        let made = std::process::Command::new("mkfifo").arg(&path).status();
        assert!(made.unwrap().success());
        // With a writer there is no end, and with both ends in one hand nobody waits for the other.
        let mut both = std::fs::OpenOptions::new();
        let pipe = both.read(true).write(true).open(&path).unwrap();
        HeldFile {
            path,
            content,
            pipe,
        }
    }

    /// A window in which a recorded sensor, worn aligned, moves a body from the beginning on.
    pub(crate) fn sensor_window(&self) -> Window {
        let mut window = self.window(&[]);
        let context = window.ctx.clone();
        window.state_mut().open(&context, &self.sensor());
        window.run_steps(2);
        click(&mut window, "Aligned");
        click(&mut window, "Again");
        window
    }

    /// A window that shows these files; waits until all of them are read.
    pub(crate) fn window(&self, paths: &[PathBuf]) -> Window {
        let options = StudioOptions {
            paths: paths.to_vec(),
            data_folder: Some(self.folder.path().join("data")),
        };
        let blank = Studio::new(&Context::default(), StudioOptions::default());
        let mut window = Harness::builder()
            .with_size(Vec2::new(1280.0, 800.0))
            .with_step_dt(1.0 / 60.0)
            .with_max_steps(400)
            .renderer(Raster::default())
            .build_ui_state(|ui, studio: &mut Studio| studio.frame(ui), blank);
        // Work in the background wakes the window's own context, which there was not before.
        let context = window.ctx.clone();
        *window.state_mut() = Studio::new(&context, options);
        settle(&mut window);
        window
    }
}

fn write_walk(
    model: &Arc<GaitModel>,
    path: &Path,
    steps: usize,
    seed: u64,
    speed_mps: Option<f32>,
    from_standing: bool,
) {
    let config = WalkConfig {
        steps,
        seed,
        variation: 1.0,
        speed_mps,
        turn_rate_radps: 0.0,
        direction_rad: 0.0,
        frame_rate_hz: Some(60.0),
        from_standing,
        gait: footfall_synth::GaitChoice::Auto,
    };
    let walk = synthesize(model, &model.skeleton, &config).unwrap();
    std::fs::write(path, bvh::write(&clip_to_bvh(&walk.clip))).unwrap();
}

/// Begins a design with a shipped sheet.
pub(crate) fn begin_with(window: &mut Window, sheet: &str) {
    window.get_by_value("Begin with…").click();
    window.run_steps(3);
    click(window, sheet);
    settle(window);
}

/// Frames until no work goes on.
pub(crate) fn settle(window: &mut Window) {
    for _ in 0..6000 {
        window.step();
        if !window.state().is_busy() {
            window.run_steps(3);
            return;
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    panic!("work goes on for ever");
}

/// Clicks what has this label.
pub(crate) fn click(window: &mut Window, label: &str) {
    window.get_by_label(label).click();
    window.run_steps(3);
}

/// Content of the style that a button saves.
pub(crate) fn saved_style(window: &mut Window, label: &str, path: PathBuf) -> GaitStyle {
    click(window, label);
    assert!(window.state_mut().answer_dialog(path.clone()));
    window.run_steps(2);
    GaitStyle::from_bytes(&std::fs::read(path).unwrap()).unwrap()
}
