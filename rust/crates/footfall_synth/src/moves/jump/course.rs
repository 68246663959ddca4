//! Course of the hips in a jump: that of the legs before and after, and a parabola in between.

use super::tables::{LEAST_SECS, bulging};
use super::{ABSORPTION, DIP, FLIGHT, JumpTables, Leap, PUSH, RECOVERY, Timing};
use crate::gait::GRAVITY_MPS2;
use crate::moves::body::{Beside, Body};
use footfall_core::ease::{hermite, smooth_step};
use footfall_model::{BESIDE_COUNT, FEATURE_COUNT};
use glam::Vec3;

/// Bounds of the rise of a jump, leg lengths: less is no jump, more is beyond people.
const RISES: [f32; 2] = [0.03, 0.8];

/// Maximum distance of a jump ahead, and to the side or back, leg lengths.
const FARTHEST_AHEAD: f32 = 2.2;
const FARTHEST_ASIDE: f32 = 0.7;

/// Minimum rise of the hips above their height at landing, metres.
const LEAST_FALL_M: f32 = 0.02;

/// Minimum duration of the absorption, as a share of that of an even deceleration.
const ABSORPTION_SHARE: f32 = 0.9;

/// Speed of recorded falls, m/s, extra depth for faster ones, metres per m/s, and its maximum, leg lengths.
const USUAL_FALL_MPS: f32 = 2.8;
const SINK_SECS: f32 = 0.09;
const DEEPEST_SINK: f32 = 0.3;

/// Time before take-off at which the character begins to move, and after landing at which it arrives, seconds.
const SHIFT_SECS: f32 = 0.12;

/// Range of the downward acceleration of the hips as the dip begins, m/s²: near free fall feet would leave the ground, and people begin with
/// their arms, for which players do not wait.
const DROP_MPS2: [f32; 2] = [0.5 * GRAVITY_MPS2, 0.8 * GRAVITY_MPS2];

/// Greatest deceleration of the hips as the recovery ends, m/s²: knees straighten suddenly where it is high.
const SETTLE_MPS2: f32 = 1.5;

/// Part of a phase for numerical slopes.
const SLOPE_PART: f32 = 0.02;

/// The course of one jump.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Course {
    pub(super) timing: Timing,
    /// Displacement of the feet to the left, up and ahead, metres.
    way: Vec3,
    /// Positions of the hips at take-off and at landing, from where they stand before and after the jump, metres.
    ends: [Vec3; 2],
    /// Velocities of the hips there, m/s.
    speeds: [Vec3; 2],
    /// Errors of the model's own course at the end of the push-off and at the beginning of the absorption: metres, and metres per phase.
    missing: [[Vec3; 2]; 2],
    /// Height of the hips between dip and push-off, which raises them evenly, metres.
    bottom: f32,
    /// Delay of the dip as a bulge of the hips' height, so that the body neither falls faster than it can nor waits, metres.
    delay: f32,
    /// Lead of the recovery as a bulge of the hips' way, so that they come to rest gently, metres.
    lead: Vec3,
    /// Extra depth of the absorption beyond that of recorded jumps, metres.
    sink: f32,
    leg: f32,
}

impl Course {
    /// Makes the course of a jump of a body. A rise too low for the landing place is raised; a place beyond reach is replaced by one
    /// on the way to it, as high as can be reached.
    pub(super) fn new(tables: &JumpTables, leap: Leap, body: &Body) -> Self {
        let leg = body.leg_length;
        let rise = (leap.rise_m / leg).clamp(RISES[0], RISES[1]);
        let over_ground = within_reach(leap.way.with_y(0.0), leg);
        let mut timing = tables.timing(rise, over_ground.z / leg);
        let slope = |phase: usize, from: f32| leg * tables.slope(phase, from, &timing);
        let [most, least] = DROP_MPS2.map(|drop| -0.5 * drop * timing.secs[DIP] * timing.secs[DIP]);
        // The dip begins at rest; a bulge has a second derivative of two there.
        let sinking = slope(DIP, 0.0).y / SLOPE_PART;
        let delay = sinking.clamp(least, most) - sinking;
        let own_slopes = [slope(PUSH, 1.0 - SLOPE_PART), slope(ABSORPTION, 0.0)];
        let postures =
            [(PUSH, 1.0), (ABSORPTION, 0.0)].map(|(phase, s)| tables.beside(phase, s, &timing));
        let own_ends = postures.each_ref().map(|beside| leg * hips_of(beside));
        let mut ends = own_ends;
        for (end, beside) in ends.iter_mut().zip(&postures) {
            end.y = end.y.min(highest(tables, body, beside, *end));
        }
        let up = leap.way.y.min(RISES[1] * leg - 2.0 * LEAST_FALL_M);
        let apex = (rise * leg)
            .max(ends[0].y + LEAST_FALL_M)
            .max(up + ends[1].y.max(0.0) + LEAST_FALL_M)
            .min(RISES[1] * leg);
        ends[1].y = ends[1].y.min(apex - up - LEAST_FALL_M);
        let push = (2.0 * GRAVITY_MPS2 * (apex - ends[0].y)).sqrt();
        let bottom = leg * hips_of(&tables.beside(DIP, 1.0, &timing)).y;
        timing.secs[PUSH] = (2.0 * (ends[0].y - bottom) / push).max(LEAST_SECS);
        let fall = (2.0 * GRAVITY_MPS2 * (apex - up - ends[1].y)).sqrt();
        timing.secs[FLIGHT] = (push + fall) / GRAVITY_MPS2;
        let lowest = leg * hips_of(&tables.beside(ABSORPTION, 1.0, &timing)).y;
        let sink = (SINK_SECS * (fall - USUAL_FALL_MPS)).clamp(0.0, DEEPEST_SINK * leg);
        let even_secs = 2.0 * (ends[1].y - lowest + sink) / fall;
        timing.secs[ABSORPTION] = timing.secs[ABSORPTION].max(ABSORPTION_SHARE * even_secs);
        let most = 0.5 * SETTLE_MPS2 * timing.secs[RECOVERY] * timing.secs[RECOVERY];
        let rest = leg * tables.slope(RECOVERY, 1.0 - SLOPE_PART, &timing) / SLOPE_PART;
        // What is left of the sink comes to rest with six times its second derivative.
        let settling = rest + 3.0 * sink * Vec3::Y;
        let lead =
            settling - settling.clamp(Vec3::new(0.0, 0.0, -most), Vec3::new(0.0, most, most));
        let way = over_ground.with_y(up);
        let drift = (way + ends[1] - ends[0]) / timing.secs[FLIGHT];
        let speeds = [push, -fall].map(|rise| drift.with_y(rise));
        let missing = core::array::from_fn(|end| {
            let secs = timing.secs[[PUSH, ABSORPTION][end]];
            [
                ends[end] - own_ends[end],
                speeds[end] * secs - own_slopes[end],
            ]
        });
        Self {
            timing,
            way,
            ends,
            speeds,
            missing,
            bottom,
            delay,
            lead,
            sink,
            leg,
        }
    }

    /// Returns the position of the hips at part `s` of a phase with this posture, relative to standing before the jump, metres.
    pub(super) fn hips(&self, phase: usize, s: f32, beside: &Beside) -> Vec3 {
        let own = self.leg * hips_of(beside);
        let none = Vec3::ZERO;
        let [[off, speed_off], [on, speed_on]] = self.missing;
        match phase {
            DIP => own + self.delay * bulging(s) * Vec3::Y,
            PUSH => {
                let take_off = self.speeds[0].y * self.timing.secs[PUSH];
                let height = hermite(self.bottom, 0.0, self.ends[0].y, take_off, s);
                (own + hermite(none, none, off, speed_off, s)).with_y(height)
            }
            FLIGHT => {
                let t = s * self.timing.secs[FLIGHT];
                let fall = 0.5 * GRAVITY_MPS2 * t * t * Vec3::Y;
                self.ends[0] + self.speeds[0] * t - fall
            }
            ABSORPTION => {
                let lowest = -self.sink * Vec3::Y;
                self.way + own + hermite(on, speed_on, lowest, none, s)
            }
            _ => {
                let sunk = self.sink * (1.0 - smooth_step(s)) * Vec3::Y;
                self.way + own + self.lead * bulging(s) - sunk
            }
        }
    }

    /// Returns the displacement of the feet from their stance.
    pub(super) fn way(&self) -> Vec3 {
        self.way
    }

    /// Returns the displacement of the character at part `s` of a phase: over the ground smoothly around the flight, and in height during the flight.
    pub(super) fn place(&self, phase: usize, s: f32) -> Vec3 {
        let secs = &self.timing.secs;
        let take_off = secs[DIP] + secs[PUSH];
        let now = secs[..phase].iter().sum::<f32>() + s * secs[phase];
        let gone = (now - take_off + SHIFT_SECS) / (secs[FLIGHT] + 2.0 * SHIFT_SECS);
        let up = match phase {
            DIP | PUSH => 0.0,
            FLIGHT => {
                let level = self.ends[0].y + s * (self.ends[1].y - self.ends[0].y);
                self.hips(phase, s, &[0.0; BESIDE_COUNT]).y - level
            }
            _ => self.way.y,
        };
        (self.way * smooth_step(gone)).with_y(up)
    }
}

/// Returns the greatest height of the hips in a posture on bearing feet, relative to their height in standing.
fn highest(tables: &JumpTables, body: &Body, beside: &Beside, end: Vec3) -> f32 {
    let mut pose = tables.standing.clone();
    let feet = body.feet(&pose);
    // Flat soles are on the ground.
    let up = body.feet[0].ankle_height() - feet[0].ankle.y;
    pose.root_position.y += up;
    let plants = body.plants(&pose);
    Body::turn(beside, &mut pose);
    pose.root_position += end;
    body.highest(&pose, &plants) - up
}

impl JumpTables {
    /// Returns the timing of a jump of this rise and way, in leg lengths; that of its flight follows later.
    fn timing(&self, rise: f32, way: f32) -> Timing {
        let factors = self.factors(rise, way);
        let secs = core::array::from_fn(|phase| self.secs(phase, factors));
        Timing {
            factors,
            scale: (rise / self.rise[0]).min(1.0),
            secs,
        }
    }

    /// Returns the rate of the hips' displacement over a small part of a phase, leg lengths a phase.
    fn slope(&self, phase: usize, from: f32, timing: &Timing) -> Vec3 {
        let at = |s: f32| hips_of(&self.beside(phase, s, timing));
        (at(from + SLOPE_PART) - at(from)) / SLOPE_PART
    }
}

/// Limits a way over the ground to the distance that people jump on legs of this length.
fn within_reach(way: Vec3, leg: f32) -> Vec3 {
    let ahead = if way.z > 0.0 {
        FARTHEST_AHEAD
    } else {
        FARTHEST_ASIDE
    };
    let beyond = Vec3::new(way.x / FARTHEST_ASIDE, 0.0, way.z / ahead).length() / leg;
    way / beyond.max(1.0)
}

/// Returns the hips' displacement in a posture, leg lengths.
fn hips_of(beside: &Beside) -> Vec3 {
    Vec3::new(0.0, beside[FEATURE_COUNT], beside[FEATURE_COUNT + 1])
}
