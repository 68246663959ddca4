//! Conversion of a requested speed to a pace of the model, by measuring the model.

use super::stand::Amplitude;
use crate::error::SynthError;
use crate::ground::strafe::overstep;
use crate::plan::{Manner, Pace, Planner};
use crate::source::buffers::Workbench;
use crate::source::style_space::Blend;
use crate::source::window::{Request, Walker};
use footfall_core::{Side, Skeleton};
use glam::{Vec2, Vec3};
use std::sync::Arc;

/// Number of paces that are measured.
const SAMPLES: usize = 7;

/// Range beyond the speeds of the corpus in which the speed response is trusted, as a fraction of their range.
const EXTRAPOLATION: f64 = 0.15;

/// Largest factor by which tempo and stride together exceed what was measured.
const MAX_RESIDUAL: f64 = 1.6;

/// Least factor on the tempo: slower walks take shorter strides instead.
const MIN_TEMPO: f64 = 0.8;

/// Factor on the tempo of the briskest walk at which steps to the side and backwards are taken at most.
const MOST_QUICKER: f64 = 1.9;

/// Tolerance of the search for a walk whose steps are quick enough, m/s.
const BRISKER_MPS: f64 = 0.05;

/// Speeds of one walker at the paces of the model.
#[derive(Clone, Debug)]
pub(crate) struct PaceTable {
    /// Covariate and realised speed, both rising, m/s, and how long a step lasts, seconds.
    samples: [[f64; 3]; SAMPLES],
    leg_length: f32,
    /// Heading under which the walk goes along +Z, radians.
    pub(crate) facing: f32,
}

impl PaceTable {
    /// Measures a walker in a mixture of styles over the model's range of speeds.
    pub(crate) fn measure(
        planner: &Planner,
        skeleton: &Skeleton,
        blend: &Arc<Blend>,
        bench: &mut Workbench,
    ) -> Result<Self, SynthError> {
        let model = &blend.model;
        let mut planner = planner.clone();
        planner.wear(model);
        let mut trial = Trial {
            walker: Walker::new(skeleton, blend),
            planner,
            blend,
            bench,
        };
        let (way, _) = trial.travel(model.speed.reference_mps, 0.0)?;
        let facing = -way.x.atan2(way.z);
        let [slowest, fastest] = model.speed_range();
        let margin = EXTRAPOLATION * (fastest - slowest);
        let (low, high) = ((slowest - margin).max(0.3 * slowest), fastest + margin);
        let mut samples = [[0.0; 3]; SAMPLES];
        for (index, sample) in samples.iter_mut().enumerate() {
            let covariate = low + (high - low) * index as f64 / (SAMPLES - 1) as f64;
            let (travel, frames) = trial.travel(covariate, facing)?;
            let secs = frames as f64 / model.frame_rate_hz;
            *sample = [covariate, f64::from(travel.length()) / secs, 0.5 * secs];
        }
        for index in 1..SAMPLES {
            // A corpus of one speed has a flat response: the order must still be strict.
            samples[index][1] = samples[index][1].max(samples[index - 1][1] + 1e-4);
        }
        Ok(Self {
            samples,
            leg_length: skeleton.mean_leg_length(),
            facing,
        })
    }

    /// The pace that gives a speed forwards. Beyond the measured range tempo and stride share what is missing.
    pub(crate) fn pace(&self, speed_mps: f64) -> Pace {
        self.pace_and_secs(speed_mps).0
    }

    /// The pace that gives a velocity to the left and forwards. Where its steps would be too long, they are shorter ones of a brisker walk,
    /// or of a quicker one still.
    pub(crate) fn pace_towards(&self, velocity_mps: Vec2) -> Pace {
        let speed = f64::from(velocity_mps.length());
        let fastest = self.samples[SAMPLES - 1][1];
        let mut brisk = speed;
        loop {
            let (mut pace, secs) = self.pace_and_secs(brisk);
            let over = f64::from(overstep(velocity_mps, secs as f32, self.leg_length));
            if over <= 1.0 || brisk >= fastest {
                let quicker = over.clamp(1.0, MOST_QUICKER);
                pace.tempo *= quicker;
                pace.stride *= (speed / (brisk.max(speed) * quicker)).min(1.0);
                return pace;
            }
            brisk = (brisk + BRISKER_MPS).min(fastest);
        }
    }

    /// The same pace with a tempo at which its steps last so long at most, seconds.
    pub(crate) fn within(&self, mut pace: Pace, most_secs: f64) -> Pace {
        let speed = self
            .samples
            .iter()
            .find(|sample| sample[0] >= pace.covariate_mps);
        let [_, _, secs] = speed.copied().unwrap_or(self.samples[SAMPLES - 1]);
        pace.tempo = pace.tempo.max(secs / most_secs);
        pace
    }

    /// The pace that gives a speed forwards, and how long its steps last.
    fn pace_and_secs(&self, speed_mps: f64) -> (Pace, f64) {
        let (first, last) = (self.samples[0], self.samples[SAMPLES - 1]);
        let within = speed_mps.clamp(first[1], last[1]);
        let above = self.samples.iter().position(|sample| within <= sample[1]);
        let above = above.unwrap_or(SAMPLES - 1).max(1);
        let pair = &self.samples[above - 1..=above];
        let share = (within - pair[0][1]) / (pair[1][1] - pair[0][1]);
        let between = |column: usize| pair[0][column] + share * (pair[1][column] - pair[0][column]);
        let residual = (speed_mps / within.max(1e-3)).clamp(0.0, MAX_RESIDUAL);
        let (tempo, stride) = tempo_and_stride(residual);
        let pace = Pace {
            covariate_mps: between(0),
            tempo,
            stride,
        };
        (pace, between(2) / tempo)
    }
}

/// Tempo and stride that share a factor on the speed.
pub(crate) fn tempo_and_stride(factor: f64) -> (f64, f64) {
    let tempo = factor.sqrt().max(MIN_TEMPO);
    (tempo, factor / tempo)
}

/// A walker that walks without chance, to be measured.
struct Trial<'a> {
    planner: Planner,
    walker: Walker,
    blend: &'a Arc<Blend>,
    bench: &'a mut Workbench,
}

impl Trial<'_> {
    /// Travel over the ground and frames of the second stride.
    fn travel(&mut self, covariate_mps: f64, facing: f32) -> Result<(Vec3, usize), SynthError> {
        let request = Request {
            leap_m: None,
            manner: Manner::inside(Pace {
                covariate_mps,
                tempo: 1.0,
                stride: 1.0,
            }),
            amplitude: Amplitude::WALK,
            turn_rate: 0.0,
            velocity_mps: Vec2::ZERO,
            facing,
        };
        let draws = [Side::Right, Side::Left, Side::Right].map(Planner::mean_draw);
        let (planner, walker) = (&mut self.planner, &mut self.walker);
        walker.start(planner, self.blend, draws, request, self.bench)?;
        let mut travel = Vec3::ZERO;
        let mut frames = 0;
        for step in 0..4 {
            if step > 0 {
                let ahead = Planner::mean_draw(walker.step().timing.leading);
                walker.advance(planner, self.blend, ahead, request, self.bench);
            }
            if step >= 2 {
                travel += walker.stage().travel(walker.step());
                frames += walker.step().timing.frames;
            }
        }
        Ok((travel, frames))
    }
}
