//! Response: how quickly hips come to a speed, lose it and turn it round.
//!
//! Hips surge with every step and markers tremble, so speeds are those of the hips' way over the ground below [`CUT_OFF_HZ`]. A manoeuvre lasts from the
//! share [`REACHED`] of the speed before it to the same share of the speed after it, and from [`STANDING_MPS`] where one of the two is standing. The same
//! measure finds manoeuvres in captured takes ([`Travel::manoeuvres`]) and times those that a walker was asked for ([`Travel::secs_to`]).

use footfall_core::{Clip, Pose};
use footfall_imu::filter::low_pass;
use glam::Vec2;

/// Faster changes of the hips' way do not count, Hz.
pub const CUT_OFF_HZ: f64 = 4.0;

/// Share of a speed at which it counts as reached, and below which as left.
pub const REACHED: f32 = 0.8;

/// Hips slower than this stand, m/s.
pub const STANDING_MPS: f32 = 0.15;

/// Time within which the highest speed is that of a manoeuvre, seconds.
const SPEED_WITHIN_SECS: f64 = 1.5;

/// Slower travel is no manoeuvre: people shift their weight, m/s.
const LEAST_SPEED_MPS: f32 = 0.6;

/// Ways that part by more than this are a reversal, as the cosine of the angle.
const REVERSED_COS: f32 = -0.7;

/// Half the length of a turn, seconds: the walker goes one way this long before the slowest moment and the other way this long after it.
const TURNING_SECS: f64 = 0.6;

/// Time of standing in between that separates a stop from a start, seconds.
const LONGEST_PAUSE_SECS: f64 = 0.25;

/// Motion of the hips.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ManoeuvreKind {
    /// From standing to a speed.
    Start,
    /// From a speed to standing.
    Stop,
    /// From one way to the opposite one.
    Reversal,
}

/// A change of the way that hips take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Manoeuvre {
    /// Kind of change.
    pub kind: ManoeuvreKind,
    /// When it begins, seconds from the first frame.
    pub begin_secs: f64,
    /// Duration, seconds.
    pub secs: f64,
    /// The speed that is reached or left, m/s; in a reversal the lower of both.
    pub speed_mps: f32,
}

/// The hips' way over the ground, without what is faster than [`CUT_OFF_HZ`].
#[derive(Clone, Debug, PartialEq)]
pub struct Travel {
    rate_hz: f64,
    /// Velocity in every frame, m/s, x and z.
    velocities: Vec<Vec2>,
}

impl Travel {
    /// The way of a clip's hips from frame `first` on.
    pub fn of(clip: &Clip, first: usize) -> Self {
        let poses = clip.poses.get(first..).unwrap_or_default();
        Self::of_poses(poses, clip.frame_rate_hz)
    }

    /// Path of the hips in poses at a frame rate.
    pub fn of_poses(poses: &[Pose], rate_hz: f64) -> Self {
        let places: Vec<_> = poses.iter().map(|pose| pose.root_position).collect();
        let places = low_pass(&places, rate_hz, CUT_OFF_HZ);
        let at = |frame: usize| Vec2::new(places[frame].x, places[frame].z);
        let last = places.len().saturating_sub(1);
        let velocity = |frame: usize| {
            let (before, after) = (frame.saturating_sub(1), (frame + 1).min(last));
            (at(after) - at(before)) * (rate_hz as f32 / (after - before).max(1) as f32)
        };
        Self {
            rate_hz,
            velocities: (0..places.len()).map(velocity).collect(),
        }
    }

    /// Seconds from a moment until the travel along `velocity_mps` first is the share [`REACHED`] of it, or until the hips stand where that is zero.
    /// `None` when that never happens.
    pub fn secs_to(&self, from_secs: f64, velocity_mps: Vec2) -> Option<f64> {
        let first = (from_secs * self.rate_hz).round() as usize;
        let wanted = velocity_mps.length();
        let way = velocity_mps.normalize_or_zero();
        let there = |velocity: &Vec2| {
            if wanted == 0.0 {
                velocity.length() < STANDING_MPS
            } else {
                velocity.dot(way) >= REACHED * wanted
            }
        };
        let passed = self.velocities.get(first..)?.iter().position(there)?;
        Some(passed as f64 / self.rate_hz)
    }

    /// The speed over the ground a time after the first frame, m/s.
    pub fn speed_at(&self, secs: f64) -> Option<f32> {
        let frame = (secs * self.rate_hz).round() as usize;
        self.velocities.get(frame).map(|velocity| velocity.length())
    }

    /// Starts, stops and reversals, in the order of their beginnings.
    pub fn manoeuvres(&self) -> Vec<Manoeuvre> {
        let mut found = Vec::new();
        for (begin, end) in self.pauses() {
            let (stop, start) = (self.leaving(begin), self.reaching(end));
            let pause = (end - begin) as f64 / self.rate_hz;
            if pause <= LONGEST_PAUSE_SECS {
                found.extend(stop.zip(start).and_then(|pair| self.reversal(pair)));
                continue;
            }
            let of = |kind, from: usize, to: usize, speed_mps| Manoeuvre {
                kind,
                begin_secs: from as f64 / self.rate_hz,
                secs: (to - from) as f64 / self.rate_hz,
                speed_mps,
            };
            found.extend(stop.map(|(at, speed)| of(ManoeuvreKind::Stop, at, begin, speed)));
            found.extend(start.map(|(at, speed)| of(ManoeuvreKind::Start, end, at, speed)));
        }
        found
    }

    fn reversal(
        &self,
        ((from, before), (to, after)): ((usize, f32), (usize, f32)),
    ) -> Option<Manoeuvre> {
        let [left, reached] = [from, to].map(|frame| self.velocities[frame].normalize_or_zero());
        (left.dot(reached) < REVERSED_COS).then(|| Manoeuvre {
            kind: ManoeuvreKind::Reversal,
            begin_secs: from as f64 / self.rate_hz,
            secs: (to - from) as f64 / self.rate_hz,
            speed_mps: before.min(after),
        })
    }

    /// Stretches in which hips are slow, as the first frame of each and that after its last. Who turns round may pass through no frame of standing:
    /// there the slowest frame counts.
    fn pauses(&self) -> Vec<(usize, usize)> {
        let slow = |frame: usize| self.velocities[frame].length() < STANDING_MPS;
        let mut pauses = Vec::new();
        let mut frame = 0;
        while frame < self.velocities.len() {
            let begin = frame;
            while frame < self.velocities.len() && slow(frame) {
                frame += 1;
            }
            if frame > begin {
                pauses.push((begin, frame.min(self.velocities.len() - 1)));
            } else if self.turns_round(frame) {
                pauses.push((frame, frame));
            }
            frame += 1;
        }
        pauses
    }

    /// Returns true when hips go the other way after this frame, which is the slowest around.
    fn turns_round(&self, frame: usize) -> bool {
        let around = (TURNING_SECS * self.rate_hz) as usize;
        let (Some(first), last) = (frame.checked_sub(around), frame + around) else {
            return false;
        };
        let Some(near) = self.velocities.get(first..=last) else {
            return false;
        };
        let speed = self.velocities[frame].length();
        let slowest = near.iter().all(|velocity| velocity.length() >= speed);
        let [before, after] = [near[0], near[near.len() - 1]].map(Vec2::normalize_or_zero);
        slowest && before.dot(after) < REVERSED_COS
    }

    /// The first frame after `from` that has reached the speed to come, and that speed.
    fn reaching(&self, from: usize) -> Option<(usize, f32)> {
        let within = (SPEED_WITHIN_SECS * self.rate_hz) as usize;
        let ahead = self.velocities.get(from..)?;
        let ahead = ahead.iter().take(within).map(|velocity| velocity.length());
        let (at, speed) = reached(ahead)?;
        Some((from + at, speed))
    }

    /// The last frame before `to` that still has the speed before, and that speed.
    fn leaving(&self, to: usize) -> Option<(usize, f32)> {
        let within = (SPEED_WITHIN_SECS * self.rate_hz) as usize;
        let back = self.velocities.get(..=to)?.iter().rev();
        let back = back.take(within).map(|velocity| velocity.length());
        let (at, speed) = reached(back)?;
        Some((to - at, speed))
    }
}

/// The first of some speeds that is the share [`REACHED`] of their highest, and that one. Where they fall below standing again, what follows is something else.
fn reached(speeds: impl Iterator<Item = f32>) -> Option<(usize, f32)> {
    let mut moved = false;
    let speeds: Vec<f32> = speeds
        .take_while(|speed| {
            moved |= *speed > 2.0 * STANDING_MPS;
            !moved || *speed > STANDING_MPS
        })
        .collect();
    let highest = speeds.iter().copied().fold(0.0, f32::max);
    let first = speeds
        .iter()
        .position(|speed| *speed >= REACHED * highest)?;
    (highest >= LEAST_SPEED_MPS).then_some((first, highest))
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    const RATE_HZ: f64 = 60.0;

    /// Hips whose speed is a function of the time, along +Z.
    fn travel(speed: impl Fn(f64) -> f32, secs: f64) -> Travel {
        let mut place = 0.0;
        let poses: Vec<Pose> = (0..(secs * RATE_HZ) as usize)
            .map(|frame| {
                place += speed(frame as f64 / RATE_HZ) / RATE_HZ as f32;
                Pose {
                    root_position: Vec3::new(0.0, 0.9, place),
                    ..Pose::default()
                }
            })
            .collect();
        Travel::of_poses(&poses, RATE_HZ)
    }

    fn ramp(time: f64, begin: f64, secs: f64) -> f32 {
        ((time - begin) / secs).clamp(0.0, 1.0) as f32
    }

    #[test]
    fn starts_stops_and_reversals_last_as_long_as_their_ramps() {
        // 2 m/s within a second from 2 s on, back through 0 from 5 to 7 s, to standing from 10 to 11 s.
        let speed = |time: f64| {
            2.0 * ramp(time, 2.0, 1.0) - 4.0 * ramp(time, 5.0, 2.0) + 2.0 * ramp(time, 10.0, 1.0)
        };
        let travel = travel(speed, 14.0);
        let found = travel.manoeuvres();
        let kinds: Vec<_> = found.iter().map(|found| found.kind).collect();
        assert_eq!(
            kinds,
            [
                ManoeuvreKind::Start,
                ManoeuvreKind::Reversal,
                ManoeuvreKind::Stop
            ]
        );
        let expected = [0.8 - 0.075, 1.6, 0.8 - 0.075];
        for (found, expected) in found.iter().zip(expected) {
            assert!(
                (found.secs - expected).abs() < 0.06,
                "{found:?} for {expected} s"
            );
            assert!((found.speed_mps - 2.0).abs() < 0.05, "{found:?}");
        }
        let asked = travel.secs_to(2.0, Vec2::new(0.0, 2.0));
        assert!(
            asked.is_some_and(|secs| (secs - 0.8).abs() < 0.05),
            "{asked:?}"
        );
        assert_eq!(travel.secs_to(2.0, Vec2::new(2.0, 0.0)), None);
    }

    #[test]
    fn a_surge_of_every_step_is_no_manoeuvre() {
        let travel = travel(|time| 1.2 + 0.15 * (12.0 * time).sin() as f32, 10.0);
        assert_eq!(travel.manoeuvres(), []);
        assert!(
            travel
                .speed_at(4.0)
                .is_some_and(|speed| (0.9..1.5).contains(&speed))
        );
    }
}
