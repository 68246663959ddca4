//! Landings by where hip and knee angles put the ankles.

use super::angles::{HalfCycle, LegAngles, greatest};
use super::{ANGLE_RATE_HZ, SwitchConfig, beside};
use footfall_core::Side;

/// Standard deviation of the window under which extremes of ankle and knee are looked for, frames.
const SMOOTHING: f64 = 1.0;

/// Frames around the greatest distance of the ankles within which an ankle is farthest ahead, or behind.
const ANKLE_REACH: usize = 12;

/// Frames before and after that in which the landing knee is straightest. A straight knee at other times is that of a
/// leg that stands.
const KNEE_REACH: [usize; 2] = [5, 3];

/// Frames before the ankle is farthest ahead within which a swinging knee is bent most.
const BEND_REACH: usize = 30;

/// Bend of a swinging knee in a walk, radians: 60°.
const WALKING_BEND_RAD: f64 = 1.047;

/// Standard deviation of the window under which heights of the ankles are compared, frames.
const LIFT_SMOOTHING: f64 = 1.5;

/// A leg that swings lifts its ankle at least this much above the other's, on average over the middle of the half cycle, metres on the
/// canonical body. Of 2952 half cycles of forward walks and runs one in a hundred lifts it less than 40 mm.
const LEAST_LIFT_M: f64 = 0.01;

/// A half cycle is one of the same walk as the one before when it is no longer, frames.
const LONGEST_HALF_CYCLE: usize = 60;

/// One landing.
#[derive(Clone, Copy, Debug)]
pub(super) struct Landed {
    /// The leg that lands.
    pub(super) side: Side,
    /// Frame in which the ankles are farthest apart, for a leg that lands beside the other that of [`Self::by_legs`].
    pub(super) half_cycle: f64,
    /// Frame by the place of the ankles.
    pub(super) by_legs: f64,
}

/// Ankles and knees over time.
pub(super) struct Legs {
    /// Distance of each ankle ahead of its hip.
    ahead: [Vec<f64>; 2],
    /// Straightness of each knee: less when it is bent.
    straight: [Vec<f64>; 2],
    /// Height of the left ankle above the right one.
    pub(super) lift: Vec<f64>,
    /// Speed of the ankles against each other, m/s.
    pub(super) speed: Vec<f64>,
    /// Size of the body: 1 for the canonical one.
    pub(super) size: f64,
}

/// The landings of all swings, in the order of their frames by the ankles.
pub(super) fn landings(angles: &LegAngles, config: &SwitchConfig) -> Vec<Landed> {
    let legs = Legs::of(angles);
    let cycles = angles.half_cycles();
    let mut landings: Vec<Landed> = (0..cycles.len())
        .filter_map(|index| legs.of_half_cycle(&cycles, index, config))
        .collect();
    beside::add_to(&mut landings, &legs);
    landings.sort_by(|a, b| a.by_legs.total_cmp(&b.by_legs));
    landings
}

impl Legs {
    fn of(angles: &LegAngles) -> Self {
        let between = |deviation: f64, axis: usize| {
            angles.smoothed(deviation, |frame| angles.between_ankles(frame)[axis])
        };
        let [x, y] = [0, 1].map(|axis| between(SMOOTHING, axis));
        let last = x.len().saturating_sub(1);
        let speed = (0..x.len()).map(|frame| {
            let (from, to) = (frame.saturating_sub(1), (frame + 1).min(last));
            (x[to] - x[from]).hypot(y[to] - y[from]) * ANGLE_RATE_HZ / (to - from).max(1) as f64
        });
        Self {
            ahead: Side::BOTH
                .map(|side| angles.smoothed(SMOOTHING, |frame| angles.ankle(frame, side)[0])),
            straight: Side::BOTH
                .map(|side| angles.smoothed(SMOOTHING, |frame| -angles.knee(frame, side))),
            speed: speed.collect(),
            lift: between(LIFT_SMOOTHING, 1),
            size: angles.size,
        }
    }

    /// The landing at the end of a half cycle. `None` if neither leg is lifted, as in swaying.
    ///
    /// The lifted leg swings. Where that is the leg ahead it lands ahead; else the body walks backwards, and the other leg lands behind.
    /// The first half cycle goes the way of the second.
    fn of_half_cycle(
        &self,
        cycles: &[HalfCycle],
        index: usize,
        config: &SwitchConfig,
    ) -> Option<Landed> {
        let HalfCycle { frame, side } = cycles[index];
        let least = LEAST_LIFT_M * self.size;
        let lift = self.lift_into(cycles, index);
        if lift.is_some_and(|lift| lift.abs() < least) {
            return None;
        }
        let lift = lift.or_else(|| self.lift_into(cycles, index + 1));
        let (side, by_legs) = if lift.is_some_and(|lift| lift < -least) {
            (side.other(), self.behind(side.other(), frame, config))
        } else {
            (side, self.ahead(side, frame, config))
        };
        Some(Landed {
            side,
            half_cycle: frame as f64,
            by_legs,
        })
    }

    /// Mean height of the leg ahead above the other on the way into a half cycle, if it follows one of the same walk.
    fn lift_into(&self, cycles: &[HalfCycle], index: usize) -> Option<f64> {
        let cycle = cycles.get(index)?;
        let before = cycles.get(index.checked_sub(1)?)?;
        let walked = before.side != cycle.side && cycle.frame - before.frame <= LONGEST_HALF_CYCLE;
        walked.then(|| self.mean_lift(cycle.side, before.frame, cycle.frame))
    }

    /// Height of an ankle above the other in the middle half of these frames.
    fn mean_lift(&self, side: Side, first: usize, last: usize) -> f64 {
        let margin = (last - first) / 4;
        let middle = &self.lift[first + margin..=last - margin];
        f64::from(side.sign()) * middle.iter().sum::<f64>() / middle.len() as f64
    }

    /// Landing of a leg ahead: halfway between its ankle farthest ahead and its knee straightest, and later after a swing with
    /// the knee bent more, as in runs.
    fn ahead(&self, side: Side, around: usize, config: &SwitchConfig) -> f64 {
        let straight = &self.straight[side.index()];
        let farthest = greatest(&self.ahead[side.index()], around, [ANKLE_REACH; 2]);
        let near = farthest.round() as usize;
        let straightest = greatest(straight, near, KNEE_REACH);
        let swing = &straight[near.saturating_sub(BEND_REACH)..=near];
        let bend = -swing.iter().copied().fold(f64::INFINITY, f64::min);
        let secs = config.landing_secs + config.bend_secs_per_rad * (bend - WALKING_BEND_RAD);
        0.5 * (farthest + straightest) + secs * ANGLE_RATE_HZ
    }

    /// Landing of a leg behind: its toes reach the ground before its ankle is farthest behind.
    fn behind(&self, side: Side, around: usize, config: &SwitchConfig) -> f64 {
        let behind: Vec<f64> = self.ahead[side.index()].iter().map(|x| -x).collect();
        greatest(&behind, around, [ANKLE_REACH; 2]) - config.behind_secs * ANGLE_RATE_HZ
    }
}
