use super::*;
use crate::train_average;
use footfall_model::OBSERVATION_COUNT;
use footfall_motion::corpus::{Corpus, Where};
use footfall_prob::gaussian::GaussianStats;
use footfall_prob::windows::Windows;
use std::path::Path;

pub(crate) fn clips(condition: &str) -> Vec<Recording> {
    let index = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../tests/data/index.csv");
    let condition: Where = condition.parse().unwrap();
    let mut clips = Corpus::read(index, &[condition]).unwrap().clips;
    for clip in &mut clips {
        clip.retargeted.report.repeats = 1;
    }
    clips
}

pub(crate) fn base() -> GaitModel {
    let config = TrainConfig {
        frame_rate_hz: 60.0,
        windows: Windows::Compact,
        mirror: true,
        em: EmConfig {
            max_iterations: 5,
            min_gain_per_frame: 1e-3,
        },
    };
    let clips = clips("path=walker_1_*");
    train_average(&clips, &config, Provenance::default(), &mut ())
        .unwrap()
        .model
}

fn adapt(
    base: &GaitModel,
    clips: &[Recording],
    method: AdaptMethod,
    steps: Option<usize>,
) -> Result<Adapted, TrainError> {
    let config = AdaptConfig {
        method,
        steps,
        mirror: false,
    };
    adapt_style(base, clips, "test", &config, Provenance::default(), &mut ())
}

#[test]
fn a_walker_becomes_a_style() {
    let base = base();
    let clips = clips("path=walker_2_slow*");
    for method in [AdaptMethod::Cmllr, AdaptMethod::Csmaplr] {
        for steps in [None, Some(6)] {
            let adapted = adapt(&base, &clips, method, steps).unwrap();
            assert!(adapted.objectives.len() >= 3);
            for pair in adapted.objectives.windows(2) {
                let slack = 1e-7 * pair[0].abs();
                assert!(
                    pair[1] >= pair[0] - slack,
                    "{method:?}: {:?}",
                    adapted.objectives
                );
            }
            let [under_base, under_transforms, under_style] = adapted.log_likelihoods;
            assert!(under_transforms > under_base && under_style > under_base);
            let used = adapted.style.provenance.steps;
            assert!(
                steps.is_none_or(|steps| used == steps),
                "{used} of {steps:?}"
            );
            let styled = base.styled(&[(&adapted.style, 1.0)]).unwrap();
            let cadence = styled.cadence_hz();
            assert!(
                (cadence / adapted.style.cadence_hz - 1.0).abs() < 0.03,
                "{cadence} for {}",
                adapted.style.cadence_hz
            );
        }
    }
}

#[test]
fn state_means_come_to_those_of_the_recording() {
    let base = base();
    let clips = clips("path=walker_2_slow*");
    let adapted = adapt(&base, &clips, AdaptMethod::Csmaplr, None).unwrap();
    let encoding = TrainConfig {
        frame_rate_hz: 60.0,
        windows: Windows::Compact,
        mirror: false,
        em: EmConfig {
            max_iterations: 0,
            min_gain_per_frame: 0.0,
        },
    };
    let (corpus, _) = EncodedCorpus::of(&clips, &encoding).unwrap().steady();
    let mut seen = GaussianStats::new(FEATURE_COUNT);
    for sequence in &corpus {
        for frame in sequence.observations.chunks_exact(OBSERVATION_COUNT) {
            seen.add(&frame[..FEATURE_COUNT], 1.0);
        }
    }
    let distance = |steps: &[StepModel; 2]| {
        let states = || steps.iter().flat_map(|step| &step.states);
        let total: f64 = states().map(|state| state.duration_mean).sum();
        (0..FEATURE_COUNT)
            .map(|dim| {
                let mean: f64 = states().map(|s| s.duration_mean * s.mean[dim]).sum();
                (mean / total - seen.mean()[dim]).abs()
            })
            .fold(0.0, f64::max)
    };
    let (before, after) = (distance(&base.steps), distance(&adapted.style.steps));
    assert!(after < 0.2 * before, "from {before} to {after}");
}

#[test]
fn too_little_is_refused() {
    let base = base();
    let all = clips("path=walker_2_slow*");
    let mut standing = all.clone();
    let mut one_step = all.clone();
    for clip in &mut standing {
        clip.walks.clear();
    }
    for clip in &mut one_step {
        clip.walks.truncate(1);
        clip.walks[0].steps.drain(1..);
        clip.walks[0].steps[0].position = footfall_core::StepPosition::Inside;
    }
    one_step.truncate(1);
    let error =
        |clips: &[Recording], steps| adapt(&base, clips, AdaptMethod::Csmaplr, steps).unwrap_err();
    assert!(matches!(error(&standing, None), TrainError::NoSteps));
    assert!(matches!(
        error(&one_step, None),
        TrainError::TooFewSteps { found: 1 }
    ));
    assert!(matches!(
        error(&all, Some(1)),
        TrainError::TooFewSteps { .. }
    ));
    assert!(matches!(error(&[], None), TrainError::NoSteps));
    let mut broken = base.clone();
    broken.steps[0].states[0].variance[0] = f64::NAN;
    assert!(matches!(
        adapt(&broken, &all, AdaptMethod::Csmaplr, None),
        Err(TrainError::Model(_))
    ));
}

#[test]
fn every_loop_counts_with_the_steps_of_one_round() {
    let mut looped = clips("category=walk");
    for clip in &mut looped {
        let steady = clip.walks.iter().map(steady_part);
        let steps: usize = steady.map(|walk| walk.steps.len()).sum();
        clip.retargeted.report.repeats = steps.div_ceil(2);
    }
    let taken = |limit: usize| {
        let chosen = first_steps(&looped, limit).unwrap();
        (chosen.len(), distinct_steps(&chosen))
    };
    assert_eq!(taken(2), (1, 2));
    assert_eq!(taken(4), (2, 4));
    assert_eq!(taken(usize::MAX), (looped.len(), 2 * looped.len()));
}
