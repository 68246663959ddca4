//! Trees written down.

use super::{ContextTree, Node};

/// A line of a tree written down.
#[derive(Clone, Debug, PartialEq)]
pub struct OutlineLine {
    /// Number of questions that lead here.
    pub depth: usize,
    /// The answer that led here from the question above; `None` at the root.
    pub answer: Option<bool>,
    /// Question or leaf at this place.
    pub node: OutlineNode,
}

/// Content of a place in a tree.
#[derive(Clone, Debug, PartialEq)]
pub enum OutlineNode {
    /// A question, by its index, and what it shortens the description by, nats.
    Question {
        /// Index of the question.
        question: usize,
        /// Nats.
        gain: f64,
    },
    /// The contexts of a leaf.
    Leaf(Vec<usize>),
}

impl ContextTree {
    /// The tree as lines, parents before children, the answer no before yes.
    pub fn outline(&self) -> Vec<OutlineLine> {
        let mut lines = Vec::new();
        let mut next_leaf = 0;
        self.write_down(&self.root, 0, None, &mut next_leaf, &mut lines);
        lines
    }

    fn write_down(
        &self,
        node: &Node,
        depth: usize,
        answer: Option<bool>,
        next_leaf: &mut usize,
        lines: &mut Vec<OutlineLine>,
    ) {
        let node = match node {
            Node::Leaf => {
                let leaf = *next_leaf;
                *next_leaf += 1;
                let contexts = (0..self.leaf_of.len()).filter(|c| self.leaf_of[*c] == leaf);
                OutlineNode::Leaf(contexts.collect())
            }
            Node::Split {
                question,
                gain,
                children,
            } => {
                lines.push(OutlineLine {
                    depth,
                    answer,
                    node: OutlineNode::Question {
                        question: *question,
                        gain: *gain,
                    },
                });
                // Leaves are numbered in the order in which the tree grew: no before yes.
                for (answer, child) in [false, true].into_iter().zip(children.iter()) {
                    self.write_down(child, depth + 1, Some(answer), next_leaf, lines);
                }
                return;
            }
        };
        lines.push(OutlineLine {
            depth,
            answer,
            node,
        });
    }
}
