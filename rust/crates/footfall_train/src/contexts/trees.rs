//! Trees of contexts that share their parameters, and the differences of leaves at the ends of a walk from those inside it.

use super::moments::Moments;
use super::{CONTEXTS, ContextReport, LEAST_STEPS, TreeLine, TreeReport, context};
use crate::error::TrainError;
use crate::step_hsmm::DURATION_VARIANCE_FLOOR;
use footfall_core::{Side, StepPosition};
use footfall_model::{OBSERVATION_COUNT, STATES_PER_STEP, SpeedResponse, StepModel, StepOffset};
use footfall_prob::clustering::{ClusterConfig, ContextTree, OutlineNode, Question};
use footfall_prob::gaussian::GaussianStats;

/// Factor on the description length of a further leaf. Below 1 because a walk's ends are short beside its inside, and
/// because two steps tied that are not alike show: people push off in the second step, not in the first.
const PENALTY: f64 = 0.5;

/// Least variance of a duration relative to its mean, as the trees see it: whole frames know no less.
const DURATION_FLOOR: f64 = DURATION_VARIANCE_FLOOR;

/// Questions that can be asked of a context. Nothing is asked that would tie beginnings to ends: one says nothing of the other.
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

pub(super) struct Trees {
    pub(super) outputs: Vec<ContextTree>,
    pub(super) durations: ContextTree,
    pub(super) questions: Vec<Question>,
}

impl Trees {
    pub(super) fn grow(moments: &Moments, floor: &[f64]) -> Result<Self, TrainError> {
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

    /// Difference of a context's leaves from those of the same foot inside a walk of the same speed; `None` when they are the same.
    pub(super) fn offset(
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

    pub(super) fn report(&self, moments: &Moments) -> ContextReport {
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
            trees: self.written_down(),
        }
    }

    fn written_down(&self) -> Vec<TreeReport> {
        let names = (1..=self.outputs.len()).map(|state| format!("output of state {state}"));
        let outputs = names.zip(&self.outputs);
        outputs
            .chain([("durations".to_owned(), &self.durations)])
            .map(|(name, tree)| TreeReport {
                name,
                lines: self.lines(tree),
            })
            .collect()
    }

    fn lines(&self, tree: &ContextTree) -> Vec<TreeLine> {
        let lines = tree.outline().into_iter();
        lines
            .map(|line| TreeLine {
                depth: line.depth,
                answer: line.answer,
                text: match line.node {
                    OutlineNode::Question { question, gain } => {
                        format!("{} (saves {gain:.0} nats)", self.questions[question].name)
                    }
                    OutlineNode::Leaf(contexts) => contexts_in_words(&contexts),
                },
            })
            .collect()
    }
}

/// Contexts by place and foot, both feet of a place together.
fn contexts_in_words(contexts: &[usize]) -> String {
    let places = StepPosition::ALL.into_iter().filter_map(|position| {
        let feet = Side::BOTH.map(|side| contexts.contains(&context(position, side)));
        let name = position.name().replace('_', " ");
        match feet {
            [true, true] => Some(name),
            [true, false] => Some(format!("{name} (left)")),
            [false, true] => Some(format!("{name} (right)")),
            [false, false] => None,
        }
    });
    places.collect::<Vec<_>>().join(", ")
}

/// The moments of all contexts of a leaf together.
pub(super) fn pool(tree: &ContextTree, leaf: usize, moments: &[GaussianStats]) -> GaussianStats {
    let mut pooled = GaussianStats::new(moments.first().map_or(0, GaussianStats::dim));
    for (moments, at) in moments.iter().zip(tree.leaf_of()) {
        if *at == leaf {
            pooled.merge(moments);
        }
    }
    pooled
}
