//! Mean jump of a model: postures over time, by rise and way.
//!
//! Push-off, flight and absorption go through the model's knots at the pace of the recordings. Dip and recovery take a fraction of
//! the recorded time, in which every hesitation of the mean would be a jerk: of those only the simplest course remains.

use super::{ABSORPTION, DIP, PUSH, RECOVERY, Timing};
use crate::gait::Posture;
use crate::moves::body::Beside;
use footfall_core::Pose;
use footfall_core::ease::{hermite, hump};
use footfall_model::{BESIDE_COUNT, JUMP_PHASES, JUMP_RESPONSES, JumpModel, layout};

/// Durations of dip and recovery, seconds: recorded ones are slow, players are impatient.
const DIP_SECS: [f32; 2] = [0.15, 0.32];
const RECOVERY_SECS: [f32; 2] = [0.42, 0.5];

/// Minimum durations of push-off and absorption, seconds.
pub(super) const LEAST_SECS: f32 = 0.08;

/// Jumps of a model, prepared.
#[derive(Clone, Debug)]
pub(crate) struct JumpTables {
    /// Standing posture of the model's people.
    pub(super) standing: Pose,
    secs: [[f32; JUMP_RESPONSES]; JUMP_PHASES],
    /// Rises and ways of the recorded jumps: least, mean and most, leg lengths.
    pub(super) rise: [f32; 3],
    way: [f32; 3],
    /// Knots of all phases; knots between two phases occur once.
    knots: Vec<[Beside; JUMP_RESPONSES]>,
    /// First knot of each phase, and the last knot.
    pub(super) begins: [usize; JUMP_PHASES + 1],
    /// Bulges of dip and recovery: their detours between the ends.
    bulges: [[Beside; JUMP_RESPONSES]; 2],
}

impl JumpTables {
    pub(in crate::moves) fn of(model: &JumpModel, standing: &Posture) -> Self {
        let mut upright = Pose::default();
        layout::decode(standing, &mut upright.rotations);
        let row = |values: &Vec<f64>| -> Beside { core::array::from_fn(|at| values[at] as f32) };
        let mut knots = Vec::new();
        let mut begins = [0; JUMP_PHASES + 1];
        for (index, phase) in model.phases.iter().enumerate() {
            let shared = usize::from(index > 0);
            knots.extend(
                phase
                    .knots
                    .iter()
                    .skip(shared)
                    .map(|knot| knot.each_ref().map(row)),
            );
            begins[index + 1] = knots.len() - 1;
        }
        let mut tables = Self {
            standing: upright,
            secs: model
                .phases
                .each_ref()
                .map(|phase| phase.secs.map(|secs| secs as f32)),
            rise: model.rise.map(|rise| rise as f32),
            way: model.way.map(|way| way as f32),
            knots,
            begins,
            bulges: [[[0.0; BESIDE_COUNT]; JUMP_RESPONSES]; 2],
        };
        tables.bulges = [DIP, RECOVERY].map(|phase| tables.fit_bulges(phase));
        tables
    }

    /// Returns the deviation of a jump of this rise and way, in leg lengths, from the mean jump: the factors of the slopes.
    pub(super) fn factors(&self, rise: f32, way: f32) -> [f32; JUMP_RESPONSES] {
        let deviation = |value: f32, [least, mean, most]: [f32; 3]| value.clamp(least, most) - mean;
        [1.0, deviation(rise, self.rise), deviation(way, self.way)]
    }

    /// Returns the duration of a phase, seconds.
    pub(super) fn secs(&self, phase: usize, factors: [f32; JUMP_RESPONSES]) -> f32 {
        let secs = sum(&self.secs[phase], factors);
        match phase {
            DIP => secs.clamp(DIP_SECS[0], DIP_SECS[1]),
            RECOVERY => secs.clamp(RECOVERY_SECS[0], RECOVERY_SECS[1]),
            _ => secs.max(LEAST_SECS),
        }
    }

    /// Returns a value of a knot's posture.
    pub(super) fn number(&self, knot: usize, factors: [f32; JUMP_RESPONSES], dim: usize) -> f32 {
        sum(&self.knots[knot].each_ref().map(|row| row[dim]), factors)
    }

    /// Returns the posture at part `s` of a phase, for these durations.
    pub(super) fn beside(&self, phase: usize, s: f32, timing: &Timing) -> Beside {
        let s = s.clamp(0.0, 1.0);
        match phase {
            DIP => self.simplest(phase, &self.bulges[0], s, timing),
            RECOVERY => self.simplest(phase, &self.bulges[1], s, timing),
            _ => self.through_knots(phase, s, timing),
        }
    }

    /// Returns the posture of the simplest course of a phase between standing and its neighbour, with a bulge.
    fn simplest(
        &self,
        phase: usize,
        bulge: &[Beside; JUMP_RESPONSES],
        s: f32,
        timing: &Timing,
    ) -> Beside {
        core::array::from_fn(|dim| {
            let number = |knot: usize| timing.scale * self.number(knot, timing.factors, dim);
            let bulge = timing.scale * sum(&bulge.each_ref().map(|row| row[dim]), timing.factors);
            self.simplest_number(phase, s, &timing.secs, number) + bulge * bulging(s)
        })
    }

    /// Returns a number of the simplest course of dip or recovery: a cubic that is at rest where the body stands and passes on its rate where it is lowest.
    fn simplest_number(
        &self,
        phase: usize,
        s: f32,
        secs: &[f32; JUMP_PHASES],
        number: impl Fn(usize) -> f32,
    ) -> f32 {
        let [from, to] = [self.begins[phase], self.begins[phase + 1]].map(&number);
        let rates = if phase == DIP {
            [0.0, self.end_rate(PUSH, secs, number)]
        } else {
            [self.end_rate(ABSORPTION, secs, number), 0.0]
        };
        let [departure, arrival] = rates.map(|rate| secs[phase] * rate);
        hermite(from, departure, to, arrival, s)
    }

    /// Returns the rate a second at which push-off begins or absorption ends: that of a parabola through the three knots there.
    fn end_rate(
        &self,
        phase: usize,
        secs: &[f32; JUMP_PHASES],
        number: impl Fn(usize) -> f32,
    ) -> f32 {
        let [begin, end] = [self.begins[phase], self.begins[phase + 1]];
        let spacing = secs[phase] / (end - begin) as f32;
        let (at, next, after, sign) = if phase == PUSH {
            (begin, begin + 1, begin + 2, 1.0)
        } else {
            (end, end - 1, end - 2, -1.0)
        };
        let once = number(next) - number(at);
        // A phase of two knots is a straight line.
        let bend = if end - begin > 1 {
            number(after) - number(next) - once
        } else {
            0.0
        };
        sign * (once - 0.5 * bend) / spacing
    }

    /// Fits the bulges of dip or recovery to the knots, by least squares. The course between the ends depends on the pace, so it is that of the jump, not
    /// that of the recordings.
    fn fit_bulges(&self, phase: usize) -> [Beside; JUMP_RESPONSES] {
        let secs = core::array::from_fn(|phase| self.secs(phase, [1.0, 0.0, 0.0]));
        let (begin, count) = (
            self.begins[phase],
            self.begins[phase + 1] - self.begins[phase],
        );
        core::array::from_fn(|response| {
            core::array::from_fn(|dim| {
                let number = |knot: usize| self.knots[knot][response][dim];
                let (mut along, mut norm) = (0.0, 0.0);
                for knot in 0..=count {
                    let s = knot as f32 / count as f32;
                    let beyond =
                        number(begin + knot) - self.simplest_number(phase, s, &secs, number);
                    along += bulging(s) * beyond;
                    norm += bulging(s) * bulging(s);
                }
                along / norm.max(f32::MIN_POSITIVE)
            })
        })
    }

    /// Returns the posture of a cubic curve through the knots of a phase.
    fn through_knots(&self, phase: usize, s: f32, timing: &Timing) -> Beside {
        let Timing {
            factors,
            scale,
            secs,
        } = timing;
        let count = self.begins[phase + 1] - self.begins[phase];
        let position = s * count as f32;
        let within = (position as usize).min(count - 1);
        let knot = self.begins[phase] + within;
        let spacing =
            |phase: usize| secs[phase] / (self.begins[phase + 1] - self.begins[phase]) as f32;
        let here = spacing(phase);
        // Ratios of the rates of the neighbouring knots to the rate of these.
        let departure = if within > 0 {
            0.5
        } else {
            here / (here + spacing(phase - 1))
        };
        let arrival = if within + 1 < count {
            0.5
        } else {
            here / (here + spacing(phase + 1))
        };
        core::array::from_fn(|dim| {
            let at = |knot: usize| scale * self.number(knot, *factors, dim);
            let (from, to) = (at(knot), at(knot + 1));
            let departure = if phase == PUSH && within == 0 {
                here * self.end_rate(PUSH, secs, at)
            } else {
                departure * (to - at(knot - 1))
            };
            let arrival = if phase == ABSORPTION && within + 1 == count {
                here * self.end_rate(ABSORPTION, secs, at)
            } else {
                arrival * (at(knot + 2) - from)
            };
            hermite(from, departure, to, arrival, position - within as f32)
        })
    }
}

/// Returns a mean and its slopes, each by its factor.
fn sum(responses: &[f32; JUMP_RESPONSES], factors: [f32; JUMP_RESPONSES]) -> f32 {
    responses
        .iter()
        .zip(factors)
        .map(|(value, factor)| value * factor)
        .sum()
}

/// Returns the height of a bulge at part `s` of a phase: at rest at both ends, a sixteenth in the middle.
pub(super) fn bulging(s: f32) -> f32 {
    hump(s) / 16.0
}
