//! From a wanted speed to a pace of the model, by measuring what the model does.

use crate::error::SynthError;
use crate::plan::{Pace, Planner};
use crate::standing::Amplitude;
use crate::walker::Walker;
use footfall_core::Side;
use footfall_model::GaitModel;
use glam::Vec3;

/// How many paces are measured.
const SAMPLES: usize = 7;

/// How far beyond the speeds of the corpus the speed response is trusted, as a fraction of their range.
const EXTRAPOLATION: f64 = 0.15;

/// Largest factor by which tempo and stride together exceed what was measured.
const MAX_RESIDUAL: f64 = 1.6;

/// Least factor on the tempo: slower walks take shorter strides instead.
const MIN_TEMPO: f64 = 0.8;

/// Which speed each pace of the model gives one walker.
#[derive(Clone, Debug)]
pub(crate) struct PaceTable {
    /// Covariate and realised speed, both rising, m/s.
    samples: [[f64; 2]; SAMPLES],
}

impl PaceTable {
    /// Measures a walker over the model's range of speeds, and makes it walk along +Z.
    pub(crate) fn measure(
        model: &GaitModel,
        planner: &mut Planner,
        walker: &mut Walker,
    ) -> Result<Self, SynthError> {
        let (way, _) = travel(planner, walker, model.speed.reference_mps)?;
        walker.facing = -way.x.atan2(way.z);
        let [slowest, fastest] = model.speed_range();
        let margin = EXTRAPOLATION * (fastest - slowest);
        let (low, high) = ((slowest - margin).max(0.3 * slowest), fastest + margin);
        let mut samples = [[0.0; 2]; SAMPLES];
        for (index, sample) in samples.iter_mut().enumerate() {
            let covariate = low + (high - low) * index as f64 / (SAMPLES - 1) as f64;
            let (travel, frames) = travel(planner, walker, covariate)?;
            let secs = frames as f64 / model.frame_rate_hz;
            *sample = [covariate, f64::from(travel.length()) / secs];
        }
        for index in 1..SAMPLES {
            // A corpus of one speed has a flat response: the order must still be strict.
            samples[index][1] = samples[index][1].max(samples[index - 1][1] + 1e-4);
        }
        Ok(Self { samples })
    }

    /// The pace that gives a speed. Beyond the measured range tempo and stride share what is missing.
    pub(crate) fn pace(&self, speed_mps: f64) -> Pace {
        let (first, last) = (self.samples[0], self.samples[SAMPLES - 1]);
        let within = speed_mps.clamp(first[1], last[1]);
        let covariate_mps = self
            .samples
            .windows(2)
            .find(|pair| within <= pair[1][1])
            .map_or(last[0], |pair| {
                let share = (within - pair[0][1]) / (pair[1][1] - pair[0][1]);
                pair[0][0] + share * (pair[1][0] - pair[0][0])
            });
        let residual = (speed_mps / within.max(1e-3)).clamp(0.0, MAX_RESIDUAL);
        let tempo = residual.sqrt().max(MIN_TEMPO);
        Pace {
            covariate_mps,
            tempo,
            stride: residual / tempo,
        }
    }
}

/// Travel over the ground and frames of the second stride of a walk without chance.
fn travel(
    planner: &mut Planner,
    walker: &mut Walker,
    covariate_mps: f64,
) -> Result<(Vec3, usize), SynthError> {
    let pace = Pace {
        covariate_mps,
        tempo: 1.0,
        stride: 1.0,
    };
    let draw = |_: &mut Planner, side: Side| Planner::mean_draw(side);
    walker.start(planner, pace, Side::Left, Amplitude::WALK, draw)?;
    let mut travel = Vec3::ZERO;
    let mut frames = 0;
    for step in 0..4 {
        if step >= 2 {
            let from = walker.frames[0].pose.root_position;
            let to = walker.frames[walker.step().timing.frames]
                .pose
                .root_position;
            travel += to - from;
            frames += walker.step().timing.frames;
        }
        walker.advance(planner, pace, 0.0, Amplitude::WALK, draw);
    }
    Ok((travel * Vec3::new(1.0, 0.0, 1.0), frames))
}
