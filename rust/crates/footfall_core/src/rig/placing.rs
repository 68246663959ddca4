//! The joints of one family's map among the bones of one body: limbs first, then the hips that carry them, then the trunk between.

use super::chain::{Candidate, Chain, best_chain};
use super::names::{View, key};
use super::recognise::Doubt;
use super::{JointMap, Placement, Rig};
use crate::{JOINT_COUNT, Joint};

/// Names that are a pelvis in some rigs and a point on the floor in others.
const AMBIGUOUS: [&str; 5] = ["root", "rootx", "torso", "body", "bone"];

/// The keys of a map's names.
pub(super) struct MapKeys([Vec<String>; JOINT_COUNT]);

impl MapKeys {
    pub(super) fn of(map: &JointMap) -> Self {
        let keys = |names: &Vec<String>| names.iter().map(|name| key(name)).collect();
        Self(core::array::from_fn(|joint| keys(&map.names[joint])))
    }

    /// Names from which a body is recognised.
    pub(super) fn anchors(&self) -> Vec<String> {
        let of = |joint: Joint| self.0[joint.index()].iter().cloned();
        of(Joint::Hips).chain(of(Joint::Head)).collect()
    }
}

/// The joints of a map among the bones of a body.
pub(super) struct Placed {
    pub(super) placement: Placement,
    pub(super) doubts: Vec<Doubt>,
    /// True when the trunk's bones have the map's names. Where they have not, the bones that there are were shared out, which any map can do.
    pub(super) has_named_trunk: bool,
}

/// Places the joints of a map among the bones of a body.
pub(super) fn place(rig: &Rig, view: &View<'_>, keys: &MapKeys) -> Placed {
    let mut placing = Placing {
        rig,
        view,
        keys,
        placement: Placement::default(),
        doubts: Vec::new(),
    };
    let mut limb = |first: Joint, needed: [bool; 4]| {
        let joints = [0, 1, 2, 3].map(|n| Joint::ALL[first.index() + n]);
        placing.place_chain(&joints, &needed, |_| true);
    };
    for shoulder in [Joint::LeftShoulder, Joint::RightShoulder] {
        limb(shoulder, [false, true, true, true]);
    }
    for upper_leg in [Joint::LeftUpperLeg, Joint::RightUpperLeg] {
        limb(upper_leg, [true, true, true, false]);
    }
    placing.place_chain(&[Joint::Neck, Joint::Head], &[false, true], |_| true);
    placing.place_hips();
    let has_named_trunk = placing.place_trunk();
    Placed {
        placement: placing.placement,
        doubts: placing.doubts,
        has_named_trunk,
    }
}

struct Placing<'a> {
    rig: &'a Rig,
    view: &'a View<'a>,
    keys: &'a MapKeys,
    placement: Placement,
    doubts: Vec<Doubt>,
}

impl Placing<'_> {
    /// Bones that are named like a joint.
    fn candidates(&self, joint: Joint) -> Vec<Candidate> {
        let keys = self.keys.0[joint.index()].iter().enumerate();
        keys.flat_map(|(rank, key)| {
            let bones = self.view.named(key).iter();
            bones.map(move |&bone| Candidate { bone, rank })
        })
        .collect()
    }

    fn place_chain(&mut self, joints: &[Joint], needed: &[bool], fits: impl Fn(usize) -> bool) {
        let candidates: Vec<Vec<Candidate>> = joints
            .iter()
            .map(|&joint| {
                let mut candidates = self.candidates(joint);
                candidates.retain(|candidate| fits(candidate.bone));
                candidates
            })
            .collect();
        let Chain { bones, rivals } = best_chain(self.rig, &candidates, needed);
        for ((&joint, bone), rivals) in joints.iter().zip(bones).zip(rivals) {
            self.placement.joints[joint.index()] = bone;
            if !rivals.is_empty() {
                self.doubts.push(Doubt::Several {
                    joint,
                    bones: rivals,
                });
            }
        }
    }

    /// The ends of the body that hang from the hips, as far as they are placed.
    fn carried(&self) -> Vec<usize> {
        let neck = self.placement.joint(Joint::Neck);
        [
            self.placement.joint(Joint::LeftUpperLeg),
            self.placement.joint(Joint::RightUpperLeg),
            neck.or(self.placement.joint(Joint::Head)),
            self.placement.joint(Joint::LeftUpperArm),
            self.placement.joint(Joint::RightUpperArm),
        ]
        .into_iter()
        .flatten()
        .collect()
    }

    /// The hips are the bone of that name from which the whole body hangs.
    fn place_hips(&mut self) {
        let carried = self.carried();
        let carries_all = |bone: usize| carried.iter().all(|&below| self.rig.is_below(below, bone));
        let lowest = carried
            .first()
            .and_then(|&first| self.rig.above(first).find(|&bone| carries_all(bone)));
        let is_certain = |bone: usize| {
            let is_ambiguous = AMBIGUOUS
                .iter()
                .any(|name| self.view.named(name).contains(&bone));
            !is_ambiguous || lowest == Some(bone)
        };
        let named = self.candidates(Joint::Hips);
        let fit: Vec<Candidate> = named
            .iter()
            .copied()
            .filter(|found| carries_all(found.bone) && is_certain(found.bone))
            .collect();
        let Some(preferred) = fit.iter().map(|found| found.rank).min() else {
            if let Some(found) = named.iter().find(|found| is_certain(found.bone)) {
                let bone = found.bone;
                if let Some(&apart) = carried
                    .iter()
                    .find(|&&below| !self.rig.is_below(below, bone))
                {
                    self.doubts.push(Doubt::Apart { bone, apart });
                }
            }
            return;
        };
        let best: Vec<usize> = fit
            .iter()
            .filter(|found| found.rank == preferred)
            .map(|found| found.bone)
            .collect();
        match best[..] {
            [bone] => self.placement.joints[Joint::Hips.index()] = Some(bone),
            _ => self.doubts.push(Doubt::Several {
                joint: Joint::Hips,
                bones: best,
            }),
        }
    }

    /// Places the trunk: the bones that carry arms and head and not the legs. Returns true where names distinguish them; otherwise they are shared out.
    fn place_trunk(&mut self) -> bool {
        const TRUNK: [Joint; 3] = [Joint::Spine, Joint::Chest, Joint::UpperChest];
        let Some(hips) = self.placement.joint(Joint::Hips) else {
            return false;
        };
        let legs = [Joint::LeftUpperLeg, Joint::RightUpperLeg].map(|leg| self.placement.joint(leg));
        let above: Vec<usize> = self
            .carried()
            .into_iter()
            .filter(|&bone| !legs.contains(&Some(bone)))
            .collect();
        let Some(&top) = above.first() else {
            return false;
        };
        let carries_legs = |bone: usize| {
            let mut legs = legs.iter().flatten();
            legs.any(|&leg| self.rig.is_below(leg, bone))
        };
        let between = |ends: &[usize]| -> Vec<usize> {
            let above = self.rig.above(top).take_while(|&bone| bone != hips);
            let carries_ends = |bone: usize| ends.iter().all(|&end| self.rig.is_below(end, bone));
            let trunk = above.filter(|&bone| carries_ends(bone) && !carries_legs(bone));
            let mut chain: Vec<usize> = trunk.collect();
            chain.reverse();
            chain
        };
        let mut chain = between(&above);
        if chain.is_empty() {
            chain = between(&[top]);
        }
        self.place_chain(&TRUNK, &[true, false, false], |bone| chain.contains(&bone));
        if self.placement.joint(Joint::Spine).is_some() {
            return true;
        }
        self.doubts.retain(
            |doubt| !matches!(doubt, Doubt::Several { joint, .. } if TRUNK.contains(joint)),
        );
        let picks: &[usize] = match chain.len() {
            0 => &[],
            1 => &[0],
            2 => &[0, 1],
            n => &[0, n / 2, n - 1],
        };
        for (n, joint) in TRUNK.into_iter().enumerate() {
            self.placement.joints[joint.index()] = picks.get(n).map(|&pick| chain[pick]);
        }
        false
    }
}
