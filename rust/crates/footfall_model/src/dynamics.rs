//! Gait as a switching system: two linear systems that take turns when a foot lands.
//!
//! *Gait as a switching dynamical system*, sections 3.2 and 4: the pose is a mean plus a few principal components of the
//! features of [`crate::layout`]; their weights are put out by the system of the foot that carries the body.

use crate::check::{ModelError, check_finite, check_len, check_positive};
use crate::layout::FEATURE_COUNT;
use crate::provenance::Provenance;
use footfall_core::{Side, Skeleton};
use footfall_prob::subspace::AffineSystem;
use nalgebra::DVector;

/// Most frames of a segment beyond its recorded length.
pub const SEGMENT_SLACK: usize = 6;

/// Frames of a segment.
const SEGMENT_FRAMES: core::ops::RangeInclusive<usize> = 2..=2000;

/// Rotation vectors are not longer.
const MAX_RADIANS: f64 = 4.0 * core::f64::consts::PI;

/// A gait of a few hundred numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct DynamicsModel {
    /// Frames per second of the systems.
    pub frame_rate_hz: f64,
    /// The body that it was fitted on.
    pub skeleton: Skeleton,
    /// Mean of the static features, [`FEATURE_COUNT`].
    pub mean: Vec<f64>,
    /// Principal components, each [`FEATURE_COUNT`] numbers: by how much a weight of 1 changes each feature.
    pub components: Vec<Vec<f64>>,
    /// The system while the left foot carries the body from its initial contact on, then the right.
    pub regimes: [Regime; 2],
    /// Provenance of the model.
    pub provenance: Provenance,
}

/// One of the two systems, and what its segments were like.
#[derive(Clone, Debug, PartialEq)]
pub struct Regime {
    /// From state to weights of the components.
    pub system: AffineSystem,
    /// States in which segments began.
    pub starts: Vec<Vec<f64>>,
    /// Lengths in frames of the segments that began so.
    pub frames: Vec<usize>,
    /// When the other foot leaves the ground, as a fraction of the segment.
    pub other_terminal: f64,
}

impl Regime {
    /// Mean of the segments' lengths, frames.
    pub fn mean_frames(&self) -> f64 {
        self.frames.iter().sum::<usize>() as f64 / self.frames.len().max(1) as f64
    }

    /// Standard deviation of the segments' lengths, frames.
    pub fn frames_spread(&self) -> f64 {
        let mean = self.mean_frames();
        let squares = self
            .frames
            .iter()
            .map(|frames| (*frames as f64 - mean).powi(2));
        (squares.sum::<f64>() / self.frames.len().max(1) as f64).sqrt()
    }
}

impl DynamicsModel {
    /// The system of a foot.
    pub fn regime(&self, side: Side) -> &Regime {
        &self.regimes[side.index()]
    }

    /// The static features of component weights.
    pub fn features(&self, weights: &[f64]) -> Vec<f64> {
        let mut features = self.mean.clone();
        for (component, weight) in self.components.iter().zip(weights) {
            for (feature, value) in features.iter_mut().zip(component) {
                *feature += weight * value;
            }
        }
        features
    }

    /// Checks every shape and value, so that whatever uses the model afterwards cannot fail on it.
    ///
    /// # Errors
    /// [`ModelError`] names the first part at fault.
    pub fn check(&self) -> Result<(), ModelError> {
        check_positive("frame rate", &[self.frame_rate_hz])?;
        if self.skeleton.check().is_err() {
            return Err(ModelError::Value {
                part: "skeleton".to_owned(),
            });
        }
        check_len("mean pose", &self.mean, FEATURE_COUNT)?;
        check_finite("mean pose", &self.mean)?;
        for component in &self.components {
            check_len("component", component, FEATURE_COUNT)?;
            check_finite("component", component)?;
        }
        for (regime, side) in self.regimes.iter().zip(Side::BOTH) {
            let part = format!("system of the {} foot", side.name());
            let found = regime.system.channels();
            if found != self.components.len() || found == 0 {
                return Err(ModelError::Shape {
                    part,
                    expected: self.components.len().max(1),
                    found,
                });
            }
            for rows in regime.system.to_rows() {
                check_finite(&part, &rows)?;
            }
            if regime.starts.is_empty() {
                return Err(ModelError::Shape {
                    part: format!("states in which the {} foot's segments begin", side.name()),
                    expected: 1,
                    found: 0,
                });
            }
            for start in &regime.starts {
                check_len(&part, start, regime.system.order())?;
                check_finite(&part, start)?;
            }
            if regime.frames.len() != regime.starts.len() {
                return Err(ModelError::Shape {
                    part: format!("lengths of the {} foot's segments", side.name()),
                    expected: regime.starts.len(),
                    found: regime.frames.len(),
                });
            }
            check_finite(&part, &[regime.other_terminal])?;
            self.check_reach(regime, &part)?;
        }
        Ok(())
    }

    /// Nothing is assumed about stability, but within a segment nothing may run away.
    fn check_reach(&self, regime: &Regime, part: &str) -> Result<(), ModelError> {
        for (start, frames) in regime.starts.iter().zip(&regime.frames) {
            if !SEGMENT_FRAMES.contains(frames) {
                return Err(ModelError::Value {
                    part: format!("length of a segment of the {part}"),
                });
            }
            let start = DVector::from_column_slice(start);
            let outputs = regime.system.simulate(&start, frames + SEGMENT_SLACK);
            let mut poses = outputs.chunks_exact(self.components.len());
            if !poses.all(|weights| {
                let features = self.features(weights);
                features.iter().all(|feature| feature.abs() < MAX_RADIANS)
            }) {
                return Err(ModelError::Value {
                    part: format!("motion of the {part}"),
                });
            }
        }
        Ok(())
    }
}
