//! Live reconstruction: samples to poses.

mod sensors;

use crate::blend::{Blend, Blending};
use crate::confidence::Confidence;
use crate::ground::{Ground, GroundInput};
use crate::measure::{SensorFrames, measure, sensor_heading};
use crate::prepared::Prepared;
use crate::problem::SensorProblem;
use crate::sensor::{Sensor, Sight};
use crate::shown_behaviour::ShownBehaviour;
use crate::stride_phase::StrideClock;
use crate::tracker::{Measurement, Tracker, TrackerConfig};
use crate::travel::Travel;
use footfall_core::rotation::from_heading;
use footfall_core::{Behaviour, Pose, Skeleton, SkeletonError};
use footfall_imu::{ImuSample, SensorContact};
use footfall_model::imu_model::MAX_SENSORS;
use glam::Vec3;
use std::sync::Arc;

/// Difference in time beyond which sensors have clocks of their own, seconds.
const ONE_CLOCK_SECS: f64 = 2.0;

/// Confidence below which the body stands.
const UNEXPLAINED: f32 = 0.1;

/// Time for which a contact that a sensor has reported holds, seconds.
const CONTACT_VALID_SECS: f32 = 0.1;

/// Settings of a reconstructor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReconConfig {
    /// Settings of the tracker.
    pub tracker: TrackerConfig,
    /// Transition of the body between segments of the recordings.
    pub blending: Blending,
    /// Silence after which a sensor counts as lost, seconds.
    pub lost_after_secs: f32,
    /// If true, the body stands where the model explains little of the measurements, instead of showing the best explanation.
    pub stands_unexplained: bool,
    /// Probability above which a new behaviour is shown.
    pub behaviour_probability: f32,
    /// Length of the wearer's steps relative to the people in the model, before any is measured.
    pub stride: f32,
}

impl Default for ReconConfig {
    fn default() -> Self {
        Self {
            tracker: TrackerConfig::default(),
            blending: Blending::Inertial {
                rates: [50.0, 10.0],
            },
            lost_after_secs: 0.5,
            stands_unexplained: true,
            behaviour_probability: 0.6,
            stride: 1.0,
        }
    }
}

/// Reception of the sensors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SensorState {
    /// No samples yet.
    Waiting,
    /// Samples arrive.
    Tracking,
    /// No samples for [`ReconConfig::lost_after_secs`]; the body continues as is probable, then stands.
    Lost,
}

/// Turns samples of one or two sensors into the poses of one body. [`push`](Self::push) and [`step`](Self::step) allocate nothing and cannot
/// fail.
#[derive(Clone, Debug)]
pub struct Reconstructor {
    prepared: Arc<Prepared>,
    config: ReconConfig,
    tracker: Tracker,
    blend: Blend,
    ground: Ground,
    sensors: [Sensor; MAX_SENSORS],
    /// Result of examining each sensor's samples.
    findings: [Option<SensorProblem>; MAX_SENSORS],
    /// Time in which the model explained little, seconds.
    unexplained_secs: f32,
    travel: Travel,
    clock: StrideClock,
    confidence: Confidence,
    behaviour: ShownBehaviour,
    silent_secs: f32,
    /// Number of frames shown beyond the last measured one.
    ahead: f32,
    heading: Option<f32>,
}

impl Reconstructor {
    /// Creates a reconstructor for a body with these proportions.
    ///
    /// # Errors
    /// [`SkeletonError`] names a leg or foot without length.
    pub fn new(
        prepared: &Arc<Prepared>,
        skeleton: &Skeleton,
        config: &ReconConfig,
    ) -> Result<Self, SkeletonError> {
        skeleton.check()?;
        let rate = prepared.model.frame_rate_hz;
        let sites = &prepared.model.sites;
        let on_foot = |n: usize| sites.get(n).is_some_and(|site| site.is_foot());
        Ok(Self {
            tracker: Tracker::new(prepared, config.tracker),
            blend: Blend::new(config.blending, rate as f32),
            ground: Ground::new(skeleton, &prepared.model.skeleton),
            sensors: core::array::from_fn(|n| {
                Sensor::new(rate, on_foot(n), prepared.standing_up[n])
            }),
            findings: [None; MAX_SENSORS],
            travel: Travel::new(&prepared.model.sites, config.stride),
            clock: StrideClock::new(prepared),
            confidence: Confidence::new(config.stands_unexplained),
            behaviour: ShownBehaviour::new(),
            silent_secs: 0.0,
            unexplained_secs: 0.0,
            ahead: 0.0,
            heading: None,
            config: *config,
            prepared: Arc::clone(prepared),
        })
    }

    /// Discards all measurements; the body stands at the origin.
    pub fn reset(&mut self) {
        for sensor in &mut self.sensors {
            sensor.reset();
        }
        self.tracker.reset();
        self.blend.reset();
        self.ground.reset();
        self.travel = Travel::new(&self.prepared.model.sites, self.config.stride);
        self.clock.forget();
        self.confidence = Confidence::new(self.config.stands_unexplained);
        self.behaviour = ShownBehaviour::new();
        (self.silent_secs, self.ahead, self.unexplained_secs) = (0.0, 0.0, 0.0);
        self.findings = [None; MAX_SENSORS];
        self.heading = None;
    }

    /// Sets the heading of the direction in which the body faces now, radians.
    pub fn reset_heading(&mut self, heading: f32) {
        self.ground.set_heading(heading);
    }

    /// Returns the heading of the body, radians.
    pub const fn heading(&self) -> f32 {
        self.ground.heading()
    }

    /// Returns the shown behaviour; each is shown for at least 0.2 s.
    pub const fn behaviour(&self) -> Behaviour {
        self.behaviour.behaviour()
    }

    /// Reception of the sensors.
    pub fn sensor_state(&self) -> SensorState {
        if !self.blend.started() {
            SensorState::Waiting
        } else if self.silent_secs > self.config.lost_after_secs {
            SensorState::Lost
        } else {
            SensorState::Tracking
        }
    }

    /// Returns the confidence, 0 to 1: the probability that the current motion is among those the model learned. 0 without samples.
    /// The body stands at low confidence.
    pub fn confidence(&self) -> f32 {
        match self.sensor_state() {
            SensorState::Tracking => self.confidence.value(),
            SensorState::Waiting | SensorState::Lost => 0.0,
        }
    }

    /// Returns the footprints of the feet that landed in the last step, metres.
    pub fn landings(&self) -> [Option<Vec3>; 2] {
        self.ground.landings()
    }

    /// Returns true for the left and the right foot while it stands.
    pub fn stands(&self) -> [bool; 2] {
        self.ground.stands()
    }

    /// Returns the probabilities of the behaviours, in the order of [`Behaviour::ALL`].
    pub const fn behaviours(&self) -> &[f32; Behaviour::ALL.len()] {
        self.tracker.behaviours()
    }

    /// Writes the probability of each phase of the model, in the order of [`ImuModel::phases`](footfall_model::ImuModel::phases).
    pub fn phase_probabilities(&self, out: &mut Vec<f32>) {
        let model = &self.prepared.model;
        out.clear();
        out.resize(model.phases.len(), 0.0);
        for (frame, probability) in self.tracker.probabilities().iter().enumerate() {
            // Frames are filled up to whole blocks.
            if let Some(segment) = self.prepared.segment_of.get(frame) {
                out[usize::from(model.segments[*segment as usize].phase)] += probability;
            }
        }
    }

    /// Returns the number of samples that were not finite, repeated or late.
    pub fn rejected_samples(&self) -> u64 {
        self.sensors.iter().map(Sensor::rejected).sum()
    }

    /// Adds a sample of a sensor (0, or 1 for the second site of the model); other sensors are ignored.
    pub fn push(&mut self, sensor: usize, sample: ImuSample) {
        let used = self.prepared.model.sites.len();
        if sensor >= used {
            return;
        }
        let sees = |n: usize| n != sensor && self.sensors[n].sight() == Sight::Sees;
        let other_sees = (0..used).any(sees);
        let own = &mut self.sensors[sensor];
        let changed = own.push(sample, other_sees);
        let sees = own.sight() == Sight::Sees;
        if changed {
            self.forget_samples();
            // A step that ends with a foot at rest would go on with one.
            if !sees && !other_sees {
                self.tracker.stand();
            }
        }
        if sees {
            self.travel.push(sensor, sample);
        }
        self.catch_up();
    }

    /// Advances by a frame of the model as often as every sensor has one, or one of them has too many. Sensors on one clock advance together when
    /// their frames end together: a sensor that started earlier or lost more samples advances alone until the other has caught up.
    fn catch_up(&mut self) {
        let used = self.prepared.model.sites.len();
        let period_secs = 1.0 / self.prepared.model.frame_rate_hz;
        loop {
            let sensors = &mut self.sensors[..used];
            let all = sensors.iter().all(|sensor| sensor.next_secs().is_some());
            let full = sensors.iter().any(Sensor::is_full);
            if !all && !full {
                return;
            }
            let oldest = sensors
                .iter()
                .filter_map(Sensor::next_secs)
                .fold(f64::INFINITY, f64::min);
            let mut frames = [None; MAX_SENSORS];
            for (frame, sensor) in frames.iter_mut().zip(sensors) {
                let ahead_secs = sensor
                    .next_secs()
                    .map_or(0.0, |time_secs| time_secs - oldest);
                if !(0.5 * period_secs..ONE_CLOCK_SECS).contains(&ahead_secs) {
                    *frame = sensor.take();
                }
            }
            self.frame(&frames);
        }
    }

    /// One frame of the model.
    fn frame(&mut self, frames: &SensorFrames) {
        let stride = self.clock.step(frames);
        let measured = measure(&self.prepared.model, frames);
        let mut measured = measured.map(|measured| Measurement { stride, ..measured });
        self.tracker
            .step_striding(measured.as_mut(), self.confidence);
        let frame_secs = 1.0 / self.prepared.model.frame_rate_hz as f32;
        if measured.is_some() {
            let log_density = self.tracker.log_density() as f32;
            self.confidence.step(log_density, frame_secs);
            self.unexplained_secs = if self.confidence.value() < UNEXPLAINED {
                self.unexplained_secs + frame_secs
            } else {
                0.0
            };
        }
        let mut course = self.tracker.body(measured.as_ref());
        let standing = self.prepared.standing.as_ref();
        self.confidence.calm(standing, &mut course);
        self.blend.step(&course);
        self.heading =
            sensor_heading(frames, &course.body).filter(|_| self.confidence.is_trusted());
        if !self.confidence.is_trusted() {
            self.ground.forget_sensor_heading();
        }
        if measured.is_some() {
            self.silent_secs = 0.0;
        }
        // What was shown ahead is part of this frame.
        self.ahead -= 1.0;
        self.behaviour.step(
            &self.confidence.behaviours(self.tracker.behaviours()),
            self.config.behaviour_probability,
            frame_secs,
        );
    }

    /// Advances by `dt_secs` and writes the pose; the rest pose until the first frame is measured.
    pub fn step(&mut self, dt_secs: f32, pose: &mut Pose) {
        let dt_secs = if dt_secs.is_finite() {
            dt_secs.max(0.0)
        } else {
            0.0
        };
        let rate = self.prepared.model.frame_rate_hz as f32;
        self.silent_secs += dt_secs;
        if !self.blend.started() {
            *pose = Pose::rest(self.ground.skeleton());
            return;
        }
        if self.silent_secs > 2.5 / rate {
            self.coast(dt_secs * rate);
        }
        self.ahead = (self.ahead + dt_secs * rate).clamp(0.0, 1.5);
        let body = self.blend.body_after(self.ahead);
        let input = GroundInput {
            heading: self.heading,
            frames: dt_secs * rate,
            dt_secs,
            stride: self.travel.step(dt_secs),
            contacts: self.sensor_contacts(),
        };
        self.ground.step(&body, &input, pose);
        if let Some(side) = self.travel.side() {
            self.travel
                .compare(self.ground.shown_ankle(side), self.ground.scale());
        }
    }

    /// Contacts of the feet, if sensors on them report them.
    fn sensor_contacts(&self) -> [Option<SensorContact>; 2] {
        let heard = self.silent_secs < CONTACT_VALID_SECS && self.confidence.is_trusted();
        let contact_of = |sensor: usize| {
            let contact = self.sensors[sensor].contact().filter(|_| heard)?;
            Some(SensorContact {
                for_secs: contact.for_secs + self.silent_secs,
                ..contact
            })
        };
        self.prepared.sensor_contacts(contact_of)
    }

    /// Splits a pose from [`step`](Self::step) into the place and heading of the body on the ground, and the pose above it, which faces +Z.
    pub fn split(&self, pose: &mut Pose) -> (Vec3, f32) {
        let (place, heading) = (self.ground.place(), self.ground.heading());
        let level = from_heading(-heading);
        pose.root_position = level * (pose.root_position - place);
        pose.rotations[0] = level * pose.rotations[0];
        (place, heading)
    }

    /// Without samples the body continues as the recordings do.
    fn coast(&mut self, frames: f32) {
        self.heading = None;
        if self.ahead + frames >= 1.0 {
            self.frame(&[None; MAX_SENSORS]);
        }
    }
}
