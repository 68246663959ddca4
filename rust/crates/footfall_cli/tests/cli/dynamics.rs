//! `footfall dynamics`, `contacts --method switching`, `evaluate dynamics` and `evaluate contacts` from the outside.

use crate::common::footfall;
use crate::evaluate::write_index;
use footfall_motion::bvh;
use footfall_tests::data::{own_file, recordings, repository};
use footfall_tests::evaluator::evaluate;
use std::fs;
use std::path::Path;

/// Of the four walks that the project made, those of one walker.
fn write_walks(folder: &Path) {
    let walks = [("walker_1_slow.bvh", "slow"), ("walker_1_fast.bvh", "fast")];
    write_index(folder, "index.csv", &walks);
}

fn fit(folder: &Path, output: &str) {
    let arguments = ["dynamics", "fit", "--corpus", "index.csv", "-o", output];
    let report = footfall(folder, &[&arguments[..], &["--json"]].concat()).json();
    assert!(
        report["segments"][0]
            .as_u64()
            .expect("a fit that went well")
            >= 4,
        "{report}"
    );
    assert!(
        report["explained"].as_f64().expect("a fit that went well") > 0.9,
        "{report}"
    );
    for side in 0..2 {
        let error = report["one_step_error"][side]
            .as_f64()
            .expect("a fit that went well");
        assert!(error < 0.045, "{report}");
    }
    let bytes = fs::metadata(folder.join(output))
        .expect("a fit that went well")
        .len();
    assert_eq!(
        report["bytes"].as_u64().expect("a fit that went well"),
        bytes
    );
}

#[test]
fn walks_become_two_systems_that_walk() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    write_walks(folder);
    fit(folder, "gait.footdyn");
    fit(folder, "again.footdyn");
    let systems =
        |name: &str| footfall(folder, &["inspect", name, "--json"]).json()["systems"].clone();
    assert_eq!(systems("gait.footdyn"), systems("again.footdyn"));
    assert_eq!(systems("gait.footdyn")[0]["order"], 12);
    let facts = footfall(folder, &["inspect", "gait.footdyn"]);
    assert!(facts.stdout.contains("spectral radius"), "{}", facts.stdout);

    let synth = |seed: &str, output: &str, more: &[&str]| {
        let arguments = [
            "dynamics",
            "synth",
            "--model",
            "gait.footdyn",
            "--seed",
            seed,
        ];
        let run = footfall(folder, &[&arguments[..], &["-o", output], more].concat());
        assert_eq!(run.code, 0, "{}", run.stderr);
        fs::read(folder.join(output)).unwrap()
    };
    let walk = synth("7", "seven.bvh", &["--contacts", "contacts.json"]);
    assert_eq!(walk, synth("7", "seven_again.bvh", &[]));
    assert_ne!(walk, synth("8", "eight.bvh", &[]));
    assert_ne!(walk, synth("7", "turning.bvh", &["--turn", "20"]));
    let quality = evaluate(&bvh::read(folder.join("seven.bvh")).unwrap());
    assert!(quality.median_slip_mps < 0.005, "{quality:?}");
    assert!(quality.penetration_m < 0.01, "{quality:?}");
    assert!((0.98..1.14).contains(&quality.speed_mps), "{quality:?}");
    assert!((1.6..1.78).contains(&quality.cadence_hz), "{quality:?}");
    let contacts = fs::read_to_string(folder.join("contacts.json")).unwrap();
    let contacts: serde_json::Value = serde_json::from_str(&contacts).unwrap();
    assert!(
        contacts["events"].as_array().unwrap().len() > 20,
        "{contacts}"
    );
    // What it walks is found again, from joint angles alone.
    let report = footfall(folder, &["dynamics", "switches", "seven.bvh", "--json"]).json();
    let found = report["switches"].as_array().unwrap().len();
    assert!((15..=17).contains(&found), "{report}");
    for pair in report["switches"].as_array().unwrap().windows(2) {
        assert_ne!(pair[0]["foot"], pair[1]["foot"], "{report}");
    }
}

#[test]
fn contacts_come_from_switches_too() {
    let folder = tempfile::tempdir().unwrap();
    let walk = own_file("walker_1_slow.bvh");
    let contacts = |more: &[&str]| {
        let arguments = ["contacts", walk.to_str().unwrap(), "--json"];
        footfall(folder.path(), &[&arguments[..], more].concat()).json()
    };
    let steps = |report: &serde_json::Value| report["steps"].as_array().unwrap().len();
    let (kinematic, switching) = (contacts(&[]), contacts(&["--method", "switching"]));
    assert_eq!(kinematic["frames"], switching["frames"]);
    assert!(
        steps(&kinematic).abs_diff(steps(&switching)) <= 2,
        "{switching}"
    );
}

#[test]
fn switching_predicts_better_than_a_single_system_on_our_own_walks() {
    let folder = tempfile::tempdir().unwrap();
    write_walks(folder.path());
    let arguments = [
        "evaluate",
        "dynamics",
        "--corpus",
        "index.csv",
        "--plot",
        "errors.svg",
        "--json",
    ];
    let report = footfall(folder.path(), &arguments).json();
    let walks = &report["categories"]["walk"];
    assert_eq!(walks["recordings"], 2, "{report}");
    assert!(walks["simulated_ratio"].as_f64().unwrap() < 0.8, "{report}");
    let plot = fs::read_to_string(folder.path().join("errors.svg")).unwrap();
    assert!(
        plot.starts_with("<svg") && plot.contains("polyline"),
        "{plot}"
    );
    let arguments = [
        "evaluate",
        "contacts",
        "--corpus",
        "index.csv",
        "--leave-one-out",
        "--ablate",
        "--json",
    ];
    let report = footfall(folder.path(), &arguments).json();
    assert!(
        report["categories"]["walk"]["f1"].as_f64().unwrap() > 0.8,
        "{report}"
    );
    let people = report["people"].as_object().unwrap();
    assert!(!people.is_empty(), "{report}");
    for person in people.values() {
        for kind in ["initial_contact", "terminal_contact"] {
            assert!(person[kind]["known"].as_u64().unwrap() > 4, "{report}");
            assert!(person[kind]["f1"].as_f64().unwrap() > 0.9, "{report}");
        }
        assert!(person["limits"]["toe_speed_off"].is_number(), "{report}");
        assert!(
            person["switch_limits"]["landing_secs"].is_number(),
            "{report}"
        );
    }
    let f1 = |landing: &str| report["ablation"][landing]["all"]["f1"].as_f64().unwrap();
    assert!(f1("half cycles, legs") > f1("half cycles"), "{report}");
}

#[test]
fn bad_input_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    write_walks(folder);
    let walk = own_file("walker_1_slow.bvh");
    // Someone who stands has no switch, which is no error, and gives no model, which is one.
    let text = fs::read_to_string(&walk).unwrap();
    let (head, motion) = text.split_once("Frame Time:").unwrap();
    let rows: Vec<&str> = motion.lines().collect();
    let still: Vec<&str> = rows.iter().map(|_| rows[1]).collect();
    let standing = format!("{head}Frame Time:{}\n{}\n", rows[0], still[1..].join("\n"));
    fs::write(folder.join("standing.bvh"), standing).unwrap();
    let report = footfall(folder, &["dynamics", "switches", "standing.bvh", "--json"]).json();
    assert_eq!(report["switches"].as_array().unwrap().len(), 0);
    fs::write(
        folder.join("standing.csv"),
        "path,category,style,subject\nstanding.bvh,standing,none,someone\n",
    )
    .unwrap();
    let fit = [
        "dynamics",
        "fit",
        "--corpus",
        "standing.csv",
        "-o",
        "gait.footdyn",
    ];
    footfall(folder, &fit).fails_with(&["standing.csv", "steps"]);
    // Fewer frames than the window needs: nothing to find.
    let short = [&rows[..1], &rows[1..6]].concat();
    let count = text
        .lines()
        .find(|line| line.starts_with("Frames:"))
        .unwrap();
    let short = format!(
        "{}Frame Time:{}\n",
        head.replace(count, "Frames: 5"),
        short.join("\n")
    );
    fs::write(folder.join("short.bvh"), short).unwrap();
    let report = footfall(folder, &["dynamics", "switches", "short.bvh", "--json"]).json();
    assert_eq!(report["switches"].as_array().unwrap().len(), 0);

    let model = repository().join("addons/footfall/models/locomotion.footfall");
    let synth = |model: &str, more: &[&str]| {
        let arguments = ["dynamics", "synth", "--model", model, "-o", "out.bvh"];
        footfall(folder, &[&arguments[..], more].concat())
    };
    synth(model.to_str().unwrap(), &[]).fails_with(&[
        "locomotion.footfall",
        "'gait'",
        "'dynamics'",
    ]);
    let good = repository().join("addons/footfall/models/walk.footdyn");
    let mut bytes = fs::read(&good).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 0xff;
    fs::write(folder.join("damaged.footdyn"), bytes).unwrap();
    synth("damaged.footdyn", &[]).fails_with(&["damaged.footdyn", "damaged"]);
    let good = good.to_str().unwrap();
    synth(good, &["--seconds", "nan"]).fails_with(&["--seconds"]);
    synth(good, &["--fps", "0"]).fails_with(&["--fps"]);
    synth(good, &["--speed", "inf"]).fails_with(&["speed"]);
    assert!(!folder.join("out.bvh").exists());
}

#[test]
fn on_recordings_two_systems_halve_the_errors_of_one() {
    let Some(data) = recordings("dynamics") else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let index = data.join("index.csv");
    for (set, category, known) in [
        ("cmu/*", "neutral_walk", 39),
        ("cmu/*", "running", 5),
        ("bandai/*", "neutral_walk", 13),
        ("bandai/*", "running", 9),
    ] {
        let path = format!("path={set}");
        let kind = format!("category={category}");
        let arguments = [
            "evaluate",
            "dynamics",
            "--corpus",
            index.to_str().unwrap(),
            "--where",
            &path,
            "--where",
            &kind,
            "--json",
        ];
        let report = footfall(folder.path(), &arguments).json();
        let errors = &report["categories"][category];
        assert_eq!(errors["recordings"], known, "{report}");
        for ratio in ["one_step_ratio", "simulated_ratio"] {
            let ratio = errors[ratio].as_f64().unwrap();
            assert!(ratio <= 0.5, "{set} {category}: {errors}");
        }
    }
}
