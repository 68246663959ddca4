//! Steps at the ends of a walk: ten contexts, tied by decision trees.
//!
//! A step's context is its place in the walk (first, second, inside, last but one, last) and its foot. Every state's output
//! has a tree of its own, and so have the durations, all five of a step together (Tilmanne et al. 2012, sections 5.1.1 and
//! 5.2.1). What a context's leaves differ from those of the steps inside becomes an offset of the model.

use crate::average::{AverageWalk, DURATION_VARIANCE_FLOOR, STATES, state_index, variance_floor};
use crate::error::TrainError;
use crate::sequence::{LabelledStep, Sequence};
use footfall_core::{Side, StepPosition};
use footfall_model::{
    OBSERVATION_COUNT, STATES_PER_STEP, SpeedResponse, StepContext, StepModel, StepOffset,
};
use footfall_prob::clustering::{ClusterConfig, ContextTree, Question};
use footfall_prob::duration::{DurationDist, DurationStats, GaussianDuration};
use footfall_prob::gaussian::{DiagonalGaussian, GaussianStats, log_densities};
use footfall_prob::hsmm::{Boundary, ChainState, hsmm_viterbi};

/// Five places and two feet.
const CONTEXTS: usize = 2 * StepPosition::ALL.len();

/// How often steps are cut into states and the tied states estimated anew.
const ROUNDS: usize = 4;

/// A context of which fewer steps were seen counts as unseen: they tell of one person's whim.
const LEAST_STEPS: f64 = 4.0;

/// Factor on the description length of a further leaf. Below 1 because a walk's ends are short beside its inside, and
/// because two steps tied that are not alike show: people push off in the second step, not in the first.
const PENALTY: f64 = 0.5;

/// A shorter walk between two stands is a shuffle: it says nothing of how walks begin and end.
const LEAST_WALK_STEPS: usize = 4;

/// Least variance of a duration relative to its mean, as the trees see it: whole frames know no less.
const DURATION_FLOOR: f64 = DURATION_VARIANCE_FLOOR;

/// Which of the ten contexts share a model.
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

/// What can be asked of a context. Nothing is asked that would tie beginnings to ends: one says nothing of the other.
fn questions() -> Vec<Question> {
    use StepPosition::{First, Last, LastButOne, Second};

    let ask = |name: &str, answer: &dyn Fn(StepPosition, Side) -> bool| Question {
        name: name.to_owned(),
        answers: StepPosition::ALL
            .iter()
            .flat_map(|position| Side::BOTH.map(|side| answer(*position, side)))
            .collect(),
    };
    vec![
        ask("is it a left step?", &|_, side| side == Side::Left),
        ask("is it the first step?", &|p, _| p == First),
        ask("is it the second step?", &|p, _| p == Second),
        ask("is it one of the first two?", &|p, _| {
            matches!(p, First | Second)
        }),
        ask("is it one of the last two?", &|p, _| {
            matches!(p, LastButOne | Last)
        }),
        ask("is it the last but one?", &|p, _| p == LastButOne),
        ask("is it the last step?", &|p, _| p == Last),
    ]
}

/// The parameters that a chain of steps is cut by, and which of them each context uses.
struct Tied {
    gaussians: Vec<DiagonalGaussian>,
    durations: Vec<GaussianDuration>,
    /// Per context and state, the place of its Gaussian and of its duration.
    states: Vec<[ChainState; STATES_PER_STEP]>,
}

impl Tied {
    /// All contexts as inside: where cutting begins.
    fn untied(walk: &AverageWalk) -> Self {
        let states = StepPosition::ALL.iter().flat_map(|_| {
            Side::BOTH.map(|side| {
                core::array::from_fn(|state| {
                    let index = state_index(side, state);
                    ChainState {
                        emission: index,
                        duration: index,
                    }
                })
            })
        });
        debug_assert_eq!(walk.gaussians().len(), STATES);
        Self {
            gaussians: walk.gaussians().to_vec(),
            durations: walk.durations().to_vec(),
            states: states.collect(),
        }
    }

    fn estimate(
        trees: &Trees,
        moments: &Moments,
        floor: &[f64],
        walk: &AverageWalk,
    ) -> Result<Self, TrainError> {
        let mut gaussians = Vec::new();
        let mut durations = Vec::new();
        let nothing = ChainState {
            emission: 0,
            duration: 0,
        };
        let mut states = vec![[nothing; STATES_PER_STEP]; CONTEXTS];
        for state in 0..STATES_PER_STEP {
            let tree = &trees.outputs[state];
            for (context, leaf) in tree.leaf_of().iter().enumerate() {
                states[context][state].emission = gaussians.len() + leaf;
            }
            for leaf in 0..tree.leaves() {
                let pooled = pool(tree, leaf, &moments.outputs[state]);
                gaussians.push(pooled.estimate(floor)?);
            }
            for (context, leaf) in trees.durations.leaf_of().iter().enumerate() {
                states[context][state].duration = durations.len() + leaf;
            }
            for leaf in 0..trees.durations.leaves() {
                let pooled = pool(&trees.durations, leaf, &moments.durations);
                let mut seen = DurationStats::new();
                // Two durations have any mean and variance.
                let spread = pooled.variance()[state].sqrt();
                for sign in [-1.0, 1.0] {
                    let frames = pooled.mean()[state] + sign * spread;
                    seen.add(frames.round().max(1.0) as usize, 0.5 * pooled.weight());
                }
                durations.push(seen.estimate(walk.max_duration(), DURATION_VARIANCE_FLOOR)?);
            }
        }
        Ok(Self {
            gaussians,
            durations,
            states,
        })
    }

    /// The boundaries of a walk's states.
    fn cut(
        &self,
        sequence: &Sequence,
        durations: &[DurationDist],
    ) -> Result<Vec<usize>, TrainError> {
        let mut log_emissions = Vec::new();
        log_densities(&self.gaussians, &sequence.observations, &mut log_emissions)?;
        let of_step = |step: &LabelledStep| self.states[context(step.position, step.side)];
        let chain: Vec<ChainState> = sequence.steps.iter().flat_map(of_step).collect();
        let path = hsmm_viterbi(
            &log_emissions,
            self.gaussians.len(),
            &chain,
            durations,
            Boundary::default(),
        )?;
        Ok(path.boundaries)
    }
}

/// What every context looks like.
struct Moments {
    /// Per state and context, the observations.
    outputs: Vec<Vec<GaussianStats>>,
    /// Per context, the five durations of a step in frames.
    durations: Vec<GaussianStats>,
    /// Per context, when the other foot leaves and how fast the walk is, m/s.
    terminals: Vec<GaussianStats>,
    speeds: Vec<GaussianStats>,
}

impl Moments {
    fn gather(tied: &Tied, corpus: &[Sequence], max_duration: usize) -> Result<Self, TrainError> {
        let durations: Vec<DurationDist> = tied
            .durations
            .iter()
            .map(|duration| duration.discretise(max_duration))
            .collect::<Result<_, _>>()?;
        let empty = |dim| vec![GaussianStats::new(dim); CONTEXTS];
        let mut moments = Self {
            outputs: (0..STATES_PER_STEP)
                .map(|_| empty(OBSERVATION_COUNT))
                .collect(),
            durations: empty(STATES_PER_STEP),
            terminals: empty(1),
            speeds: empty(1),
        };
        for sequence in corpus {
            let boundaries = tied.cut(sequence, &durations)?;
            moments.add(sequence, &boundaries);
        }
        Ok(moments)
    }

    fn add(&mut self, sequence: &Sequence, boundaries: &[usize]) {
        let speed = steady_speed(sequence);
        for (number, step) in sequence.steps.iter().enumerate() {
            let context = context(step.position, step.side);
            let mut lengths = [0.0; STATES_PER_STEP];
            for (state, length) in lengths.iter_mut().enumerate() {
                let segment = number * STATES_PER_STEP + state;
                let frames = boundaries[segment]..boundaries[segment + 1];
                *length = frames.len() as f64;
                for frame in frames {
                    let row = &sequence.observations[frame * OBSERVATION_COUNT..];
                    self.outputs[state][context].add(&row[..OBSERVATION_COUNT], 1.0);
                }
            }
            self.durations[context].add(&lengths, 1.0);
            self.speeds[context].add(&[speed], 1.0);
            if let Some(terminal) = step.other_terminal {
                self.terminals[context].add(&[terminal], 1.0);
            }
        }
    }
}

/// How fast the walk is between its ends, m/s.
fn steady_speed(sequence: &Sequence) -> f64 {
    let mean = |steps: &mut dyn Iterator<Item = &LabelledStep>| {
        let (sum, count) = steps.fold((0.0, 0.0), |(s, n), step| (s + step.speed_mps, n + 1.0));
        (count > 0.0).then(|| sum / count)
    };
    let inside = |step: &&LabelledStep| step.position == StepPosition::Inside;
    mean(&mut sequence.steps.iter().filter(inside))
        .or_else(|| mean(&mut sequence.steps.iter()))
        .unwrap_or_default()
}

struct Trees {
    outputs: Vec<ContextTree>,
    durations: ContextTree,
    questions: Vec<Question>,
}

impl Trees {
    fn grow(moments: &Moments, floor: &[f64]) -> Result<Self, TrainError> {
        let questions = questions();
        let seen: Vec<bool> = moments
            .durations
            .iter()
            .map(|steps| steps.weight() >= LEAST_STEPS)
            .collect();
        let known = |all: &[GaussianStats]| -> Vec<GaussianStats> {
            let known = all.iter().zip(&seen).map(|(moments, seen)| {
                if *seen {
                    moments.clone()
                } else {
                    GaussianStats::new(moments.dim())
                }
            });
            known.collect()
        };
        let config = ClusterConfig {
            penalty: PENALTY,
            least_weight: 0.0,
        };
        let outputs = moments.outputs.iter();
        let outputs =
            outputs.map(|outputs| ContextTree::grow(&known(outputs), &questions, floor, &config));
        let duration_floor = [DURATION_FLOOR; STATES_PER_STEP];
        Ok(Self {
            outputs: outputs.collect::<Result<_, _>>()?,
            durations: ContextTree::grow(
                &known(&moments.durations),
                &questions,
                &duration_floor,
                &config,
            )?,
            questions,
        })
    }

    /// What a context's leaves differ from those of the same foot inside a walk of the same speed; `None` when they are the same.
    fn offset(
        &self,
        moments: &Moments,
        position: StepPosition,
        side: Side,
        inside: &StepModel,
        speed: &SpeedResponse,
    ) -> Option<StepOffset> {
        let (here, there) = (context(position, side), context(StepPosition::Inside, side));
        let own = |tree: &ContextTree| {
            let leaf = tree.leaf_of()[here];
            (leaf != tree.leaf_of()[there]).then_some(leaf)
        };
        let faster = |tree: &ContextTree, leaf: usize| {
            pool(tree, leaf, &moments.speeds).mean()[0] - speed.reference_mps
        };
        let slope = &speed.slopes[side.index()];
        let mut offset = StepOffset::zero();
        let mut differs = false;
        for (state, parameters) in inside.states.iter().enumerate() {
            let tree = &self.outputs[state];
            let Some(leaf) = own(tree) else { continue };
            differs = true;
            let deviation = faster(tree, leaf);
            let seen = pool(tree, leaf, &moments.outputs[state]);
            let block = state * OBSERVATION_COUNT..(state + 1) * OBSERVATION_COUNT;
            let pairs = seen.mean().iter().zip(&parameters.mean);
            let rest = offset.means[block.clone()]
                .iter_mut()
                .zip(&slope.means[block]);
            for ((offset, slope), (seen, inside)) in rest.zip(pairs) {
                *offset = seen - (inside + deviation * slope);
            }
        }
        if let Some(leaf) = own(&self.durations) {
            differs = true;
            let deviation = faster(&self.durations, leaf);
            let seen = pool(&self.durations, leaf, &moments.durations);
            for (state, offset) in offset.log_durations.iter_mut().enumerate() {
                let ratio = seen.mean()[state].max(1.0) / inside.states[state].duration_mean;
                *offset = ratio.ln() - deviation * slope.log_durations[state];
            }
            let terminal = pool(&self.durations, leaf, &moments.terminals);
            if terminal.weight() > 0.0 {
                offset.other_terminal =
                    terminal.mean()[0] - (inside.other_terminal + deviation * slope.other_terminal);
            }
        }
        differs.then_some(offset)
    }

    fn report(&self, moments: &Moments) -> ContextReport {
        let trees = || self.outputs.iter().chain([&self.durations]);
        let mut models: Vec<Vec<usize>> = (0..CONTEXTS)
            .map(|context| trees().map(|tree| tree.leaf_of()[context]).collect())
            .collect();
        models.sort();
        models.dedup();
        let mut asked = vec![0; self.questions.len()];
        for question in trees().flat_map(ContextTree::questions) {
            asked[question] += 1;
        }
        let mut order: Vec<usize> = (0..asked.len()).filter(|q| asked[*q] > 0).collect();
        order.sort_by_key(|question| core::cmp::Reverse(asked[*question]));
        let seen = moments.durations.iter();
        ContextReport {
            seen: seen.map(|steps| steps.weight().round() as usize).collect(),
            output_leaves: self.outputs.iter().map(ContextTree::leaves).collect(),
            duration_leaves: self.durations.leaves(),
            models: models.len(),
            questions: order
                .into_iter()
                .map(|question| self.questions[question].name.clone())
                .collect(),
        }
    }
}

/// The moments of all contexts of a leaf together.
fn pool(tree: &ContextTree, leaf: usize, moments: &[GaussianStats]) -> GaussianStats {
    let mut pooled = GaussianStats::new(moments.first().map_or(0, GaussianStats::dim));
    for (moments, at) in moments.iter().zip(tree.leaf_of()) {
        if *at == leaf {
            pooled.merge(moments);
        }
    }
    pooled
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::average::EmConfig;
    use footfall_model::FEATURE_COUNT;

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
