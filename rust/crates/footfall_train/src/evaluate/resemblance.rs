//! Resemblance of two sets of strides.

use super::stride_features::Stride;
use footfall_core::Joint;

/// Joints whose reference spread is below this, radians, are left out of ratios: noise over noise says nothing.
const LEAST_RATIO_SPREAD: f64 = 0.005;
use serde::ser::SerializeStruct as _;
use serde::{Serialize, Serializer};
use std::collections::BTreeMap;

/// A ratio for each joint that moves.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct JointRatios {
    /// In the order of the joints.
    pub joints: Vec<(Joint, f64)>,
}

/// As the median, and the ratios by the joints' names.
impl Serialize for JointRatios {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let joints = self.joints.iter();
        let joints: BTreeMap<&str, f64> = joints
            .map(|(joint, ratio)| (joint.name(), *ratio))
            .collect();
        let mut ratios = serializer.serialize_struct("JointRatios", 2)?;
        ratios.serialize_field("median", &self.median())?;
        ratios.serialize_field("joints", &joints)?;
        ratios.end()
    }
}

impl JointRatios {
    /// The median over the joints; `None` when none moves.
    pub fn median(&self) -> Option<f64> {
        median(self.joints.iter().map(|(_, ratio)| *ratio).collect())
    }

    /// Least and greatest ratio with their joints.
    pub fn extremes(&self) -> Option<[(Joint, f64); 2]> {
        let by_ratio = |a: &&(Joint, f64), b: &&(Joint, f64)| a.1.total_cmp(&b.1);
        let least = self.joints.iter().min_by(by_ratio)?;
        Some([*least, *self.joints.iter().max_by(by_ratio)?])
    }

    fn of(judged: &[f64], reference: &[f64], least: f64) -> Self {
        let joints = Joint::ALL
            .into_iter()
            .zip(judged.iter().zip(reference))
            .filter(|(_, (_, reference))| **reference > least)
            .map(|(joint, (judged, reference))| (joint, judged / reference))
            .collect();
        Self { joints }
    }
}

/// Root mean square, over the features, of the difference of the two means in units of the spread within styles.
///
/// 0 for equal means; about √(1/n + 1/m) for n and m strides of the same style. `None` when a set is empty.
pub fn distance(judged: &[&Stride], reference: &[&Stride], spread: &[f64]) -> Option<f64> {
    let (judged, reference) = (mean_features(judged)?, mean_features(reference)?);
    let squares = judged
        .iter()
        .zip(&reference)
        .zip(spread)
        .map(|((a, b), spread)| ((a - b) / spread).powi(2));
    Some((squares.sum::<f64>() / spread.len() as f64).sqrt())
}

/// Mean of the features; `None` without strides.
fn mean_features(strides: &[&Stride]) -> Option<Vec<f64>> {
    let mut mean = vec![0.0; strides.first()?.features.len()];
    for stride in strides {
        for (mean, value) in mean.iter_mut().zip(&stride.features) {
            *mean += value / strides.len() as f64;
        }
    }
    Some(mean)
}

/// Variance of each joint's angles over a stride, judged over reference: below 1 the motion is damped.
pub fn variance_ratios(judged: &[&Stride], reference: &[&Stride]) -> JointRatios {
    let mean = |strides: &[&Stride]| -> Vec<f64> {
        (0..Joint::ALL.len())
            .map(|joint| {
                let sum: f64 = strides
                    .iter()
                    .map(|stride| stride.joint_variances[joint])
                    .sum();
                sum / strides.len().max(1) as f64
            })
            .collect()
    };
    if judged.is_empty() || reference.is_empty() {
        return JointRatios::default();
    }
    JointRatios::of(&mean(judged), &mean(reference), LEAST_RATIO_SPREAD.powi(2))
}

/// Variability of the steps of a walk: for each joint the root mean square, over the phases of the step, of
/// the standard deviation of its angles between steps, radians.
///
/// `walks` holds the strides of one walker's recording each; steps are compared with steps of the same foot in the same
/// recording. `None` when no recording has two of them.
pub fn step_variability(walks: &[Vec<&Stride>]) -> Option<Vec<f64>> {
    let mut squares = vec![0.0; Joint::ALL.len()];
    let mut freedom = 0;
    for walk in walks {
        for side in footfall_core::Side::BOTH {
            let steps: Vec<&[f64]> = walk
                .iter()
                .filter(|stride| stride.side == side)
                .map(|stride| stride.step_angles.as_slice())
                .collect();
            if steps.len() < 2 {
                continue;
            }
            freedom += steps.len() - 1;
            let width = 3 * Joint::ALL.len();
            for sample in 0..steps[0].len() {
                let mean = steps.iter().map(|step| step[sample]).sum::<f64>() / steps.len() as f64;
                let square: f64 = steps.iter().map(|step| (step[sample] - mean).powi(2)).sum();
                squares[sample % width / 3] += square / super::PHASES as f64;
            }
        }
    }
    (freedom > 0).then(|| {
        squares
            .iter()
            .map(|square| (square / freedom as f64).sqrt())
            .collect()
    })
}

/// Variability between steps, judged over reference, by joint.
pub fn variability_ratios(judged: &[Vec<&Stride>], reference: &[Vec<&Stride>]) -> JointRatios {
    match (step_variability(judged), step_variability(reference)) {
        (Some(judged), Some(reference)) => JointRatios::of(&judged, &reference, LEAST_RATIO_SPREAD),
        _ => JointRatios::default(),
    }
}

/// Pearson's correlation; `None` for fewer than two pairs or when one side does not vary.
pub fn correlation(pairs: &[(f64, f64)]) -> Option<f64> {
    let count = pairs.len() as f64;
    let mean_x = pairs.iter().map(|pair| pair.0).sum::<f64>() / count;
    let mean_y = pairs.iter().map(|pair| pair.1).sum::<f64>() / count;
    let (mut xx, mut yy, mut xy) = (0.0, 0.0, 0.0);
    for (x, y) in pairs {
        xx += (x - mean_x).powi(2);
        yy += (y - mean_y).powi(2);
        xy += (x - mean_x) * (y - mean_y);
    }
    (pairs.len() >= 2 && xx > 1e-12 && yy > 1e-12).then(|| xy / (xx * yy).sqrt())
}

/// The middle value, or the mean of the two in the middle; `None` without values.
pub(super) fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    let upper = *values.get(middle)?;
    Some(if values.len() % 2 == 1 {
        upper
    } else {
        0.5 * (values[middle - 1] + upper)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use footfall_core::Side;
    use proptest::prelude::*;

    /// A stride whose features, angles and variances are all the same number.
    fn stride(side: Side, features: [f64; 2], angle: f64, variance: f64) -> Stride {
        Stride {
            side,
            first: 0,
            end: 1,
            features: features.to_vec(),
            step_angles: vec![angle; super::super::PHASES * 3 * Joint::ALL.len()],
            joint_variances: vec![variance; Joint::ALL.len()],
        }
    }

    #[test]
    fn distance_is_in_units_of_the_spread() {
        let here = stride(Side::Left, [1.0, 5.0], 0.0, 1.0);
        let there = stride(Side::Left, [2.0, 5.0], 0.0, 4.0);
        let spread = [0.5, 0.1];
        assert_eq!(distance(&[&here], &[&here], &spread), Some(0.0));
        let apart = distance(&[&there], &[&here], &spread).unwrap();
        assert!((apart - 2_f64.sqrt()).abs() < 1e-12, "{apart}");
        assert_eq!(distance(&[], &[&here], &spread), None);
        let ratios = variance_ratios(&[&there], &[&here]);
        assert_eq!(ratios.joints.len(), Joint::ALL.len());
        assert_eq!(ratios.median(), Some(4.0));
    }

    #[test]
    fn variability_is_between_steps_of_one_foot_in_one_recording() {
        let angles = [0.1, 0.3, 0.5];
        // The right foot's steps are alike, far from the left's; another recording is elsewhere again.
        let mut walk: Vec<Stride> = angles
            .map(|angle| stride(Side::Left, [0.0; 2], angle, 1.0))
            .to_vec();
        walk.extend([2.0; 3].map(|angle| stride(Side::Right, [0.0; 2], angle, 1.0)));
        let elsewhere: Vec<Stride> = angles
            .map(|angle| stride(Side::Left, [0.0; 2], 9.0 + angle, 1.0))
            .to_vec();
        let walks = [walk.iter().collect(), elsewhere.iter().collect()];
        // Three axes; (0.2² + 0.2²) twice over 2 + 2 + 2 degrees of freedom.
        let expected = (3.0_f64 * 0.16 / 6.0).sqrt();
        for value in step_variability(&walks).unwrap() {
            assert!((value - expected).abs() < 1e-9, "{value} is not {expected}");
        }
        assert_eq!(step_variability(&[vec![&walk[0], &walk[3]]]), None);
        let ratios = variability_ratios(&walks, &walks);
        assert!((ratios.median().unwrap() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn joints_that_do_not_move_have_no_ratio() {
        let still = stride(Side::Left, [0.0; 2], 0.0, 0.0);
        assert_eq!(variance_ratios(&[&still], &[&still]).extremes(), None);
        assert_eq!(median(Vec::new()), None);
        assert_eq!(median(vec![4.0, 1.0, 2.0, 3.0]), Some(2.5));
    }

    #[test]
    fn the_paper_s_figures_correlate() {
        assert_eq!(
            correlation(&[(1.0, 2.0), (2.0, 4.0), (3.0, 6.0)]),
            Some(1.0)
        );
        assert_eq!(correlation(&[(1.0, 2.0), (1.0, 4.0)]), None);
        // The diagonals of Table 2 as printed; the paper's own figure, from unrounded rates, is 0.8849.
        let original = [
            10.0, 37.0, 68.0, 58.0, 91.0, 20.0, 49.0, 71.0, 17.0, 19.5, 47.0,
        ];
        let synthesised = [
            15.0, 42.0, 71.0, 51.0, 72.0, 38.0, 44.0, 42.0, 19.0, 23.0, 52.0,
        ];
        let pairs: Vec<(f64, f64)> = original.into_iter().zip(synthesised).collect();
        let found = correlation(&pairs).unwrap();
        assert!((found - 0.885).abs() < 0.01, "{found}");
    }

    proptest! {
        #[test]
        fn correlation_is_bounded_and_symmetric(pairs in proptest::collection::vec((-5.0_f64..5.0, -5.0_f64..5.0), 2..20)) {
            if let Some(found) = correlation(&pairs) {
                let swapped: Vec<(f64, f64)> = pairs.iter().map(|(x, y)| (*y, *x)).collect();
                prop_assert!(found.abs() <= 1.0 + 1e-9);
                prop_assert!((found - correlation(&swapped).unwrap()).abs() < 1e-9);
            }
        }
    }
}
