//! Rigs of common tools, bone by bone (`tests/data/rigs/*.txt`): every joint is found, in whatever order, and nothing else is.

#![expect(
    clippy::unwrap_used,
    clippy::disallowed_methods,
    reason = "a test's lists are files that are there or the test fails"
)]

use footfall_core::rig::{Doubt, recognise};
use footfall_core::{JOINT_COUNT, Joint, Rig};
use std::path::{Path, PathBuf};

/// A rig of a file: one bone a line below its parent, one blank deeper; `= Joint` behind those that are joints.
#[derive(Clone, Default)]
struct Listed {
    bones: Vec<(String, Option<usize>)>,
    joints: [Option<usize>; JOINT_COUNT],
}

impl Listed {
    fn read(path: &Path) -> Self {
        let text = std::fs::read_to_string(path).unwrap();
        let mut listed = Self::default();
        let mut above: Vec<usize> = Vec::new();
        for line in text.lines() {
            let depth = line.len() - line.trim_start().len();
            let (name, joint) = line.trim().split_once(" = ").unwrap_or((line.trim(), ""));
            above.truncate(depth);
            let bone = listed.bones.len();
            listed.bones.push((name.to_owned(), above.last().copied()));
            above.push(bone);
            if let Some(joint) = Joint::from_name(joint) {
                listed.joints[joint.index()] = Some(bone);
            }
        }
        listed
    }

    fn named(name: &str) -> Self {
        Self::read(&folder().join(name).with_extension("txt"))
    }

    fn rig(&self) -> Rig {
        Rig::new(self.bones.clone())
    }

    fn bone(&self, name: &str) -> usize {
        self.bones.iter().position(|bone| bone.0 == name).unwrap()
    }

    fn add(&mut self, name: &str, parent: Option<usize>) -> usize {
        self.bones.push((name.to_owned(), parent));
        self.bones.len() - 1
    }

    /// The same rig with its bones in another order.
    fn shuffled(&self, seed: u64) -> Self {
        let mut order: Vec<usize> = (0..self.bones.len()).collect();
        let mut state = seed;
        for n in (1..order.len()).rev() {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            order.swap(n, (state >> 33) as usize % (n + 1));
        }
        let mut place = vec![0; order.len()];
        for (new, &old) in order.iter().enumerate() {
            place[old] = new;
        }
        let moved = |bone: &Option<usize>| bone.map(|bone| place[bone]);
        Self {
            bones: order
                .iter()
                .map(|&old| (self.bones[old].0.clone(), moved(&self.bones[old].1)))
                .collect(),
            joints: self.joints.each_ref().map(moved),
        }
    }

    #[track_caller]
    fn expect_recognised(&self, context: &str) {
        let found = recognise(&self.rig());
        let name = |bone: Option<usize>| bone.map_or("nothing", |bone| &self.bones[bone].0);
        for joint in Joint::ALL {
            let (got, wanted) = (found.placement.joint(joint), self.joints[joint.index()]);
            assert!(
                got == wanted,
                "{context}, taken for {}: {joint:?} is {}, and {} was found; {:?}",
                found.family,
                name(wanted),
                name(got),
                found.doubts
            );
        }
    }
}

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../tests/data/rigs")
}

fn all() -> Vec<(String, Listed)> {
    let mut files: Vec<PathBuf> = std::fs::read_dir(folder())
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .collect();
    files.sort();
    let name = |path: &Path| path.file_stem().unwrap().to_string_lossy().into_owned();
    files
        .into_iter()
        .map(|path| (name(&path), Listed::read(&path)))
        .collect()
}

#[test]
fn every_family_is_recognised_in_any_order() {
    let rigs = all();
    assert!(rigs.len() >= 20, "the lists are there");
    for (name, listed) in rigs {
        assert!(
            listed.joints.iter().flatten().count() >= 18,
            "{name} is marked"
        );
        listed.expect_recognised(&name);
        for seed in 1..6 {
            listed.shuffled(seed).expect_recognised(&name);
        }
    }
}

#[test]
fn a_trunk_that_a_family_names_tells_the_family() {
    for (name, family) in [
        ("mixamo", "Mixamo and MotionBuilder"),
        ("mixamo_numbered", "Mixamo and MotionBuilder"),
        ("motionbuilder", "Mixamo and MotionBuilder"),
        ("ready_player_me", "Mixamo and MotionBuilder"),
        ("godot", "humanoid (Godot, VRM, Unity)"),
        ("reallusion_cc", "Reallusion CC"),
        ("unreal_5", "Unreal"),
    ] {
        assert_eq!(
            recognise(&Listed::named(name).rig()).family,
            family,
            "{name}"
        );
    }
    // Another family, which has the same limbs, would share out a longer trunk and take the bone above for the chest.
    let mut listed = Listed::named("mixamo");
    let upper_chest = listed.bone("mixamorig:Spine2");
    let last = listed.add("mixamorig:Spine3", Some(upper_chest));
    for bone in ["Neck", "LeftShoulder", "RightShoulder"] {
        let bone = listed.bone(&format!("mixamorig:{bone}"));
        listed.bones[bone].1 = Some(last);
    }
    listed.joints[Joint::UpperChest.index()] = Some(last);
    listed.expect_recognised("with four bones of a spine");
}

#[test]
fn bones_that_are_named_alike_and_hang_elsewhere_do_not_mislead() {
    for (name, mut listed) in all() {
        let joints: Vec<usize> = listed.joints.iter().flatten().copied().collect();
        let top = listed.add("Armature", None);
        for (n, bone) in joints.into_iter().enumerate() {
            let own = listed.bones[bone].0.clone();
            // A target of the same kind beside the body, an end of the bone, something worn on it.
            let target = listed.add(&format!("IK_{own}_target"), Some(top));
            listed.add(&format!("{own}_end_{n}"), Some(bone));
            listed.add(&format!("{own}_twist"), Some(bone));
            listed.add(&format!("prop_{n}"), Some(target));
        }
        listed.shuffled(9).expect_recognised(&name);
    }
}

#[test]
fn a_bone_of_the_same_name_outside_the_limb_is_passed_over() {
    let mut listed = Listed::named("mixamo");
    let weapon = listed.add("weapon_rack", None);
    for name in [
        "mixamorig:LeftHand",
        "mixamorig:RightFoot",
        "mixamorig:Spine1",
    ] {
        listed.add(name, Some(weapon));
    }
    listed.expect_recognised("with a rack");
}

#[test]
fn two_bones_that_fit_equally_well_are_left_out_and_message() {
    let mut listed = Listed::named("mixamo");
    let forearm = listed.bone("mixamorig:LeftForeArm");
    let second = listed.add("mixamorig:LeftHand", Some(forearm));
    let rig = listed.rig();
    let found = recognise(&rig);
    assert_eq!(found.placement.joint(Joint::LeftHand), None);
    assert_eq!(found.placement.joint(Joint::LeftLowerArm), Some(forearm));
    let [Doubt::Several { joint, bones }] = &found.doubts[..] else {
        panic!("{:?}", found.doubts);
    };
    assert!(*joint == Joint::LeftHand && bones.contains(&second) && bones.len() == 2);
    let message = found.doubts[0].describe(&rig);
    assert!(
        message.contains("LeftHand may be any of mixamorig:LeftHand"),
        "{message}"
    );
}

#[test]
fn hips_that_do_not_carry_the_legs_are_no_hips() {
    let mut listed = Listed::named("rigify_deform");
    let (root, thigh) = (listed.bone("root"), listed.bone("DEF-thigh.L"));
    listed.bones[thigh].1 = Some(root);
    let rig = listed.rig();
    let found = recognise(&rig);
    assert_eq!(found.placement.joint(Joint::Hips), None);
    let message = found.doubts[0].describe(&rig);
    assert!(
        message.contains("DEF-spine") && message.contains("DEF-thigh.L"),
        "{message}"
    );
}

#[test]
fn a_root_on_the_floor_is_not_taken_for_the_hips() {
    let mut listed = Listed::named("makehuman");
    let hips = listed.bone("root");
    listed.bones[hips].0 = "strange".to_owned();
    let floor = listed.add("root", None);
    listed.bones[hips].1 = Some(floor);
    let found = recognise(&listed.rig());
    assert_eq!(found.placement.joint(Joint::Hips), None, "{}", found.family);
}

#[test]
fn two_bodies_in_one_rig_are_not_mixed() {
    let one = Listed::named("reallusion_cc");
    let mut both = one.clone();
    for (name, parent) in &one.bones {
        let shifted = parent.map(|parent| parent + one.bones.len());
        both.add(&name.replace("CC_Base", "Twin_Base"), shifted);
    }
    let found = recognise(&both.rig());
    assert!(found.placement.joints.iter().all(Option::is_none));
    assert!(!found.doubts.is_empty());
}

#[test]
fn what_is_no_body_has_no_joints_that_matter() {
    for names in [
        &["door", "hinge"][..],
        &["Bone", "Bone.001", "Bone.002"],
        &[],
    ] {
        let bones = names.iter().enumerate();
        let rig = Rig::new(bones.map(|(n, name)| ((*name).to_owned(), n.checked_sub(1))));
        assert_eq!(recognise(&rig).placement.count(), 0, "{names:?}");
    }
}
