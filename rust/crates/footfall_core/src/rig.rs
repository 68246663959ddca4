//! Rigs: the bones of a character, and recognition of the joints of the canonical body among them.
//!
//! Every tool names bones in its own way, and names alone mislead: `shoulder` is a collar bone here and an upper arm there, `root` is
//! a pelvis or a point on the floor, twist bones and IK targets are named like the bones that they serve. So names propose, and structure
//! decides: [`recognise`]. A joint that stays uncertain is left out and reported as a [`Doubt`].

mod chain;
mod families;
mod joint_map;
mod names;
mod placing;
mod recognise;

pub use joint_map::{JointMap, Placement};
pub use recognise::{Doubt, Recognition, recognise};

/// Names of bones, and what each hangs from.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Rig {
    names: Vec<String>,
    parents: Vec<Option<usize>>,
}

impl Rig {
    /// Bones in any order. A parent that does not exist, or that would close a circle, counts as none.
    pub fn new(bones: impl IntoIterator<Item = (String, Option<usize>)>) -> Self {
        let (names, parents): (Vec<_>, Vec<_>) = bones.into_iter().unzip();
        let mut rig = Self { names, parents };
        for bone in 0..rig.len() {
            if rig.parents[bone].is_some_and(|parent| parent >= rig.len()) {
                rig.parents[bone] = None;
            }
        }
        for bone in 0..rig.len() {
            if rig.above(bone).take(rig.len() + 1).count() > rig.len() {
                rig.parents[bone] = None;
            }
        }
        rig
    }

    /// Number of bones.
    pub fn len(&self) -> usize {
        self.names.len()
    }

    /// Returns true when there is no bone.
    pub fn is_empty(&self) -> bool {
        self.names.is_empty()
    }

    /// The names of all bones.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// The bone that a bone hangs from.
    pub fn parent(&self, bone: usize) -> Option<usize> {
        self.parents.get(bone).copied().flatten()
    }

    /// All bones above one, nearest first.
    pub fn above(&self, bone: usize) -> impl Iterator<Item = usize> {
        core::iter::successors(self.parent(bone), |above| self.parent(*above))
    }

    /// Number of links from a bone up to another; `None` where that is not above it.
    pub fn links(&self, bone: usize, above: usize) -> Option<usize> {
        self.above(bone)
            .position(|found| found == above)
            .map(|n| n + 1)
    }

    /// Returns true when a bone hangs somewhere below another.
    pub fn is_below(&self, bone: usize, above: usize) -> bool {
        self.links(bone, above).is_some()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn circles_and_parents_that_do_not_exist_are_cut() {
        let bone = |parent: Option<usize>| ("bone".to_owned(), parent);
        let rig = Rig::new([bone(Some(1)), bone(Some(2)), bone(Some(0)), bone(Some(9))]);
        assert!((0..4).all(|bone| rig.above(bone).count() < 4));
        assert_eq!(rig.parent(3), None);
        assert!(recognise(&rig).placement.joints.iter().all(Option::is_none));
    }
}
