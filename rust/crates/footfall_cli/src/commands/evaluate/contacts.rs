//! `footfall evaluate contacts`: the contact detectors beside each other.

use crate::output;
use anyhow::{Context as _, Result};
use footfall_core::{EventKind, Side};
use footfall_motion::corpus::{Corpus, CorpusClip, Where};
use footfall_motion::switches::detect_switches;
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::PathBuf;

/// Contacts found by the switching method against the kinematic ones
///
/// Takes the initial contacts that `footfall contacts` finds as the truth and matches the switches of hip and knee angles to
/// them, foot by foot, within a tolerance. An event so near an end of the recording that its other half is not seen is left out.
#[derive(Debug, clap::Args)]
#[command(after_help = "Example:\n  \
    footfall evaluate contacts --corpus index.csv --where category=neutral_walk")]
pub(crate) struct ContactsArgs {
    /// Table of the recordings
    #[arg(long, value_name = "INDEX.csv")]
    corpus: PathBuf,
    /// Condition on a column, for example `category=neutral_walk`; may repeat
    #[arg(long = "where", value_name = "COLUMN=VALUE")]
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
struct Agreement {
    recordings: usize,
    kinematic: usize,
    switching: usize,
    matched: usize,
    f1: f64,
    /// Mean and standard deviation of switching less kinematic time over matched events.
    bias_ms: f64,
    spread_ms: f64,
    #[serde(skip)]
    delays_ms: Vec<f64>,
}

#[derive(Serialize)]
struct Report {
    tolerance_ms: f64,
    categories: BTreeMap<String, Agreement>,
}

pub(crate) fn run(args: &ContactsArgs) -> Result<()> {
    let corpus = Corpus::read(&args.corpus, &args.conditions)?;
    let mut report = Report {
        tolerance_ms: args.tolerance,
        categories: BTreeMap::new(),
    };
    for clip in &corpus.clips {
        let category = clip.row.category().to_owned();
        let agreement = report.categories.entry(category).or_default();
        agreement
            .add(clip, args.tolerance)
            .with_context(|| clip.row.path.display().to_string())?;
    }
    for agreement in report.categories.values_mut() {
        agreement.summarise();
    }
    if args.json {
        return output::print_json(&report);
    }
    let mut lines = vec![format!(
        "Initial contacts within {} ms; bias and spread of switching less kinematic, ms",
        args.tolerance
    )];
    lines.push(format!(
        "{:28} {:>10} {:>9} {:>9} {:>5} {:>7} {:>7}",
        "category", "recordings", "kinematic", "switching", "F1", "bias", "spread"
    ));
    lines.extend(report.categories.iter().map(|(category, agreement)| {
        format!(
            "{category:28} {:10} {:9} {:9} {:5.2} {:+7.1} {:7.1}",
            agreement.recordings,
            agreement.kinematic,
            agreement.switching,
            agreement.f1,
            agreement.bias_ms,
            agreement.spread_ms
        )
    }));
    output::print_text(&lines.join("\n"))
}

impl Agreement {
    fn add(&mut self, clip: &CorpusClip, tolerance_ms: f64) -> Result<()> {
        let motion = &clip.retargeted;
        let rate = motion.clip.frame_rate_hz;
        let secs = |frame: usize| frame as f64 / rate;
        let (first, last) = (secs(motion.first_frame), secs(motion.clip.poses.len() - 1));
        let inside = |time: &f64| (first + EDGE_SECS..=last - EDGE_SECS).contains(time);
        let switches = detect_switches(&motion.clip, motion.first_frame)?;
        let events = clip.contacts.events();
        self.recordings += 1;
        for side in Side::BOTH {
            let known: Vec<f64> = events
                .iter()
                .filter(|e| e.side == side && e.kind == EventKind::InitialContact)
                .map(|event| secs(event.frame))
                .filter(inside)
                .collect();
            let mut found: Vec<f64> = switches
                .iter()
                .filter(|switch| switch.side == side)
                .map(|switch| secs(switch.frame))
                .filter(inside)
                .collect();
            self.kinematic += known.len();
            self.switching += found.len();
            for time in known {
                let nearest = (0..found.len()).min_by(|a, b| {
                    (found[*a] - time)
                        .abs()
                        .total_cmp(&(found[*b] - time).abs())
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
        Ok(())
    }

    fn summarise(&mut self) {
        self.matched = self.delays_ms.len();
        let count = self.matched.max(1) as f64;
        self.f1 = 2.0 * self.matched as f64 / (self.kinematic + self.switching).max(1) as f64;
        self.bias_ms = self.delays_ms.iter().sum::<f64>() / count;
        let squares = self.delays_ms.iter().map(|d| (d - self.bias_ms).powi(2));
        self.spread_ms = (squares.sum::<f64>() / count).sqrt();
    }
}
