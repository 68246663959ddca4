//! One limb among bones that are named like its joints.

use super::Rig;

/// Bones looked at for one joint: more of one name are no body's.
const MOST_CANDIDATES: usize = 6;

/// A bone that may be a joint.
#[derive(Clone, Copy, Debug)]
pub(super) struct Candidate {
    pub(super) bone: usize,
    /// Place of its name among the joint's names: 0 is preferred.
    pub(super) rank: usize,
}

/// Joints that hang below each other, and their bones.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Chain {
    pub(super) bones: Vec<Option<usize>>,
    /// Bones that would do as well in place of the joint's; its own is left out then.
    pub(super) rivals: Vec<Vec<usize>>,
}

/// The better, the larger: more joints that are needed, more joints, more preferred names, fewer bones between.
type Score = (usize, usize, isize, isize);

/// Finds the bones of joints that hang below each other. `needed` marks those that count most.
pub(super) fn best_chain(rig: &Rig, joints: &[Vec<Candidate>], needed: &[bool]) -> Chain {
    let mut search = Search {
        rig,
        joints,
        needed,
        best: (0, 0, 0, 0),
        found: Vec::new(),
    };
    search.extend(&mut Vec::new(), (0, 0, 0, 0));
    let mut bones = search
        .found
        .first()
        .cloned()
        .unwrap_or_else(|| vec![None; joints.len()]);
    let mut rivals = vec![Vec::new(); joints.len()];
    for other in search.found.iter().skip(1) {
        for (joint, bone) in other.iter().enumerate() {
            if let Some(bone) = *bone
                && search.found[0][joint] != Some(bone)
                && !rivals[joint].contains(&bone)
            {
                rivals[joint].push(bone);
            }
        }
    }
    for (joint, rivals) in rivals.iter_mut().enumerate() {
        if !rivals.is_empty() {
            rivals.extend(bones[joint].take());
            rivals.sort_unstable();
        }
    }
    Chain { bones, rivals }
}

struct Search<'a> {
    rig: &'a Rig,
    joints: &'a [Vec<Candidate>],
    needed: &'a [bool],
    best: Score,
    /// All chains of the best score.
    found: Vec<Vec<Option<usize>>>,
}

impl Search<'_> {
    fn extend(&mut self, chain: &mut Vec<Option<usize>>, score: Score) {
        let joint = chain.len();
        let Some(candidates) = self.joints.get(joint) else {
            if score > self.best {
                self.best = score;
                self.found.clear();
            }
            if score == self.best {
                self.found.push(chain.clone());
            }
            return;
        };
        let above = chain.iter().rev().flatten().next().copied();
        for candidate in candidates.iter().take(MOST_CANDIDATES) {
            let links = match above {
                None => 0,
                Some(above) => match self.rig.links(candidate.bone, above) {
                    Some(links) => links.cast_signed(),
                    None => continue,
                },
            };
            let (needed, count, names, near) = score;
            let needed = needed + usize::from(self.needed[joint]);
            let names = names - candidate.rank.cast_signed();
            chain.push(Some(candidate.bone));
            self.extend(chain, (needed, count + 1, names, near - links));
            chain.pop();
        }
        chain.push(None);
        self.extend(chain, score);
        chain.pop();
    }
}
