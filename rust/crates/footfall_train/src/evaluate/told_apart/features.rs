//! A stride in numbers that classifiers take.

use super::swings::{PART_COUNT, StrideSwings};
use glam::Vec3;

/// Energies below this are taken for it: a part that capture holds still has no logarithm.
const LEAST_ENERGY: f64 = 1e-12;

/// Features that a classifier sees.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum View {
    /// Shape and smoothness.
    All,
    /// Mean, deviation and range of every swing, and cadence: posture and amplitude.
    Shape,
    /// Energies of second over first and of third over second differences, logarithms, by part.
    Smoothness,
}

impl View {
    /// Every view.
    pub const ALL: [Self; 3] = [Self::All, Self::Shape, Self::Smoothness];

    /// Name in tables.
    pub const fn name(self) -> &'static str {
        match self {
            Self::All => "all",
            Self::Shape => "shape",
            Self::Smoothness => "smoothness",
        }
    }
}

/// Features of a stride.
pub fn of(stride: &StrideSwings, view: View) -> Vec<f64> {
    match view {
        View::All => {
            let mut all = shape(stride);
            all.extend(smoothness(stride));
            all
        }
        View::Shape => shape(stride),
        View::Smoothness => smoothness(stride),
    }
}

fn shape(stride: &StrideSwings) -> Vec<f64> {
    let mut features = Vec::with_capacity(9 * PART_COUNT + 1);
    let count = stride.angles.len() as f64;
    for part in 0..PART_COUNT {
        for axis in 0..3 {
            let values = || {
                let frames = stride.angles.iter();
                frames.map(move |angles| f64::from(angles[part][axis]))
            };
            let mean = values().sum::<f64>() / count;
            let variance = values().map(|v| (v - mean).powi(2)).sum::<f64>() / count;
            let (low, high) = values().fold((f64::MAX, f64::MIN), |(low, high), value| {
                (low.min(value), high.max(value))
            });
            features.extend([mean, variance.sqrt(), high - low]);
        }
    }
    features.push(2.0 / stride.secs);
    features
}

fn smoothness(stride: &StrideSwings) -> Vec<f64> {
    let mut features = Vec::with_capacity(2 * PART_COUNT);
    for part in 0..PART_COUNT {
        let mut values: Vec<Vec3> = stride.angles.iter().map(|angles| angles[part]).collect();
        let energies: [f64; 3] = core::array::from_fn(|_| {
            values = values.windows(2).map(|pair| pair[1] - pair[0]).collect();
            let energy: f64 = values.iter().map(|v| f64::from(v.length_squared())).sum();
            (energy / values.len().max(1) as f64).max(LEAST_ENERGY)
        });
        features.push((energies[1] / energies[0]).ln());
        features.push((energies[2] / energies[0]).ln());
    }
    features
}
