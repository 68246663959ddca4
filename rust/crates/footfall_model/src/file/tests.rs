use super::container::MAGIC;
use super::*;
use crate::crouching::CrouchModel;
use crate::fine_motion::{FINE_POINTS, FINE_TAPS, FineChance, FineMotion};
use crate::gait_model::{
    GlobalVarianceModel, STATES_PER_STEP, SpeedResponse, StateModel, StepContext, StepModel,
    StepOffset, Variation,
};
use crate::jumping::{BESIDE_COUNT, JumpModel, JumpPhase};
use crate::layout::{FEATURE_COUNT, OBSERVATION_COUNT};
use crate::standing::{Breath, Looks, SWAY_COUNT, StandingModel, SwayOctave};
use footfall_core::{Side, Skeleton, StepPosition};
use footfall_prob::windows::Windows;
use proptest::prelude::*;

/// A model whose numbers are all different and exact in f32.
pub(crate) fn sample() -> GaitModel {
    let row = |scale: f64, len: usize| (0..len).map(|i| scale * (i + 1) as f64).collect::<Vec<_>>();
    let offset = |scale: f64| StepOffset::from_row(&row(scale, StepOffset::LEN)).unwrap();
    let step = |scale: f64| StepModel {
        states: (0..STATES_PER_STEP)
            .map(|state| StateModel {
                mean: row(scale * (state + 1) as f64, OBSERVATION_COUNT),
                variance: row(0.25, OBSERVATION_COUNT),
                duration_mean: 6.5,
                duration_variance: 1.5,
            })
            .collect(),
        other_terminal: 0.25,
    };
    GaitModel {
        frame_rate_hz: 60.0,
        skeleton: Skeleton::standard(),
        windows: Windows::Compact,
        steps: [step(0.5), step(-0.5)],
        global_variance: GlobalVarianceModel {
            mean: row(0.5, FEATURE_COUNT),
            variance: row(0.125, FEATURE_COUNT),
        },
        speed: SpeedResponse {
            reference_mps: 1.25,
            min_mps: 0.75,
            max_mps: 1.75,
            cadence_range_hz: [1.5, 2.25],
            slopes: [offset(0.5), offset(0.25)],
        },
        variation: Variation {
            walker: vec![[offset(0.5), offset(1.0)]],
            step: vec![[offset(2.0), offset(4.0)], [offset(0.125), offset(8.0)]],
            step_correlation: 0.5,
        },
        contexts: Vec::new(),
        fine: None,
        standing: None,
        running: None,
        jump: None,
        crouch: None,
        provenance: Provenance {
            corpus: "made by a test".to_owned(),
            clips: 3,
            ..Provenance::default()
        },
    }
}

#[test]
fn a_model_survives_the_round_trip() {
    let model = sample();
    let bytes = model.to_bytes().unwrap();
    assert_eq!(GaitModel::from_bytes(&bytes).unwrap(), model);
    let (version, header) = read_header(&bytes).unwrap();
    assert_eq!((version, header.kind.as_str()), (FORMAT_1, "gait"));
}

/// Fine motion of numbers that are all different and exact in f32.
fn fine() -> FineMotion {
    let row = |scale: f64, len: usize| (0..len).map(|i| scale * (i + 1) as f64).collect::<Vec<_>>();
    let table = |scale: f64| [scale, -scale].map(|scale| row(scale, FINE_POINTS * FEATURE_COUNT));
    FineMotion {
        shared: table(0.5),
        walker: vec![table(0.25)],
        chance: FineChance {
            kernels: vec![row(0.125, FINE_TAPS); 2],
            directions: vec![row(2.0, FEATURE_COUNT), row(-0.5, FEATURE_COUNT)],
            walker_strength: vec![0.375],
        },
        scale: row(0.5, FEATURE_COUNT),
    }
}

#[test]
fn fine_motion_survives_and_leaves_the_fingerprint_alone() {
    let plain = sample();
    let model = GaitModel {
        fine: Some(fine()),
        ..plain.clone()
    };
    let bytes = model.to_bytes().unwrap();
    assert_eq!(read_header(&bytes).unwrap().0, FORMAT_3);
    assert_eq!(GaitModel::from_bytes(&bytes).unwrap(), model);
    assert_eq!(model.fingerprint().unwrap(), plain.fingerprint().unwrap());
}

/// A walk of any version gets a standing: everything survives, and styles fit as before.
#[test]
fn standing_survives_beside_every_version_of_the_walk() {
    let row = |scale: f64, len: usize| (0..len).map(|i| scale * (i + 1) as f64).collect::<Vec<_>>();
    let standing = StandingModel {
        posture: row(0.25, FEATURE_COUNT),
        hips_ahead: 0.0625,
        stance: SwayOctave {
            knot_secs: 24.0,
            directions: vec![row(0.375, SWAY_COUNT)],
        },
        octaves: vec![
            SwayOctave {
                knot_secs: 8.0,
                directions: vec![row(0.5, SWAY_COUNT), row(-0.5, SWAY_COUNT)],
            },
            SwayOctave {
                knot_secs: 0.5,
                directions: vec![row(0.125, SWAY_COUNT)],
            },
        ],
        looks: Looks {
            rate_hz: 0.125,
            shift_secs: 1.25,
            directions: vec![row(2.0, SWAY_COUNT), row(4.0, SWAY_COUNT)],
        },
        breath: Breath {
            rate_hz: 0.25,
            direction: row(-2.0, SWAY_COUNT),
        },
        strength_spread: 0.375,
    };
    let plain = sample();
    for (fine, contexts) in [(None, 0), (None, 1), (Some(fine()), 1)] {
        let context = StepContext {
            position: StepPosition::Last,
            side: Side::Right,
            offset: plain.speed.slopes[0].clone(),
        };
        let model = GaitModel {
            fine,
            contexts: vec![context; contexts],
            standing: Some(standing.clone()),
            ..plain.clone()
        };
        let bytes = model.to_bytes().unwrap();
        assert_eq!(read_header(&bytes).unwrap().0, FORMAT_4);
        assert_eq!(GaitModel::from_bytes(&bytes).unwrap(), model);
        assert_eq!(model.fingerprint().unwrap(), plain.fingerprint().unwrap());
        let runner = GaitModel {
            running: Some(Box::new(run_of(&plain))),
            ..model
        };
        let bytes = runner.to_bytes().unwrap();
        assert_eq!(read_header(&bytes).unwrap().0, FORMAT_5);
        assert_eq!(GaitModel::from_bytes(&bytes).unwrap(), runner);
        assert_eq!(runner.fingerprint().unwrap(), plain.fingerprint().unwrap());
    }
}

/// A model of any version learns to jump, to crouch or both: everything survives, and styles fit as before.
#[test]
fn jumps_and_crouches_survive_beside_every_version() {
    let row = |scale: f64| (0..BESIDE_COUNT).map(|i| scale * (i + 1) as f64).collect();
    let phase = |scale: f64| JumpPhase {
        secs: [scale, 0.25, -0.125],
        knots: vec![
            [row(scale), row(-scale), row(0.5)],
            [row(2.0), row(1.0), row(scale)],
        ],
    };
    let jump = JumpModel {
        phases: [0.25, 0.5, 0.75, 1.0, 1.25].map(phase),
        rise: [0.25, 0.5, 0.75],
        way: [0.0, 0.5, 1.5],
    };
    let crouch = CrouchModel {
        beside: row(-0.125),
        fastest: 1.5,
    };
    let plain = sample();
    let runner = GaitModel {
        running: Some(Box::new(run_of(&plain))),
        ..plain.clone()
    };
    for model in [&plain, &runner] {
        for (jump, crouch) in [
            (Some(&jump), None),
            (None, Some(&crouch)),
            (Some(&jump), Some(&crouch)),
        ] {
            let model = GaitModel {
                jump: jump.cloned(),
                crouch: crouch.cloned(),
                ..model.clone()
            };
            let bytes = model.to_bytes().unwrap();
            assert_eq!(read_header(&bytes).unwrap().0, FORMAT_VERSION);
            assert_eq!(GaitModel::from_bytes(&bytes).unwrap(), model);
            assert_eq!(model.fingerprint().unwrap(), plain.fingerprint().unwrap());
        }
    }
}

/// Steps that end in flight, from other recordings than the walk's.
fn run_of(walk: &GaitModel) -> GaitModel {
    let mut run = walk.clone();
    for step in &mut run.steps {
        step.other_terminal = -0.25;
    }
    run.provenance.corpus = "runs".to_owned();
    run
}

#[test]
fn a_run_that_does_not_belong_to_its_walk_is_refused() {
    let refused = |change: &dyn Fn(&mut GaitModel)| {
        let mut run = run_of(&sample());
        change(&mut run);
        let model = GaitModel {
            running: Some(Box::new(run)),
            ..sample()
        };
        model.to_bytes().unwrap_err().to_string()
    };
    let said = refused(&|run| run.frame_rate_hz *= 2.0);
    assert!(said.contains("frame rate of the run"), "{said}");
    let said = refused(&|run| run.running = Some(Box::new(sample())));
    assert!(said.contains("crouching of the run"), "{said}");
    let said = refused(&|run| run.steps[0].states[1].variance[3] = 0.0);
    assert!(said.contains("state 1"), "{said}");
}

#[test]
fn fine_motion_of_another_shape_is_refused() {
    let refused = |change: &dyn Fn(&mut FineMotion)| {
        let mut fine = fine();
        change(&mut fine);
        let model = GaitModel {
            fine: Some(fine),
            ..sample()
        };
        model.to_bytes().unwrap_err().to_string()
    };
    let said = refused(&|fine| fine.walker.clear());
    assert!(said.contains("fine motion"), "{said}");
    let said = refused(&|fine| fine.shared[1].truncate(7));
    assert!(said.contains("fine motion"), "{said}");
    let said = refused(&|fine| fine.chance.kernels[1][2] = f64::NAN);
    assert!(said.contains("kernel"), "{said}");
    let said = refused(&|fine| fine.scale[0] = 0.0);
    assert!(said.contains("scale"), "{said}");
}

#[test]
fn steps_at_the_ends_of_a_walk_survive_and_leave_the_fingerprint_alone() {
    let plain = sample();
    let mut model = plain.clone();
    let offset = model.speed.slopes[0].clone();
    model.contexts = vec![StepContext {
        position: StepPosition::Last,
        side: Side::Right,
        offset,
    }];
    let bytes = model.to_bytes().unwrap();
    assert_eq!(read_header(&bytes).unwrap().0, FORMAT_2);
    let again = GaitModel::from_bytes(&bytes).unwrap();
    assert_eq!(again, model);
    assert_eq!(again.context(StepPosition::Last, Side::Right), Some(0));
    assert_eq!(again.context(StepPosition::Last, Side::Left), None);
    // A style belongs to the steps inside a walk.
    assert_eq!(again.fingerprint().unwrap(), plain.fingerprint().unwrap());
    model.contexts[0].offset.log_durations[2] = f64::NAN;
    assert!(model.to_bytes().is_err());
}

#[test]
fn a_newer_file_names_its_writer() {
    let mut bytes = sample().to_bytes().unwrap();
    bytes[8..12].copy_from_slice(&99_u32.to_le_bytes());
    let error = GaitModel::from_bytes(&bytes).unwrap_err().to_string();
    assert!(
        error.contains("format 99") && error.contains(env!("CARGO_PKG_VERSION")),
        "{error}"
    );
}

#[test]
fn every_cut_is_noticed() {
    let bytes = sample().to_bytes().unwrap();
    for length in (0..bytes.len())
        .step_by(997)
        .chain([7, 11, 15, bytes.len() - 1])
    {
        let error = GaitModel::from_bytes(&bytes[..length]).unwrap_err();
        let expected = if length < MAGIC.len() {
            matches!(error, ModelFileError::NotAModel)
        } else {
            matches!(error, ModelFileError::Truncated { .. })
        };
        assert!(expected, "cut at {length}: {error}");
    }
}

#[test]
fn wrong_content_is_refused_before_it_is_written() {
    let mut model = sample();
    model.steps[1].states[2].variance[7] = 0.0;
    let error = model.to_bytes().unwrap_err().to_string();
    assert!(error.contains("state 2 of the right step"), "{error}");
}

proptest! {
    #[test]
    fn a_changed_byte_is_noticed(position in 0_usize..1_000_000, flip in 1_u8..=255) {
        let mut bytes = sample().to_bytes().unwrap();
        let position = position % bytes.len();
        bytes[position] ^= flip;
        prop_assert!(GaitModel::from_bytes(&bytes).is_err());
    }

    #[test]
    fn garbage_never_panics(bytes in proptest::collection::vec(any::<u8>(), 0..200)) {
        let mut framed = MAGIC.to_vec();
        framed.extend(bytes);
        prop_assert!(GaitModel::from_bytes(&framed).is_err());
    }
}
