//! Players who step on the spot where a room ends.

use super::canonical;
use crate::common::footfall;
use std::fs;

/// Small steps with high knees, as on the spot in a room.
const ON_THE_SPOT: &str = r#"
name = "on_the_spot"
summary = "Small steps with high knees."

[walk]
stride = 30

[feet]
landing = -25
lift = 10
"#;

/// A live body from the thigh of a walker of this seed who steps on the spot: seconds of walking, of anything, and metres of its way.
fn on_the_spot(seed: &str) -> (f64, f64, f32) {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let shipped = |name: &str| {
        let path = footfall_tests::data::repository()
            .join("addons/footfall/models")
            .join(name);
        path.to_str().expect("a path in UTF-8").to_owned()
    };
    let (walk, pocket) = (
        shipped("locomotion.footfall"),
        shipped("right_thigh.footimu"),
    );
    fs::write(folder.join("spot.toml"), ON_THE_SPOT).expect("a sheet");
    let run = |arguments: &[&str]| {
        let run = footfall(folder, arguments);
        assert_eq!(run.code, 0, "{arguments:?}: {}", run.stderr);
    };
    run(&[
        "synth", "--model", &walk, "--steps", "24", "--seed", seed, "--fps", "60", "-o", "walk.bvh",
    ]);
    run(&[
        "design",
        "--sheet",
        "spot.toml",
        "walk.bvh",
        "-o",
        "spot.bvh",
    ]);
    run(&[
        "imu",
        "simulate",
        "spot.bvh",
        "--site",
        "right_thigh",
        "-o",
        "imu.csv",
    ]);
    let report = footfall(
        folder,
        &[
            "imu",
            "reconstruct",
            "--model",
            &pocket,
            "--imu",
            "imu.csv",
            "--mounting",
            "aligned",
            "--live",
            "-o",
            "body.bvh",
            "--json",
        ],
    )
    .json();
    let secs = |wanted: &str| -> f64 {
        let spans = report["behaviours"].as_array().expect("behaviours").iter();
        spans
            .filter(|span| wanted.is_empty() || span[0] == wanted)
            .map(|span| span[1].as_f64().expect("seconds"))
            .sum()
    };
    let clip = canonical(&folder.join("body.bvh"));
    let way = clip.poses[clip.poses.len() - 1]
        .root_position
        .distance(clip.poses[0].root_position);
    (secs("walk"), secs(""), way)
}

/// Players differ: stamping is taken for jumps now and then, but for none of them most of the time.
#[test]
fn players_who_step_on_the_spot_walk() {
    let players = ["1", "2", "3", "4"].map(on_the_spot);
    let shares = players.map(|(walking, all, _)| walking / all);
    assert!(shares.iter().all(|share| *share > 0.6), "{shares:?}");
    assert!(
        shares.iter().sum::<f64>() > 0.72 * shares.len() as f64,
        "{shares:?}"
    );
    // Their own way is a third of a metre a second.
    let (secs, way) = players
        .iter()
        .fold((0.0, 0.0), |(all, whole), (_, secs, way)| {
            (all + secs, whole + way)
        });
    assert!(way > 0.5 * secs as f32, "{way} m in {secs} s");
}
