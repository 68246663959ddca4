//! Small changes of features as rotations of the parts of the body in the walker's space, and back.

use footfall_core::rotation::log_map;
use footfall_core::{Joint, ModelPose, Pose, Skeleton, forward_kinematics};
use footfall_model::{FEATURE_COUNT, layout};
use nalgebra::{DMatrix, DVector};

/// Half the difference of features that the derivative is taken over, radians.
const DIFFERENCE: f32 = 0.01;

/// Derivative of all parts' rotations by the features, about one posture.
pub(super) struct Orientations {
    /// A column a feature, three rows a joint.
    by_feature: DMatrix<f64>,
    by_turn: DMatrix<f64>,
}

impl Orientations {
    /// About the posture with these features.
    pub(super) fn about(mean_features: &[f64]) -> Self {
        let mut by_feature = DMatrix::zeros(FEATURE_COUNT, FEATURE_COUNT);
        for feature in 0..FEATURE_COUNT {
            let [before, after] = [-DIFFERENCE, DIFFERENCE].map(|change| {
                let mut features: [f32; FEATURE_COUNT] =
                    core::array::from_fn(|number| mean_features[number] as f32);
                features[feature] += change;
                rotations(&features)
            });
            for joint in Joint::ALL {
                let turn = log_map(after.rotation(joint) * before.rotation(joint).inverse());
                for (axis, value) in turn.to_array().into_iter().enumerate() {
                    let row = 3 * joint.index() + axis;
                    by_feature[(row, feature)] = f64::from(value / (2.0 * DIFFERENCE));
                }
            }
        }
        // Triangular by blocks that are near rotations: a posture of people has an inverse.
        let by_turn = by_feature
            .clone()
            .try_inverse()
            .unwrap_or_else(|| DMatrix::identity(FEATURE_COUNT, FEATURE_COUNT));
        Self {
            by_feature,
            by_turn,
        }
    }

    /// Rotations of all parts that go with changes of the features, three numbers a joint.
    pub(super) fn of(&self, change: &[f64]) -> Vec<f64> {
        (&self.by_feature * DVector::from_column_slice(change))
            .as_slice()
            .to_vec()
    }

    /// Rotations in rows of changes, of all parts but the legs: hips are where the standing leg carries them, so that an error of an angle would become a surge of
    /// the body, and in legs nearly all detail repeats.
    pub(super) fn of_upper_body(&self, rows: &[f64]) -> Vec<f64> {
        rows.chunks_exact(FEATURE_COUNT)
            .flat_map(|row| {
                let mut turns = self.of(row);
                for joint in Joint::ALL.into_iter().filter(|joint| joint.is_of_leg()) {
                    turns[3 * joint.index()..][..3].fill(0.0);
                }
                turns
            })
            .collect()
    }

    /// Changes of the features that turn the parts so.
    pub(super) fn features(&self, turns: &[f64]) -> Vec<f64> {
        (&self.by_turn * DVector::from_column_slice(turns))
            .as_slice()
            .to_vec()
    }
}

fn rotations(features: &[f32]) -> ModelPose {
    let mut pose = Pose::default();
    layout::decode(features, &mut pose.rotations);
    let mut model = ModelPose::default();
    forward_kinematics(&Skeleton::standard(), &pose, &mut model);
    model
}
