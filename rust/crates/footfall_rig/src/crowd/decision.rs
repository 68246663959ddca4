//! Decisions of a walker: speed and turning towards its goal, around others.

use super::agent::Agent;
use super::avoidance::Wayfarer;
use super::goal::Goal;
use super::neighbours::Passerby;
use super::steering::{ARC_SPEED, turn_rate, turning_speed};
use footfall_core::rotation::wrap_angle;
use footfall_synth::Controls;

/// Speed of arrival at a goal, m/s, and its increase with each metre that is left.
const ARRIVING_MPS: f32 = 0.5;
const ARRIVING_RATE: f32 = 0.8;
/// Time that a walker continues after it decides to stop, seconds: half of it in the step that comes to a stand, and half a step until the next decision.
const AHEAD_SECS: f32 = 0.7;
/// Space that a walker needs to turn around in an arc, metres.
const ARC_M: f32 = 2.0;
/// Distance to the goal below which a walker takes no further step, metres, and the same where somebody stands beside the goal.
const THERE_M: f32 = 0.5;
const BESIDE_M: f32 = 0.8;
/// Distance from the goal, metres, and speed, m/s, below which somebody stands beside it.
const TAKEN_M: f32 = 0.9;
const STANDS_MPS: f32 = 0.2;

impl Agent {
    /// Sets speed and turning for the next step. The walker slows down for its last goal if it `stops` there.
    pub(super) fn decide(&mut self, others: &[Passerby], stops: bool) {
        let mut speed = self.speed_mps;
        let turn = match self.goal {
            Goal::Turn(rate) => rate,
            Goal::Awaited(_) => {
                speed = 0.0;
                0.0
            }
            Goal::Place(place) => {
                let here = self.level();
                let far = place.distance(here);
                let last = self.route.is_empty();
                // Who avoids somebody at his goal would go to and fro before it.
                let is_taken = || {
                    others.iter().any(|other| {
                        let stands = other.velocity.length() < STANDS_MPS && other.place != here;
                        stands && other.place.distance(place) < TAKEN_M
                    })
                };
                let there = far < THERE_M || (far < BESIDE_M && is_taken());
                let left = if last && there {
                    0.0
                } else if last && stops {
                    (far - AHEAD_SECS * self.present_mps()).max(0.0)
                } else {
                    f32::INFINITY
                };
                if left <= 0.0 {
                    speed = 0.0;
                }
                speed = speed.min(ARRIVING_MPS + ARRIVING_RATE * left);
                let (way, room_rad) = self.way_to(place);
                let mut off = wrap_angle(way.x.atan2(way.y) - self.heading);
                let wayfarer = Wayfarer {
                    place: self.level(),
                    heading: self.heading,
                    off,
                    speed_mps: self.speed_mps,
                    present_mps: self.present_mps(),
                    room_rad,
                };
                // A walker that takes no step avoids nobody.
                if left > 0.0
                    && let Some(detour) = wayfarer.detour(others.iter())
                {
                    off += detour.aside;
                    speed *= detour.speed;
                }
                // A large turn comes first, on the spot if there is no space for an arc.
                let least = if left < ARC_M { 0.0 } else { ARC_SPEED };
                speed *= turning_speed(off, least);
                if left <= 0.0 { 0.0 } else { turn_rate(off) }
            }
        };
        // A large body takes longer steps in more time: speeds go with the root of its size (Froude).
        let froude = self.size.sqrt();
        self.controls = Controls {
            speed_mps: speed / froude,
            turn_rate_radps: turn * froude,
            ..Controls::STAND
        };
    }

    /// Speed at the end of the current step, m/s: the measured speed lags behind.
    fn present_mps(&self) -> f32 {
        let asked = self.controls.speed_mps * self.size.sqrt();
        asked.min(self.velocity.length())
    }

    /// Returns whether its next step begins within this time, so that a decision is due.
    pub(super) fn is_about_to_step(&self, dt_secs: f32) -> bool {
        let walker = self.walker.as_ref();
        walker.is_some_and(|walker| walker.secs_to_next_step() <= dt_secs / self.size.sqrt())
    }
}
