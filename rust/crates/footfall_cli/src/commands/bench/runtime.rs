//! Cost of each frame of a walker in a game.

use super::{microseconds, now};
use anyhow::{Context as _, Result};
use footfall_core::{ModelPose, Pose, Skeleton, forward_kinematics};
use footfall_model::{DynamicsModel, GaitModel};
use footfall_synth::{Controls, GaitGenerator, GeneratorConfig, StyleSpace};
use std::hint::black_box;
use std::sync::Arc;

/// About a hundred steps.
const FRAMES: usize = 3500;
const KINEMATICS_RUNS: usize = 10_000;
const STATE_RUNS: usize = 200;

/// Speed of a run, m/s.
const RUN_MPS: f32 = 3.0;

const CONFIG: GeneratorConfig = GeneratorConfig {
    seed: 1,
    phase: 0.0,
    variation: 1.0,
};

/// A walker and its body.
pub(super) struct WalkerBench {
    generator: GaitGenerator,
    skeleton: Skeleton,
    controls: Controls,
    dt_secs: f32,
    pose: Pose,
}

/// Times of saving a walker's state and of restoring it, microseconds.
pub(super) struct Saved {
    pub(super) state: f64,
    pub(super) restore: f64,
}

/// Times of one walk, microseconds.
pub(super) struct Walked {
    pub(super) mean: f64,
    pub(super) worst: f64,
}

impl WalkerBench {
    pub(super) fn new(model: GaitModel) -> Result<Self> {
        let speed = model.speed.reference_mps as f32;
        Self::at(speed, model)
    }

    /// A runner; none of a model that only walks.
    pub(super) fn running(model: &GaitModel) -> Result<Option<Self>> {
        let runs = model.running.is_some();
        runs.then(|| Self::at(RUN_MPS, model.clone())).transpose()
    }

    fn at(speed_mps: f32, model: GaitModel) -> Result<Self> {
        let skeleton = model.skeleton.clone();
        let controls = Controls {
            speed_mps,
            turn_rate_radps: 0.1,
            ..Controls::STAND
        };
        let dt_secs = (1.0 / model.frame_rate_hz) as f32;
        let space = StyleSpace::new(&Arc::new(model), &[]).context("the model does not walk")?;
        let generator = GaitGenerator::new(&Arc::new(space), &[], &skeleton, &CONFIG)
            .context("the model does not walk")?;
        Ok(Self {
            generator,
            skeleton,
            controls,
            dt_secs,
            pose: Pose::default(),
        })
    }

    /// A walker of a switching model.
    pub(super) fn switching(model: &Arc<DynamicsModel>) -> Result<Self> {
        let skeleton = model.skeleton.clone();
        let generator = GaitGenerator::switching(model, &skeleton, &CONFIG)
            .context("the switching model does not walk")?;
        Ok(Self {
            controls: Controls {
                speed_mps: generator.usual_speed_mps(),
                turn_rate_radps: 0.1,
                ..Controls::STAND
            },
            generator,
            skeleton,
            dt_secs: (1.0 / model.frame_rate_hz) as f32,
            pose: Pose::default(),
        })
    }

    pub(super) fn walk(&mut self) -> Walked {
        let begun = now();
        for _ in 0..FRAMES {
            self.frame();
        }
        let mean = microseconds(begun.elapsed()) / FRAMES as f64;
        // Apart, for reading the clock costs as much as a tenth of a frame.
        let mut worst = 0.0_f64;
        for _ in 0..FRAMES {
            let begun = now();
            self.frame();
            worst = worst.max(microseconds(begun.elapsed()));
        }
        Walked { mean, worst }
    }

    fn frame(&mut self) {
        self.generator
            .step(self.dt_secs, &self.controls, &mut self.pose);
        black_box(&self.pose);
    }

    /// A state as games that predict need it: saved, and restored by the same walker.
    pub(super) fn save(&mut self) -> Result<Saved> {
        let begun = now();
        for _ in 0..STATE_RUNS {
            black_box(self.generator.state());
        }
        let state = microseconds(begun.elapsed()) / STATE_RUNS as f64;
        let saved = self.generator.state();
        let begun = now();
        for _ in 0..STATE_RUNS {
            self.generator
                .restore(black_box(&saved))
                .context("a walker refuses its own state")?;
        }
        let restore = microseconds(begun.elapsed()) / STATE_RUNS as f64;
        Ok(Saved { state, restore })
    }

    /// Microseconds of one pass.
    pub(super) fn forward_kinematics(&self) -> f64 {
        let mut model = ModelPose::default();
        let begun = now();
        for _ in 0..KINEMATICS_RUNS {
            forward_kinematics(&self.skeleton, black_box(&self.pose), &mut model);
            black_box(&model);
        }
        microseconds(begun.elapsed()) / KINEMATICS_RUNS as f64
    }
}
