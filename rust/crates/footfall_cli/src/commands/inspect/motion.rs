//! Facts of a recording.

use super::fact;
use crate::fit_facts::{HeadFacts, HipFacts};
use crate::motion_input::{WalkFigures, read_file};
use anyhow::Result;
use footfall_core::{Joint, Side};
use footfall_motion::game_clip;
use footfall_motion::recording::Recording;
use footfall_motion::retarget::RetargetOptions;
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Facts of a recording; lengths and speeds as the recorded person's.
#[derive(Serialize)]
pub(super) struct MotionFacts {
    file: PathBuf,
    skeleton: String,
    joints: usize,
    /// Canonical joints that the file does not have.
    absent_joints: Vec<&'static str>,
    frames: usize,
    fps: f64,
    seconds: f64,
    /// Frames before this one are no motion (a T-pose).
    first_motion_frame: usize,
    /// Metres of the canonical body for one unit of the file.
    metres_per_unit: f32,
    /// Median height of the hips above the floor, on the canonical body.
    hip_height_m: f32,
    /// Value on the canonical body.
    mean_speed_mps: f64,
    walks: usize,
    steps: usize,
    steps_per_minute: Option<f64>,
    left_stances: usize,
    right_stances: usize,
    /// Share of the motion in which each foot stands.
    left_stance_share: f64,
    right_stance_share: f64,
    /// True when it walks in place; its speed is then that of its standing feet.
    in_place: bool,
    /// Frames of one round, if it is a loop.
    cycle_frames: Option<usize>,
    warnings: Vec<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    hip_joints: Option<HipFacts>,
    #[serde(skip_serializing_if = "Option::is_none")]
    head: Option<HeadFacts>,
}

/// Reads a recording.
pub(super) fn inspect(path: &Path, options: &RetargetOptions) -> Result<MotionFacts> {
    let (file, motion) = read_file(path, options)?;
    let report = &motion.report;
    let mut unrolled = motion.clone();
    game_clip::unroll(&mut unrolled);
    let recording = Recording::detected(unrolled);
    let walking = WalkFigures::of(&recording);
    let unrolled = &recording.retargeted;
    let rounds = report.cycle_frames.map_or(1, |_| unrolled.report.repeats);
    let clip = &motion.clip;
    let mut heights: Vec<f32> = clip.poses[motion.first_frame..]
        .iter()
        .map(|pose| pose.root_position.y)
        .collect();
    heights.sort_by(f32::total_cmp);
    let frames = (unrolled.clip.poses.len() - unrolled.first_frame).max(1);
    let [left, right] = Side::BOTH.map(|side| {
        let stances = &recording.contacts.foot(side).stances;
        let standing: usize = stances.iter().map(|stance| stance.frames()).sum();
        (
            stances.len().div_ceil(rounds),
            standing as f64 / frames as f64,
        )
    });
    Ok(MotionFacts {
        file: path.to_owned(),
        skeleton: motion.report.map.clone(),
        joints: file.joints.len(),
        absent_joints: Joint::ALL
            .into_iter()
            .filter(|joint| motion.report.source_joints[joint.index()].is_none())
            .map(Joint::name)
            .collect(),
        frames: file.frame_count,
        fps: file.frame_rate_hz(),
        seconds: clip.duration_secs(),
        first_motion_frame: motion.first_frame,
        metres_per_unit: motion.report.scale,
        hip_height_m: heights.get(heights.len() / 2).copied().unwrap_or_default(),
        mean_speed_mps: walking.speed_mps,
        walks: recording.walks.len(),
        steps: recording.step_count().div_ceil(rounds),
        steps_per_minute: walking.cadence_per_min,
        left_stances: left.0,
        right_stances: right.0,
        left_stance_share: left.1,
        right_stance_share: right.1,
        in_place: report.in_place,
        cycle_frames: report.cycle_frames,
        warnings: report
            .cycle_frames
            .map(|_| "one loop: a style made of it alone is thin, with equal steps".to_owned())
            .into_iter()
            .collect(),
        hip_joints: HipFacts::of(&motion.report.fit.hip_centres),
        head: motion.report.fit.head.as_ref().map(HeadFacts::of),
    })
}

impl MotionFacts {
    pub(super) fn lines(&self) -> Vec<String> {
        let mut lines = vec![
            fact("recording", self.file.display()),
            fact(
                "skeleton",
                format!("{}, {} joints", self.skeleton, self.joints),
            ),
            fact(
                "length",
                format!(
                    "{:.2} s: {} frames at {} fps",
                    self.seconds, self.frames, self.fps
                ),
            ),
            fact(
                "scale",
                format!(
                    "{:.4} m a unit, hips at {:.3} m",
                    self.metres_per_unit, self.hip_height_m
                ),
            ),
            fact("speed", format!("{:.2} m/s", self.mean_speed_mps)),
            fact(
                "contacts",
                format!(
                    "left {} stances ({:.0} % of the time), right {} ({:.0} %)",
                    self.left_stances,
                    100.0 * self.left_stance_share,
                    self.right_stances,
                    100.0 * self.right_stance_share
                ),
            ),
            fact(
                "steps",
                match self.steps_per_minute {
                    Some(cadence) => format!(
                        "{} in {} walks, {cadence:.0} a minute",
                        self.steps, self.walks
                    ),
                    None => "none".to_owned(),
                },
            ),
        ];
        if let Some(hip_joints) = &self.hip_joints {
            lines.push(fact("hip joints", &hip_joints.line));
        }
        if let Some(head) = &self.head {
            lines.push(fact("head", &head.line));
        }
        if self.first_motion_frame > 0 {
            lines.push(fact(
                "motion from",
                format!("frame {} on (a T-pose before)", self.first_motion_frame),
            ));
        }
        if self.in_place {
            lines.push(fact(
                "in place",
                "yes; its travel is that of the standing feet",
            ));
        }
        if let Some(frames) = self.cycle_frames {
            lines.push(fact("loop", format!("of {frames} frames")));
        }
        for warning in &self.warnings {
            lines.push(fact("warning", warning));
        }
        if !self.absent_joints.is_empty() {
            lines.push(fact("without", self.absent_joints.join(", ")));
        }
        lines
    }
}
