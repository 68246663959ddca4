//! `footfall imu` from the outside.

mod calibrated;
mod evaluated;
mod on_the_spot;
mod unusable;

use crate::common::{Run, footfall};
use crate::evaluate::write_index;
use footfall_core::rotation::{from_heading, heading};
use footfall_core::{Clip, Joint, ModelPose};
use footfall_motion::bvh;
use footfall_motion::retarget::{RetargetOptions, retarget};
use footfall_tests::evaluator::evaluate;
use glam::Vec3;
use std::fs;
use std::path::Path;

/// Two walkers; the faster walk of the first is kept for what the model has not seen.
const SEEN: [(&str, &str); 3] = [
    ("walker_1_slow.bvh", "slow"),
    ("walker_2_slow.bvh", "slow"),
    ("walker_2_fast.bvh", "fast"),
];
const UNSEEN: &str = "walker_1_fast.bvh";

/// Trains a model on `index.csv`.
fn train(folder: &Path, what: &[&str], model: &str) -> Run {
    let train = ["imu", "train", "--corpus", "index.csv", "--json"];
    footfall(folder, &[&train[..], what, &["-o", model]].concat())
}

/// Reconstructs a body; returns its report.
pub(crate) fn reconstruct(folder: &Path, model: &str, imu: &str, more: &[&str]) -> Run {
    let arguments = [
        "imu",
        "reconstruct",
        "--model",
        model,
        "--imu",
        imu,
        "-o",
        "out.bvh",
    ];
    footfall(folder, &[&arguments[..], more, &["--json"]].concat())
}

fn prepare(folder: &Path, site: &str) -> String {
    write_index(folder, "index.csv", &SEEN);
    write_index(folder, "unseen.csv", &[(UNSEEN, "fast")]);
    let report = train(folder, &["--site", site], "body.footimu").json();
    assert_eq!(report["sites"][0], site);
    assert!(
        report["frames"].as_u64().expect("a trained model") > 500,
        "{report}"
    );
    let path = footfall_tests::data::own_file(UNSEEN);
    path.to_str().expect("a path in UTF-8").to_owned()
}

fn canonical(path: &Path) -> Clip {
    let file = bvh::read(path).expect("a BVH file");
    retarget(&file, &RetargetOptions::default())
        .expect("a body")
        .clip
}

/// Mean distance of the joints at the same times, hips and headings brought together, centimetres.
fn apart_cm(truth: &Clip, made: &Clip, start_secs: f64) -> f64 {
    let places = |clip: &Clip, secs: f64| {
        let pose = clip.pose_at(secs).expect("frames");
        let model = ModelPose::of(&clip.skeleton, &pose);
        let level = from_heading(-heading(pose.rotation(Joint::Hips)));
        model
            .positions
            .map(|place| level * (place - model.positions[0]))
    };
    let frames = made.poses.len();
    let mut sum = 0.0;
    for frame in 0..frames {
        let secs = frame as f64 / made.frame_rate_hz;
        let (own, true_places) = (places(made, secs), places(truth, start_secs + secs));
        let distances = own
            .iter()
            .zip(&true_places)
            .map(|(a, b): (&Vec3, &Vec3)| a.distance(*b));
        sum += f64::from(distances.sum::<f32>()) / own.len() as f64;
    }
    100.0 * sum / frames as f64
}

#[test]
fn a_sensor_on_a_foot_becomes_the_walk_it_was_worn_in() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let walk = prepare(folder, "right_foot");
    let simulate = |more: &[&str], output: &str| {
        let arguments = [
            "imu",
            "simulate",
            &walk,
            "--site",
            "right_foot",
            "-o",
            output,
        ];
        footfall(folder, &[&arguments[..], more, &["--json"]].concat()).json()
    };
    let report = simulate(&[], "imu.csv");
    let start_secs = report["start_s"].as_f64().unwrap();
    simulate(&["--noise", "1", "--mounting", "70,-40,120"], "anyhow.csv");
    assert_eq!(footfall(folder, &["inspect", "imu.csv"]).code, 0);
    let facts = footfall(folder, &["inspect", "body.footimu"]);
    assert!(facts.stdout.contains("right_foot"), "{}", facts.stdout);

    let truth = canonical(Path::new(&walk));
    let reconstructed = |model: &str, imu: &str, more: &[&str]| {
        let report = reconstruct(folder, model, imu, more).json();
        assert!(
            report["behaviours"][0].to_string().contains("walk"),
            "{report}"
        );
        canonical(&folder.join("out.bvh"))
    };
    let few = ["--site", "right_foot", "--frames", "300"];
    let kept = train(folder, &few, "small.footimu").json()["frames"].as_u64();
    assert!(kept.is_some_and(|frames| (200..=300).contains(&frames)));
    let aligned = ["--mounting", "aligned"];
    for (model, imu, more, most_cm) in [
        ("body.footimu", "imu.csv", &aligned[..], 2.5),
        (
            "body.footimu",
            "imu.csv",
            &["--mounting", "aligned", "--live"],
            3.5,
        ),
        ("body.footimu", "anyhow.csv", &[], 2.8),
        ("small.footimu", "imu.csv", &aligned, 3.0),
    ] {
        let made = reconstructed(model, imu, more);
        let error = apart_cm(&truth, &made, start_secs);
        assert!(error < most_cm, "{model} {imu} {more:?}: {error:.2} cm");
    }
    // The same input gives the same bytes, and feet stay where they are.
    reconstructed(
        "body.footimu",
        "imu.csv",
        &["--mounting", "aligned", "--fps", "60"],
    );
    let bytes = fs::read(folder.join("out.bvh")).unwrap();
    reconstructed(
        "body.footimu",
        "imu.csv",
        &["--mounting", "aligned", "--fps", "60"],
    );
    assert_eq!(bytes, fs::read(folder.join("out.bvh")).unwrap());
    let walked = evaluate(&bvh::read(folder.join("out.bvh")).unwrap());
    assert!(
        walked.median_slip_mps < 0.02,
        "slip {} m/s",
        walked.median_slip_mps
    );
    assert!(
        walked.penetration_m < 0.005,
        "{} m below the floor",
        walked.penetration_m
    );
}

#[test]
fn real_sensors_take_the_place_of_simulated_ones() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    write_index(folder, "index.csv", &SEEN);
    let clips = SEEN.map(|(clip, _)| footfall_tests::data::own_file(clip));
    let clip = clips[0].to_str().expect("a path in UTF-8");
    let worn = ["--noise", "1", "--mounting", "70,-40,120", "-o", "worn.csv"];
    let simulate = ["imu", "simulate", clip, "--site", "right_foot"];
    assert_eq!(footfall(folder, &[&simulate[..], &worn].concat()).code, 0);
    let recorded = fs::read(folder.join("worn.csv")).expect("was written");
    // The second row names nothing, the third what was worn in another walk.
    let index = fs::read_to_string(folder.join("index.csv")).expect("was written");
    let added = [",imu_right_foot", ",worn.csv", ",", ",worn.csv"];
    let rows = index.lines().zip(added);
    let rows: Vec<String> = rows.map(|(row, added)| format!("{row}{added}\n")).collect();
    fs::write(folder.join("index.csv"), rows.concat()).expect("the folder can be written");
    let foot = ["--site", "right_foot"];
    let trained = train(folder, &foot, "body.footimu");
    assert_eq!(trained.json()["real"], 1, "{}", trained.stderr);
    assert!(
        trained.stderr.contains("correlation 0.9"),
        "{}",
        trained.stderr
    );
    assert!(
        trained.stderr.contains("a simulated sensor is used"),
        "{}",
        trained.stderr
    );
    let refused = train(folder, &foot, "worn.csv");
    assert_eq!(refused.code, 1, "{}", refused.stderr);
    assert_eq!(fs::read(folder.join("worn.csv")).ok(), Some(recorded));
}

#[test]
fn two_sensors_go_in_the_order_of_the_models_sites() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    write_index(folder, "index.csv", &SEEN);
    let sites = ["--site", "right_foot", "--site", "left_hand"];
    assert_eq!(train(folder, &sites, "two.footimu").code, 0);
    let walk = footfall_tests::data::own_file(UNSEEN);
    let walk = walk.to_str().unwrap();
    for site in ["right_foot", "left_hand"] {
        let output = format!("{site}.csv");
        let simulate = ["imu", "simulate", walk, "--site", site, "-o", &output];
        assert_eq!(footfall(folder, &simulate).code, 0);
    }
    let reconstruct = |imus: &[&str]| {
        let mut arguments = vec![
            "imu",
            "reconstruct",
            "--model",
            "two.footimu",
            "-o",
            "out.bvh",
        ];
        arguments.extend(["--mounting", "aligned"]);
        for imu in imus {
            arguments.extend(["--imu", imu]);
        }
        footfall(folder, &arguments)
    };
    assert_eq!(reconstruct(&["right_foot.csv", "left_hand.csv"]).code, 0);
    let truth = canonical(Path::new(walk));
    let error = apart_cm(&truth, &canonical(&folder.join("out.bvh")), 0.0);
    assert!(error < 2.5, "{error:.2} cm");
    reconstruct(&["right_foot.csv"]).fails_with(&["two sensors", "right_foot, left_hand"]);
}

#[test]
fn events_and_strides_of_a_simulated_foot_are_those_of_the_body() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let walk = footfall_tests::data::own_file(UNSEEN);
    let walk = walk.to_str().unwrap();
    let simulate = [
        "imu",
        "simulate",
        walk,
        "--site",
        "left_foot",
        "--mounting",
        "10,80,-30",
        "-o",
        "imu.csv",
    ];
    assert_eq!(footfall(folder, &simulate).code, 0);
    let found = footfall(
        folder,
        &["imu", "events", "imu.csv", "--site", "left_foot", "--json"],
    )
    .json();
    let known = footfall(folder, &["contacts", walk, "--json"]).json();
    let times = |report: &serde_json::Value, kind: &str| -> Vec<f64> {
        let events = report["events"].as_array().expect("events").iter();
        events
            .filter(|event| event["foot"] == "left" && event["kind"] == kind)
            .map(|event| event["time_s"].as_f64().expect("a time"))
            .collect()
    };
    for kind in ["initial_contact", "terminal_contact"] {
        let (found, known) = (times(&found, kind), times(&known, kind));
        // A swing that the recording cuts off is none.
        let inner = &known[1..known.len() - 1];
        assert!(inner.len() >= 2);
        for time in inner {
            let nearest = found
                .iter()
                .map(|f| (f - time).abs())
                .fold(f64::INFINITY, f64::min);
            assert!(nearest < 0.07, "{kind} at {time}: {found:?}");
        }
        assert!(found.len() <= known.len() + 1);
    }
    let strides = found["strides"].as_array().unwrap();
    let lengths: Vec<f64> = strides
        .iter()
        .map(|s| s["length_m"].as_f64().unwrap())
        .collect();
    let clip = canonical(Path::new(walk));
    let way = clip.poses.last().unwrap().root_position - clip.poses[0].root_position;
    let speed = f64::from(way.length()) / clip.duration_secs();
    let (first, last) = (&strides[0], &strides[strides.len() - 1]);
    let secs = last["end_s"].as_f64().unwrap() - first["start_s"].as_f64().unwrap();
    let ratio = lengths.iter().sum::<f64>() / (speed * secs);
    assert!(
        (ratio - 1.0).abs() < 0.06,
        "strides {lengths:?}, {ratio:.3} of the way"
    );
}
