//! One worn sensor: its samples and its mounting.

use crate::imu_source::SourceSamples;
use footfall_imu::live::Device;
use footfall_imu::live::device::now_secs;
use footfall_imu::live::recorder::Recorder;
use footfall_imu::{ImuRecording, ImuSample, PoseMeter, Rest, find_rest};
use footfall_model::CalibratedSensor;
use footfall_recon::{Examination, Mounting, Prepared, SensorProblem, TrackerConfig, examine};
use glam::Quat;
use std::path::Path;
use std::sync::Arc;
use std::thread::JoinHandle;

/// Samples that are window to find the mounting from, seconds.
const KEPT_SECS: f64 = 8.0;

/// Length of the measurement before the mounting is estimated for the first time, and before each further time, seconds.
const FIRST_SECS: f64 = 4.0;
const AGAIN_SECS: f64 = 12.0;

/// Most samples that are window.
const MOST_SAMPLES: usize = 4096;

/// A sensor of one character.
#[derive(Debug, Default)]
pub(super) struct WornSensor {
    replay: Option<Replay>,
    device: Option<Device>,
    /// Time of a live sensor's newest sample, by our clock.
    live_secs: Option<f64>,
    tracked: Tracked,
    recorder: Option<Recorder>,
    window: SampleWindow,
    looked_at_secs: Option<f64>,
    /// The thread that estimates the mounting, and whether the calibration asked for it.
    worker: Option<(JoinHandle<Outcome>, bool)>,
    /// The best estimate so far, or the calibrated mounting.
    pub(super) mounting: Option<Mounting>,
    /// True if the mounting comes from a calibration, which nothing replaces.
    calibrated: bool,
}

/// Result of an estimate from the last samples; `None` if there was too little motion.
type Outcome = Option<(Examination, Option<Rest>)>;

/// Result of an estimate of the mounting.
#[derive(Debug, Default)]
pub(super) struct MountingReport {
    /// True for an estimate that the calibration asked for, which includes all samples up to then.
    pub(super) asked: bool,
    /// A mounting to take over.
    pub(super) mounting: Option<Mounting>,
    /// Measurement at rest.
    pub(super) rest: Option<Rest>,
    /// Problem with the mounting.
    pub(super) finding: Option<SensorProblem>,
}

/// An object of the game that stands for a sensor.
#[derive(Debug, Default)]
struct Tracked {
    meter: PoseMeter,
    /// Time that the game has played, seconds.
    played_secs: f64,
}

/// The last samples of a sensor, whose times rise.
#[derive(Debug, Default)]
struct SampleWindow(Vec<ImuSample>);

impl SampleWindow {
    fn push(&mut self, sample: ImuSample) {
        let since = sample.time_secs - KEPT_SECS;
        if self.0.len() == MOST_SAMPLES
            || self
                .0
                .first()
                .is_some_and(|s| s.time_secs < since - KEPT_SECS)
        {
            let old = self.0.partition_point(|sample| sample.time_secs < since);
            self.0.drain(..old.max(1));
        }
        if self
            .0
            .last()
            .is_none_or(|last| sample.time_secs > last.time_secs)
        {
            self.0.push(sample);
        } else {
            self.0.clear();
        }
    }
}

/// A recording that plays.
#[derive(Debug)]
struct Replay {
    recording: Arc<ImuRecording>,
    /// Time that has played, over all rounds, seconds.
    played_secs: f64,
    /// When the round at hand began.
    round_secs: f64,
    next: usize,
}

impl Replay {
    /// The next sample, if it is due.
    fn next_sample(&mut self, repeats: bool) -> Option<ImuSample> {
        let samples = &self.recording.samples;
        let length = self.recording.duration_secs();
        if self.next == samples.len() && repeats {
            // One sample's time lies between the last and the first again.
            self.round_secs += length + length / (samples.len() - 1) as f64;
            self.next = 0;
        }
        let sample = samples.get(self.next)?;
        let time_secs = self.round_secs + sample.time_secs - self.recording.start_secs();
        if time_secs > self.played_secs {
            return None;
        }
        self.next += 1;
        Some(ImuSample {
            time_secs,
            ..*sample
        })
    }
}

impl WornSensor {
    /// Passes on the samples of a frame, and keeps them.
    pub(super) fn hear(
        &mut self,
        samples: SourceSamples,
        dt_secs: f64,
        mut give: impl FnMut(ImuSample),
    ) {
        let mut taken = |worn: &mut Self, sample: ImuSample| {
            worn.keep(sample);
            give(sample);
        };
        match samples {
            SourceSamples::Recording(recording, repeats) => {
                self.play(&recording);
                self.replay(dt_secs, repeats, taken);
            }
            SourceSamples::Device(device) => {
                if !self.device.as_ref().is_some_and(|known| known.is(&device)) {
                    // Samples from before this node listened are dropped.
                    device.take(|_| {});
                    self.device = Some(device.clone());
                }
                device.take(|sample| {
                    self.live_secs = Some(sample.time_secs);
                    taken(self, sample);
                });
            }
            SourceSamples::Now(sample) => {
                self.live_secs = Some(sample.time_secs);
                taken(self, sample);
            }
            SourceSamples::Pose(position, turn) => {
                self.tracked.played_secs += dt_secs;
                let secs = self.tracked.played_secs;
                if let Some(sample) = self.tracked.meter.push(secs, position, turn) {
                    taken(self, sample);
                }
            }
            SourceSamples::Nothing => {}
        }
    }

    /// Age of the newest sample of a live sensor, seconds.
    pub(super) fn latency_secs(&self) -> f64 {
        self.live_secs.map_or(0.0, |at| (now_secs() - at).max(0.0))
    }

    pub(super) fn start_recording(&mut self, path: &str) -> bool {
        self.recorder = Recorder::new(Path::new(path)).ok();
        self.recorder.is_some()
    }

    pub(super) fn stop_recording(&mut self) -> bool {
        self.recorder
            .take()
            .is_some_and(|recorder| recorder.finish().is_ok())
    }

    pub(super) fn forget_mounting(&mut self) {
        (self.mounting, self.worker, self.looked_at_secs) = (None, None, None);
        self.calibrated = false;
        self.window = SampleWindow::default();
    }

    /// Plays a recording from its beginning, unless it plays already.
    fn play(&mut self, recording: &Arc<ImuRecording>) {
        let plays = |replay: &Replay| Arc::ptr_eq(&replay.recording, recording);
        if !self.replay.as_ref().is_some_and(plays) {
            self.replay = Some(Replay {
                recording: Arc::clone(recording),
                played_secs: 0.0,
                round_secs: 0.0,
                next: 0,
            });
        }
    }

    /// Passes on the recording's samples of a frame.
    fn replay(&mut self, dt_secs: f64, repeats: bool, mut give: impl FnMut(&mut Self, ImuSample)) {
        let Some(mut replay) = self.replay.take() else {
            return;
        };
        replay.played_secs += dt_secs;
        while let Some(sample) = replay.next_sample(repeats) {
            give(self, sample);
        }
        self.replay = Some(replay);
    }

    /// Keeps a sample for the estimate of the mounting, and for the recording.
    pub(super) fn keep(&mut self, sample: ImuSample) {
        self.window.push(sample);
        if let Some(recorder) = &mut self.recorder
            && recorder.push(sample).is_err()
        {
            // The disk is full: the file keeps what was written, and `stop_recording` returns false.
            self.recorder = None;
        }
    }

    /// Name of the live sensor, without the port of an address; empty for other sources.
    pub(super) fn device_name(&self) -> String {
        let Some(device) = &self.device else {
            return String::new();
        };
        let name = device.status().name;
        let (address, rest) = name.split_at(name.find(',').unwrap_or(name.len()));
        match address.parse::<std::net::SocketAddr>() {
            Ok(address) => format!("{}{rest}", address.ip()),
            Err(_) => name,
        }
    }

    /// Takes over a calibrated mounting.
    pub(super) fn calibrate(&mut self, calibrated: &CalibratedSensor) {
        self.forget_mounting();
        self.mounting = Some(Mounting {
            site_from_sensor: calibrated.site_from_sensor,
            certainty: calibrated.certainty,
        });
        self.calibrated = true;
    }

    /// Estimates the mounting on another thread, at intervals or at once if `asked` to; returns each result once. A calibrated mounting, or an
    /// `aligned` one, is only checked.
    pub(super) fn look(
        &mut self,
        prepared: &Arc<Prepared>,
        sensor: usize,
        aligned: Option<Quat>,
        asked: bool,
    ) -> Option<MountingReport> {
        let calibrated = self.mounting.filter(|_| self.calibrated);
        let believed = aligned.or(calibrated.map(|known| known.site_from_sensor));
        let finished = |(worker, _): &mut (JoinHandle<Outcome>, bool)| worker.is_finished();
        if let Some((worker, asked)) = self.worker.take_if(finished) {
            let found: Outcome = worker.join().ok().flatten();
            let seen = self.weigh(found, believed.is_some());
            return Some(MountingReport { asked, ..seen });
        }
        let (first, last) = (
            self.window.0.first()?.time_secs,
            self.window.0.last()?.time_secs,
        );
        let due = self
            .looked_at_secs
            .map_or(first + FIRST_SECS, |at| at + AGAIN_SECS);
        if self.worker.is_none() && (last >= due || asked) {
            self.looked_at_secs = Some(last);
            let recording = ImuRecording {
                samples: self.window.0.clone(),
            };
            let prepared = Arc::clone(prepared);
            let config = TrackerConfig::default();
            let look = move || {
                let found = examine(&prepared, sensor, &recording, believed, &config).ok()?;
                Some((found, find_rest(&recording)))
            };
            // Without a thread the mounting stays; the next estimate may get one.
            let thread = std::thread::Builder::new().name("footfall mounting".to_owned());
            self.worker = thread.spawn(look).ok().map(|worker| (worker, asked));
        }
        None
    }

    /// Takes over an estimate that is better than the known mounting.
    fn weigh(&mut self, found: Outcome, believed: bool) -> MountingReport {
        let Some((found, rest)) = found else {
            return MountingReport::default();
        };
        let finding = found.finding;
        // A later estimate replaces a less certain one.
        let better = |known: Mounting| found.mounting.certainty >= 0.9 * known.certainty;
        if believed || !self.mounting.is_none_or(better) {
            return MountingReport {
                finding,
                ..MountingReport::default()
            };
        }
        self.mounting = Some(found.mounting);
        MountingReport {
            asked: false,
            mounting: self.mounting,
            rest,
            finding,
        }
    }
}
