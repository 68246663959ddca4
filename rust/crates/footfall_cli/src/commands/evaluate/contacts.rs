//! `footfall evaluate contacts`: the contact detectors beside each other.

mod bodies;
mod people;
mod sensors;

use crate::motion_input::KneesArgs;
use crate::output;
use anyhow::{Context as _, Result};
use bodies::Bodies;
use footfall_core::{EventKind, Side};
use footfall_motion::corpus::Where;
use footfall_motion::recording::Recording;
use footfall_motion::switches::{Landing, detect_switches_by};
use footfall_prob::switching::median;
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::PathBuf;

/// Contacts of people's feet, found in three ways, against others
///
/// On motion, person by person (column `subject`): the contacts that `footfall contacts` finds against those of Zeni et al. 2008 within
/// 50 ms, where the person walks straight ahead; and the switches of hip and knee angles against the initial contacts that `footfall
/// contacts` finds, foot by foot, within a tolerance. An event so near an end of the recording that its other half is not seen is left out.
///
/// On sensors: each row of the index is a recording of one sensor on a foot (`path`, an IMU .csv) with its known events
/// (`events`, a .json like `footfall imu events` prints); initial and terminal contacts are matched apart. With --model the bodies that the sensors
/// drive are judged as well, both feet; the column `foot` then says which foot wears the sensor, where the events are of both.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  \
    footfall evaluate contacts --corpus index.csv --where category=neutral_walk\n  \
    footfall evaluate contacts --corpus index.csv --where category=neutral_walk --leave-one-out --ablate\n  \
    footfall evaluate contacts --sensors sensors.csv")]
#[group(id = "truth", required = true, multiple = true, args = ["corpus", "sensors"])]
pub(crate) struct ContactsArgs {
    /// Table of the recordings of motion
    #[arg(long, value_name = "INDEX.csv")]
    corpus: Option<PathBuf>,
    /// Table of the recordings of sensors on feet, with a column `events`
    #[arg(long, value_name = "SENSORS.csv")]
    sensors: Option<PathBuf>,
    /// Model for a sensor on one foot; contacts of the bodies that it reconstructs are judged as well, live and whole
    #[arg(long, value_name = "FOOT.footimu", requires = "sensors")]
    model: Option<PathBuf>,
    /// Condition on a column of the corpus, for example `category=neutral_walk`; may repeat
    #[arg(long = "where", value_name = "COLUMN=VALUE", requires = "corpus")]
    conditions: Vec<Where>,
    /// Choose the detector's limits on the other people for each person who is judged
    #[arg(long, requires = "corpus")]
    leave_one_out: bool,
    /// Switches without the parts that place them, and with the projection residual, beside them
    #[arg(long, requires = "corpus")]
    ablate: bool,
    #[command(flatten)]
    knees: KneesArgs,
    /// Largest difference at which switches or events of sensors count as the same as others, milliseconds
    #[arg(long, default_value_t = 33.4)]
    tolerance: f64,
    /// Print one JSON object on stdout
    #[arg(long)]
    json: bool,
}

/// Events nearer to an end than this are left out, seconds.
const EDGE_SECS: f64 = 0.1;

/// Agreement of one category.
#[derive(Clone, Default, Serialize)]
pub(super) struct Agreement {
    pub(super) recordings: usize,
    /// Events of the reference.
    known: usize,
    /// Events of what is judged.
    found: usize,
    matched: usize,
    f1: f64,
    /// Mean, median and standard deviation of found less known time over matched events.
    bias_ms: f64,
    median_ms: f64,
    spread_ms: f64,
    #[serde(skip)]
    delays_ms: Vec<f64>,
}

#[derive(Serialize)]
pub(super) struct Report {
    tolerance_ms: f64,
    /// Of motion, by person.
    people: BTreeMap<String, people::Person>,
    /// Switches of motion against contacts, by category.
    categories: BTreeMap<String, Agreement>,
    /// The same by what places a switch, with `--ablate`.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    ablation: BTreeMap<&'static str, people::Ablated>,
    /// Of sensors, by category and kind of contact.
    sensors: BTreeMap<String, Agreement>,
}

/// Evaluates, and returns the report that is printed as JSON.
pub(super) fn evaluate(args: &ContactsArgs) -> Result<Report> {
    let mut report = Report {
        tolerance_ms: args.tolerance,
        people: BTreeMap::new(),
        categories: BTreeMap::new(),
        ablation: BTreeMap::new(),
        sensors: BTreeMap::new(),
    };
    if let Some(index) = &args.corpus {
        let clips = args.knees.read_corpus(index, &args.conditions)?.clips;
        for clip in &clips {
            let category = clip.row.category().to_owned();
            let agreement = report.categories.entry(category).or_default();
            agreement.add_switches(clip, Landing::default(), args.tolerance)?;
        }
        report.people = people::judge(&clips, args.tolerance, args.leave_one_out)?;
        if args.ablate {
            report.ablation = people::ablate(&clips, args.tolerance)?;
        }
    }
    if let Some(index) = &args.sensors {
        let bodies = args.model.as_deref().map(Bodies::read).transpose()?;
        report.sensors = sensors::compare(index, bodies.as_ref(), args.tolerance)?;
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
    let mut lines = people::table(&report.people, args.tolerance);
    lines.extend(people::ablation_table(&report.ablation));
    lines.extend([
        format!(
            "Contacts within {} ms; bias and spread of found less known, ms",
            args.tolerance
        ),
        format!(
            "{:36} {:>10} {:>6} {:>6} {:>5} {:>7} {:>7}",
            "known by", "recordings", "known", "found", "F1", "bias", "spread"
        ),
    ]);
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
    /// Switches of a clip against its initial contacts.
    fn add_switches(
        &mut self,
        clip: &Recording,
        landing: Landing,
        tolerance_ms: f64,
    ) -> Result<()> {
        let motion = &clip.retargeted;
        let rate = motion.clip.frame_rate_hz;
        let secs = |frame: usize| frame as f64 / rate;
        let (first, last) = (secs(motion.first_frame), secs(motion.clip.poses.len() - 1));
        let inside = |time: &f64| (first + EDGE_SECS..=last - EDGE_SECS).contains(time);
        let switches = detect_switches_by(&motion.clip, motion.first_frame, landing)
            .with_context(|| clip.row.path.display().to_string())?;
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
        self.median_ms = median(&self.delays_ms);
        let squares = self.delays_ms.iter().map(|d| (d - self.bias_ms).powi(2));
        self.spread_ms = (squares.sum::<f64>() / count).sqrt();
    }
}
