//! `footfall imu reconstruct`: recordings of sensors become the motion of a body.

mod worn_sensors;

use super::read_recording;
use crate::output;
use anyhow::{Context as _, Result, ensure};
use footfall_core::Behaviour;
use footfall_imu::ImuRecording;
use footfall_model::{ImuModel, SensorCalibration};
use footfall_motion::bvh::{self, clip_to_bvh};
use footfall_recon::{Prepared, ReconConfig, reconstruct_recording};
use footfall_train::read_model_file;
use serde::Serialize;
use std::path::PathBuf;
use std::sync::Arc;
use worn_sensors::{ProblemReport, WornSensors};

/// Below this confidence a frame is unexplained; more than this share of a recording is warned of.
const UNEXPLAINED: f32 = 0.1;
const MOST_UNEXPLAINED: f64 = 0.1;

/// Reconstruct the motion of a body from recordings of one or two sensors
///
/// Frame 0 is at the time of the first sample, at the origin, facing +Z. Later samples improve earlier frames;
/// --live shows the result of a game, which cannot know them.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  \
    footfall imu reconstruct --model body.footimu --imu imu.csv -o out.bvh\n  \
    footfall imu reconstruct --model two.footimu --imu foot.csv --imu hand.csv --mounting aligned -o out.bvh\n  \
    footfall imu reconstruct --model body.footimu --imu first.csv --save-calibration me.footcal -o first.bvh\n  \
    footfall imu reconstruct --model body.footimu --imu next.csv --calibration me.footcal -o next.bvh")]
pub(crate) struct ReconstructArgs {
    /// The model
    #[arg(long, value_name = "BODY.footimu")]
    model: PathBuf,
    /// The recording of the sensor; twice for two sensors, in the order of the model's sites
    #[arg(long = "imu", value_name = "IMU.csv", required = true)]
    recordings: Vec<PathBuf>,
    /// Mounting of the sensors
    #[arg(long, value_enum, default_value_t = MountingArg::Auto)]
    mounting: MountingArg,
    /// Calibration of wearer and sensors from an earlier run, used instead of calibrating
    #[arg(long, value_name = "ME.footcal", conflicts_with = "mounting")]
    calibration: Option<PathBuf>,
    /// Output file for the calibration: mounting of the sensors, their values at rest, length of the wearer's steps
    #[arg(long, value_name = "ME.footcal")]
    save_calibration: Option<PathBuf>,
    /// Sample rate that the sensors should deliver; warns about other rates
    #[arg(long, value_name = "HZ")]
    rate: Option<f64>,
    /// Use no later samples: the result at each moment of a game
    #[arg(long)]
    live: bool,
    /// Frames per second of the output; the model's when absent
    #[arg(long)]
    fps: Option<f64>,
    /// Output file
    #[arg(short, long, value_name = "OUT.bvh")]
    output: PathBuf,
    /// Print one JSON object on stdout
    #[arg(long)]
    json: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum MountingArg {
    /// Found from the motion
    Auto,
    /// The sensor's axes are parallel to the model's in the T-pose: x left, y up, z forward
    Aligned,
}

#[derive(Serialize)]
struct Report<'a> {
    output: &'a PathBuf,
    start_s: f64,
    fps: f64,
    frames: usize,
    mountings: Vec<MountingReport>,
    /// Problems of the sensors and of how they were worn, with their times.
    problems: Vec<ProblemReport>,
    /// Length of the wearer's steps beside those of the people in the model.
    stride: f32,
    /// Seconds of each behaviour.
    behaviours: Vec<(&'static str, f64)>,
    /// Mean of how well the model explains the frames, 0 to 1, and seconds in which it explains them so little that the body stands instead.
    confidence: f64,
    unexplained_s: f64,
}

#[derive(Serialize)]
struct MountingReport {
    site: &'static str,
    /// `site_from_sensor` as a quaternion x, y, z, w.
    site_from_sensor: [f32; 4],
    certainty: f32,
}

pub(crate) fn run(args: &ReconstructArgs) -> Result<()> {
    let mut inputs: Vec<&std::path::Path> = vec![&args.model];
    inputs.extend(args.recordings.iter().map(PathBuf::as_path));
    inputs.extend(args.calibration.as_deref());
    output::refuse_overwrite(&inputs, &args.output)?;
    if let Some(path) = &args.save_calibration {
        output::refuse_overwrite(&inputs, path)?;
        output::refuse_overwrite(&[&args.output], path)?;
    }
    if let Some(fps) = args.fps {
        ensure!(
            (1.0..=1000.0).contains(&fps),
            "{fps} frames a second cannot be written; give --fps a number from 1 to 1000"
        );
    }
    let model = read_model_file(&args.model, ImuModel::from_bytes)?;
    let sites: Vec<&'static str> = model.sites.iter().map(|site| site.name()).collect();
    ensure!(
        sites.len() == args.recordings.len(),
        "{}: the model is for {} ({}); give --imu {} times, in this order",
        args.model.display(),
        if sites.len() == 1 {
            "one sensor"
        } else {
            "two sensors"
        },
        sites.join(", "),
        sites.len()
    );
    let skeleton = model.skeleton.clone();
    let prepared =
        Arc::new(Prepared::new(Arc::new(model)).with_context(|| args.model.display().to_string())?);
    let mut config = ReconConfig::default();
    let recordings: Result<Vec<ImuRecording>> = args
        .recordings
        .iter()
        .map(|path| read_recording(path))
        .collect();
    let recordings = recordings?;
    let mut worn = WornSensors::find(args, &prepared, &recordings, &config)?;
    config.stride = worn.calibration.stride;
    let mountings = worn
        .calibration
        .sensors
        .iter()
        .map(|sensor| MountingReport {
            site: sensor.site.name(),
            site_from_sensor: sensor.site_from_sensor.to_array(),
            certainty: sensor.certainty,
        });
    let mountings = mountings.collect();
    let made = reconstruct_recording(&prepared, &worn.recordings, &skeleton, &config, args.live)?;
    ensure!(
        made.clip.poses.len() >= 2,
        "{}: {:.2} s are too short for a motion; give a longer recording",
        args.recordings[0].display(),
        recordings[0].duration_secs()
    );
    let clip = match args.fps {
        Some(fps) => made.clip.resampled(fps),
        None => made.clip,
    };
    output::write_atomic(&args.output, bvh::write(&clip_to_bvh(&clip)).as_bytes())?;
    if let Some(path) = &args.save_calibration {
        worn.calibration.stride = made.stride;
        let bytes = worn.calibration.to_bytes();
        output::write_atomic(path, &bytes.with_context(|| path.display().to_string())?)?;
    }
    let seconds_of = |behaviour: Behaviour| {
        let frames = made.behaviours.iter().filter(|b| **b == behaviour).count();
        frames as f64 / prepared.model().frame_rate_hz
    };
    let unexplained = made.confidences.iter().filter(|c| **c < UNEXPLAINED);
    let unexplained_s = unexplained.count() as f64 / prepared.model().frame_rate_hz;
    if unexplained_s > MOST_UNEXPLAINED * recordings[0].duration_secs() {
        output::note(&format!(
            "warning: the model explains too little of {unexplained_s:.1} s, in which the body stands; check that the sensor is at {} and its mounting, or train on recordings of this motion",
            sites.join(", ")
        ));
    }
    let confidence = made.confidences.iter().map(|c| f64::from(*c)).sum::<f64>();
    let behaviours = Behaviour::ALL.map(|behaviour| (behaviour.name(), seconds_of(behaviour)));
    let report = Report {
        output: &args.output,
        start_s: made.start_secs,
        fps: clip.frame_rate_hz,
        frames: clip.poses.len(),
        mountings,
        problems: worn.problems,
        stride: made.stride,
        behaviours: behaviours
            .into_iter()
            .filter(|(_, secs)| *secs > 0.0)
            .collect(),
        confidence: confidence / made.confidences.len() as f64,
        unexplained_s,
    };
    if args.json {
        return output::print_json(&report);
    }
    let behaviours = report.behaviours.iter();
    let behaviours: Vec<String> = behaviours.map(|(b, s)| format!("{b} {s:.1} s")).collect();
    output::note(&format!(
        "{}: {} frames at {} fps; {}; confidence {:.2}",
        args.output.display(),
        report.frames,
        report.fps,
        behaviours.join(", "),
        report.confidence
    ));
    Ok(())
}

/// Reads a calibration; errors name the file.
pub(in crate::commands) fn read_calibration(path: &std::path::Path) -> Result<SensorCalibration> {
    let bytes = std::fs::read(path).with_context(|| path.display().to_string())?;
    SensorCalibration::from_bytes(&bytes).with_context(|| path.display().to_string())
}
