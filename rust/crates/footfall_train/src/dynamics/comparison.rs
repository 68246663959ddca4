//! Two systems that switch against one that does not (figure 5 of the paper): prediction errors over time.

use super::pose_space::PoseSpace;
use super::{DynamicsConfig, FittedSystem, Outputs, SwitchWalks, fit_segments};
use crate::error::TrainError;
use footfall_core::Side;
use footfall_motion::recording::Recording;
use footfall_prob::subspace::initial_state;

/// Error of a model in every frame, as a root mean square over the component weights divided by their spread.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ErrorCurve {
    /// Against the prediction from all frames before (equation 11).
    pub one_step: Vec<f64>,
    /// Against the system left to itself from its initial state: of each segment, or of the whole recording.
    pub simulated: Vec<f64>,
}

impl ErrorCurve {
    /// Root mean squares over the frames: one step ahead, and left to itself.
    pub fn means(&self) -> [f64; 2] {
        [&self.one_step, &self.simulated].map(|errors| {
            let squares: f64 = errors.iter().map(|error| error * error).sum();
            (squares / errors.len().max(1) as f64).sqrt()
        })
    }
}

/// Both models of one recording.
#[derive(Clone, Debug, PartialEq)]
pub struct DynamicsComparison {
    /// Frames per second of the curves.
    pub frame_rate_hz: f64,
    /// First frames of the segments.
    pub switches: Vec<usize>,
    /// Two systems that switch.
    pub switching: ErrorCurve,
    /// One linear system of the same order.
    pub single: ErrorCurve,
}

/// Fits two switching systems and a single one of the same order to the longest walk of a recording, and compares how well they predict
/// it. `None` when the recording shows too few steps.
///
/// # Errors
/// [`TrainError`] when a pose is not finite.
pub fn compare_dynamics(
    recording: &Recording,
    config: &DynamicsConfig,
) -> Result<Option<DynamicsComparison>, TrainError> {
    let walks = match SwitchWalks::read(core::slice::from_ref(recording), config) {
        Ok(walks) => walks,
        Err(TrainError::NoSteps) => return Ok(None),
        Err(error) => return Err(error),
    };
    let longest = walks
        .sequences
        .into_iter()
        .max_by_key(super::super::sequence::Sequence::frames);
    let Some(sequence) = longest else {
        return Ok(None);
    };
    let sequence = [sequence];
    let pose = PoseSpace::of(&sequence, &recording.clip().skeleton, config.components)?;
    let outputs = Outputs::of(&sequence, &pose);
    let fits = Side::BOTH.map(|side| fit_segments(&outputs.segments(side), config));
    let whole = [outputs.sequences[0].as_slice()];
    let (Ok(left), Ok(right), Ok(single)) = (&fits[0], &fits[1], &fit_segments(&whole, config))
    else {
        return Ok(None);
    };
    let mut switching = ErrorCurve::default();
    let mut nth = [0; 2];
    for (_, side, first, end) in &outputs.cuts {
        let fit = [left, right][side.index()];
        let segment = &whole[0][first * outputs.channels..end * outputs.channels];
        switching.add(fit, nth[side.index()], segment, outputs.spread)?;
        nth[side.index()] += 1;
    }
    let mut alone = ErrorCurve::default();
    alone.add(single, 0, whole[0], outputs.spread)?;
    Ok(Some(DynamicsComparison {
        frame_rate_hz: config.frame_rate_hz,
        switches: outputs.cuts.iter().map(|cut| cut.2).collect(),
        switching,
        single: alone,
    }))
}

impl ErrorCurve {
    fn add(
        &mut self,
        fit: &FittedSystem,
        nth: usize,
        segment: &[f64],
        spread: f64,
    ) -> Result<(), TrainError> {
        let channels = fit.system.channels();
        let norm = |errors: &[f64]| {
            let squares: f64 = errors.iter().map(|error| error * error).sum();
            (squares / channels as f64).sqrt() / spread
        };
        let predicted = fit.system.prediction_errors(&fit.starts[nth], segment);
        self.one_step
            .extend(predicted.chunks_exact(channels).map(norm));
        let start = initial_state(&fit.system, segment)?;
        let simulated = fit.system.simulate(&start, segment.len() / channels);
        let errors: Vec<f64> = simulated.iter().zip(segment).map(|(a, b)| a - b).collect();
        self.simulated
            .extend(errors.chunks_exact(channels).map(norm));
        Ok(())
    }
}
