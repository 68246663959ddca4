//! Strides of a foot that wears a sensor, as its samples come: what [`strides`](crate::strides) measures in a recording as a whole.
//!
//! From rest to rest velocity is integrated; what is left of it at the end is taken off in proportion to time, which follows from the sums: nothing
//! is kept of the samples. Where a wrong level adds the same acceleration throughout, it goes with that.

use crate::sample::{GRAVITY_MPS2, ImuSample};
use crate::strides::SensorStride;
use footfall_core::rotation::{exp_map, shortest_arc};
use glam::{Quat, Vec3};

/// Motion and force are averaged over about this time, seconds.
const MEAN_SECS: f32 = 0.05;

/// A foot comes to rest below the first and leaves it above the second: squared rad/s, and squared deviation of the specific force from gravity.
const REST: [f32; 2] = [1.0, 4.0];

/// Time after a foot has come to rest within which the quietest moment is searched for, seconds.
const SETTLE_SECS: f64 = 0.3;

/// A gyroscope's bias is what it reads while the foot moves less than this, and follows it with this time constant, seconds.
const STILL: f32 = 0.02;
const BIAS_SECS: f32 = 1.0;

/// A stride is no longer than this, seconds.
const LONGEST_SECS: f64 = 3.0;

/// After a gap of this length nothing is known of where the foot is, seconds.
const LONGEST_GAP_SECS: f64 = 0.1;

/// A foot that has come to rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rest {
    /// The stride that brought it there; `None` when it did not rest before, or too long ago to be known.
    pub stride: Option<SensorStride>,
}

/// Measures the strides of a sensor in any orientation on a foot. Does not allocate.
#[derive(Clone, Copy, Debug, Default)]
pub struct StrideMeter {
    last: Option<ImuSample>,
    motion: f32,
    force: Vec3,
    bias: Vec3,
    /// Since the rest before this one, and since the quietest moment of this one.
    since: Option<Integral>,
    mark: Option<Integral>,
    state: State,
}

/// Part of its cycle that a foot is in.
#[derive(Clone, Copy, Debug, Default)]
enum State {
    #[default]
    Moving,
    /// At rest since a time; how quiet the quietest moment was, and the stride that ended there.
    Settling(f64, f32, Option<SensorStride>),
    /// At rest, and reported.
    Resting,
}

impl StrideMeter {
    /// Adds a sample; returns a rest once it is over or has lasted a moment. Samples that are not finite or late are ignored.
    pub fn push(&mut self, sample: ImuSample) -> Option<Rest> {
        if !sample.is_finite() {
            return None;
        }
        let Some(last) = self.last else {
            self.begin(sample);
            return None;
        };
        let dt_secs = sample.time_secs - last.time_secs;
        if dt_secs <= 0.0 {
            return None;
        }
        if dt_secs > LONGEST_GAP_SECS {
            self.begin(sample);
            return None;
        }
        let dt = dt_secs as f32;
        let share = 1.0 - (-dt / MEAN_SECS).exp();
        let off = sample.force.length() / GRAVITY_MPS2 - 1.0;
        let own = (sample.rate - self.bias).length_squared() + 4.0 * off * off;
        self.motion += share * (own - self.motion);
        self.force += share * (sample.force - self.force);
        let rate = 0.5 * (last.rate + sample.rate) - self.bias;
        for integral in [&mut self.since, &mut self.mark].into_iter().flatten() {
            integral.step(rate, [last.force, sample.force], dt);
        }
        if self.motion < STILL {
            self.bias += (sample.rate - self.bias) * (dt / BIAS_SECS).min(1.0);
        }
        self.last = Some(sample);
        self.settle(sample.time_secs)
    }

    fn begin(&mut self, sample: ImuSample) {
        *self = Self {
            last: Some(sample),
            motion: REST[1],
            force: sample.force,
            bias: self.bias,
            ..Self::default()
        };
    }

    fn settle(&mut self, now: f64) -> Option<Rest> {
        match self.state {
            State::Moving => {
                if self.motion < REST[0] {
                    self.state = State::Settling(now, f32::INFINITY, None);
                }
                None
            }
            State::Settling(begun, quietest, stride) => {
                if self.motion > REST[1] || now - begun > SETTLE_SECS {
                    self.since = self.mark.take();
                    self.state = if self.motion > REST[1] {
                        State::Moving
                    } else {
                        State::Resting
                    };
                    return Some(Rest { stride });
                }
                if self.motion < quietest {
                    let stride = self.since.and_then(|since| since.stride(now));
                    self.state = State::Settling(begun, self.motion, stride);
                    self.mark = Some(Integral::new(now, self.force));
                }
                None
            }
            State::Resting => {
                if self.motion > REST[1] {
                    self.state = State::Moving;
                } else if self.motion < REST[0] {
                    self.since = Some(Integral::new(now, self.force));
                }
                None
            }
        }
    }
}

/// Velocity and way since a rest.
#[derive(Clone, Copy, Debug)]
struct Integral {
    start_secs: f64,
    secs: f32,
    /// `level_from_sensor`, as integrated from the gyroscope.
    turn: Quat,
    gravity_mps2: f32,
    velocity: Vec3,
    way: Vec3,
}

impl Integral {
    fn new(start_secs: f64, force: Vec3) -> Self {
        Self {
            start_secs,
            secs: 0.0,
            turn: shortest_arc(force.normalize_or(Vec3::Y), Vec3::Y),
            // What the sensor reads for gravity at rest, not what gravity is.
            gravity_mps2: force.length(),
            velocity: Vec3::ZERO,
            way: Vec3::ZERO,
        }
    }

    fn step(&mut self, rate: Vec3, forces: [Vec3; 2], dt: f32) {
        let before = self.turn * forces[0];
        self.turn = (self.turn * exp_map(rate * dt)).normalize();
        let acceleration = 0.5 * (before + self.turn * forces[1]) - Vec3::Y * self.gravity_mps2;
        let velocity = self.velocity;
        self.velocity += acceleration * dt;
        self.way += 0.5 * (velocity + self.velocity) * dt;
        self.secs += dt;
    }

    /// The stride that ends now.
    fn stride(&self, now: f64) -> Option<SensorStride> {
        if now - self.start_secs > LONGEST_SECS {
            return None;
        }
        let way = self.way - 0.5 * self.secs * self.velocity;
        Some(SensorStride {
            start_secs: self.start_secs,
            end_secs: now,
            length_m: f64::from(way.with_y(0.0).length()),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f32::consts::TAU;

    /// Strides of a known length, a second each with 0.3 s of rest, of a foot that pitches and rises, with a biased gyroscope.
    fn strides(turn: Quat, length_m: f32, rate_hz: f32) -> Vec<SensorStride> {
        let mut meter = StrideMeter::default();
        let mut found = Vec::new();
        for n in 0..(8.0 * rate_hz) as usize {
            let time = n as f32 / rate_hz;
            let phase = if time < 1.0 {
                0.0
            } else {
                (((time - 1.0) % 1.0) / 0.7).min(1.0)
            };
            let moving = f32::from(u8::from((0.001..0.999).contains(&phase)));
            let forward = length_m * TAU * (TAU * phase).sin() / 0.49 * moving;
            let up = 0.05 * TAU * TAU * (TAU * phase).cos() / 0.49 * moving;
            let pitch = 0.5 * (1.0 - (TAU * phase).cos());
            let pitch_rate = 0.5 * TAU * (TAU * phase).sin() / 0.7;
            let force = Quat::from_rotation_x(-pitch) * Vec3::new(0.0, GRAVITY_MPS2 + up, forward);
            let rest = meter.push(ImuSample {
                time_secs: f64::from(time),
                force: turn * force,
                rate: turn * (Vec3::X * pitch_rate + Vec3::splat(0.01)),
            });
            found.extend(rest.and_then(|rest| rest.stride));
        }
        found
    }

    #[test]
    fn strides_of_known_length_are_measured_in_any_mounting_at_any_rate() {
        for (turn, length_m, rate_hz) in [
            (Vec3::ZERO, 1.3, 100.0),
            (Vec3::new(1.0, -2.0, 0.5), 0.8, 200.0),
            (Vec3::new(-0.4, 0.3, 2.5), 1.6, 60.0),
        ] {
            let found = strides(Quat::from_scaled_axis(turn), length_m, rate_hz);
            assert!((5..=7).contains(&found.len()), "{} strides", found.len());
            for stride in found {
                let off = stride.length_m / f64::from(length_m) - 1.0;
                assert!(off.abs() < 0.04, "{} m of {length_m}", stride.length_m);
            }
        }
    }

    #[test]
    fn a_gap_forgets_where_the_foot_was() {
        let mut meter = StrideMeter::default();
        let mut rests = Vec::new();
        for n in 0..300 {
            let time_secs = f64::from(n) * 0.01 + if n > 100 { 2.0 } else { 0.0 };
            let rest = meter.push(ImuSample {
                time_secs,
                force: Vec3::Y * GRAVITY_MPS2,
                rate: Vec3::ZERO,
            });
            rests.extend(rest);
        }
        assert_eq!(rests, [Rest { stride: None }; 2]);
        let broken = ImuSample {
            time_secs: 9.0,
            force: Vec3::NAN,
            rate: Vec3::ZERO,
        };
        assert_eq!(meter.push(broken), None);
    }
}
