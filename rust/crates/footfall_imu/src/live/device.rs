//! One sensor that is heard: its samples on their way to the game, and its state.

use super::assembly::Assembly;
use super::clock::{ArrivalClock, DeviceClock};
use super::reading::{Quantity, Reading};
use crate::checks::{RecordingFault, check_recording};
use crate::sample::{ImuRecording, ImuSample};
use crossbeam_queue::ArrayQueue;
use std::collections::VecDeque;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::time::Instant;

/// Most samples that wait for the game: ten seconds at 400 Hz. Beyond that, the oldest are dropped.
const MOST_WAITING: usize = 4096;

/// Readings of one device that are taken in a second on average, and at once after silence: what comes beyond them is a flood.
const MOST_A_SECOND: f64 = 5000.0;
const MOST_AT_ONCE: f64 = 10_000.0;

/// Length of the checks of units and axes, and their interval, seconds.
const CHECKED_SECS: f64 = 4.0;
const CHECK_EVERY_SECS: f64 = 2.0;
const MOST_CHECKED: usize = 4000;

/// Weight of a new step of time in the mean period.
const PERIOD_GAIN: f64 = 0.02;

/// Steps of time longer than this many periods have lost samples in them; longer than this many seconds they are pauses.
const LOST_PERIODS: f64 = 1.6;
const PAUSE_SECS: f64 = 2.0;

/// Longest name of a device that is kept, characters.
const LONGEST_NAME: usize = 64;

/// Seconds since this program asked for the time first: our clock in all live sensors.
#[expect(
    clippy::disallowed_methods,
    reason = "ports are outside of the program, and so is the time at which bytes come"
)]
pub fn now_secs() -> f64 {
    static BEGIN: OnceLock<Instant> = OnceLock::new();
    BEGIN.get_or_init(Instant::now).elapsed().as_secs_f64()
}

/// Status of a device.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DeviceStatus {
    /// Name: a port, an address or the name that it gives itself.
    pub name: String,
    /// Protocol of the device.
    pub format: &'static str,
    /// Samples so far.
    pub samples: u64,
    /// Samples that are missing in the row of times.
    pub lost: u64,
    /// Readings that were no measurement, late, or too many.
    pub rejected: u64,
    /// Samples that were dropped because they were not taken in time.
    pub overflowed: u64,
    /// Samples a second.
    pub rate_hz: f64,
    /// Mean delay of arrivals beyond the least, seconds.
    pub jitter_secs: f64,
    /// Mean time from a sample to when the game could have it, by our clock, seconds: beyond the least delay of the way, which no one can know.
    pub delay_secs: f64,
    /// When something was heard last, by our clock.
    pub heard_secs: f64,
    /// The last sample.
    pub last: Option<ImuSample>,
    /// Fault of units, axes or rate, and its remedy.
    pub fault: Option<String>,
}

impl DeviceStatus {
    /// Time since something was heard, seconds.
    pub fn silent_secs(&self) -> f64 {
        (now_secs() - self.heard_secs).max(0.0)
    }
}

#[derive(Debug)]
struct Shared {
    samples: ArrayQueue<ImuSample>,
    status: Mutex<DeviceStatus>,
}

/// A sensor as the game sees it. Copies share their samples: each is given once.
#[derive(Clone, Debug)]
pub struct Device {
    shared: Arc<Shared>,
}

impl Device {
    /// Gives the samples that came since the last time, in order. Their times are by our clock ([`now_secs`]) and rise.
    pub fn take(&self, mut give: impl FnMut(ImuSample)) {
        while let Some(sample) = self.shared.samples.pop() {
            give(sample);
        }
    }

    /// Current status.
    pub fn status(&self) -> DeviceStatus {
        self.lock().clone()
    }

    fn lock(&self) -> std::sync::MutexGuard<'_, DeviceStatus> {
        // A status is whole even when the thread that wrote it has died.
        self.shared
            .status
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
    }

    /// Returns true when both are the same sensor.
    pub fn is(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.shared, &other.shared)
    }
}

/// The end of a device that its port's thread holds.
#[derive(Debug)]
pub struct DeviceWriter {
    device: Device,
    assembly: Assembly,
    device_clock: DeviceClock,
    arrival_clocks: [ArrivalClock; 5],
    allowance: f64,
    period_secs: f64,
    last_secs: Option<f64>,
    recent: VecDeque<ImuSample>,
    checked_secs: f64,
}

impl DeviceWriter {
    /// A device of this name, which speaks this.
    pub fn new(name: &str, format: &'static str) -> Self {
        let status = DeviceStatus {
            name: name
                .chars()
                .filter(|c| !c.is_control())
                .take(LONGEST_NAME)
                .collect(),
            format,
            heard_secs: now_secs(),
            ..DeviceStatus::default()
        };
        Self {
            device: Device {
                shared: Arc::new(Shared {
                    samples: ArrayQueue::new(MOST_WAITING),
                    status: Mutex::new(status),
                }),
            },
            assembly: Assembly::default(),
            device_clock: DeviceClock::default(),
            arrival_clocks: [ArrivalClock::default(); 5],
            allowance: MOST_AT_ONCE,
            period_secs: 0.0,
            last_secs: None,
            recent: VecDeque::new(),
            checked_secs: f64::NEG_INFINITY,
        }
    }

    /// The game's end.
    pub fn device(&self) -> Device {
        self.device.clone()
    }

    /// Something came that is no reading: the device is there.
    pub fn heard(&mut self, arrival_secs: f64) {
        let heard = &mut self.device.lock().heard_secs;
        self.allowance += MOST_A_SECOND * (arrival_secs - *heard).max(0.0);
        self.allowance = self.allowance.min(MOST_AT_ONCE);
        *heard = arrival_secs.max(*heard);
    }

    /// Something came that cannot be read.
    pub fn rejected(&mut self) {
        self.device.lock().rejected += 1;
    }

    /// Sets a fault that holds whatever the device measures.
    pub fn set_fault(&mut self, fault: &str) {
        self.device.lock().fault = Some(fault.to_owned());
        // It is not to be replaced by a check of samples.
        self.checked_secs = f64::INFINITY;
    }

    /// Takes a reading that arrived at a time by our clock.
    pub fn push(&mut self, reading: Reading, arrival_secs: f64) {
        self.heard(arrival_secs);
        let sound = reading.quantity.is_sound() && reading.time_secs.is_none_or(f64::is_finite);
        if !sound || self.allowance < 1.0 {
            self.rejected();
            return;
        }
        self.allowance -= 1.0;
        let kind = match reading.quantity {
            Quantity::Force(_) | Quantity::Both { .. } => 0,
            Quantity::Rate(_) => 1,
            Quantity::Acceleration(_) => 2,
            Quantity::Gravity(_) => 3,
            Quantity::Orientation(_) => 4,
        };
        let time_secs = match reading.time_secs {
            Some(device_secs) => self.device_clock.ours(device_secs, arrival_secs),
            None => self.arrival_clocks[kind].smoothed(arrival_secs),
        };
        // Lent out, since what it gives goes on through this device.
        let mut assembly = core::mem::take(&mut self.assembly);
        assembly.push(time_secs, reading.quantity, |sample| {
            self.sample(sample, arrival_secs);
        });
        self.assembly = assembly;
    }

    fn sample(&mut self, sample: ImuSample, arrival_secs: f64) {
        let step = self.last_secs.map(|last| sample.time_secs - last);
        if step.is_some_and(|step| step <= 0.0) {
            self.rejected();
            return;
        }
        self.last_secs = Some(sample.time_secs);
        let overflow = self.device.shared.samples.force_push(sample).is_some();
        self.keep(sample);
        let checked = self.check(arrival_secs);
        let jitter = self.arrival_clocks.iter().map(ArrivalClock::jitter_secs);
        let jitter = jitter.fold(self.device_clock.jitter_secs(), f64::max);
        let mut status = self.device.lock();
        status.samples += 1;
        status.overflowed += u64::from(overflow);
        status.last = Some(sample);
        status.jitter_secs = jitter;
        let delay = arrival_secs - sample.time_secs;
        status.delay_secs += PERIOD_GAIN * (delay - status.delay_secs);
        if let Some(verdict) = checked {
            status.fault = verdict.err().map(|fault| fault.to_string());
        }
        let Some(step) = step.filter(|step| *step < PAUSE_SECS) else {
            return;
        };
        // The mean over the first samples, then one that forgets.
        let gain = PERIOD_GAIN.max(1.0 / status.samples as f64);
        let known = status.samples > 20;
        if known && step > LOST_PERIODS * self.period_secs {
            status.lost += (step / self.period_secs).round() as u64 - 1;
        } else {
            self.period_secs += gain * (step - self.period_secs);
        }
        status.rate_hz = 1.0 / self.period_secs.max(1e-6);
    }

    fn keep(&mut self, sample: ImuSample) {
        while self.recent.len() >= MOST_CHECKED
            || self
                .recent
                .front()
                .is_some_and(|first| sample.time_secs - first.time_secs > CHECKED_SECS)
        {
            self.recent.pop_front();
        }
        self.recent.push_back(sample);
    }

    /// Checks the last seconds, at intervals.
    fn check(&mut self, arrival_secs: f64) -> Option<Result<(), RecordingFault>> {
        let first = self.recent.front()?.time_secs;
        let long_enough = self.last_secs? - first > 0.9 * CHECKED_SECS;
        if !long_enough || arrival_secs - self.checked_secs < CHECK_EVERY_SECS {
            return None;
        }
        self.checked_secs = arrival_secs;
        let recording = ImuRecording {
            samples: self.recent.iter().copied().collect(),
        };
        Some(check_recording(&recording))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    fn reading(time_secs: f64) -> Reading {
        let swing = (time_secs * 6.0).sin() as f32;
        Reading {
            time_secs: Some(time_secs),
            quantity: Quantity::Both {
                force: Vec3::new(swing, 9.8, 0.2 * swing),
                rate: Vec3::new(0.1 * swing, swing, 0.3 * swing),
            },
        }
    }

    fn pushed(readings: impl Iterator<Item = (Reading, f64)>) -> (Device, Vec<ImuSample>) {
        let mut writer = DeviceWriter::new("test", "none");
        let mut samples = Vec::new();
        for (reading, arrival) in readings {
            writer.push(reading, arrival);
            writer.device().take(|sample| samples.push(sample));
        }
        (writer.device(), samples)
    }

    #[test]
    fn rate_losses_and_faults_are_told() {
        let times = (0..2000).map(|n| f64::from(n) * 0.01);
        let kept = times.filter(|t| !(8.0..8.05).contains(t));
        let in_g = kept.map(|t| {
            let mut reading = reading(t);
            if let Quantity::Both { force, .. } = &mut reading.quantity {
                *force /= 9.8;
            }
            (reading, t + 100.0)
        });
        let (device, samples) = pushed(in_g);
        let status = device.status();
        assert_eq!(samples.len(), 1995);
        assert_eq!((status.samples, status.lost, status.rejected), (1995, 5, 0));
        assert!((status.rate_hz - 100.0).abs() < 1.0, "{}", status.rate_hz);
        assert!(status.delay_secs.abs() < 1e-3, "{}", status.delay_secs);
        let fault = status.fault.expect("forces in g are a fault");
        assert!(fault.contains("unit is g"), "{fault}");
        assert!(
            samples
                .windows(2)
                .all(|pair| pair[1].time_secs > pair[0].time_secs)
        );
    }

    #[test]
    fn late_broken_and_flooding_readings_are_left_out() {
        let mut readings: Vec<(Reading, f64)> = (0..100)
            .map(|n| (reading(f64::from(n) * 0.01), f64::from(n) * 0.01))
            .collect();
        readings[50].0.time_secs = Some(f64::NAN);
        readings[60].0.time_secs = Some(0.3);
        if let Quantity::Both { force, .. } = &mut readings[70].0.quantity {
            force.x = f32::INFINITY;
        }
        let (device, samples) = pushed(readings.into_iter());
        assert_eq!((samples.len(), device.status().rejected), (97, 3));

        // A hundred thousand readings in a second.
        let flood = (0..100_000).map(|n| (reading(f64::from(n) * 1e-5), f64::from(n) * 1e-5));
        let (device, samples) = pushed(flood);
        assert!(
            (10_000..16_000).contains(&samples.len()),
            "{}",
            samples.len()
        );
        assert!(device.status().rejected > 80_000);
    }

    #[test]
    fn the_oldest_samples_go_when_nobody_takes_them() {
        let mut writer = DeviceWriter::new("test", "none");
        for n in 0..MOST_WAITING + 10 {
            writer.push(reading(n as f64 * 0.01), n as f64 * 0.01);
        }
        let mut first = None;
        writer.device().take(|sample| {
            first.get_or_insert(sample.time_secs);
        });
        assert!((first.unwrap() - 0.1).abs() < 1e-9);
        assert_eq!(writer.device().status().overflowed, 10);
    }
}
