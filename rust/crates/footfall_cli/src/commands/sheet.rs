//! `footfall sheet`: motion on one page.

use crate::motion_input::{MapArgs, WalkFigures, read_recording};
use crate::output;
use crate::sheet::{SheetOptions, Subject, draw_sheet};
use anyhow::{Context as _, Result, ensure};
use footfall_core::Side;
use footfall_motion::contact_file::ContactFile;
use footfall_motion::recording::Recording;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder as _};
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Draw motion on one page
///
/// For each file, of any known skeleton: figures at true scale along the floor, the path from above with its footfalls, poses over time
/// from the side and the front, contact bars, and joint curves.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  \
    footfall sheet walk.bvh -o sheet.png\n  \
    footfall sheet captured.bvh synthetic.bvh -o compare.png --seconds 3\n  \
    footfall sheet walk.bvh -o sheet.png --contacts contacts.json      (from `footfall contacts walk.bvh --json`)")]
pub(crate) struct SheetArgs {
    /// One or more recordings, .bvh, .glb or .gltf, drawn one below the other
    #[arg(value_name = "RECORDING", required = true)]
    inputs: Vec<PathBuf>,
    /// Output file for the picture
    #[arg(short, long, value_name = "SHEET.png")]
    output: PathBuf,
    /// Start of the drawing, in seconds from frame 0 [default: the first frame of the motion]
    #[arg(long)]
    start: Option<f64>,
    /// Seconds to draw [default: all]
    #[arg(long)]
    seconds: Option<f64>,
    /// Figures in each pose strip
    #[arg(long, default_value_t = 14, value_parser = clap::value_parser!(u16).range(2..=60))]
    poses: u16,
    /// Width of the picture in pixels
    #[arg(long, default_value_t = 1800, value_parser = clap::value_parser!(u32).range(600..=8000))]
    width: u32,
    /// Contacts to draw instead of detected ones: output of `footfall contacts --json` or `synth --contacts`, one for each
    /// recording
    #[arg(long, value_name = "CONTACTS.json")]
    contacts: Vec<PathBuf>,
    #[command(flatten)]
    map: MapArgs,
    /// Print one JSON object on stdout
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Report<'a> {
    output: &'a Path,
    width: u32,
    height: u32,
    clips: usize,
}

pub(crate) fn run(args: &SheetArgs) -> Result<()> {
    let inputs: Vec<&Path> = args.inputs.iter().map(PathBuf::as_path).collect();
    output::refuse_overwrite(&inputs, &args.output)?;
    ensure!(
        args.contacts.is_empty() || args.contacts.len() == args.inputs.len(),
        "{} recordings but {} files of contacts; pass --contacts once for each recording, in the same order",
        args.inputs.len(),
        args.contacts.len()
    );
    let reading = args.map.read(None)?;
    let mut options = SheetOptions {
        start_secs: args.start.unwrap_or(0.0),
        seconds: args.seconds,
        poses: usize::from(args.poses),
        width: args.width,
    };
    let mut subjects = Vec::new();
    for (index, input) in inputs.into_iter().enumerate() {
        let recording = read_recording(input, &reading)?;
        let note = facts(&recording);
        let motion = recording.retargeted;
        let stances = match args.contacts.get(index) {
            Some(path) => ContactFile::read(path, &motion.clip)?.stances(),
            None => Side::BOTH.map(|side| recording.contacts.foot(side).stances.clone()),
        };
        if args.start.is_none() {
            options.start_secs = motion.first_frame as f64 / motion.clip.frame_rate_hz;
        }
        subjects.push(Subject {
            title: file_name(input),
            note,
            clip: motion.clip,
            stances,
        });
    }
    let (width, height, rgb) = draw_sheet(&subjects, &options)?;
    let mut png = Vec::new();
    PngEncoder::new_with_quality(&mut png, CompressionType::Default, FilterType::Adaptive)
        .write_image(&rgb, width, height, ExtendedColorType::Rgb8)
        .context("the picture is too large for PNG")?;
    output::write_atomic(&args.output, &png)?;
    if args.json {
        return output::print_json(&Report {
            output: &args.output,
            width,
            height,
            clips: subjects.len(),
        });
    }
    output::note(&format!(
        "{}: {width} x {height} pixels, {} clips",
        args.output.display(),
        subjects.len()
    ));
    Ok(())
}

fn file_name(path: &Path) -> String {
    path.file_name()
        .map_or_else(String::new, |name| name.to_string_lossy().into_owned())
}

fn facts(recording: &Recording) -> String {
    let (motion, walking) = (&recording.retargeted, WalkFigures::of(recording));
    let clip = &motion.clip;
    let mut facts = vec![
        motion.report.map.clone(),
        format!(
            "{:.2} s at {} fps",
            clip.duration_secs(),
            clip.frame_rate_hz
        ),
        format!("{:.2} m/s", walking.speed_mps),
        format!("{} steps", recording.step_count()),
    ];
    facts.extend(
        walking
            .cadence_per_min
            .map(|cadence| format!("{cadence:.0} steps/min")),
    );
    facts.join(" · ")
}
