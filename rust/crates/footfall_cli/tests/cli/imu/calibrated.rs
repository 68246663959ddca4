//! Calibrations that are kept and taken over, and problems of sensors that are at fault or worn wrongly.

use super::reconstruct;
use crate::common::footfall;
use serde_json::Value;
use std::fs;
use std::path::Path;

const CALIBRATION: &str = "me.footcal";

/// A shipped model.
fn shipped(site: &str) -> String {
    let path = format!("addons/footfall/models/{site}.footimu");
    let path = footfall_tests::data::repository().join(path);
    path.to_str().expect("a path in UTF-8").to_owned()
}

/// Simulates a sensor at a site of a walker of the project's own, whose walk lasts a quarter of a minute, worn anyhow.
fn simulate(folder: &Path, site: &str, output: &str) {
    if !folder.join("walk.bvh").exists() {
        let model = footfall_tests::data::repository().join("addons/footfall/models");
        let model = model.join("locomotion.footfall");
        let model = model.to_str().expect("a path in UTF-8");
        let synth = [
            "synth", "--model", model, "--steps", "24", "--seed", "3", "--fps", "60", "-o",
            "walk.bvh",
        ];
        assert_eq!(footfall(folder, &synth).code, 0);
    }
    let simulate = [
        "imu",
        "simulate",
        "walk.bvh",
        "--site",
        site,
        "--noise",
        "1",
        "--mounting",
        "70,-40,120",
        "-o",
        output,
    ];
    assert_eq!(footfall(folder, &simulate).code, 0);
}

/// Names of the problems in a report.
fn problems(report: &Value) -> Vec<&str> {
    let problems = report["problems"].as_array().expect("problems").iter();
    problems
        .map(|problem| problem["problem"].as_str().expect("a name"))
        .collect()
}

#[test]
fn a_calibration_is_kept_and_taken_over() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let model = shipped("right_foot");
    simulate(folder, "right_foot", "imu.csv");
    let first = reconstruct(
        folder,
        &model,
        "imu.csv",
        &["--save-calibration", CALIBRATION],
    )
    .json();
    assert_eq!(problems(&first), [""; 0], "{first}");
    let again = reconstruct(folder, &model, "imu.csv", &["--calibration", CALIBRATION]).json();
    assert_eq!(first["mountings"], again["mountings"]);
    assert_eq!(problems(&again), [""; 0], "{again}");
    let stride = |report: &Value| report["stride"].as_f64().expect("a factor");
    assert!(
        (0.7..1.4).contains(&stride(&first)) && (stride(&first) - 1.0).abs() > 1e-3,
        "{first}"
    );
    let facts = footfall(folder, &["inspect", CALIBRATION]);
    assert!(
        facts.stdout.contains("right_foot     any sensor"),
        "{}",
        facts.stdout
    );
    // A walk that was understood from its first step needs no second of motion.
    let text = fs::read_to_string(folder.join("imu.csv")).expect("a recording");
    let short: Vec<&str> = text.lines().take(90).collect();
    fs::write(folder.join("short.csv"), short.join("\n")).expect("a file");
    reconstruct(folder, &model, "short.csv", &[]).fails_with(&["short.csv", "too little"]);
    let short = reconstruct(folder, &model, "short.csv", &["--calibration", CALIBRATION]);
    assert_eq!(short.code, 0, "{}", short.stderr);

    // Another player's, or one that has slipped.
    let simulate = [
        "imu",
        "simulate",
        "walk.bvh",
        "--site",
        "right_foot",
        "--mounting",
        "0,180,0",
        "-o",
        "other.csv",
    ];
    assert_eq!(footfall(folder, &simulate).code, 0);
    let other = reconstruct(folder, &model, "other.csv", &["--calibration", CALIBRATION]);
    assert!(other.stderr.contains("calibrate again"), "{}", other.stderr);
    assert_eq!(problems(&other.json())[0], "turned");
}

#[test]
fn calibrations_that_do_not_fit_say_what_to_do() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    simulate(folder, "right_foot", "imu.csv");
    let (foot, thigh) = (shipped("right_foot"), shipped("right_thigh"));
    let saved = reconstruct(
        folder,
        &foot,
        "imu.csv",
        &["--save-calibration", CALIBRATION],
    );
    assert_eq!(saved.code, 0, "{}", saved.stderr);
    fs::remove_file(folder.join("out.bvh")).expect("a body");
    let with =
        |model: &str, file: &str| reconstruct(folder, model, "imu.csv", &["--calibration", file]);
    with(&thigh, CALIBRATION)
        .fails_with(&[CALIBRATION, "for right_foot, the model for right_thigh"]);
    with(&foot, "imu.csv").fails_with(&["imu.csv", "not a sensor calibration"]);
    with(&foot, "none.footcal").fails_with(&["none.footcal"]);
    let mut bytes = fs::read(folder.join(CALIBRATION)).expect("a calibration");
    let last = bytes.len() - 6;
    bytes[last] ^= 1;
    fs::write(folder.join("damaged.footcal"), &bytes).expect("a file");
    with(&foot, "damaged.footcal").fails_with(&["damaged.footcal", "calibrate again"]);
    bytes[8] = 77;
    fs::write(folder.join("later.footcal"), &bytes).expect("a file");
    with(&foot, "later.footcal").fails_with(&["later.footcal", "update Footfall"]);
    reconstruct(folder, &foot, "imu.csv", &["--save-calibration", "imu.csv"])
        .fails_with(&["imu.csv"]);
    assert!(
        !folder.join("out.bvh").exists(),
        "nothing is written when it fails"
    );
}

#[test]
fn what_is_wrong_with_a_sensor_is_problem_and_reported() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let model = shipped("right_foot");
    simulate(folder, "right_foot", "imu.csv");
    let text = fs::read_to_string(folder.join("imu.csv")).expect("a recording");
    let stuck = text.lines().enumerate().map(|(n, line)| {
        let mut fields: Vec<&str> = line.split(',').collect();
        if n > 500 {
            fields[4] = "0.25";
        }
        fields.join(",")
    });
    fs::write(
        folder.join("stuck.csv"),
        stuck.collect::<Vec<_>>().join("\n"),
    )
    .expect("a file");
    for live in [&["--live"][..], &[]] {
        let run = reconstruct(folder, &model, "stuck.csv", live);
        assert!(
            run.stderr.contains("stuck.csv: from") && run.stderr.contains("gx stays"),
            "{}",
            run.stderr
        );
        let report = run.json();
        assert_eq!(problems(&report), ["stuck_axis"], "{report}");
        let problem = &report["problems"][0];
        assert_eq!(problem["site"], "right_foot");
        assert!(
            (5.0..9.0).contains(&problem["start_s"].as_f64().expect("a time")),
            "{problem}"
        );
        let stood = report["behaviours"].as_array().expect("behaviours").iter();
        let stood: f64 = stood
            .filter(|b| b[0] == "stand")
            .filter_map(|b| b[1].as_f64())
            .sum();
        let long = report["frames"].as_f64().expect("a number")
            / report["fps"].as_f64().expect("a number");
        assert!(stood > long - 7.5, "{report}");
    }
    // Every second sample is lost.
    let half = text.lines().enumerate().filter(|(n, _)| n % 2 == 0);
    let half: Vec<&str> = half.map(|(_, line)| line).collect();
    fs::write(folder.join("half.csv"), half.join("\n")).expect("a file");
    let report = reconstruct(folder, &model, "half.csv", &["--rate", "100"]).json();
    assert_eq!(problems(&report), ["pace"], "{report}");
    // On the other foot.
    simulate(folder, "left_foot", "left.csv");
    let run = reconstruct(folder, &model, "left.csv", &[]);
    assert!(run.stderr.contains("left foot"), "{}", run.stderr);
    assert_eq!(problems(&run.json())[0], "other_side");
}
