//! Height and speed of the points on which a foot can stand.

use super::levels::Levels;
use crate::figure::sole_points;
use footfall_core::{Clip, ModelPose, Side, forward_kinematics};
use glam::Vec3;

/// Leg of the canonical body, metres. Heights and speeds of other bodies are as much greater or less as their legs are longer or shorter.
const CANONICAL_LEG_M: f32 = 0.84;

/// A foot that swings at less than this, metres a second on the canonical body, does not swing.
const LEAST_SWING_SPEED: f32 = 1.5;

/// A stance begins and ends within this time of the fastest moment of a swing, seconds.
const SWING_REACH_SECS: f32 = 0.5;

/// A swing keeps its speed for this long, seconds; what is shorter is a glitch of capture.
const SWING_PEAK_SECS: f32 = 0.05;

/// Speed of a swing, from its fastest moment: what a tenth of the frames of a steady walk exceed.
const SWING_SHARE: f32 = 0.93;

/// Size of a clip's body: 1 for the canonical one.
pub(crate) fn body_size(clip: &Clip) -> f32 {
    (clip.skeleton.mean_leg_length() / CANONICAL_LEG_M).max(f32::MIN_POSITIVE)
}

/// One point over time.
#[derive(Clone, Debug)]
pub(super) struct PointSignal {
    /// Above its own resting level, metres.
    pub(super) height: Vec<f32>,
    /// Metres a second, over about 33 ms around the frame.
    pub(super) speed: Vec<f32>,
    /// Metres a second before or after the frame, whichever is less: small from the frame on in which a point comes to rest.
    pub(super) settling: Vec<f32>,
}

/// One foot over time, from the first frame of the motion on.
#[derive(Clone, Debug)]
pub(super) struct FootSignals {
    pub(super) heel: PointSignal,
    /// Ball or toe tip, whichever can bear: the lower height, and of forward and upward speed the lesser each.
    pub(super) toe: PointSignal,
}

impl FootSignals {
    pub(super) fn of(clip: &Clip, side: Side, first_frame: usize) -> Self {
        let mut model = ModelPose::default();
        let mut points: [Vec<Vec3>; 3] = Default::default();
        for pose in clip.poses.iter().skip(first_frame) {
            forward_kinematics(&clip.skeleton, pose, &mut model);
            for (track, point) in points
                .iter_mut()
                .zip(sole_points(&clip.skeleton, &model, side))
            {
                track.push(point);
            }
        }
        let rate = clip.frame_rate_hz as f32;
        let size = body_size(clip);
        let toe_speed = forefoot_speeds(&points[1], &points[2], rate);
        let levels = Levels::of(&points, rate, size);
        let [heel, ball, tip] =
            [0, 1, 2].map(|n| point_signal(&points[n], &levels.points[n], rate));
        let lesser = |a: &[f32], b: &[f32]| a.iter().zip(b).map(|(a, b)| a.min(*b)).collect();
        Self {
            heel,
            toe: PointSignal {
                height: lesser(&ball.height, &tip.height),
                speed: toe_speed,
                settling: lesser(&ball.settling, &tip.settling),
            },
        }
    }
}

/// Speed at which feet swing around each frame, metres a second: the fastest swing of either heel nearby.
///
/// Speed of the swings nearby, since a clip may hold standing, walking and running. Of either foot, since both swing alike, and at the ends
/// of a clip one of them may lack a swing.
pub(super) fn swing_speeds(heels: [&PointSignal; 2], rate: f32, size: f32) -> Vec<f32> {
    let frames = |secs: f32| (secs * rate).round() as usize;
    let [left, right] = heels.map(|heel| sustained(&heel.speed, frames(0.5 * SWING_PEAK_SECS)));
    let faster: Vec<f32> = left.iter().zip(&right).map(|(a, b)| a.max(*b)).collect();
    extremes(&faster, frames(SWING_REACH_SECS), f32::max)
        .into_iter()
        .map(|fastest| (SWING_SHARE * fastest).max(LEAST_SWING_SPEED * size))
        .collect()
}

/// Level that a signal keeps for longer than `reach` frames before and after some moment nearby.
fn sustained(values: &[f32], reach: usize) -> Vec<f32> {
    extremes(&extremes(values, reach, f32::min), reach, f32::max)
}

/// Moving maximum or minimum over this many values on both sides.
fn extremes(values: &[f32], reach: usize, better: fn(f32, f32) -> f32) -> Vec<f32> {
    (0..values.len())
        .map(|at| {
            let window = at.saturating_sub(reach)..=(at + reach).min(values.len() - 1);
            values[window].iter().copied().fold(values[at], better)
        })
        .collect()
}

/// Speed at which the front of a foot leaves its place: the lesser forward speed and the lesser upward speed of ball and toe tip.
///
/// While a foot rolls over its toes the ball rises and the tip stays down, and neither goes forward. In bodies whose toes do not bend as
/// the person's did, the tip slides back meanwhile as fast as the ball rises: the speed of either is no sign that the foot has lifted.
fn forefoot_speeds(ball: &[Vec3], tip: &[Vec3], rate: f32) -> Vec<f32> {
    velocities(ball, rate)
        .zip(velocities(tip, rate))
        .map(|(ball, tip)| {
            let along = |velocity: Vec3| velocity.with_y(0.0).length();
            let upward = ball.y.abs().min(tip.y.abs());
            along(ball).min(along(tip)).hypot(upward)
        })
        .collect()
}

fn point_signal(track: &[Vec3], levels: &[f32], rate: f32) -> PointSignal {
    let above = |(point, level): (&Vec3, &f32)| point.y - level;
    PointSignal {
        height: track.iter().zip(levels).map(above).collect(),
        speed: velocities(track, rate).map(Vec3::length).collect(),
        settling: settling_speeds(track, rate),
    }
}

/// Velocity from some frames before to as many after each frame. At high rates over 33 ms, for one frame of noise is no speed.
pub(super) fn velocities(track: &[Vec3], rate: f32) -> impl Iterator<Item = Vec3> {
    let reach = reach(rate);
    let last = track.len().saturating_sub(1);
    (0..track.len()).map(move |frame| {
        let (from, to) = (frame.saturating_sub(reach), (frame + reach).min(last));
        (track[to] - track[from]) * rate / (to - from).max(1) as f32
    })
}

fn reach(rate: f32) -> usize {
    ((rate / 60.0).round() as usize).max(1)
}

/// The lesser of the speeds before and after each frame.
fn settling_speeds(track: &[Vec3], rate: f32) -> Vec<f32> {
    let reach = reach(rate);
    let speed = |from: usize, to: usize| track[to].distance(track[from]) * rate / reach as f32;
    (0..track.len())
        .map(|frame| {
            let before = frame.checked_sub(reach).map(|from| speed(from, frame));
            let to = frame + reach;
            let after = (to < track.len()).then(|| speed(frame, to));
            match (before, after) {
                (Some(before), Some(after)) => before.min(after),
                (before, after) => before.or(after).unwrap_or(0.0),
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A track that moves by `step` a frame.
    fn track(step: Vec3) -> Vec<Vec3> {
        (0..20).map(|frame| step * frame as f32).collect()
    }

    #[test]
    fn a_foot_that_rolls_over_sliding_toes_has_not_left_its_place() {
        // At 60 frames a second: the ball rises at 1.2 m/s while the tip slides back as fast.
        let rises = track(Vec3::new(0.0, 0.02, 0.0));
        let slides = track(Vec3::new(0.0, 0.0, -0.02));
        let rolls = forefoot_speeds(&rises, &slides, 60.0);
        assert!(rolls.iter().all(|speed| *speed < 1e-3), "{rolls:?}");
        // What goes forward, or rises as a whole, has.
        let forward = track(Vec3::new(0.0, 0.01, 0.02));
        for (ball, tip, speed) in [(&forward, &slides, 1.2), (&rises, &rises, 1.2)] {
            let leaves = forefoot_speeds(ball, tip, 60.0);
            assert!((leaves[10] - speed).abs() < 1e-3, "{leaves:?}");
        }
    }

    #[test]
    fn one_frame_of_noise_is_no_swing() {
        let signal = |speed: Vec<f32>| PointSignal {
            height: vec![0.0; speed.len()],
            settling: speed.clone(),
            speed,
        };
        let mut swings: Vec<f32> = (0..240)
            .map(|frame| 3.0 * (0.05 * frame as f32).sin().abs())
            .collect();
        let clean = signal(swings.clone());
        swings[100] = 40.0;
        let noisy = signal(swings);
        let still = signal(vec![0.0; 240]);
        let of = |left: &PointSignal| swing_speeds([left, &still], 120.0, 1.0);
        let (clean, noisy) = (of(&clean), of(&noisy));
        for (clean, noisy) in clean.iter().zip(&noisy) {
            assert!((clean - noisy).abs() < 0.15, "{clean} {noisy}");
        }
        assert!((2.5..3.0).contains(&clean[120]), "{}", clean[120]);
    }
}
