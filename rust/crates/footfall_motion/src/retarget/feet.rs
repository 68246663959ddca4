//! When a foot lies flat on the ground, and how it is turned then: the zero of foot and toes.
//!
//! Skeletons differ in the slope of the line from ankle to ball, and in what zero rotations mean for a foot. What they
//! share is the ground: a foot that neither moves nor is lifted lies flat.

use super::evidence::is_canonical;
use super::rest::{RestRotations, canonical_direction, is_t_pose};
use super::source::SourceMotion;
use footfall_core::{Joint, Side};
use glam::{Quat, Vec3, Vec4};

/// Measurements of one flat foot.
#[derive(Clone, Copy, Debug)]
pub(super) struct FlatFoot {
    /// Frames that it was learned from; 0 when the reference pose had to serve.
    pub(super) frames: usize,
    /// Direction from ankle to ball, pointing along +Z seen from above.
    pub(super) direction: Vec3,
}

/// A foot of the canonical body that stands turned further from its zero than this does not lie flat, radians.
const MOST_TURNED: f32 = 0.26;

/// Rotation about the vertical that brings a direction to +Z as seen from above.
fn facing_forward(direction: Vec3) -> Quat {
    Quat::from_rotation_y(-direction.x.atan2(direction.z))
}

/// Finds how foot and toes are turned on flat ground and puts it into `rest`. The canonical body has flat soles at zero rotations: one that stands far from them
/// walks on tiptoe.
pub(super) fn flat_feet(motion: &SourceMotion, rest: &mut RestRotations) -> [FlatFoot; 2] {
    let is_own_body = is_canonical(motion) && is_t_pose(&motion.rest);
    Side::BOTH.map(|side| {
        let foot = side.foot();
        let toes = side.toes();
        let flat = standing_frames(motion, side);
        let turned = |joint: Joint| {
            let rotations: Vec<Quat> = flat
                .iter()
                .map(|&frame| {
                    let frame = &motion.frames[frame];
                    facing_forward(frame.segment(foot)) * frame.rotation(joint)
                })
                .collect();
            robust_mean(&rotations)
        };
        let local = |joint: Joint| {
            motion
                .sampled()
                .map(|frame| frame.rotation(joint).inverse() * frame.direction(joint))
                .sum::<Vec3>()
                .normalize_or_zero()
        };
        let foot_local = local(foot);
        let level = facing_forward(motion.rest.direction(foot));
        let known = [foot, toes].map(|joint| level * motion.rest.rotation(joint));
        let learned = turned(foot);
        let on_tiptoe = |learned: Quat| learned.angle_between(known[0]) > MOST_TURNED;
        if is_own_body && learned.is_some_and(on_tiptoe) {
            [rest[foot.index()], rest[toes.index()]] = known;
            return FlatFoot {
                frames: 0,
                direction: level * motion.rest.direction(foot),
            };
        }
        if let Some(rotation) = learned {
            rest[foot.index()] = rotation;
        }
        let direction = rest[foot.index()] * foot_local;
        let level = facing_forward(direction);
        rest[foot.index()] = level * rest[foot.index()];
        if motion.has[toes.index()] {
            if let Some(rotation) = turned(toes) {
                rest[toes.index()] = level * rotation;
            } else {
                let toe = rest[toes.index()] * local(toes);
                rest[toes.index()] = facing_forward(toe) * rest[toes.index()];
            }
        } else {
            rest[toes.index()] = rest[foot.index()];
        }
        let direction = level * direction;
        FlatFoot {
            frames: flat.len(),
            direction: if direction.length() > 0.5 {
                direction
            } else {
                canonical_direction(foot)
            },
        }
    })
}

/// Frames in which the foot lies still and low: ankle and ball both.
fn standing_frames(motion: &SourceMotion, side: Side) -> Vec<usize> {
    const LEAST_FRAMES: usize = 4;
    let rate = motion.frame_rate_hz as f32;
    let leg = motion.leg_length.max(1e-6);
    // Over 50 ms, so that the noise of one frame does not count as speed.
    let reach = ((0.025 * rate).round() as usize).max(1);
    let first = motion.first_motion_frame + reach;
    let last = motion.frames.len().saturating_sub(reach);
    if first >= last {
        return Vec::new();
    }
    let points = |frame: usize| {
        let frame = &motion.frames[frame];
        let ankle = frame.position(side.foot());
        [ankle, ankle + frame.segment(side.foot())]
    };
    // Both in units of a leg of 0.84 m, so that they read as metres.
    let metre = 0.84 / leg;
    let mut still: Vec<(f32, f32, usize)> = (first..last)
        .map(|frame| {
            let (before, now, after) =
                (points(frame - reach), points(frame), points(frame + reach));
            let speed = (0..2)
                .map(|n| (after[n] - before[n]).length())
                .fold(0.0_f32, f32::max)
                * metre
                * rate
                / (2 * reach) as f32;
            (speed, (now[0].y + now[1].y) * 0.5 * metre, frame)
        })
        .collect();
    still.sort_by(|a, b| a.0.total_cmp(&b.0));
    // A running foot is flat for a few hundredths of a second and slides meanwhile, hence the quantile.
    let slowest = still[still.len() / 25].0;
    let limit = (2.0 * slowest).clamp(0.15, 0.6);
    let slow: Vec<_> = still.iter().take_while(|entry| entry.0 <= limit).collect();
    let mut heights: Vec<f32> = slow.iter().map(|entry| entry.1).collect();
    heights.sort_by(f32::total_cmp);
    let Some(&lowest) = heights.get(heights.len() / 5) else {
        return Vec::new();
    };
    let flat: Vec<usize> = slow
        .iter()
        .filter(|entry| (entry.1 - lowest).abs() < 0.03)
        .map(|entry| entry.2)
        .collect();
    if flat.len() < LEAST_FRAMES {
        return Vec::new();
    }
    flat
}

/// Mean rotation without the outliers: those farther than twice the median distance are dropped, three times over.
fn robust_mean(rotations: &[Quat]) -> Option<Quat> {
    let mut kept: Vec<Quat> = rotations.to_vec();
    let mut mean = mean_rotation(&kept)?;
    for _ in 0..3 {
        let mut angles: Vec<f32> = kept.iter().map(|turn| turn.angle_between(mean)).collect();
        angles.sort_by(f32::total_cmp);
        let limit = (2.0 * angles[angles.len() / 2]).max(0.02);
        kept.retain(|turn| turn.angle_between(mean) <= limit);
        mean = mean_rotation(&kept)?;
    }
    Some(mean)
}

fn mean_rotation(rotations: &[Quat]) -> Option<Quat> {
    let first = *rotations.first()?;
    let sum: Vec4 = rotations
        .iter()
        .map(|&turn| Vec4::from(if first.dot(turn) < 0.0 { -turn } else { turn }))
        .sum();
    sum.try_normalize().map(Quat::from_vec4)
}
