//! Detail of captured steps beyond the trajectories of their states.
//!
//! A trajectory that is the likeliest one through five Gaussians a step is too smooth: edges that all steps have in common are rounded, and
//! what differs from step to step within a state is gone. Both are added to it after it is solved: tables over the step's phase for
//! what repeats, and coloured noise for what does not.

use crate::check::{ModelError, check_finite, check_len, check_positive};
use crate::layout::FEATURE_COUNT;

/// Points of a table over a step, equally spaced in time; the next step's table goes on where this one ends.
pub const FINE_POINTS: usize = 12;

/// Points before and after one that the noise there is made of.
pub const FINE_REACH: usize = 6;

/// Points that the noise of one is made of.
pub const FINE_TAPS: usize = 2 * FINE_REACH + 1;

/// Directions in which the noise can go.
pub const MAX_FINE_DIRECTIONS: usize = 16;

/// A row of [`FEATURE_COUNT`] offsets at each of [`FINE_POINTS`] points, for the step that begins with the left foot's initial contact
/// and for the one with the right's.
pub type FineTable = [Vec<f64>; 2];

/// Detail that is added to the features of a step after its trajectory is solved.
#[derive(Clone, Debug, PartialEq)]
pub struct FineMotion {
    /// Detail that steps have in common.
    pub shared: FineTable,
    /// Addition of each component of [`Variation::walker`](crate::Variation::walker) by its weight; empty where all walkers have the same.
    pub walker: Vec<FineTable>,
    /// Detail that differs from step to step.
    pub chance: FineChance,
    /// Factor on each feature: 1 for the average walk, another in a style that swings farther or less.
    pub scale: Vec<f64>,
}

/// Noise that has the covariance and the spectrum of what captured steps do not have in common.
#[derive(Clone, Debug, PartialEq)]
pub struct FineChance {
    /// For each direction, weights of independent numbers at the points from [`FINE_REACH`] before to as many after: their squares add up
    /// to 1. Arms sway slowly, head and trunk tremble.
    pub kernels: Vec<Vec<f64>>,
    /// Directions of [`FEATURE_COUNT`] offsets, each with the standard deviation of its noise as its length.
    pub directions: Vec<Vec<f64>>,
    /// By how much the weight of each walker component adds to the logarithm of the noise's strength.
    pub walker_strength: Vec<f64>,
}

impl FineMotion {
    /// Checks every shape and value against the number of walker components.
    pub(crate) fn check(&self, walker_components: usize) -> Result<(), ModelError> {
        for table in self.walker.iter().chain([&self.shared]).flatten() {
            check_len("fine motion", table, FINE_POINTS * FEATURE_COUNT)?;
            check_finite("fine motion", table)?;
        }
        check_len("scale of fine motion", &self.scale, FEATURE_COUNT)?;
        check_positive("scale of fine motion", &self.scale)?;
        let chance = &self.chance;
        for kernel in &chance.kernels {
            check_len("kernel of fine motion", kernel, FINE_TAPS)?;
            check_finite("kernel of fine motion", kernel)?;
        }
        for direction in &chance.directions {
            check_len("direction of fine motion", direction, FEATURE_COUNT)?;
            check_finite("direction of fine motion", direction)?;
        }
        check_finite("strength of fine motion", &chance.walker_strength)?;
        // Without any, all walkers have the same.
        let walkers = if self.walker.is_empty() {
            0
        } else {
            walker_components
        };
        let counts = [
            ("walkers' fine motion", walkers, self.walker.len()),
            (
                "strengths of fine motion",
                walkers,
                chance.walker_strength.len(),
            ),
            (
                "kernels of fine motion",
                chance.directions.len(),
                chance.kernels.len(),
            ),
        ];
        for (part, expected, found) in counts {
            if found != expected {
                return Err(ModelError::Shape {
                    part: part.to_owned(),
                    expected,
                    found,
                });
            }
        }
        if chance.directions.len() > MAX_FINE_DIRECTIONS {
            return Err(ModelError::Shape {
                part: "directions of fine motion".to_owned(),
                expected: MAX_FINE_DIRECTIONS,
                found: chance.directions.len(),
            });
        }
        Ok(())
    }
}
