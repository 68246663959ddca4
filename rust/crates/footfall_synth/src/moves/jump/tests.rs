use super::course::Course;
use super::*;
use crate::moves::body::Beside;
use footfall_core::Skeleton;
use footfall_model::{BESIDE_COUNT, FEATURE_COUNT, JumpModel, JumpPhase as Phase};

/// A jump whose postures are all numbers of their own.
fn tables() -> JumpTables {
    let mut number = 0.0;
    let mut row = |scale: f64| -> Vec<f64> {
        (0..BESIDE_COUNT)
            .map(|_| {
                number += 1.0;
                scale * f64::sin(number)
            })
            .collect()
    };
    let phases = [(0.4, 4), (0.25, 3), (0.5, 5), (0.15, 2), (0.4, 3)];
    let mut shared: Option<[Vec<f64>; 3]> = None;
    let phases = phases.map(|(secs, count)| {
        let knots: Vec<[Vec<f64>; 3]> = (0..count)
            .map(|knot| match (&shared, knot) {
                (Some(shared), 0) => shared.clone(),
                _ => [row(0.1), row(0.05), row(0.02)],
            })
            .collect();
        shared = knots.last().cloned();
        Phase {
            secs: [secs, 0.1, 0.02],
            knots,
        }
    });
    let model = JumpModel {
        phases,
        rise: [0.1, 0.4, 0.7],
        way: [0.0, 0.5, 2.0],
    };
    JumpTables::of(&model, &[0.0; FEATURE_COUNT])
}

/// Dip and recovery meet the knots at their ends only, and are at rest where the body stands.
#[test]
fn the_course_goes_through_the_knots_and_is_smooth_where_phases_meet() {
    let tables = tables();
    let timing = Timing {
        factors: tables.factors(0.5, 0.8),
        scale: 1.0,
        secs: [0.3, 0.2, 0.5, 0.1, 0.4],
    };
    let mut before: Option<(Beside, Beside)> = None;
    for phase in 0..JUMP_PHASES {
        let count = tables.begins[phase + 1] - tables.begins[phase];
        for within in 0..=count {
            let s = within as f32 / count as f32;
            let beside = tables.beside(phase, s, &timing);
            let ends = within == 0 || within == count;
            if matches!(phase, DIP | RECOVERY) && !ends {
                continue;
            }
            for (dim, value) in beside.into_iter().enumerate() {
                let knot = tables.number(tables.begins[phase] + within, timing.factors, dim);
                assert!(
                    (value - knot).abs() < 1e-4,
                    "knot {within} of phase {phase}"
                );
            }
        }
        let step = 2e-3;
        let per_sec = |from: f32, to: f32| -> Beside {
            let [a, b] = [from, to].map(|s| tables.beside(phase, s, &timing));
            core::array::from_fn(|dim| (b[dim] - a[dim]) / ((to - from) * timing.secs[phase]))
        };
        let begin = tables.beside(phase, 0.0, &timing);
        if let Some((end, speed)) = before {
            for (dim, now) in per_sec(0.0, step).into_iter().enumerate() {
                assert!((begin[dim] - end[dim]).abs() < 1e-4);
                assert!(
                    (now - speed[dim]).abs() < 0.25,
                    "{now} after {}",
                    speed[dim]
                );
            }
        }
        let at_rest = |rates: Beside| rates.iter().all(|rate| rate.abs() < 0.05);
        assert!(phase != DIP || at_rest(per_sec(0.0, step)));
        assert!(phase != RECOVERY || at_rest(per_sec(1.0 - step, 1.0)));
        before = Some((tables.beside(phase, 1.0, &timing), per_sec(1.0 - step, 1.0)));
    }
}

/// Checks that the hips rise as requested, fall freely, and arrive without a jolt.
#[test]
fn hips_go_on_where_the_phase_before_left_them() {
    let tables = tables();
    let body = Body::new(&Skeleton::standard());
    for leap in [
        (0.3, Vec3::ZERO),
        (0.5, Vec3::new(0.1, 0.2, 1.0)),
        (0.05, Vec3::new(0.0, 0.4, 0.3)),
        (9.0, Vec3::new(9.0, -0.5, 9.0)),
        (0.2, Vec3::new(0.0, 9.0, 0.0)),
    ] {
        let (rise_m, way) = leap;
        let course = Course::new(&tables, Leap { rise_m, way }, &body);
        let at = |phase: usize, s: f32| {
            let beside = tables.beside(phase, s, &course.timing);
            course.hips(phase, s, &beside)
        };
        for phase in 0..JUMP_PHASES - 1 {
            let apart = at(phase, 1.0).distance(at(phase + 1, 0.0));
            assert!(apart < 1e-3, "{apart} m after phase {phase} of {leap:?}");
            let apart = course
                .place(phase, 1.0)
                .distance(course.place(phase + 1, 0.0));
            assert!(apart < 1e-3, "{apart} m after phase {phase} of {leap:?}");
        }
        let apex = (0..200)
            .map(|index| at(FLIGHT, index as f32 / 199.0).y)
            .fold(f32::NEG_INFINITY, f32::max);
        let expected = rise_m.min(0.8 * body.leg_length);
        assert!(apex > expected - 1e-3, "{apex} of {leap:?}");
        assert!(
            course
                .timing
                .secs
                .iter()
                .all(|secs| *secs > 0.0 && secs.is_finite())
        );
    }
}
