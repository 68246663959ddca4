//! A model prepared for the inner loop.

use crate::body::BodyFrame;
use crate::confidence::{standing_body, standing_rows};
use crate::kernels::BLOCK;
use crate::manner::drawn_to_others;
use crate::published::PhaseDeviations;
use crate::stride_phase::{PHASE_COUNT, PHASE_DEVIATION, phases_of, without_stride};
use crate::watch::{Watch, WornRecording};
use footfall_core::Side;
use footfall_imu::{ImuRecording, SensorContact};
use footfall_model::ModelError;
use footfall_model::imu_model::{MAX_SENSORS, SENSOR_COUNT};
use footfall_model::{CalibratedSensor, ImuModel};
use glam::Vec3;
use std::ops::Range;
use std::sync::Arc;

/// A foot that wears a sensor.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WornFoot {
    pub(crate) sensor: usize,
    pub(crate) side: Side,
}

/// A model, checked and laid out. One serves any number of bodies.
#[derive(Clone, Debug)]
pub struct Prepared {
    pub(crate) model: Arc<ImuModel>,
    /// Frames of all segments.
    pub(crate) frames: usize,
    /// Frames in whole blocks.
    pub(crate) padded: usize,
    /// Motion of the body of a stranger, each person drawn to the others: a row for each frame; `None` where strangers are shown as one of the people.
    drawn: Option<Vec<f32>>,
    /// Sensor numbers over their deviations, then the phase of the stride of a foot with a sensor over its: for each block of frames the first number of all of
    /// them, then the second.
    pub(crate) sensor: Vec<f32>,
    /// Numbers of a frame among them.
    pub(crate) columns: usize,
    /// Runs of frames that belong to no stride.
    pub(crate) without_stride: Vec<Range<usize>>,
    /// Deviations of the sensors within each phase, where they take the place of the model's.
    pub(crate) phase_deviations: Option<PhaseDeviations>,
    /// The body of the people who stand, to show where the model explains little.
    pub(crate) standing: Option<BodyFrame>,
    /// Vertical in the axes of each site on the people who stand.
    pub(crate) standing_up: [Vec3; MAX_SENSORS],
    /// Feet that wear sensors.
    pub(crate) worn_feet: Vec<WornFoot>,
    /// First frame of each segment, and the end of the last.
    pub(crate) starts: Vec<usize>,
    /// Segment of each frame.
    pub(crate) segment_of: Vec<u32>,
    /// Numbers of segments of each subject in each phase, subject by subject.
    pub(crate) counts: Vec<f32>,
    /// The segments of each phase.
    pub(crate) of_phase: Vec<Vec<u32>>,
}

impl Prepared {
    /// Checks a model and lays it out.
    ///
    /// # Errors
    /// [`ModelError`] names the part at fault.
    pub fn new(model: Arc<ImuModel>) -> Result<Self, ModelError> {
        model.check()?;
        let frames = model.frame_count();
        let padded = frames.next_multiple_of(BLOCK);
        let sites = model.sites.iter().enumerate();
        let worn_feet: Vec<WornFoot> = sites
            .filter(|(_, site)| site.is_foot())
            .filter_map(|(sensor, site)| {
                Some(WornFoot {
                    sensor,
                    side: site.side()?,
                })
            })
            .collect();
        let phases = worn_feet.first().map(|foot| phases_of(&model, *foot));
        let phases = phases.unwrap_or_default();
        let (sensor, columns) = laid_out(&model, padded, &phases);
        let kinds = model.phases.len();
        let mut starts = Vec::with_capacity(model.segments.len() + 1);
        let mut segment_of = Vec::with_capacity(frames);
        let mut counts = vec![0.0; model.subjects * kinds];
        let mut of_phase = vec![Vec::new(); kinds];
        for (n, segment) in model.segments.iter().enumerate() {
            starts.push(segment_of.len());
            segment_of.extend((0..segment.frames).map(|_| n as u32));
            counts[usize::from(segment.subject) * kinds + usize::from(segment.phase)] += 1.0;
            of_phase[usize::from(segment.phase)].push(n as u32);
        }
        starts.push(segment_of.len());
        Ok(Self {
            frames,
            padded,
            sensor,
            columns,
            without_stride: without_stride(&phases),
            phase_deviations: None,
            worn_feet,
            standing: standing_body(&model),
            drawn: Some(drawn_to_others(&model)),
            standing_up: core::array::from_fn(|n| standing_up(&model, n)),
            model,
            starts,
            segment_of,
            counts,
            of_phase,
        })
    }

    /// Shows strangers as people were recorded, too ([`Published::Manner`](crate::Published::Manner)).
    #[must_use]
    pub fn with_bodies_as_recorded(mut self) -> Self {
        self.drawn = None;
        self
    }

    /// Learns how far sensors deviate within each phase ([`Published::Gaussians`](crate::Published::Gaussians)).
    #[must_use]
    pub fn with_phase_deviations(mut self) -> Self {
        self.phase_deviations = Some(PhaseDeviations::learn(&self));
        self
    }

    /// Returns the contacts of the left and the right foot from the numbered sensors on them; `None` without a sensor or before the contact is known.
    pub(crate) fn sensor_contacts(
        &self,
        contact_of: impl Fn(usize) -> Option<SensorContact>,
    ) -> [Option<SensorContact>; 2] {
        let mut contacts = [None; 2];
        for WornFoot { sensor, side } in &self.worn_feet {
            contacts[side.index()] = contact_of(*sensor);
        }
        contacts
    }

    /// Checks the recording of a sensor, by its number in the model, in the sensor's axes, and rotates it to the site's by its calibration. `promised_hz` is the
    /// sample rate that the sensor should deliver.
    pub fn wear(
        &self,
        sensor: usize,
        recording: &ImuRecording,
        calibrated: &CalibratedSensor,
        promised_hz: Option<f64>,
    ) -> WornRecording {
        let standing_up = self.standing_up.get(sensor).copied().unwrap_or(Vec3::Y);
        let mut watch = Watch::new(standing_up, promised_hz);
        watch.set_gravity(calibrated.gravity_mps2);
        let alone = self.model.sites.len() < 2;
        WornRecording::watched(watch, recording, calibrated, alone)
    }

    /// Returns true if measurements are compared with the phase of the stride, too.
    pub(crate) const fn has_strides(&self) -> bool {
        !self.worn_feet.is_empty() && self.phase_deviations.is_none()
    }

    /// Returns the model.
    pub const fn model(&self) -> &Arc<ImuModel> {
        &self.model
    }

    /// Returns the frames of a segment.
    pub(crate) fn frames_of(&self, segment: usize) -> Range<usize> {
        self.starts[segment]..self.starts[segment + 1]
    }

    /// Returns true when the segment after this one follows it in the same recording.
    pub(crate) fn is_followed(&self, segment: usize) -> bool {
        self.model
            .segments
            .get(segment + 1)
            .is_some_and(|next| next.follows)
    }

    /// Returns the rows of bodies and their shares where the wearer is a stranger by a share: those of people as recorded, and drawn to others.
    pub(crate) fn bodies(&self, stranger: f32) -> [(&[f32], f32); 2] {
        let drawn = self.drawn.as_deref();
        let share = drawn.map_or(0.0, |_| stranger);
        [
            (&self.model.body, 1.0 - share),
            (drawn.unwrap_or_default(), share),
        ]
    }

    /// Returns true for the first frame of a chain, and past the last of all.
    pub(crate) fn begins_chain(&self, frame: usize) -> bool {
        if frame >= self.frames {
            return true;
        }
        let segment = self.segment_of[frame] as usize;
        self.starts[segment] == frame && !self.model.segments[segment].follows
    }
}

/// Lays out what is compared with measurements, in whole blocks, given the phases of strides, if there are any. Returns also the numbers of a frame.
fn laid_out(model: &ImuModel, padded: usize, phases: &[[f32; PHASE_COUNT]]) -> (Vec<f32>, usize) {
    let width = model.sensor_width();
    let columns = width + phases.first().map_or(0, |phase| phase.len());
    let mut numbers = vec![0.0; padded * columns];
    for (frame, row) in model.sensor.chunks_exact(width).enumerate() {
        let block = frame / BLOCK * BLOCK * columns + frame % BLOCK;
        let sensor = row.iter().zip(&model.deviations);
        let phase = phases.get(frame).into_iter().flatten();
        let phase = phase.map(|value| value / PHASE_DEVIATION);
        let row = sensor
            .map(|(value, deviation)| value / deviation)
            .chain(phase);
        for (n, value) in row.enumerate() {
            numbers[block + n * BLOCK] = value;
        }
    }
    (numbers, columns)
}

/// Returns the mean vertical in the axes of a site of standing people; the site's own without standing frames or without such a site.
fn standing_up(model: &ImuModel, sensor: usize) -> Vec3 {
    if sensor >= model.sites.len() {
        return Vec3::Y;
    }
    let at = sensor * SENSOR_COUNT + 6;
    let rows = standing_rows(model, &model.sensor, model.sensor_width());
    let sum: Vec3 = rows.map(|row| Vec3::from_slice(&row[at..at + 3])).sum();
    sum.normalize_or(Vec3::Y)
}
