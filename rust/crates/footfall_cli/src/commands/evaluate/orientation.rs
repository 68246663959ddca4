//! `footfall evaluate orientation`: how well is the vertical known, by our filter, by VQF, and by a gyroscope alone?

mod filters;

use crate::commands::imu::parse_site;
use crate::motion_input::KneesArgs;
use crate::output;
use anyhow::{Result, ensure};
use filters::FILTERS;
use footfall_core::{Clip, ModelPose, Site, forward_kinematics};
use footfall_imu::{GRAVITY_MPS2, ImuRecording, csv};
use footfall_motion::corpus::{Where, read_index};
use footfall_motion::virtual_imu::{SensorNoise, VirtualImuConfig, simulate};
use glam::{Quat, Vec3};
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::PathBuf;

/// Filters find the vertical in this time, which is not judged, seconds.
const SETTLING_SECS: f64 = 1.0;

/// Longest rest needed for its mean specific force to be the vertical, seconds.
const REST_SECS: f64 = 0.12;
/// Greatest angular rate of a rest, rad/s, and difference of its specific force from gravity, as a share.
const REST: (f32, f32) = (0.25, 0.03);

/// Errors of the vertical by this project's filter, VQF and a gyroscope alone, live
///
/// On motion, sensors are simulated at a site, with the noise and bias of a consumer's sensor, at the recording's own rate: the angle between the found
/// vertical and the true one, in every frame but those of the first second. On real sensors (column `path` of the index, an IMU .csv) nobody knows the truth but at
/// rest: the angle between the vertical that was found in the first sample of a rest, when the filter has come through a swing, and the mean specific
/// force of that rest.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  \
    footfall evaluate orientation --corpus index.csv --site right_foot\n  \
    footfall evaluate orientation --sensors sensors.csv")]
#[group(id = "recordings", required = true, multiple = true, args = ["corpus", "sensors"])]
pub(crate) struct OrientationArgs {
    /// Table of the recordings of motion
    #[arg(long, value_name = "INDEX.csv")]
    corpus: Option<PathBuf>,
    /// Table of the recordings of real sensors
    #[arg(long, value_name = "SENSORS.csv")]
    sensors: Option<PathBuf>,
    /// Condition on a column of the corpus, for example `category=neutral_walk`; may repeat
    #[arg(long = "where", value_name = "COLUMN=VALUE", requires = "corpus")]
    conditions: Vec<Where>,
    /// Site of the simulated sensors
    #[arg(long, value_parser = parse_site, default_value = "right_foot")]
    site: Site,
    #[command(flatten)]
    knees: KneesArgs,
    /// Print one JSON object on stdout
    #[arg(long)]
    json: bool,
}

/// Errors of one filter, degrees.
#[derive(Default, Serialize)]
struct Errors {
    count: usize,
    rms_deg: f64,
    median_deg: f64,
    ninety_fifth_deg: f64,
    #[serde(skip)]
    all_deg: Vec<f64>,
}

/// By filter.
type ByFilter = BTreeMap<&'static str, Errors>;

/// The comparison, by category of the recordings.
#[derive(Default, Serialize)]
pub(super) struct Report {
    simulated: BTreeMap<String, ByFilter>,
    real: BTreeMap<String, ByFilter>,
}

pub(crate) fn run(args: &OrientationArgs) -> Result<()> {
    let report = evaluate(args)?;
    if args.json {
        return output::print_json(&report);
    }
    output::print_text(&report.table())
}

/// The report, as JSON has it.
pub(super) fn evaluate(args: &OrientationArgs) -> Result<Report> {
    let mut report = Report::default();
    if let Some(index) = &args.corpus {
        let corpus = args.knees.read_corpus(index, &args.conditions)?;
        for (seed, recording) in corpus.clips.iter().enumerate() {
            let clip = &recording.retargeted.clip;
            let first = recording.retargeted.first_frame;
            let judged = simulated(clip, first, args.site, seed as u64);
            add(&mut report.simulated, recording.row.category(), judged);
        }
    }
    if let Some(index) = &args.sensors {
        for row in read_index(index)? {
            let recording = csv::read(&row.path)?.evenly_spaced();
            ensure!(
                recording.samples.len() > 1,
                "{}: two samples at least are needed to judge a filter",
                row.path.display()
            );
            add(&mut report.real, row.category(), at_rests(&recording));
        }
    }
    for errors in [&mut report.simulated, &mut report.real]
        .into_iter()
        .flat_map(BTreeMap::values_mut)
        .flat_map(BTreeMap::values_mut)
    {
        errors.summarise();
    }
    Ok(report)
}

fn add(
    to: &mut BTreeMap<String, ByFilter>,
    category: &str,
    judged: impl Iterator<Item = (&'static str, Vec<f64>)>,
) {
    let filters = to.entry(category.to_owned()).or_default();
    for (name, errors_deg) in judged {
        filters.entry(name).or_default().all_deg.extend(errors_deg);
    }
}

/// Errors of the filters on a simulated sensor, degrees.
fn simulated(
    clip: &Clip,
    first_frame: usize,
    site: Site,
    seed: u64,
) -> impl Iterator<Item = (&'static str, Vec<f64>)> {
    let config = VirtualImuConfig {
        rate_hz: clip.frame_rate_hz,
        mounting: Quat::IDENTITY,
        noise: Some(SensorNoise::consumer(1.0)),
        seed,
    };
    let recording = simulate(clip, first_frame, site, &config);
    let mut model = ModelPose::default();
    let poses = clip.poses.iter().skip(first_frame);
    let ups: Vec<Vec3> = poses
        .map(|pose| {
            forward_kinematics(&clip.skeleton, pose, &mut model);
            model.rotation(site.joint()).conjugate() * Vec3::Y
        })
        .collect();
    let settling = (SETTLING_SECS * clip.frame_rate_hz) as usize;
    FILTERS.into_iter().map(move |(name, verticals)| {
        let found = verticals(&recording);
        let errors = found.iter().zip(&ups).skip(settling);
        (name, errors.map(|(a, b)| degrees_between(*a, *b)).collect())
    })
}

/// Errors of the filters as a real sensor comes to rest, degrees.
fn at_rests(recording: &ImuRecording) -> impl Iterator<Item = (&'static str, Vec<f64>)> {
    let rests = rests(recording);
    FILTERS.into_iter().map(move |(name, verticals)| {
        let found = verticals(recording);
        let errors = rests.iter();
        let errors = errors.map(|(sample, up)| degrees_between(found[*sample], *up));
        (name, errors.collect())
    })
}

/// First samples of the rests after motion, and up in the sensor's axes there.
fn rests(recording: &ImuRecording) -> Vec<(usize, Vec3)> {
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

fn degrees_between(a: Vec3, b: Vec3) -> f64 {
    f64::from(a.angle_between(b).to_degrees())
}

impl Errors {
    fn summarise(&mut self) {
        self.all_deg.sort_by(f64::total_cmp);
        let errors = &self.all_deg;
        self.count = errors.len();
        if let Some(last) = errors.len().checked_sub(1) {
            let at = |share: f64| errors[(share * last as f64).round() as usize];
            let squares: f64 = errors.iter().map(|error| error * error).sum();
            self.rms_deg = (squares / errors.len() as f64).sqrt();
            self.median_deg = at(0.5);
            self.ninety_fifth_deg = at(0.95);
        }
    }
}

impl Report {
    fn table(&self) -> String {
        let mut text = String::new();
        for (title, categories) in [
            ("Simulated sensors, every frame", &self.simulated),
            ("Real sensors, as they come to rest", &self.real),
        ] {
            if categories.is_empty() {
                continue;
            }
            let _written = writeln!(
                text,
                "{title}: error of the vertical, degrees\n{:<44}{:>8}{:>8}{:>8}{:>8}",
                "category, filter", "count", "rms", "median", "95 %"
            );
            for (category, filters) in categories {
                for (filter, errors) in filters {
                    let _written = writeln!(
                        text,
                        "{:<44}{:>8}{:>8.2}{:>8.2}{:>8.2}",
                        format!("{category}, {filter}"),
                        errors.count,
                        errors.rms_deg,
                        errors.median_deg,
                        errors.ninety_fifth_deg
                    );
                }
            }
        }
        text
    }
}
