//! Styles: differences in walking, and mixtures of and beyond styles.

mod running;

pub use running::carried_posture_share;

use crate::check::{ModelError, check_len, check_positive};
use crate::gait_model::{GaitModel, GlobalVarianceModel, STATES_PER_STEP, StateModel, StepModel};
use crate::layout::{FEATURE_COUNT, OBSERVATION_COUNT, feature_offset};
use crate::provenance::Provenance;
use footfall_core::Joint;

/// A style adapted from a base model.
///
/// It replaces parts of the base walk; the rest (the body, the response to speed, variation between walkers
/// and steps) stays the base's.
#[derive(Clone, Debug, PartialEq)]
pub struct GaitStyle {
    /// Name of the style.
    pub name: String,
    /// [`GaitModel::fingerprint`] of the model that it was adapted from, and the only one that it fits.
    pub base_fingerprint: u32,
    /// The adapted steps: means, variances, durations and terminal contacts; the left foot's first.
    pub steps: [StepModel; 2],
    /// Total variance of the features of a walk in the style.
    pub global_variance: GlobalVarianceModel,
    /// Spread of its steps.
    pub step_spread: StepSpread,
    /// Mean speed of the recorded steps on the canonical body, m/s.
    pub speed_mps: f64,
    /// Mean cadence of the recorded steps, steps per second.
    pub cadence_hz: f64,
    /// Provenance of the style.
    pub provenance: Provenance,
}

/// Spread of the steps of a style, as factors on the base's [`variation`](GaitModel::variation) of
/// steps.
#[derive(Clone, Debug, PartialEq)]
pub struct StepSpread {
    /// One factor a feature ([`FEATURE_COUNT`]), all positive.
    pub features: Vec<f64>,
    /// Factor on durations and terminal contacts.
    pub timing: f64,
}

impl Default for StepSpread {
    /// As the base's.
    fn default() -> Self {
        Self {
            features: vec![1.0; FEATURE_COUNT],
            timing: 1.0,
        }
    }
}

/// Errors of using styles.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum StyleError {
    /// The style was adapted from another model.
    #[error(
        "style '{style}' was made for another base model; adapt it again with `footfall adapt --base` and this model"
    )]
    OtherBase {
        /// The style.
        style: String,
    },
    /// A weight is NaN or infinite.
    #[error(
        "the weight of style '{style}' is {weight}; give a finite number, 1 for the style as recorded"
    )]
    Weight {
        /// The style.
        style: String,
        /// The weight.
        weight: f64,
    },
    /// A style or the base has invalid content.
    #[error("style '{style}' cannot be used: {source}")]
    Content {
        /// The style.
        style: String,
        /// Fault.
        source: ModelError,
    },
    /// The base model cannot be used.
    #[error("the base model cannot be used: {0}")]
    Base(ModelError),
}

/// Limit of weights: poses reach their limits long before.
const MAX_WEIGHT: f64 = 10.0;

/// Largest distance of the logarithm of a variance, duration or speed beyond the base and the styles in use.
const LOG_MARGIN: f64 = 0.5;

/// Number of steps below which a style depends on chance.
const FEW_STEPS: usize = 6;

/// Least and greatest factor on the fine motion of a joint, which is scaled with its swing.
pub const FINE_SCALES: [f64; 2] = [0.5, 2.0];

impl GaitStyle {
    /// Returns a warning for a style of so few steps that chance is part of it.
    pub fn thin_warning(&self) -> Option<String> {
        let steps = self.provenance.steps;
        (1..FEW_STEPS).contains(&steps).then(|| {
            format!(
                "only {steps} steps: what is chance in them is in the style; give six to twelve"
            )
        })
    }

    /// Checks every shape and value.
    ///
    /// # Errors
    /// [`ModelError`] names the first part at fault.
    pub fn check(&self) -> Result<(), ModelError> {
        for (step, side) in self.steps.iter().zip(footfall_core::Side::BOTH) {
            step.check(side.name())?;
        }
        self.global_variance.check()?;
        let spread = &self.step_spread;
        check_len("spread of steps", &spread.features, FEATURE_COUNT)?;
        check_positive("spread of steps", &spread.features)?;
        check_positive("spread of durations", &[spread.timing])?;
        if [self.speed_mps, self.cadence_hz]
            .iter()
            .all(|value| value.is_finite() && *value > 0.0)
        {
            return Ok(());
        }
        Err(ModelError::Value {
            part: "speed of the style".to_owned(),
        })
    }
}

impl GaitModel {
    /// Returns this walk in a mixture of styles.
    ///
    /// Means and terminal contacts move from the base's towards each style's by its weight, as do the logarithms of variances,
    /// durations and speed: no styles, or weights of 0, give the base; one style with weight 1 gives that style; weights may have
    /// any sum, exceed 1 (exaggeration) or be negative (the opposite).
    ///
    /// Poses stay human: the joint rotations of all states stay within the limits of joints, or of the base and the given
    /// styles. Where the weights exceed them, the walk goes as far in their direction as the first joint
    /// allows. Durations, variances and speed stay near those of the base and the styles.
    ///
    /// # Errors
    /// [`StyleError`] when a style was made for another model, a weight is not finite, or content is invalid.
    pub fn styled(&self, styles: &[(&GaitStyle, f64)]) -> Result<Self, StyleError> {
        let all: Vec<&GaitStyle> = styles.iter().map(|(style, _)| *style).collect();
        self.check_styles(&all)?;
        for (style, weight) in styles {
            if !weight.is_finite() {
                return Err(StyleError::Weight {
                    style: style.name.clone(),
                    weight: *weight,
                });
            }
        }
        Ok(self.mixture(styles))
    }

    /// Checks that these styles fit this model.
    ///
    /// # Errors
    /// [`StyleError`] when a style was made for another model, or content is invalid.
    pub fn check_styles(&self, styles: &[&GaitStyle]) -> Result<(), StyleError> {
        self.check().map_err(StyleError::Base)?;
        let fingerprint = self.fingerprint().map_err(StyleError::Base)?;
        for style in styles {
            if style.base_fingerprint != fingerprint {
                return Err(StyleError::OtherBase {
                    style: style.name.clone(),
                });
            }
            style.check().map_err(|source| StyleError::Content {
                style: style.name.clone(),
                source,
            })?;
        }
        Ok(())
    }

    /// [`styled`](Self::styled) for styles that [`check_styles`](Self::check_styles) has passed: for weights that change while
    /// a walker walks. A weight that is not finite counts as 0.
    #[must_use]
    pub fn mixture(&self, styles: &[(&GaitStyle, f64)]) -> Self {
        let mut parts: Vec<(&GaitStyle, f64)> = styles
            .iter()
            .filter(|(_, weight)| weight.is_finite())
            .map(|(style, weight)| (*style, weight.clamp(-MAX_WEIGHT, MAX_WEIGHT)))
            .filter(|(_, weight)| weight.abs() > 0.0)
            .collect();
        // A sum of many numbers depends on their order; a mixture must not.
        parts.sort_by(|(a, wa), (b, wb)| {
            let key = |style: &GaitStyle| (style.name.clone(), style.speed_mps.to_bits());
            key(a).cmp(&key(b)).then(wa.total_cmp(wb))
        });
        if parts.is_empty() {
            return self.clone();
        }
        let share = self.human_share(&parts);
        for (_, weight) in &mut parts {
            *weight *= share;
        }
        self.mixed(&Mixture { parts: &parts })
    }

    fn mixed(&self, mixture: &Mixture<'_>) -> Self {
        let mut mixed = self.clone();
        for (side, step) in mixed.steps.iter_mut().enumerate() {
            for (index, state) in step.states.iter_mut().enumerate() {
                let of = |style: &GaitStyle, read: &dyn Fn(&StateModel) -> f64| {
                    read(&style.steps[side].states[index])
                };
                for dim in 0..state.mean.len() {
                    state.mean[dim] =
                        mixture.linear(state.mean[dim], |style| of(style, &|s| s.mean[dim]));
                    state.variance[dim] = mixture
                        .logarithmic(state.variance[dim], |style| of(style, &|s| s.variance[dim]));
                }
                state.duration_mean = mixture
                    .logarithmic(state.duration_mean, |style| of(style, &|s| s.duration_mean));
                state.duration_variance = mixture.logarithmic(state.duration_variance, |style| {
                    of(style, &|s| s.duration_variance)
                });
            }
            step.other_terminal = mixture
                .linear(step.other_terminal, |style| {
                    style.steps[side].other_terminal
                })
                .clamp(0.0, 1.0);
        }
        for dim in 0..FEATURE_COUNT {
            let target = &mut mixed.global_variance;
            target.mean[dim] =
                mixture.logarithmic(target.mean[dim], |style| style.global_variance.mean[dim]);
            target.variance[dim] = mixture.logarithmic(target.variance[dim], |style| {
                style.global_variance.variance[dim]
            });
        }
        if let Some(fine) = &mut mixed.fine {
            let swings = mixed.global_variance.mean.iter();
            let pairs = swings.zip(&self.global_variance.mean);
            for (scale, (swing, base)) in fine.scale.iter_mut().zip(pairs) {
                *scale *= (swing / base).sqrt().clamp(FINE_SCALES[0], FINE_SCALES[1]);
            }
        }
        if self.standing.is_some() {
            let styled = mixed.mean_features();
            if let Some(standing) = &mut mixed.standing {
                standing.restyle(&self.mean_features(), &styled);
            }
        }
        let factors: Vec<f64> = (0..FEATURE_COUNT)
            .map(|dim| mixture.logarithmic(1.0, |style| style.step_spread.features[dim]))
            .collect();
        let timing = mixture.logarithmic(1.0, |style| style.step_spread.timing);
        for offset in mixed.variation.step.iter_mut().flatten() {
            for (index, mean) in offset.means.iter_mut().enumerate() {
                *mean *= factors[index % OBSERVATION_COUNT % FEATURE_COUNT];
            }
            for value in &mut offset.log_durations {
                *value *= timing;
            }
            offset.other_terminal *= timing;
        }
        // The range of speeds goes with the mean speed: a shuffle can be hurried, but not to a runner's pace.
        let speed = mixture.logarithmic(self.speed.reference_mps, |style| style.speed_mps);
        let ratio = speed / self.speed.reference_mps;
        mixed.speed.reference_mps = speed;
        mixed.speed.min_mps *= ratio;
        mixed.speed.max_mps *= ratio;
        let cadence = mixed.cadence_hz() / self.cadence_hz();
        mixed.speed.cadence_range_hz = mixed.speed.cadence_range_hz.map(|hz| hz * cadence);
        if let Some(running) = &self.running {
            mixed.running = Some(Box::new(running.in_style_of(self, &mixed)));
        }
        mixed
    }

    /// Steps per second of the mean steps.
    pub fn cadence_hz(&self) -> f64 {
        let frames: f64 = self.steps.iter().map(StepModel::mean_frames).sum();
        2.0 * self.frame_rate_hz / frames
    }

    /// Share of a mixture's way that its poses can go: 1 when all of it.
    fn human_share(&self, parts: &[(&GaitStyle, f64)]) -> f64 {
        let mut share: f64 = 1.0;
        for side in 0..2 {
            for state in 0..STATES_PER_STEP {
                let base = &self.steps[side].states[state].mean;
                for joint in Joint::ALL {
                    let limits = rotation_limits(joint);
                    for (axis, [least, most]) in limits.into_iter().enumerate() {
                        let dim = feature_offset(joint) + axis;
                        let from = base[dim];
                        let (mut low, mut high) = (from.min(least), from.max(most));
                        let mut way = 0.0;
                        for (style, weight) in parts {
                            let styled = style.steps[side].states[state].mean[dim];
                            low = low.min(styled);
                            high = high.max(styled);
                            way += weight * (styled - from);
                        }
                        let room = if way > 0.0 { high - from } else { low - from };
                        // A way within the room may still divide to a little under 1.
                        if way.abs() > room.abs() * (1.0 + 1e-9) {
                            share = share.min(room / way);
                        }
                    }
                }
            }
        }
        share
    }
}

/// Styles and their weights, none of them zero.
struct Mixture<'a> {
    parts: &'a [(&'a GaitStyle, f64)],
}

impl Mixture<'_> {
    fn linear(&self, base: f64, of: impl Fn(&GaitStyle) -> f64) -> f64 {
        if let [(style, weight)] = self.parts
            && (weight - 1.0).abs() < f64::EPSILON
        {
            // Exactly the style, not up to rounding.
            return of(style);
        }
        let ways = self.parts.iter();
        base + ways
            .map(|(style, weight)| weight * (of(style) - base))
            .sum::<f64>()
    }

    /// Mixes logarithms, and keeps to the neighbourhood of what is mixed.
    fn logarithmic(&self, base: f64, of: impl Fn(&GaitStyle) -> f64) -> f64 {
        let values = || self.parts.iter().map(|(style, _)| of(style)).chain([base]);
        let low = values().fold(f64::INFINITY, f64::min);
        let high = values().fold(0.0, f64::max);
        if let [(style, weight)] = self.parts
            && (weight - 1.0).abs() < f64::EPSILON
        {
            return of(style);
        }
        let mixed = self.linear(base.ln(), |style| of(style).ln()).exp();
        mixed.clamp(low * (-LOG_MARGIN).exp(), high * LOG_MARGIN.exp())
    }
}

/// Least and greatest rotation vector of a joint, per axis in radians from the T-pose: about what people can do while they
/// walk. x bends forwards, y turns left, z leans to the right.
fn rotation_limits(joint: Joint) -> [[f64; 2]; 3] {
    let even = |x: f64, y: f64, z: f64| [[-x, x], [-y, y], [-z, z]];
    match joint {
        Joint::Hips => even(0.6, 0.6, 0.4),
        Joint::Spine | Joint::Chest | Joint::UpperChest => even(0.5, 0.45, 0.35),
        Joint::Neck | Joint::Head => even(0.6, 0.7, 0.4),
        Joint::LeftShoulder | Joint::RightShoulder => even(0.4, 0.5, 0.5),
        Joint::LeftUpperArm | Joint::RightUpperArm => even(1.6, 1.6, 1.6),
        Joint::LeftLowerArm | Joint::RightLowerArm => even(1.6, 2.3, 1.2),
        Joint::LeftHand | Joint::RightHand => even(0.9, 0.9, 0.9),
        Joint::LeftUpperLeg | Joint::RightUpperLeg => even(1.3, 0.6, 0.5),
        // A knee bends one way only.
        Joint::LeftLowerLeg | Joint::RightLowerLeg => [[-0.02, 2.1], [-0.3, 0.3], [-0.3, 0.3]],
        Joint::LeftFoot | Joint::RightFoot => even(0.8, 0.4, 0.4),
        Joint::LeftToes | Joint::RightToes => even(0.9, 0.3, 0.3),
    }
}

#[cfg(test)]
mod tests;
