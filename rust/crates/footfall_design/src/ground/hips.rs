//! Hips of a styled walk: over the course, as high as the standing feet, and within reach of both.

use super::Ground;
use crate::chance::drift;
use crate::curve::{smoothed, stance_wave};
use footfall_core::{FrameSpan, Joint, ModelPose, Pose, Side};
use footfall_ik::{FootTarget, RockerFoot, foot_pitch, reach_height};

/// A standing leg is stretched to this share of its length at most: knees are bent by 7° then.
pub(super) const MOST_STRETCH: f32 = 0.998;

/// Standard deviation of the times over which the hips follow the heights of standing feet, seconds.
const FOLLOWING_SECS: f64 = 0.06;

/// The hips give way to a leg that is too short this long before and after, seconds.
const REACH_AHEAD_SECS: f64 = 0.1;

impl Ground<'_> {
    /// Places the hips as captured, over the new course.
    pub(super) fn place_hips(&self, poses: &mut [Pose]) {
        let pelvis = &self.sheet.pelvis;
        let heights: Vec<f32> = self
            .captured
            .poses
            .iter()
            .map(|pose| pose.root_position.y)
            .collect();
        let level = smoothed(&heights, 0.4 * self.timeline.stride_frames);
        let squares = heights.iter().zip(&level).map(|(y, m)| (y - m).powi(2));
        // Of a sine of this deviation, the height over its mean.
        let top = (2.0 * squares.sum::<f32>() / heights.len() as f32).sqrt();
        for (frame, pose) in poses.iter_mut().enumerate() {
            let stretch = self.new.stretch[frame];
            let wave = stance_wave(self.timeline.phase[frame]);
            let mut place = self
                .old
                .relative(frame, self.captured.poses[frame].root_position);
            let weave = drift(self.seed, 5, self.secs(frame) / self.sheet.irregular.period);
            place.x = place.x * pelvis.sway / 100.0
                + 0.01 * pelvis.sway_more * wave
                + 0.001 * self.sheet.irregular.trunk * weave;
            place.z *= stretch;
            // Legs as long as ever: the hips' highest place stays, and short steps dip less below it.
            let bounce = pelvis.bounce / 100.0 * (stretch * stretch).clamp(0.3, 1.3);
            place.y = level[frame] + top + bounce * (heights[frame] - level[frame] - top);
            place.y += 0.01 * pelvis.height;
            for side in Side::BOTH {
                let carries = (wave * side.sign()).max(0.0);
                place.y -= 0.01 * self.sheet.sides[side.index()].drop * carries * carries;
            }
            pose.root_position = self.new.point(frame, place);
        }
    }

    /// Raises and lowers the hips by as much as standing feet were lowered to the ground: captured soles are up to centimetres above it or in it. Legs keep
    /// their captured lengths that way.
    pub(super) fn follow_feet(
        &self,
        poses: &mut [Pose],
        models: &[ModelPose],
        soles: &[RockerFoot; 2],
    ) {
        let lowered: [Vec<(FrameSpan, f32)>; 2] = Side::BOTH.map(|side| {
            let stances = self.timeline.stances[side.index()].iter();
            let foot = &soles[side.index()];
            stances
                .map(|span| (*span, height_above_ground(side, foot, *span, models)))
                .collect()
        });
        let raised: Vec<f32> = (0..poses.len())
            .map(|frame| {
                let wave = stance_wave(self.timeline.phase[frame]);
                let (mut sum, mut weights) = (0.0, 0.0);
                for side in Side::BOTH {
                    let standing = lowered[side.index()].iter();
                    for (_, height) in standing.filter(|(span, _)| span.contains(frame)) {
                        // The foot in the middle of its stance bears most.
                        let weight = 1.0 + 0.9 * wave * side.sign();
                        sum -= weight * height;
                        weights += weight;
                    }
                }
                sum / f32::max(weights, f32::MIN_POSITIVE)
            })
            .collect();
        let sigma = (FOLLOWING_SECS * self.captured.frame_rate_hz) as f32;
        for (pose, raised) in poses.iter_mut().zip(smoothed(&raised, sigma)) {
            pose.root_position.y += raised;
        }
    }

    /// Lowers the hips, softly, to where the legs reach their feet.
    pub(super) fn give_way(&self, poses: &mut [Pose], feet: &[Vec<FootTarget>; 2]) {
        let skeleton = &self.captured.skeleton;
        let ahead = (REACH_AHEAD_SECS * self.captured.frame_rate_hz).ceil() as usize;
        // What smoothing leaves short, a second and third round find.
        for _ in 0..3 {
            let mut need = vec![0.0_f32; poses.len()];
            for (frame, pose) in poses.iter().enumerate() {
                for side in Side::BOTH {
                    let hip = pose.rotation(Joint::Hips) * skeleton.offset(side.upper_leg());
                    let ankle = feet[side.index()][frame].ankle;
                    let length = skeleton.leg_length(side);
                    let limit = reach_height(pose.root_position, hip, ankle, length, MOST_STRETCH);
                    if let Some(limit) = limit {
                        need[frame] = need[frame].max(pose.root_position.y - limit);
                    }
                }
            }
            if need.iter().all(|short| *short < 1e-4) {
                return;
            }
            let widened: Vec<f32> = (0..need.len())
                .map(|frame| {
                    let to = (frame + ahead).min(need.len() - 1);
                    need[frame.saturating_sub(ahead)..=to]
                        .iter()
                        .copied()
                        .fold(0.0, f32::max)
                })
                .collect();
            for (pose, lower) in poses.iter_mut().zip(smoothed(&widened, 0.6 * ahead as f32)) {
                pose.root_position.y -= lower;
            }
        }
    }
}

/// Mean height of a captured sole above the ground in the middle of a stance, metres.
fn height_above_ground(
    side: Side,
    foot: &RockerFoot,
    span: FrameSpan,
    models: &[ModelPose],
) -> f32 {
    let middle = &models[span.first + span.frames() / 4..=span.last - span.frames() / 4];
    let heights = middle.iter().map(|model| {
        let pitch = foot_pitch(model.rotation(side.foot()));
        model.position(side.foot()).y - foot.ankle_height() - foot.roll(pitch).y
    });
    heights.sum::<f32>() / middle.len() as f32
}
