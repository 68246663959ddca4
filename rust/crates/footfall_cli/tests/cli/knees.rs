//! Hip joints of recordings: moved where a person's walking shows that they are misplaced, unless `--as-recorded` is given.

use crate::common::footfall;
use footfall_motion::bvh::{self, clip_to_bvh};
use footfall_motion::retarget::{RetargetOptions, SkeletonFit, normalised_start, retarget};
use footfall_tests::data::{own_file, recordings};
use serde_json::Value;
use std::fs;
use std::path::Path;

/// The bytes that a recording becomes with its hip joints from this source.
fn expected(path: &Path, fit: SkeletonFit) -> String {
    let options = RetargetOptions {
        fit,
        ..RetargetOptions::default()
    };
    let retargeted = retarget(&bvh::read(path).expect("a recording"), &options).expect("a body");
    let clip = normalised_start(&retargeted.clip, retargeted.first_frame);
    bvh::write(&clip_to_bvh(&clip))
}

fn written(path: &Path, flags: &[&str]) -> (String, String) {
    let folder = tempfile::tempdir().expect("a folder");
    let mut arguments = vec![
        "retarget",
        path.to_str().expect("a path in UTF-8"),
        "-o",
        "out.bvh",
    ];
    arguments.extend(flags);
    let run = footfall(folder.path(), &arguments);
    assert_eq!(run.code, 0, "{}", run.stderr);
    let bytes = fs::read_to_string(folder.path().join("out.bvh")).expect("a written file");
    (bytes, run.stderr)
}

fn facts(path: &Path, flags: &[&str]) -> Value {
    let folder = tempfile::tempdir().expect("a folder");
    let mut arguments = vec!["inspect", path.to_str().expect("a path in UTF-8"), "--json"];
    arguments.extend(flags);
    footfall(folder.path(), &arguments).json()
}

#[test]
fn misplaced_hip_joints_move_unless_they_are_to_stay() {
    let Some(data) = recordings("recordings") else {
        return;
    };
    let walk = data.join("cmu/neutral_walk/cmu_05_walking_train_02.bvh");
    let (plain, said) = written(&walk, &["--as-recorded"]);
    assert_eq!(plain, expected(&walk, SkeletonFit::AsRecorded));
    assert!(!said.contains("hip joints"), "{said}");
    assert_eq!(facts(&walk, &["--as-recorded"])["hip_joints"], Value::Null);

    let (natural, said) = written(&walk, &[]);
    assert_eq!(natural, expected(&walk, SkeletonFit::FromRecording));
    assert_ne!(natural, plain);
    assert!(said.contains("hip joints moved"), "{said}");
    let found = &facts(&walk, &[])["hip_joints"];
    assert_eq!(found["verdict"], "corrected", "{found}");
    assert!(found["probability"].as_f64().unwrap() > 0.9, "{found}");
    let strike = |key: &str| found[key][0].as_f64().unwrap();
    assert!(
        strike("knee_degrees") + 5.0 < strike("recorded_knee_degrees"),
        "{found}"
    );
}

#[test]
fn an_acted_walk_and_our_own_walkers_are_left_and_said_to_be() {
    let own = Some(own_file("walker_2_fast.bvh"));
    let acted =
        recordings("recordings").map(|data| data.join("bandai/styled_walk/bn1_walk_old_001.bvh"));
    for walk in [own, acted].into_iter().flatten() {
        let (plain, _) = written(&walk, &["--as-recorded"]);
        let (natural, said) = written(&walk, &[]);
        assert_eq!(natural, plain);
        assert!(said.contains("hip joints left"), "{said}");
    }
}

#[test]
fn a_model_says_that_hip_joints_stayed_as_recorded() {
    let Some(data) = recordings("recordings") else {
        return;
    };
    let folder = tempfile::tempdir().expect("a folder");
    let index = data.join("index.csv");
    let fit = |flags: &[&str]| {
        let mut arguments = vec![
            "dynamics",
            "fit",
            "--corpus",
            index.to_str().expect("a path in UTF-8"),
            "--where",
            "subject=cmu16",
            "-o",
            "gait.footdyn",
        ];
        arguments.extend(flags);
        let run = footfall(folder.path(), &arguments);
        assert_eq!(run.code, 0, "{}", run.stderr);
        let model = footfall(folder.path(), &["inspect", "gait.footdyn", "--json"]);
        (run.stderr, model.json().to_string())
    };
    let (said, model) = fit(&[]);
    assert!(said.contains("hip joints of cmu16 moved"), "{said}");
    assert!(!model.contains("--as-recorded"), "{model}");
    let (said, model) = fit(&["--as-recorded"]);
    assert!(!said.contains("hip joints"), "{said}");
    assert!(model.contains("--as-recorded"), "{model}");
}
