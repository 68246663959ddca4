//! Assignment of a file's joints to those of the canonical body: as given, or as [recognised](footfall_core::rig).

use super::RetargetError;
use crate::bvh::BvhFile;
use footfall_core::rig::{JointMap, Placement, Recognition, recognise};
use footfall_core::{JOINT_COUNT, Joint, Rig};
use std::collections::BTreeMap;

/// A map from text such as `Hips = "pelvis"` and `Chest = ["spine_02", "spine2"]`, one line for each joint.
///
/// # Errors
/// [`RetargetError::Map`] for text that is not TOML, keys that are no canonical joint, and values that are no names.
pub fn parse_joint_map(text: &str) -> Result<JointMap, RetargetError> {
    let table: BTreeMap<String, toml::Value> =
        toml::from_str(text).map_err(|error| RetargetError::Map(error.to_string()))?;
    let mut names: [Vec<String>; JOINT_COUNT] = Default::default();
    for (key, value) in table {
        let Some(joint) = Joint::from_name(&key) else {
            let known = Joint::ALL.map(Joint::name).join(", ");
            return Err(RetargetError::Map(format!(
                "{key} is not a joint of the canonical body; the joints are {known}"
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
    Ok(JointMap {
        label: "given map".to_owned(),
        names,
    })
}

/// Places the joints of a file by the map, or by the family that is recognised, and names the map.
///
/// # Errors
/// [`RetargetError::UnknownSkeleton`] when not all that is needed is placed.
pub(super) fn place(
    file: &BvhFile,
    map: Option<&JointMap>,
) -> Result<(String, Placement), RetargetError> {
    let bones = file.joints.iter();
    let rig = Rig::new(bones.map(|joint| (joint.name.clone(), joint.parent)));
    let Recognition {
        family,
        placement,
        doubts,
    } = match map {
        Some(map) => map.place(&rig),
        None => recognise(&rig),
    };
    let missing = placement.missing();
    if missing.is_empty() {
        return Ok((family, placement));
    }
    let doubts = doubts.iter().map(|doubt| doubt.describe(&rig));
    let reasons: Vec<String> = std::iter::once(String::new()).chain(doubts).collect();
    Err(RetargetError::UnknownSkeleton {
        missing,
        map: family,
        doubts: reasons.join("; "),
        joints: rig.names().to_vec(),
    })
}
