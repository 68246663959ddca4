//! `footfall evaluate orientation`: how well is the vertical known, by our filter, by VQF, and by a gyroscope alone?

mod filters;
mod report;

use crate::commands::imu::parse_site;
use crate::motion_input::SkeletonArgs;
use crate::output;
use anyhow::Result;
use filters::FILTERS;
use footfall_core::{Clip, ModelPose, Site, forward_kinematics};
use footfall_imu::{GRAVITY_MPS2, ImuRecording, csv};
use footfall_motion::corpus::{Where, read_index};
use footfall_motion::virtual_imu::{SensorNoise, VirtualImuConfig, simulate};
use glam::Vec3;
use report::{ByFilter, Report};
use std::path::PathBuf;

/// Filters find the vertical in this time, which is not judged, seconds.
const SETTLING_SECS: f64 = 1.0;

/// Longest rest needed for its mean specific force to be the vertical, seconds.
const REST_SECS: f64 = 0.12;
/// Greatest angular rate of a rest, rad/s, and difference of its specific force from gravity, as a share.
const REST: (f32, f32) = (0.25, 0.03);

/// A sample, and up in the sensor's axes there.
type Truth = (usize, Vec3);

/// Compare the vertical of this project's filter, VQF and a gyroscope alone, live
///
/// Motion: sensors are simulated at a site, with the noise and bias of a consumer sensor, at the recording's own rate. The error is the angle between the estimated
/// and the true vertical, in every frame after the first second. Real sensors (column `path` of the index, an IMU .csv): the truth is known only at
/// rest. The error is the angle between the vertical estimated in the first sample of a rest, after a swing, and the mean specific
/// force of that rest.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  \
    footfall evaluate orientation --corpus index.csv --site right_foot\n  \
    footfall evaluate orientation --sensors sensors.csv")]
#[group(id = "recordings", required = true, multiple = true, args = ["corpus", "sensors"])]
pub(crate) struct OrientationArgs {
    /// Index of the motion recordings
    #[arg(long, value_name = "INDEX.csv")]
    corpus: Option<PathBuf>,
    /// Index of the recordings of real sensors
    #[arg(long, value_name = "SENSORS.csv")]
    sensors: Option<PathBuf>,
    /// Condition on a column of the corpus, for example `category=neutral_walk`; repeatable
    #[arg(long = "where", value_name = "COLUMN=VALUE", requires = "corpus")]
    conditions: Vec<Where>,
    /// Site of the simulated sensors
    #[arg(long, value_parser = parse_site, default_value = "right_foot")]
    site: Site,
    #[command(flatten)]
    fit: SkeletonArgs,
    /// Print one JSON object on stdout
    #[arg(long)]
    json: bool,
}

pub(crate) fn run(args: &OrientationArgs) -> Result<()> {
    output::print_report(args.json, &evaluate(args)?, Report::table)
}

/// The report, as JSON has it.
fn evaluate(args: &OrientationArgs) -> Result<Report> {
    let mut report = Report::default();
    if let Some(index) = &args.corpus {
        let corpus = args.fit.read_corpus(index, &args.conditions)?;
        for (seed, take) in corpus.clips.iter().enumerate() {
            let clip = &take.retargeted.clip;
            let first = take.retargeted.first_frame;
            let (recording, truths) = simulated(clip, first, args.site, seed as u64);
            let filters = report.simulated.entry(take.row.category().to_owned());
            judge(&recording, &truths, filters.or_default());
        }
    }
    if let Some(index) = &args.sensors {
        for row in read_index(index)? {
            let recording = csv::read(&row.path)?.evenly_spaced();
            let filters = report.real.entry(row.category().to_owned());
            judge(&recording, &rests(&recording), filters.or_default());
        }
    }
    report.summarise();
    Ok(report)
}

/// Adds the errors of all filters on one recording, in the samples where the truth is known. A filter is not run where it is known nowhere.
fn judge(recording: &ImuRecording, truths: &[Truth], filters: &mut ByFilter) {
    for (name, verticals) in FILTERS {
        let errors = filters.entry(name).or_default();
        if truths.is_empty() {
            continue;
        }
        let found = verticals(recording);
        let angles = truths.iter();
        errors.extend(angles.map(|(sample, up)| found[*sample].angle_between(*up)));
    }
}

/// A simulated sensor, and the truth in its samples from when the filters have settled.
fn simulated(clip: &Clip, first_frame: usize, site: Site, seed: u64) -> (ImuRecording, Vec<Truth>) {
    let config = VirtualImuConfig {
        noise: Some(SensorNoise::consumer(1.0)),
        seed,
        ..VirtualImuConfig::ideal(clip.frame_rate_hz)
    };
    let recording = simulate(clip, first_frame, site, &config);
    let mut model = ModelPose::default();
    let poses = clip.poses.iter().skip(first_frame).enumerate();
    let settling = (SETTLING_SECS * clip.frame_rate_hz) as usize;
    let truths = poses.take(recording.samples.len()).skip(settling);
    let truths = truths.map(|(sample, pose)| {
        forward_kinematics(&clip.skeleton, pose, &mut model);
        (sample, model.rotation(site.joint()).conjugate() * Vec3::Y)
    });
    let truths = truths.collect();
    (recording, truths)
}

/// First samples of the rests after motion: mean specific force is up there.
fn rests(recording: &ImuRecording) -> Vec<Truth> {
    let rate_hz = recording.rate_hz();
    let least = ((REST_SECS * rate_hz).ceil() as usize).max(2);
    let settling = (SETTLING_SECS * rate_hz) as usize;
    let samples = &recording.samples;
    let rests_at = |n: usize| {
        let sample = &samples[n];
        sample.rate.length() < REST.0 && (sample.force.length() / GRAVITY_MPS2 - 1.0).abs() < REST.1
    };
    let mut found = Vec::new();
    let mut began = 0;
    for n in 0..=samples.len() {
        if n < samples.len() && rests_at(n) {
            continue;
        }
        // The run of resting samples from `began` on ends here.
        if n - began >= least && began > settling {
            let sum: Vec3 = samples[began..n].iter().map(|sample| sample.force).sum();
            found.push((began, sum.normalize()));
        }
        began = n + 1;
    }
    found
}
