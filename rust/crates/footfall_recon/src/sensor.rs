//! One sensor: its samples on their way to frames.

use crate::measure::SensorFrame;
use crate::problem::SensorProblem;
use crate::watch::Watch;
use footfall_imu::{ContactMeter, FeatureStream, ImuRecording, ImuSample, SensorContact};
use glam::{Quat, Vec3};

/// Frames of one sensor that wait for the other's; more mean that the other has stopped.
const MOST_WAITING: usize = 6;

/// Samples in the site's axes, to frames.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frames {
    stream: FeatureStream,
    /// Contact meter of a sensor on a foot.
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
            let contact = contact.as_ref().and_then(|c| c.contact_at(frame.time_secs));
            give(SensorFrame { frame, contact });
        });
    }

    /// Returns the contact of the foot that wears the sensor.
    pub(crate) fn contact(&self) -> Option<SensorContact> {
        self.contact.as_ref().and_then(ContactMeter::contact)
    }
}

/// Use of a sensor's samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Sight {
    /// Usable.
    Sees,
    /// Unusable: the body stands.
    Blind,
}

/// A worn sensor, and its frames that wait to be used.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sensor {
    /// `site_from_sensor` rotation; `None` while it is unknown.
    mounting: Option<Quat>,
    /// Angular rate at rest, in the sensor's axes, as it was calibrated.
    rate_bias: Vec3,
    watch: Watch,
    sight: Sight,
    frame_rate_hz: f64,
    frames: Frames,
    waiting: [Option<SensorFrame>; MOST_WAITING],
    count: usize,
}

impl Sensor {
    /// Creates an aligned sensor with this vertical on a standing person.
    pub(crate) fn new(frame_rate_hz: f64, on_foot: bool, standing_up: Vec3) -> Self {
        Self {
            mounting: Some(Quat::IDENTITY),
            rate_bias: Vec3::ZERO,
            watch: Watch::new(standing_up, None),
            sight: Sight::Sees,
            frame_rate_hz,
            frames: Frames::new(frame_rate_hz, on_foot),
            waiting: [None; MOST_WAITING],
            count: 0,
        }
    }

    /// Sets another mounting, or none: earlier measurements in other axes are discarded.
    pub(crate) fn set_mounting(&mut self, site_from_sensor: Option<Quat>) {
        self.mounting = site_from_sensor;
        self.watch.forget_mounting();
        self.forget_samples();
    }

    /// Measures this at rest: the angular rate in the sensor's axes, and the strength of gravity.
    pub(crate) const fn set_rest(&mut self, rate_bias: Vec3, gravity_mps2: f32) {
        self.rate_bias = rate_bias;
        self.watch.set_gravity(gravity_mps2);
    }

    /// The mounting, where it is known.
    pub(crate) const fn mounting(&self) -> Option<Quat> {
        self.mounting
    }

    /// Angular rate at rest, in the sensor's axes: what was calibrated and what was learned since.
    pub(crate) fn rate_bias(&self) -> Vec3 {
        let learned = self.frames.stream.filter().bias();
        self.mounting.map_or(self.rate_bias, |site_from_sensor| {
            self.rate_bias + site_from_sensor.inverse() * learned
        })
    }

    /// Strength of gravity by this sensor's scale, where it was still, m/s².
    pub(crate) fn gravity_mps2(&self) -> Option<f32> {
        self.watch.gravity_mps2()
    }

    /// Sets the promised sample rate.
    pub(crate) const fn promise_rate(&mut self, rate_hz: f64) {
        self.watch.promise_rate(rate_hz);
    }

    fn forget_samples(&mut self) {
        self.frames = Frames::new(self.frame_rate_hz, self.frames.contact.is_some());
    }

    /// Forgets everything but how it is worn.
    pub(crate) fn reset(&mut self) {
        self.forget_samples();
        self.watch.reset();
        self.sight = Sight::Sees;
        (self.waiting, self.count) = ([None; MOST_WAITING], 0);
    }

    /// Problem with the samples or with how the sensor lies.
    pub(crate) fn problem(&self) -> Option<SensorProblem> {
        self.watch.problem()
    }

    /// Use of its samples now.
    pub(crate) const fn sight(&self) -> Sight {
        self.sight
    }

    /// Adds a sample in the sensor's axes; the oldest frame is dropped when too many wait. While the samples are unusable, the person is assumed to stand, or,
    /// if another sensor is usable (`other_sees`), frames are empty. Returns true when that changes.
    pub(crate) fn push(&mut self, mut sample: ImuSample, other_sees: bool) -> bool {
        let raw = sample;
        sample.rate -= self.rate_bias;
        let worn = self.mounting.map(|mounting| sample.turned(mounting));
        self.watch.push(&raw, worn.as_ref());
        let sight = if worn.is_none() || self.watch.is_blind() {
            Sight::Blind
        } else {
            Sight::Sees
        };
        let changed = sight != self.sight;
        if changed {
            self.sight = sight;
            self.forget_samples();
        }
        let understood = match (sight, worn) {
            (Sight::Sees, Some(worn)) => worn,
            _ if sample.is_finite() => ImuSample::standing(sample.time_secs),
            _ => sample,
        };
        let empty = sight == Sight::Blind && other_sees;
        let Self {
            frames,
            waiting,
            count,
            ..
        } = self;
        frames.push(understood, |mut frame| {
            if empty {
                (frame.frame.values, frame.contact) = (None, None);
            }
            if *count == MOST_WAITING {
                waiting.rotate_left(1);
                *count -= 1;
            }
            waiting[*count] = Some(frame);
            *count += 1;
        });
        changed
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
    pub(crate) fn contact(&self) -> Option<SensorContact> {
        self.frames.contact()
    }

    /// Samples that were not finite, repeated or late.
    pub(crate) const fn rejected(&self) -> u64 {
        self.frames.stream.rejected()
    }
}
