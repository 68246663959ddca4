//! `footfall imu reconstruct`: recordings of sensors become the motion of a body.

use super::read_recording;
use crate::output;
use anyhow::{Context as _, Result, ensure};
use footfall_core::Behaviour;
use footfall_imu::ImuRecording;
use footfall_model::ImuModel;
use footfall_motion::bvh::{self, clip_to_bvh};
use footfall_recon::{Mounting, Prepared, ReconConfig, find_mounting, reconstruct_recording};
use footfall_train::read_model_file;
use serde::Serialize;
use std::path::PathBuf;
use std::sync::Arc;

/// A mounting that is less certain is warned of.
const CERTAIN: f32 = 0.9;

/// Below this confidence a frame is unexplained; more than this share of a recording is warned of.
const UNEXPLAINED: f32 = 0.1;
const MOST_UNEXPLAINED: f64 = 0.1;

/// Reconstruct the motion of a body from what one or two sensors on it measured
///
/// Frame 0 is at the time of the first sample, at the origin, facing +Z. What comes later in the recording helps with what comes
/// before; --live shows what a game sees, which cannot know.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  \
    footfall imu reconstruct --model body.footimu --imu imu.csv -o out.bvh\n  \
    footfall imu reconstruct --model two.footimu --imu foot.csv --imu hand.csv --mounting aligned -o out.bvh")]
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
    /// Use nothing of the future: what a game shows at each moment
    #[arg(long)]
    live: bool,
    /// Frames per second of the output; the model's when absent
    #[arg(long)]
    fps: Option<f64>,
    /// File to write
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
    output::refuse_overwrite(&inputs, &args.output)?;
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
    let config = ReconConfig::default();
    let (mut recordings, mut mountings) = (Vec::new(), Vec::new());
    for (sensor, path) in args.recordings.iter().enumerate() {
        let recording = read_recording(path)?;
        let mounting = mounting(args, &prepared, sensor, &recording, &config)
            .with_context(|| path.display().to_string())?;
        if mounting.certainty < CERTAIN {
            output::note(&format!(
                "warning: {}: the mounting is only {:.0} % certain; record more steps, or give --mounting aligned",
                path.display(),
                100.0 * mounting.certainty
            ));
        }
        recordings.push(recording.turned(mounting.site_from_sensor));
        mountings.push(MountingReport {
            site: prepared.model().sites[sensor].name(),
            site_from_sensor: mounting.site_from_sensor.to_array(),
            certainty: mounting.certainty,
        });
    }
    let made = reconstruct_recording(&prepared, &recordings, &skeleton, &config, args.live)?;
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
    let seconds_of = |behaviour: Behaviour| {
        let frames = made.behaviours.iter().filter(|b| **b == behaviour).count();
        frames as f64 / prepared.model().frame_rate_hz
    };
    let unexplained = made.confidences.iter().filter(|c| **c < UNEXPLAINED);
    let unexplained_s = unexplained.count() as f64 / prepared.model().frame_rate_hz;
    if unexplained_s > MOST_UNEXPLAINED * recordings[0].duration_secs() {
        output::note(&format!(
            "warning: the model explains {unexplained_s:.1} s so little that the body stands there; check that the sensor sits at {} and how it is mounted, or train with recordings of what is done",
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

fn mounting(
    args: &ReconstructArgs,
    prepared: &Arc<Prepared>,
    sensor: usize,
    recording: &ImuRecording,
    config: &ReconConfig,
) -> Result<Mounting> {
    if args.mounting == MountingArg::Aligned {
        return Ok(Mounting {
            site_from_sensor: glam::Quat::IDENTITY,
            certainty: 1.0,
        });
    }
    Ok(find_mounting(prepared, sensor, recording, &config.tracker)?)
}
