//! Designed styles, from the outside: every shipped sheet on real walks, and mistakes in sheets.

use crate::common::footfall;
use footfall_design::shipped::SHEETS;
use footfall_motion::bvh;
use footfall_tests::data::recordings;
use footfall_tests::evaluator::evaluate;

/// Hips of the canonical body stay between these heights, metres.
const HIPS_M: [f32; 2] = [0.72, 1.0];

#[test]
fn every_style_walks_the_cmu_walks_with_planted_feet() {
    let Some(data) = recordings("designs") else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let index = data.join("index.csv");
    let index = index.to_str().unwrap();
    let mut speeds = Vec::new();
    let styles = SHEETS.into_iter().map(|(name, _)| name);
    for style in styles.filter(|name| *name != "template") {
        let arguments = [
            "design",
            "--sheet",
            style,
            "--corpus",
            index,
            "--where",
            "category=neutral_walk",
            "--where",
            "path=cmu/*",
            "--steps",
            "24",
            "-o",
            style,
            "--json",
        ];
        let report = footfall(folder.path(), &arguments).json();
        assert!(report["steps"].as_u64().unwrap() >= 24, "{report}");
        let clips = report["clips"].as_array().unwrap();
        let mut speed = 0.0;
        for clip in clips {
            let path = folder.path().join(clip["output"].as_str().unwrap());
            let file = bvh::read(&path).unwrap();
            let quality = evaluate(&file);
            let name = path.display();
            let figures = format!(
                "{name}: slip {:.4} and {:.4} m/s, penetration {:.4} m",
                quality.median_slip_mps, quality.worst_slip_mps, quality.penetration_m
            );
            assert!(quality.median_slip_mps <= 0.005, "{figures}");
            assert!(quality.worst_slip_mps <= 0.01, "{figures}");
            assert!(quality.penetration_m <= 0.01, "{figures}");
            for frame in 0..file.frame_count {
                let hips = file.frame(frame)[1];
                assert!(
                    (HIPS_M[0]..HIPS_M[1]).contains(&hips),
                    "{name}: hips at {hips} in frame {frame}"
                );
            }
            speed += clip["speed_mps"].as_f64().unwrap() / clips.len() as f64;
        }
        speeds.push((style, speed));
        let listed = std::fs::read_to_string(folder.path().join(style).join("index.csv")).unwrap();
        assert_eq!(listed.lines().count(), clips.len() + 1);
        assert!(
            listed.contains(&format!("styled_walk,{style},cmu")),
            "{listed}"
        );
        assert!(
            listed.contains("CMU mocap"),
            "the licence is carried over: {listed}"
        );
    }
    let speed = |style: &str| speeds.iter().find(|(name, _)| *name == style).unwrap().1;
    assert!(speed("sad") < 0.75 * speed("proud"), "{speeds:?}");
    assert!(speed("afraid") < 0.8 * speed("cool"), "{speeds:?}");
    assert!(speed("in_a_hurry") > 1.1 * speed("decided"), "{speeds:?}");
}

#[test]
fn mistakes_in_sheets_and_arguments_are_one_line() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("mine.toml"), "[walk]\nstride = 400\n").unwrap();
    std::fs::write(folder.path().join("walk.bvh"), "HIERARCHY\n").unwrap();
    let run = |arguments: &[&str]| footfall(folder.path(), arguments);
    run(&[
        "design",
        "--sheet",
        "mine.toml",
        "walk.bvh",
        "-o",
        "out.bvh",
    ])
    .fails_with(&["mine.toml", "line 2", "400", "30 to 150"]);
    run(&["design", "--sheet", "glad", "walk.bvh", "-o", "out.bvh"]).fails_with(&[
        "glad",
        "sad",
        "glad.toml",
    ]);
    run(&[
        "design",
        "--sheet",
        "none.toml",
        "walk.bvh",
        "-o",
        "out.bvh",
    ])
    .fails_with(&["none.toml"]);
    run(&["design", "--sheet", "sad", "walk.bvh", "-o", "out.bvh"]).fails_with(&["walk.bvh"]);
    run(&["design", "--sheet", "sad", "-o", "out.bvh"]).fails_with(&["--corpus"]);
    assert!(!folder.path().join("out.bvh").exists());
}

#[test]
fn keys_and_template_are_printed() {
    let folder = tempfile::tempdir().unwrap();
    let keys = footfall(folder.path(), &["design", "--keys"]);
    assert_eq!(keys.code, 0);
    assert!(
        keys.stdout.contains("| `stride` | % | 30 to 150 | 100 |"),
        "{}",
        keys.stdout
    );
    let template = footfall(folder.path(), &["design", "--print", "template"]);
    assert!(template.stdout.contains("[walk]") && template.code == 0);
}
