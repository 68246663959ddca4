//! Promises of the product, measured on the real CMU walks. Skipped where the recordings are not.

use crate::common::footfall;
use footfall_motion::bvh;
use footfall_tests::data::recordings;
use footfall_tests::evaluator::evaluate;
use std::path::Path;

/// Slowest and fastest, on the canonical body, of the clips that were trained on, as `inspect` measures them.
struct Range {
    speed_mps: [f64; 2],
    cadence_per_minute: [f64; 2],
}

fn training_range(folder: &Path, data: &Path) -> Range {
    let mut range = Range {
        speed_mps: [f64::MAX, f64::MIN],
        cadence_per_minute: [f64::MAX, f64::MIN],
    };
    let walks = std::fs::read_dir(data.join("cmu/neutral_walk")).expect("a folder of walks");
    for walk in walks {
        let path = walk.expect("an entry").path();
        let facts = footfall(
            folder,
            &["inspect", path.to_str().expect("a path in UTF-8"), "--json"],
        )
        .json();
        for (name, range) in [
            ("mean_speed_mps", &mut range.speed_mps),
            ("steps_per_minute", &mut range.cadence_per_minute),
        ] {
            if let Some(value) = facts[name].as_f64() {
                *range = [range[0].min(value), range[1].max(value)];
            }
        }
    }
    range
}

/// Trains `walk.footfall` on the CMU walks; returns the report.
fn train(folder: &Path, data: &Path, more: &[&str]) -> serde_json::Value {
    let index = data.join("index.csv");
    let arguments = [
        "train",
        "--corpus",
        index.to_str().expect("a path in UTF-8"),
        "--where",
        "category=neutral_walk",
        "--where",
        "path=cmu/*",
        "-o",
        "walk.footfall",
        "--json",
    ];
    footfall(folder, &[&arguments[..], more].concat()).json()
}

#[test]
fn the_cmu_walks_train_in_a_minute_and_walk_with_planted_feet() {
    let Some(data) = recordings("recordings") else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let report = train(folder.path(), &data, &[]);
    assert!(report["seconds"].as_f64().unwrap() < 60.0, "{report}");
    assert_eq!(report["skipped"].as_array().unwrap().len(), 0, "{report}");
    assert!(report["subjects"].as_u64().unwrap() >= 8, "{report}");
    let range = training_range(folder.path(), &data);
    for seed in 1..=8 {
        let seed = seed.to_string();
        let arguments = [
            "synth",
            "--model",
            "walk.footfall",
            "--steps",
            "20",
            "--seed",
            &seed,
            "-o",
            "out.bvh",
        ];
        assert_eq!(footfall(folder.path(), &arguments).code, 0);
        let quality = evaluate(&bvh::read(folder.path().join("out.bvh")).unwrap());
        eprintln!("seed {seed}: {quality:?}");
        assert!(
            quality.median_slip_mps <= 0.005,
            "seed {seed}: slip of {} m/s",
            quality.median_slip_mps
        );
        assert!(
            quality.penetration_m <= 0.01,
            "seed {seed}: {} m below the floor",
            quality.penetration_m
        );
        let within = |value: f64, [low, high]: [f64; 2]| (low..=high).contains(&value);
        assert!(
            within(quality.speed_mps, range.speed_mps),
            "seed {seed}: {} m/s",
            quality.speed_mps
        );
        let cadence = 60.0 * quality.cadence_hz;
        assert!(
            within(cadence, range.cadence_per_minute),
            "seed {seed}: {cadence} steps a minute"
        );
        // 20 steps show 19 initial contacts: both feet stand already in the first frame.
        assert_eq!(quality.initial_contacts, 19, "seed {seed}: {quality:?}");
    }
}

#[test]
fn every_recording_can_be_read_and_placed() {
    let Some(data) = recordings("recordings") else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let index = data.join("index.csv");
    let facts = footfall(
        folder.path(),
        &["inspect", index.to_str().unwrap(), "--json"],
    )
    .json();
    assert!(facts["clips"].as_u64().unwrap() > 100, "{facts}");
    for sample in [
        "cmu/neutral_walk/cmu_07_walking_train_04.bvh",
        "cmu/running/cmu_35_running_train_01.bvh",
        "bandai/neutral_walk/bn2_walk_normal_001.bvh",
        "bandai/turning/bn2_walk-turn-left_normal_001.bvh",
        "other/idle/react_002_genuine.bvh",
    ] {
        let path = data.join(sample);
        let facts = footfall(
            folder.path(),
            &["inspect", path.to_str().unwrap(), "--json"],
        )
        .json();
        let steps = facts["steps"].as_u64().unwrap();
        assert_eq!(
            steps > 0,
            !sample.contains("idle"),
            "{sample}: {steps} steps"
        );
    }
}

/// The yardstick measures: captured feet slip as much as an evaluator of other people's found (7.2 and 1.8 cm/s).
#[test]
fn captured_feet_slip_as_much_as_the_calibration_says() {
    let Some(data) = recordings("calibration") else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    for (walks, range) in [
        ("cmu/neutral_walk", 0.05..0.07),
        ("bandai/neutral_walk", 0.018..0.03),
    ] {
        let mut slips: Vec<f64> = std::fs::read_dir(data.join(walks))
            .unwrap()
            .map(|walk| {
                let path = walk.unwrap().path();
                let arguments = ["retarget", path.to_str().unwrap(), "-o", "out.bvh"];
                assert_eq!(footfall(folder.path(), &arguments).code, 0);
                evaluate(&bvh::read(folder.path().join("out.bvh")).unwrap()).median_slip_mps
            })
            .filter(|slip| slip.is_finite())
            .collect();
        slips.sort_by(f64::total_cmp);
        let median = slips[slips.len() / 2];
        eprintln!(
            "{walks}: median slip {median:.4} m/s over {} clips",
            slips.len()
        );
        assert!(
            range.contains(&median),
            "{walks}: {median} m/s of {slips:?}"
        );
    }
}

/// Δ² over neighbouring frames is the default because the paper's, which couples frames of equal parity alone, lets frames of either
/// parity go ways of their own: 0.129 of a trajectory's energy is such ripple, and 0.012 here.
#[test]
fn the_default_windows_ripple_a_tenth_as_much_as_the_paper_s() {
    let Some(data) = recordings("ripple") else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let [paper, compact] = ["paper", "compact"].map(|windows| {
        train(folder.path(), &data, &["--windows", windows]);
        let ripples = (1..=8).map(|seed: u32| {
            let seed = seed.to_string();
            let arguments = [
                "synth",
                "--model",
                "walk.footfall",
                "--seed",
                &seed,
                "-o",
                "out.bvh",
            ];
            assert_eq!(footfall(folder.path(), &arguments).code, 0);
            evaluate(&bvh::read(folder.path().join("out.bvh")).unwrap()).ripple
        });
        ripples.sum::<f64>() / 8.0
    });
    eprintln!("ripple: paper {paper:.2e}, compact {compact:.2e}");
    assert!(
        compact < 0.15 * paper && compact < 0.02,
        "compact {compact}, paper {paper}"
    );
}
