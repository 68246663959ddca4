//! A walk of the switching model: two systems take turns, each from a state in which a recorded segment began (*Gait as a switching
//! dynamical system*, section 4).

use crate::error::SynthError;
use crate::plan::StepPlan;
use crate::planting::StepTiming;
use crate::walk::{SynthesizedWalk, WalkConfig, put_on_ground};
use footfall_core::{Side, Skeleton};
use footfall_model::{DynamicsModel, Regime};
use footfall_prob::subspace::AffineSystem;
use rand::{RngExt as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution as _, Normal};

/// A segment begins where one of so many nearest recorded ones began: the pose goes on, and still varies.
const NEAREST: usize = 4;

/// What the pose jumps by at a switch dies away in this time, seconds.
const SETTLE_SECS: f64 = 0.08;

/// A segment lasts at least and at most this share of the mean.
const LENGTHS: [f64; 2] = [0.7, 1.4];

/// Fewest frames of a segment that can be put on the ground.
const LEAST_FRAMES: usize = 6;

/// What walk to make.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DynamicsWalkConfig {
    /// How long.
    pub seconds: f64,
    /// Which of its walks.
    pub seed: u64,
    /// Frames per second of the clip; the model's when absent.
    pub frame_rate_hz: Option<f64>,
}

/// Generates a walk of a switching model.
///
/// # Errors
/// [`SynthError`] when the model or the skeleton cannot be used or a setting is not finite.
pub fn synthesize_dynamics(
    model: &DynamicsModel,
    skeleton: &Skeleton,
    config: &DynamicsWalkConfig,
) -> Result<SynthesizedWalk, SynthError> {
    model.check()?;
    skeleton.check()?;
    if !config.seconds.is_finite() || config.seconds <= 0.0 {
        return Err(SynthError::Setting {
            setting: "seconds",
            value: config.seconds as f32,
        });
    }
    let mut walker = SwitchingWalker::new(model, config.seed);
    let mut features: Vec<f64> = Vec::new();
    let mut plans: Vec<StepPlan> = Vec::new();
    // The first segment and the last are generated but not shown.
    let wanted = (config.seconds * model.frame_rate_hz).ceil() as usize + 1;
    let mut shown = 0;
    while shown < wanted || plans.len() < 3 {
        let plan = walker.segment(&mut features);
        if !plans.is_empty() {
            shown += plan.timing.frames;
        }
        plans.push(plan);
    }
    plans.push(walker.segment(&mut features));
    walker.segment(&mut features);
    let walk = WalkConfig {
        steps: plans.len(),
        seed: config.seed,
        variation: 1.0,
        speed_mps: None,
        turn_rate_radps: 0.0,
        frame_rate_hz: config.frame_rate_hz,
        from_standing: false,
    };
    let on_ground = |facing: f32| {
        put_on_ground(
            model.frame_rate_hz,
            skeleton,
            &walk,
            &plans,
            &features,
            facing,
        )
    };
    // People hold their hips a little askew: the walk is to go along +Z all the same.
    let straight = on_ground(0.0);
    let way = straight.clip.poses.last().map_or(0.0, |pose| {
        let travel = pose.root_position;
        if travel.z > 0.0 {
            -travel.x.atan2(travel.z)
        } else {
            0.0
        }
    });
    let mut made = on_ground(way);
    made.cut_to(config.seconds);
    Ok(made)
}

/// The systems as they run.
struct SwitchingWalker<'a> {
    model: &'a DynamicsModel,
    rng: ChaCha8Rng,
    side: Side,
    /// Where the component weights would be next, had nothing switched.
    expected: Option<Vec<f64>>,
}

impl<'a> SwitchingWalker<'a> {
    fn new(model: &'a DynamicsModel, seed: u64) -> Self {
        Self {
            model,
            rng: ChaCha8Rng::seed_from_u64(seed),
            // The first segment is not shown; the second begins with the left foot.
            side: Side::Right,
            expected: None,
        }
    }

    /// Runs one system for a segment, and appends its static features frame by frame.
    fn segment(&mut self, features: &mut Vec<f64>) -> StepPlan {
        let regime = self.model.regime(self.side);
        let system = &regime.system;
        let frames = self.length(regime);
        let start = self.start(regime);
        let channels = system.channels();
        let weights = system.simulate(&start, frames + 1);
        let jump: Vec<f64> = match &self.expected {
            Some(expected) => expected.iter().zip(&weights).map(|(a, b)| a - b).collect(),
            None => vec![0.0; channels],
        };
        let settle = SETTLE_SECS * self.model.frame_rate_hz;
        let mut rows = weights
            .chunks_exact(channels)
            .enumerate()
            .map(|(frame, weights)| {
                let remains = (-(frame as f64) / settle).exp();
                let pairs = weights.iter().zip(&jump);
                pairs
                    .map(|(weight, jump)| weight + remains * jump)
                    .collect::<Vec<f64>>()
            });
        for row in rows.by_ref().take(frames) {
            features.extend(self.model.features(&row));
        }
        self.expected = rows.next();
        let terminal = regime.other_terminal.clamp(0.02, 0.6) * frames as f64;
        let mut plan = StepPlan::empty();
        plan.timing = StepTiming {
            leading: self.side,
            frames,
            terminal: (terminal.round() as usize).clamp(1, frames - 2),
            rests: false,
        };
        self.side = self.side.other();
        plan
    }

    fn length(&mut self, regime: &Regime) -> usize {
        let mean = regime.frames_mean;
        let drawn = Normal::new(mean, regime.frames_variance.sqrt())
            .map_or(mean, |lengths| lengths.sample(&mut self.rng));
        let frames = drawn.clamp(LENGTHS[0] * mean, LENGTHS[1] * mean).round() as usize;
        frames.max(LEAST_FRAMES)
    }

    /// One of the recorded starts that go on best from where the pose is.
    fn start(&mut self, regime: &Regime) -> nalgebra::DVector<f64> {
        let mut starts: Vec<(f64, nalgebra::DVector<f64>)> = regime
            .starts
            .iter()
            .map(|start| {
                let start = nalgebra::DVector::from_column_slice(start);
                (self.distance(&regime.system, &start), start)
            })
            .collect();
        starts.sort_by(|a, b| a.0.total_cmp(&b.0));
        let among = if self.expected.is_some() {
            NEAREST.min(starts.len())
        } else {
            starts.len()
        };
        starts.swap_remove(self.rng.random_range(0..among)).1
    }

    fn distance(&self, system: &AffineSystem, start: &nalgebra::DVector<f64>) -> f64 {
        let Some(expected) = &self.expected else {
            return 0.0;
        };
        let begins = system.put_out(start);
        begins
            .iter()
            .zip(expected)
            .map(|(a, b)| (a - b).powi(2))
            .sum()
    }
}
