//! Posture of a leap: a knee is driven up, the leg that took off folds under the body, and the arms rise.
//!
//! Steps of a run whose flight is stretched keep one posture in the air. What is added to it is nothing where feet bear, and was read from the
//! leaps of O3DE's take of jumps, beside the generated ones.

use crate::plan::StepTiming;
use core::f32::consts::PI;
use footfall_core::Joint;
use footfall_core::ease::hump;
use footfall_core::rotation::{exp_map, log_map};
use footfall_model::FEATURE_COUNT;
use footfall_model::layout::feature_offset;
use glam::{Quat, Vec3};

/// Rise of the hips from which the whole posture is added, metres.
const WHOLE_RISE_M: f32 = 0.3;

/// Flexion of hip and knee, radians, in the middle of their movement: of the leg that lands and of the one that took off.
const LEADING: [f32; 2] = [55.0 * DEGREE, 95.0 * DEGREE];
const TRAILING: [f32; 2] = [0.0, 90.0 * DEGREE];

/// Flexion that is added to the shoulders, radians, of the side that took off and of the other.
const ARMS: [f32; 2] = [55.0 * DEGREE, 25.0 * DEGREE];

const DEGREE: f32 = PI / 180.0;

/// Part of the flight's duration by which the leading leg and the arms begin before the take-off, within the step.
const EARLIER: f32 = 0.8;

/// Adds the posture of a leap with this rise of the hips to the features of its step, frame by frame.
pub(crate) fn add_leap(rows: &mut [f32], timing: &StepTiming, rise_m: f32) {
    let Some(take_off) = timing.take_off else {
        return;
    };
    let share = (rise_m / WHOLE_RISE_M).min(1.0);
    let [leaves, lands] = [take_off, timing.frames].map(|frame| frame as f32);
    // The leg that lands has left the ground by then.
    let free = if timing.airborne { 0 } else { timing.terminal };
    let begins = (leaves - EARLIER * (lands - leaves)).max(free as f32);
    let trails = timing.leading;
    for (frame, row) in rows.chunks_exact_mut(FEATURE_COUNT).enumerate() {
        let from = |begin: f32| share * hump((frame as f32 - begin) / (lands - begin));
        let (early, late) = (from(begins), from(leaves));
        for (side, legs, arm, amount) in [
            (trails.other(), LEADING, ARMS[1], early),
            (trails, TRAILING, ARMS[0], late),
        ] {
            // Rotations about the lateral axis flex knees where they are positive, and hips and shoulders where they are negative.
            for (joint, angle) in [(side.upper_leg(), -legs[0]), (side.lower_leg(), legs[1])] {
                let bent = row[feature_offset(joint)];
                flex(row, joint, amount * (angle - bent));
            }
            flex(row, side.upper_arm(), -early * arm);
        }
    }
}

/// Turns a joint about the lateral axis of its parent.
fn flex(row: &mut [f32], joint: Joint, angle: f32) {
    if angle == 0.0 {
        return;
    }
    let vector = &mut row[feature_offset(joint)..][..3];
    let turned = Quat::from_rotation_x(angle) * exp_map(Vec3::from_slice(vector));
    vector.copy_from_slice(&log_map(turned).to_array());
}

#[cfg(test)]
mod tests {
    use super::*;
    use footfall_core::Side;

    #[test]
    fn nothing_is_added_where_the_legs_bear() {
        let timing = StepTiming {
            leading: Side::Left,
            frames: 60,
            terminal: 12,
            take_off: Some(30),
            sets_off: false,
            borne: 0,
            airborne: false,
            rests: false,
        };
        let mut rows = [0.0; 61 * FEATURE_COUNT];
        add_leap(&mut rows, &timing, 0.2);
        let row = |frame: usize| &rows[frame * FEATURE_COUNT..][..FEATURE_COUNT];
        let knee = |frame: usize, side: Side| row(frame)[feature_offset(side.lower_leg())];
        for frame in (0..=12).chain([60]) {
            assert!(
                row(frame).iter().all(|value| value.abs() < 1e-9),
                "frame {frame}"
            );
        }
        for frame in 0..=30 {
            assert!(knee(frame, Side::Left).abs() < 1e-9, "frame {frame}");
        }
        // Two thirds of the rise from which all of it is added.
        let expected = 2.0 / 3.0 * TRAILING[1];
        assert!((knee(45, Side::Left) - expected).abs() < 1e-5);
        assert!(knee(30, Side::Right) > 0.5 * LEADING[1]);
    }
}
