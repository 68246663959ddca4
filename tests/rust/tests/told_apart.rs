//! `evaluate::told_apart` has to be able to say both: these are alike, and these are not.

use footfall_core::Clip;
use footfall_model::GaitModel;
use footfall_motion::contacts::{ContactConfig, detect_contacts};
use footfall_motion::steps::segment_walks;
use footfall_synth::{WalkConfig, synthesize};
use footfall_tests::data::repository;
use footfall_train::evaluate::EvaluateError;
use footfall_train::evaluate::told_apart::features::View;
use footfall_train::evaluate::told_apart::{Comparison, Walker, compare};
use std::sync::Arc;

/// Walks of the shipped model, a seed each, seen through a change of its poses.
fn walkers(seeds: core::ops::Range<u64>, change: impl Fn(&Clip) -> Clip) -> Vec<Walker> {
    let path = repository().join("addons/footfall/models/locomotion.footfall");
    let bytes = std::fs::read(&path).expect("the shipped model");
    let model = Arc::new(GaitModel::from_bytes(&bytes).expect("the shipped model"));
    seeds
        .map(|seed| {
            let config = WalkConfig {
                steps: 13,
                seed,
                variation: 1.0,
                speed_mps: None,
                turn_rate_radps: 0.0,
                direction_rad: 0.0,
                frame_rate_hz: None,
                from_standing: false,
                gait: footfall_synth::GaitChoice::Auto,
            };
            let walk = synthesize(&model, &model.skeleton, &config).expect("a walk");
            let contacts = detect_contacts(&walk.clip, &ContactConfig::from_frame(0));
            let walks = segment_walks(&walk.clip, &contacts);
            Walker {
                name: format!("seed {seed}"),
                clips: vec![(change(&walk.clip), walks)],
            }
        })
        .collect()
}

/// Every pose the mean of those within a tenth of a second.
fn smoothed(clip: &Clip) -> Clip {
    let reach = (0.1 * clip.frame_rate_hz) as usize;
    let around = |frame: usize| {
        let first = frame.saturating_sub(reach);
        let last = (frame + reach).min(clip.poses.len() - 1);
        let mut mean = clip.poses[first].clone();
        for (count, pose) in clip.poses[first + 1..=last].iter().enumerate() {
            mean = mean.interpolate(pose, 1.0 / (count + 2) as f32);
        }
        mean
    };
    Clip {
        poses: (0..clip.poses.len()).map(around).collect(),
        ..clip.clone()
    }
}

fn accuracies(comparison: &Comparison, wanted: View) -> [f64; 2] {
    let found = comparison
        .told_apart
        .iter()
        .find(|(view, ..)| *view == wanted);
    let (_, verdict, _) = found.expect("every view is judged");
    verdict.accuracies.map(|accuracy| accuracy.mean)
}

#[test]
fn equal_sources_are_not_told_apart_and_a_smoothed_copy_is() {
    let first = walkers(1..9, Clip::clone);
    let alike = compare(&first, &walkers(101..117, Clip::clone)).expect("enough strides");
    for view in View::ALL {
        for accuracy in accuracies(&alike, view) {
            assert!(accuracy < 0.68, "{}: {accuracy}", view.name());
        }
    }
    let smooth = compare(&first, &walkers(101..117, smoothed)).expect("enough strides");
    for view in [View::All, View::Smoothness] {
        for accuracy in accuracies(&smooth, view) {
            assert!(accuracy > 0.9, "{}: {accuracy}", view.name());
        }
    }
    // A smoothed copy lacks what the measure of detail is about, in every part that moves.
    for ((part, [_, own]), (_, [_, copy])) in alike.detail.iter().zip(&smooth.detail) {
        assert!(copy.rms < 0.8 * own.rms, "{part}: {copy:?} of {own:?}");
    }
}

#[test]
fn too_few_walkers_are_an_error_that_says_so() {
    let error = compare(&walkers(1..3, Clip::clone), &walkers(1..9, Clip::clone)).unwrap_err();
    assert!(matches!(
        error,
        EvaluateError::TooFewWalkers { found: 2, .. }
    ));
    assert!(error.to_string().contains("captured: 2 walkers"), "{error}");
}
