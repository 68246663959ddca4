use super::*;
use crate::file::tests::sample;
use crate::layout::OBSERVATION_COUNT;
use crate::{ModelFileError, file::read_header};
use proptest::prelude::*;

/// A plausible base: upright, hanging arms, bent knees.
fn base() -> GaitModel {
    let mut model = sample();
    for (side, step) in model.steps.iter_mut().enumerate() {
        for (index, state) in step.states.iter_mut().enumerate() {
            let wave = |dim: usize| 0.01 * ((7 * dim + 3 * index + side) % 11) as f64;
            state.mean = (0..OBSERVATION_COUNT).map(wave).collect();
            state.variance = (0..OBSERVATION_COUNT).map(|d| 0.02 + wave(d)).collect();
        }
    }
    model
}

/// A style that differs everywhere, by `scale`.
fn style(base: &GaitModel, name: &str, scale: f64) -> GaitStyle {
    let mut steps = base.steps.clone();
    for step in &mut steps {
        step.other_terminal += 0.03 * scale;
        for state in &mut step.states {
            for (dim, mean) in state.mean.iter_mut().enumerate() {
                *mean += scale * 0.05 * ((dim % 5) as f64 - 1.5);
            }
            for variance in &mut state.variance {
                *variance *= 1.0 + 0.5 * scale.abs();
            }
            state.duration_mean *= 1.0 + 0.25 * scale.abs();
        }
    }
    let mut global_variance = base.global_variance.clone();
    for mean in &mut global_variance.mean {
        *mean *= 1.0 + 0.5 * scale.abs();
    }
    GaitStyle {
        name: name.to_owned(),
        base_fingerprint: base.fingerprint().unwrap(),
        steps,
        global_variance,
        speed_mps: base.speed.reference_mps * 0.75,
        cadence_hz: 1.75,
        step_spread: StepSpread::default(),
        provenance: Provenance {
            corpus: "made by a test".to_owned(),
            ..Provenance::default()
        },
    }
}

#[test]
fn a_style_survives_the_round_trip_in_tens_of_kilobytes() {
    let base = base();
    let style = style(&base, "sad", 1.0);
    let bytes = style.to_bytes().unwrap();
    assert!((14_000..20_000).contains(&bytes.len()), "{}", bytes.len());
    let again = GaitStyle::from_bytes(&bytes).unwrap();
    assert_eq!(again.to_bytes().unwrap(), bytes);
    assert_eq!(again.base_fingerprint, style.base_fingerprint);
    assert_eq!(
        (&again.name, &again.provenance),
        (&style.name, &style.provenance)
    );
    let pairs = again.steps[1].states[3]
        .mean
        .iter()
        .zip(&style.steps[1].states[3].mean);
    assert!(pairs.into_iter().all(|(a, b)| (a - b).abs() < 1e-6));
    assert_eq!(read_header(&bytes).unwrap().1.kind, "style");
}

#[test]
fn models_and_styles_are_not_taken_for_each_other() {
    let base = base();
    let model_bytes = base.to_bytes().unwrap();
    let style_bytes = style(&base, "sad", 1.0).to_bytes().unwrap();
    assert!(matches!(
        GaitStyle::from_bytes(&model_bytes),
        Err(ModelFileError::WrongKind { .. })
    ));
    assert!(matches!(
        GaitModel::from_bytes(&style_bytes),
        Err(ModelFileError::WrongKind { .. })
    ));
    for length in (0..style_bytes.len()).step_by(501) {
        assert!(GaitStyle::from_bytes(&style_bytes[..length]).is_err());
    }
}

#[test]
fn the_fingerprint_survives_the_file() {
    let base = base();
    let loaded = GaitModel::from_bytes(&base.to_bytes().unwrap()).unwrap();
    assert_eq!(loaded.fingerprint().unwrap(), base.fingerprint().unwrap());
    let mut other = base.clone();
    other.steps[0].states[0].mean[0] += 0.1;
    let style = style(&base, "sad", 1.0);
    let error = other.styled(&[(&style, 1.0)]).unwrap_err();
    assert!(
        error
            .to_string()
            .contains("'sad' was made for another base"),
        "{error}"
    );
}

#[test]
fn the_ends_of_the_scale_are_exact() {
    let base = base();
    let sad = style(&base, "sad", 1.0);
    assert_eq!(base.styled(&[]).unwrap(), base);
    assert_eq!(base.styled(&[(&sad, 0.0)]).unwrap(), base);
    let styled = base.styled(&[(&sad, 1.0)]).unwrap();
    assert_eq!(styled.steps, sad.steps);
    assert_eq!(styled.global_variance, sad.global_variance);
    assert!((styled.speed.reference_mps - sad.speed_mps).abs() < 1e-12);
    styled.check().unwrap();
    let ratio = styled.speed.max_mps / base.speed.max_mps;
    assert!((ratio - 0.75).abs() < 1e-9);
    assert!(styled.cadence_hz() < base.cadence_hz());
}

#[test]
fn halfway_is_halfway() {
    let base = base();
    let sad = style(&base, "sad", 1.0);
    let half = base.styled(&[(&sad, 0.5)]).unwrap();
    let (from, to, at) = (
        &base.steps[0].states[2],
        &sad.steps[0].states[2],
        &half.steps[0].states[2],
    );
    for dim in 0..OBSERVATION_COUNT {
        assert!((at.mean[dim] - 0.5 * (from.mean[dim] + to.mean[dim])).abs() < 1e-12);
        assert!((at.variance[dim].powi(2) - from.variance[dim] * to.variance[dim]).abs() < 1e-9);
    }
    assert!((at.duration_mean.powi(2) - from.duration_mean * to.duration_mean).abs() < 1e-9);
}

#[test]
fn knees_do_not_bend_backwards_however_negative_the_weight() {
    let base = base();
    let mut bent = style(&base, "bent", 1.0);
    let knee = feature_offset(Joint::LeftLowerLeg);
    for state in bent.steps.iter_mut().flat_map(|step| &mut step.states) {
        state.mean[knee] += 1.0;
    }
    for weight in [-1.0, -5.0, -1e300] {
        let model = base.styled(&[(&bent, weight)]).unwrap();
        model.check().unwrap();
        for state in model.steps.iter().flat_map(|step| &step.states) {
            assert!(state.mean[knee] > -0.021, "{weight}: {}", state.mean[knee]);
        }
    }
}

#[test]
fn weights_that_are_no_numbers_are_refused() {
    let base = base();
    let sad = style(&base, "sad", 1.0);
    for weight in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let error = base.styled(&[(&sad, weight)]).unwrap_err();
        assert!(matches!(error, StyleError::Weight { .. }), "{error}");
    }
    let mut broken = sad;
    broken.steps[0].states[0].variance[0] = -1.0;
    assert!(matches!(
        base.styled(&[(&broken, 1.0)]),
        Err(StyleError::Content { .. })
    ));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]
    #[test]
    fn any_weights_give_a_model_that_can_be_used(a in -1e6_f64..1e6, b in -4.0_f64..4.0) {
        let base = base();
        let (one, two) = (style(&base, "one", 1.0), style(&base, "two", -0.6));
        let mixed = base.styled(&[(&one, a), (&two, b)]).unwrap();
        prop_assert!(mixed.check().is_ok());
        prop_assert_eq!(&mixed, &base.styled(&[(&two, b), (&one, a)]).unwrap());
        for state in mixed.steps.iter().flat_map(|step| &step.states) {
            for joint in Joint::ALL {
                for (axis, [low, high]) in rotation_limits(joint).into_iter().enumerate() {
                    let value = state.mean[feature_offset(joint) + axis];
                    prop_assert!(value > low - 1e-6 - 0.2 && value < high + 1e-6 + 0.2, "{joint:?} {value}");
                }
            }
        }
        let secs = 1.0 / mixed.cadence_hz();
        prop_assert!((0.1..3.0).contains(&secs), "{secs}");
    }
}

#[test]
fn the_spread_of_steps_is_worn_and_mixed() {
    let model = base();
    let mut lively = style(&model, "lively", 0.0);
    lively.step_spread.features[3] = 4.0;
    lively.step_spread.timing = 0.25;
    let component = |model: &GaitModel| model.variation.step[0][0].clone();
    let (plain, worn) = (
        component(&model),
        component(&model.mixture(&[(&lively, 1.0)])),
    );
    for (index, (worn, plain)) in worn.means.iter().zip(&plain.means).enumerate() {
        let factor = if index % OBSERVATION_COUNT % FEATURE_COUNT == 3 {
            4.0
        } else {
            1.0
        };
        assert!(
            (worn - factor * plain).abs() < 1e-9 * plain.abs(),
            "number {index}"
        );
    }
    assert!((worn.log_durations[2] - 0.25 * plain.log_durations[2]).abs() < 1e-9);
    let half = component(&model.mixture(&[(&lively, 0.5)]));
    assert!((half.means[3] - 2.0 * plain.means[3]).abs() < 1e-9);
    lively.step_spread.features.pop();
    assert!(lively.check().is_err());
}
