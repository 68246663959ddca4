//! From a recording to training sequences.

use crate::error::TrainError;
use crate::sequence::{LabelledStep, Sequence};
use footfall_core::rotation::{heading, wrap_angle};
use footfall_core::{Clip, Joint};
use footfall_model::{FEATURE_COUNT, OBSERVATION_COUNT, layout};
use footfall_motion::recording::Recording;
use footfall_motion::steps::{Step, Walk};
use footfall_prob::windows::Windows;

/// Standard deviation of the window that smooths the heading, seconds: the pelvis' swing within a stride stays in the
/// features, a turn of the walker does not.
const HEADING_WINDOW_SECS: f64 = 0.35;

/// Settings of encoding.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EncodeConfig {
    /// Frames per second of the features.
    pub frame_rate_hz: f64,
    /// Time differences of the observations.
    pub windows: Windows,
}

/// A recording, encoded whole; training takes walks of it, or parts of walks.
#[derive(Clone, Debug)]
pub struct EncodedRecording<'a> {
    recording: &'a Recording,
    observations: Vec<f64>,
    /// Frames of the features for one of the recording.
    scale: f64,
}

impl<'a> EncodedRecording<'a> {
    /// Encodes a recording from its [first frame](Recording::first_frame) on.
    ///
    /// # Errors
    /// [`TrainError::FrameRate`] for a rate that is not usable; [`TrainError::Inference`] when a pose is not finite.
    pub fn of(recording: &'a Recording, config: &EncodeConfig) -> Result<Self, TrainError> {
        if !(20.0..=240.0).contains(&config.frame_rate_hz) {
            return Err(TrainError::FrameRate {
                frame_rate_hz: config.frame_rate_hz,
            });
        }
        let clip = recording.clip();
        let first = recording.first_frame();
        let moving = Clip {
            poses: clip.poses.get(first..).unwrap_or_default().to_vec(),
            ..clip.clone()
        };
        Ok(Self {
            recording,
            observations: observe(&moving, config)?,
            scale: config.frame_rate_hz / clip.frame_rate_hz,
        })
    }

    /// The recording itself.
    pub const fn recording(&self) -> &'a Recording {
        self.recording
    }

    /// Walks, each from its first initial contact to its last, in frames of the recording. Walks of fewer than two steps are left out.
    pub fn walks(&self, walks: &[Walk], walker: usize) -> Vec<Sequence> {
        let long = walks.iter().filter(|walk| walk.steps.len() >= 2);
        long.filter_map(|walk| self.sequence(walk, walker))
            .collect()
    }

    fn sequence(&self, walk: &Walk, walker: usize) -> Option<Sequence> {
        let first = self.frame_at(walk.steps.first()?.first);
        let end = self.frame_at(walk.steps.last()?.end);
        let steps = walk.steps.iter();
        let steps = steps.map(|step| self.labelled(step, first)).collect();
        let cells = first * OBSERVATION_COUNT..end * OBSERVATION_COUNT;
        Some(Sequence {
            walker,
            observations: self.observations[cells].to_vec(),
            steps,
        })
    }

    /// A step, in frames of a sequence that begins at `first`.
    fn labelled(&self, step: &Step, first: usize) -> LabelledStep {
        let (from, to) = (self.frame_at(step.first), self.frame_at(step.end));
        let length = step.frames() as f64;
        LabelledStep {
            side: step.side,
            first: from - first,
            end: to - first,
            other_terminal: match (step.other_terminal, step.take_off) {
                (Some(frame), _) => Some((frame as f64 - step.first as f64) / length),
                // The flight that ends a running step is as long as the one before it.
                (None, Some(frame)) => Some((frame as f64 - step.end as f64) / length),
                (None, None) => None,
            },
            position: step.position,
            speed_mps: speed(self.recording.clip(), step.first, step.end),
        }
    }

    /// The frame of the features that a frame of the recording becomes.
    fn frame_at(&self, frame: usize) -> usize {
        let frames = self.observations.len() / OBSERVATION_COUNT;
        let position = frame.saturating_sub(self.recording.first_frame()) as f64 * self.scale;
        (position.round() as usize).min(frames)
    }
}

/// Observations of a whole clip at the rate of the features, T × [`OBSERVATION_COUNT`].
fn observe(clip: &Clip, config: &EncodeConfig) -> Result<Vec<f64>, TrainError> {
    let headings = smooth_headings(clip);
    let mut statics = vec![0.0; clip.poses.len() * FEATURE_COUNT];
    for (frame, pose) in clip.poses.iter().enumerate() {
        let (before, rest) = statics.split_at_mut(frame * FEATURE_COUNT);
        let previous = before.rchunks_exact(FEATURE_COUNT).next();
        layout::encode(
            pose,
            headings[frame] as f32,
            previous,
            &mut rest[..FEATURE_COUNT],
        );
    }
    let statics = resample(&statics, config.frame_rate_hz / clip.frame_rate_hz);
    let mut observations = Vec::new();
    config
        .windows
        .append_dynamics(&statics, FEATURE_COUNT, &mut observations)?;
    Ok(observations)
}

/// Static features at `scale` times their rate, along a cubic curve through the frames (Catmull-Rom).
///
/// Straight lines between the frames of a slow recording would have no curvature but for the corners, and Δ² would learn the
/// corners.
fn resample(statics: &[f64], scale: f64) -> Vec<f64> {
    let Some(last) = (statics.len() / FEATURE_COUNT).checked_sub(1) else {
        return Vec::new();
    };
    // A relative slack keeps the last frame when the duration is a whole number of new frames up to rounding.
    let frames = (last as f64 * scale * (1.0 + 1e-9) + 1e-6).floor() as usize;
    let row = |frame: usize| &statics[frame.min(last) * FEATURE_COUNT..][..FEATURE_COUNT];
    let mut resampled = Vec::with_capacity((frames + 1) * FEATURE_COUNT);
    for frame in 0..=frames {
        let position = (frame as f64 / scale).min(last as f64);
        let first = position.floor() as usize;
        let s = position - first as f64;
        let rows = [
            row(first.saturating_sub(1)),
            row(first),
            row(first + 1),
            row(first + 2),
        ];
        let (s2, s3) = (s * s, s * s * s);
        let weights = [
            0.5 * (-s3 + 2.0 * s2 - s),
            0.5 * (3.0 * s3 - 5.0 * s2 + 2.0),
            0.5 * (-3.0 * s3 + 4.0 * s2 + s),
            0.5 * (s3 - s2),
        ];
        let value = |dim: usize| {
            rows.iter()
                .zip(weights)
                .map(|(row, w)| w * row[dim])
                .sum::<f64>()
        };
        resampled.extend((0..FEATURE_COUNT).map(value));
    }
    resampled
}

/// The heading of the hips, smoothed over time. Beyond the ends it is taken to go on as it began and ended.
pub(crate) fn smooth_headings(clip: &Clip) -> Vec<f64> {
    let mut raw: Vec<f64> = Vec::with_capacity(clip.poses.len());
    for pose in &clip.poses {
        let now = f64::from(heading(pose.rotation(Joint::Hips)));
        let last = raw.last().copied().unwrap_or(now);
        raw.push(last + f64::from(wrap_angle((now - last) as f32)));
    }
    let Some(last) = raw.len().checked_sub(1) else {
        return raw;
    };
    let width = HEADING_WINDOW_SECS * clip.frame_rate_hz;
    let reach = (3.0 * width).ceil() as usize;
    // Point reflection at the ends keeps the trend of a turn.
    let before = |offset: usize, frame: usize| match frame.checked_sub(offset) {
        Some(index) => raw[index],
        None => 2.0 * raw[0] - raw[(offset - frame).min(last)],
    };
    let after = |offset: usize, frame: usize| match (frame + offset).checked_sub(last + 1) {
        None => raw[frame + offset],
        Some(beyond) => 2.0 * raw[last] - raw[last.saturating_sub(beyond + 1)],
    };
    (0..=last)
        .map(|frame| {
            let (mut sum, mut weights) = (raw[frame], 1.0);
            for offset in 1..=reach {
                let weight = (-0.5 * (offset as f64 / width).powi(2)).exp();
                sum += weight * (before(offset, frame) + after(offset, frame));
                weights += 2.0 * weight;
            }
            sum / weights
        })
        .collect()
}

/// Mean speed of the hips over the ground between two frames, m/s.
fn speed(clip: &Clip, first: usize, end: usize) -> f64 {
    let place = |frame: usize| clip.poses[frame.min(clip.poses.len() - 1)].root_position;
    let travel = place(end) - place(first);
    f64::from(travel.x.hypot(travel.z)) * clip.frame_rate_hz / (end - first) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use footfall_core::rotation::from_heading;
    use footfall_core::{Pose, Skeleton};

    #[test]
    fn resampling_follows_the_curve_between_frames() {
        let wave = |time: f64| (core::f64::consts::TAU * 1.8 * time).sin();
        let slow: Vec<f64> = (0..61)
            .flat_map(|frame| [wave(f64::from(frame) / 30.0); FEATURE_COUNT])
            .collect();
        let doubled = resample(&slow, 2.0);
        assert_eq!(doubled.len(), 121 * FEATURE_COUNT);
        for (frame, row) in doubled
            .chunks_exact(FEATURE_COUNT)
            .enumerate()
            .skip(2)
            .take(116)
        {
            let error = row[7] - wave(frame as f64 / 60.0);
            // Straight lines are off by 0.018 between frames.
            assert!(error.abs() < 0.002, "frame {frame}: off by {error}");
        }
        assert_eq!(resample(&doubled, 0.5).len(), slow.len());
        assert_eq!(resample(&slow, 1.0), slow);
    }

    #[test]
    fn smoothing_keeps_a_turn_and_removes_the_swing() {
        let poses = (0..300)
            .map(|frame| {
                let time = f64::from(frame) / 60.0;
                let swing = 0.1 * (core::f64::consts::TAU * 0.9 * time).sin();
                let mut pose = Pose::default();
                pose.rotations[0] = from_heading((3.0 + 0.3 * time + swing) as f32);
                pose
            })
            .collect();
        let clip = Clip {
            skeleton: Skeleton::standard(),
            frame_rate_hz: 60.0,
            poses,
        };
        for (frame, smooth) in smooth_headings(&clip).iter().enumerate().skip(60).take(180) {
            let expected = 3.0 + 0.3 * frame as f64 / 60.0;
            assert!(
                (smooth - expected).abs() < 0.025,
                "frame {frame}: {smooth} for {expected}"
            );
        }
    }
}
