//! Outcome of a climb, and its faults.

use super::way::STEPS;
use glam::Vec3;
use std::fmt;

/// Failures that end a climb early.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Failure {
    /// A foot that the animation puts down is locked to nothing.
    GroundLost,
    /// An ankle is higher than its hip joint.
    FootAboveHip,
    /// A point of a sole is inside a step.
    Inside,
    /// The body is in the ground, or far above it.
    BodyLeft,
    /// No point of a locked sole is at the ground.
    OffGround,
    /// It does not arrive.
    Stuck,
}

/// A failure, where and when.
#[derive(Clone, Copy, Debug)]
pub struct Fault {
    /// The kind.
    pub failure: Failure,
    /// After so many seconds.
    pub secs: f32,
    /// Position of the hips.
    pub hips: Vec3,
    /// Severity, in the failure's own measure.
    pub measure: f32,
}

/// Observations of a climb.
#[derive(Clone, Debug, Default)]
pub struct Outcome {
    /// The first failure of every kind.
    pub faults: Vec<Fault>,
    /// Accelerations of the hips against gravity, m/s².
    pub lift: Vec<f32>,
    /// The same between the first edge and the last.
    pub lift_between: Vec<f32>,
    /// Accelerations of the hips, m/s².
    pub acceleration: Vec<f32>,
    /// Fastest that the stillest of the points on which a locked sole stands moved along the ground, m/s.
    pub slip: f32,
    /// Highest angular acceleration of a knee, rad/s².
    pub knee: f32,
    /// Farthest that an ankle jumped beyond how it moved the frame before, metres.
    pub jump: f32,
    /// Duration, seconds.
    pub secs: f32,
    /// Number of steps on the way.
    pub steps: usize,
    /// Speed of the hips over the ground between the first edge and the last, m/s.
    pub pace_mps: f32,
    /// Every landing of a foot.
    pub landings: Vec<Landed>,
    /// Longest part of a sole that lay on the ground with nothing under it, metres.
    pub overhang: f32,
    /// Greatest bend of a knee, radians.
    pub bend: f32,
}

/// A foot that has just been locked to the ground.
#[derive(Clone, Copy, Debug)]
pub struct Landed {
    /// Time since the start, seconds.
    pub secs: f32,
    /// The ground under the ankle of the flat foot, in the world, metres.
    pub sole: Vec3,
}

impl Outcome {
    /// Treads that each step on a staircase went up or down, from one landing to the next: of steps that begin or end on it.
    pub fn treads(&self, rise_m: f32) -> impl Iterator<Item = i32> + '_ {
        let tread = move |landed: &Landed| (landed.sole.y / rise_m).round() as i32;
        let pairs = self.landings.windows(2);
        pairs.filter_map(move |pair| {
            let [from, to] = [tread(&pair[0]), tread(&pair[1])];
            let on = |tread: i32| (1..STEPS as i32).contains(&tread);
            (on(from) || on(to)).then_some(to - from)
        })
    }
}

impl fmt::Display for Outcome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for fault in &self.faults {
            write!(
                f,
                "{:?} {:.3} at {:.2} s {:.2}; ",
                fault.failure, fault.measure, fault.secs, fault.hips
            )?;
        }
        write!(
            f,
            "lift 99 %: {:.1}, all: {:.1}, slip {:.4}, knee {:.0}, jump {:.3}, {:.1} s, {} steps",
            percentile(&self.lift, 0.99),
            percentile(&self.acceleration, 0.99),
            self.slip,
            self.knee,
            self.jump,
            self.secs,
            self.steps
        )
    }
}

/// The value below which this share of all lies.
pub fn percentile(values: &[f32], share: f32) -> f32 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f32::total_cmp);
    let last = sorted.len().saturating_sub(1);
    sorted
        .get((share * last as f32).round() as usize)
        .copied()
        .unwrap_or(0.0)
}
