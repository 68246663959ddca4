//! The times as JSON and as a table.

use super::course::{COURSE, Trial, accelerations};
use footfall_core::Clip;
use footfall_train::evaluate::response::{Manoeuvre, ManoeuvreKind, Travel};
use serde::Serialize;
use std::fmt::Write as _;

/// Generated manoeuvres, and those of takes.
#[derive(Serialize)]
pub(crate) struct Report {
    generated: Vec<Row>,
    captured: Vec<Take>,
}

/// Walkers on one course: medians and the worst.
#[derive(Serialize)]
struct Row {
    course: &'static str,
    walkers: usize,
    /// Number of walks that never reached the request.
    never: usize,
    asked_s: Option<[f64; 2]>,
    moved_s: Option<[f64; 2]>,
    speed_mps: f64,
    /// Largest angle by which a body turned farther than asked, degrees; `None` where it was not to turn.
    beyond_deg: Option<f32>,
    hips_acceleration_mps2: f32,
}

/// Starts, stops and reversals that the hips make in a take, and their greatest acceleration.
#[derive(Serialize)]
pub(super) struct Take {
    name: String,
    starts: Vec<Found>,
    stops: Vec<Found>,
    reversals: Vec<Found>,
    hips_acceleration_mps2: f32,
}

#[derive(Serialize)]
struct Found {
    at_s: f64,
    secs: f64,
    speed_mps: f32,
}

impl Report {
    pub(super) fn new(captured: Vec<Take>, trials: &[Vec<Trial>]) -> Self {
        let rows = COURSE.iter().zip(trials);
        let generated = rows
            .map(|(course, trials)| Row::of(course.name, trials))
            .collect();
        Self {
            generated,
            captured,
        }
    }

    /// The table that people read.
    pub(super) fn table(&self) -> String {
        let mut text = String::from(
            "generated                from the request, s   of the motion, s   speed, m/s   too far   hips, m/s² (99.9 %)\n                          median    worst      median    worst\n",
        );
        for row in &self.generated {
            let pair = |pair: Option<[f64; 2]>| match pair {
                Some([median, worst]) => format!("{median:8.2} {worst:8.2}"),
                None => "       -        -".to_owned(),
            };
            let beyond = match row.beyond_deg {
                Some(beyond) => format!("{beyond:8.0}°"),
                None => "        -".to_owned(),
            };
            let never = match row.never {
                0 => String::new(),
                never => format!("  {never} of {} never reached it", row.walkers),
            };
            let _written = writeln!(
                text,
                "{:24} {} {}   {:9.2} {beyond} {:14.1}{never}",
                row.course,
                pair(row.asked_s),
                pair(row.moved_s),
                row.speed_mps,
                row.hips_acceleration_mps2
            );
        }
        for take in &self.captured {
            let _written = writeln!(
                text,
                "\n{}: hips {:.1} m/s² (99.9 %)",
                take.name, take.hips_acceleration_mps2
            );
            let kinds = [
                ("starts", &take.starts),
                ("stops", &take.stops),
                ("reversals", &take.reversals),
            ];
            for (name, found) in kinds {
                if found.is_empty() {
                    continue;
                }
                let found = found
                    .iter()
                    .map(|found| format!("{:.2} s ({:.1} m/s)", found.secs, found.speed_mps));
                let _written =
                    writeln!(text, "  {name:9} {}", found.collect::<Vec<_>>().join(", "));
            }
        }
        text
    }
}

impl Row {
    fn of(course: &'static str, trials: &[Trial]) -> Self {
        let all = trials
            .iter()
            .flat_map(|trial| trial.accelerations.iter().copied());
        let speeds: f64 = trials.iter().map(|trial| trial.speed_mps).sum();
        Self {
            course,
            walkers: trials.len(),
            never: trials
                .iter()
                .filter(|trial| trial.asked_secs.is_none())
                .count(),
            asked_s: median_and_worst(trials.iter().filter_map(|trial| trial.asked_secs)),
            moved_s: median_and_worst(trials.iter().filter_map(|trial| trial.moved_secs)),
            speed_mps: speeds / trials.len() as f64,
            beyond_deg: trials
                .iter()
                .filter_map(|trial| trial.beyond_rad)
                .reduce(f32::max)
                .map(f32::to_degrees),
            hips_acceleration_mps2: high(all.collect()),
        }
    }
}

impl Take {
    pub(super) fn new(name: &str, clip: &Clip, first: usize, travel: &Travel) -> Self {
        let found = travel.manoeuvres();
        let of = |kind: ManoeuvreKind| {
            let own = found.iter().filter(|found| found.kind == kind);
            own.map(Found::of).collect()
        };
        let poses = clip.poses.get(first..).unwrap_or_default();
        Self {
            name: name.to_owned(),
            starts: of(ManoeuvreKind::Start),
            stops: of(ManoeuvreKind::Stop),
            reversals: of(ManoeuvreKind::Reversal),
            hips_acceleration_mps2: high(accelerations(poses, clip.frame_rate_hz)),
        }
    }
}

impl Found {
    fn of(found: &Manoeuvre) -> Self {
        Self {
            at_s: found.begin_secs,
            secs: found.secs,
            speed_mps: found.speed_mps,
        }
    }
}

fn median_and_worst(values: impl Iterator<Item = f64>) -> Option<[f64; 2]> {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    Some([*values.get(values.len() / 2)?, *values.last()?])
}

/// The value that one in a thousand exceeds.
fn high(mut values: Vec<f32>) -> f32 {
    values.sort_by(f32::total_cmp);
    let at = (values.len() as f64 * 0.999) as usize;
    values
        .get(at.min(values.len().saturating_sub(1)))
        .copied()
        .unwrap_or(0.0)
}
