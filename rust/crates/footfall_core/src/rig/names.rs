//! Names made comparable: what of a bone's name says which bone it is.

use super::Rig;
use std::collections::{BTreeSet, HashMap};

/// Words that end every name of some rigs.
const SUFFIXES: [&str; 5] = ["jnt", "joint", "bone", "bind", "bnd"];
/// Share of the bones that a suffix must end to be no part of the names.
const MOST: f32 = 0.8;
/// Share of the bones that need a number of their own for numbers to be no part of the names: `spine_01` keeps its own.
const NUMBERED: f32 = 0.3;

/// The keys of all bones of a rig.
#[derive(Clone, Debug)]
pub(super) struct Keys(Vec<String>);

/// A body among the bones: those whose names begin alike.
#[derive(Clone, Debug)]
pub(super) struct View<'a> {
    /// Begin of the names that belong to it.
    pub(super) prefix: &'a str,
    bones: HashMap<&'a str, Vec<usize>>,
}

/// Purpose of bones with a prefix, those that most likely move the mesh first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Purpose {
    /// Named so by rigs that have others too.
    Deforming,
    /// Nothing is said.
    Unsaid,
    /// They steer others.
    Steering,
}

impl Keys {
    pub(super) fn of(rig: &Rig) -> Self {
        let names = without_numbers(rig.names());
        let mut keys: Vec<String> = names.iter().map(|name| key(name)).collect();
        for suffix in SUFFIXES {
            let ending = keys.iter().filter(|key| key.ends_with(suffix)).count();
            if ending as f32 > MOST * keys.len() as f32 {
                for key in &mut keys {
                    key.truncate(key.strip_suffix(suffix).map_or(key.len(), str::len));
                }
            }
        }
        Self(keys)
    }

    /// The bodies that the bones may be, by bones that end like one of these.
    pub(super) fn views<'a>(&'a self, anchors: &[String]) -> Vec<View<'a>> {
        let mut prefixes: BTreeSet<&str> = BTreeSet::from([""]);
        for key in &self.0 {
            prefixes.extend(
                anchors
                    .iter()
                    .filter_map(|anchor| key.strip_suffix(anchor.as_str())),
            );
        }
        prefixes
            .into_iter()
            .map(|prefix| self.view(prefix))
            .collect()
    }

    fn view<'a>(&'a self, prefix: &'a str) -> View<'a> {
        let mut bones: HashMap<&str, Vec<usize>> = HashMap::new();
        for (bone, key) in self.0.iter().enumerate() {
            if let Some(rest) = key.strip_prefix(prefix) {
                bones.entry(rest).or_default().push(bone);
            }
        }
        View { prefix, bones }
    }
}

impl View<'_> {
    /// The bones with this key.
    pub(super) fn named(&self, key: &str) -> &[usize] {
        self.bones.get(key).map_or(&[], Vec::as_slice)
    }

    pub(super) fn purpose(&self) -> Purpose {
        const STEERING: [&str; 12] = [
            "org", "mch", "ctrl", "ctl", "control", "ik", "fk", "tweak", "vis", "wgt", "target",
            "proxy",
        ];
        match self.prefix {
            "def" | "deform" => Purpose::Deforming,
            prefix if STEERING.contains(&prefix) => Purpose::Steering,
            _ => Purpose::Unsaid,
        }
    }
}

/// Form of a name for comparison: letters and digits after the last namespace, in lower case.
pub(super) fn key(name: &str) -> String {
    name.rsplit([':', '|'])
        .next()
        .unwrap_or(name)
        .chars()
        .filter(|letter| letter.is_alphanumeric())
        .flat_map(char::to_lowercase)
        .collect()
}

/// Names without the running number that some exporters put behind every one of them.
fn without_numbers(names: &[String]) -> Vec<&str> {
    let number = |name: &str| {
        let (rest, number) = name.rsplit_once('_')?;
        let is_number = !number.is_empty() && number.bytes().all(|digit| digit.is_ascii_digit());
        (is_number && !rest.is_empty()).then(|| number.to_owned())
    };
    let distinct: BTreeSet<String> = names.iter().filter_map(|name| number(name)).collect();
    let is_numbered = names.len() > 1 && distinct.len() as f32 > NUMBERED * names.len() as f32;
    let shorten =
        |name: &'_ String| number(name).map_or(name.len(), |number| name.len() - number.len() - 1);
    names
        .iter()
        .map(|name| {
            if is_numbered {
                &name[..shorten(name)]
            } else {
                name.as_str()
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_keep_what_tells_bones_apart() {
        assert_eq!(key("Armature|mixamorig:LeftUpLeg"), "leftupleg");
        assert_eq!(key("DEF-thigh.L.001"), "defthighl001");
        assert_eq!(key("Bip01 L UpperArm"), "bip01lupperarm");
    }

    #[test]
    fn running_numbers_go_and_numbers_that_name_stay() {
        let numbered: Vec<String> = ["Hips_01", "Spine_02", "Spine1_03"]
            .map(str::to_owned)
            .into();
        assert_eq!(without_numbers(&numbered), ["Hips", "Spine", "Spine1"]);
        let named = [
            "pelvis", "spine_01", "spine_02", "head", "hand_l", "hand_r", "foot_l",
        ];
        let named: Vec<String> = named.map(str::to_owned).into();
        assert_eq!(without_numbers(&named), named);
    }
}
