//! Features that a reconstructor compares with its model: samples at any rate become frames at the model's.
//!
//! A frame holds means over the time since the frame before, so that recordings of any rate are band-limited alike. It is complete when its
//! time is reached and waits for no later sample.

use crate::orientation::OrientationFilter;
use crate::sample::{ImuRecording, ImuSample};
use glam::{Quat, Vec3};

/// Numbers a sensor gives in a frame: angular rate (rad/s), specific force (m/s²), and up, each x, y, z in the sensor's axes.
pub const SENSOR_FEATURES: usize = 9;

/// Longest gap that is interpolated linearly, seconds; in a longer one frames are missing.
const LONGEST_BRIDGE_SECS: f64 = 0.1;

/// After a gap of this length nothing is known any more, seconds.
const LONGEST_GAP_SECS: f64 = 10.0;

/// One frame of one sensor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FeatureFrame {
    /// The end of the frame on the sensor's clock, seconds.
    pub time_secs: f64,
    /// Measured features; `None` when samples were missing.
    pub values: Option<[f32; SENSOR_FEATURES]>,
    /// Standard deviation of up, radians.
    pub tilt_deviation: f32,
    /// `world_from_sensor` rotation at the end of the frame.
    pub world_from_sensor: Quat,
}

/// Turns one sensor's samples into frames. Allocates nothing.
#[derive(Clone, Copy, Debug)]
pub struct FeatureStream {
    period_secs: f64,
    filter: OrientationFilter,
    last: Option<ImuSample>,
    frame_end_secs: f64,
    force: Vec3,
    rate: Vec3,
    covered_secs: f64,
    rejected: u64,
}

impl FeatureStream {
    /// Creates a stream with this frame rate.
    pub fn new(frame_rate_hz: f64) -> Self {
        Self {
            period_secs: 1.0 / frame_rate_hz,
            filter: OrientationFilter::new(Vec3::Y),
            last: None,
            frame_end_secs: 0.0,
            force: Vec3::ZERO,
            rate: Vec3::ZERO,
            covered_secs: 0.0,
            rejected: 0,
        }
    }

    /// The frames of a whole recording.
    pub fn frames_of(recording: &ImuRecording, frame_rate_hz: f64) -> Vec<FeatureFrame> {
        let mut stream = Self::new(frame_rate_hz);
        let mut frames = Vec::new();
        for sample in &recording.samples {
            stream.push(*sample, |frame| frames.push(frame));
        }
        frames
    }

    /// Samples that were not finite, repeated or came after later ones.
    pub const fn rejected(&self) -> u64 {
        self.rejected
    }

    /// The orientation so far.
    pub const fn filter(&self) -> &OrientationFilter {
        &self.filter
    }

    /// Takes a sample and gives every frame that it completes.
    pub fn push(&mut self, sample: ImuSample, mut give: impl FnMut(FeatureFrame)) {
        let Some(last) = self.last else {
            if sample.is_finite() {
                self.begin(sample);
            } else {
                self.rejected += 1;
            }
            return;
        };
        if !sample.is_finite() || sample.time_secs <= last.time_secs {
            self.rejected += 1;
            return;
        }
        let gap_secs = sample.time_secs - last.time_secs;
        if gap_secs > LONGEST_GAP_SECS {
            self.begin(sample);
            return;
        }
        let bridged = gap_secs <= LONGEST_BRIDGE_SECS.max(2.0 * self.period_secs);
        let mut from = last;
        while self.frame_end_secs <= sample.time_secs {
            let end = last.towards(&sample, self.frame_end_secs);
            if bridged {
                self.cover(&from, &end);
            }
            self.give_frame(&mut give);
            from = end;
        }
        if bridged {
            self.cover(&from, &sample);
        }
        self.last = Some(sample);
    }

    fn begin(&mut self, sample: ImuSample) {
        let rejected = self.rejected;
        *self = Self::new(1.0 / self.period_secs);
        self.rejected = rejected;
        self.filter = OrientationFilter::new(sample.force);
        self.frame_end_secs = sample.time_secs + self.period_secs;
        self.last = Some(sample);
    }

    /// Adds the time between two samples to the frame.
    fn cover(&mut self, from: &ImuSample, to: &ImuSample) {
        let dt = to.time_secs - from.time_secs;
        if dt <= 0.0 {
            return;
        }
        let (force, rate) = (0.5 * (from.force + to.force), 0.5 * (from.rate + to.rate));
        self.filter.step(dt as f32, force, rate);
        self.force += force * dt as f32;
        self.rate += (rate - self.filter.bias()) * dt as f32;
        self.covered_secs += dt;
    }

    fn give_frame(&mut self, give: &mut impl FnMut(FeatureFrame)) {
        // A frame of which less than half was measured has no features.
        let values = (self.covered_secs > 0.5 * self.period_secs).then(|| {
            let secs = self.covered_secs as f32;
            let parts = [self.rate / secs, self.force / secs, self.filter.up()];
            let mut values = [0.0; SENSOR_FEATURES];
            for (values, part) in values.chunks_exact_mut(3).zip(parts) {
                values.copy_from_slice(&part.to_array());
            }
            values
        });
        give(FeatureFrame {
            time_secs: self.frame_end_secs,
            values,
            tilt_deviation: self.filter.tilt_deviation(),
            world_from_sensor: self.filter.world_from_sensor(),
        });
        self.frame_end_secs += self.period_secs;
        (self.force, self.rate, self.covered_secs) = (Vec3::ZERO, Vec3::ZERO, 0.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample::GRAVITY_MPS2;

    fn sample(time_secs: f64) -> ImuSample {
        ImuSample {
            time_secs,
            force: Vec3::new(0.0, GRAVITY_MPS2, 0.0),
            rate: Vec3::new(time_secs as f32, 0.0, 0.0),
        }
    }

    fn frames(times: impl Iterator<Item = f64>) -> (Vec<FeatureFrame>, u64) {
        let mut stream = FeatureStream::new(30.0);
        let mut frames = Vec::new();
        for time in times {
            stream.push(sample(time), |frame| frames.push(frame));
        }
        (frames, stream.rejected())
    }

    #[test]
    fn frames_are_means_whatever_the_rate() {
        for rate_hz in [40.0, 100.0, 204.8] {
            let (frames, rejected) = frames((0..=(rate_hz as usize)).map(|n| n as f64 / rate_hz));
            assert!((29..=30).contains(&frames.len()), "{}", frames.len());
            assert_eq!(rejected, 0);
            for frame in &frames {
                let values = frame.values.unwrap();
                let middle = frame.time_secs - 1.0 / 60.0;
                assert!((f64::from(values[0]) - middle).abs() < 1e-4);
                assert!((values[4] - GRAVITY_MPS2).abs() < 1e-4);
            }
        }
    }

    #[test]
    fn a_gap_gives_missing_frames_and_late_samples_are_left_out() {
        let times = (0..100).map(|n| f64::from(n) * 0.01);
        let (frames, rejected) = frames(times.filter(|t| !(0.3..0.6).contains(t)));
        assert_eq!(rejected, 0);
        let missing = frames.iter().filter(|frame| frame.values.is_none()).count();
        assert!((8..=10).contains(&missing), "{missing} missing");
        let steps = frames
            .windows(2)
            .map(|pair| pair[1].time_secs - pair[0].time_secs);
        assert!(
            steps
                .into_iter()
                .all(|step| (step - 1.0 / 30.0).abs() < 1e-9)
        );

        let mut stream = FeatureStream::new(30.0);
        for time in [0.0, 0.01, 0.02, 0.01, 0.02, f64::NAN, 0.03] {
            stream.push(sample(time), |_| {});
        }
        assert_eq!(stream.rejected(), 3);
    }
}
