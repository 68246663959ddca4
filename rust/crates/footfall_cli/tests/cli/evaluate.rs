//! `footfall evaluate` and `footfall study` from the outside, on walks that the project made.

use crate::common::{Run, footfall};
use footfall_tests::data::{own_file, recordings, repository};
use std::fs;
use std::path::Path;

/// Writes an index of our own walks; the two walkers take the parts of the captured and of the synthesised.
pub(crate) fn write_index(folder: &Path, name: &str, walks: &[(&str, &str)]) {
    let mut text = "path,category,style,subject\n".to_owned();
    for (file, style) in walks {
        let path = own_file(file);
        let row = [
            path.to_str().expect("a path in UTF-8"),
            "walk",
            style,
            "someone",
        ];
        text.push_str(&row.join(","));
        text.push('\n');
    }
    fs::write(folder.join(name), text).expect("the folder can be written");
}

pub(crate) fn write_pair(folder: &Path) {
    write_index(
        folder,
        "real.csv",
        &[("walker_1_slow.bvh", "slow"), ("walker_1_fast.bvh", "fast")],
    );
    write_index(
        folder,
        "made.csv",
        &[("walker_2_slow.bvh", "slow"), ("walker_2_fast.bvh", "fast")],
    );
}

fn evaluate(folder: &Path, more: &[&str]) -> Run {
    let mut arguments = vec!["evaluate", "style", "--real", "real.csv"];
    arguments.extend(more);
    footfall(folder, &arguments)
}

#[test]
fn slow_and_fast_are_told_apart_and_swapped_names_are_found_out() {
    let folder = tempfile::tempdir().unwrap();
    write_pair(folder.path());
    let report = evaluate(folder.path(), &["--synthesised", "made.csv", "--json"]).json();
    assert_eq!(report["split"], "half", "one take each");
    assert_eq!(report["styles"].as_array().unwrap().len(), 2);
    assert_eq!(report["real"]["rate"], 1.0, "{report}");
    assert_eq!(report["real"]["efficiency"], 2.0, "{report}");
    assert_eq!(report["synthesised"]["rate"], 1.0, "{report}");
    assert_eq!(report["ratio"], 1.0, "{report}");
    let measures = &report["measures"]["slow"];
    for kind in ["real", "synthesised"] {
        let slip = measures[kind]["slip_mps"].as_f64().unwrap();
        assert!(slip < 0.006, "planted feet slip at {slip} m/s");
        assert!(measures[kind]["jerk_mps3"].as_f64().unwrap() > 1.0);
        assert!(measures[kind]["skating_ratio"].as_f64().unwrap() < 0.3);
    }
    assert!(
        measures["synthesised_against_real"]["variance_ratio"]["median"]
            .as_f64()
            .unwrap()
            > 0.5
    );

    write_index(
        folder.path(),
        "made.csv",
        &[("walker_2_slow.bvh", "fast"), ("walker_2_fast.bvh", "slow")],
    );
    let report = evaluate(folder.path(), &["--synthesised", "made.csv", "--json"]).json();
    assert_eq!(report["real"]["rate"], 1.0, "{report}");
    assert_eq!(report["synthesised"]["rate"], 0.0, "{report}");
}

#[test]
fn tables_name_every_style_and_say_how_good_guessing_is() {
    let folder = tempfile::tempdir().unwrap();
    write_pair(folder.path());
    let alone = evaluate(folder.path(), &[]);
    assert_eq!(alone.code, 0, "{}", alone.stderr);
    assert!(!alone.stdout.contains("ynthesised"), "{}", alone.stdout);
    let both = evaluate(
        folder.path(),
        &["--synthesised", "made.csv", "--where", "style=slow"],
    );
    for part in [
        "slow",
        "fast",
        "100.0 %",
        "2.00 times chance",
        "Synthesised over real: 1.00",
    ] {
        assert!(
            both.stdout.contains(part),
            "{part} is not in {}",
            both.stdout
        );
    }
}

#[test]
fn recordings_without_a_run_and_speeds_that_are_none_are_named() {
    let folder = tempfile::tempdir().unwrap();
    write_pair(folder.path());
    let model = repository().join("addons/footfall/models/locomotion.footfall");
    let model = model.to_str().expect("a path in UTF-8");
    let judged = |more: &[&str]| {
        let mut all = vec!["evaluate", "naturalness", "--corpus", "real.csv", "--model"];
        all.push(model);
        all.extend(more);
        footfall(folder.path(), &all)
    };
    judged(&["--gait", "run"]).fails_with(&["real.csv", "no run", "2.5 to 4.5 m/s", "--where"]);
    judged(&["--speeds", "9:10"]).fails_with(&["real.csv", "no walk", "9 to 10 m/s"]);
    let unreadable = judged(&["--speeds", "4:3"]);
    assert_eq!(unreadable.code, 2, "{}", unreadable.stderr);
    assert!(
        unreadable.stderr.contains("2.5:4.5"),
        "{}",
        unreadable.stderr
    );
}

#[test]
fn what_cannot_be_judged_is_named() {
    let folder = tempfile::tempdir().unwrap();
    write_pair(folder.path());
    evaluate(folder.path(), &["--split", "take"]).fails_with(&["real.csv", "fast", "--split half"]);
    evaluate(folder.path(), &["--where", "style=slow"]).fails_with(&["needs two"]);
    evaluate(folder.path(), &["--synthesised", "none.csv"]).fails_with(&["none.csv"]);
    write_index(folder.path(), "made.csv", &[("walker_2_slow.bvh", "proud")]);
    evaluate(folder.path(), &["--synthesised", "made.csv"]).fails_with(&["proud", "fast, slow"]);
    let study = |arguments: &[&str]| {
        let mut all = vec!["study", "--real", "real.csv", "-o", "study.html"];
        all.extend(arguments);
        footfall(folder.path(), &all)
    };
    study(&[]).fails_with(&["--synthesised"]);
    study(&["--synthesised", "made.csv"]).fails_with(&["no style has both"]);
    study(&["--synthesised", "made.csv", "--seconds", "nan"]).fails_with(&["--seconds"]);
    assert!(!folder.path().join("study.html").exists());
}

/// Calibration on captured people: six styles of set 2 all recognised across takes, fourteen of set 1 within a
/// take, and fewer across takes.
#[test]
fn filters_of_the_vertical_are_judged_on_the_same_samples() {
    let folder = tempfile::tempdir().unwrap();
    write_pair(folder.path());
    let arguments = ["evaluate", "orientation", "--corpus", "real.csv", "--json"];
    let report = footfall(folder.path(), &arguments).json();
    let filters = &report["simulated"]["walk"];
    let of = |filter: &str, name: &str| filters[filter][name].as_f64().unwrap();
    for filter in ["Footfall", "VQF", "gyroscope alone"] {
        assert_eq!(
            filters[filter]["count"], filters["VQF"]["count"],
            "{report}"
        );
        assert!(of(filter, "median_deg") <= of(filter, "ninety_fifth_deg"));
    }
    assert!(of("Footfall", "rms_deg") < of("gyroscope alone", "rms_deg"));
    assert!(of("Footfall", "rms_deg") < 6.0, "{report}");
    let absent = ["evaluate", "orientation", "--sensors", "absent.csv"];
    footfall(folder.path(), &absent).fails_with(&["absent.csv"]);
}

#[test]
fn captured_styles_are_recognised_as_the_calibration_says() {
    let Some(data) = recordings("style calibration") else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let index = data.join("index.csv");
    let judge = |conditions: &[&str]| {
        let mut arguments = vec![
            "evaluate",
            "style",
            "--real",
            index.to_str().unwrap(),
            "--json",
        ];
        arguments.extend(conditions);
        footfall(folder.path(), &arguments).json()
    };
    let acted = ["--where", "category=styled_walk", "--where"];
    let second = judge(&[&acted[..], &["clip_id=bn2*", "--split", "take"]].concat());
    let within = judge(&[&acted[..], &["clip_id=bn1*", "--split", "half"]].concat());
    let across = judge(&["--where", "category=strafe", "--split", "take"]);
    let rate = |report: &serde_json::Value| report["real"]["rate"].as_f64().unwrap();
    eprintln!(
        "set 2 {}, set 1 within {}, across {}",
        rate(&second),
        rate(&within),
        rate(&across)
    );
    assert_eq!(second["styles"].as_array().unwrap().len(), 6);
    assert_eq!(within["styles"].as_array().unwrap().len(), 14);
    assert!(rate(&second) >= 0.99, "{}", second["real"]);
    assert!(rate(&within) >= 0.97, "{}", within["real"]);
    assert!((0.48..0.61).contains(&rate(&across)), "{}", across["real"]);
    let variability = second["step_variability_ratio"].as_f64().unwrap();
    assert!((0.95..1.15).contains(&variability), "{variability}");
}

fn compare_training(index: &Path, conditions: &[&str]) -> serde_json::Value {
    let folder = tempfile::tempdir().expect("a folder");
    let mut arguments = vec!["evaluate", "training", "--json", "--corpus"];
    arguments.push(index.to_str().expect("a path in UTF-8"));
    for condition in conditions {
        arguments.extend(["--where", condition]);
    }
    footfall(folder.path(), &arguments).json()
}

fn number(report: &serde_json::Value, key: &str) -> f64 {
    report[key].as_f64().expect("a number")
}

fn assert_adaptive_is_better(report: &serde_json::Value) {
    let number = |key| number(report, key);
    assert!(
        number("adaptive_log_variance") < number("plain_log_variance") - 0.1,
        "{report}"
    );
    assert!(number("adaptive") > number("plain") + 30.0, "{report}");
}

#[test]
fn walkers_that_are_taken_out_leave_sharper_states() {
    let report = compare_training(&own_file("index.csv"), &[]);
    assert_adaptive_is_better(&report);
}

#[test]
fn unseen_cmu_walkers_are_explained_better_by_walker_adaptive_training() {
    let Some(data) = recordings("walker-adaptive training") else {
        return;
    };
    let conditions = ["category=neutral_walk", "path=cmu/*"];
    let report = compare_training(&data.join("index.csv"), &conditions);
    assert_adaptive_is_better(&report);
    // Also when the plainly trained walk gets the unseen walker's transform.
    let number = |key| number(&report, key);
    assert!(
        number("adaptive") > number("plain_adapted") + 8.0,
        "{report}"
    );
    assert!(report["walkers"].as_array().unwrap().len() >= 4, "{report}");
}
