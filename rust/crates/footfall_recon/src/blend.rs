//! Continuity where the tracker changes to other segments (Mousas 2017, section 6).

use crate::body::{BodyFrame, Course};
use footfall_core::ease::smooth_step;
use footfall_core::rotation::log_map_near;
use footfall_model::FEATURE_COUNT;
use footfall_model::imu_model::{BODY_COUNT, HEIGHT};
use glam::{Quat, Vec3};

/// Numbers that are blended: joints and height. The others are rates and probabilities.
const BLENDED: usize = HEIGHT + 1;

/// Courses are near each other where their joints are turned by less than the first of these against each other, and far from the second on; root mean square
/// over the numbers of all joints, radians.
const PARTED: [f32; 2] = [0.08, 0.16];

/// Far courses count as far with this time constant, seconds.
const PARTED_SECS: f32 = 0.2;

/// Time after the beginning for which any transition counts as a near one, seconds: the body shown first is a guess.
const BEGINNING_SECS: f32 = 0.5;

/// Transition of the body between segments of the recordings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Blending {
    /// Immediate.
    Off,
    /// As published (after Levine et al.): the body moves at the recordings' velocity and is drawn to their pose.
    Velocity {
        /// Share of the way to the target per frame.
        gain: f32,
    },
    /// Offsets in place and in velocity decay as in a critically damped spring (inertialization, after Bollo 2018).
    Inertial {
        /// Rates of the spring, 1/s: where the two are near each other, and where they are far apart.
        rates: [f32; 2],
    },
}

/// The shown body.
#[derive(Clone, Copy, Debug)]
pub struct Blend {
    blending: Blending,
    frame_secs: f32,
    target: Course,
    /// The body that is shown less the target, and how that changes in a frame.
    offset: BodyFrame,
    drift: BodyFrame,
    /// Distance at which courses parted lately, between [`PARTED`]: 0 to 1.
    parted: f32,
    /// Time since the first frame, seconds.
    shown_secs: f32,
    started: bool,
}

impl Blend {
    /// Creates it for a frame rate.
    pub const fn new(blending: Blending, frame_rate_hz: f32) -> Self {
        Self {
            blending,
            frame_secs: 1.0 / frame_rate_hz,
            target: Course::REST,
            offset: [0.0; BODY_COUNT],
            drift: [0.0; BODY_COUNT],
            parted: 0.0,
            shown_secs: 0.0,
            started: false,
        }
    }

    /// Forgets the body.
    pub const fn reset(&mut self) {
        self.started = false;
    }

    /// Goes on by a frame to a course.
    pub fn step(&mut self, target: &Course) {
        let previous = self.target;
        self.target = *target;
        if !self.started {
            (self.offset, self.drift) = ([0.0; BODY_COUNT], [0.0; BODY_COUNT]);
            (self.parted, self.shown_secs) = (0.0, 0.0);
            self.started = true;
            return;
        }
        let foreseen = |n: usize| previous.body[n] + previous.velocity[n];
        for joint in 0..FEATURE_COUNT / 3 {
            let at = 3 * joint;
            let reference = Vec3::from_array([at, at + 1, at + 2].map(foreseen));
            let turn = Quat::from_scaled_axis(Vec3::from_slice(&target.body[at..at + 3]));
            let near = log_map_near(turn, reference).to_array();
            self.target.body[at..at + 3].copy_from_slice(&near);
        }
        let squares = (0..FEATURE_COUNT).map(|n| (foreseen(n) - self.target.body[n]).powi(2));
        let apart = (squares.sum::<f32>() / FEATURE_COUNT as f32).sqrt();
        self.shown_secs += self.frame_secs;
        let parted = if self.shown_secs < BEGINNING_SECS {
            0.0
        } else {
            smooth_step((apart - PARTED[0]) / (PARTED[1] - PARTED[0]))
        };
        self.parted = parted.max(self.parted * (-self.frame_secs / PARTED_SECS).exp());
        // Where the courses part, the body that is shown goes on.
        for n in 0..BLENDED {
            (self.offset[n], self.drift[n]) = self.after(n, 1.0);
            self.offset[n] += foreseen(n) - self.target.body[n];
            match self.blending {
                Blending::Off => self.offset[n] = 0.0,
                Blending::Velocity { gain } => self.offset[n] *= 1.0 - gain,
                Blending::Inertial { .. } => {
                    self.drift[n] += previous.velocity[n] - self.target.arrival[n];
                }
            }
        }
    }

    /// Offset and drift of a number, `frames` after the last step.
    fn after(&self, n: usize, frames: f32) -> (f32, f32) {
        let (offset, drift) = (self.offset[n], self.drift[n]);
        let Blending::Inertial { rates: [near, far] } = self.blending else {
            return (offset, 0.0);
        };
        let damping = (near + (far - near) * self.parted) * self.frame_secs;
        let toward = drift + damping * offset;
        let left = (-damping * frames).exp();
        (
            left * (offset + toward * frames),
            left * (drift - damping * toward * frames),
        )
    }

    /// Returns true once there is a body.
    pub const fn started(&self) -> bool {
        self.started
    }

    /// The body, `frames` after the last step: a fraction, as it goes on from there.
    pub fn body_after(&self, frames: f32) -> BodyFrame {
        let mut body = self.target.body;
        for n in 0..BLENDED {
            body[n] += frames * self.target.velocity[n] + self.after(n, frames.max(0.0)).0;
        }
        body
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RATE_HZ: f32 = 30.0;

    /// Heights that are shown while a body that rises goes over to one that sinks, 0.3 m lower.
    fn shown(blending: Blending) -> Vec<f32> {
        let mut blend = Blend::new(blending, RATE_HZ);
        let course = |height: f32, change: f32| {
            let mut course = Course::REST;
            course.body[HEIGHT] = height;
            (course.arrival[HEIGHT], course.velocity[HEIGHT]) = (change, change);
            course
        };
        let rising = (0..10).map(|n| course(1.0 + 0.01 * n as f32, 0.01));
        let sinking = (0..40).map(|n| course(0.8 - 0.01 * n as f32, -0.01));
        let heights = rising.chain(sinking).map(|course| {
            blend.step(&course);
            blend.body_after(0.0)[HEIGHT]
        });
        heights.collect()
    }

    fn greatest_jerk(heights: &[f32]) -> f32 {
        let second = heights.windows(3).map(|h| (h[0] - 2.0 * h[1] + h[2]).abs());
        second.fold(0.0, f32::max)
    }

    #[test]
    fn a_change_of_course_is_no_jump() {
        let off = shown(Blending::Off);
        let velocity = shown(Blending::Velocity { gain: 0.6 });
        let inertial = shown(Blending::Inertial { rates: [10.0; 2] });
        assert!((greatest_jerk(&off) - 0.3).abs() < 1e-4);
        assert!(greatest_jerk(&velocity) < 0.7 * greatest_jerk(&off));
        assert!(greatest_jerk(&inertial) < 0.15 * greatest_jerk(&off));
        // In the end all are the course.
        for heights in [&off, &velocity, &inertial] {
            assert!((heights[49] - 0.41).abs() < 1e-3, "{}", heights[49]);
        }
    }

    #[test]
    fn far_courses_are_gone_over_to_more_slowly() {
        let half_way = |turn: f32| {
            let mut blend = Blend::new(
                Blending::Inertial {
                    rates: [50.0, 10.0],
                },
                RATE_HZ,
            );
            let turned = Course {
                body: [turn; BODY_COUNT],
                ..Course::REST
            };
            for _ in 0..30 {
                blend.step(&Course::REST);
            }
            let frames = 1..40;
            frames
                .take_while(|_| {
                    blend.step(&turned);
                    blend.body_after(0.0)[HEIGHT] < 0.5 * turn
                })
                .count()
        };
        assert!(half_way(0.01) <= 2, "{} frames", half_way(0.01));
        let far = half_way(0.5);
        assert!((3..8).contains(&far), "{far} frames");
    }

    #[test]
    fn one_course_is_shown_as_it_is() {
        let inertial = shown(Blending::Inertial { rates: [10.0; 2] });
        for (n, height) in inertial[..10].iter().enumerate() {
            assert!((height - 1.0 - 0.01 * n as f32).abs() < 1e-5);
        }
    }
}
