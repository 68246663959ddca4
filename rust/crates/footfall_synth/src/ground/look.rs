//! Look: the head turns to where a turn leads, ahead of the body.
//!
//! People who turn look along the way to come (Grasso, Prévost, Ivanenko and Berthoz, Eye-head coordination for the steering of locomotion in humans: an anticipatory synergy, 1998).
//! The generated heads look straight ahead. Therefore chest, neck and head turn with the turn rate that is asked for, from the beginning of the step, sooner than the body takes it up.

use super::frame::PlantedFrame;
use super::planter::Planter;
use super::planter_state::PlanterState;
use super::turning::on_the_spot;
use footfall_core::Joint;
use footfall_core::ease::hermite;
use glam::{Quat, Vec2};
use serde::{Deserialize, Serialize};

/// Times for turning the head: at least, seconds, and more for each radian. The head of O3DE's actor turns by up to 220 °/s relative to his hips.
const LEAST_SECS: f32 = 0.2;
const SECS_A_RAD: f32 = 0.25;

/// Turn of the head relative to the hips in slow turns, radians per rad/s, and its limit in quick ones, radians: on the spot and in a walk or a run.
///
/// O3DE's actor, walking, turns his head by 7°, 18°, 24° and 29° in turns of 20, 45, 80 and 130 °/s (running by 18° and 25° in those of 45 and 80), on the spot by 4°, 8°, 17° and 21°.
/// It goes along best with the turn rate of the hips 0.3 to 0.45 s later, on the spot 0.15 s.
const ON_THE_SPOT: Vec2 = Vec2::new(0.22, 0.5);
const WALKING: Vec2 = Vec2::new(0.55, 0.55);

/// Turn rate that does not turn the head, rad/s.
const UNNOTICED_RADPS: f32 = 0.08;

/// Share of the turn that the chest takes; neck and head take twice as much each.
const CHEST_SHARE: f32 = 0.2;

/// Turn of the head relative to the hips, radians, positive to the left, and its rate of change, rad/s.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Look {
    pub(crate) angle: f32,
    pub(crate) rate: f32,
}

/// Course of the look in a step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Glance {
    begin: Look,
    end: f32,
    secs: f32,
}

impl Glance {
    /// Looks into the turn of a step that ends with this state.
    pub(super) fn new(begin: Look, ended: &PlanterState) -> Self {
        let end = look(ended).angle;
        Self {
            begin,
            end,
            secs: LEAST_SECS + SECS_A_RAD * (end - begin.angle).abs(),
        }
    }

    /// Returns the look at a time after the beginning of the step, seconds.
    pub(super) fn at(&self, secs: f32) -> Look {
        let Self { begin, end, .. } = *self;
        let s = (secs / self.secs).min(1.0);
        let left = 1.0 - s;
        let arriving = 6.0 * s * (end - begin.angle) / self.secs;
        Look {
            angle: hermite(begin.angle, begin.rate * self.secs, end, 0.0, s),
            rate: left * (arriving + begin.rate * (1.0 - 3.0 * s)),
        }
    }
}

/// Returns the look into the turn that goes on at the end of a step, with a head that has come to rest.
pub(crate) fn look(state: &PlanterState) -> Look {
    let walking = (1.0 - on_the_spot(state.stride)) * state.strafe.uprightness();
    let [share, most] = ON_THE_SPOT.lerp(WALKING, walking).to_array();
    let noticed = (state.turn_rate.abs() - UNNOTICED_RADPS).max(0.0) * share / most;
    let angle = most * noticed / (1.0 + noticed * noticed).sqrt();
    Look {
        angle: angle.copysign(state.turn_rate),
        rate: 0.0,
    }
}

impl Planter {
    /// Turns the heads of a step's frames, once the feet stand.
    pub(crate) fn look(&mut self, out: &mut [PlantedFrame]) {
        let glance = Glance::new(self.state.look, &self.state);
        let secs = |index: usize| index as f32 * self.frame_secs;
        if glance.begin != Look::default() || glance.end != 0.0 {
            for (index, frame) in out.iter_mut().enumerate() {
                turn_head(frame, glance.at(secs(index)).angle);
            }
        }
        self.state.look = glance.at(secs(out.len() - 1));
    }
}

/// Turns chest, neck and head about the vertical.
fn turn_head(frame: &mut PlantedFrame, angle: f32) {
    let rotations = &mut frame.pose.rotations;
    let trunk = [Joint::Hips, Joint::Spine, Joint::Chest];
    let [hips, spine, chest] = trunk.map(|joint| rotations[joint.index()]);
    let once = Quat::from_rotation_y(CHEST_SHARE * angle);
    let twice = once * once;
    let mut parent = hips * spine * chest;
    for (joint, turn) in [
        (Joint::UpperChest, once),
        (Joint::Neck, twice),
        (Joint::Head, twice),
    ] {
        // Turns about the vertical add up: each joint turns as if those below did not.
        let rotation = &mut rotations[joint.index()];
        let before = parent * *rotation;
        *rotation = (parent.conjugate() * turn * before).normalize();
        parent = before;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use footfall_ik::Plant;
    use glam::Vec3;

    const H: f32 = 1e-3;

    /// State of a walker that turns.
    fn turning(turn_rate: f32) -> PlanterState {
        let plant = Plant {
            flat_ankle: Vec3::ZERO,
            heading: 0.0,
        };
        PlanterState {
            turn_rate,
            ..PlanterState::first([plant; 2], 0.0)
        }
    }

    #[test]
    fn a_glance_goes_on_from_any_look_without_a_jolt_and_comes_to_rest() {
        let begin = Look {
            angle: -0.2,
            rate: 1.5,
        };
        let glance = Glance::new(begin, &turning(1.0));
        assert_eq!(glance.at(0.0), begin);
        for secs in [0.05, 0.15, 0.28] {
            let [before, now, after] = [secs - H, secs, secs + H].map(|secs| glance.at(secs));
            let rate = (after.angle - before.angle) / (2.0 * H);
            assert!((rate - now.rate).abs() < 0.01, "{rate} {}", now.rate);
            assert_eq!(Glance::new(now, &turning(-2.0)).at(0.0), now);
        }
        let end = glance.at(glance.secs);
        assert_eq!(end, glance.at(2.0));
        assert!(end.rate.abs() < 1e-6 && end.angle > 0.3, "{end:?}");
    }

    #[test]
    fn turns_both_ways_are_alike_and_slow_ones_are_not_noticed() {
        let end = |turn_rate: f32| look(&turning(turn_rate)).angle;
        assert!((end(0.8) + end(-0.8)).abs() < 1e-6);
        assert!(end(0.5 * UNNOTICED_RADPS).abs() < 1e-6);
        assert!(end(50.0) < WALKING.y);
    }
}
