//! From poses to the few numbers that systems put out, and back.

use crate::error::TrainError;
use crate::sequence::Sequence;
use footfall_core::{JOINT_COUNT, Joint, ModelPose, Pose, Side, Skeleton};
use footfall_model::{FEATURE_COUNT, OBSERVATION_COUNT};
use nalgebra::{DMatrix, DVector, SymmetricEigen};

/// A joint that moves nothing beyond it counts as if it moved this much a radian, metres: feet's toes and hands are seen too.
const LEAST_REACH: f64 = 0.02;

/// Mean and principal components of the static features.
pub(super) struct PoseSpace {
    pub(super) mean: Vec<f64>,
    /// From features to the weights of the components, and back.
    directions: Vec<Vec<f64>>,
    pub(super) components: Vec<Vec<f64>>,
    pub(super) explained: f64,
}

impl PoseSpace {
    /// The directions in which the joints' places vary most, to first order: a hip that turns moves a whole leg, a hand little.
    pub(super) fn of(
        sequences: &[Sequence],
        skeleton: &Skeleton,
        most: usize,
    ) -> Result<Self, TrainError> {
        let statics = || {
            let rows = sequences
                .iter()
                .flat_map(|s| s.observations.chunks_exact(OBSERVATION_COUNT));
            rows.map(|row| &row[..FEATURE_COUNT])
        };
        let count = statics().count();
        if count == 0 {
            return Err(TrainError::NoSteps);
        }
        let mut mean = vec![0.0; FEATURE_COUNT];
        for row in statics() {
            for (mean, value) in mean.iter_mut().zip(row) {
                *mean += value / count as f64;
            }
        }
        let reach = reach(skeleton);
        let mut scatter = DMatrix::<f64>::zeros(FEATURE_COUNT, FEATURE_COUNT);
        for row in statics() {
            let centred = row.iter().zip(&mean).map(|(value, mean)| value - mean);
            let moved = centred.zip(&reach).map(|(value, reach)| value * reach);
            let moved = DVector::from_iterator(FEATURE_COUNT, moved);
            scatter.ger(1.0 / count as f64, &moved, &moved, 1.0);
        }
        let total = scatter.trace();
        let eigen = SymmetricEigen::new(scatter);
        let mut rank: Vec<usize> = (0..FEATURE_COUNT).collect();
        rank.sort_by(|a, b| eigen.eigenvalues[*b].total_cmp(&eigen.eigenvalues[*a]));
        rank.truncate(most);
        let held: f64 = rank.iter().map(|index| eigen.eigenvalues[*index]).sum();
        let scaled = |scale: &dyn Fn(f64, f64) -> f64| {
            let column = |index: &usize| {
                let column = eigen.eigenvectors.column(*index);
                column
                    .iter()
                    .zip(&reach)
                    .map(|(v, r)| scale(*v, *r))
                    .collect()
            };
            rank.iter().map(column).collect::<Vec<Vec<f64>>>()
        };
        Ok(Self {
            mean,
            directions: scaled(&|value, reach| value * reach),
            components: scaled(&|value, reach| value / reach),
            explained: if total > 0.0 { held / total } else { 1.0 },
        })
    }

    /// The weights of the components in a frame, metres.
    pub(super) fn project(&self, features: &[f64], weights: &mut Vec<f64>) {
        weights.extend(self.directions.iter().map(|direction| {
            let centred = features
                .iter()
                .zip(&self.mean)
                .map(|(value, mean)| value - mean);
            centred.zip(direction).map(|(a, b)| a * b).sum::<f64>()
        }));
    }
}

/// Distance from a joint of those that it moves, root mean square over all joints, for every feature: what a radian there
/// moves, metres. A leg's joints move the foot half of the time, and all the rest of the body while the foot stands.
fn reach(skeleton: &Skeleton) -> Vec<f64> {
    let rest = ModelPose::of(skeleton, &Pose::rest(skeleton));
    let legs = Side::BOTH.map(|side| [side.upper_leg(), side.lower_leg(), side.foot()]);
    let reach = |joint: Joint| {
        let of_leg = legs.iter().flatten().any(|leg| *leg == joint);
        let squares = Joint::ALL.into_iter().map(|other| {
            let share = match (of_leg, is_beyond(other, joint)) {
                (true, _) => 0.5,
                (false, true) => 1.0,
                (false, false) => 0.0,
            };
            share * rest.position(other).distance_squared(rest.position(joint))
        });
        let mean = squares.sum::<f32>() / JOINT_COUNT as f32;
        f64::from(mean.sqrt()).max(LEAST_REACH)
    };
    Joint::ALL
        .into_iter()
        .flat_map(|joint| [reach(joint); 3])
        .collect()
}

/// Returns true when a joint hangs on another.
fn is_beyond(joint: Joint, on: Joint) -> bool {
    let mut parent = joint.parent();
    while let Some(joint) = parent {
        if joint == on {
            return true;
        }
        parent = joint.parent();
    }
    false
}
