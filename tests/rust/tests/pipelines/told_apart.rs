//! `evaluate::told_apart` has to be able to say both: these are alike, and these are not.

use footfall_core::Clip;
use footfall_model::GaitModel;
use footfall_motion::contacts::{ContactConfig, detect_contacts};
use footfall_motion::steps::segment_walks;
use footfall_synth::{GaitChoice, WalkConfig, synthesize};
use footfall_tests::data::repository;
use footfall_train::evaluate::EvaluateError;
use footfall_train::evaluate::told_apart::bouts::{Bout, Gait, WithinRange};
use footfall_train::evaluate::told_apart::features::View;
use footfall_train::evaluate::told_apart::{Comparison, Walker, compare};
use std::sync::Arc;

/// Walks of the shipped model, a seed each, seen through a change of its poses.
fn walkers(
    gait: Gait,
    seeds: core::ops::Range<u64>,
    change: impl Fn(&Clip) -> Clip,
) -> Vec<Walker> {
    let path = repository().join("addons/footfall/models/locomotion.footfall");
    let bytes = std::fs::read(&path).expect("the shipped model");
    let model = Arc::new(GaitModel::from_bytes(&bytes).expect("the shipped model"));
    seeds
        .map(|seed| {
            // Of runs, straight parts count alone.
            let (choice, asked_mps, steps) = match gait {
                Gait::Walk => (GaitChoice::Walk, 1.3, 13),
                Gait::Run => (GaitChoice::Run, 3.2, 26),
            };
            let config = WalkConfig {
                steps,
                seed,
                variation: 1.0,
                speed_mps: Some(asked_mps as f32),
                turn_rate_radps: 0.0,
                direction_rad: 0.0,
                frame_rate_hz: None,
                from_standing: false,
                gait: choice,
            };
            let walk = synthesize(&model, &model.skeleton, &config).expect("a walk");
            let contacts = detect_contacts(&walk.clip, &ContactConfig::from_frame(0));
            let walks = segment_walks(&walk.clip, &contacts);
            let parts = gait.parts(&walk.clip, &walks);
            Walker {
                name: format!("seed {seed}"),
                clips: vec![(change(&walk.clip), parts)],
                asked_mps: Some(asked_mps),
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
        .find(|(view, _)| *view == wanted);
    let (_, verdict) = found.expect("every view is judged");
    verdict.accuracies.map(|accuracy| accuracy.mean)
}

/// Judges one gait of the model against itself and against a smoothed copy; the former is returned.
fn judge_both(gait: Gait) -> Comparison {
    let first = walkers(gait, 1..13, Clip::clone);
    let alike =
        compare(&first, &walkers(gait, 101..125, Clip::clone), gait).expect("enough strides");
    for view in View::ALL {
        for accuracy in accuracies(&alike, view) {
            assert!(accuracy < 0.68, "{gait:?}, {}: {accuracy}", view.name());
        }
    }
    let smooth = compare(&first, &walkers(gait, 101..125, smoothed), gait).expect("enough strides");
    for view in [View::All, View::Smoothness] {
        for accuracy in accuracies(&smooth, view) {
            assert!(accuracy > 0.9, "{gait:?}, {}: {accuracy}", view.name());
        }
    }
    // A smoothed copy lacks what the measure of detail is about, in every part that moves.
    for ((part, [_, own]), (_, [_, copy])) in alike.detail.iter().zip(&smooth.detail) {
        assert!(copy.rms < 0.8 * own.rms, "{part}: {copy:?} of {own:?}");
    }
    // Its feet slide as they land and as they stand.
    let [own, copy] = [&alike, &smooth].map(|comparison| {
        let [_, generated] = &comparison.gait;
        generated.landing_slip_mps.expect("feet land")
    });
    assert!(copy > 2.0 * own, "{gait:?}: {copy} of {own} m/s");
    alike
}

#[test]
fn equal_walks_are_not_told_apart_and_a_smoothed_copy_is() {
    let alike = judge_both(Gait::Walk);
    let [_, walks] = &alike.gait;
    assert!(walks.bouts.iter().all(|bout| bout.flight_share == 0.0));
}

#[test]
fn equal_runs_are_not_told_apart_and_a_smoothed_copy_is() {
    let alike = judge_both(Gait::Run);
    let [first, second] = &alike.gait;
    assert!(second.bouts.iter().all(|bout| bout.flight_share > 0.02));
    assert!(
        second.speed_errors.iter().all(|error| *error < 0.1),
        "{:?}",
        second.speed_errors
    );
    let within = WithinRange::of(&first.bouts, &second.bouts);
    assert!(within.bouts >= 8 && within.cadence > 0.5, "{within:?}");
    // The same runs played faster have a cadence that nobody had at their speed.
    let hurried: Vec<_> = second
        .bouts
        .iter()
        .map(|bout| Bout {
            cadence_hz: 1.3 * bout.cadence_hz,
            ..*bout
        })
        .collect();
    assert!(WithinRange::of(&first.bouts, &hurried).cadence < 0.1);
}

#[test]
fn too_few_walkers_are_an_error_that_says_so() {
    let error = compare(
        &walkers(Gait::Walk, 1..3, Clip::clone),
        &walkers(Gait::Walk, 1..9, Clip::clone),
        Gait::Walk,
    )
    .unwrap_err();
    assert!(matches!(
        error,
        EvaluateError::TooFewWalkers { found: 2, .. }
    ));
    assert!(error.to_string().contains("captured: 2 walkers"), "{error}");
}
