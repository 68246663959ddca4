//! Two-footed jumps, as a part of a gait model.

use crate::beside::{Upright, symmetric};
use footfall_core::Clip;
use footfall_core::ease::smooth_step;
use footfall_core::rotation::from_heading;
use footfall_core::{Joint, rotation};
use footfall_model::{BESIDE_COUNT, JUMP_PHASES, JUMP_RESPONSES, JumpModel, JumpPhase};
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
    rise: f64,
    way: f64,
    /// Durations of the phases, seconds.
    secs: [f64; JUMP_PHASES],
    /// Phase by phase, knot by knot.
    knots: [Vec<Vec<f64>>; JUMP_PHASES],
}

/// Learns how people jump off both feet; each clip comes with its leading frames to leave out. `None` when they make fewer than three such jumps.
pub fn learn(clips: &[(&Clip, usize)]) -> Option<LearnedJumping> {
    let samples: Vec<Sample> = clips
        .iter()
        .flat_map(|(clip, skip)| {
            let jumps = two_footed_jumps(clip, *skip);
            jumps.into_iter().map(|jump| Sample::new(clip, &jump))
        })
        .collect();
    if samples.len() < LEAST_JUMPS {
        return None;
    }
    let range = |value: fn(&Sample) -> f64| {
        let values = || samples.iter().map(value);
        let least = values().fold(f64::INFINITY, f64::min);
        let most = values().fold(f64::NEG_INFINITY, f64::max);
        let mean = values().sum::<f64>() / samples.len() as f64;
        [least, mean, most]
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
    fn new(clip: &Clip, jump: &Jump) -> Self {
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
                    let standing = before.towards(&after, smooth_step(landed as f32));
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
            rise: f64::from((apex - hips(jump.begin).y) / leg),
            way: f64::from(way / leg),
            secs: core::array::from_fn(|phase| times[phase + 1] - times[phase]),
            knots,
        }
    }
}

/// Least squares on rise and way, with a ridge.
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
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let products = [dot(&rises, &rises), dot(&rises, &ways), dot(&ways, &ways)];
        Self {
            samples,
            rises,
            ways,
            products,
        }
    }

    /// Mean and slopes of a value.
    fn fit(&self, value: impl Fn(&Sample) -> f64) -> [f64; JUMP_RESPONSES] {
        let values: Vec<f64> = self.samples.iter().map(value).collect();
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        let dot = |a: &[f64]| a.iter().zip(&values).map(|(a, v)| a * (v - mean)).sum();
        let (by_rise, by_way): (f64, f64) = (dot(&self.rises), dot(&self.ways));
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
