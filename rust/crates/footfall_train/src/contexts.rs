//! Steps at the ends of a walk: ten contexts, tied by decision trees.
//!
//! A step's context is its place in the walk (first, second, inside, last but one, last) and its foot. Every state's output
//! has a tree of its own, and so have the durations, all five of a step together (Tilmanne et al. 2012, sections 5.1.1 and
//! 5.2.1). What a context's leaves differ from those of the steps inside becomes an offset of the model.

mod moments;
mod tied;
mod trees;

use crate::average::{AverageWalk, variance_floor};
use crate::error::TrainError;
use crate::sequence::{LabelledStep, Sequence};
use footfall_core::{Side, StepPosition};
use footfall_model::{SpeedResponse, StepContext, StepModel};
use moments::Moments;
use tied::Tied;
use trees::Trees;

/// Five places and two feet.
const CONTEXTS: usize = 2 * StepPosition::ALL.len();

/// Number of times that steps are cut into states and the tied states estimated anew.
const ROUNDS: usize = 4;

/// Least number of steps of a context: fewer may reflect one person's whim, and the context counts as unseen.
const LEAST_STEPS: f64 = 4.0;

/// A shorter walk between two stands is a shuffle: it says nothing of how walks begin and end.
const LEAST_WALK_STEPS: usize = 4;

/// Contexts, of ten, that share a model.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ContextReport {
    /// Steps seen of every context, mirrored ones included: place by place, the left foot first.
    pub seen: Vec<usize>,
    /// Leaves of the output tree of each state.
    pub output_leaves: Vec<usize>,
    /// Leaves of the tree of durations.
    pub duration_leaves: usize,
    /// Different step models that are left of the ten: the paper has six.
    pub models: usize,
    /// The questions that the trees ask, each once, those asked most often first.
    pub questions: Vec<String>,
    /// The trees themselves: one for the output of each state, then the durations'.
    pub trees: Vec<TreeReport>,
}

/// A tree, written down.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct TreeReport {
    /// Quantity that it ties: `output of state 1`, `durations`.
    pub name: String,
    /// Parents before children.
    pub lines: Vec<TreeLine>,
}

/// A line of a tree.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TreeLine {
    /// Number of questions that lead here.
    pub depth: usize,
    /// The answer that led here from the question above; `None` at the root.
    pub answer: Option<bool>,
    /// A question and what it saves, or the steps that share a model.
    pub text: String,
}

/// Estimates how steps at the ends of walks differ. `corpus` holds whole walks as those of the average walker.
///
/// # Errors
/// [`TrainError`] when a walk cannot be explained.
pub(crate) fn estimate(
    walk: &AverageWalk,
    steps: &[StepModel; 2],
    speed: &SpeedResponse,
    corpus: &[Sequence],
) -> Result<(Vec<StepContext>, ContextReport), TrainError> {
    let walks = corpus.iter().filter(|walk| {
        let ends = |step: &LabelledStep| step.position != StepPosition::Inside;
        walk.steps.len() >= LEAST_WALK_STEPS || !walk.steps.iter().any(ends)
    });
    let corpus: Vec<Sequence> = walks.cloned().collect();
    let corpus = corpus.as_slice();
    let floor = variance_floor(corpus);
    let mut tied = Tied::untied(walk);
    let mut moments = Moments::gather(&tied, corpus, walk.max_duration())?;
    let trees = Trees::grow(&moments, &floor)?;
    for _ in 0..ROUNDS {
        tied = Tied::estimate(&trees, &moments, &floor, walk)?;
        moments = Moments::gather(&tied, corpus, walk.max_duration())?;
    }
    let mut contexts = Vec::new();
    for position in StepPosition::ALL {
        for side in Side::BOTH {
            let offset = trees.offset(&moments, position, side, &steps[side.index()], speed);
            if let Some(offset) = offset {
                contexts.push(StepContext {
                    position,
                    side,
                    offset,
                });
            }
        }
    }
    Ok((contexts, trees.report(&moments)))
}

fn context(position: StepPosition, side: Side) -> usize {
    2 * position.index() + side.index()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::average::EmConfig;
    use footfall_model::{FEATURE_COUNT, OBSERVATION_COUNT, STATES_PER_STEP, StepOffset};

    const FRAMES: usize = 30;
    const OFFSET: f64 = 0.4;

    /// Six steps that swing as a wave; the first, of which there may be none, is shifted and half as long again.
    fn walk(number: usize, is_first: impl Fn(usize) -> bool) -> Sequence {
        let mut values: Vec<[f64; FEATURE_COUNT]> = Vec::new();
        let mut steps = Vec::new();
        for step in 0..6 {
            let side = Side::BOTH[(step + number) % 2];
            let starts = is_first(step);
            let frames = if starts { FRAMES * 3 / 2 } else { FRAMES };
            let first = values.len();
            for frame in 0..frames {
                let phase =
                    core::f64::consts::PI * (frame as f64 / frames as f64 + side.index() as f64);
                values.push(core::array::from_fn(|feature| {
                    let noise = ((values.len() * 131 + feature * 71 + number * 17) as f64).sin();
                    let shift = if starts { OFFSET } else { 0.0 };
                    0.3 * (phase + 0.1 * feature as f64).sin() + 0.01 * noise + shift
                }));
            }
            steps.push(LabelledStep {
                side,
                first,
                end: first + frames,
                other_terminal: Some(if starts { 0.5 } else { 0.2 }),
                position: if starts {
                    StepPosition::First
                } else {
                    StepPosition::Inside
                },
                speed_mps: 1.2,
            });
        }
        let last = values.len() - 1;
        let mut observations = Vec::new();
        for frame in 0..=last {
            let (before, after) = (
                &values[frame.saturating_sub(1)],
                &values[(frame + 1).min(last)],
            );
            let now = &values[frame];
            observations.extend(now);
            observations.extend((0..FEATURE_COUNT).map(|f| 0.5 * (after[f] - before[f])));
            observations.extend((0..FEATURE_COUNT).map(|f| after[f] + before[f] - 2.0 * now[f]));
        }
        Sequence {
            walker: number,
            observations,
            steps,
        }
    }

    fn estimated(starts: usize) -> ([StepModel; 2], Vec<StepContext>, ContextReport) {
        let steady: Vec<Sequence> = (0..6).map(|number| walk(number, |_| false)).collect();
        let em = EmConfig {
            max_iterations: 10,
            min_gain_per_frame: 1e-4,
        };
        let average = AverageWalk::train(&steady, &em, &mut ()).unwrap();
        let steps = Side::BOTH.map(|side| StepModel {
            states: average.states(side).unwrap(),
            other_terminal: 0.2,
        });
        let flat = SpeedResponse {
            reference_mps: 1.2,
            min_mps: 1.0,
            max_mps: 1.4,
            cadence_range_hz: [1.5, 2.5],
            slopes: [StepOffset::zero(), StepOffset::zero()],
        };
        let started = (0..starts).map(|number| walk(number, |step| step == 0));
        let corpus: Vec<Sequence> = steady.iter().cloned().chain(started).collect();
        let (contexts, report) = estimate(&average, &steps, &flat, &corpus).unwrap();
        (steps, contexts, report)
    }

    /// Stops after a number of iterations, and keeps the likelihood of each.
    struct StopsAfter {
        iterations: usize,
        fits: Vec<f64>,
    }

    impl crate::Progress for StopsAfter {
        fn advance(&mut self, _: &str, done: usize, _: usize) -> core::ops::ControlFlow<()> {
            if done >= self.iterations {
                return core::ops::ControlFlow::Break(());
            }
            core::ops::ControlFlow::Continue(())
        }

        fn fit(&mut self, log_likelihood: f64) {
            self.fits.push(log_likelihood);
        }
    }

    #[test]
    fn training_that_is_asked_to_stop_stops() {
        let steady: Vec<Sequence> = (0..4).map(|number| walk(number, |_| false)).collect();
        let em = EmConfig {
            max_iterations: 10,
            min_gain_per_frame: 0.0,
        };
        let mut progress = StopsAfter {
            iterations: 1,
            fits: Vec::new(),
        };
        let stopped = AverageWalk::train(&steady, &em, &mut progress);
        assert!(matches!(stopped, Err(TrainError::Cancelled)));
        assert_eq!(progress.fits.len(), 1);
    }

    #[test]
    fn trees_are_written_down_question_by_question() {
        let (_, _, report) = estimated(12);
        assert_eq!(report.trees.len(), STATES_PER_STEP + 1);
        let durations = &report.trees[STATES_PER_STEP];
        assert_eq!(durations.name, "durations");
        let leaves = durations
            .lines
            .iter()
            .filter(|line| !line.text.starts_with("is it"));
        assert_eq!(leaves.count(), report.duration_leaves);
        let root = &durations.lines[0];
        assert!(root.depth == 0 && root.answer.is_none() && root.text.starts_with("is it"));
        // Every context stands in one leaf of every tree, by its name.
        for tree in &report.trees {
            let words: Vec<&str> = tree.lines.iter().map(|line| line.text.as_str()).collect();
            let said = words.join(", ");
            assert!(
                said.contains("inside") && said.contains("last but one"),
                "{said}"
            );
        }
    }

    #[test]
    fn first_steps_that_differ_get_a_model_of_their_own() {
        let (steps, contexts, report) = estimated(12);
        assert_eq!(report.models, 4, "{report:?}");
        assert_eq!(report.seen[..2], [6, 6]);
        let places: Vec<_> = contexts.iter().map(|c| (c.position, c.side)).collect();
        // Second steps were never seen: the questions lead them to the first. Last ones are as inside.
        let is_start = |p| matches!(p, StepPosition::First | StepPosition::Second);
        assert!(places.iter().all(|(p, _)| is_start(*p)), "{places:?}");
        for side in Side::BOTH {
            let own = contexts
                .iter()
                .find(|c| (c.position, c.side) == (StepPosition::First, side))
                .unwrap();
            for state in 0..STATES_PER_STEP {
                let statics = &own.offset.means[state * OBSERVATION_COUNT..][..FEATURE_COUNT];
                let mean = statics.iter().sum::<f64>() / FEATURE_COUNT as f64;
                assert!((mean - OFFSET).abs() < 0.03, "state {state}: {mean}");
            }
            // Where one state of a wave ends and the next begins is anyone's guess; how long the step lasts is not.
            let inside = &steps[side.index()].states;
            let durations = inside.iter().zip(&own.offset.log_durations);
            let frames: f64 = durations.map(|(s, o)| s.duration_mean * o.exp()).sum();
            assert!(
                (frames - 1.5 * FRAMES as f64).abs() < 1.0,
                "{frames} frames"
            );
            assert!((own.offset.other_terminal - 0.3).abs() < 1e-6);
        }
    }

    #[test]
    fn one_start_is_a_whim() {
        let (_, contexts, report) = estimated(1);
        assert!(contexts.is_empty());
        assert_eq!((report.models, report.duration_leaves), (2, 1));
        assert_eq!(report.questions, ["is it a left step?"]);
    }
}
