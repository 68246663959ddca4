//! Observation of devices while they are watched.

use anyhow::{Context as _, Result};
use footfall_imu::ImuSample;
use footfall_imu::live::device::now_secs;
use footfall_imu::live::recorder::Recorder;
use footfall_imu::live::{Device, Link};
use glam::Vec3;
use serde::Serialize;

/// Weight of a new sample in the mean force, whose direction gives the axis that points up.
const MEAN_GAIN: f32 = 0.02;

/// Time without samples after which a device counts as silent, seconds.
const SILENT_SECS: f64 = 0.5;

/// Report that is printed as JSON.
#[derive(Serialize)]
pub(super) struct Report {
    pub(super) seconds: f64,
    pub(super) state: &'static str,
    pub(super) message: String,
    /// Bytes or packets that were no message.
    pub(super) garbage: u64,
    pub(super) devices: Vec<DeviceReport>,
}

#[derive(Serialize)]
pub(super) struct DeviceReport {
    pub(super) name: String,
    pub(super) format: &'static str,
    pub(super) samples: u64,
    pub(super) lost: u64,
    rejected: u64,
    rate_hz: f64,
    jitter_ms: f64,
    delay_ms: f64,
    longest_gap_ms: f64,
    silent_s: f64,
    /// The sensor's axis that points up on average.
    up: &'static str,
    force_mps2: [f32; 3],
    rate_radps: [f32; 3],
    fault: Option<String>,
}

/// One device, watched.
struct Watched {
    device: Device,
    mean_force: Vec3,
    longest_gap_secs: f64,
    last: Option<ImuSample>,
}

pub(super) struct Watch {
    begin_secs: f64,
    told_secs: f64,
    message: String,
    devices: Vec<Watched>,
}

impl Watch {
    pub(super) fn new() -> Self {
        Self {
            begin_secs: now_secs(),
            told_secs: now_secs(),
            message: String::new(),
            devices: Vec::new(),
        }
    }

    pub(super) fn seconds(&self) -> f64 {
        now_secs() - self.begin_secs
    }

    /// Takes what came.
    pub(super) fn look(&mut self, link: &Link, mut recorder: Option<&mut Recorder>) -> Result<()> {
        for device in link.devices().into_iter().skip(self.devices.len()) {
            self.devices.push(Watched {
                device,
                mean_force: Vec3::ZERO,
                longest_gap_secs: 0.0,
                last: None,
            });
        }
        for (place, watched) in self.devices.iter_mut().enumerate() {
            let mut written = Ok(());
            watched.device.clone().take(|sample| {
                watched.see(sample);
                if let Some(recorder) = recorder.as_deref_mut().filter(|_| place == 0)
                    && written.is_ok()
                {
                    written = recorder.push(sample);
                }
            });
            written.context("the recording cannot be written; is the disk full?")?;
        }
        Ok(())
    }

    /// A line for each device every second, and one whenever the port's state changes.
    pub(super) fn due(&mut self, link: &Link) -> Option<String> {
        let state = link.state();
        let mut lines = Vec::new();
        if state.message() != self.message {
            state.message().clone_into(&mut self.message);
            if !self.message.is_empty() {
                lines.push(self.message.clone());
            }
        }
        if now_secs() - self.told_secs >= 1.0 {
            self.told_secs += 1.0;
            let seconds = self.seconds();
            lines.extend(self.devices.iter().map(|watched| watched.line(seconds)));
        }
        (!lines.is_empty()).then(|| lines.join("\n"))
    }

    pub(super) fn report(&self, link: &Link) -> Report {
        let state = link.state();
        Report {
            seconds: self.seconds(),
            state: state.name(),
            message: state.message().to_owned(),
            garbage: link.garbage(),
            devices: self.devices.iter().map(Watched::report).collect(),
        }
    }
}

impl Watched {
    fn see(&mut self, sample: ImuSample) {
        let gap = self
            .last
            .map_or(0.0, |last| sample.time_secs - last.time_secs);
        self.longest_gap_secs = self.longest_gap_secs.max(gap);
        let gain = if self.last.is_none() { 1.0 } else { MEAN_GAIN };
        self.mean_force += (sample.force - self.mean_force) * gain;
        self.last = Some(sample);
    }

    fn report(&self) -> DeviceReport {
        let status = self.device.status();
        let last = self.last;
        DeviceReport {
            samples: status.samples,
            lost: status.lost,
            rejected: status.rejected,
            rate_hz: status.rate_hz,
            jitter_ms: status.jitter_secs * 1e3,
            delay_ms: status.delay_secs * 1e3,
            longest_gap_ms: self.longest_gap_secs * 1e3,
            silent_s: status.silent_secs(),
            up: up(self.mean_force),
            force_mps2: last.map_or([0.0; 3], |sample| sample.force.to_array()),
            rate_radps: last.map_or([0.0; 3], |sample| sample.rate.to_array()),
            fault: status.fault,
            format: status.format,
            name: status.name,
        }
    }

    fn line(&self, seconds: f64) -> String {
        let report = self.report();
        let head = format!("{seconds:5.0} s  {} ({})", report.name, report.format);
        if report.silent_s > SILENT_SECS {
            return format!("{head}  silent for {:.1} s", report.silent_s);
        }
        let length = |v: [f32; 3]| Vec3::from_array(v).length();
        let mut line = format!(
            "{head}  {:.1} Hz  jitter {:.1} ms  lost {}  force {:5.2} m/s²  rate {:5.2} rad/s  up {}",
            report.rate_hz,
            report.jitter_ms,
            report.lost,
            length(report.force_mps2),
            length(report.rate_radps),
            report.up,
        );
        if let Some(fault) = report.fault {
            line.push_str("\n        ");
            line.push_str(&fault);
        }
        line
    }
}

/// The axis along which a force is greatest.
fn up(force: Vec3) -> &'static str {
    let size = force.abs();
    let (positive, negative, value) = if size.x >= size.y && size.x >= size.z {
        ("+x", "-x", force.x)
    } else if size.y >= size.z {
        ("+y", "-y", force.y)
    } else {
        ("+z", "-z", force.z)
    };
    if value >= 0.0 { positive } else { negative }
}
