//! Levels at which the points of a sole rest.

use super::signals::velocities;
use glam::Vec3;

/// Stances within this time are those that a point's level is taken from, seconds.
const NEAR_SECS: f32 = 0.6;

/// A foot stands where one of its points rests no more than this above that point's level in the clip, metres.
const MOST_ABOVE_GROUND_M: f32 = 0.015;

/// Levels are at most this far from the ground, and from those of the clip, metres.
const MOST_FROM_GROUND_M: f32 = 0.05;

/// Heights at which the points of a foot rest, metres, frame by frame.
pub(super) struct Levels {
    pub(super) points: [Vec<f32>; 3],
}

impl Levels {
    /// Levels of heel, ball and toe tip: those of the stances nearby where the foot stands, else those of the whole clip.
    ///
    /// The lie of a sole is known for the clip as a whole. After long standing and a short walk it is that of standing, and the
    /// ball may pass over the ground at three centimetres in every stance of the walk.
    pub(super) fn of(tracks: &[Vec<Vec3>; 3], rate: f32, size: f32) -> Self {
        let points = tracks.each_ref().map(|track| Point::of(track, rate, size));
        let frames = tracks[0].len();
        let reach = (NEAR_SECS * rate).round() as usize;
        let mut levels = points.each_ref().map(|point| vec![point.level; frames]);
        for frame in 0..frames {
            let window = frame.saturating_sub(reach)..(frame + reach + 1).min(frames);
            let resting = points.each_ref().map(|point| point.rests(window.clone()));
            let above = points
                .iter()
                .zip(resting)
                .filter_map(|(point, resting)| resting.map(|height| height - point.level));
            if above.fold(f32::INFINITY, f32::min) > MOST_ABOVE_GROUND_M * size {
                continue;
            }
            for ((levels, point), resting) in levels.iter_mut().zip(&points).zip(resting) {
                if let Some(height) = resting {
                    let most = MOST_FROM_GROUND_M * size;
                    levels[frame] = height.clamp(point.level - most, point.level + most);
                }
            }
        }
        Self { points: levels }
    }
}

/// One point over time.
struct Point {
    /// Heights where the point is slow, else nothing.
    slow: Vec<Option<f32>>,
    /// Level at which it rests in the clip as a whole.
    level: f32,
}

impl Point {
    fn of(track: &[Vec3], rate: f32, size: f32) -> Self {
        let speeds: Vec<f32> = velocities(track, rate).map(Vec3::length).collect();
        let mut sorted = speeds.clone();
        sorted.sort_by(f32::total_cmp);
        let limit = sorted
            .get(sorted.len() / 8)
            .map_or(0.3 * size, |slow| (1.5 * slow).clamp(0.25 * size, size));
        let slow: Vec<Option<f32>> = track
            .iter()
            .zip(&speeds)
            .map(|(point, speed)| (*speed <= limit).then_some(point.y))
            .collect();
        let level = clip_level(slow.iter().flatten().copied().collect(), size);
        Self { slow, level }
    }

    /// The median height of the slow frames among these.
    fn rests(&self, frames: core::ops::Range<usize>) -> Option<f32> {
        let mut heights: Vec<f32> = self.slow[frames].iter().flatten().copied().collect();
        let middle = heights.len() / 2;
        (!heights.is_empty()).then(|| *heights.select_nth_unstable_by(middle, f32::total_cmp).1)
    }
}

/// The height at which a point rests: the median of these without those in the air.
fn clip_level(mut heights: Vec<f32>, size: f32) -> f32 {
    heights.sort_by(f32::total_cmp);
    let Some(&low) = heights.get(heights.len() / 10) else {
        return 0.0;
    };
    heights.retain(|height| *height <= low + 0.04 * size);
    // A point that never comes near the ground of the clip rests on the ground, not in the air.
    let most = MOST_FROM_GROUND_M * size;
    heights[heights.len() / 2].clamp(-most, most)
}
