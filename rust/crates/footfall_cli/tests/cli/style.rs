//! Styles from the outside: adapt, inspect, synth.

use crate::common::footfall;
use footfall_motion::bvh;
use footfall_tests::data::{own_file, recordings};
use footfall_tests::evaluator::evaluate;
use serde_json::Value;
use std::fs;
use std::path::Path;

fn train(folder: &Path, model: &str, index: &Path, conditions: &[&str]) {
    let mut arguments = vec![
        "train",
        "--corpus",
        index.to_str().expect("UTF-8"),
        "-o",
        model,
    ];
    for condition in conditions {
        arguments.extend(["--where", condition]);
    }
    arguments.push("--json");
    footfall(folder, &arguments).json();
}

fn adapt(folder: &Path, index: &Path, condition: &str, name: &str, more: &[&str]) -> Value {
    let output = format!("{name}.footstyle");
    let mut arguments = vec!["adapt", "--base", "walk.footfall", "--corpus"];
    arguments.push(index.to_str().expect("UTF-8"));
    arguments.extend([
        "--where", condition, "--name", name, "-o", &output, "--json",
    ]);
    arguments.extend(more);
    footfall(folder, &arguments).json()
}

fn synth(folder: &Path, styles: &[&str], output: &str) -> Value {
    let mut arguments = vec![
        "synth",
        "--model",
        "walk.footfall",
        "--steps",
        "12",
        "-o",
        output,
    ];
    for style in styles {
        arguments.extend(["--style", style]);
    }
    arguments.push("--json");
    footfall(folder, &arguments).json()
}

#[test]
fn a_dozen_steps_become_a_style_that_walks() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let index = own_file("index.csv");
    train(folder, "walk.footfall", &index, &["subject=walker_1"]);
    let report = adapt(
        folder,
        &index,
        "path=walker_2_slow*",
        "slow",
        &["--steps", "6"],
    );
    assert_eq!(report["steps"], 6);
    assert_eq!(report["warnings"].as_array().unwrap().len(), 0, "{report}");
    let bytes = fs::metadata(folder.join("slow.footstyle")).unwrap().len();
    assert_eq!(report["bytes"], bytes);
    assert!(bytes < 60_000, "{bytes}");
    adapt(
        folder,
        &index,
        "path=walker_2_fast*",
        "fast",
        &["--method", "cmllr"],
    );

    let facts = footfall(folder, &["inspect", "slow.footstyle", "--json"]).json();
    assert_eq!(facts["kind"], "gait_style");
    assert_eq!(facts["name"], "slow");
    assert_eq!(facts["provenance"]["steps"], 6);
    assert!(
        facts["provenance"]["command"]
            .as_str()
            .unwrap()
            .contains("--steps 6")
    );

    let plain = synth(folder, &[], "plain.bvh");
    assert_eq!(plain["styles"].as_array().unwrap().len(), 0);
    synth(folder, &["slow.footstyle:0"], "none.bvh");
    assert_eq!(
        fs::read(folder.join("plain.bvh")).unwrap(),
        fs::read(folder.join("none.bvh")).unwrap(),
        "a style of weight 0 is none"
    );
    let styled = synth(folder, &["slow.footstyle"], "slow.bvh");
    assert_eq!(styled["styles"][0]["name"], "slow");
    let speed = styled["speed_mps"].as_f64().unwrap();
    let recorded = report["speed_mps"].as_f64().unwrap();
    assert!(
        (speed / recorded - 1.0).abs() < 0.1,
        "{speed} for {recorded}"
    );
    synth(
        folder,
        &["slow.footstyle:0.7", "fast.footstyle:0.6"],
        "mixed.bvh",
    );
    synth(
        folder,
        &["fast.footstyle:0.6", "slow.footstyle:0.7"],
        "other.bvh",
    );
    assert_eq!(
        fs::read(folder.join("mixed.bvh")).unwrap(),
        fs::read(folder.join("other.bvh")).unwrap(),
        "order does not matter"
    );
    for weight in ["-1", "3", "1e9"] {
        let style = format!("slow.footstyle:{weight}");
        synth(folder, &[&style], "extreme.bvh");
        let quality = evaluate(&bvh::read(folder.join("extreme.bvh")).unwrap());
        assert!(quality.penetration_m < 0.02, "{weight}: {quality:?}");
    }
}

#[test]
fn what_is_no_style_is_refused_in_one_line() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let index = own_file("index.csv");
    let index_name = index.to_str().expect("UTF-8");
    train(folder, "walk.footfall", &index, &["subject=walker_1"]);
    adapt(folder, &index, "path=walker_2_slow*", "slow", &[]);
    let synth = |model: &str, style: &str| {
        footfall(
            folder,
            &["synth", "--model", model, "--style", style, "-o", "x.bvh"],
        )
    };
    synth("walk.footfall", "slow.footstyle:NaN").fails_with(&["slow.footstyle", "NaN"]);
    synth("walk.footfall", "missing.footstyle").fails_with(&["missing.footstyle"]);
    synth("walk.footfall", "walk.footfall").fails_with(&["walk.footfall", "'style'"]);
    synth("slow.footstyle", "slow.footstyle").fails_with(&["'gait'"]);
    train(folder, "other.footfall", &index, &["subject=walker_2"]);
    synth("other.footfall", "slow.footstyle").fails_with(&["'slow'", "another base"]);
    assert!(!folder.join("x.bvh").exists());
    let adapt = |base: &str, steps: &str, output: &str| {
        let arguments = [
            "adapt", "--base", base, "--corpus", index_name, "--name", "s", "--steps", steps, "-o",
            output,
        ];
        footfall(folder, &arguments)
    };
    adapt("slow.footstyle", "6", "s.footstyle").fails_with(&["'style'", "'gait'"]);
    adapt("walk.footfall", "6", "walk.footfall").fails_with(&["is the input"]);
    assert_eq!(adapt("walk.footfall", "1", "s.footstyle").code, 2);
}

/// Styles of actors at 30 fps from an average walk at 120 fps: the measures of the average walk hold for them.
#[test]
fn acted_styles_keep_their_speed_and_their_feet() {
    let Some(data) = recordings("acted_styles_keep_their_speed_and_their_feet") else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let index = data.join("index.csv");
    let neutral = ["category=neutral_walk", "path=cmu/*"];
    train(folder, "walk.footfall", &index, &neutral);
    for style in STYLES {
        let condition = format!("path=*{style}_*");
        let name = style.replace("_walk", "");
        let report = adapt(folder, &index, &condition, &name, &["--steps", "12"]);
        let objectives = report["objectives"].as_array().unwrap();
        for pair in objectives.windows(2) {
            assert!(
                pair[1].as_f64() >= pair[0].as_f64().map(|v| v - 1e-6 * v.abs()),
                "{style}"
            );
        }
        synth(folder, &[&format!("{name}.footstyle")], "out.bvh");
        let quality = evaluate(&bvh::read(folder.join("out.bvh")).unwrap());
        let recorded = report["speed_mps"].as_f64().unwrap();
        let cadence = report["cadence_per_minute"].as_f64().unwrap() / 60.0;
        println!(
            "{name:18} slip {:.2} cm/s, worst {:.1}; floor {:.1} mm; {:.2} of {recorded:.2} m/s; {:.0} of {:.0} steps/min",
            100.0 * quality.median_slip_mps,
            100.0 * quality.worst_slip_mps,
            1000.0 * quality.penetration_m,
            quality.speed_mps,
            60.0 * quality.cadence_hz,
            60.0 * cadence
        );
        assert!(quality.median_slip_mps < 0.005, "{style}: {quality:?}");
        assert!(quality.penetration_m < 0.005, "{style}: {quality:?}");
        assert!(
            (quality.speed_mps / recorded - 1.0).abs() < 0.1,
            "{style}: {quality:?}"
        );
    }
}

/// Slow and quick, bent and bouncing, of both sets.
const STYLES: [&str; 6] = [
    "bn1_walk_sad",
    "bn1_walk_old",
    "bn1_walk_giant",
    "bn1_walk_musical",
    "bn2_walk_exhausted",
    "bn2_walk_masculine",
];
