//! Time: which captured frame each new frame shows, where in the gait cycle it is, and when the feet stand.

use crate::DesignError;
use crate::chance::normal;
use crate::curve::Monotone;
use crate::sheet::StyleSheet;
use footfall_core::{Clip, FrameSpan, ModelPose, Side};
use footfall_motion::contacts::Contacts;
use footfall_motion::steps::{Step, Walk};

/// Share of a step for which both feet stand, at least and at most.
const DOUBLE_SUPPORT: [f64; 2] = [0.04, 0.5];
/// A stance or a break in one that is shorter than this is a slip of the detector, seconds.
const LEAST_SECS: f64 = 0.08;

/// Feet that go slower than this over the ground have come to rest, m/s; they do so within this time after they touch it, seconds.
const RESTING_MPS: f32 = 0.4;
const SETTLING_SECS: f64 = 0.06;

/// The new clip's time.
#[derive(Debug)]
pub(crate) struct Timeline {
    /// Captured frame, with a fraction, that each new frame shows.
    pub(crate) source: Vec<f64>,
    /// Strides since the left foot landed, of each new frame.
    pub(crate) phase: Vec<f32>,
    /// When each foot stands, in new frames.
    pub(crate) stances: [Vec<FrameSpan>; 2],
    /// Mean length of a stride in new frames.
    pub(crate) stride_frames: f32,
}

impl Timeline {
    pub(crate) fn new(
        clip: &Clip,
        contacts: &Contacts,
        walks: &[Walk],
        sheet: &StyleSheet,
        seed: u64,
    ) -> Result<Self, DesignError> {
        let walk = walks
            .iter()
            .max_by_key(|walk| walk.steps.len())
            .filter(|walk| walk.steps.len() >= 2);
        let Some(walk) = walk else {
            return Err(DesignError::TooFewSteps {
                steps: walks.iter().map(|walk| walk.steps.len()).max().unwrap_or(0),
            });
        };
        let steps = &walk.steps;
        let last_frame = clip.poses.len().saturating_sub(1);
        let landing = steps[0].first;
        let end = steps[steps.len() - 1].end;
        let step_frames = (end - landing) as f64 / steps.len() as f64;
        // Beyond the walk as far as a step, where the cycle is still defined.
        let from = (landing as f64 - step_frames).max(contacts.first_frame as f64);
        let to = (end as f64 + step_frames).min(last_frame as f64);

        let mut knots = vec![(0.0, landing as f64)];
        let mut lengths = Vec::new();
        for (index, step) in steps.iter().enumerate() {
            let time = knots[knots.len() - 1].0;
            let length = new_length(step, index, sheet, seed);
            lengths.push(length);
            if let Some(terminal) = step.other_terminal
                && terminal > step.first
                && terminal < step.end
            {
                let share = (terminal - step.first) as f64 / step.frames() as f64;
                // A stance lasts for a step and one double support, and a stride has two steps.
                let share = share + 2.0 * f64::from(sheet.walk.stance_share) / 100.0;
                let share = share.clamp(DOUBLE_SUPPORT[0], DOUBLE_SUPPORT[1]);
                knots.push((time + share * length, terminal as f64));
            }
            knots.push((time + length, step.end as f64));
        }
        let mean_length = lengths.iter().sum::<f64>() / lengths.len() as f64;
        let rate = mean_length / step_frames;
        if from < landing as f64 {
            knots.insert(0, (-(landing as f64 - from) * rate, from));
        }
        if to > end as f64 {
            let time = knots[knots.len() - 1].0;
            knots.push((time + (to - end as f64) * rate, to));
        }
        let start = knots[0].0;
        let duration = knots[knots.len() - 1].0 - start;
        let source_of_new = Monotone::new(knots);
        let frames = duration.floor() as usize + 1;
        let source: Vec<f64> = (0..frames)
            .map(|frame| source_of_new.at(frame as f64 + start).clamp(from, to))
            .collect();

        let half = if steps[0].side == Side::Left {
            0.0
        } else {
            0.5
        };
        let mut cycle = vec![(landing as f64, half)];
        for step in steps {
            let strides = cycle[cycle.len() - 1].1 + 0.5;
            cycle.push((step.end as f64, strides));
        }
        let cycle = Monotone::new(cycle);
        let phase = source.iter().map(|frame| cycle.at(*frame) as f32).collect();
        let least = (LEAST_SECS * clip.frame_rate_hz).round() as usize;
        let stances = Side::BOTH.map(|side| {
            let mut spans = stances_of(contacts, side, &source, least);
            for span in &mut spans {
                settle(clip, side, &source, span);
            }
            spans
        });
        if stances.iter().any(Vec::is_empty) {
            return Err(DesignError::TooFewSteps { steps: steps.len() });
        }
        Ok(Self {
            source,
            phase,
            stances,
            stride_frames: 2.0 * mean_length as f32,
        })
    }

    /// Returns the number of new frames.
    pub(crate) fn frames(&self) -> usize {
        self.source.len()
    }
}

/// Frames that a step takes in the style.
fn new_length(step: &Step, index: usize, sheet: &StyleSheet, seed: u64) -> f64 {
    let side = &sheet.sides[step.side.index()];
    let chance = 1.0 + 0.01 * sheet.irregular.step_time * normal(seed, 1, index as u64);
    let factor = side.step_time / sheet.walk.cadence * chance.clamp(0.6, 1.6);
    step.frames() as f64 * f64::from(factor)
}

/// Lets a stance begin where the captured foot has come to rest: a heel that has touched the ground goes on for some frames.
fn settle(clip: &Clip, side: Side, source: &[f64], span: &mut FrameSpan) {
    if span.first == 0 {
        return;
    }
    let rate = clip.frame_rate_hz;
    let place = |frame: usize| {
        let pose = clip.pose_at(source[frame] / rate).unwrap_or_default();
        let ankle = ModelPose::of(&clip.skeleton, &pose).position(side.foot());
        ankle.with_y(0.0)
    };
    let most = (SETTLING_SECS * rate) as usize;
    let last = (span.first + most).min(span.last.saturating_sub(3));
    while span.first < last
        && place(span.first).distance(place(span.first + 1)) * rate as f32 > RESTING_MPS
    {
        span.first += 1;
    }
}

fn stances_of(contacts: &Contacts, side: Side, source: &[f64], least: usize) -> Vec<FrameSpan> {
    let captured = &contacts.foot(side).stances;
    let mut spans: Vec<FrameSpan> = Vec::new();
    for (frame, from) in source.iter().enumerate() {
        let at = from.round() as usize;
        if !captured.iter().any(|span| span.contains(at)) {
            continue;
        }
        match spans.last_mut() {
            Some(span) if frame - span.last <= least => span.last = frame,
            _ => spans.push(FrameSpan {
                first: frame,
                last: frame,
            }),
        }
    }
    let frames = source.len();
    // What the clip's ends cut off may be short.
    spans.retain(|span| span.frames() >= least || span.first == 0 || span.last + 1 == frames);
    spans.retain(|span| span.frames() >= 3);
    spans
}
