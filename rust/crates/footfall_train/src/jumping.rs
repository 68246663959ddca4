//! Two-footed jumps, as a part of a gait model.

use crate::beside::{Arms, Upright, symmetric};
use footfall_core::Clip;
use footfall_core::ease::smooth_step;
use footfall_core::rotation::from_heading;
use footfall_core::{Joint, rotation};
use footfall_model::{
    BESIDE_COUNT, JUMP_PHASES, JUMP_RESPONSES, JumpModel, JumpPhase, StandingModel,
};
use footfall_motion::jumps::{Jump, two_footed_jumps};
use glam::Vec3;

/// Knots of the phases: about one in 50 milliseconds.
const KNOTS: [usize; JUMP_PHASES] = [9, 7, 8, 4, 7];

/// Fewer jumps show no slope.
const LEAST_JUMPS: usize = 3;

/// Cost of a slope, as a share of the spread of rises and ways: with a dozen jumps chance makes slopes, too.
const RIDGE: f64 = 0.15;

/// Jumping as learned, and the amount of data behind it.
#[derive(Clone, Debug)]
pub struct LearnedJumping {
    /// The section of a model.
    pub model: JumpModel,
    /// Number of jumps.
    pub jumps: usize,
}

/// One recorded jump.
struct Sample {
    /// Weight: jumps of one recording share that of one jump, for they are the manner of one person.
    weight: f64,
    rise: f64,
    way: f64,
    /// Durations of the phases, seconds.
    secs: [f64; JUMP_PHASES],
    /// Phase by phase, knot by knot.
    knots: [Vec<Vec<f64>>; JUMP_PHASES],
}

/// Learns how people jump off both feet; each clip comes with its leading frames to leave out. `None` when they make fewer than three such jumps.
///
/// Postures are compared with the same person's before and after the jump. Arms are in between compared with those of `standing`, from which the model jumps, if it has learned to stand.
pub fn learn(clips: &[(&Clip, usize)], standing: Option<&StandingModel>) -> Option<LearnedJumping> {
    let arms = standing.map(Arms::of);
    let samples: Vec<Sample> = clips
        .iter()
        .flat_map(|(clip, skip)| {
            let jumps = two_footed_jumps(clip, *skip);
            let weight = 1.0 / jumps.len() as f64;
            jumps
                .into_iter()
                .map(|jump| Sample::new(clip, &jump, weight, arms.as_ref()))
                .collect::<Vec<_>>()
        })
        .collect();
    if samples.len() < LEAST_JUMPS {
        return None;
    }
    let range = |value: fn(&Sample) -> f64| {
        let values = || samples.iter().map(value);
        let least = values().fold(f64::INFINITY, f64::min);
        let most = values().fold(f64::NEG_INFINITY, f64::max);
        [least, mean(&samples, value), most]
    };
    let (rise, way) = (range(|sample| sample.rise), range(|sample| sample.way));
    let regression = Regression::new(&samples, rise[1], way[1]);
    let phases = core::array::from_fn(|phase| JumpPhase {
        secs: regression.fit(|sample| sample.secs[phase]),
        knots: (0..KNOTS[phase])
            .map(|knot| {
                let fits: Vec<[f64; JUMP_RESPONSES]> = (0..BESIDE_COUNT)
                    .map(|dim| regression.fit(|sample| sample.knots[phase][knot][dim]))
                    .collect();
                core::array::from_fn(|response| fits.iter().map(|fit| fit[response]).collect())
            })
            .collect(),
    });
    Some(LearnedJumping {
        model: JumpModel { phases, rise, way },
        jumps: samples.len(),
    })
}

impl Sample {
    fn new(clip: &Clip, jump: &Jump, weight: f64, arms: Option<&Arms>) -> Self {
        let leg = clip.skeleton.mean_leg_length();
        let posture = |time: f64| {
            let pose = clip.pose_at(time).unwrap_or_default();
            Upright::new(&clip.skeleton, &pose)
        };
        let time = |frame: usize| frame as f64 / clip.frame_rate_hz;
        let times = [
            jump.begin,
            jump.push,
            jump.take_off,
            jump.landing,
            jump.lowest,
            jump.end,
        ];
        let times = times.map(time);
        let (landing, end) = (times[3], times[5]);
        let (before, after) = (posture(times[0]), posture(end));
        let knots = core::array::from_fn(|phase| {
            (0..KNOTS[phase])
                .map(|knot| {
                    let share = knot as f64 / (KNOTS[phase] - 1) as f64;
                    let time = times[phase] + share * (times[phase + 1] - times[phase]);
                    // Who has landed stands a little otherwise than before.
                    let landed = (time - landing) / (end - landing);
                    let mut standing = before.towards(&after, smooth_step(landed as f32));
                    if let Some(arms) = arms {
                        standing.carry_arms(arms, carried(phase, share as f32));
                    }
                    symmetric(&posture(time).beside(&standing, leg))
                })
                .collect()
        });
        let hips = |frame: usize| clip.poses[frame].root_position;
        let apex = (jump.take_off..=jump.landing)
            .map(|frame| hips(frame).y)
            .fold(0.0, f32::max);
        let faced = rotation::heading(clip.poses[jump.begin].rotation(Joint::Hips));
        let way = (hips(jump.end) - hips(jump.begin)).dot(from_heading(faced) * Vec3::Z);
        Self {
            weight,
            rise: f64::from((apex - hips(jump.begin).y) / leg),
            way: f64::from(way / leg),
            secs: core::array::from_fn(|phase| times[phase + 1] - times[phase]),
            knots,
        }
    }
}

/// Returns how far arms are compared with the model's at part `share` of a phase: not at all where the jump begins and ends, for there the model stands.
fn carried(phase: usize, share: f32) -> f32 {
    if phase == 0 {
        smooth_step(share)
    } else if phase + 1 == JUMP_PHASES {
        1.0 - smooth_step(share)
    } else {
        1.0
    }
}

/// Weighted mean of a value.
fn mean(samples: &[Sample], value: impl Fn(&Sample) -> f64) -> f64 {
    let weights = samples.iter().map(|sample| sample.weight).sum::<f64>();
    let values = samples.iter().map(|sample| sample.weight * value(sample));
    values.sum::<f64>() / weights
}

/// Weighted least squares on rise and way, with a ridge.
struct Regression<'a> {
    samples: &'a [Sample],
    /// Deviations from the means.
    rises: Vec<f64>,
    ways: Vec<f64>,
    /// Of the normal equations: rise by rise, rise by way, way by way.
    products: [f64; 3],
}

impl<'a> Regression<'a> {
    fn new(samples: &'a [Sample], rise: f64, way: f64) -> Self {
        let rises: Vec<f64> = samples.iter().map(|sample| sample.rise - rise).collect();
        let ways: Vec<f64> = samples.iter().map(|sample| sample.way - way).collect();
        let products = [(&rises, &rises), (&rises, &ways), (&ways, &ways)];
        Self {
            products: products.map(|(a, b)| product(samples, a, b)),
            samples,
            rises,
            ways,
        }
    }

    /// Mean and slopes of a value.
    fn fit(&self, value: impl Fn(&Sample) -> f64) -> [f64; JUMP_RESPONSES] {
        let mean = mean(self.samples, &value);
        let deviations: Vec<f64> = self.samples.iter().map(|s| value(s) - mean).collect();
        let by = |deviating: &[f64]| product(self.samples, deviating, &deviations);
        let (by_rise, by_way) = (by(&self.rises), by(&self.ways));
        let [rise, both, way] = self.products;
        let (rise, way) = ((1.0 + RIDGE) * rise, (1.0 + RIDGE) * way);
        let determinant = rise * way - both * both;
        if determinant <= f64::EPSILON {
            return [mean, 0.0, 0.0];
        }
        [
            mean,
            (way * by_rise - both * by_way) / determinant,
            (rise * by_way - both * by_rise) / determinant,
        ]
    }
}

/// Weighted sum of the products of two values of each sample.
fn product(samples: &[Sample], a: &[f64], b: &[f64]) -> f64 {
    let pairs = a.iter().zip(b).zip(samples);
    pairs.map(|((a, b), sample)| sample.weight * a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample(rise: f64, way: f64, secs: f64, weight: f64) -> Sample {
        Sample {
            weight,
            rise,
            way,
            secs: [secs; JUMP_PHASES],
            knots: core::array::from_fn(|_| Vec::new()),
        }
    }

    fn fit(samples: &[Sample]) -> [f64; JUMP_RESPONSES] {
        let rise = mean(samples, |sample| sample.rise);
        let way = mean(samples, |sample| sample.way);
        Regression::new(samples, rise, way).fit(|sample| sample.secs[0])
    }

    #[test]
    fn a_weight_of_two_is_a_sample_that_occurs_twice() {
        let rows = [
            (0.2, 0.0, 0.5),
            (0.3, 1.0, 0.7),
            (0.5, 0.4, 0.4),
            (0.4, 1.2, 0.9),
        ];
        let heavy = |(at, (rise, way, secs)): (usize, (f64, f64, f64))| {
            sample(rise, way, secs, if at == 1 { 2.0 } else { 1.0 })
        };
        let weighted: Vec<Sample> = rows.into_iter().enumerate().map(heavy).collect();
        let repeated: Vec<Sample> = [0, 1, 1, 2, 3]
            .map(|at: usize| rows[at])
            .map(|(rise, way, secs)| sample(rise, way, secs, 1.0))
            .into();
        for (weighted, repeated) in fit(&weighted).into_iter().zip(fit(&repeated)) {
            assert!((weighted - repeated).abs() < 1e-12, "{weighted} {repeated}");
        }
    }
}
