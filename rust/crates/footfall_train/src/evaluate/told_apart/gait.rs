//! Speed, cadence, flight and slip over all walkers.

use super::Walker;
use super::bouts::Bout;
use crate::averages::upper_median;
use crate::evaluate::naturalness::{Slips, slips};
use footfall_core::Clip;
use footfall_motion::steps::Walk;
use rayon::prelude::*;

/// Measures of all bouts.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GaitMeasures {
    /// Every bout.
    pub bouts: Vec<Bout>,
    /// Bouts of each walker who shows any, as one.
    pub walkers: Vec<(String, Bout)>,
    /// Median slip of standing feet, m/s; `None` without a contact long enough.
    pub slip_mps: Option<f64>,
    /// Median slip within 50 ms of the landing, m/s.
    pub landing_slip_mps: Option<f64>,
    /// Absolute error of the speed over the speed that was asked, by walker; empty where none was.
    pub speed_errors: Vec<f64>,
}

impl GaitMeasures {
    /// Measures of walkers.
    pub fn of(walkers: &[Walker]) -> Self {
        let mut all = Self::default();
        let mut all_slips = Slips::default();
        let measured: Vec<(Vec<Bout>, Slips)> = walkers.par_iter().map(measure).collect();
        for (walker, (bouts, slips)) in walkers.iter().zip(measured) {
            if let Some(mean) = mean(&bouts) {
                if let Some(asked) = walker.asked_mps {
                    all.speed_errors
                        .push((mean.speed_mps - asked).abs() / asked);
                }
                all.walkers.push((walker.name.clone(), mean));
            }
            all.bouts.extend(bouts);
            all_slips.standing.extend(slips.standing);
            all_slips.landing.extend(slips.landing);
        }
        all.slip_mps = upper_median(all_slips.standing);
        all.landing_slip_mps = upper_median(all_slips.landing);
        all
    }
}

fn measure(walker: &Walker) -> (Vec<Bout>, Slips) {
    let (mut bouts, mut all) = (Vec::new(), Slips::default());
    for (clip, walks) in &walker.clips {
        for walk in walks {
            bouts.extend(Bout::of(clip, walk));
            let found = slips(&cut(clip, walk));
            all.standing.extend(found.standing);
            all.landing.extend(found.landing);
        }
    }
    (bouts, all)
}

/// A part as a clip of its own.
fn cut(clip: &Clip, walk: &Walk) -> Clip {
    let first = walk.steps.first().map_or(0, |step| step.first);
    let end = walk.steps.last().map_or(0, |step| step.end);
    let poses = clip.poses.get(first..end.min(clip.poses.len()));
    Clip {
        skeleton: clip.skeleton.clone(),
        frame_rate_hz: clip.frame_rate_hz,
        poses: poses.unwrap_or_default().to_vec(),
    }
}

/// Bouts as one, means over time; `None` without any.
fn mean(bouts: &[Bout]) -> Option<Bout> {
    let secs = |bout: &Bout| bout.steps as f64 / bout.cadence_hz;
    let all: f64 = bouts.iter().map(secs).sum();
    let over_time = |of: fn(&Bout) -> f64| {
        let sum: f64 = bouts.iter().map(|bout| of(bout) * secs(bout)).sum();
        sum / all
    };
    (all > 0.0).then(|| Bout {
        steps: bouts.iter().map(|bout| bout.steps).sum(),
        speed_mps: over_time(|bout| bout.speed_mps),
        cadence_hz: over_time(|bout| bout.cadence_hz),
        flight_share: over_time(|bout| bout.flight_share),
    })
}
