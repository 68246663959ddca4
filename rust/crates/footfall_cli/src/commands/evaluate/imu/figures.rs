//! Figures of reconstructed bodies by category, and their lines in a table.

use footfall_core::Behaviour;
use footfall_train::imu::evaluate::ImuTrial;
use serde::Serialize;
use std::collections::BTreeMap;

/// Means over the frames of a category's recordings.
#[derive(Default, Serialize)]
pub(super) struct Figures {
    recordings: usize,
    frames: usize,
    moving_frames: usize,
    live_cm: f64,
    whole_cm: f64,
    /// Standing included.
    live_all_cm: f64,
    whole_all_cm: f64,
    /// Standard deviation of `live_cm` between recordings.
    live_spread_cm: f64,
    /// One pose for all: the mean of the training data.
    constant_cm: f64,
    /// The average course of the true phase at its true time.
    average_cm: f64,
    /// The nearest of the model's poses.
    nearest_cm: f64,
    /// Mean correlation of the joints' coordinates that vary by more than a centimetre, live.
    correlation: f64,
    /// Share of the frames whose behaviour is recognised live.
    recognised: f64,
    /// Acceleration of the joints that one frame in twenty exceeds, m/s²: recorded, and live.
    sudden_m_s2: [f64; 2],
    /// Changes of behaviour, and the median delay with which they are recognised live.
    changes: usize,
    median_delay_s: Option<f64>,
    /// Median bend of the knees while the body stands, degrees: recorded, and live.
    standing_knee_deg: Option<[f32; 2]>,
    /// Of the frames of each behaviour, the share that is recognised live as each.
    confusion: BTreeMap<&'static str, BTreeMap<&'static str, f64>>,
}

impl Figures {
    /// Titles of the columns of a [`line`](Self::line).
    pub(super) fn title() -> String {
        format!(
            "{:28} {:>10} {:>7} {:>6} {:>7} {:>6} {:>5} {:>9} {:>8} {:>8} {:>11} {:>6} {:>16} {:>12}",
            "",
            "recordings",
            "frames",
            "live",
            "spread",
            "whole",
            "r",
            "constant",
            "average",
            "nearest",
            "recognised",
            "delay",
            "standing knee",
            "sudden, m/s²"
        )
    }

    /// Behaviours that each behaviour is taken for, in shares of its frames.
    pub(super) fn confusion_lines(&self) -> Vec<String> {
        let mut lines = vec![format!(
            "{:28} {}",
            "taken live for",
            Behaviour::ALL.map(|b| format!("{:>9}", b.name())).join(" ")
        )];
        lines.extend(self.confusion.iter().map(|(truth, shares)| {
            let share = |b: Behaviour| 100.0 * shares.get(b.name()).copied().unwrap_or(0.0);
            let cells = Behaviour::ALL.map(|b| format!("{:7.0} %", share(b)));
            format!("{truth:28} {}", cells.join(" "))
        }));
        lines
    }

    /// One line of the table.
    pub(super) fn line(&self, category: &str) -> String {
        let delay = self
            .median_delay_s
            .map_or("-".to_owned(), |d| format!("{d:.2} s"));
        let knee = self
            .standing_knee_deg
            .map_or("-".to_owned(), |[truth, live]| {
                format!("{live:.0}° of {truth:.0}°")
            });
        format!(
            "{category:28} {:10} {:7} {:6.2} {:7.2} {:6.2} {:5.2} {:9.2} {:8.2} {:8.2} {:9.0} % {delay:>6} {knee:>16} {:>12}",
            self.recordings,
            self.moving_frames,
            self.live_cm,
            self.live_spread_cm,
            self.whole_cm,
            self.correlation,
            self.constant_cm,
            self.average_cm,
            self.nearest_cm,
            100.0 * self.recognised,
            format!("{:.0} of {:.0}", self.sudden_m_s2[1], self.sudden_m_s2[0]),
        )
    }
}

/// Figures by category, and of all where there are several.
pub(super) fn summarise(trials: &[ImuTrial], categories: &[&str]) -> BTreeMap<String, Figures> {
    let mut names: Vec<&str> = trials.iter().map(|trial| categories[trial.clip]).collect();
    names.sort_unstable();
    names.dedup();
    let all = names.iter().map(|name| {
        let own = trials
            .iter()
            .filter(|trial| categories[trial.clip] == *name);
        ((*name).to_owned(), figures_of(&own.collect::<Vec<_>>()))
    });
    let mut all: BTreeMap<String, Figures> = all.collect();
    if all.len() > 1 {
        all.insert(
            "total".to_owned(),
            figures_of(&trials.iter().collect::<Vec<_>>()),
        );
    }
    all
}

fn figures_of(trials: &[&ImuTrial]) -> Figures {
    let weighed = |weight: fn(&ImuTrial) -> usize, value: fn(&ImuTrial) -> f64| {
        let sum: f64 = trials.iter().map(|t| weight(t) as f64 * value(t)).sum();
        sum / trials.iter().map(|t| weight(t)).sum::<usize>().max(1) as f64
    };
    let moving = |value: fn(&ImuTrial) -> f64| weighed(|t| t.moving, value);
    let all = |value: fn(&ImuTrial) -> f64| weighed(|t| t.frames, value);
    let moved: Vec<f64> = trials
        .iter()
        .filter(|t| t.moving > 0)
        .map(|t| t.live.moving_cm)
        .collect();
    let mean = moved.iter().sum::<f64>() / moved.len().max(1) as f64;
    let squares: f64 = moved.iter().map(|error| (error - mean).powi(2)).sum();
    let mut delays: Vec<f64> = trials
        .iter()
        .flat_map(|t| t.delays_secs.iter().copied())
        .collect();
    delays.sort_by(f64::total_cmp);
    Figures {
        recordings: trials.len(),
        frames: trials.iter().map(|t| t.frames).sum(),
        moving_frames: trials.iter().map(|t| t.moving).sum(),
        live_cm: moving(|t| t.live.moving_cm),
        whole_cm: moving(|t| t.whole.moving_cm),
        live_all_cm: all(|t| t.live.all_cm),
        whole_all_cm: all(|t| t.whole.all_cm),
        live_spread_cm: (squares / moved.len().max(1) as f64).sqrt(),
        correlation: correlation(trials),
        constant_cm: moving(|t| t.trivial.constant),
        average_cm: moving(|t| t.trivial.average),
        nearest_cm: moving(|t| t.trivial.nearest),
        sudden_m_s2: [all(|t| t.sudden_m_s2[0]), all(|t| t.sudden_m_s2[1])],
        recognised: all(|t| t.live.recognised),
        changes: delays.len(),
        median_delay_s: delays.get(delays.len() / 2).copied(),
        standing_knee_deg: standing_knee_deg(trials),
        confusion: confusion(trials),
    }
}

/// Mean over the recordings in which something moves, by their frames.
fn correlation(trials: &[&ImuTrial]) -> f64 {
    let own = trials
        .iter()
        .filter_map(|t| Some((t.moving as f64, t.correlation?)));
    let (sum, weights) = own.fold((0.0, 0.0), |(sum, weights), (weight, value)| {
        (sum + weight * value, weights + weight)
    });
    sum / f64::max(weights, 1.0)
}

fn standing_knee_deg(trials: &[&ImuTrial]) -> Option<[f32; 2]> {
    let median = |which: usize| {
        let knees = trials.iter().flat_map(|t| &t.standing_knees_deg);
        let mut knees: Vec<f32> = knees.map(|knees| knees[which]).collect();
        knees.sort_by(f32::total_cmp);
        knees.get(knees.len() / 2).copied()
    };
    Some([median(0)?, median(1)?])
}

/// Behaviours that occur, each with the shares of what is recognised.
fn confusion(trials: &[&ImuTrial]) -> BTreeMap<&'static str, BTreeMap<&'static str, f64>> {
    let count = |truth: Behaviour, found: Behaviour| -> usize {
        let cells = trials
            .iter()
            .map(|t| t.confusion[truth.index()][found.index()]);
        cells.sum()
    };
    let rows = Behaviour::ALL.into_iter().filter_map(|truth| {
        let all: usize = Behaviour::ALL.iter().map(|b| count(truth, *b)).sum();
        let share = |found: Behaviour| (found.name(), count(truth, found) as f64 / all as f64);
        let shares = Behaviour::ALL.into_iter().map(share);
        (all > 0).then(|| {
            (
                truth.name(),
                shares.filter(|(_, share)| *share > 0.0).collect(),
            )
        })
    });
    rows.collect()
}
