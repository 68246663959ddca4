//! Figures of reconstructed bodies by category.

use crate::averages::upper_median;
use crate::imu::evaluate::ImuTrial;
use footfall_core::Behaviour;
use serde::Serialize;
use std::collections::BTreeMap;

/// Means over the frames of a category's recordings, over those in which the body moves unless something else is said. Distances are those of the
/// joints, hips and heading brought together.
#[derive(Clone, Debug, Default, Serialize)]
pub struct ImuFigures {
    /// Number of recordings.
    pub recordings: usize,
    /// Number of their frames.
    pub frames: usize,
    /// Number of frames in which the body moves.
    pub moving_frames: usize,
    /// Distance as a game shows it.
    pub live_cm: f64,
    /// Distance with what comes later in the recording.
    pub whole_cm: f64,
    /// The first over all frames.
    pub live_all_cm: f64,
    /// The second over all frames.
    pub whole_all_cm: f64,
    /// Standard deviation of `live_cm` between recordings.
    pub live_spread_cm: f64,
    /// Distance of one pose for all: the mean of the training data.
    pub constant_cm: f64,
    /// Distance of the average course of the true phase at its true time.
    pub average_cm: f64,
    /// Distance of the nearest of the model's poses.
    pub nearest_cm: f64,
    /// Mean correlation of the joints' coordinates that vary by more than a centimetre, live.
    pub correlation: f64,
    /// Share of all frames whose behaviour is recognised live.
    pub recognised: f64,
    /// Acceleration of the joints that one frame in twenty exceeds, m/s²: recorded, and live.
    pub sudden_m_s2: [f64; 2],
    /// Number of changes of behaviour.
    pub changes: usize,
    /// Median delay with which these are recognised live, seconds.
    pub median_delay_s: Option<f64>,
    /// Median bend of the knees while the body stands, degrees: recorded, and live.
    pub standing_knee_deg: Option<[f32; 2]>,
    /// Share of the frames of each behaviour that is recognised live as each behaviour.
    pub confusion: BTreeMap<&'static str, BTreeMap<&'static str, f64>>,
}

/// Figures by category, and of all where there are several.
pub(super) fn by_category(
    trials: &[ImuTrial],
    categories: &[&str],
) -> BTreeMap<String, ImuFigures> {
    let mut names: Vec<&str> = trials.iter().map(|trial| categories[trial.clip]).collect();
    names.sort_unstable();
    names.dedup();
    let all = names.iter().map(|name| {
        let own = trials
            .iter()
            .filter(|trial| categories[trial.clip] == *name);
        ((*name).to_owned(), figures_of(&own.collect::<Vec<_>>()))
    });
    let mut all: BTreeMap<String, ImuFigures> = all.collect();
    if all.len() > 1 {
        all.insert(
            "total".to_owned(),
            figures_of(&trials.iter().collect::<Vec<_>>()),
        );
    }
    all
}

fn figures_of(trials: &[&ImuTrial]) -> ImuFigures {
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
    let delays = || trials.iter().flat_map(|t| t.delays_secs.iter().copied());
    ImuFigures {
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
        changes: delays().count(),
        median_delay_s: upper_median(delays()),
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
