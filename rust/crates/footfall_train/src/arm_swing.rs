//! Swing of the arms with speed.
//!
//! Slow and fast walks of a corpus are of different people, so a regression on speed takes what these people differ in for what speed does: hands of slow walkers
//! went from side to side twice as far as anybody's. The posture of the arms, their mean over a stride, keeps its slopes. The swing about it rather keeps its shape,
//! and speed makes it wider or narrower, by one number for both arms.

use core::ops::Range;
use footfall_core::Joint;
use footfall_model::layout::feature_offset;
use footfall_model::{FEATURE_COUNT, OBSERVATION_COUNT, STATES_PER_STEP, StepModel, StepOffset};

/// Share of a change of shape that is taken for one of people. With a half of it, hands go as far to the sides at any speed as those of the people who walk at it.
const OF_PEOPLE: f64 = 0.5;

/// States of a stride: a left step, and the right one after it.
const STATES: usize = 2 * STATES_PER_STEP;

/// Features of the arms, shoulders included.
const ARMS: Range<usize> = feature_offset(Joint::LeftShoulder)..feature_offset(Joint::LeftUpperLeg);

/// An observation in every state of a stride.
type Course = [f64; STATES];

/// Draws what speed does to the swing of the arms to a change of its width.
pub(crate) fn keep_shape(slopes: &mut [StepOffset; 2], steps: &[StepModel; 2]) {
    let durations: Course = core::array::from_fn(|state| of_state(steps, state).0);
    let stride: f64 = durations.iter().sum();
    let shares = durations.map(|duration| duration / stride);
    let swing = |course: Course| {
        let posture = mean_product(&course, &[1.0; STATES], &shares);
        course.map(|value| value - posture)
    };
    let mean = |dim: usize| swing(core::array::from_fn(|state| of_state(steps, state).1[dim]));
    let slope = |slopes: &[StepOffset; 2], dim: usize| {
        swing(core::array::from_fn(|state| {
            slopes[state / STATES_PER_STEP].means[place(state, dim)]
        }))
    };
    let (mut common, mut whole) = (0.0, 0.0);
    for dim in ARMS {
        let mean = mean(dim);
        common += mean_product(&slope(slopes, dim), &mean, &shares);
        whole += mean_product(&mean, &mean, &shares);
    }
    if whole <= 0.0 {
        return;
    }
    let widening = common / whole;
    // The features, and their first and second differences.
    for dim in (0..3).flat_map(|order| ARMS.map(move |dim| order * FEATURE_COUNT + dim)) {
        let (slope, mean) = (slope(slopes, dim), mean(dim));
        for state in 0..STATES {
            slopes[state / STATES_PER_STEP].means[place(state, dim)] +=
                OF_PEOPLE * (widening * mean[state] - slope[state]);
        }
    }
}

/// Mean of the product of two courses over a stride.
fn mean_product(one: &Course, other: &Course, shares: &Course) -> f64 {
    let products = one.iter().zip(other).zip(shares);
    products
        .map(|((one, other), share)| one * other * share)
        .sum()
}

/// Duration and means of a state.
fn of_state(steps: &[StepModel; 2], state: usize) -> (f64, &[f64]) {
    let state = &steps[state / STATES_PER_STEP].states[state % STATES_PER_STEP];
    (state.duration_mean, &state.mean)
}

/// Place of an observation of a state among the means of its step.
fn place(state: usize, dim: usize) -> usize {
    state % STATES_PER_STEP * OBSERVATION_COUNT + dim
}

#[cfg(test)]
mod tests {
    use super::*;
    use footfall_model::StateModel;
    use std::f64::consts::TAU;

    /// Steps whose observations swing by a sine over the stride, about a posture, with a phase of their own.
    fn steps() -> [StepModel; 2] {
        [0, 1].map(|step| StepModel {
            states: (0..STATES_PER_STEP)
                .map(|state| StateModel {
                    mean: (0..OBSERVATION_COUNT)
                        .map(|dim| 0.3 + sine(step * STATES_PER_STEP + state, dim as f64))
                        .collect(),
                    variance: vec![1.0; OBSERVATION_COUNT],
                    duration_mean: 6.0,
                    duration_variance: 1.0,
                })
                .collect(),
            other_terminal: 0.2,
        })
    }

    fn sine(state: usize, phase: f64) -> f64 {
        (TAU * state as f64 / STATES as f64 + phase).sin()
    }

    /// Slopes by state and observation.
    fn slopes(of: impl Fn(usize, usize) -> f64) -> [StepOffset; 2] {
        [0, 1].map(|step| {
            let mut offset = StepOffset::zero();
            for state in 0..STATES_PER_STEP {
                for dim in 0..OBSERVATION_COUNT {
                    offset.means[place(state, dim)] = of(step * STATES_PER_STEP + state, dim);
                }
            }
            offset
        })
    }

    fn farthest(one: &[StepOffset; 2], other: &[StepOffset; 2]) -> f64 {
        let pairs = one.iter().zip(other);
        let apart = pairs.flat_map(|(one, other)| one.means.iter().zip(&other.means));
        apart
            .map(|(one, other)| (one - other).abs())
            .fold(0.0, f64::max)
    }

    #[test]
    fn a_wider_swing_and_another_posture_stay_as_they_are() {
        let wider = slopes(|state, dim| dim as f64 - 0.7 * sine(state, dim as f64));
        let mut kept = wider.clone();
        keep_shape(&mut kept, &steps());
        assert!(farthest(&kept, &wider) < 1e-12);
    }

    #[test]
    fn half_of_another_shape_goes_and_only_from_arms() {
        let quarter = TAU / 4.0;
        let other = slopes(|state, dim| sine(state, dim as f64 + quarter));
        let mut drawn = other.clone();
        keep_shape(&mut drawn, &steps());
        let expected = slopes(|state, dim| {
            let is_of_arms = ARMS.contains(&(dim % FEATURE_COUNT));
            let share = if is_of_arms { 1.0 - OF_PEOPLE } else { 1.0 };
            share * sine(state, dim as f64 + quarter)
        });
        assert!(farthest(&drawn, &expected) < 1e-12);
    }
}
