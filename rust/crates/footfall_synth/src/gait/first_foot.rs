//! First foot of a walk from standing.
//!
//! People lift the foot that bears less weight, who steps aside the foot of that side, and who turns the inner one: on the spot O3DE's actor does in 39 of 48 turns.

use crate::controls::{Controls, STANDING_SPEED_MPS};
use footfall_core::Side;

/// Distance of the hips from the middle of a standing walker's feet from which one bears less weight than the other, as a share of the leg's length.
const UNEVEN: f32 = 0.01;

/// Turn rate from which whoever sets out lifts the inner foot, rad/s.
const TURNS_RADPS: f32 = 1.0;

/// Returns true when people whose hips are so far aside, as a share of the leg's length, positive to the left, do not lift the `usual` foot first for these controls.
pub(crate) fn lifts_other_foot(controls: &Controls, hips_aside: f32, usual: Side) -> bool {
    first_foot(controls, hips_aside).is_some_and(|lifted| lifted != usual)
}

/// Returns the foot that people lift first; `None` if either will do.
fn first_foot(controls: &Controls, hips_aside: f32) -> Option<Side> {
    let velocity = controls.velocity();
    let turn_rate = controls.turn_rate();
    let lifted = if velocity.length() < STANDING_SPEED_MPS || turn_rate.abs() > TURNS_RADPS {
        turn_rate
    } else if velocity.x.abs() > velocity.y.abs() {
        velocity.x
    } else if hips_aside.abs() > UNEVEN {
        -hips_aside
    } else {
        0.0
    };
    if lifted > 0.0 {
        Some(Side::Left)
    } else if lifted < 0.0 {
        Some(Side::Right)
    } else {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f32::consts::FRAC_PI_2;

    #[test]
    fn people_lift_the_foot_without_weight_the_one_of_their_way_and_the_inner_one() {
        let ahead = Controls {
            speed_mps: 1.3,
            ..Controls::STAND
        };
        let aside = Controls {
            direction_rad: FRAC_PI_2,
            ..ahead
        };
        let turning = Controls {
            turn_rate_radps: -0.8,
            ..Controls::STAND
        };
        assert_eq!(first_foot(&ahead, 0.05), Some(Side::Right));
        assert_eq!(first_foot(&ahead, -0.05), Some(Side::Left));
        assert_eq!(first_foot(&ahead, 0.5 * UNEVEN), None);
        assert_eq!(first_foot(&aside, 0.05), Some(Side::Left));
        let leaving = Controls {
            turn_rate_radps: -1.5 * TURNS_RADPS,
            ..ahead
        };
        assert_eq!(first_foot(&turning, -0.05), Some(Side::Right));
        assert_eq!(first_foot(&leaving, -0.05), Some(Side::Right));
        assert_eq!(first_foot(&Controls::STAND, 0.05), None);
    }
}
