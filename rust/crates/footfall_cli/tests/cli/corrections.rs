//! Contacts that a person corrected: every command that takes a recording's contacts for true reads them.

use crate::common::footfall;
use footfall_tests::data::own_file;
use serde_json::{Value, json};
use std::fs;

const LABELS: &str = "walk.bvh.labels.json";

#[test]
fn sheets_and_designs_go_by_the_corrections_beside_a_recording() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    fs::copy(own_file("walker_1_slow.bvh"), here.join("walk.bvh")).unwrap();
    let draw = || footfall(here, &["sheet", "walk.bvh", "-o", "sheet.png"]);
    let design = ["design", "--sheet", "sad", "walk.bvh", "-o", "sad.bvh"];
    assert_eq!(draw().code, 0);
    let as_detected = fs::read(here.join("sheet.png")).unwrap();
    assert_eq!(footfall(here, &design).code, 0);

    // What is detected, taken for true, changes nothing; no contact at all does.
    let mut labels = footfall(here, &["contacts", "walk.bvh", "--json"]).json();
    fs::write(here.join(LABELS), labels.to_string()).unwrap();
    assert_eq!(draw().code, 0);
    assert_eq!(fs::read(here.join("sheet.png")).unwrap(), as_detected);
    for list in ["left", "right", "events", "steps", "flight"] {
        labels[list] = json!([]);
    }
    fs::write(here.join(LABELS), labels.to_string()).unwrap();
    assert_eq!(draw().code, 0);
    assert_ne!(fs::read(here.join("sheet.png")).unwrap(), as_detected);
    footfall(here, &design).fails_with(&["walk.bvh", "step"]);

    labels["frames"] = Value::from(3);
    fs::write(here.join(LABELS), labels.to_string()).unwrap();
    draw().fails_with(&[LABELS, "3 frames"]);
    footfall(here, &design).fails_with(&[LABELS, "3 frames"]);
}
