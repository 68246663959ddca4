//! Switching models: fitting them, finding switches, and running them, beside dense linear algebra.

use super::{microseconds, now};
use anyhow::{Context as _, Result};
use footfall_core::{Clip, Side};
use footfall_model::DynamicsModel;
use footfall_motion::switches::detect_switches;
use footfall_prob::subspace::initial_states;
use footfall_prob::switching::ProjectionResidual;
use footfall_synth::workload::SwitchingWorkload;
use footfall_synth::{SwitchingWalkConfig, synthesize_switching};
use footfall_train::dynamics::{DynamicsConfig, WINDOWS, fit_segments};
use nalgebra::{DMatrix, DVector};
use std::hint::black_box;
use std::sync::Arc;

/// A small model that the project's own fitter made.
const BUILT_IN_MODEL: &[u8] = include_bytes!("../../../../../../tests/model_versions/v1.footdyn");

const SEGMENTS: usize = 10;
const FRAMES: usize = 400;
const CHANNELS: usize = 4;
/// Frames of past and future, as the detector has them.
const WINDOW: usize = 2;
/// Segments of one timing.
const RUN_SEGMENTS: usize = 200;

/// Segments and a clip that a switching model put out.
pub(super) struct DynamicsBench {
    model: Arc<DynamicsModel>,
    segments: Vec<Vec<f64>>,
    clip: Clip,
    angles: Vec<f64>,
}

/// A model that runs.
pub(super) struct SwitchingBench(SwitchingWorkload);

impl SwitchingBench {
    /// Microseconds a frame.
    pub(super) fn run(&mut self) -> f64 {
        let begun = now();
        let frames: usize = (0..RUN_SEGMENTS).map(|_| self.0.segment()).sum();
        microseconds(begun.elapsed()) / frames as f64
    }
}

impl DynamicsBench {
    pub(super) fn new() -> Result<Self> {
        let model = DynamicsModel::from_bytes(BUILT_IN_MODEL).context("the built-in model")?;
        let model = Arc::new(model);
        let regime = model.regime(Side::Left);
        let starts = regime.starts.iter().cycle().take(SEGMENTS);
        let segments = starts
            .enumerate()
            .map(|(index, start)| {
                let frames = regime.mean_frames() as usize + index % 3;
                let start = DVector::from_column_slice(start);
                let mut segment = regime.system.simulate(&start, frames);
                // No recording is without noise, which refinement works on; a rough wave does for it.
                for (index, value) in segment.iter_mut().enumerate() {
                    *value += 1e-3 * (1.7 * (index * index) as f64).sin();
                }
                segment
            })
            .collect();
        let config = SwitchingWalkConfig {
            seconds: FRAMES as f64 / model.frame_rate_hz,
            seed: 1,
            variation: 1.0,
            speed_mps: None,
            turn_rate_radps: 0.0,
            direction_rad: 0.0,
            frame_rate_hz: None,
        };
        let walk = synthesize_switching(&model, &model.skeleton, &config)?;
        let mut clip = walk.clip;
        clip.poses.truncate(FRAMES);
        let legs = Side::BOTH.map(|side| [side.upper_leg(), side.lower_leg()]);
        let angles = clip.poses.iter().flat_map(|pose| {
            legs.as_flattened()
                .iter()
                .map(|joint| f64::from(pose.rotation(*joint).to_scaled_axis().x))
        });
        Ok(Self {
            angles: angles.collect(),
            model,
            segments,
            clip,
        })
    }

    pub(super) fn model(&self) -> &Arc<DynamicsModel> {
        &self.model
    }

    pub(super) fn switching(&self) -> Result<SwitchingBench> {
        Ok(SwitchingBench(SwitchingWorkload::new(&self.model)?))
    }

    /// Fits one system to the segments, in a limited number of refinement steps.
    pub(super) fn fit(&self, refine_steps: usize) -> Result<()> {
        let views: Vec<&[f64]> = self.segments.iter().map(Vec::as_slice).collect();
        let config = DynamicsConfig {
            refine_steps,
            ..DynamicsConfig::default()
        };
        black_box(fit_segments(&views, &config)?);
        Ok(())
    }

    pub(super) fn fit_refined(&self) -> Result<()> {
        self.fit(DynamicsConfig::default().refine_steps)
    }

    /// The same windows and initial states, each Hankel matrix by its singular values and each regression by a pseudo-inverse.
    pub(super) fn fit_dense(&self) -> Result<()> {
        let config = DynamicsConfig::default();
        let (channels, order) = (config.components, config.order);
        let views: Vec<&[f64]> = self.segments.iter().map(Vec::as_slice).collect();
        let most = self.segments[0].len() / (2 * channels);
        let fits = |window: &usize| window * channels >= order && *window <= most;
        for window in WINDOWS.into_iter().filter(fits) {
            let rows = window * channels;
            let columns: Vec<&[f64]> = self
                .segments
                .iter()
                .flat_map(|segment| segment.windows(rows).step_by(channels))
                .collect();
            if columns.len() < order + SEGMENTS {
                continue;
            }
            let hankel = DMatrix::from_fn(rows, columns.len(), |row, column| columns[column][row]);
            let svd = hankel.svd(true, false);
            let directions = svd
                .u
                .context("no directions")?
                .columns(0, order)
                .into_owned();
            let project = |column: &[f64]| directions.tr_mul(&DVector::from_column_slice(column));
            let states: Vec<DVector<f64>> = columns.iter().map(|column| project(column)).collect();
            let inputs = DMatrix::from_fn(order + 1, states.len() - 1, |row, column| {
                states[column].get(row).copied().unwrap_or(1.0)
            });
            let targets = DMatrix::from_fn(order + channels, states.len() - 1, |row, column| {
                let next = states[column + 1].get(row);
                next.copied()
                    .unwrap_or_else(|| columns[column][row.saturating_sub(order)])
            });
            let inverse = inputs.pseudo_inverse(1e-9).ok().context("no inverse")?;
            black_box(targets * inverse);
            let system = &self.model.regime(Side::Left).system;
            black_box(initial_states(system, &views)?);
        }
        Ok(())
    }

    pub(super) fn detect(&self) -> Result<()> {
        black_box(detect_switches(&self.clip, 0)?);
        Ok(())
    }

    pub(super) fn project(&self) -> Result<()> {
        black_box(ProjectionResidual::new(&self.angles, CHANNELS, WINDOW)?.norms());
        Ok(())
    }

    pub(super) fn project_dense(&self) -> Result<()> {
        black_box(self.dense_norms()?);
        Ok(())
    }

    pub(super) fn max_difference_from_dense(&self) -> Result<f64> {
        let ours = ProjectionResidual::new(&self.angles, CHANNELS, WINDOW)?.norms();
        let pairs = ours.into_iter().zip(self.dense_norms()?);
        Ok(pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max))
    }

    fn dense_norms(&self) -> Result<Vec<f64>> {
        let rows = WINDOW * CHANNELS;
        let columns = FRAMES - 2 * WINDOW + 1;
        let past = DMatrix::from_fn(rows + 1, columns, |row, column| {
            if row == rows {
                1.0
            } else {
                self.angles[column * CHANNELS + row]
            }
        });
        let future = DMatrix::from_fn(rows, columns, |row, column| {
            self.angles[(column + WINDOW) * CHANNELS + row]
        });
        let inverse = past
            .clone()
            .pseudo_inverse(1e-12)
            .ok()
            .context("no inverse")?;
        let rest = &future - &future * inverse * past;
        Ok(rest.column_iter().map(|column| column.norm()).collect())
    }

    /// Microseconds a frame of the model's own matrices, f64 and dense.
    pub(super) fn simulate_dense(&self) -> f64 {
        let begun = now();
        let mut frames = 0;
        for side in Side::BOTH {
            let regime = self.model.regime(side);
            let length = regime.mean_frames() as usize;
            for start in &regime.starts {
                let start = DVector::from_column_slice(start);
                let outputs = regime.system.simulate(&start, length);
                for weights in outputs.chunks_exact(regime.system.channels()) {
                    black_box(self.model.features(weights));
                }
                frames += length;
            }
        }
        microseconds(begun.elapsed()) / frames as f64
    }
}
