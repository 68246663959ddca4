//! One sensor as it is worn: what is heard of it, and how its axes lie.

use crate::imu_source::Heard;
use footfall_imu::live::Device;
use footfall_imu::live::device::now_secs;
use footfall_imu::live::recorder::Recorder;
use footfall_imu::{ImuRecording, ImuSample, PoseMeter};
use footfall_recon::{Mounting, Prepared, TrackerConfig, find_mounting};
use glam::Quat;
use std::path::Path;
use std::sync::Arc;
use std::thread::JoinHandle;

/// Samples that are kept to find the mounting from, seconds.
const KEPT_SECS: f64 = 8.0;

/// The mounting is looked for when so much was measured since the last time, seconds: the first time sooner.
const FIRST_SECS: f64 = 4.0;
const AGAIN_SECS: f64 = 12.0;

/// Most samples that are kept.
const MOST_SAMPLES: usize = 4096;

/// A sensor of one character.
#[derive(Debug, Default)]
pub(super) struct Worn {
    replay: Option<Replay>,
    device: Option<Device>,
    /// When the newest sample of a live sensor was measured, by our clock.
    live_secs: Option<f64>,
    tracked: Tracked,
    recorder: Option<Recorder>,
    kept: Kept,
    looked_at_secs: Option<f64>,
    worker: Option<JoinHandle<Option<Mounting>>>,
    /// The best that was found.
    pub(super) mounting: Option<Mounting>,
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
struct Kept(Vec<ImuSample>);

impl Kept {
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
    /// The next sample, when its time has come.
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

impl Worn {
    /// Gives the samples of the time that passes, and keeps them.
    pub(super) fn hear(&mut self, heard: Heard, dt_secs: f64, mut give: impl FnMut(ImuSample)) {
        let mut taken = |worn: &mut Self, sample: ImuSample| {
            worn.keep(sample);
            give(sample);
        };
        match heard {
            Heard::Recording(recording, repeats) => {
                self.play(&recording);
                self.replay(dt_secs, repeats, taken);
            }
            Heard::Device(device) => {
                if !self.device.as_ref().is_some_and(|known| known.is(&device)) {
                    // What came while nobody listened is past.
                    device.take(|_| {});
                    self.device = Some(device.clone());
                }
                device.take(|sample| {
                    self.live_secs = Some(sample.time_secs);
                    taken(self, sample);
                });
            }
            Heard::Now(sample) => {
                self.live_secs = Some(sample.time_secs);
                taken(self, sample);
            }
            Heard::Pose(position, turn) => {
                self.tracked.played_secs += dt_secs;
                let secs = self.tracked.played_secs;
                if let Some(sample) = self.tracked.meter.push(secs, position, turn) {
                    taken(self, sample);
                }
            }
            Heard::Nothing => {}
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
        self.kept = Kept::default();
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

    /// Gives the recording's samples of the time that passes.
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

    /// Keeps a sample for finding the mounting, and for the recording.
    pub(super) fn keep(&mut self, sample: ImuSample) {
        self.kept.push(sample);
        if let Some(recorder) = &mut self.recorder
            && recorder.push(sample).is_err()
        {
            // The disk is full: what was written stays, and `stop_recording` tells.
            self.recorder = None;
        }
    }

    /// Looks for the mounting on another thread, now and then; gives what was found, once.
    pub(super) fn find_mounting(
        &mut self,
        prepared: &Arc<Prepared>,
        sensor: usize,
    ) -> Option<Quat> {
        if let Some(worker) = self.worker.take_if(|worker| worker.is_finished()) {
            let found = worker.join().ok().flatten()?;
            // A later look replaces what is less certain.
            if self
                .mounting
                .is_none_or(|known| found.certainty >= 0.9 * known.certainty)
            {
                self.mounting = Some(found);
                return Some(found.site_from_sensor);
            }
        }
        let (first, last) = (
            self.kept.0.first()?.time_secs,
            self.kept.0.last()?.time_secs,
        );
        let due = self
            .looked_at_secs
            .map_or(first + FIRST_SECS, |at| at + AGAIN_SECS);
        if self.worker.is_none() && last >= due {
            self.looked_at_secs = Some(last);
            let recording = ImuRecording {
                samples: self.kept.0.clone(),
            };
            let prepared = Arc::clone(prepared);
            let look = move || {
                find_mounting(&prepared, sensor, &recording, &TrackerConfig::default()).ok()
            };
            // Without a thread the axes stay as they are; the next look may have one.
            let thread = std::thread::Builder::new().name("footfall mounting".to_owned());
            self.worker = thread.spawn(look).ok();
        }
        None
    }
}
