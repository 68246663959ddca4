//! One sensor: its samples on their way to frames.

use crate::measure::SensorFrame;
use footfall_imu::{ContactMeter, FeatureStream, ImuRecording, ImuSample, ToldContact};
use glam::Quat;

/// Frames of one sensor that wait for the other's; more mean that the other has stopped.
const MOST_WAITING: usize = 6;

/// Samples in the site's axes, to frames.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frames {
    stream: FeatureStream,
    /// Of a sensor on a foot.
    contact: Option<ContactMeter>,
}

impl Frames {
    pub(crate) fn new(frame_rate_hz: f64, on_foot: bool) -> Self {
        Self {
            stream: FeatureStream::new(frame_rate_hz),
            contact: on_foot.then(ContactMeter::default),
        }
    }

    /// The frames of a whole recording.
    pub(crate) fn of(
        recording: &ImuRecording,
        frame_rate_hz: f64,
        on_foot: bool,
    ) -> Vec<SensorFrame> {
        let mut all = Self::new(frame_rate_hz, on_foot);
        let mut frames = Vec::new();
        for sample in &recording.samples {
            all.push(*sample, |frame| frames.push(frame));
        }
        frames
    }

    /// Takes a sample and gives every frame that it completes.
    fn push(&mut self, sample: ImuSample, mut give: impl FnMut(SensorFrame)) {
        if let Some(contact) = &mut self.contact {
            contact.push(sample);
        }
        let contact = &self.contact;
        self.stream.push(sample, |frame| {
            let contact = contact.as_ref().and_then(|c| c.told(frame.time_secs));
            give(SensorFrame { frame, contact });
        });
    }

    /// Returns the contact of the foot that wears the sensor.
    pub(crate) fn contact(&self) -> Option<ToldContact> {
        self.contact.as_ref().and_then(ContactMeter::contact)
    }
}

/// A sensor as it is worn, and its frames that nobody has taken yet.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sensor {
    /// `site_from_sensor` rotation.
    mounting: Quat,
    frame_rate_hz: f64,
    frames: Frames,
    waiting: [Option<SensorFrame>; MOST_WAITING],
    count: usize,
}

impl Sensor {
    pub(crate) fn new(frame_rate_hz: f64, on_foot: bool) -> Self {
        Self {
            mounting: Quat::IDENTITY,
            frame_rate_hz,
            frames: Frames::new(frame_rate_hz, on_foot),
            waiting: [None; MOST_WAITING],
            count: 0,
        }
    }

    /// Is worn otherwise from now on: what it measured in other axes means nothing any more.
    pub(crate) fn set_mounting(&mut self, site_from_sensor: Quat) {
        self.mounting = site_from_sensor;
        self.frames = Frames::new(self.frame_rate_hz, self.frames.contact.is_some());
    }

    /// Forgets everything but how it is worn.
    pub(crate) fn reset(&mut self) {
        *self = Self {
            mounting: self.mounting,
            ..Self::new(self.frame_rate_hz, self.frames.contact.is_some())
        };
    }

    /// Takes a sample in the sensor's axes; the oldest frame goes when too many wait.
    pub(crate) fn push(&mut self, sample: ImuSample) {
        let Self {
            mounting,
            frames,
            waiting,
            count,
            ..
        } = self;
        frames.push(sample.turned(*mounting), |frame| {
            if *count == MOST_WAITING {
                waiting.rotate_left(1);
                *count -= 1;
            }
            waiting[*count] = Some(frame);
            *count += 1;
        });
    }

    /// When the oldest frame that waits ends.
    pub(crate) fn next_secs(&self) -> Option<f64> {
        self.waiting[0].map(|heard| heard.frame.time_secs)
    }

    pub(crate) const fn is_full(&self) -> bool {
        self.count == MOST_WAITING
    }

    pub(crate) fn take(&mut self) -> Option<SensorFrame> {
        let first = self.waiting[0].take();
        if first.is_some() {
            self.waiting.rotate_left(1);
            self.count -= 1;
        }
        first
    }

    /// Returns the contact of the foot that wears it, as of the last sample.
    pub(crate) fn contact(&self) -> Option<ToldContact> {
        self.frames.contact()
    }

    /// Samples that were not finite, repeated or late.
    pub(crate) const fn rejected(&self) -> u64 {
        self.frames.stream.rejected()
    }
}
