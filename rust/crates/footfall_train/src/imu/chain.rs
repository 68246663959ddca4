//! One recording: what sensors measure and what the body does, frame by frame, in phases.

use super::ImuTrainConfig;
use super::level_trunks::TrunkTurn;
use core::ops::Range;
use footfall_core::rotation::{from_heading, heading, wrap_angle};
use footfall_core::{
    Clip, Joint, ModelPose, PhaseKind, Pose, Side, Site, Skeleton, forward_kinematics,
};
use footfall_imu::{FeatureFrame, FeatureStream, ImuRecording};
use footfall_model::imu_model::{
    BODY_COUNT, CONTACT, HEIGHT, ImuModel, SENSOR_COUNT, SENSOR_HEADING, Segment, TURN, WAY,
};
use footfall_model::{FEATURE_COUNT, layout};
use footfall_motion::contacts::{ContactConfig, Contacts, detect_contacts};
use footfall_motion::phases::segment_phases;
use footfall_motion::recording::Recording;
use footfall_motion::virtual_imu::{VirtualImuConfig, simulate};

/// Samples a second of the virtual sensors that a model is trained on.
const VIRTUAL_RATE_HZ: f64 = 120.0;

/// A recording of a body, with what real sensors on it measured at the same time, if there were any.
#[derive(Clone, Copy, Debug)]
pub struct ImuClip<'a> {
    /// The person who moves.
    pub subject: &'a str,
    /// The motion on the canonical body.
    pub clip: &'a Clip,
    /// First frame of the motion proper.
    pub first_frame: usize,
    /// Recordings of the sensors, `aligned` and on the clip's time, one for each site; virtual ones take their place when empty.
    pub recordings: &'a [ImuRecording],
    /// Turn that sets the trunk upright in a model; frames are chosen and compared as recorded.
    pub trunk: TrunkTurn,
}

impl<'a> ImuClip<'a> {
    /// A recording whose sensors are virtual.
    pub fn simulated(recording: &'a Recording) -> Self {
        Self {
            subject: recording.subject(),
            clip: recording.clip(),
            first_frame: recording.first_frame(),
            recordings: &[],
            trunk: TrunkTurn::default(),
        }
    }
}

/// A run of frames of one phase.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ChainSegment {
    /// Kind of phase.
    pub kind: PhaseKind,
    /// First frame in the chain.
    pub first: usize,
    /// One past the last.
    pub end: usize,
}

/// A recording as the model takes it.
#[derive(Clone, Debug, PartialEq)]
pub struct Chain {
    /// The person who moves.
    pub subject: String,
    /// True when left and right are changed.
    pub mirrored: bool,
    /// The body.
    pub skeleton: Skeleton,
    /// Phases without gaps.
    pub segments: Vec<ChainSegment>,
    /// [`SENSOR_COUNT`] numbers a sensor for each frame.
    pub sensor: Vec<f32>,
    /// [`BODY_COUNT`] numbers for each frame.
    pub body: Vec<f32>,
    /// Turn that sets the trunk upright in a model.
    pub trunk: TrunkTurn,
}

impl Chain {
    /// Number of frames.
    pub fn frames(&self) -> usize {
        self.body.len() / BODY_COUNT
    }

    /// A frame of the body.
    pub fn body_row(&self, frame: usize) -> &[f32] {
        &self.body[frame * BODY_COUNT..(frame + 1) * BODY_COUNT]
    }

    /// A frame of all sensors.
    pub fn sensor_row(&self, frame: usize) -> &[f32] {
        let width = self.sensor.len() / self.frames().max(1);
        &self.sensor[frame * width..(frame + 1) * width]
    }

    /// Adds some segments to a model; `follows` is true if they continue the last added one.
    pub(super) fn append_to(
        &self,
        model: &mut ImuModel,
        segments: Range<usize>,
        subject: u16,
        follows: bool,
    ) {
        let first = segments.start;
        for (n, segment) in segments.clone().zip(&self.segments[segments]) {
            model.segments.push(Segment {
                phase: model.phases.binary_search(&segment.kind).unwrap_or(0) as u16,
                subject,
                frames: (segment.end - segment.first) as u16,
                follows: follows || n > first,
            });
            for frame in segment.first..segment.end {
                model.sensor.extend_from_slice(self.sensor_row(frame));
                let begin = model.body.len();
                model.body.extend_from_slice(self.body_row(frame));
                self.trunk.turn(&mut model.body[begin..]);
            }
        }
    }
}

/// The chain of a clip and, when asked for, that of its mirror image. A clip of less than two frames gives none.
pub fn observe(clip: &ImuClip<'_>, config: &ImuTrainConfig) -> Vec<Chain> {
    let mut chains = Vec::new();
    chains.extend(observe_one(clip, config, false));
    // What a real sensor on one side measures says nothing of the other.
    if config.mirror && clip.recordings.is_empty() {
        let mirrored = Clip {
            skeleton: clip.clip.skeleton.mirrored(),
            frame_rate_hz: clip.clip.frame_rate_hz,
            poses: clip.clip.poses.iter().map(Pose::mirrored).collect(),
        };
        let mirrored = ImuClip {
            clip: &mirrored,
            ..*clip
        };
        chains.extend(observe_one(&mirrored, config, true));
    }
    chains
}

fn observe_one(clip: &ImuClip<'_>, config: &ImuTrainConfig, mirrored: bool) -> Option<Chain> {
    let simulated = |site: Site| {
        let sensor = if config.strapped {
            VirtualImuConfig::strapped(VIRTUAL_RATE_HZ, clip.clip.poses.len() as u64)
        } else {
            VirtualImuConfig::ideal(VIRTUAL_RATE_HZ)
        };
        simulate(clip.clip, clip.first_frame, site, &sensor)
    };
    let sensors: Vec<Vec<FeatureFrame>> = config
        .sites
        .iter()
        .enumerate()
        .map(|(n, site)| {
            let recording = clip.recordings.get(n).cloned();
            let recording = recording.unwrap_or_else(|| simulated(*site));
            FeatureStream::frames_of(&recording, config.frame_rate_hz)
        })
        .collect();
    let contacts = detect_contacts(clip.clip, &ContactConfig::from_frame(clip.first_frame));
    let count = sensors.iter().map(Vec::len).min()?;
    let start_secs = sensors.first()?.first()?.time_secs;
    let times: Vec<f64> = (0..count)
        .map(|frame| start_secs + frame as f64 / config.frame_rate_hz)
        .collect();
    let mut chain = Chain {
        subject: clip.subject.to_owned(),
        mirrored,
        skeleton: clip.clip.skeleton.clone(),
        segments: segments_at(clip.clip, &contacts, &times),
        sensor: Vec::with_capacity(count * SENSOR_COUNT * sensors.len()),
        body: Vec::with_capacity(count * BODY_COUNT),
        trunk: clip.trunk,
    };
    let mut body = BodyRows::new(clip.clip, &contacts, &config.sites);
    body.previous = clip.clip.pose_at(start_secs - 1.0 / config.frame_rate_hz);
    for (frame, time_secs) in times.iter().enumerate() {
        let ups = body.push(*time_secs, &mut chain.body)?;
        for (sensor, up) in sensors.iter().zip(ups) {
            let mut values = sensor[frame].values.unwrap_or_default();
            // The filter's vertical is not yet settled when a clip begins; the body's own is known.
            values[6..].copy_from_slice(&up.to_array());
            chain.sensor.extend_from_slice(&values);
        }
    }
    Some(chain)
}

/// Phases of a clip at the model's times.
fn segments_at(clip: &Clip, contacts: &Contacts, times: &[f64]) -> Vec<ChainSegment> {
    let mut segments: Vec<ChainSegment> = Vec::new();
    for phase in segment_phases(clip, contacts) {
        // A frame belongs to the phase in which it ends.
        let place = |frame: usize| {
            let secs = frame as f64 / clip.frame_rate_hz;
            times.partition_point(|time| *time < secs)
        };
        let first = segments.last().map_or(0, |segment| segment.end);
        let end = if phase.end == contacts.frames {
            times.len()
        } else {
            place(phase.end)
        };
        if end > first {
            segments.push(ChainSegment {
                kind: phase.kind,
                first,
                end,
            });
        }
    }
    segments
}

/// Writes rows of the body.
struct BodyRows<'a> {
    clip: &'a Clip,
    contacts: &'a Contacts,
    sites: &'a [Site],
    previous: Option<Pose>,
    features: Option<[f64; FEATURE_COUNT]>,
}

impl<'a> BodyRows<'a> {
    fn new(clip: &'a Clip, contacts: &'a Contacts, sites: &'a [Site]) -> Self {
        Self {
            clip,
            contacts,
            sites,
            previous: None,
            features: None,
        }
    }

    /// Appends the row of a time; gives up in each sensor's axes.
    fn push(&mut self, time_secs: f64, rows: &mut Vec<f32>) -> Option<Vec<glam::Vec3>> {
        let pose = self.clip.pose_at(time_secs)?;
        let previous = self.previous.replace(pose.clone()).unwrap_or(pose.clone());
        let facing = heading(pose.rotation(Joint::Hips));
        let mut features = [0.0; FEATURE_COUNT];
        let before = self.features.as_ref().map(<[f64; FEATURE_COUNT]>::as_slice);
        layout::encode(&pose, facing, before, &mut features);
        self.features = Some(features);

        let mut row = [0.0; BODY_COUNT];
        for (value, feature) in row.iter_mut().zip(features) {
            *value = feature as f32;
        }
        let before = heading(previous.rotation(Joint::Hips));
        let way = from_heading(-before) * (pose.root_position - previous.root_position);
        row[HEIGHT] = pose.root_position.y;
        row[WAY] = way.x;
        row[WAY + 1] = way.z;
        row[TURN] = wrap_angle(facing - before);
        let frame = (time_secs * self.clip.frame_rate_hz).round() as usize;
        for side in Side::BOTH {
            let bears = self
                .contacts
                .bears(side, frame.min(self.contacts.frames - 1));
            row[CONTACT + side.index()] = f32::from(u8::from(bears));
        }
        let mut model = ModelPose::default();
        forward_kinematics(&self.clip.skeleton, &pose, &mut model);
        let mut ups = Vec::with_capacity(self.sites.len());
        for (n, site) in self.sites.iter().enumerate() {
            let turn = model.rotation(site.joint());
            row[SENSOR_HEADING + n] = wrap_angle(heading(turn) - facing);
            ups.push(turn.inverse() * glam::Vec3::Y);
        }
        rows.extend_from_slice(&row);
        Some(ups)
    }
}
