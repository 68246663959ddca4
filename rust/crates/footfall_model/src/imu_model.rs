//! The model that turns what a sensor measures into a body (Mousas 2017): frames of recorded motion, each with what the sensor measured in
//! it, in phases that follow each other.
//!
//! A *chain* is a recording: its segments follow each other without a gap. A *segment* is one phase of it, the paper's higher level; its
//! frames are the paper's lower level, template states of a left-to-right Markov chain. A frame's two rows are the means of the joint
//! Gaussian of equation 2; what the Gaussians of a phase share is its regression U^XY (U^YY)⁻¹ of equation 6.

use crate::check::ModelError;
use crate::layout::FEATURE_COUNT;
use crate::provenance::Provenance;
use footfall_core::{Behaviour, PhaseKind, Site, Skeleton};

/// Numbers that one sensor gives in a frame: angular rate (rad/s), specific force (m/s²) and up, each x, y, z in the site's axes.
pub const SENSOR_COUNT: usize = 9;

/// Numbers that describe the body in a frame.
pub const BODY_COUNT: usize = FEATURE_COUNT + 8;

/// Place of the height of the hips in a body row, metres on the canonical body. Joint rotations come before it, as in [`crate::layout`].
pub const HEIGHT: usize = FEATURE_COUNT;

/// Place of the way of the hips since the frame before: to the body's left, then forward, metres.
pub const WAY: usize = FEATURE_COUNT + 1;

/// Place of the turn since the frame before, radians.
pub const TURN: usize = FEATURE_COUNT + 3;

/// Place of the contacts of the left and the right foot: 0 or 1.
pub const CONTACT: usize = FEATURE_COUNT + 4;

/// Place of the headings of up to two sensors relative to the body's, radians.
pub const SENSOR_HEADING: usize = FEATURE_COUNT + 6;

/// Most sensors that a model can have.
pub const MAX_SENSORS: usize = 2;

/// Most numbers that all sensors give in a frame.
pub const MAX_WIDTH: usize = SENSOR_COUNT * MAX_SENSORS;

/// Most kinds of phases.
pub const MAX_PHASES: usize = 256;

/// Most frames of all segments together.
pub const MAX_FRAMES: usize = 2_000_000;

/// One phase of a recording.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Segment {
    /// Number among [`ImuModel::phases`].
    pub phase: u16,
    /// The person who moves: an index below [`ImuModel::subjects`].
    pub subject: u16,
    /// Number of its frames.
    pub frames: u16,
    /// True when it follows the segment before without a gap.
    pub follows: bool,
}

/// Motion of a body beside the frames of its sensors.
#[derive(Clone, Debug, PartialEq)]
pub struct ImuModel {
    /// Frames per second.
    pub frame_rate_hz: f64,
    /// Sites of the sensors; one or two.
    pub sites: Vec<Site>,
    /// The body of the recordings.
    pub skeleton: Skeleton,
    /// Every kind of phase that occurs.
    pub phases: Vec<PhaseKind>,
    /// Probability of each phase after each, row by row: `phases.len()` squared.
    pub next: Vec<f32>,
    /// Number of different subjects.
    pub subjects: usize,
    /// Phases of the recordings, in order.
    pub segments: Vec<Segment>,
    /// Measurements of the sensors: [`SENSOR_COUNT`] numbers a sensor for each frame of each segment.
    pub sensor: Vec<f32>,
    /// Motion of the body: [`BODY_COUNT`] numbers for each frame.
    pub body: Vec<f32>,
    /// Standard deviation of each sensor number round that of a like frame.
    pub deviations: Vec<f32>,
    /// Of each phase, the regression of body on sensor: [`BODY_COUNT`] rows of as many numbers as the sensors have. Empty where
    /// there are too few frames.
    pub regressions: Vec<Vec<f32>>,
    /// Provenance of the model.
    pub provenance: Provenance,
}

impl ImuModel {
    /// Numbers that all sensors give in a frame.
    pub fn sensor_width(&self) -> usize {
        SENSOR_COUNT * self.sites.len()
    }

    /// Behaviour that a segment shows.
    pub fn behaviour_of(&self, segment: Segment) -> Behaviour {
        self.phases[usize::from(segment.phase)].behaviour
    }

    /// Frames of all segments.
    pub fn frame_count(&self) -> usize {
        self.segments
            .iter()
            .map(|segment| usize::from(segment.frames))
            .sum()
    }

    /// Checks that the parts fit together and are finite.
    ///
    /// # Errors
    /// [`ModelError`] names the part at fault.
    pub fn check(&self) -> Result<(), ModelError> {
        let value = |part: &str| {
            Err(ModelError::Value {
                part: part.to_owned(),
            })
        };
        let shape = |part: &str, expected: usize, found: usize| {
            if expected == found {
                return Ok(());
            }
            Err(ModelError::Shape {
                part: part.to_owned(),
                expected,
                found,
            })
        };
        if !(5.0..=1000.0).contains(&self.frame_rate_hz) {
            return value("frame rate");
        }
        if self.skeleton.check().is_err() {
            return value("skeleton");
        }
        if !(1..=MAX_SENSORS).contains(&self.sites.len()) {
            return value("number of sites");
        }
        let kinds = self.phases.len();
        let frames = self.frame_count();
        if kinds == 0 || kinds > MAX_PHASES || frames == 0 || frames > MAX_FRAMES {
            return value("number of phases or frames");
        }
        if self.segments.iter().any(|segment| {
            usize::from(segment.phase) >= kinds
                || usize::from(segment.subject) >= self.subjects
                || segment.frames == 0
        }) {
            return value("segment");
        }
        let width = self.sensor_width();
        shape("successors of phases", kinds * kinds, self.next.len())?;
        shape("sensor frames", frames * width, self.sensor.len())?;
        shape("body frames", frames * BODY_COUNT, self.body.len())?;
        shape("deviations", width, self.deviations.len())?;
        shape("regressions", kinds, self.regressions.len())?;
        for regression in self.regressions.iter().filter(|r| !r.is_empty()) {
            shape("regression", BODY_COUNT * width, regression.len())?;
        }
        let finite = |values: &[f32]| values.iter().all(|value| value.abs() < 1e6);
        if !(finite(&self.next) && self.next.iter().all(|share| *share >= 0.0)) {
            return value("successors of phases");
        }
        if !finite(&self.sensor) || !finite(&self.body) {
            return value("frames");
        }
        if !self
            .deviations
            .iter()
            .all(|deviation| (1e-6..1e6).contains(deviation))
        {
            return value("deviations");
        }
        if !self.regressions.iter().all(|regression| finite(regression)) {
            return value("regressions");
        }
        Ok(())
    }
}
