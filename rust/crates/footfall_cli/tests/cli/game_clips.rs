//! Clips as games have them: a loop of two steps on the spot, on a Mixamo-like rig in centimetres, as glTF.

#![expect(
    clippy::unwrap_used,
    reason = "a clip that cannot be made fails its test"
)]

use crate::common::{Run, footfall};
use footfall_core::{Clip, Joint};
use footfall_motion::bvh;
use footfall_motion::contacts::{ContactConfig, detect_contacts};
use footfall_motion::gltf::clip_to_glb;
use footfall_motion::recording::read_motion;
use footfall_motion::retarget::RetargetOptions;
use footfall_tests::evaluator::evaluate;
use glam::{Quat, Vec3};
use serde_json::{Value, json};
use std::fs;
use std::path::{Path, PathBuf};

const CENTIMETRES: f32 = 100.0;

fn shipped_model() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../../addons/footfall/models/locomotion.footfall")
}

/// One stride out of the middle of a walk that the shipped model makes at a speed, and how far it goes.
fn stride(folder: &Path, speed: &str) -> (Clip, f64) {
    let model = shipped_model();
    let arguments = [
        "synth",
        "--model",
        model.to_str().unwrap(),
        "--steps",
        "16",
        "--seed",
        "3",
        "--variation",
        "0",
        "--fps",
        "30",
        "--speed",
        speed,
        "-o",
        "walk.bvh",
    ];
    let run = footfall(folder, &arguments);
    assert_eq!(run.code, 0, "{}", run.stderr);
    let options = RetargetOptions::default();
    let (_, walk) = read_motion(&folder.join("walk.bvh"), &options).unwrap();
    let contacts = detect_contacts(&walk.clip, &ContactConfig::from_frame(0));
    let landings = &contacts.feet[0].stances;
    let (first, end) = (landings[4].first, landings[5].first);
    let place = |frame: usize| walk.clip.poses[frame].root_position.with_y(0.0);
    let length = f64::from(place(end).distance(place(first)));
    let mut clip = walk.clip.clone();
    clip.poses = walk.clip.poses[first..=end].to_vec();
    let last = clip.poses.len() - 1;
    // Made to be a loop, as animators do: what is left over between the ends is shared out.
    for joint in Joint::ALL {
        let ends = [0, last].map(|frame: usize| clip.poses[frame].rotation(joint));
        let rest = ends[1].inverse() * ends[0];
        for (frame, pose) in clip.poses.iter_mut().enumerate() {
            let part = Quat::IDENTITY.slerp(rest, frame as f32 / last as f32);
            pose.rotations[joint.index()] = (pose.rotation(joint) * part).normalize();
        }
    }
    (clip, length)
}

fn stripped(mut clip: Clip) -> Clip {
    for pose in &mut clip.poses {
        pose.root_position = Vec3::new(0.0, pose.root_position.y, 0.0);
    }
    clip
}

/// Name of a joint's bone, and how the bone rests turned against ours.
fn mixamo(joint: Joint) -> (String, Quat) {
    let name = joint.name();
    let own = match joint {
        Joint::Chest => "Spine1".to_owned(),
        Joint::UpperChest => "Spine2".to_owned(),
        _ => name
            .replace("UpperArm", "Arm")
            .replace("LowerArm", "ForeArm")
            .replace("UpperLeg", "UpLeg")
            .replace("LowerLeg", "Leg")
            .replace("Toes", "ToeBase"),
    };
    let index = joint.index() as f32;
    let turn = Quat::from_euler(glam::EulerRot::XYZ, 0.3 * index, -0.2 * index, 1.0);
    (format!("mixamorig:{own}"), turn)
}

/// A clip as Mixamo gives it: centimetres under an armature of 0.01, which stands somewhere; bones with axes of their own.
fn mixamo_glb(clip: &Clip, animations: &[&str]) -> Vec<u8> {
    let glb = clip_to_glb(clip, animations[0]);
    let word = |at: usize| u32::from_le_bytes(glb[at..at + 4].try_into().unwrap()) as usize;
    let json_end = 20 + word(12);
    let mut document: Value = serde_json::from_slice(&glb[20..json_end]).unwrap();
    let mut binary = glb[json_end + 8..].to_vec();
    let turn_of = |joint: Option<Joint>| joint.map_or(Quat::IDENTITY, |joint| mixamo(joint).1);
    let mut change = |accessor: usize, width: usize, map: &dyn Fn(&[f32]) -> Vec<f32>| {
        let view = document["accessors"][accessor]["bufferView"]
            .as_u64()
            .unwrap() as usize;
        let view = &document["bufferViews"][view];
        let first = view["byteOffset"].as_u64().unwrap() as usize;
        let length = view["byteLength"].as_u64().unwrap() as usize;
        for bytes in binary[first..first + length].chunks_exact_mut(4 * width) {
            let values: Vec<f32> = bytes
                .chunks_exact(4)
                .map(|bytes| f32::from_le_bytes(bytes.try_into().unwrap()))
                .collect();
            let changed = map(&values).into_iter().flat_map(f32::to_le_bytes);
            bytes.copy_from_slice(&changed.collect::<Vec<u8>>());
        }
    };
    change(1, 3, &|place| {
        place.iter().map(|value| CENTIMETRES * value).collect()
    });
    for joint in Joint::ALL {
        let (above, own) = (turn_of(joint.parent()).inverse(), turn_of(Some(joint)));
        change(2 + joint.index(), 4, &|turn| {
            (above * Quat::from_slice(turn) * own)
                .normalize()
                .to_array()
                .to_vec()
        });
    }
    for joint in Joint::ALL {
        let above = turn_of(joint.parent()).inverse();
        let offset = above * clip.skeleton.offset(joint) * CENTIMETRES;
        let node = &mut document["nodes"][joint.index()];
        node["name"] = mixamo(joint).0.into();
        node["translation"] = json!(offset.to_array());
        node["rotation"] = json!((above * turn_of(Some(joint))).normalize().to_array());
    }
    let armature = document["nodes"].as_array().unwrap().len();
    let nodes = document["nodes"].as_array_mut().unwrap();
    nodes.push(json!({"name": "Armature", "translation": [2, 1.5, -3], "scale": [0.01, 0.01, 0.01], "children": [0]}));
    document["scenes"][0]["nodes"] = json!([armature]);
    let first = document["animations"][0].clone();
    let named = animations.iter().map(|name| {
        let mut animation = first.clone();
        animation["name"] = json!(name);
        animation
    });
    document["animations"] = named.collect();
    let mut text = serde_json::to_vec(&document).unwrap();
    text.resize(text.len().next_multiple_of(4), b' ');
    let mut bytes = b"glTF".to_vec();
    let sizes = [2, 12 + 8 + text.len() + 8 + binary.len(), text.len()];
    bytes.extend(
        sizes
            .into_iter()
            .flat_map(|size| (size as u32).to_le_bytes()),
    );
    bytes.extend(b"JSON");
    bytes.extend(text);
    bytes.extend((binary.len() as u32).to_le_bytes());
    bytes.extend(b"BIN\0");
    bytes.extend(binary);
    bytes
}

#[track_caller]
fn near(got: f64, wanted: f64, share: f64, what: &str) {
    assert!(
        (got / wanted - 1.0).abs() < share,
        "{what}: {got:.3} for {wanted:.3}"
    );
}

#[test]
fn a_loop_on_the_spot_becomes_a_style_that_walks_as_it_did() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let model = shipped_model();
    for speed in ["0.9", "1.5"] {
        let (clip, length) = stride(folder, speed);
        let frames = clip.poses.len() - 1;
        let secs = frames as f64 / clip.frame_rate_hz;
        let walked = length / secs;
        let glb = mixamo_glb(&stripped(clip), &["mixamo.com"]);
        fs::write(folder.join("walk.glb"), glb).unwrap();

        let facts = footfall(folder, &["inspect", "walk.glb", "--json"]).json();
        assert_eq!(facts["in_place"], true, "{facts}");
        assert_eq!(facts["skeleton"], "Mixamo and MotionBuilder");
        assert_eq!(facts["cycle_frames"], frames);
        assert_eq!(facts["steps"], 2, "{facts}");
        assert_eq!(facts["warnings"].as_array().unwrap().len(), 1);
        near(
            facts["mean_speed_mps"].as_f64().unwrap(),
            walked,
            0.04,
            "speed of the file",
        );

        index_of(folder, "walk.glb");
        let report = adapt(folder).json();
        assert_eq!(report["steps"], 2, "{report}");
        let warning = report["warnings"][0].as_str().unwrap();
        assert!(warning.contains("only 2 steps"), "{warning}");
        near(
            report["speed_mps"].as_f64().unwrap(),
            walked,
            0.04,
            "speed of the style",
        );
        let facts = footfall(folder, &["inspect", "loop.footstyle", "--json"]).json();
        assert_eq!(facts["warnings"].as_array().unwrap().len(), 1, "{facts}");

        let arguments = [
            "synth",
            "--model",
            model.to_str().unwrap(),
            "--style",
            "loop.footstyle",
            "--steps",
            "20",
            "--variation",
            "0",
            "-o",
            "out.bvh",
        ];
        assert_eq!(footfall(folder, &arguments).code, 0);
        let quality = evaluate(&bvh::read(folder.join("out.bvh")).unwrap());
        near(quality.speed_mps, walked, 0.05, "speed");
        near(quality.cadence_hz, 2.0 / secs, 0.05, "cadence");
        let stride = 2.0 * quality.speed_mps / quality.cadence_hz;
        near(stride, length, 0.05, "stride");
    }
}

#[test]
fn a_clip_that_travels_is_left_as_it_is() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let (clip, length) = stride(folder, "1.2");
    let secs = (clip.poses.len() - 1) as f64 / clip.frame_rate_hz;
    fs::write(folder.join("walk.glb"), mixamo_glb(&clip, &["walk"])).unwrap();
    let facts = footfall(folder, &["inspect", "walk.glb", "--json"]).json();
    assert_eq!(facts["in_place"], false);
    near(
        facts["mean_speed_mps"].as_f64().unwrap(),
        length / secs,
        0.03,
        "speed",
    );
    let arguments = ["retarget", "walk.glb", "-o", "out.bvh"];
    assert_eq!(footfall(folder, &arguments).code, 0);
    let (_, read) = read_motion(&folder.join("out.bvh"), &RetargetOptions::default()).unwrap();
    assert_eq!(read.clip.poses.len(), clip.poses.len());
    for (frame, (got, wanted)) in read.clip.poses.iter().zip(&clip.poses).enumerate() {
        for joint in [
            Joint::LeftUpperLeg,
            Joint::RightLowerLeg,
            Joint::LeftLowerArm,
        ] {
            let apart = got.rotation(joint).angle_between(wanted.rotation(joint));
            assert!(apart < 0.12, "frame {frame}, {joint:?}: {apart}");
        }
    }
}

#[test]
fn one_of_several_animations_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let (clip, _) = stride(folder, "1.2");
    fs::write(
        folder.join("hero.glb"),
        mixamo_glb(&clip, &["Idle", "Walk"]),
    )
    .unwrap();
    let inspect = |path: &str| footfall(folder, &["inspect", path]);
    inspect("hero.glb").fails_with(&["2 animations", "hero.glb#Idle", "hero.glb#Walk"]);
    inspect("hero.glb#Run").fails_with(&["no animation \"Run\"", "hero.glb#Walk"]);
    assert_eq!(inspect("hero.glb#Walk").code, 0);
    fs::write(folder.join("broken.glb"), b"glTF nonsense").unwrap();
    inspect("broken.glb").fails_with(&["broken.glb"]);
    inspect("missing.glb").fails_with(&["missing.glb"]);
}

/// A table of one clip.
fn index_of(folder: &Path, clip: &str) {
    let table = format!("path,category,style,subject\n{clip},walk,loop,me\n");
    fs::write(folder.join("index.csv"), table).unwrap();
}

fn adapt(folder: &Path) -> Run {
    let model = shipped_model();
    let base = model.to_str().unwrap();
    let wanted = ["--name", "loop", "-o", "loop.footstyle", "--json"];
    let arguments = ["adapt", "--base", base, "--corpus", "index.csv"];
    footfall(folder, &[&arguments[..], &wanted].concat())
}

#[test]
fn clips_that_make_no_style_are_named_with_what_to_do() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let (walk, _) = stride(folder, "1.2");
    let walk = stripped(walk);
    let refuses = |name: &str, glb: &[u8], words: &[&str]| {
        fs::write(folder.join(name), glb).unwrap();
        index_of(folder, name);
        adapt(folder).fails_with(&[&[name][..], words].concat());
        assert!(!folder.join("loop.footstyle").exists(), "{name}");
    };

    let mut idle = walk.clone();
    for (frame, pose) in idle.poses.iter_mut().enumerate() {
        *pose = walk.poses[0].clone();
        let breath = 0.05 * (0.2 * frame as f32).sin();
        pose.rotations[Joint::Chest.index()] *= Quat::from_rotation_x(breath);
    }
    let glb = mixamo_glb(&idle, &["Idle"]);
    refuses(
        "idle.glb",
        &glb,
        &["no two consecutive steps", "walking clips"],
    );

    let mut short = walk.clone();
    short.poses.truncate(15);
    let glb = mixamo_glb(&short, &["Walk"]);
    refuses("short.glb", &glb, &["(0.5 s)", "no two consecutive steps"]);

    // A name that stays as long keeps the file's sizes.
    let glb = mixamo_glb(&walk, &["Walk"]);
    let at = |name: &[u8]| glb.windows(name.len()).position(|bytes| bytes == name);
    let first = at(b"mixamorig:LeftFoot").unwrap();
    let mut strange = glb.clone();
    strange[first..first + 18].copy_from_slice(b"mixamorig:LeftFlap");
    refuses("strange.glb", &strange, &["LeftFoot", "--map"]);

    let empty = br#"{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[]}]}"#;
    refuses("empty.gltf", empty, &["no animation moves a skeleton"]);
}

#[test]
fn a_clip_without_steps_beside_a_walk_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let (walk, _) = stride(folder, "1.2");
    let mut short = walk.clone();
    short.poses.truncate(15);
    fs::write(folder.join("walk.glb"), mixamo_glb(&walk, &["A", "B"])).unwrap();
    fs::write(folder.join("short.glb"), mixamo_glb(&short, &["A"])).unwrap();
    index_of(folder, "walk.glb#B,walk,loop,me\nshort.glb");
    let report = adapt(folder).json();
    let warnings = report["warnings"].to_string();
    assert!(warnings.contains("short.glb (0.5 s)"), "{warnings}");
    assert!(!warnings.contains("walk.glb"), "{warnings}");
}
