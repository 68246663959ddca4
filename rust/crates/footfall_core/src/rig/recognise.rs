//! The family that a rig is of, and its joints.

use super::names::{Keys, Purpose};
use super::placing::{MapKeys, Placed, place};
use super::{JointMap, Placement, Rig};
use crate::Joint;
use std::cmp::Reverse;

/// The joints that were recognised in a rig.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Recognition {
    /// Label of the map that fits best.
    pub family: String,
    /// Placement of the joints.
    pub placement: Placement,
    /// Reasons why joints were left out.
    pub doubts: Vec<Doubt>,
}

/// A reason why a joint was left out, although bones are named like it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Doubt {
    /// Several bones fit one joint equally well.
    Several {
        /// The joint.
        joint: Joint,
        /// The bones, all of them.
        bones: Vec<usize>,
    },
    /// The bone that is named like the hips does not carry the whole body.
    Apart {
        /// The bone.
        bone: usize,
        /// A bone of the body that does not hang from it.
        apart: usize,
    },
}

impl Doubt {
    /// The reason with the bones' names, as a sentence without its full stop.
    pub fn describe(&self, rig: &Rig) -> String {
        let name = |bone: usize| rig.names().get(bone).map_or("?", String::as_str);
        match self {
            Self::Several { joint, bones } => {
                let listed: Vec<&str> = bones.iter().map(|&bone| name(bone)).collect();
                let listed = listed.join(", ");
                format!("{} may be any of {listed}", joint.name())
            }
            Self::Apart { bone, apart } => format!(
                "{} is named like the Hips, but {} does not hang from it",
                name(*bone),
                name(*apart)
            ),
        }
    }
}

/// Finds the joints of the canonical body in a rig of any family that is [known](JointMap::known).
pub fn recognise(rig: &Rig) -> Recognition {
    best_of(rig, &JointMap::known())
}

impl JointMap {
    /// Finds the joints of this map in a rig.
    pub fn place(&self, rig: &Rig) -> Recognition {
        best_of(rig, core::slice::from_ref(self))
    }
}

/// The better, the larger: fewer joints missing, bones more likely to deform, more joints, a trunk with the map's names.
type Rank = (Reverse<usize>, Reverse<Purpose>, usize, bool);

/// The map and the body among the bones that together place the most.
fn best_of(rig: &Rig, maps: &[JointMap]) -> Recognition {
    let keys = Keys::of(rig);
    let mut best: Option<(Rank, Recognition)> = None;
    let mut rival: Option<Recognition> = None;
    for map in maps {
        let map_keys = MapKeys::of(map);
        for view in keys.views(&map_keys.anchors()) {
            let Placed {
                placement,
                doubts,
                has_named_trunk,
            } = place(rig, &view, &map_keys);
            let rank = (
                Reverse(placement.missing().len()),
                Reverse(view.purpose()),
                placement.count(),
                has_named_trunk,
            );
            let found = Recognition {
                family: map.label.clone(),
                placement,
                doubts,
            };
            match &best {
                Some((known, best)) if rank == *known => {
                    if are_apart(&best.placement, &found.placement) {
                        rival = Some(found);
                    }
                }
                Some((known, _)) if rank < *known => {}
                _ => {
                    best = Some((rank, found));
                    rival = None;
                }
            }
        }
    }
    let Some((_, mut best)) = best else {
        return Recognition {
            family: "no".to_owned(),
            placement: Placement::default(),
            doubts: Vec::new(),
        };
    };
    if let Some(rival) = rival {
        leave_out_both(&mut best, &rival);
    }
    best
}

/// Returns true when two placements are of two bodies.
fn are_apart(a: &Placement, b: &Placement) -> bool {
    a.count() > 0
        && a.joints
            .iter()
            .flatten()
            .all(|bone| !b.joints.contains(&Some(*bone)))
}

/// A rig with two whole bodies: nothing says which of them is meant.
fn leave_out_both(best: &mut Recognition, rival: &Recognition) {
    best.doubts.clear();
    let bones: Vec<usize> = [best, rival]
        .into_iter()
        .filter_map(|found| found.placement.joint(Joint::Hips))
        .collect();
    best.placement = Placement::default();
    if !bones.is_empty() {
        best.doubts.push(Doubt::Several {
            joint: Joint::Hips,
            bones,
        });
    }
}
