//! Continuity where the tracker goes over to other segments: velocity-based blending (Mousas 2017, section 6, after Levine et al.).
//!
//! The body goes on at the velocity that the recordings have there, and is drawn to what they say it should be: a change of segments shows
//! as a change of direction, not as a jump.

use crate::body::BodyFrame;
use footfall_core::rotation::log_map_near;
use footfall_model::FEATURE_COUNT;
use footfall_model::imu_model::{BODY_COUNT, HEIGHT};
use glam::{Quat, Vec3};

/// Numbers that are blended: joints and height. The others are rates and probabilities.
const BLENDED: usize = HEIGHT + 1;

/// The body as it is shown.
#[derive(Clone, Copy, Debug)]
pub struct Blend {
    /// Share of the way to the target that is gone in a frame.
    gain: f32,
    body: BodyFrame,
    velocity: BodyFrame,
    started: bool,
}

impl Blend {
    /// A blend that goes this share of the way to its target in each frame.
    pub const fn new(gain: f32) -> Self {
        Self {
            gain,
            body: [0.0; BODY_COUNT],
            velocity: [0.0; BODY_COUNT],
            started: false,
        }
    }

    /// Forgets the body.
    pub const fn reset(&mut self) {
        self.started = false;
    }

    /// Goes on by a frame to a target and to the velocity (a frame) that it has.
    pub fn step(&mut self, target: &BodyFrame, velocity: &BodyFrame) {
        let previous = self.body;
        self.body = *target;
        if self.started {
            let mut near = *target;
            for joint in 0..FEATURE_COUNT / 3 {
                let at = 3 * joint;
                let reference = Vec3::from_slice(&previous[at..at + 3]);
                let turn = Quat::from_scaled_axis(Vec3::from_slice(&target[at..at + 3]));
                near[at..at + 3].copy_from_slice(&log_map_near(turn, reference).to_array());
            }
            for n in 0..BLENDED {
                let foreseen = previous[n] + self.velocity[n];
                self.body[n] = foreseen + self.gain * (near[n] - foreseen);
            }
        }
        self.velocity = *velocity;
        self.started = true;
    }

    /// Returns true once there is a body.
    pub const fn started(&self) -> bool {
        self.started
    }

    /// The body, `frames` after the last step: a fraction, as it goes on from there.
    pub fn body_after(&self, frames: f32) -> BodyFrame {
        let mut body = self.body;
        for n in 0..BLENDED {
            body[n] += frames * self.velocity[n];
        }
        body
    }
}
