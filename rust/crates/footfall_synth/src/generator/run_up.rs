//! Run-up: steps towards a place to leap to.
//!
//! A leap covers the way of its stance and of its flight. It begins with the step from whose foothold a flight that people manage ends at the place; the flight is as long as that takes.
//! Until then the walker goes on, and drifts sideways so that the body passes over the place. What a leap does not reach by its flight, its steps are displaced by.

use super::GaitGenerator;
use crate::controls::Controls;
use crate::gait::GRAVITY_MPS2;
use crate::source::{Aim, Steps};
use footfall_core::GroundTransform;
use footfall_core::rotation::from_heading;
use glam::Vec3;

/// Least rise of the hips in a leap to a place and the most that is chosen, metres, both above the higher of the beginning and the place.
const LEAST_RISE_M: f32 = 0.15;
const MOST_RISE_M: f32 = 0.42;

/// Greatest difference of height that a leap overcomes, metres; feet are placed on what is there.
const LEVEL_M: f32 = 0.15;

/// Time in which a leap's stance covers its way, seconds, and the share of the speed that walkers and runners keep in the flight.
const STANCE_SECS: f32 = 0.3;
const KEPT: [f32; 2] = [1.05, 0.85];

/// Shares of the lengths of the shortest and the longest flight from which and up to which a leap is displaced to its place.
const NEAREST: f32 = 0.8;
const FARTHEST: f32 = 1.08;

/// Longest run-up, seconds: who is sent farther is not held to the way there for so long.
const LONGEST_SECS: f32 = 4.0;

/// Share by which the next step may be longer than this one.
const LONGER: f32 = 1.1;

/// Greatest displacement sideways by one step, metres.
const MOST_ASIDE_M: f32 = 0.12;

/// Least displacement that is worth it, metres.
const LEAST_M: f32 = 0.01;

/// Greatest distance to the side of the way, metres.
const MOST_OFF_M: f32 = 0.35;

/// Next step of a run-up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct RunUp {
    /// Rise of the hips if the step is the leap.
    pub(crate) rise_m: Option<f32>,
    /// Place to land on, relative to the start of the walk.
    place: Vec3,
    /// Direction of the way in the same space, radians.
    direction: f32,
    /// Displacement to the left by a step before the leap, metres.
    aside_m: f32,
}

impl GaitGenerator {
    /// Returns the next step of the run-up to a place; `None` if no leap lands there.
    pub(super) fn run_up(&self, place: Vec3, controls: &Controls) -> Option<RunUp> {
        let Steps::Styled(steps) = &self.steps else {
            return None;
        };
        let pace = Pace {
            mps: steps.velocity_mps.length(),
            kept: KEPT[self.gait() as usize],
            height: place.y,
        };
        // The step begins where this one ends.
        let from = self.start_from_aim(false);
        let body = self.start_from_aim(true);
        let velocity = controls.velocity();
        let direction = body.heading + velocity.x.atan2(velocity.y);
        let [ahead, _] = along(direction, place - from.position);
        let [_, off] = along(direction, place - body.position);
        let least = LEAST_RISE_M + place.y.max(0.0);
        let [shortest, longest] = [least, MOST_RISE_M].map(|rise| pace.length(rise));
        let possible = place.y.abs() <= LEVEL_M && off.abs() <= MOST_OFF_M && pace.mps > 0.0;
        if !possible || ahead < NEAREST * shortest || ahead > LONGEST_SECS * pace.mps {
            return None;
        }
        let step = LONGER * pace.mps * self.shape().timing.frames as f32 / self.frame_rate_hz;
        let leaps = ahead <= FARTHEST * longest || ahead - step < NEAREST * shortest;
        let steps_left = ((ahead - longest) / step).ceil().max(1.0);
        Some(RunUp {
            rise_m: leaps.then(|| pace.rise(ahead).clamp(least, MOST_RISE_M)),
            place,
            direction,
            aside_m: (off / (steps_left + 1.0)).clamp(-MOST_ASIDE_M, MOST_ASIDE_M),
        })
    }

    /// Leads the step that has just been planned towards the place of its run-up.
    pub(super) fn lead(&mut self, run_up: &RunUp) {
        let leads = self.start_from_aim(false);
        let body = self.start_from_aim(true);
        let [ahead, _] = along(run_up.direction, run_up.place - leads.position);
        let [_, off] = along(run_up.direction, run_up.place - body.position);
        let axis = from_heading(run_up.direction);
        let way = if run_up.rise_m.is_some() {
            axis * Vec3::new(off, 0.0, ahead)
        } else {
            axis * (run_up.aside_m * Vec3::X)
        };
        if way.length() < LEAST_M {
            return;
        }
        self.aim_at(&Aim {
            place: GroundTransform {
                position: leads.position + way,
                heading: leads.heading,
            },
            rests: false,
        });
    }
}

/// Returns the parts of a way ahead and to the left.
fn along(direction: f32, way: Vec3) -> [f32; 2] {
    let seen = from_heading(-direction) * way;
    [seen.z, seen.x]
}

/// Pace of a leap.
struct Pace {
    mps: f32,
    /// Share of it that is kept in the flight.
    kept: f32,
    /// Height of the landing above the beginning, metres.
    height: f32,
}

impl Pace {
    /// Returns the length of a leap that rises by this much, from foot to foot, metres.
    fn length(&self, rise_m: f32) -> f32 {
        let secs = |way: f32| (2.0 * way.max(0.0) / GRAVITY_MPS2).sqrt();
        let flight = secs(rise_m) + secs(rise_m - self.height);
        self.mps * (STANCE_SECS + self.kept * flight)
    }

    /// Returns the rise of a leap of this length, metres.
    fn rise(&self, length: f32) -> f32 {
        let flight = (length / self.mps - STANCE_SECS) / self.kept;
        let up = 0.5 * flight + self.height / (GRAVITY_MPS2 * flight.max(0.1));
        0.5 * GRAVITY_MPS2 * up.max(0.0).powi(2)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rise_of_a_leap_gives_its_length() {
        for height in [-0.15, 0.0, 0.15] {
            let pace = Pace {
                mps: 2.5,
                kept: 0.85,
                height,
            };
            for rise_m in [0.2, 0.3, 0.45] {
                let found = pace.rise(pace.length(rise_m));
                assert!((found - rise_m).abs() < 1e-4, "{found} for {rise_m}");
            }
        }
    }
}
