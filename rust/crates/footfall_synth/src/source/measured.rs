//! A mixture of styles on one body, with its measured paces.

use super::buffers::StepBuffers;
use super::style_space::Blend;
use super::window::StepWindow;
use crate::error::SynthError;
use crate::gait::{Amplitude, Gait, Manner, Pace, PaceTable, SAMPLES, StepChooser, StepRequest};
use crate::plan::Planner;
use footfall_core::{Side, Skeleton};
use glam::{Vec2, Vec3};
use std::sync::Arc;

/// Range beyond the speeds of the corpus in which the speed response is trusted, as a fraction of their range.
const EXTRAPOLATION: f64 = 0.15;

/// A mixture of styles, and its gaits on one body.
#[derive(Clone, Debug)]
pub(crate) struct MeasuredBlend {
    /// The walk, which contains its run.
    pub(crate) blend: Arc<Blend>,
    pub(crate) chooser: StepChooser,
}

impl MeasuredBlend {
    /// Measures a walker in a mixture of styles.
    ///
    /// # Errors
    /// [`SynthError::Inference`] when the model gives no trajectory.
    pub(crate) fn measure(
        planner: &Planner,
        skeleton: &Skeleton,
        blend: Arc<Blend>,
        buffers: &mut StepBuffers,
    ) -> Result<Self, SynthError> {
        let walk = measure_paces(planner, skeleton, &blend, buffers)?;
        let run = match &blend.running {
            Some(run) => Some(measure_paces(planner, skeleton, run, buffers)?),
            None => None,
        };
        let chooser = StepChooser {
            walk,
            run,
            leg_length: skeleton.mean_leg_length(),
            frame_rate_hz: blend.model.frame_rate_hz,
            usual_mps: blend.model.speed.reference_mps,
        };
        Ok(Self { blend, chooser })
    }

    /// Returns the mixture for a step of this gait.
    pub(crate) fn blend_of(&self, gait: Gait) -> &Arc<Blend> {
        self.blend.of_gait(gait)
    }
}

/// Measures the paces of a walker in a mixture of styles over the model's range of speeds.
pub(crate) fn measure_paces(
    planner: &Planner,
    skeleton: &Skeleton,
    blend: &Arc<Blend>,
    buffers: &mut StepBuffers,
) -> Result<PaceTable, SynthError> {
    let model = &blend.model;
    let mut planner = planner.clone();
    planner.set_model(model);
    let mut trial = Trial {
        window: StepWindow::new(skeleton, blend),
        planner,
        blend,
        buffers,
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
    let leg_length = skeleton.mean_leg_length();
    Ok(PaceTable::new(samples, leg_length, facing))
}

/// Measurement of a walker without chance.
struct Trial<'a> {
    planner: Planner,
    window: StepWindow,
    blend: &'a Arc<Blend>,
    buffers: &'a mut StepBuffers,
}

impl Trial<'_> {
    /// Returns the travel over the ground and the frames of the second stride.
    fn travel(&mut self, covariate_mps: f64, facing: f32) -> Result<(Vec3, usize), SynthError> {
        let request = StepRequest {
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
        let (planner, window) = (&mut self.planner, &mut self.window);
        window.start(planner, self.blend, draws, request, self.buffers)?;
        let mut travel = Vec3::ZERO;
        let mut frames = 0;
        for step in 0..4 {
            if step > 0 {
                let ahead = Planner::mean_draw(window.step().timing.leading);
                window.advance(planner, self.blend, ahead, request, self.buffers);
            }
            if step >= 2 {
                travel += window.planted().travel(window.step());
                frames += window.step().timing.frames;
            }
        }
        Ok((travel, frames))
    }
}
