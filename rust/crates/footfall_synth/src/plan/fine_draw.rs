//! Draw of a step's fine motion, part of its plan.

use super::step_draw::{MAX_COMPONENTS, StepDraw};
use crate::hash::mixed;
use footfall_model::GaitModel;

/// Largest factor between a walker's strength of noise and the average's.
const MAX_STRENGTH: f64 = 1.6;

/// Draw of the fine motion of one step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct FineDraw {
    /// The weights of the model's walker components.
    pub(crate) walker: [f32; MAX_COMPONENTS],
    /// Factor on the noise.
    pub(crate) strength: f32,
    /// Source of the step's noise.
    pub(crate) number: u64,
}

impl FineDraw {
    /// Draws the fine motion of a step of a walker; `variation` scales the deviations of both.
    pub(crate) fn new(
        model: &GaitModel,
        walker: &[f64; MAX_COMPONENTS],
        draw: &StepDraw,
        variation: f64,
    ) -> Self {
        let Some(fine) = &model.fine else {
            return Self::default();
        };
        let weights = walker.map(|weight| variation * weight);
        let slopes = fine.chance.walker_strength.iter().zip(&weights);
        let log: f64 = slopes.map(|(slope, weight)| slope * weight).sum();
        let most = MAX_STRENGTH.ln();
        let number = number_of(draw, model.variation.step.len());
        let strength = variation * log.clamp(-most, most).exp();
        Self {
            walker: weights.map(|weight| weight as f32),
            strength: if number == 0 { 0.0 } else { strength as f32 },
            number,
        }
    }
}

/// Returns a number unique to the step, derived from its random weights and its side; 0 for a step without chance.
fn number_of(draw: &StepDraw, components: usize) -> u64 {
    let used = components.clamp(1, MAX_COMPONENTS);
    let weights = &draw.weights[..used];
    if weights.iter().all(|weight| weight.abs() <= 0.0) {
        return 0;
    }
    let side = mixed(draw.side.index() as u64);
    weights
        .iter()
        .fold(side, |number, weight| mixed(number ^ weight.to_bits()))
}
