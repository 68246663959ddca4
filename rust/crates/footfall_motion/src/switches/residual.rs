//! The projection residual of hip and knee angles, each leg's own.

use super::angles::{CHANNELS, LegAngles, smoothed};
use footfall_core::Side;
use footfall_prob::ProbError;
use footfall_prob::switching::{ProjectionResidual, median};

/// Frames of past and future. The noise of captured angles outweighs what longer windows explain.
const WINDOW: usize = 2;

/// Limit of a residual, in medians: one glitch of capture is not a switch.
const MOST_RESIDUAL: f64 = 4.0;

/// Share of the trailing leg in the residual.
const TRAILING_SHARE: f64 = 0.3;

/// Standard deviation of the window under which the averaged residual is smoothed, frames, and how finely it is looked at.
const SMOOTHING: f64 = 1.0;
const PARTS: usize = 4;

/// The projection residual of each leg over its median.
pub(super) struct Residual {
    /// The frame of the angles that the first value stands for.
    pub(super) first: usize,
    pub(super) legs: [Vec<f64>; 2],
}

impl Residual {
    /// `None` for too few frames.
    pub(super) fn of(angles: &LegAngles) -> Result<Option<Self>, ProbError> {
        let found = ProjectionResidual::new(angles.frames.as_flattened(), CHANNELS, WINDOW);
        let residual = match found {
            Ok(residual) => residual,
            Err(ProbError::SequenceTooShort { .. }) => return Ok(None),
            Err(error) => return Err(error),
        };
        let legs = [0, 1].map(|leg| {
            let mut norms = residual.norms_of(|channel| channel % 2 == leg);
            let level = median(&norms).max(f64::MIN_POSITIVE);
            for norm in &mut norms {
                *norm = (*norm / level).min(MOST_RESIDUAL);
            }
            norms
        });
        Ok(Some(Self {
            first: residual.first_frame(),
            legs,
        }))
    }

    /// Number of frames, the same for all, after which the residual is greatest on average, from `-reach` to `reach`.
    pub(super) fn peak(&self, moments: &[(f64, Side)], reach: f64) -> f64 {
        let parts = (reach * PARTS as f64).round() as isize;
        let offsets: Vec<f64> = (-parts..=parts).map(|n| n as f64 / PARTS as f64).collect();
        let means: Vec<f64> = offsets
            .iter()
            .map(|offset| self.mean(moments, *offset))
            .collect();
        let means = smoothed(&means, SMOOTHING * PARTS as f64);
        offsets
            .iter()
            .zip(&means)
            .max_by(|a, b| a.1.total_cmp(b.1))
            .map_or(0.0, |(offset, _)| *offset)
    }

    /// Mean at these numbers of frames after each moment; 0 without any.
    fn mean(&self, moments: &[(f64, Side)], offset: f64) -> f64 {
        let (mut sum, mut count) = (0.0, 0.0);
        for (moment, side) in moments {
            let own = self.at(*side, moment + offset);
            let other = self.at(side.other(), moment + offset);
            if let (Some(own), Some(other)) = (own, other) {
                sum += (1.0 - TRAILING_SHARE) * own + TRAILING_SHARE * other;
                count += 1.0;
            }
        }
        if count > 0.0 { sum / count } else { 0.0 }
    }

    /// Residual of one leg, between frames.
    fn at(&self, side: Side, frame: f64) -> Option<f64> {
        let column = frame - self.first as f64;
        let leg = &self.legs[side.index()];
        let before = column.floor();
        if before < 0.0 {
            return None;
        }
        let (left, right) = (leg.get(before as usize)?, leg.get(before as usize + 1)?);
        Some(left + (column - before) * (right - left))
    }
}
