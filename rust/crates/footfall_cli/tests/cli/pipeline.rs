//! Corpus to model to walk and back, with data that the project made itself: runs on any machine.

use crate::common::footfall;
use footfall_motion::bvh;
use footfall_tests::data::{own_file, repository};
use footfall_tests::evaluator::evaluate;
use serde_json::Value;
use std::fs;
use std::path::Path;

fn train(folder: &Path) -> Value {
    let index = own_file("index.csv");
    let index = index.to_str().expect("a path in UTF-8");
    let arguments = [
        "train",
        "--corpus",
        index,
        "--where",
        "category=walk",
        "-o",
        "walk.footfall",
        "--json",
    ];
    footfall(folder, &arguments).json()
}

fn synth(folder: &Path, seed: &str, output: &str) -> Value {
    let arguments = [
        "synth",
        "--model",
        "walk.footfall",
        "--steps",
        "12",
        "--seed",
        seed,
        "-o",
        output,
        "--contacts",
        "out.json",
        "--json",
    ];
    footfall(folder, &arguments).json()
}

#[test]
fn a_corpus_becomes_a_model_that_walks() {
    let folder = tempfile::tempdir().unwrap();
    let report = train(folder.path());
    assert_eq!(report["subjects"], 2);
    assert_eq!(report["clips"], 4);
    assert!(report["steps"].as_u64().unwrap() >= 16, "{report}");
    assert_eq!(report["warnings"].as_array().unwrap().len(), 0, "{report}");
    let likelihoods: Vec<f64> = report["log_likelihoods"]
        .as_array()
        .unwrap()
        .iter()
        .map(|value| value.as_f64().unwrap())
        .collect();
    assert!(likelihoods.len() >= 2);
    for pair in likelihoods.windows(2) {
        assert!(pair[1] >= pair[0] - 1e-6 * pair[0].abs(), "{likelihoods:?}");
    }

    let facts = footfall(folder.path(), &["inspect", "walk.footfall", "--json"]).json();
    assert_eq!(facts["kind"], "gait_model");
    assert_eq!(facts["format_version"], 3);
    assert_eq!(facts["provenance"]["subjects"], 2);
    let command = facts["provenance"]["command"].as_str().unwrap();
    assert!(
        command.contains("footfall train") && command.contains("category=walk"),
        "{command}"
    );
    assert!(
        !command.contains('/'),
        "no folders of this machine: {command}"
    );
    assert!(
        facts["provenance"]["terms"]
            .as_str()
            .unwrap()
            .contains("MIT"),
        "{facts}"
    );

    let walk = synth(folder.path(), "1", "out.bvh");
    assert_eq!(walk["steps"], 12);
    let quality = evaluate(&bvh::read(folder.path().join("out.bvh")).unwrap());
    assert!(quality.median_slip_mps <= 0.005, "{quality:?}");
    assert!(quality.penetration_m <= 0.01, "{quality:?}");
    let range = |name: &str| -> Vec<f64> {
        report[name]
            .as_array()
            .unwrap()
            .iter()
            .map(|value| value.as_f64().unwrap())
            .collect()
    };
    let (speed, cadence) = (range("speed_range_mps"), range("cadence_range_per_minute"));
    assert!(
        (speed[0]..=speed[1]).contains(&quality.speed_mps),
        "{quality:?} not in {speed:?}"
    );
    assert!(
        (cadence[0]..=cadence[1]).contains(&(60.0 * quality.cadence_hz)),
        "{quality:?} not in {cadence:?}"
    );
}

#[test]
fn equal_seeds_give_equal_bytes_and_others_do_not() {
    let folder = tempfile::tempdir().unwrap();
    train(folder.path());
    let model = fs::read(folder.path().join("walk.footfall")).unwrap();
    train(folder.path());
    assert_eq!(
        fs::read(folder.path().join("walk.footfall")).unwrap(),
        model,
        "training repeats itself"
    );
    for (seed, name) in [("1", "a.bvh"), ("1", "b.bvh"), ("2", "c.bvh")] {
        synth(folder.path(), seed, name);
    }
    let bytes = |name: &str| fs::read(folder.path().join(name)).unwrap();
    assert_eq!(bytes("a.bvh"), bytes("b.bvh"));
    assert_ne!(bytes("a.bvh"), bytes("c.bvh"));
}

#[test]
fn a_speed_that_nobody_walked_or_ran_is_warned_of() {
    let folder = tempfile::tempdir().unwrap();
    let model = repository().join("addons/footfall/models/locomotion.footfall");
    let warned = |gait: &str, speed: &str| {
        let model = model.to_str().unwrap();
        let arguments = ["synth", "--model", model, "--steps", "4", "-o", "out.bvh"];
        let more = ["--gait", gait, "--speed", speed, "--json"];
        let report = footfall(folder.path(), &[&arguments[..], &more].concat()).json();
        let warnings = report["warnings"].as_array().unwrap();
        let first = warnings.first().map(|warning| warning.as_str().unwrap());
        first.unwrap_or_default().to_owned()
    };
    for (gait, speed) in [("auto", "1.3"), ("auto", "3.2"), ("run", "3.2")] {
        assert_eq!(warned(gait, speed), "", "{gait} at {speed} m/s");
    }
    let walk = warned("walk", "3.2");
    assert!(
        walk.contains("recorded walks") && !walk.contains("runs"),
        "{walk}"
    );
    let fast = warned("auto", "5.5");
    assert!(
        fast.contains("recorded walks") && fast.contains("and runs"),
        "{fast}"
    );
    assert!(warned("run", "1.0").contains("recorded runs"));
}

#[test]
fn contacts_have_the_contract_s_shape_and_agree_with_the_generator() {
    let folder = tempfile::tempdir().unwrap();
    let model = repository().join("tests/model_versions/v1.footfall");
    let model = model.to_str().unwrap();
    let arguments = [
        "synth",
        "--model",
        model,
        "--steps",
        "16",
        "-o",
        "out.bvh",
        "--contacts",
        "out.json",
    ];
    assert_eq!(footfall(folder.path(), &arguments).code, 0);
    let made: Value =
        serde_json::from_str(&fs::read_to_string(folder.path().join("out.json")).unwrap()).unwrap();
    let found = footfall(folder.path(), &["contacts", "out.bvh", "--json"]).json();
    for report in [&made, &found] {
        let mut keys: Vec<&str> = report
            .as_object()
            .unwrap()
            .keys()
            .map(String::as_str)
            .collect();
        keys.sort_unstable();
        assert_eq!(keys, ["events", "fps", "frames", "left", "right", "steps"]);
        assert_eq!(report["fps"], made["fps"]);
        assert_eq!(report["frames"], made["frames"]);
        for event in report["events"].as_array().unwrap() {
            let frame = event["frame"].as_f64().unwrap();
            let time = frame / report["fps"].as_f64().unwrap();
            assert!((event["time_s"].as_f64().unwrap() - time).abs() < 1e-9);
            let foot = event["foot"].as_str().unwrap();
            let first_or_last = match event["kind"].as_str().unwrap() {
                "initial_contact" => 0,
                "terminal_contact" => 1,
                other => panic!("{other}"),
            };
            assert!(
                report[foot]
                    .as_array()
                    .unwrap()
                    .iter()
                    .any(|stance| stance[first_or_last] == event["frame"]),
                "{event} ends no stance"
            );
        }
    }
    assert_eq!(made["steps"].as_array().unwrap().len(), 16);
    // The detector knows nothing of the generator: initial contacts agree to a tenth of a second.
    let initial = |report: &Value| -> Vec<(f64, String)> {
        report["events"]
            .as_array()
            .unwrap()
            .iter()
            .filter(|event| event["kind"] == "initial_contact")
            .map(|event| {
                (
                    event["time_s"].as_f64().unwrap(),
                    event["foot"].as_str().unwrap().to_owned(),
                )
            })
            .collect()
    };
    let (made, found) = (initial(&made), initial(&found));
    let agreed = made
        .iter()
        .filter(|(time, foot)| {
            found
                .iter()
                .any(|(at, side)| side == foot && (at - time).abs() < 0.1)
        })
        .count();
    assert!(
        agreed as f64 >= 0.9 * made.len() as f64,
        "{agreed} of {made:?} in {found:?}"
    );
}

#[test]
fn contacts_of_any_walk_lie_in_it_and_can_be_drawn() {
    let folder = tempfile::tempdir().unwrap();
    let model = repository().join("tests/model_versions/v1.footfall");
    let model = model.to_str().unwrap();
    // Lengths whose sums of frame times round up and down.
    for steps in 5..45 {
        let steps = steps.to_string();
        let fps = if steps.ends_with('7') { "24" } else { "60" };
        let arguments = [
            "synth",
            "--model",
            model,
            "--steps",
            &steps,
            "--fps",
            fps,
            "-o",
            "out.bvh",
            "--contacts",
            "out.json",
        ];
        assert_eq!(footfall(folder.path(), &arguments).code, 0);
        let text = fs::read_to_string(folder.path().join("out.json")).unwrap();
        let report: Value = serde_json::from_str(&text).unwrap();
        for foot in ["left", "right"] {
            // A foot lifts before it comes down again.
            let ends: Vec<u64> = report[foot]
                .as_array()
                .unwrap()
                .iter()
                .flat_map(|stance| [stance[0].as_u64().unwrap(), stance[1].as_u64().unwrap() + 1])
                .collect();
            assert!(
                ends.is_sorted_by(|a, b| a < b),
                "{steps} steps at {fps} fps, {foot}: {ends:?}"
            );
            assert!(
                ends.last() <= report["frames"].as_u64().as_ref(),
                "{steps} steps: {ends:?}"
            );
        }
    }
    let arguments = [
        "sheet",
        "out.bvh",
        "--contacts",
        "out.json",
        "-o",
        "out.png",
    ];
    let run = footfall(folder.path(), &arguments);
    assert_eq!(run.code, 0, "{}", run.stderr);
}

#[test]
fn the_benchmark_times_every_kernel_and_agrees_with_its_peers() {
    let folder = tempfile::tempdir().unwrap();
    let report = footfall(folder.path(), &["bench", "--json", "--repetitions", "1"]).json();
    for name in [
        "mlpg_us_per_frame",
        "jbonsai_us_per_frame",
        "ratio",
        "hsmm_us_per_frame",
        "walker_us_per_frame",
        "walker_state_us",
        "walker_restore_us",
        "forward_kinematics_us",
    ] {
        assert!(report[name].as_f64().unwrap() > 0.0, "{name}: {report}");
    }
    assert_eq!(
        (
            report["mlpg_frames"].as_u64(),
            report["mlpg_dimensions"].as_u64()
        ),
        (Some(1000), Some(54))
    );
    assert!(
        report["jbonsai_max_difference"].as_f64().unwrap() <= 1e-9,
        "{report}"
    );
    assert!(
        report["dense_max_difference"].as_f64().unwrap() <= 1e-9,
        "{report}"
    );
}

#[test]
fn every_command_has_help_with_examples() {
    let folder = tempfile::tempdir().unwrap();
    let help = footfall(folder.path(), &["--help"]);
    assert_eq!(help.code, 0);
    for command in [
        "inspect", "retarget", "contacts", "train", "synth", "sheet", "bench",
    ] {
        assert!(help.stdout.contains(command), "{}", help.stdout);
        let run = footfall(folder.path(), &[command, "--help"]);
        assert_eq!(run.code, 0);
        assert!(
            run.stdout.contains("Examples:") && run.stdout.contains("--json"),
            "{}",
            run.stdout
        );
    }
}
