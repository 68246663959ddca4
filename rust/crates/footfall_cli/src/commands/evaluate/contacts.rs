//! `footfall evaluate contacts`: the contact detectors beside each other.

mod sensors;

use crate::output;
use anyhow::{Context as _, Result};
use footfall_core::{EventKind, Side};
use footfall_motion::corpus::{Corpus, CorpusClip, Where};
use footfall_motion::switches::detect_switches;
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::PathBuf;

/// Contacts found by the switching method against others
///
/// On motion: takes the initial contacts that `footfall contacts` finds as the truth and matches the switches of hip and knee angles
/// to them, foot by foot, within a tolerance. An event so near an end of the recording that its other half is not seen is left out.
///
/// On sensors: each row of the index is a recording of one sensor on a foot (`path`, an IMU .csv) with its known events
/// (`events`, a .json like `footfall imu events` prints); initial and terminal contacts are matched apart.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  \
    footfall evaluate contacts --corpus index.csv --where category=neutral_walk\n  \
    footfall evaluate contacts --sensors sensors.csv")]
#[group(id = "truth", required = true, multiple = true, args = ["corpus", "sensors"])]
pub(crate) struct ContactsArgs {
    /// Table of the recordings of motion
    #[arg(long, value_name = "INDEX.csv")]
    corpus: Option<PathBuf>,
    /// Table of the recordings of sensors on feet, with a column `events`
    #[arg(long, value_name = "SENSORS.csv")]
    sensors: Option<PathBuf>,
    /// Condition on a column of the corpus, for example `category=neutral_walk`; may repeat
    #[arg(long = "where", value_name = "COLUMN=VALUE", requires = "corpus")]
    conditions: Vec<Where>,
    /// How far apart two events may be to count as one, milliseconds
    #[arg(long, default_value_t = 33.4)]
    tolerance: f64,
    /// Print one JSON object on stdout
    #[arg(long)]
    json: bool,
}

/// Events nearer to an end than this are left out, seconds.
const EDGE_SECS: f64 = 0.1;

/// Agreement of one category.
#[derive(Default, Serialize)]
pub(super) struct Agreement {
    pub(super) recordings: usize,
    /// Kinematic contacts, or the events of the reference.
    known: usize,
    /// By the switching method.
    found: usize,
    matched: usize,
    f1: f64,
    /// Mean and standard deviation of found less known time over matched events.
    bias_ms: f64,
    spread_ms: f64,
    #[serde(skip)]
    delays_ms: Vec<f64>,
}

#[derive(Serialize)]
pub(super) struct Report {
    tolerance_ms: f64,
    /// Of motion, by category.
    categories: BTreeMap<String, Agreement>,
    /// Of sensors, by category and kind of contact.
    sensors: BTreeMap<String, Agreement>,
}

/// What is printed as JSON.
pub(super) fn evaluate(args: &ContactsArgs) -> Result<Report> {
    let mut report = Report {
        tolerance_ms: args.tolerance,
        categories: BTreeMap::new(),
        sensors: BTreeMap::new(),
    };
    if let Some(index) = &args.corpus {
        for clip in &Corpus::read(index, &args.conditions)?.clips {
            let category = clip.row.category().to_owned();
            let agreement = report.categories.entry(category).or_default();
            agreement
                .add_motion(clip, args.tolerance)
                .with_context(|| clip.row.path.display().to_string())?;
        }
    }
    if let Some(index) = &args.sensors {
        report.sensors = sensors::compare(index, args.tolerance)?;
    }
    let agreements = report.categories.values_mut();
    for agreement in agreements.chain(report.sensors.values_mut()) {
        agreement.summarise();
    }
    Ok(report)
}

pub(crate) fn run(args: &ContactsArgs) -> Result<()> {
    let report = evaluate(args)?;
    if args.json {
        return output::print_json(&report);
    }
    let mut lines = vec![
        format!(
            "Contacts within {} ms; bias and spread of found less known, ms",
            args.tolerance
        ),
        format!(
            "{:36} {:>10} {:>6} {:>6} {:>5} {:>7} {:>7}",
            "known by", "recordings", "known", "found", "F1", "bias", "spread"
        ),
    ];
    for (known, agreements) in [
        ("kinematics", &report.categories),
        ("sensors' reference", &report.sensors),
    ] {
        lines.extend(agreements.iter().map(|(category, agreement)| {
            let name = format!("{known}: {category}");
            format!(
                "{name:36} {:10} {:6} {:6} {:5.2} {:+7.1} {:7.1}",
                agreement.recordings,
                agreement.known,
                agreement.found,
                agreement.f1,
                agreement.bias_ms,
                agreement.spread_ms
            )
        }));
    }
    output::print_text(&lines.join("\n"))
}

impl Agreement {
    fn add_motion(&mut self, clip: &CorpusClip, tolerance_ms: f64) -> Result<()> {
        let motion = &clip.retargeted;
        let rate = motion.clip.frame_rate_hz;
        let secs = |frame: usize| frame as f64 / rate;
        let (first, last) = (secs(motion.first_frame), secs(motion.clip.poses.len() - 1));
        let inside = |time: &f64| (first + EDGE_SECS..=last - EDGE_SECS).contains(time);
        let switches = detect_switches(&motion.clip, motion.first_frame)?;
        let events = clip.contacts.events();
        self.recordings += 1;
        for side in Side::BOTH {
            let known = events
                .iter()
                .filter(|e| e.side == side && e.kind == EventKind::InitialContact)
                .map(|event| secs(event.frame))
                .filter(inside);
            let found = switches
                .iter()
                .filter(|switch| switch.side == side)
                .map(|switch| secs(switch.frame))
                .filter(inside);
            self.add(known.collect(), found.collect(), tolerance_ms);
        }
        Ok(())
    }

    /// Matches times, in seconds: every known one to the nearest found one that is left.
    pub(super) fn add(&mut self, known: Vec<f64>, mut found: Vec<f64>, tolerance_ms: f64) {
        self.known += known.len();
        self.found += found.len();
        for time in known {
            let nearest = (0..found.len()).min_by(|a, b| {
                let [a, b] = [found[*a], found[*b]].map(|found| (found - time).abs());
                a.total_cmp(&b)
            });
            if let Some(index) = nearest {
                let delay_ms = 1000.0 * (found[index] - time);
                if delay_ms.abs() <= tolerance_ms {
                    found.remove(index);
                    self.delays_ms.push(delay_ms);
                }
            }
        }
    }

    fn summarise(&mut self) {
        self.matched = self.delays_ms.len();
        let count = self.matched.max(1) as f64;
        self.f1 = 2.0 * self.matched as f64 / (self.known + self.found).max(1) as f64;
        self.bias_ms = self.delays_ms.iter().sum::<f64>() / count;
        let squares = self.delays_ms.iter().map(|d| (d - self.bias_ms).powi(2));
        self.spread_ms = (squares.sum::<f64>() / count).sqrt();
    }
}
