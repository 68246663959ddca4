//! Monitoring of one sensor: its samples, and its orientation.

use crate::problem::SensorProblem;
use crate::wear::{Posture, WearMonitor};
use footfall_imu::{ImuRecording, ImuSample, StreamFault, StreamMonitor};
use footfall_model::CalibratedSensor;
use glam::Vec3;

/// Monitors of one sensor.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Watch {
    stream: StreamMonitor,
    wear: WearMonitor,
}

impl Watch {
    /// Creates the monitors of a sensor with this vertical on a standing person, and optionally a promised sample rate.
    pub(crate) const fn new(standing_up: Vec3, promised_hz: Option<f64>) -> Self {
        Self {
            stream: StreamMonitor::new(promised_hz),
            wear: WearMonitor::new(standing_up),
        }
    }

    /// Restarts with another mounting.
    pub(crate) const fn forget_mounting(&mut self) {
        self.wear.reset();
    }

    /// Discards the samples.
    pub(crate) const fn reset(&mut self) {
        self.stream.reset();
        self.wear.reset();
    }

    /// Measures gravity of this strength at rest.
    pub(crate) const fn set_gravity(&mut self, gravity_mps2: f32) {
        self.wear.set_gravity(gravity_mps2);
    }

    /// Strength of gravity by the sensor's scale, where it was still.
    pub(crate) fn gravity_mps2(&self) -> Option<f32> {
        self.wear.gravity_mps2()
    }

    /// Sets the promised sample rate.
    pub(crate) const fn promise_rate(&mut self, rate_hz: f64) {
        self.stream = StreamMonitor::new(Some(rate_hz));
    }

    /// Takes a sample in the sensor's axes and, where the mounting is known, in the site's.
    pub(crate) fn push(&mut self, sample: &ImuSample, worn: Option<&ImuSample>) {
        self.stream.push(*sample);
        // Who walks with an axis that is stuck seems to ride until the fault is certain.
        let worn = worn.filter(|worn| worn.is_finite() && !self.stream.suspects_axes());
        if let Some(worn) = worn {
            self.wear.push(worn);
        }
    }

    /// Returns true when the samples are unusable, so that the wearer is assumed to stand.
    pub(crate) fn is_blind(&self) -> bool {
        self.wear.posture() != Posture::Worn
            || self.stream.fault().is_some_and(|fault| fault.is_blinding())
    }

    /// The gravest problem.
    pub(crate) fn problem(&self) -> Option<SensorProblem> {
        let fault = self.stream.fault();
        let posture = match self.wear.posture() {
            Posture::Worn => None,
            Posture::Lies => Some(SensorProblem::Lies),
            Posture::Rides => Some(SensorProblem::Rides),
        };
        let grave = fault.filter(StreamFault::is_blinding);
        let grave = grave.map(SensorProblem::Stream);
        grave.or(posture).or(fault.map(SensorProblem::Stream))
    }
}

/// A sensor's recording, ready for a reconstructor.
#[derive(Clone, Debug, PartialEq)]
pub struct WornRecording {
    /// Samples in the site's axes. Unusable ones are left out, or replaced by those of a standing person.
    pub recording: ImuRecording,
    /// Problems, with their times.
    pub problems: Vec<ProblemSpan>,
}

/// A problem with a sensor, and the times between which it was reported.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProblemSpan {
    /// First sample at which it was reported, on the recording's clock, seconds.
    pub start_secs: f64,
    /// Last sample, seconds.
    pub end_secs: f64,
    /// Problem as first reported.
    pub problem: SensorProblem,
}

/// Pause up to which problems count as one, seconds.
const ONE_SECS: f64 = 1.0;

impl WornRecording {
    /// Checks a recording in the sensor's axes, of a sensor with this calibration. Unusable samples are left out if another sensor continues, or replaced by those of a
    /// standing person if this sensor is `alone`.
    pub(crate) fn watched(
        mut watch: Watch,
        recording: &ImuRecording,
        calibrated: &CalibratedSensor,
        alone: bool,
    ) -> Self {
        let mut problems: Vec<ProblemSpan> = Vec::new();
        let mut samples = Vec::with_capacity(recording.samples.len());
        for sample in &recording.samples {
            let worn = ImuSample {
                rate: sample.rate - calibrated.rate_bias,
                ..*sample
            };
            let worn = worn.turned(calibrated.site_from_sensor);
            watch.push(sample, Some(&worn));
            if !watch.is_blind() {
                samples.push(worn);
            } else if alone {
                samples.push(ImuSample::standing(sample.time_secs));
            }
            if let Some(problem) = watch.problem() {
                note(&mut problems, sample.time_secs, problem);
            }
        }
        Self {
            recording: ImuRecording { samples },
            problems,
        }
    }
}

/// Adds a problem that is reported at a time.
fn note(problems: &mut Vec<ProblemSpan>, time_secs: f64, problem: SensorProblem) {
    let goes_on = |span: &&mut ProblemSpan| {
        span.problem.is_alike(&problem) && time_secs - span.end_secs <= ONE_SECS
    };
    if let Some(span) = problems.last_mut().filter(goes_on) {
        span.end_secs = time_secs;
    } else {
        problems.push(ProblemSpan {
            start_secs: time_secs,
            end_secs: time_secs,
            problem,
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f32::consts::TAU;

    #[test]
    fn whoever_walks_with_a_stuck_axis_does_not_ride() {
        let reported = |stuck: bool| {
            let mut watch = Watch::new(Vec3::Y, Some(100.0));
            let mut reported = Vec::new();
            for n in 0..600_u32 {
                let secs = f64::from(n) * 0.01;
                let walks = n >= 200;
                let phase = TAU * 1.8 * secs as f32;
                let swing = if walks { phase.sin() } else { 0.0 };
                let turns = if walks && stuck { 0.25 } else { 3.0 * swing };
                let [yaw, roll] = [0.15 * phase.sin(), 0.15 * phase.cos()];
                let sample = ImuSample {
                    time_secs: secs,
                    force: Vec3::new(yaw, 9.8 + 4.0 * swing.abs(), roll),
                    rate: Vec3::new(turns, yaw, roll),
                };
                watch.push(&sample, Some(&sample));
                let kind = watch.problem();
                if reported.last() != Some(&kind) {
                    reported.push(kind);
                }
            }
            reported
        };
        assert_eq!(reported(false), [None]);
        let problems = reported(true);
        let [
            None,
            Some(SensorProblem::Stream(StreamFault::StuckAxis { .. })),
        ] = problems[..]
        else {
            panic!("{problems:?}");
        };
    }
}
