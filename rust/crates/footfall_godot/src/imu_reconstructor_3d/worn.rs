//! One sensor as it is worn: what plays it, and how its axes lie.

use footfall_imu::{ImuRecording, ImuSample};
use footfall_recon::{Mounting, Prepared, TrackerConfig, find_mounting};
use glam::Quat;
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
    kept: Kept,
    looked_at_secs: Option<f64>,
    worker: Option<JoinHandle<Option<Mounting>>>,
    /// The best that was found.
    pub(super) mounting: Option<Mounting>,
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

impl Worn {
    /// Plays a recording from its beginning, unless it plays already.
    pub(super) fn play(&mut self, recording: &Arc<ImuRecording>) {
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

    /// Gives the samples of the time that passes, and keeps them.
    pub(super) fn replay(&mut self, dt_secs: f64, repeats: bool, mut give: impl FnMut(ImuSample)) {
        let Some(replay) = &mut self.replay else {
            return;
        };
        replay.played_secs += dt_secs;
        let samples = &replay.recording.samples;
        let start = replay.recording.start_secs();
        let length = replay.recording.duration_secs();
        loop {
            let Some(sample) = samples.get(replay.next) else {
                if !repeats {
                    return;
                }
                // One sample's time lies between the last and the first again.
                replay.round_secs += length + length / (samples.len() - 1) as f64;
                replay.next = 0;
                continue;
            };
            let time_secs = replay.round_secs + sample.time_secs - start;
            if time_secs > replay.played_secs {
                return;
            }
            replay.next += 1;
            let sample = ImuSample {
                time_secs,
                ..*sample
            };
            self.kept.push(sample);
            give(sample);
        }
    }

    /// Keeps a sample for finding the mounting.
    pub(super) fn keep(&mut self, sample: ImuSample) {
        self.kept.push(sample);
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
