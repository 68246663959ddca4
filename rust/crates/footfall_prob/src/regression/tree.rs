//! Gaussians that share a transform.

use crate::error::{ProbError, check_finite, check_len};

/// A class of Gaussians.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RegressionNode {
    /// The class that it is a part of; `None` for the root.
    pub parent: Option<usize>,
    /// Numbers of the Gaussians that belong to it, rising.
    pub members: Vec<usize>,
    /// Steps from the root.
    pub depth: usize,
}

/// A binary tree of classes. The root holds all Gaussians; a node's children share its Gaussians out.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RegressionTree {
    /// Parents before children; the root is first.
    pub nodes: Vec<RegressionNode>,
}

impl RegressionTree {
    /// Splits the Gaussians whose means are `points` (all D values) into two nearby halves, and the halves again, down to
    /// `max_depth`. No class has fewer than `least_members`.
    ///
    /// # Errors
    /// [`ProbError`] when there is no point, shapes differ or a value is not finite.
    pub fn by_distance(
        points: &[&[f64]],
        max_depth: usize,
        least_members: usize,
    ) -> Result<Self, ProbError> {
        let first = points.first().ok_or(ProbError::Empty { what: "points" })?;
        for point in points {
            check_len("point", point.len(), first.len())?;
            check_finite("point", point)?;
        }
        let mut nodes = vec![RegressionNode {
            parent: None,
            members: (0..points.len()).collect(),
            depth: 0,
        }];
        let mut next = 0;
        while next < nodes.len() {
            let RegressionNode { members, depth, .. } = nodes[next].clone();
            if depth < max_depth && members.len() >= 2 * least_members.max(1) {
                let halves = split(points, &members);
                if halves.iter().all(|half| half.len() >= least_members.max(1)) {
                    nodes.extend(halves.map(|members| RegressionNode {
                        parent: Some(next),
                        members,
                        depth: depth + 1,
                    }));
                }
            }
            next += 1;
        }
        Ok(Self { nodes })
    }

    /// The classes in use when the tree is cut at a depth: every Gaussian is in exactly one of them.
    pub fn cut(&self, depth: usize) -> Vec<usize> {
        let is_parent = |index: usize| self.nodes.iter().any(|node| node.parent == Some(index));
        (0..self.nodes.len())
            .filter(|&index| {
                let own = self.nodes[index].depth;
                own == depth || (own < depth && !is_parent(index))
            })
            .collect()
    }

    /// Depth of the deepest class.
    pub fn depth(&self) -> usize {
        self.nodes.iter().map(|node| node.depth).max().unwrap_or(0)
    }
}

/// Two-means from the two points that lie farthest apart.
fn split(points: &[&[f64]], members: &[usize]) -> [Vec<usize>; 2] {
    let mut seeds = (members[0], members[0]);
    for (index, left) in members.iter().enumerate() {
        for right in &members[index + 1..] {
            if distance(points[*left], points[*right]) > distance(points[seeds.0], points[seeds.1])
            {
                seeds = (*left, *right);
            }
        }
    }
    let mut centres = [points[seeds.0].to_vec(), points[seeds.1].to_vec()];
    let mut halves = [vec![], vec![]];
    for _ in 0..20 {
        let near = |member: &usize| {
            distance(points[*member], &centres[0]) <= distance(points[*member], &centres[1])
        };
        let (left, right): (Vec<usize>, Vec<usize>) = members.iter().partition(|m| near(m));
        let next = [left, right];
        if next == halves {
            break;
        }
        halves = next;
        for (centre, half) in centres.iter_mut().zip(&halves) {
            for (dim, value) in centre.iter_mut().enumerate() {
                let sum: f64 = half.iter().map(|member| points[*member][dim]).sum();
                *value = sum / half.len().max(1) as f64;
            }
        }
    }
    halves
}

fn distance(left: &[f64], right: &[f64]) -> f64 {
    left.iter().zip(right).map(|(l, r)| (l - r).powi(2)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn near_points_share_a_class() {
        let points: Vec<Vec<f64>> = [0.0, 0.1, 5.0, 5.2, 0.2, 9.0].map(|x| vec![x, -x]).to_vec();
        let slices: Vec<&[f64]> = points.iter().map(Vec::as_slice).collect();
        let tree = RegressionTree::by_distance(&slices, 2, 1).unwrap();
        assert_eq!(tree.nodes[0].members, [0, 1, 2, 3, 4, 5]);
        let halves: Vec<&[usize]> = tree
            .cut(1)
            .iter()
            .map(|n| &*tree.nodes[*n].members)
            .collect();
        assert_eq!(halves, [&[0, 1, 4][..], &[2, 3, 5]]);
        for depth in 0..4 {
            let mut all: Vec<usize> = tree
                .cut(depth)
                .iter()
                .flat_map(|node| tree.nodes[*node].members.clone())
                .collect();
            all.sort_unstable();
            assert_eq!(all, [0, 1, 2, 3, 4, 5], "cut at {depth}");
        }
    }

    #[test]
    fn equal_points_stay_together() {
        let tree = RegressionTree::by_distance(&[&[1.0], &[1.0], &[1.0]], 3, 1).unwrap();
        assert_eq!(tree.nodes.len(), 1);
        assert!(RegressionTree::by_distance(&[], 3, 1).is_err());
    }
}
