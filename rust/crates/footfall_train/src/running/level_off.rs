//! Runs that go on: over a stride, trunk, head and arms neither rise nor fall.
//!
//! Few steps in a row were recorded of a run, in which people bend and right themselves. What that leaves in the mean first differences adds up in a long run, against
//! statics that hold little: a head that looks about sank by 3° a second. Legs are held by the ground.

use footfall_core::Joint;
use footfall_model::layout::feature_offset;
use footfall_model::{FEATURE_COUNT, GaitModel, OBSERVATION_COUNT, StepOffset};

/// Most time in which the statics of a run come to bear against its first differences, frames: the ratio of their deviations. In walks it is 4 to 11; the head of a
/// runner who looks about has 22.
const MOST_FRAMES: f64 = 11.0;

/// Observations of the states of both steps of a stride.
type Stride<'a> = Vec<&'a mut [f64]>;

/// Takes from the first differences of a run what a stride does not undo: from their means, from their response to speed up to the fastest run, and from how
/// runners and steps differ. What is left, for states last whole frames, finds firm statics.
pub(super) fn level_off(run: &mut GaitModel) {
    let faster = run.speed.max_mps - run.speed.reference_mps;
    let [frames, fast_frames] = [0.0, faster].map(|faster| durations(run, faster));
    for state in run.steps.iter_mut().flat_map(|step| &mut step.states) {
        for dim in differences() {
            let most = MOST_FRAMES * MOST_FRAMES * state.variance[dim];
            let own = &mut state.variance[dim - FEATURE_COUNT];
            *own = own.min(most);
        }
    }
    let states = run.steps.iter_mut().flat_map(|step| &mut step.states);
    let mut means: Stride<'_> = states.map(|state| state.mean.as_mut_slice()).collect();
    take(&mut means, |means, dim| drift(means, &frames, dim));
    let variation = &mut run.variation;
    for offset in variation.walker.iter_mut().chain(&mut variation.step) {
        take(&mut rows(offset), |offsets, dim| {
            drift(offsets, &frames, dim)
        });
    }
    if faster > 0.0 {
        take(&mut rows(&mut run.speed.slopes), |slopes, dim| {
            // States last otherwise in a fast run, so that the means alone have a drift there.
            drift(&means, &fast_frames, dim) / faster + drift(slopes, &fast_frames, dim)
        });
    }
}

/// Takes this amount of each of the [`differences`] from every state of a stride.
fn take(stride: &mut Stride<'_>, amount: impl Fn(&Stride<'_>, usize) -> f64) {
    for dim in differences() {
        let amount = amount(stride, dim);
        for state in stride.iter_mut() {
            state[dim] -= amount;
        }
    }
}

/// Frames that the states of a stride last in a run that is so much faster than that of the reference, m/s.
fn durations(run: &GaitModel, faster: f64) -> Vec<f64> {
    let steps = run.steps.iter().zip(&run.speed.slopes);
    steps
        .flat_map(|(step, slope)| step.states.iter().zip(&slope.log_durations))
        .map(|(state, slope)| state.duration_mean * (faster * slope).exp())
        .collect()
}

/// Places of the first differences of trunk, head and arms in an observation.
fn differences() -> impl Iterator<Item = usize> {
    let upper = Joint::ALL
        .into_iter()
        .filter(|joint| !joint.is_of_lower_body());
    upper.flat_map(|joint| {
        let first = FEATURE_COUNT + feature_offset(joint);
        first..first + 3
    })
}

fn rows(offsets: &mut [StepOffset; 2]) -> Stride<'_> {
    let means = offsets.iter_mut().map(|offset| &mut offset.means);
    means
        .flat_map(|means| means.chunks_exact_mut(OBSERVATION_COUNT))
        .collect()
}

/// Mean of one number over a stride whose states last so many frames.
fn drift(observations: &Stride<'_>, frames: &[f64], dim: usize) -> f64 {
    let weighted = observations.iter().zip(frames);
    let sum: f64 = weighted.map(|(row, frames)| frames * row[dim]).sum();
    sum / frames.iter().sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::adapt::tests::base;

    /// The rise of a feature over a stride of this model at another speed, and over one of a walker or step that differs.
    fn rises(run: &GaitModel, dim: usize) -> Vec<f64> {
        let GaitModel {
            steps,
            speed,
            variation,
            ..
        } = run;
        let rise = |offset: &[StepOffset; 2], faster: f64, of_means: f64| -> f64 {
            let sides = steps.iter().zip(offset).zip(&speed.slopes);
            let states = sides.flat_map(|((step, offset), slope)| {
                let rows = offset.means.chunks_exact(OBSERVATION_COUNT);
                step.states.iter().zip(rows).zip(&slope.log_durations)
            });
            let rises = states.map(|((state, row), slope)| {
                let frames = state.duration_mean * (faster * slope).exp();
                frames
                    * (of_means * state.mean[dim]
                        + row[dim] * if faster > 0.0 { faster } else { 1.0 })
            });
            rises.sum()
        };
        let still = [0, 1].map(|_| StepOffset::zero());
        let mut rises = vec![
            rise(&still, 0.0, 1.0),
            rise(&speed.slopes, speed.max_mps - speed.reference_mps, 1.0),
        ];
        let others = variation.walker.iter().chain(&variation.step);
        rises.extend(others.map(|offset| rise(offset, 0.0, 0.0)));
        rises
    }

    #[test]
    fn strides_leave_trunk_head_and_arms_where_they_were_and_legs_alone() {
        let mut run = base();
        let head = FEATURE_COUNT + feature_offset(Joint::Head);
        let knee = FEATURE_COUNT + feature_offset(Joint::LeftLowerLeg);
        for state in run.steps.iter_mut().flat_map(|step| &mut step.states) {
            state.mean[head] += 1e-3;
            state.mean[knee] += 1e-3;
        }
        let before = run.clone();
        level_off(&mut run);
        for dim in differences() {
            for rise in rises(&run, dim) {
                assert!(rise.abs() < 1e-9, "{rise} in {dim}");
            }
        }
        let most = rises(&before, head)[0];
        assert!(most > 1e-2, "{most}");
        assert_eq!(rises(&run, knee), rises(&before, knee));
    }

    #[test]
    fn loose_statics_are_made_firm() {
        let mut run = base();
        let head = feature_offset(Joint::Head);
        let state = &mut run.steps[0].states[1];
        let difference = state.variance[FEATURE_COUNT + head];
        state.variance[head] = 400.0 * difference;
        state.variance[head + 1] = 16.0 * state.variance[FEATURE_COUNT + head + 1];
        let kept = state.variance[head + 1];
        level_off(&mut run);
        let state = &run.steps[0].states[1];
        let ratio = (state.variance[head] / difference).sqrt();
        assert!((ratio - MOST_FRAMES).abs() < 1e-9, "{ratio}");
        assert!((state.variance[head + 1] - kept).abs() < 1e-15);
    }
}
