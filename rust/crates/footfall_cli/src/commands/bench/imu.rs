//! Cost of each frame of a body that sensors drive in a game.

use super::{microseconds, now};
use anyhow::{Result, ensure};
use footfall_core::{Pose, Site};
use footfall_imu::ImuRecording;
use footfall_imu::live::network::udp::{self, UdpConfig};
use footfall_model::{GaitModel, Provenance};
use footfall_motion::virtual_imu::{VirtualImuConfig, simulate};
use footfall_recon::{Prepared, ReconConfig, Reconstructor};
use footfall_synth::{WalkConfig, synthesize};
use footfall_train::imu::{Chain, ImuClip, ImuTrainConfig, TrunkTurn, observe, train_imu};
use serde::Serialize;
use std::hint::black_box;
use std::net::{Ipv4Addr, UdpSocket};
use std::sync::Arc;
use std::time::Duration;

/// Samples a second of the sensor.
const RATE_HZ: f64 = 100.0;

/// Samples that are sent live, how often the game looks for them, and how long it waits at most.
const LIVE_SAMPLES: usize = 300;
const LOOK_EVERY: Duration = Duration::from_millis(1);
const PATIENCE: Duration = Duration::from_secs(5);

/// Steps of each walker, at most; and about how many frames a step makes, its mirror image included.
const STEPS: usize = 60;
const FRAMES_A_STEP: usize = 36;

/// Frames of the models that are timed: those of the paper (Mousas 2017, table 2) with the latency that it reports, milliseconds, and ten
/// times as many.
pub(super) const SIZES: [(usize, Option<f64>); 7] = [
    (500, Some(25.0)),
    (1_000, Some(39.0)),
    (2_000, Some(73.0)),
    (4_000, Some(124.0)),
    (5_000, Some(292.0)),
    (10_000, Some(758.0)),
    (100_000, None),
];

/// A line of that table.
#[derive(Serialize)]
pub(super) struct SizeReport {
    pub(super) frames: usize,
    pub(super) segments: usize,
    pub(super) us_per_frame: f64,
    pub(super) paper_ms: Option<f64>,
}

/// A body, its sensor's recording, and how many frames the model has.
pub(super) struct ReconstructorBench {
    reconstructor: Reconstructor,
    recording: ImuRecording,
    frames: f64,
    /// Frames and segments of the model.
    size: (usize, usize),
}

impl ReconstructorBench {
    /// A model of this many frames, from generated walkers, each with its own seed and speed.
    pub(super) fn new(gait: &Arc<GaitModel>, frames: usize) -> Result<Self> {
        let walk = |seed: u64| {
            let config = WalkConfig {
                steps: STEPS.min(frames / FRAMES_A_STEP),
                seed,
                variation: 1.0,
                speed_mps: Some(0.9 + 0.05 * (seed % 13) as f32),
                turn_rate_radps: 0.0,
                direction_rad: 0.0,
                frame_rate_hz: Some(60.0),
                from_standing: false,
                gait: footfall_synth::GaitChoice::Auto,
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
                    trunk: TrunkTurn::default(),
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
        let own = prepared.model();
        let size = (own.frame_count(), own.segments.len());
        Ok(Self {
            reconstructor: Reconstructor::new(&prepared, skeleton, &ReconConfig::default())?,
            frames: recording.duration_secs() * prepared.model().frame_rate_hz,
            size,
            recording,
        })
    }

    /// Frames and segments of the model.
    pub(super) fn size(&self) -> (usize, usize) {
        self.size
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

    /// From a sample that is sent over this machine's own network to the pose that it makes, with the game looking every millisecond: the median and the longest of 99 in a
    /// hundred, milliseconds.
    pub(super) fn live(&mut self) -> Result<(f64, f64)> {
        let link = udp::listen(UdpConfig {
            port: 0,
            ..UdpConfig::default()
        });
        let begun = now();
        let address = loop {
            ensure!(begun.elapsed() < PATIENCE, "{}", link.state().message());
            if let Some(address) = link.address() {
                break address;
            }
            std::thread::sleep(LOOK_EVERY);
        };
        let socket = UdpSocket::bind((Ipv4Addr::LOCALHOST, 0))?;
        socket.connect((Ipv4Addr::LOCALHOST, address.port()))?;
        socket.send(b"time_s,ax_mps2,ay_mps2,az_mps2,gx_rad,gy_rad,gz_rad")?;
        self.reconstructor.reset();
        let mut pose = Pose::default();
        let mut waits = Vec::new();
        for sample in self.recording.samples.iter().take(LIVE_SAMPLES) {
            let (force, rate) = (sample.force, sample.rate);
            let line = format!(
                "{},{},{},{},{},{},{}",
                sample.time_secs, force.x, force.y, force.z, rate.x, rate.y, rate.z
            );
            let sent = now();
            socket.send(line.as_bytes())?;
            let mut come = false;
            while !come {
                ensure!(
                    sent.elapsed() < PATIENCE,
                    "a sample got lost on this machine's own network"
                );
                std::thread::sleep(LOOK_EVERY);
                if let Some(device) = link.device(0) {
                    device.take(|sample| {
                        self.reconstructor.push(0, sample);
                        come = true;
                    });
                }
            }
            self.reconstructor.step((1.0 / RATE_HZ) as f32, &mut pose);
            black_box(&pose);
            waits.push(1e-3 * microseconds(sent.elapsed()));
            let left = Duration::from_secs_f64(1.0 / RATE_HZ).saturating_sub(sent.elapsed());
            std::thread::sleep(left);
        }
        waits.sort_by(f64::total_cmp);
        Ok((waits[waits.len() / 2], waits[waits.len() * 99 / 100]))
    }
}
