//! Gain of taking walkers out of the average walk, as a report.

use crate::average::EmConfig;
use crate::error::TrainError;
use crate::progress::Progress;
use crate::train::TrainConfig;
use crate::training_comparison::{HeldOutWalker, TrainingComparison, compare_training};
use footfall_motion::corpus::Corpus;
use footfall_prob::windows::Windows;
use serde::Serialize;

/// Frames per second of the models unless others are asked for.
pub const DEFAULT_RATE_HZ: f64 = 60.0;

/// Plain against walker-adaptive training.
#[derive(Clone, Debug, Serialize)]
pub struct TrainingReport {
    /// Mean ln variance of the states' Gaussians, trained plainly.
    pub plain_log_variance: f64,
    /// The same, walker-adaptive.
    pub adaptive_log_variance: f64,
    /// Log density a frame, mean over all frames of unseen walkers, trained plainly.
    pub plain: f64,
    /// The same, with a transform estimated from the walker's other recordings.
    pub plain_adapted: f64,
    /// The same, trained walker-adaptively.
    pub adaptive: f64,
    /// Every unseen walker.
    pub walkers: Vec<HeldOutWalker>,
    /// Recordings that were left out, and why.
    pub skipped: Vec<String>,
}

/// Trains at a frame rate with and without a linear transform of each walker, and scores walkers that were not trained on.
///
/// # Errors
/// As [`compare_training`].
pub fn evaluate_training(
    corpus: &Corpus,
    frame_rate_hz: f64,
    progress: &mut dyn Progress,
) -> Result<TrainingReport, TrainError> {
    let config = TrainConfig {
        frame_rate_hz,
        windows: Windows::Compact,
        mirror: true,
        em: EmConfig {
            max_iterations: 30,
            min_gain_per_frame: 1e-3,
        },
    };
    let comparison = compare_training(&corpus.clips, &config, progress)?;
    Ok(TrainingReport::new(comparison, corpus.report.reasons()))
}

impl TrainingReport {
    fn new(comparison: TrainingComparison, skipped: Vec<String>) -> Self {
        let walkers = comparison.held_out;
        let frames: usize = walkers.iter().map(|walker| walker.frames).sum();
        let mean = |of: fn(&HeldOutWalker) -> f64| {
            let sum: f64 = walkers.iter().map(|w| w.frames as f64 * of(w)).sum();
            sum / frames.max(1) as f64
        };
        Self {
            plain_log_variance: comparison.log_variance[0],
            adaptive_log_variance: comparison.log_variance[1],
            plain: mean(|walker| walker.plain),
            plain_adapted: mean(|walker| walker.plain_adapted),
            adaptive: mean(|walker| walker.adaptive),
            walkers,
            skipped,
        }
    }
}
