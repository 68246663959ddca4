//! Running: steps whose end both feet spend in the air.
//!
//! Contacts that are read from feet overlook most of a slow run's flight, as shoes drag. Hips do not: who has no foot on the ground falls,
//! and walks never come near free fall.

use super::{Step, Walk};
use footfall_core::Clip;
use glam::Vec3;

/// Time on either side over which a parabola is fitted for the hips' acceleration, seconds.
const FIT_SECS: f64 = 0.033;
/// Share of the acceleration of gravity beyond which nothing bears the body. Fast walks of the corpora reach 0.5.
const FALLING_SHARE: f64 = 0.85;
const GRAVITY_MPS2: f64 = 9.81;
/// A fall that lasts shorter is noise.
const LEAST_FALL_SECS: f64 = 0.025;
/// A fall that ends longer before the landing is noise, too.
const LANDING_SECS: f64 = 0.06;
/// Longest flight of a run, as a share of a step; a longer one is a jump.
const LONGEST_FLIGHT_SHARE: f64 = 0.6;
/// Steps of one run are so alike in speed, as a share, and turn so slowly, radians a second.
const STEADY_SPEED_SHARE: f32 = 0.06;
const STEADY_TURN_RADPS: f32 = 0.25;

/// The parts of walks that are runs: at least two steps in a row with flight, at an even speed and nearly straight. The other foot is in the air as each begins,
/// whatever the contacts say.
pub fn running_parts(clip: &Clip, walks: &[Walk]) -> Vec<Walk> {
    let mut runs = Vec::new();
    for walk in walks {
        let mut steps: Vec<Step> = Vec::new();
        for step in &walk.steps {
            if step.take_off.is_none() {
                runs.push(core::mem::take(&mut steps));
                continue;
            }
            if !steps.last().is_none_or(|last| is_steady(clip, last, step)) {
                runs.push(core::mem::take(&mut steps));
            }
            steps.push(Step {
                other_terminal: None,
                ..*step
            });
        }
        runs.push(steps);
    }
    runs.retain(|steps| steps.len() >= 2);
    runs.into_iter().map(|steps| Walk { steps }).collect()
}

/// Returns true when a step goes on like the one before it.
fn is_steady(clip: &Clip, before: &Step, step: &Step) -> bool {
    let [last, now] = [before, step].map(|step| velocity(clip, step));
    let even = (now.length() - last.length()).abs() < STEADY_SPEED_SHARE * last.length();
    let secs = 0.5 * (step.end - before.first) as f32 / clip.frame_rate_hz as f32;
    even && now.angle_between(last) < STEADY_TURN_RADPS * secs
}

/// Mean velocity of the hips over the ground, m/s.
fn velocity(clip: &Clip, step: &Step) -> Vec3 {
    let place = |frame: usize| clip.poses[frame.min(clip.poses.len() - 1)].root_position;
    let way = (place(step.end) - place(step.first)).with_y(0.0);
    way * (clip.frame_rate_hz as f32 / step.frames() as f32)
}

/// The last frame before the body falls, if it does so until the step ends.
pub(super) fn take_off(clip: &Clip, first: usize, end: usize) -> Option<usize> {
    let rate = clip.frame_rate_hz;
    let reach = fit_reach(rate);
    let middle = first.midpoint(end);
    if middle < reach || end + reach >= clip.poses.len() {
        return None;
    }
    let falls = |frame: &usize| falls_freely(clip, *frame, reach);
    // The foot that lands brakes the fall a little before its initial contact is seen.
    let ends = (middle..=end).rev().find(falls)?;
    let begins = (middle..=ends).rev().take_while(falls).last()?;
    let until_landing = ((end - ends) as f64) < LANDING_SECS * rate;
    let long_enough = until_landing && (ends + 1 - begins) as f64 >= LEAST_FALL_SECS * rate;
    let no_jump = ((end - begins) as f64) < LONGEST_FLIGHT_SHARE * (end - first) as f64;
    (long_enough && no_jump).then(|| begins.saturating_sub(1).max(first + 1))
}

/// Frame by frame, true where nothing bears the body.
pub(crate) fn free_falls(clip: &Clip) -> Vec<bool> {
    let (frames, reach) = (clip.poses.len(), fit_reach(clip.frame_rate_hz));
    (0..frames)
        .map(|frame| {
            (reach..frames.saturating_sub(reach)).contains(&frame)
                && falls_freely(clip, frame, reach)
        })
        .collect()
}

fn fit_reach(frame_rate_hz: f64) -> usize {
    ((FIT_SECS * frame_rate_hz).round() as usize).max(1)
}

fn falls_freely(clip: &Clip, frame: usize, reach: usize) -> bool {
    vertical_acceleration(clip, frame, reach) < -FALLING_SHARE * GRAVITY_MPS2
}

/// Vertical acceleration of the hips, m/s²: twice the curvature of the parabola fitted by least squares to the heights of `reach` frames on either side.
fn vertical_acceleration(clip: &Clip, frame: usize, reach: usize) -> f64 {
    let count = (2 * reach + 1) as f64;
    let offsets = || (0..=2 * reach).map(|index| index as f64 - reach as f64);
    let mean_square = offsets().map(|x| x * x).sum::<f64>() / count;
    let (mut above, mut below) = (0.0, 0.0);
    for (index, x) in offsets().enumerate() {
        let weight = x * x - mean_square;
        let height = f64::from(clip.poses[frame + index - reach].root_position.y);
        above += weight * height;
        below += weight * weight;
    }
    2.0 * above / below * clip.frame_rate_hz * clip.frame_rate_hz
}

#[cfg(test)]
mod tests {
    use super::*;
    use footfall_core::{Pose, Skeleton};

    /// Hips that bounce: pushed up for `stance` seconds, in free fall for `flight`, over and over.
    fn bouncing(stance: f64, flight: f64, rate: f64) -> Clip {
        let period = stance + flight;
        // What pushes for a part of the time has to make up for the weight of all of it.
        let push = GRAVITY_MPS2 * flight / stance;
        let poses = (0..(4.0 * period * rate) as usize).map(|frame| {
            let t = (frame as f64 / rate) % period;
            let speed = -0.5 * GRAVITY_MPS2 * flight;
            let y = if t < stance {
                speed * t + 0.5 * push * t * t
            } else {
                let s = t - stance;
                speed * stance + 0.5 * push * stance * stance
                    - speed * s
                    - 0.5 * GRAVITY_MPS2 * s * s
            };
            Pose {
                root_position: Vec3::new(0.0, 0.9 + y as f32, 0.0),
                ..Pose::default()
            }
        });
        Clip {
            skeleton: Skeleton::standard(),
            frame_rate_hz: rate,
            poses: poses.collect(),
        }
    }

    #[test]
    fn a_fall_begins_where_nothing_bears_the_body_any_more() {
        for rate in [60.0, 120.0] {
            let clip = bouncing(0.25, 0.1, rate);
            let at = |secs: f64| (secs * rate).round() as usize;
            let found = take_off(&clip, at(0.35), at(0.7));
            let secs = found.map(|frame| frame as f64 / rate);
            assert!(
                secs.is_some_and(|secs| (secs - 0.6).abs() < 0.035),
                "{secs:?} at {rate} Hz"
            );
        }
    }

    #[test]
    fn who_never_falls_does_not_take_off() {
        let mut clip = bouncing(0.25, 0.1, 60.0);
        for pose in &mut clip.poses {
            // Half as strong a bounce is a walk's.
            pose.root_position.y = 0.9 + 0.5 * (pose.root_position.y - 0.9);
        }
        assert_eq!(take_off(&clip, 21, 42), None);
    }
}
