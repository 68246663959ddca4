//! Sway: offset of a standing body from its posture at a time, from octaves of sway, glances and breathing.

use super::noise::{AT_ONCE, Curves, key, normal, share};
use crate::rows::Sum as _;
use core::f32::consts::TAU;
use footfall_core::Joint;
use footfall_model::layout::feature_offset;
use footfall_model::{FEATURE_COUNT, LOOK_DIRECTIONS, SWAY_COUNT, StandingModel, SwayOctave};

/// Offsets of a body from its posture, as [`SWAY_COUNT`] has them.
pub(crate) type Sway = [f32; SWAY_COUNT];

/// Keys of the parts of a walker's chance; octaves follow the last.
const STRENGTH: u64 = 0;
const BREATH: u64 = 1;
const LOOK_TIMES: u64 = 2;
const LOOKS: u64 = 3;
const STANCE: u64 = LOOKS + LOOK_DIRECTIONS as u64;
const OCTAVES: u64 = STANCE + ROWS_AN_OCTAVE;

/// Maximum number of rows of curves in an octave.
const ROWS_AN_OCTAVE: u64 = 4;

/// Limits of people's strength and of the resting points of the gaze, standard deviations.
const MOST_STRENGTH: f32 = 1.0;
const MOST_LOOK: f32 = 2.0;

/// Length of a cell of time, in which the gaze jumps at most once, and number of cells after which it always does, so that the search for the last jump is bounded.
const LOOK_CELL_SECS: f64 = 2.5;
const LOOK_CELLS: i64 = 24;

/// Drift of the breath's phase, radians, and its time scale.
const BREATH_DRIFT: f32 = 1.0;
const BREATH_KNOT_SECS: f64 = 9.0;
/// Spread of people's breathing rates and of the depths of their breaths.
const BREATH_RATE_SPREAD: f64 = 0.1;
const BREATH_DEPTH_SPREAD: f32 = 0.2;
/// Skew of the breath: breathing in is quicker than breathing out.
const BREATH_SKEW: f32 = 0.35;

/// Standing motion of a model's people, prepared for many walkers.
#[derive(Debug)]
pub(crate) struct StandingTables {
    /// Motion of equal strength for all people.
    stance: Octave,
    octaves: Vec<Octave>,
    hips_ahead: f32,
    looks: [Sway; LOOK_DIRECTIONS],
    /// The chance of a jump in a cell, and the share of the cell that a jump takes.
    look_chance: f32,
    look_share: f32,
    breath: Sway,
    breath_rate_hz: f64,
    strength_spread: f32,
    /// Flexion of the knees, radians.
    pub(crate) knee: f32,
}

#[derive(Debug)]
struct Octave {
    knots_hz: f64,
    /// Filled up with zeros to whole rows of curves.
    directions: Vec<[Sway; AT_ONCE]>,
}

/// One walker's draw of standing motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Stander {
    number: u64,
    /// Amplitude of its motion; 1 is the average.
    strength: f32,
    breath_rate_hz: f64,
}

impl StandingTables {
    pub(crate) fn of(model: &StandingModel) -> Self {
        Self {
            stance: Octave::of(&model.stance),
            octaves: model.octaves.iter().map(Octave::of).collect(),
            hips_ahead: model.hips_ahead as f32,
            looks: core::array::from_fn(|axis| {
                let row = model.looks.directions.get(axis);
                row.map_or([0.0; SWAY_COUNT], |row| narrow(row))
            }),
            look_chance: (model.looks.rate_hz * LOOK_CELL_SECS).clamp(0.0, 1.0) as f32,
            look_share: (model.looks.shift_secs / LOOK_CELL_SECS).clamp(0.1, 1.0) as f32,
            breath: narrow(&model.breath.direction),
            breath_rate_hz: model.breath.rate_hz,
            strength_spread: model.strength_spread as f32,
            knee: {
                let knee = &model.posture[feature_offset(Joint::LeftLowerLeg)..][..3];
                knee.iter().map(|value| value * value).sum::<f64>().sqrt() as f32
            },
        }
    }

    /// Draws the standing motion of a seed; `variation` scales the differences between people.
    pub(crate) fn stander(&self, seed: u64, variation: f32) -> Stander {
        let number = key(seed, u64::from_be_bytes(*b"standing"));
        let differs = |index: i64| {
            let chance = normal(key(number, STRENGTH), index);
            variation * chance.clamp(-MOST_STRENGTH, MOST_STRENGTH)
        };
        let rate = BREATH_RATE_SPREAD * f64::from(differs(1));
        Stander {
            number,
            strength: (self.strength_spread * differs(0)).exp(),
            breath_rate_hz: self.breath_rate_hz * rate.exp(),
        }
    }

    /// Returns the offset of the body at a time, seconds from the beginning.
    pub(crate) fn at(&self, stander: &Stander, secs: f64) -> Sway {
        let mut sway = [0.0; SWAY_COUNT];
        self.stance
            .add(stander.number, STANCE, 1.0, secs, &mut sway);
        for (octave, index) in self.octaves.iter().zip(0_u64..) {
            let part = OCTAVES + ROWS_AN_OCTAVE * index;
            octave.add(stander.number, part, stander.strength, secs, &mut sway);
        }
        let [side, down] = self.look(stander, secs);
        let rows = [
            (self.looks[0].as_slice(), stander.strength.min(1.0) * side),
            (self.looks[1].as_slice(), stander.strength.min(1.0) * down),
            (self.breath.as_slice(), breath(stander, secs)),
            (self.breath.as_slice(), 0.0),
        ];
        f32::add_rows(&mut sway, rows);
        sway[FEATURE_COUNT + 1] += self.hips_ahead;
        sway
    }

    /// Returns the direction of the gaze, in standard deviations from its rest.
    fn look(&self, stander: &Stander, secs: f64) -> [f32; LOOK_DIRECTIONS] {
        let times = key(stander.number, LOOK_TIMES);
        let jumps =
            |cell: i64| cell.rem_euclid(LOOK_CELLS) == 0 || share(times, cell) < self.look_chance;
        let rest = |cell: i64| {
            // There is one within a round of cells.
            let cell = (0..LOOK_CELLS)
                .map(|back| cell - back)
                .find(|cell| jumps(*cell));
            let cell = cell.unwrap_or(0);
            core::array::from_fn(|axis| {
                let level = normal(key(stander.number, LOOKS + axis as u64), cell);
                level.clamp(-MOST_LOOK, MOST_LOOK)
            })
        };
        let time = secs / LOOK_CELL_SECS;
        let cell = time.floor() as i64;
        let before: [f32; LOOK_DIRECTIONS] = rest(cell - 1);
        if !jumps(cell) {
            return before;
        }
        let begin = (1.0 - self.look_share) * share(times ^ 1, cell);
        let part = ((time - time.floor()) as f32 - begin) / self.look_share;
        let after = rest(cell);
        let gone = least_jerk(part);
        core::array::from_fn(|axis| before[axis] + gone * (after[axis] - before[axis]))
    }
}

impl Octave {
    fn of(model: &SwayOctave) -> Self {
        let rows: Vec<Sway> = model.directions.iter().map(|row| narrow(row)).collect();
        let fours = rows.chunks(AT_ONCE).map(|rows| {
            core::array::from_fn(|row| rows.get(row).copied().unwrap_or([0.0; SWAY_COUNT]))
        });
        Self {
            knots_hz: model.knot_secs.recip(),
            directions: fours.collect(),
        }
    }

    /// Adds the walker's curves at a time; their first rows are those of `part`.
    fn add(&self, number: u64, part: u64, strength: f32, secs: f64, sway: &mut Sway) {
        let curves = Curves::at(secs * self.knots_hz);
        for (rows, row) in self.directions.iter().zip(0_u64..) {
            let values = curves.values(key(number, part + row));
            let weighted = |n: usize| (rows[n].as_slice(), strength * values[n]);
            f32::add_rows(sway, [weighted(0), weighted(1), weighted(2), weighted(3)]);
        }
    }
}

/// Returns the minimum-jerk curve from 0 at 0 to 1 at 1 (Flash and Hogan 1985).
fn least_jerk(s: f32) -> f32 {
    let s = s.clamp(0.0, 1.0);
    s * s * s * (10.0 + s * (6.0 * s - 15.0))
}

/// Returns the filling of the chest: 1 at the top of a usual breath, -1 when empty.
fn breath(stander: &Stander, secs: f64) -> f32 {
    let [drift, depth, ..] =
        Curves::at(secs / BREATH_KNOT_SECS).values(key(stander.number, BREATH));
    let cycles = (secs * stander.breath_rate_hz).fract() as f32;
    let angle = TAU * cycles + BREATH_DRIFT * drift;
    (1.0 + BREATH_DEPTH_SPREAD * depth) * (angle - BREATH_SKEW * angle.sin()).cos()
}

fn narrow(row: &[f64]) -> Sway {
    core::array::from_fn(|n| row.get(n).map_or(0.0, |value| *value as f32))
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use footfall_model::{Breath, Looks};

    /// Weight that goes from leg to leg, a trunk that trembles, and a head that looks about.
    pub(in crate::standing) fn model() -> StandingModel {
        let row = |numbers: &[(usize, f64)]| {
            let mut row = vec![0.0; SWAY_COUNT];
            for (number, value) in numbers {
                row[*number] = *value;
            }
            row
        };
        StandingModel {
            posture: vec![0.0; FEATURE_COUNT],
            hips_ahead: 0.05,
            stance: SwayOctave {
                knot_secs: 24.0,
                directions: vec![row(&[(0, 0.01)])],
            },
            octaves: vec![
                SwayOctave {
                    knot_secs: 3.0,
                    directions: vec![row(&[(FEATURE_COUNT, 0.02), (1, 0.02)])],
                },
                SwayOctave {
                    knot_secs: 0.5,
                    directions: vec![row(&[(3, 0.004)]); 5],
                },
            ],
            looks: Looks {
                rate_hz: 0.15,
                shift_secs: 1.0,
                directions: vec![row(&[(16, 0.2)]), row(&[(15, 0.05)])],
            },
            breath: Breath {
                rate_hz: 0.25,
                direction: row(&[(9, -0.01)]),
            },
            strength_spread: 0.4,
        }
    }

    fn series(seed: u64, number: usize) -> Vec<f32> {
        let tables = StandingTables::of(&model());
        let stander = tables.stander(seed, 0.0);
        (0..40_000)
            .map(|frame| tables.at(&stander, f64::from(frame) * 0.05)[number])
            .collect()
    }

    #[test]
    fn sway_has_the_deviations_of_the_model() {
        let deviation = |values: &[f32]| {
            let squares: f32 = values.iter().map(|value| value * value).sum();
            (squares / values.len() as f32).sqrt()
        };
        let found = deviation(&series(4, FEATURE_COUNT));
        assert!((found / 0.02 - 1.0).abs() < 0.1, "{found}");
        let found = deviation(&series(4, 3));
        assert!(
            (found / (0.004 * 5.0_f32.sqrt()) - 1.0).abs() < 0.1,
            "{found}"
        );
        // Looks rest where a normal number has them, cut off at two deviations.
        let found = deviation(&series(4, 16));
        assert!((0.15..0.21).contains(&found), "{found}");
    }

    #[test]
    fn a_gaze_rests_and_jumps() {
        let yaw = series(11, 16);
        let still = yaw
            .windows(2)
            .filter(|pair| (pair[1] - pair[0]).abs() < 1e-5);
        let resting = still.count() as f32 / yaw.len() as f32;
        assert!((0.7..0.95).contains(&resting), "{resting}");
        // No jump within a frame: a radian in a second goes no faster than its least jerk.
        let fastest = yaw.windows(2).map(|pair| (pair[1] - pair[0]).abs());
        assert!(fastest.fold(0.0, f32::max) < 0.05 * 1.9 * 4.0 * 0.2);
    }

    #[test]
    fn breaths_come_at_their_rate_and_never_quite_alike() {
        let full = series(5, 9);
        let rises = full
            .windows(2)
            .filter(|pair| pair[0] > 0.0 && pair[1] <= 0.0);
        let rate = rises.count() as f32 / (40_000.0 * 0.05);
        assert!((rate - 0.25).abs() < 0.02, "{rate}");
        let seconds = |from: usize| &full[from..from + 400];
        let apart = seconds(0)
            .iter()
            .zip(seconds(4000))
            .map(|(a, b)| (a - b).abs());
        assert!(apart.fold(0.0, f32::max) > 2e-3);
    }

    #[test]
    fn nothing_comes_back() {
        // Correlation with itself a while ago: high at first, then none that would show.
        let values = series(8, FEATURE_COUNT);
        let power: f32 = values.iter().map(|value| value * value).sum();
        let with_itself = |lag: usize| {
            let pairs = values.iter().zip(&values[lag..]);
            pairs.map(|(a, b)| a * b).sum::<f32>() / power
        };
        assert!(with_itself(5) > 0.9);
        let most = (400..20_000)
            .step_by(7)
            .map(with_itself)
            .fold(0.0, f32::max);
        assert!(most < 0.25, "{most}");
    }

    #[test]
    fn seeds_differ_and_each_is_itself() {
        let tables = StandingTables::of(&model());
        let [one, other] = [1, 2].map(|seed| tables.stander(seed, 1.0));
        assert!(one.strength.ln().abs() <= 0.4 && one != other);
        let at = |stander: &Stander| tables.at(stander, 12.5).map(f32::to_bits);
        assert_eq!(at(&one), at(&tables.stander(1, 1.0)));
        assert_ne!(at(&one), at(&other));
    }
}
