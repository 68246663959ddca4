//! Decision trees that tie contexts: which of many models share one Gaussian (Tilmanne et al. 2012, section 5.1.1).
//!
//! Each context has its own moments, many of them of too little data. A tree of yes-or-no questions about the context splits
//! them top down: of all questions the one that shortens the description of the data most, until none does (minimum
//! description length, K. Shinoda and T. Watanabe, "MDL-based context-dependent subword modeling for speech recognition",
//! 2000). A context without data follows the questions to a leaf that has some.

mod outline;

pub use outline::{OutlineLine, OutlineNode};

use crate::error::{ProbError, check_len};
use crate::gaussian::GaussianStats;

/// A question about contexts.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Question {
    /// Text of the question, for reports.
    pub name: String,
    /// The answer for every context.
    pub answers: Vec<bool>,
}

/// Contexts that share a model.
#[derive(Clone, Debug, PartialEq)]
pub struct ContextTree {
    root: Node,
    leaf_of: Vec<usize>,
    leaves: usize,
}

#[derive(Clone, Debug, PartialEq)]
enum Node {
    Leaf,
    Split {
        question: usize,
        /// Reduction of the description length by the split, nats; positive.
        gain: f64,
        /// For the answers no and yes.
        children: Box<[Self; 2]>,
    },
}

/// Settings for growing a tree.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClusterConfig {
    /// Factor on what a further Gaussian costs: 1 is the description length itself, more makes smaller trees.
    pub penalty: f64,
    /// A split leaves at least this weight (frames) on either side.
    pub least_weight: f64,
}

impl ContextTree {
    /// Grows a tree over contexts whose moments are `stats`.
    ///
    /// `variance_floor` has a value for every dimension.
    ///
    /// # Errors
    /// [`ProbError`] when there is no context or no data at all, or lengths differ.
    pub fn grow(
        stats: &[GaussianStats],
        questions: &[Question],
        variance_floor: &[f64],
        config: &ClusterConfig,
    ) -> Result<Self, ProbError> {
        let first = stats.first().ok_or(ProbError::Empty { what: "contexts" })?;
        check_len("variance_floor", variance_floor.len(), first.dim())?;
        for stats in stats {
            check_len("context moments", stats.dim(), first.dim())?;
        }
        for question in questions {
            check_len("answers", question.answers.len(), stats.len())?;
        }
        let total: f64 = stats.iter().map(GaussianStats::weight).sum();
        if total <= 0.0 {
            return Err(ProbError::NoData {
                what: "a tree of contexts",
            });
        }
        let grower = Grower {
            stats,
            questions,
            variance_floor,
            least_weight: config.least_weight,
            // A diagonal Gaussian has two numbers a dimension, each described by ½ ln of how much data there is.
            leaf_cost: config.penalty * first.dim() as f64 * total.ln().max(0.0),
        };
        let mut leaf_of = vec![0; stats.len()];
        let mut leaves = 0;
        let all: Vec<usize> = (0..stats.len()).collect();
        let root = grower.grow(&all, &mut leaf_of, &mut leaves);
        Ok(Self {
            root,
            leaf_of,
            leaves,
        })
    }

    /// Number of leaves.
    pub fn leaves(&self) -> usize {
        self.leaves
    }

    /// The leaf of every context, seen or not.
    pub fn leaf_of(&self) -> &[usize] {
        &self.leaf_of
    }

    /// Reduction of the description length by all splits, nats.
    pub fn gain(&self) -> f64 {
        fn sum(node: &Node) -> f64 {
            match node {
                Node::Leaf => 0.0,
                Node::Split { gain, children, .. } => gain + children.iter().map(sum).sum::<f64>(),
            }
        }
        sum(&self.root)
    }

    /// Indices of the questions that the tree asks, parents before children.
    pub fn questions(&self) -> Vec<usize> {
        fn visit(node: &Node, asked: &mut Vec<usize>) {
            if let Node::Split {
                question, children, ..
            } = node
            {
                asked.push(*question);
                children.iter().for_each(|child| visit(child, asked));
            }
        }
        let mut asked = Vec::new();
        visit(&self.root, &mut asked);
        asked
    }
}

struct Grower<'a> {
    stats: &'a [GaussianStats],
    questions: &'a [Question],
    variance_floor: &'a [f64],
    least_weight: f64,
    leaf_cost: f64,
}

impl Grower<'_> {
    fn grow(&self, contexts: &[usize], leaf_of: &mut [usize], leaves: &mut usize) -> Node {
        if let Some((question, gain)) = self.best_question(contexts) {
            let answers = &self.questions[question].answers;
            let children = [false, true].map(|answer| {
                let chosen = contexts.iter().copied();
                let chosen: Vec<usize> = chosen.filter(|c| answers[*c] == answer).collect();
                self.grow(&chosen, leaf_of, leaves)
            });
            return Node::Split {
                question,
                gain,
                children: Box::new(children),
            };
        }
        for context in contexts {
            leaf_of[*context] = *leaves;
        }
        *leaves += 1;
        Node::Leaf
    }

    fn best_question(&self, contexts: &[usize]) -> Option<(usize, f64)> {
        let whole = self.misfit(&self.pool(contexts.iter()));
        let gains = self.questions.iter().enumerate().map(|(index, question)| {
            let parts = [false, true].map(|answer| {
                self.pool(contexts.iter().filter(|c| question.answers[**c] == answer))
            });
            let is_fed = parts
                .iter()
                .all(|part| part.weight() > 0.0 && part.weight() >= self.least_weight);
            let gain = if is_fed {
                whole - parts.iter().map(|part| self.misfit(part)).sum::<f64>() - self.leaf_cost
            } else {
                f64::NEG_INFINITY
            };
            (index, gain)
        });
        gains
            .filter(|(_, gain)| *gain > 0.0)
            .max_by(|a, b| a.1.total_cmp(&b.1))
    }

    fn pool<'c>(&self, contexts: impl Iterator<Item = &'c usize>) -> GaussianStats {
        let mut pooled = GaussianStats::new(self.variance_floor.len());
        for context in contexts {
            pooled.merge(&self.stats[*context]);
        }
        pooled
    }

    /// The part of the negative log-likelihood that depends on the split: ½ Γ ln |Σ|.
    fn misfit(&self, pooled: &GaussianStats) -> f64 {
        let variance = pooled.variance();
        let floored = variance.iter().zip(self.variance_floor);
        0.5 * pooled.weight() * floored.map(|(v, floor)| v.max(*floor).ln()).sum::<f64>()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const CONFIG: ClusterConfig = ClusterConfig {
        penalty: 1.0,
        least_weight: 0.0,
    };

    fn moments(centre: f64, count: usize) -> GaussianStats {
        let mut stats = GaussianStats::new(2);
        for i in 0..count {
            let wave = (i as f64 * 2.4).sin();
            stats.add(&[centre + wave, 3.0 - centre + (i as f64 * 1.1).cos()], 1.0);
        }
        stats
    }

    /// One question for every context, and one for the lower half.
    fn questions(contexts: usize) -> Vec<Question> {
        let single = (0..contexts).map(|asked| Question {
            name: format!("is it {asked}?"),
            answers: (0..contexts).map(|context| context == asked).collect(),
        });
        let half = Question {
            name: "is it of the lower half?".to_owned(),
            answers: (0..contexts)
                .map(|context| context < contexts / 2)
                .collect(),
        };
        single.chain([half]).collect()
    }

    #[test]
    fn contexts_of_one_kind_share_a_leaf_and_unseen_ones_find_it() {
        // 0 to 2 are of one kind, 3 and 4 of another, 5 was never seen and is of the upper half, with 3 and 4.
        let stats = [0.0, 0.02, -0.01, 4.0, 4.01]
            .map(|centre| moments(centre, 60))
            .into_iter()
            .chain([GaussianStats::new(2)])
            .collect::<Vec<_>>();
        let tree = ContextTree::grow(&stats, &questions(6), &[1e-6; 2], &CONFIG).unwrap();
        assert_eq!(tree.leaves(), 2);
        let leaf = tree.leaf_of();
        assert_eq!(leaf[0], leaf[1]);
        assert_eq!(leaf[0], leaf[2]);
        assert_eq!(leaf[3], leaf[4]);
        assert_eq!(leaf[3], leaf[5]);
        assert_ne!(leaf[0], leaf[3]);
        assert_eq!(tree.questions(), [6]);
    }

    #[test]
    fn a_context_with_next_to_no_data_is_tied() {
        let stats = vec![moments(0.0, 200), moments(0.0, 200), moments(1.5, 1)];
        let tree = ContextTree::grow(&stats, &questions(3), &[0.1; 2], &CONFIG).unwrap();
        assert_eq!(tree.leaves(), 1);
        let bold = ClusterConfig {
            least_weight: 30.0,
            penalty: 0.0,
        };
        let tree = ContextTree::grow(&stats, &questions(3), &[1e-6; 2], &bold).unwrap();
        assert!(tree.leaf_of()[..2].contains(&tree.leaf_of()[2]));
    }

    #[test]
    fn bad_input_is_named() {
        let none: [GaussianStats; 0] = [];
        assert!(matches!(
            ContextTree::grow(&none, &[], &[1.0; 2], &CONFIG),
            Err(ProbError::Empty { .. })
        ));
        let empty = [GaussianStats::new(2), GaussianStats::new(2)];
        assert!(matches!(
            ContextTree::grow(&empty, &[], &[1.0; 2], &CONFIG),
            Err(ProbError::NoData { .. })
        ));
        assert!(matches!(
            ContextTree::grow(&[moments(0.0, 5)], &questions(2), &[1.0; 2], &CONFIG),
            Err(ProbError::Shape { .. })
        ));
        assert!(matches!(
            ContextTree::grow(&[moments(0.0, 5)], &[], &[1.0; 3], &CONFIG),
            Err(ProbError::Shape { .. })
        ));
    }

    /// The description length written out: the log density of every leaf's data under its own Gaussian, by definition.
    fn description(stats: &[GaussianStats], leaf_of: &[usize], leaves: usize) -> f64 {
        let total: f64 = stats.iter().map(GaussianStats::weight).sum();
        let mut length = leaves as f64 * 2.0 * total.ln();
        for leaf in 0..leaves {
            let mut pooled = GaussianStats::new(2);
            for (stats, at) in stats.iter().zip(leaf_of) {
                if *at == leaf {
                    pooled.merge(stats);
                }
            }
            for variance in pooled.variance() {
                let density = (core::f64::consts::TAU * variance.max(1e-6)).ln() + 1.0;
                length += 0.5 * pooled.weight() * density;
            }
        }
        length
    }

    proptest! {
        /// The gain that a tree reports is the difference of two descriptions written out, and no question asked of a leaf would
        /// shorten the description further.
        #[test]
        fn a_tree_stops_where_no_split_pays(
            centres in proptest::collection::vec(-3.0_f64..3.0, 6),
            counts in proptest::collection::vec(3_usize..40, 6),
        ) {
            let stats: Vec<GaussianStats> =
                centres.iter().zip(&counts).map(|(centre, count)| moments(*centre, *count)).collect();
            let questions = questions(6);
            let tree = ContextTree::grow(&stats, &questions, &[1e-6; 2], &CONFIG).unwrap();
            let one = description(&stats, &[0; 6], 1);
            let found = description(&stats, tree.leaf_of(), tree.leaves());
            prop_assert!((one - found - tree.gain()).abs() < 1e-6 * one.abs().max(1.0));
            for leaf in 0..tree.leaves() {
                for question in &questions {
                    let split: Vec<usize> = tree.leaf_of().iter().zip(&question.answers)
                        .map(|(at, yes)| if *at == leaf && *yes { tree.leaves() } else { *at })
                        .collect();
                    let further = description(&stats, &split, tree.leaves() + 1);
                    prop_assert!(further > found - 1e-6, "{} would pay", question.name);
                }
            }
        }
    }
}
