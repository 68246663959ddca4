//! Recordings and indices that are inspected, retargeted and drawn.

use crate::common::footfall;
use footfall_motion::bvh;
use footfall_tests::data::own_file;
use serde_json::Value;
use std::fs;

#[test]
fn a_recording_is_inspected_retargeted_and_drawn() {
    let folder = tempfile::tempdir().unwrap();
    let walk = own_file("walker_2_fast.bvh");
    let walk = walk.to_str().unwrap();
    let facts = footfall(folder.path(), &["inspect", walk, "--json"]).json();
    assert_eq!(facts["kind"], "motion");
    assert_eq!(facts["fps"], 30.0);
    assert_eq!(facts["steps"], 7, "{facts}");
    assert!(
        (1.45..1.52).contains(&facts["mean_speed_mps"].as_f64().unwrap()),
        "{facts}"
    );

    let report = footfall(
        folder.path(),
        &["retarget", walk, "-o", "sixty.bvh", "--fps", "60", "--json"],
    )
    .json();
    assert_eq!(report["fps"], 60.0);
    let file = bvh::read(folder.path().join("sixty.bvh")).unwrap();
    assert_eq!(file.frame_count as u64, report["frames"].as_u64().unwrap());
    assert!((file.frame_rate_hz() - 60.0).abs() < 1e-9);
    let hips: Vec<f32> = file.frame(0)[..3].to_vec();
    assert!(
        hips[0].abs() < 1e-4 && hips[2].abs() < 1e-4,
        "starts at the origin: {hips:?}"
    );

    let sheet = footfall(
        folder.path(),
        &[
            "sheet",
            walk,
            "sixty.bvh",
            "-o",
            "sheet.png",
            "--width",
            "1200",
            "--seconds",
            "2",
            "--json",
        ],
    )
    .json();
    let (width, height) = image::image_dimensions(folder.path().join("sheet.png")).unwrap();
    assert_eq!(
        (width, sheet["height"].as_u64().unwrap()),
        (1200, u64::from(height))
    );
    assert_eq!(sheet["clips"], 2);
}

#[test]
fn a_sheet_shows_the_contacts_that_it_is_given() {
    let folder = tempfile::tempdir().unwrap();
    let walk = own_file("walker_1_slow.bvh");
    let walk = walk.to_str().unwrap();
    let found = footfall(folder.path(), &["contacts", walk, "--json"]);
    let mut report = found.json();
    fs::write(folder.path().join("own.json"), &found.stdout).unwrap();
    let draw = |contacts: &str, output: &str| {
        footfall(
            folder.path(),
            &["sheet", walk, "-o", output, "--contacts", contacts],
        )
    };
    assert_eq!(draw("own.json", "own.png").code, 0);
    report["left"] = Value::Array(vec![]);
    fs::write(folder.path().join("none.json"), report.to_string()).unwrap();
    assert_eq!(draw("none.json", "none.png").code, 0);
    let bytes = |name: &str| fs::read(folder.path().join(name)).unwrap();
    assert_ne!(bytes("own.png"), bytes("none.png"));
    report["frames"] = 3.into();
    fs::write(folder.path().join("short.json"), report.to_string()).unwrap();
    draw("short.json", "x.png").fails_with(&["short.json", "3 frames", "footfall contacts"]);
    fs::write(folder.path().join("text.json"), "hello").unwrap();
    draw("text.json", "x.png").fails_with(&["text.json", "footfall contacts"]);
    draw("absent.json", "x.png").fails_with(&["absent.json"]);
}

#[test]
fn an_index_is_inspected() {
    let folder = tempfile::tempdir().unwrap();
    let index = own_file("index.csv");
    let facts = footfall(
        folder.path(),
        &["inspect", index.to_str().unwrap(), "--json"],
    )
    .json();
    assert_eq!(facts["kind"], "corpus_index");
    assert_eq!(facts["clips"], 4);
    assert_eq!(facts["subjects"]["walker_1"], 2);
    assert_eq!(facts["missing"].as_array().unwrap().len(), 0);
}
