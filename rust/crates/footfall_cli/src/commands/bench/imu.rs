//! What a game pays for each frame of a body that sensors drive.

use super::{microseconds, now};
use anyhow::Result;
use footfall_core::{Pose, Site};
use footfall_imu::ImuRecording;
use footfall_model::{GaitModel, Provenance};
use footfall_motion::virtual_imu::{VirtualImuConfig, simulate};
use footfall_recon::{Prepared, ReconConfig, Reconstructor};
use footfall_synth::{WalkConfig, synthesize};
use footfall_train::imu::{Chain, ImuClip, ImuTrainConfig, observe, train_imu};
use std::hint::black_box;
use std::sync::Arc;

/// Samples a second of the sensor.
const RATE_HZ: f64 = 100.0;

/// Steps of each walker.
const STEPS: usize = 60;

/// A body, its sensor's recording, and how many frames the model has.
pub(super) struct ReconstructorBench {
    reconstructor: Reconstructor,
    recording: ImuRecording,
    frames: f64,
}

impl ReconstructorBench {
    /// A model of so many frames, of walkers that the gait model makes, each with a seed and a speed of its own.
    pub(super) fn new(gait: &Arc<GaitModel>, frames: usize) -> Result<Self> {
        let walk = |seed: u64| {
            let config = WalkConfig {
                steps: STEPS,
                seed,
                variation: 1.0,
                speed_mps: Some(0.9 + 0.05 * (seed % 13) as f32),
                turn_rate_radps: 0.0,
                frame_rate_hz: Some(60.0),
                from_standing: false,
            };
            synthesize(gait, &gait.skeleton, &config).map(|walk| walk.clip)
        };
        let config = ImuTrainConfig::new(&[Site::RightFoot]);
        let mut chains: Vec<Chain> = Vec::new();
        let mut seed = 0;
        while chains.iter().map(Chain::frames).sum::<usize>() < frames {
            seed += 1;
            let clip = walk(seed)?;
            chains.extend(observe(
                &ImuClip {
                    subject: &seed.to_string(),
                    clip: &clip,
                    first_frame: 0,
                    recordings: &[],
                },
                &config,
            ));
        }
        let all: Vec<&Chain> = chains.iter().collect();
        let model = train_imu(&all, &config, Provenance::default())?;
        let unseen = walk(seed + 1)?;
        let recording = simulate(
            &unseen,
            0,
            Site::RightFoot,
            &VirtualImuConfig::ideal(RATE_HZ),
        );
        let prepared = Arc::new(Prepared::new(Arc::new(model))?);
        let skeleton = &prepared.model().skeleton;
        Ok(Self {
            reconstructor: Reconstructor::new(&prepared, skeleton, &ReconConfig::default())?,
            frames: recording.duration_secs() * prepared.model().frame_rate_hz,
            recording,
        })
    }

    /// The whole recording; microseconds a frame of the model, samples, tracking, pose and feet.
    pub(super) fn run(&mut self) -> f64 {
        self.reconstructor.reset();
        let mut pose = Pose::default();
        let begun = now();
        for sample in &self.recording.samples {
            self.reconstructor.push(0, *sample);
            self.reconstructor.step((1.0 / RATE_HZ) as f32, &mut pose);
        }
        black_box(&pose);
        microseconds(begun.elapsed()) / self.frames
    }
}
