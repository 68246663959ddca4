//! Walking and running, and the choice between them.

use super::slowing::LESS_LOST;
use crate::controls::{FASTEST_RUN_MPS, GaitChoice};
use glam::Vec2;

/// Kind of gait.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Gait {
    /// At least one foot bears.
    #[default]
    Walk,
    /// Both feet are in the air between one step and the next.
    Run,
}

/// Froude numbers (v² over g times the leg's length) above which a walker begins to run and below which a runner begins to walk. People change
/// at about 0.5, and not at the same speed in both directions.
const RUN_FROM_FROUDE: f32 = 0.5;
const WALK_FROM_FROUDE: f32 = 0.4;
pub(crate) const GRAVITY_MPS2: f32 = 9.81;

/// Largest angle between the direction of a run and the facing direction, radians: people do not run sideways.
pub(crate) const WIDEST_RUN_RAD: f32 = 1.1;

/// Fastest speed of a walk, m/s.
pub(crate) const FASTEST_WALK_MPS: f32 = 3.0;

/// Largest difference in velocity between consecutive steps, m/s, walked and run: people who start or brake hard
/// change their velocity by 3 to 4 m/s².
const MOST_CHANGE_MPS: [f32; 2] = [1.2, 1.6];

/// Speed from which a walker can stop within the next two steps, and which it reaches in its first step, m/s.
pub(crate) const STOPPABLE_MPS: f32 = 2.0;

impl GaitChoice {
    /// Returns the gait of a step at this velocity to the left and forwards, after one of `before`, on legs of this length. `starts_or_stops` is true if the
    /// step begins or ends standing.
    pub(crate) fn of_step(
        self,
        before: Gait,
        velocity_mps: Vec2,
        leg_length: f32,
        starts_or_stops: bool,
    ) -> Gait {
        let direction = velocity_mps.x.atan2(velocity_mps.y);
        if starts_or_stops || self == Self::Walk || direction.abs() > WIDEST_RUN_RAD {
            return Gait::Walk;
        }
        let froude = velocity_mps.length_squared() / (GRAVITY_MPS2 * leg_length);
        let threshold = match before {
            Gait::Walk => RUN_FROM_FROUDE,
            Gait::Run => WALK_FROM_FROUDE,
        };
        if self == Self::Run || froude > threshold {
            Gait::Run
        } else {
            Gait::Walk
        }
    }
}

impl Gait {
    /// Largest difference in velocity from the previous step, m/s. `slows` is true for the quick steps in which a runner slows down to stand.
    pub(crate) const fn most_change_mps(self, slows: bool) -> f32 {
        let share = if slows { LESS_LOST } else { 1.0 };
        share * MOST_CHANGE_MPS[self as usize]
    }

    /// Fastest speed of the gait, m/s.
    pub(crate) const fn fastest_mps(self) -> f32 {
        match self {
            Self::Walk => FASTEST_WALK_MPS,
            Self::Run => FASTEST_RUN_MPS,
        }
    }

    /// Returns a velocity to the left and forwards relative to the facing direction of the steps: a runner's body turns to its direction of travel.
    pub(crate) fn seen_from_steps(self, velocity_mps: Vec2) -> Vec2 {
        match self {
            Self::Walk => velocity_mps,
            Self::Run => velocity_mps.length() * Vec2::Y,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LEG: f32 = 0.85;

    fn gait(choice: GaitChoice, before: Gait, speed: f32) -> Gait {
        choice.of_step(before, speed * Vec2::Y, LEG, false)
    }

    #[test]
    fn people_change_near_two_metres_a_second_and_not_back_at_once() {
        assert_eq!(gait(GaitChoice::Auto, Gait::Walk, 1.9), Gait::Walk);
        assert_eq!(gait(GaitChoice::Auto, Gait::Walk, 2.2), Gait::Run);
        assert_eq!(gait(GaitChoice::Auto, Gait::Run, 1.95), Gait::Run);
        assert_eq!(gait(GaitChoice::Auto, Gait::Run, 1.7), Gait::Walk);
    }

    #[test]
    fn short_legs_run_sooner() {
        let child = GaitChoice::Auto.of_step(Gait::Walk, 1.6 * Vec2::Y, 0.45, false);
        assert_eq!(child, Gait::Run);
    }

    #[test]
    fn nobody_runs_sideways_or_out_of_standing() {
        let side = GaitChoice::Run.of_step(Gait::Run, 3.0 * Vec2::X, LEG, false);
        let start = GaitChoice::Run.of_step(Gait::Walk, 3.0 * Vec2::Y, LEG, true);
        assert_eq!([side, start], [Gait::Walk; 2]);
        assert_eq!(gait(GaitChoice::Run, Gait::Walk, 1.0), Gait::Run);
        assert_eq!(gait(GaitChoice::Walk, Gait::Walk, 3.0), Gait::Walk);
    }
}
