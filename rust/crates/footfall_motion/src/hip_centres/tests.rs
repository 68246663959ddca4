//! Synthetic people whose hip joints are misplaced by known amounts.

use super::reference::FLEXION_DEG;
use super::*;
use crate::walking_evidence::{PHASES, STRIDE_SHARES, Stance};

const SEGMENTS: [[f32; 2]; 2] = [[0.49, 0.51], [0.49, 0.51]];

/// A person with knees of their own: `bent` degrees more than normal gait, and 2° to and fro over stance.
fn walks(bent: f64, strides: usize) -> WalkingEvidence {
    walks_with(strides, |_| bent)
}

/// The same with a difference from normal gait at each share of the stride, degrees.
fn walks_with(strides: usize, bent: impl Fn(f64) -> f64) -> WalkingEvidence {
    let stances = (0..2 * strides)
        .map(|n| {
            let side = Side::BOTH[n % 2];
            let hip_from_ankle = core::array::from_fn(|phase| {
                let share = f64::from(STRIDE_SHARES[phase]);
                let own = 2.0 * (9.0 * share + 0.7 * n as f64).sin();
                let flexion = (FLEXION_DEG[phase] + bent(share) + own).to_radians();
                let [thigh, shank] = SEGMENTS[side.index()].map(f64::from);
                let squares = thigh * thigh + shank * shank;
                let distance = (squares + 2.0 * thigh * shank * flexion.cos()).sqrt();
                // From behind the ankle to ahead of it, on a pelvis that stays level.
                let lean = 0.4 * (share - 0.25) / 0.25;
                Vec3::new(0.02, lean.cos() as f32, lean.sin() as f32) * distance as f32
            });
            Stance {
                side,
                hip_from_ankle,
            }
        })
        .collect();
    WalkingEvidence {
        segments: SEGMENTS,
        stances,
        ..WalkingEvidence::default()
    }
}

/// The same recording from a skeleton whose joints have to move by `offsets` and whose legs are too short by `factor`.
fn misplaced(mut evidence: WalkingEvidence, offsets: [Vec2; 2], factor: f32) -> WalkingEvidence {
    for stance in &mut evidence.stances {
        let [up, forward] = offsets[stance.side.index()].to_array();
        for hip in &mut stance.hip_from_ankle {
            *hip = *hip * factor - Vec3::new(0.0, up, forward);
        }
    }
    evidence
}

/// Flexion over stance once the joints are where a finding says that they belong, degrees.
fn curve(mut evidence: WalkingEvidence, correction: &HipCorrection) -> reference::KneeCurve {
    for stance in &mut evidence.stances {
        for hip in &mut stance.hip_from_ankle {
            *hip = (*hip + correction.offset(stance.side)) / correction.leg_factor;
        }
    }
    Legs::new(&[&evidence]).mean_knee(&Parameters::default())
}

/// Root mean square difference.
fn apart(a: &reference::KneeCurve, b: &reference::KneeCurve) -> f64 {
    let squares = a.iter().zip(b).map(|(a, b)| (a - b).powi(2));
    (squares.sum::<f64>() / PHASES as f64).sqrt()
}

fn of_origin(mut evidence: WalkingEvidence, origin: Origin) -> WalkingEvidence {
    evidence.origin = origin;
    evidence
}

fn fitted(evidence: WalkingEvidence) -> WalkingEvidence {
    of_origin(evidence, Origin::MarkerFit)
}

fn landmarks_of_reference() -> [f32; 3] {
    reference::landmarks(&FLEXION_DEG)
}

#[test]
fn misplaced_hip_joints_are_found() {
    for (offset, factor) in [
        (Vec2::new(0.02, -0.05), 1.0),
        (Vec2::new(0.015, -0.012), 1.005),
        (Vec2::new(0.025, 0.01), 0.995),
        (Vec2::new(0.025, 0.03), 0.995),
    ] {
        let evidence = fitted(misplaced(walks(0.0, 6), [offset; 2], factor));
        let finding = find_hip_centres(&[&evidence]);
        let correction = finding.verdict.correction().copied().unwrap();
        // Up and longer legs do the same to a knee; together they must be right.
        for found in correction.offsets {
            let raised = found.x - (correction.leg_factor - 1.0);
            let known = offset.x - (factor - 1.0);
            assert!((raised - known).abs() < 0.004, "{offset}: {correction:?}");
            assert!(
                (found.y - offset.y).abs() < 0.008,
                "{offset}: {correction:?}"
            );
        }
        let knee = finding.knee.unwrap();
        for (found, known) in knee.into_iter().zip(landmarks_of_reference()) {
            assert!((found - known).abs() < 3.0, "{offset}: {knee:?}");
        }
    }
}

#[test]
fn a_skeleton_of_unknown_origin_is_corrected_only_on_strong_evidence() {
    let clear = misplaced(walks(0.0, 6), [Vec2::new(0.02, -0.05); 2], 1.0);
    let finding = find_hip_centres(&[&clear]);
    assert!(finding.verdict.correction().is_some());
    assert!(finding.probability.unwrap() > 0.9, "{finding:?}");
    // The same knees could be those of a person who walks a little bent.
    let doubtful = misplaced(walks(0.0, 6), [Vec2::new(0.012, -0.005); 2], 1.0);
    let finding = find_hip_centres(&[&doubtful]);
    assert_eq!(finding.verdict.correction(), None);
    assert_eq!(finding.knee, finding.recorded_knee);
    let finding = find_hip_centres(&[&fitted(doubtful)]);
    assert!(finding.verdict.correction().is_some());
}

#[test]
fn what_is_a_persons_own_stays_theirs() {
    const NOTHING: HipCorrection = HipCorrection {
        offsets: [Vec2::ZERO; 2],
        leg_factor: 1.0,
    };
    let about = |share: f64, middle: f64| (-0.5 * ((share - middle) / 0.06).powi(2)).exp();
    // Knees that yield more in loading, hardly at all, and that stay bent in the middle of stance.
    for (degrees, middle) in [(10.0, 0.13), (-10.0, 0.13), (9.0, 0.26)] {
        let truth = walks_with(8, |share| degrees * about(share, middle));
        let known = curve(truth.clone(), &NOTHING);
        for offset in [Vec2::new(0.015, -0.012), Vec2::new(0.02, -0.04)] {
            let evidence = fitted(misplaced(truth.clone(), [offset; 2], 1.0));
            let finding = find_hip_centres(&[&evidence]);
            let correction = *finding.verdict.correction().unwrap();
            let error = apart(&curve(evidence, &correction), &known);
            let own = apart(&FLEXION_DEG, &known);
            assert!(
                error < 0.5 * own,
                "{degrees} at {middle}: {error} from their own curve, normal gait is {own}"
            );
        }
    }
}

#[test]
fn a_recording_whose_legs_would_not_reach_is_of_somebody_else() {
    let offset = Vec2::new(0.02, -0.03);
    let own = fitted(misplaced(walks(0.0, 6), [offset; 2], 1.0));
    let correction = *find_hip_centres(&[&own]).verdict.correction().unwrap();
    assert!(correction.suits(&own));
    // On this skeleton the left leg is where it belongs already.
    let other = misplaced(walks(0.0, 6), [Vec2::new(0.0, -0.03), offset], 1.0);
    assert!(!correction.suits(&fitted(other)));
    assert!(correction.suits(&WalkingEvidence::default()));
}

#[test]
fn legs_that_differ_are_corrected_apart() {
    let offsets = [Vec2::new(0.025, -0.04), Vec2::new(0.015, -0.03)];
    let evidence = fitted(misplaced(walks(0.0, 12), offsets, 1.0));
    let correction = *find_hip_centres(&[&evidence]).verdict.correction().unwrap();
    let apart = correction.offsets[0] - correction.offsets[1];
    assert!(apart.x > 0.004 && apart.y < -0.003, "{apart}");
}

#[test]
fn natural_knees_are_left_alone() {
    for bent in [-2.0, 0.0, 3.0] {
        let finding = find_hip_centres(&[&walks(bent, 5)]);
        assert_eq!(finding.verdict, HipVerdict::Natural, "{bent}");
        assert_eq!(finding.knee, finding.recorded_knee);
    }
}

#[test]
fn who_crouches_throughout_still_does() {
    for origin in [Origin::Unknown, Origin::MarkerFit] {
        for bent in [35.0, 50.0, 80.0] {
            let finding = find_hip_centres(&[&of_origin(walks(bent, 6), origin)]);
            assert_eq!(finding.verdict, HipVerdict::OwnManner, "{origin:?} {bent}");
        }
    }
    // With less flexion, only a skeleton that is known to be misplaced is straightened.
    for bent in [8.0, 12.0, 20.0] {
        let finding = find_hip_centres(&[&walks(bent, 6)]);
        assert_eq!(finding.verdict.correction(), None, "{bent}");
    }
}

#[test]
fn two_strides_tell_only_of_a_known_family() {
    let mut evidence = misplaced(walks(0.0, 1), [Vec2::new(0.02, -0.05); 2], 1.0);
    assert_eq!(
        find_hip_centres(&[&evidence]).verdict,
        HipVerdict::TooLittleWalking
    );
    evidence = fitted(evidence);
    let finding = find_hip_centres(&[&evidence]);
    assert!(finding.verdict.correction().is_some());
    // Many strides of one leg are no evidence for the other.
    let left = evidence.stances[0].clone();
    evidence.stances = vec![left; 9];
    assert_eq!(
        find_hip_centres(&[&evidence]).verdict,
        HipVerdict::TooLittleWalking
    );
}

#[test]
fn one_stride_that_is_no_plain_walking_does_not_hold_a_person_back() {
    let mut evidence = fitted(misplaced(walks(0.0, 8), [Vec2::new(0.02, -0.04); 2], 1.0));
    let alone = *find_hip_centres(&[&evidence]).verdict.correction().unwrap();
    let mut stumble = evidence.stances[0].clone();
    for hip in &mut stumble.hip_from_ankle {
        *hip *= 0.85;
    }
    evidence.stances.push(stumble);
    let both = *find_hip_centres(&[&evidence]).verdict.correction().unwrap();
    assert!((both.offsets[0] - alone.offsets[0]).length() < 0.001);
}

#[test]
fn a_crouched_recording_does_not_hide_a_misplaced_joint() {
    let offset = [Vec2::new(0.02, -0.04); 2];
    let [plain, crouched] =
        [walks(0.0, 6), walks(45.0, 2)].map(|evidence| fitted(misplaced(evidence, offset, 1.0)));
    let alone = find_hip_centres(&[&plain]);
    let both = find_hip_centres(&[&plain, &crouched]);
    assert!(alone.verdict.correction().is_some());
    assert_eq!(alone.verdict, both.verdict);
}

#[test]
fn numbers_beyond_all_measure_are_no_correction() {
    let mut evidence = walks(0.0, 4);
    for stance in &mut evidence.stances {
        stance.hip_from_ankle[3] = Vec3::splat(f32::NAN);
    }
    assert_eq!(
        find_hip_centres(&[&evidence]).verdict,
        HipVerdict::TooLittleWalking
    );
    for stance in &mut evidence.stances {
        stance.hip_from_ankle[3] = Vec3::splat(f32::MAX);
    }
    assert_eq!(find_hip_centres(&[&evidence]).verdict.correction(), None);
    assert_eq!(find_hip_centres(&[]).verdict, HipVerdict::TooLittleWalking);
}

#[test]
fn the_family_of_the_cmu_library_is_known_by_its_joints() {
    let names = ["Hips", "LHipJoint", "LeftUpLeg", "RHipJoint"];
    assert_eq!(Origin::of(&names.into_iter()), Origin::MarkerFit);
    assert_eq!(Origin::of(&names[..3].iter().copied()), Origin::Unknown);
}
