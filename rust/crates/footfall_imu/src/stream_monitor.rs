//! Monitoring of a sensor's raw samples as they arrive.
//!
//! Each part detects one kind of fault and holds it for a while, so that a message can be read. [`check_recording`](crate::check_recording)
//! checks a recording as a whole; this monitor needs no later samples and does not allocate.

mod axes;
mod fault;
mod pace;
mod rails;
mod units;

pub use fault::StreamFault;

use crate::sample::{ImuRecording, ImuSample};
use axes::StuckAxes;
use pace::Pace;
use rails::Rails;
use units::Units;

/// Step in time above which the stream pauses, seconds.
const PAUSE_SECS: f64 = 0.5;

/// Specific force x, y, z and angular rate x, y, z.
const CHANNELS: usize = 6;

/// Monitors the samples of one sensor, in the sensor's own axes.
#[derive(Clone, Copy, Debug)]
pub struct StreamMonitor {
    last: Option<ImuSample>,
    axes: StuckAxes,
    rails: Rails,
    units: Units,
    pace: Pace,
}

impl StreamMonitor {
    /// Creates a monitor for a promised sample rate; without one, for the rate at which the sensor begins.
    pub const fn new(promised_hz: Option<f64>) -> Self {
        Self {
            last: None,
            axes: StuckAxes::NONE,
            rails: Rails::NONE,
            units: Units::NONE,
            pace: Pace::new(promised_hz),
        }
    }

    /// Discards the samples and keeps the promised rate.
    pub const fn reset(&mut self) {
        *self = Self::new(self.pace.promised_hz());
    }

    /// Adds a sample. Late, repeated and non-finite ones are dropped.
    pub fn push(&mut self, sample: ImuSample) {
        if !sample.is_finite() {
            return;
        }
        let Some(last) = self.last else {
            self.last = Some(sample);
            return;
        };
        let step_secs = sample.time_secs - last.time_secs;
        if step_secs <= 0.0 {
            return;
        }
        self.last = Some(sample);
        if step_secs > PAUSE_SECS {
            self.pace.pause();
            self.rails.pause();
            return;
        }
        let dt_secs = step_secs as f32;
        let row = channels(&sample);
        self.axes.step(&row, dt_secs);
        self.rails.step(&row, dt_secs);
        self.units.step(&sample, dt_secs);
        self.pace.step(step_secs);
    }

    /// Returns the most severe fault of the last seconds.
    pub fn fault(&self) -> Option<StreamFault> {
        // An axis that is stuck at rest also makes gravity wrong.
        let axes = self.axes.fault();
        axes.or_else(|| self.units.fault())
            .or_else(|| self.pace.fault())
            .or_else(|| self.rails.fault())
    }

    /// Returns true while an axis keeps one value in motion: it may be [stuck](StreamFault::StuckAxis), and samples say little of how the sensor is worn.
    pub fn suspects_axes(&self) -> bool {
        self.axes.are_suspected()
    }

    /// Returns the faults of a whole recording, with the times between which each was reported, in the order of their begin.
    pub fn faults_of(recording: &ImuRecording, promised_hz: Option<f64>) -> Vec<FaultSpan> {
        let mut monitor = Self::new(promised_hz);
        let mut spans: Vec<FaultSpan> = Vec::new();
        for sample in &recording.samples {
            monitor.push(*sample);
            let Some(fault) = monitor.fault() else {
                continue;
            };
            // A fault whose figures change goes on.
            let same = |span: &&mut FaultSpan| {
                span.fault.is_alike(&fault) && sample.time_secs - span.end_secs <= PAUSE_SECS
            };
            if let Some(span) = spans.last_mut().filter(same) {
                span.end_secs = sample.time_secs;
            } else {
                spans.push(FaultSpan {
                    start_secs: sample.time_secs,
                    end_secs: sample.time_secs,
                    fault,
                });
            }
        }
        spans
    }
}

/// A fault, and the times between which a monitor reported it, on the recording's clock.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FaultSpan {
    /// First sample at which it was reported, seconds.
    pub start_secs: f64,
    /// Last sample, seconds.
    pub end_secs: f64,
    /// Fault as first reported.
    pub fault: StreamFault,
}

fn channels(sample: &ImuSample) -> [f32; CHANNELS] {
    let (force, rate) = (sample.force, sample.rate);
    [force.x, force.y, force.z, rate.x, rate.y, rate.z]
}

#[cfg(test)]
mod tests;
