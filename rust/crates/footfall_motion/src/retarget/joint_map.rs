//! Which joint of a file is which joint of the canonical body, by name.

mod families;

use super::RetargetError;
use crate::bvh::BvhFile;
use footfall_core::{JOINT_COUNT, Joint};
use std::collections::BTreeMap;

/// Names that the joints of the canonical body go by in a family of skeletons.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct JointMap {
    /// What the family is called, for reports and errors.
    pub label: String,
    /// Names of each joint in the order of [`Joint::ALL`], the preferred one first; empty where the family has no such joint.
    ///
    /// Compared without case, without a namespace (`mixamorig:Hips` is `Hips`) and with blanks, dots and dashes as `_`.
    pub names: [Vec<String>; JOINT_COUNT],
}

/// Where the canonical joints are in one file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Placement {
    /// Position in [`BvhFile::joints`] of each canonical joint, where the file has it.
    pub joints: [Option<usize>; JOINT_COUNT],
}

impl Placement {
    /// The joint of the file, where there is one.
    pub fn joint(&self, joint: Joint) -> Option<usize> {
        self.joints[joint.index()]
    }

    /// Joints that retargeting cannot do without and that are not placed. `Neck` stands for itself or the `Head`.
    pub fn missing(&self) -> Vec<Joint> {
        REQUIRED
            .into_iter()
            .filter(|&joint| self.joint(joint).is_none())
            .filter(|&joint| joint != Joint::Neck || self.joint(Joint::Head).is_none())
            .collect()
    }

    fn count(&self) -> usize {
        self.joints.iter().flatten().count()
    }
}

const REQUIRED: [Joint; 12] = [
    Joint::Hips,
    Joint::Neck,
    Joint::LeftUpperArm,
    Joint::LeftLowerArm,
    Joint::RightUpperArm,
    Joint::RightLowerArm,
    Joint::LeftUpperLeg,
    Joint::LeftLowerLeg,
    Joint::LeftFoot,
    Joint::RightUpperLeg,
    Joint::RightLowerLeg,
    Joint::RightFoot,
];

impl JointMap {
    /// The maps of the skeletons that are known by name.
    pub fn known() -> Vec<Self> {
        families::known()
    }

    /// A map from text such as `Hips = "pelvis"` and `Chest = ["spine_02", "spine2"]`, one line for each joint.
    ///
    /// # Errors
    /// [`RetargetError::Map`] for text that is not TOML, keys that are no canonical joint, and values that are no names.
    pub fn from_toml(text: &str) -> Result<Self, RetargetError> {
        let table: BTreeMap<String, toml::Value> =
            toml::from_str(text).map_err(|error| RetargetError::Map(error.to_string()))?;
        let mut names: [Vec<String>; JOINT_COUNT] = Default::default();
        for (key, value) in table {
            let Some(joint) = Joint::from_name(&key) else {
                let known = Joint::ALL.map(Joint::name).join(", ");
                return Err(RetargetError::Map(format!(
                    "{key} is no joint of the canonical body; the joints are {known}"
                )));
            };
            let listed = match value {
                toml::Value::String(name) => vec![name],
                toml::Value::Array(values) => values
                    .iter()
                    .filter_map(|value| value.as_str().map(str::to_owned))
                    .collect(),
                _ => Vec::new(),
            };
            if listed.is_empty() {
                return Err(RetargetError::Map(format!(
                    "{key} needs the name of a joint in the file, in quotes, or a list of names"
                )));
            }
            names[joint.index()] = listed;
        }
        Ok(Self {
            label: "given map".to_owned(),
            names,
        })
    }

    /// Finds the joints in a file; those that it does not have stay `None`.
    ///
    /// A limb's joint counts only below the joint before it, so that a `LeftShoulder` that is the collar bone in one family
    /// and the upper arm in another does not confuse. Where no joint of the trunk between hips and neck is named, the chain
    /// between them is shared out.
    pub fn place(&self, file: &BvhFile) -> Placement {
        let keys: Vec<String> = file.joints.iter().map(|joint| key(&joint.name)).collect();
        let mut joints = [None; JOINT_COUNT];
        for joint in Joint::ALL {
            let above = joint
                .parent()
                .filter(|&parent| is_limb(parent))
                .and_then(|parent| joints[parent.index()]);
            let taken = |index: usize| joints.contains(&Some(index));
            joints[joint.index()] = self.names[joint.index()].iter().find_map(|name| {
                let wanted = key(name);
                (0..keys.len()).find(|&index| {
                    keys[index] == wanted
                        && !taken(index)
                        && above.is_none_or(|above| is_below(file, index, above))
                })
            });
        }
        share_out_trunk(file, &mut joints);
        Placement { joints }
    }

    /// The known map that places the most joints.
    ///
    /// # Errors
    /// [`RetargetError::UnknownSkeleton`] when none places all that is needed.
    pub fn best_fit(file: &BvhFile) -> Result<(Self, Placement), RetargetError> {
        let mut best: Option<(Self, Placement)> = None;
        for map in Self::known() {
            let placement = map.place(file);
            let rank = |placement: &Placement| {
                (
                    std::cmp::Reverse(placement.missing().len()),
                    placement.count(),
                )
            };
            if best
                .as_ref()
                .is_none_or(|(_, found)| rank(&placement) > rank(found))
            {
                best = Some((map, placement));
            }
        }
        match best {
            Some((map, placement)) => {
                map.check(file, &placement)?;
                Ok((map, placement))
            }
            None => Err(RetargetError::Map("no joint maps are known".to_owned())),
        }
    }

    /// Makes sure that all that is needed is placed.
    pub(super) fn check(&self, file: &BvhFile, placement: &Placement) -> Result<(), RetargetError> {
        let missing = placement.missing();
        if missing.is_empty() {
            return Ok(());
        }
        Err(RetargetError::UnknownSkeleton {
            missing,
            map: self.label.clone(),
            joints: file.joints.iter().map(|joint| joint.name.clone()).collect(),
        })
    }
}

/// Whether a joint belongs to an arm or a leg.
fn is_limb(joint: Joint) -> bool {
    joint >= Joint::LeftShoulder
}

/// What of a name counts in comparison.
fn key(name: &str) -> String {
    let name = name.rsplit(':').next().unwrap_or(name);
    let mut key: String = name
        .trim()
        .to_ascii_lowercase()
        .replace([' ', '.', '-'], "_");
    for prefix in ["def_", "org_", "mixamorig_", "j_bip_", "bip01_", "bip001_"] {
        if let Some(rest) = key.strip_prefix(prefix) {
            key = rest.to_owned();
        }
    }
    key
}

/// Whether a joint of the file hangs somewhere below another.
fn is_below(file: &BvhFile, mut joint: usize, above: usize) -> bool {
    while let Some(parent) = file.joints[joint].parent {
        if parent == above {
            return true;
        }
        joint = parent;
    }
    false
}

/// Gives the chain between hips and neck to the canonical joints of the spine when their names are unknown.
fn share_out_trunk(file: &BvhFile, joints: &mut [Option<usize>; JOINT_COUNT]) {
    let trunk = [Joint::Spine, Joint::Chest, Joint::UpperChest];
    if trunk.iter().any(|joint| joints[joint.index()].is_some()) {
        return;
    }
    let (Some(hips), Some(neck)) = (
        joints[Joint::Hips.index()],
        joints[Joint::Neck.index()].or(joints[Joint::Head.index()]),
    ) else {
        return;
    };
    let mut chain = Vec::new();
    let mut at = neck;
    while let Some(parent) = file.joints[at].parent.filter(|&parent| parent != hips) {
        chain.insert(0, parent);
        at = parent;
    }
    if file.joints[at].parent != Some(hips) {
        return;
    }
    let picks: &[usize] = match chain.len() {
        0 => &[],
        1 => &[0],
        2 => &[0, 1],
        n => &[0, n / 2, n - 1],
    };
    for (joint, &pick) in trunk.into_iter().zip(picks) {
        joints[joint.index()] = Some(chain[pick]);
    }
}
