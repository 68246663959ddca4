//! Ground contacts from joint angles alone: when the legs change roles.
//!
//! Gait alternates between two systems, which switch when a foot lands (*Gait as a switching dynamical system*, section 2). The
//! projection residual of hip and knee angles ([`footfall_prob::switching`]) rises around each switch, but in captured motion a
//! single residual is too noisy to read: noise, muffled impacts and the lift of the other foot, a tenth of a second later, blur
//! it. So what the paper thresholds step by step is read off all steps together:
//!
//! 1. Every half cycle of the difference of the hip angles holds one switch, onto the leg ahead.
//! 2. The switches repeat: half cycles are shifted until the angles around them agree with their mean, left mirrored to right.
//! 3. The residual is averaged over the aligned steps, and its greatest value while the landing knee begins to bend is the
//!    switch of them all.
//!
//! No height, speed or ground is looked at. Against the kinematic initial contacts ([`crate::contacts`]), within 33 ms, from
//! `footfall evaluate contacts` on public recordings (bias and spread of ours less the kinematic time, milliseconds):
//!
//! | recordings | events | F1 | bias | spread |
//! | --- | --- | --- | --- | --- |
//! | CMU neutral walks, 120 fps | 218 | 0.93 | +3 | 16 |
//! | Bandai styled walks, 30 fps | 1368 | 0.97 | -2 | 20 |
//! | CMU runs, 120 fps | 16 | 1.00 | +13 | 14 |
//!
//! Limits: it needs steps that repeat. Walks of a few steps out of standing and into it, tight turns, walking backwards, hops
//! and jumps are beyond it.

use crate::steps::{LONGEST_STEP_SECS, SHORTEST_STEP_SECS, Step, Walk};
use footfall_core::rotation::log_map;
use footfall_core::{Clip, FrameSpan, Side, StepPosition};
use footfall_prob::ProbError;
use footfall_prob::switching::{ProjectionResidual, median};

/// Frames per second at which angles are looked at, those of the paper.
pub const ANGLE_RATE_HZ: f64 = 60.0;

/// Hip and knee of both legs.
const CHANNELS: usize = 4;

/// Frames of past and future. The noise of captured angles outweighs what longer windows explain.
const WINDOW: usize = 2;

/// A half cycle is at least so long, frames.
const LEAST_HALF_CYCLE: usize = 8;

/// And its hips swing at least this share of the usual way apart: less is standing.
const LEAST_SWING: f64 = 0.35;

/// And at least so far, radians.
const LEAST_SWING_RAD: f64 = 0.08;

/// Frames around a switch that are compared between steps.
const HALF_TEMPLATE: usize = 9;

/// How far a step is shifted in one round of alignment, frames, and how many rounds there are.
const MOST_SHIFT: isize = 4;
const ROUNDS: usize = 6;

/// A residual counts for at most so many medians: one glitch of capture is not a switch.
const MOST_RESIDUAL: f64 = 4.0;

/// Share of the trailing leg in the residual.
const TRAILING_SHARE: f64 = 0.3;

/// Frames over which the averaged residual is smoothed (standard deviation).
const SMOOTHING: f64 = 2.0;

/// How long after the landing knee is straightest the foot may land, frames.
const LANDING_FRAMES: isize = 2;

/// A change of roles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Switch {
    /// Frame of the clip.
    pub frame: usize,
    /// The leg that lands and carries the body from here on.
    pub side: Side,
}

/// Finds the switches of a clip from its frame `first_frame` on. A clip that is too short, or in which nobody walks, has none.
///
/// # Errors
/// [`ProbError::NotFinite`] when a pose is not finite.
pub fn detect_switches(clip: &Clip, first_frame: usize) -> Result<Vec<Switch>, ProbError> {
    Ok(analyse_switches(clip, first_frame)?.0)
}

/// The switches, and what they were found by, to be shown beside them; nothing of it for a clip that is too short.
///
/// # Errors
/// As [`detect_switches`].
pub fn analyse_switches(
    clip: &Clip,
    first_frame: usize,
) -> Result<(Vec<Switch>, Option<SwitchResidual>), ProbError> {
    check_finite_legs(clip, first_frame)?;
    let angles = LegAngles::of(clip, first_frame);
    let Some(residual) = Residual::of(&angles)? else {
        return Ok((Vec::new(), None));
    };
    let mut steps = angles.half_cycles();
    angles.align(&mut steps);
    let shift = angles.landing(&steps, &residual);
    let scale = clip.frame_rate_hz / ANGLE_RATE_HZ;
    let last = clip.poses.len().cast_signed() - 1;
    let mut switches: Vec<Switch> = steps
        .iter()
        .map(|step| {
            let frames = ((step.frame + shift) as f64 * scale).round() as isize;
            (first_frame.cast_signed() + frames, step.side)
        })
        .filter(|(frame, _)| (first_frame.cast_signed()..=last).contains(frame))
        .map(|(frame, side)| Switch {
            frame: frame as usize,
            side,
        })
        .collect();
    switches.sort_by_key(|switch| switch.frame);
    let shown = SwitchResidual {
        first_secs: first_frame as f64 / clip.frame_rate_hz + residual.first as f64 / ANGLE_RATE_HZ,
        rate_hz: ANGLE_RATE_HZ,
        legs: residual.legs,
    };
    Ok((switches, Some(shown)))
}

fn check_finite_legs(clip: &Clip, first_frame: usize) -> Result<(), ProbError> {
    let legs = Side::BOTH.map(|side| [side.upper_leg(), side.lower_leg()]);
    for (frame, pose) in clip.poses.iter().enumerate().skip(first_frame) {
        for rotation in legs
            .as_flattened()
            .iter()
            .map(|joint| pose.rotation(*joint))
        {
            if !rotation.is_finite() {
                return Err(ProbError::NotFinite {
                    what: "leg rotations, by frame",
                    index: frame,
                    value: f64::NAN,
                });
            }
        }
    }
    Ok(())
}

/// The projection residual, which peaks where one system hands over to the next.
#[derive(Clone, Debug, PartialEq)]
pub struct SwitchResidual {
    /// Time in the clip of the first value, seconds.
    pub first_secs: f64,
    /// Values a second.
    pub rate_hz: f64,
    /// For the left and the right leg, over the clip's median.
    pub legs: [Vec<f64>; 2],
}

/// The frames in which each foot certainly bears on the ground: from its switch until the other foot's. When it leaves the
/// ground after that, switches do not tell.
pub fn stances(switches: &[Switch], frames: usize) -> [Vec<FrameSpan>; 2] {
    let mut stances = [Vec::new(), Vec::new()];
    for (index, switch) in switches.iter().enumerate() {
        let next = switches.get(index + 1);
        let last = next.map_or(frames.saturating_sub(1), |next| next.frame);
        stances[switch.side.index()].push(FrameSpan {
            first: switch.frame,
            last: last.max(switch.frame),
        });
    }
    stances
}

/// The steps between switches, as walks; steps shorter than 0.15 s or longer than 1.5 s break a walk. Which steps begin and end a
/// walk, and when feet leave the ground, switches do not tell.
pub fn walks(switches: &[Switch], frame_rate_hz: f64) -> Vec<Walk> {
    let mut walks: Vec<Walk> = Vec::new();
    let mut last_end = None;
    for pair in switches.windows(2) {
        let (side, first, end) = (pair[0].side, pair[0].frame, pair[1].frame);
        let secs = end.saturating_sub(first) as f64 / frame_rate_hz;
        if side == pair[1].side || !(SHORTEST_STEP_SECS..=LONGEST_STEP_SECS).contains(&secs) {
            continue;
        }
        let step = Step {
            side,
            first,
            end,
            position: StepPosition::Inside,
            other_terminal: None,
            heel_rise: None,
        };
        match walks.last_mut() {
            Some(walk) if last_end == Some(first) => walk.steps.push(step),
            _ => walks.push(Walk { steps: vec![step] }),
        }
        last_end = Some(end);
    }
    walks
}

/// Sagittal angles of hips and knees, radians, at [`ANGLE_RATE_HZ`].
struct LegAngles {
    /// Frame by frame: hip left and right, positive when the thigh is behind; knee left and right, positive when bent.
    frames: Vec<[f64; CHANNELS]>,
}

/// A half cycle: one leg is ahead.
#[derive(Clone, Copy)]
struct HalfCycle {
    frame: isize,
    side: Side,
}

impl LegAngles {
    fn of(clip: &Clip, first_frame: usize) -> Self {
        let moving = Clip {
            poses: clip.poses.get(first_frame..).unwrap_or_default().to_vec(),
            ..clip.clone()
        };
        let frames = moving.resampled(ANGLE_RATE_HZ).poses;
        let frames = frames.iter().map(|pose| {
            let angle = |joint| f64::from(log_map(pose.rotation(joint)).x);
            [
                angle(Side::Left.upper_leg()),
                angle(Side::Right.upper_leg()),
                angle(Side::Left.lower_leg()),
                angle(Side::Right.lower_leg()),
            ]
        });
        Self {
            frames: frames.collect(),
        }
    }

    /// How far the right thigh is behind the left one: positive when the left leg is ahead.
    fn lead(&self, frame: usize) -> f64 {
        self.frames[frame][1] - self.frames[frame][0]
    }

    /// The runs of frames in which one leg is ahead, each where it is farthest ahead.
    fn half_cycles(&self) -> Vec<HalfCycle> {
        let leads: Vec<f64> = (0..self.frames.len())
            .map(|frame| self.lead(frame))
            .collect();
        let leads = smoothed(&leads, SMOOTHING);
        let mut runs: Vec<(usize, usize)> = Vec::new();
        for frame in 0..leads.len() {
            match runs.last_mut() {
                Some((_, last)) if leads[*last].signum() == leads[frame].signum() => *last = frame,
                _ => runs.push((frame, frame)),
            }
        }
        let peaks: Vec<usize> = runs
            .iter()
            .filter(|(first, last)| last - first + 1 >= LEAST_HALF_CYCLE)
            .map(|&(first, last)| {
                (first..=last).fold(first, |best, frame| {
                    if leads[frame].abs() > leads[best].abs() {
                        frame
                    } else {
                        best
                    }
                })
            })
            .collect();
        let swings: Vec<f64> = peaks.iter().map(|peak| leads[*peak].abs()).collect();
        let least = (LEAST_SWING * median(&swings)).max(LEAST_SWING_RAD);
        // A leg that is still moving ahead when the clip ends has not landed in it.
        let seen = |frame: &usize| *frame > 0 && frame + 1 < leads.len();
        peaks
            .into_iter()
            .filter(seen)
            .filter(|peak| leads[*peak].abs() > least)
            .map(|peak| HalfCycle {
                frame: peak.cast_signed(),
                side: if leads[peak] > 0.0 {
                    Side::Left
                } else {
                    Side::Right
                },
            })
            .collect()
    }

    /// The angles around a frame, the side's own leg first; `None` beyond the ends.
    fn around(&self, frame: isize, side: Side) -> Option<Vec<f64>> {
        let first = usize::try_from(frame - HALF_TEMPLATE.cast_signed()).ok()?;
        let frames = self.frames.get(first..=first + 2 * HALF_TEMPLATE)?;
        let ordered = frames
            .iter()
            .flat_map(|&[left_hip, right_hip, left_knee, right_knee]| match side {
                Side::Left => [left_hip, right_hip, left_knee, right_knee],
                Side::Right => [right_hip, left_hip, right_knee, left_knee],
            });
        Some(ordered.collect())
    }

    /// The mean of the angles around all steps.
    fn template(&self, steps: &[HalfCycle]) -> Option<Vec<f64>> {
        let mut sum = vec![0.0; (2 * HALF_TEMPLATE + 1) * CHANNELS];
        let mut count = 0.0;
        for around in steps
            .iter()
            .filter_map(|step| self.around(step.frame, step.side))
        {
            count += 1.0;
            for (sum, value) in sum.iter_mut().zip(around) {
                *sum += value;
            }
        }
        (count > 0.0).then(|| sum.iter().map(|sum| sum / count).collect())
    }

    /// Shifts all steps until each agrees best with their mean.
    fn align(&self, steps: &mut [HalfCycle]) {
        for _ in 0..ROUNDS {
            let Some(template) = self.template(steps) else {
                return;
            };
            let mut moved = false;
            for step in &mut *steps {
                let misfit = |shift: isize| {
                    let around = self.around(step.frame + shift, step.side)?;
                    let squares = around.iter().zip(&template).map(|(a, b)| (a - b).powi(2));
                    Some((squares.sum::<f64>(), shift))
                };
                let best = (-MOST_SHIFT..=MOST_SHIFT)
                    .filter_map(misfit)
                    .min_by(|a, b| a.0.total_cmp(&b.0));
                if let Some((_, shift)) = best
                    && shift != 0
                {
                    step.frame += shift;
                    moved = true;
                }
            }
            if !moved {
                return;
            }
        }
    }

    /// How many frames after the aligned instants the feet land.
    fn landing(&self, steps: &[HalfCycle], residual: &Residual) -> isize {
        let Some(template) = self.template(steps) else {
            return 0;
        };
        let reach = HALF_TEMPLATE.cast_signed();
        let knee = |offset: isize| template[(offset + reach) as usize * CHANNELS + 2];
        let straightest = (-reach + 2..=reach - 2)
            .min_by(|a, b| knee(*a).total_cmp(&knee(*b)))
            .unwrap_or(0);
        let offsets: Vec<isize> = (-reach - 3..=reach + 3).collect();
        let means: Vec<f64> = offsets
            .iter()
            .map(|offset| residual.mean(steps, *offset))
            .collect();
        let means = smoothed(&means, SMOOTHING);
        let landing = straightest..=straightest + LANDING_FRAMES;
        offsets
            .iter()
            .zip(&means)
            .filter(|(offset, _)| landing.contains(*offset))
            .max_by(|a, b| a.1.total_cmp(b.1))
            .map_or(straightest, |(offset, _)| *offset)
    }
}

/// The projection residual of each leg over its median.
struct Residual {
    first: isize,
    legs: [Vec<f64>; 2],
}

impl Residual {
    /// `None` for too few frames.
    fn of(angles: &LegAngles) -> Result<Option<Self>, ProbError> {
        let found = ProjectionResidual::new(angles.frames.as_flattened(), CHANNELS, WINDOW);
        let residual = match found {
            Ok(residual) => residual,
            Err(ProbError::SequenceTooShort { .. }) => return Ok(None),
            Err(error) => return Err(error),
        };
        let legs = [0, 1].map(|leg| {
            let mut norms = residual.norms_of(|channel| channel % 2 == leg);
            let level = median(&norms).max(f64::MIN_POSITIVE);
            for norm in &mut norms {
                *norm = (*norm / level).min(MOST_RESIDUAL);
            }
            norms
        });
        Ok(Some(Self {
            first: residual.first_frame().cast_signed(),
            legs,
        }))
    }

    /// The mean over all steps, so many frames after each; 0 where none is seen.
    fn mean(&self, steps: &[HalfCycle], offset: isize) -> f64 {
        let (mut sum, mut count) = (0.0, 0.0);
        for step in steps {
            let column = step.frame + offset - self.first;
            let at = |side: Side| {
                let column = usize::try_from(column).ok()?;
                self.legs[side.index()].get(column)
            };
            if let (Some(own), Some(other)) = (at(step.side), at(step.side.other())) {
                sum += (1.0 - TRAILING_SHARE) * own + TRAILING_SHARE * other;
                count += 1.0;
            }
        }
        if count > 0.0 { sum / count } else { 0.0 }
    }
}

/// Values under a Gaussian window, the ends repeated.
fn smoothed(values: &[f64], deviation: f64) -> Vec<f64> {
    let reach = (3.0 * deviation).ceil() as isize;
    let last = values.len().cast_signed() - 1;
    let weight = |offset: isize| (-0.5 * (offset as f64 / deviation).powi(2)).exp();
    let total: f64 = (-reach..=reach).map(weight).sum();
    (0..=last)
        .map(|at| {
            let sum: f64 = (-reach..=reach)
                .map(|offset| weight(offset) * values[(at + offset).clamp(0, last) as usize])
                .sum();
            sum / total
        })
        .collect()
}
