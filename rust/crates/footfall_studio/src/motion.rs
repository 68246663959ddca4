//! A motion that is looked at: where it comes from, its contacts, and what a second detector says of it.

use footfall_core::rotation::log_map;
use footfall_core::{Clip, JOINT_COUNT, Joint};
use footfall_motion::phases::{Phase, segment_phases};
use footfall_motion::recording::{Recording, RecordingError};
use footfall_motion::retarget::RetargetOptions;
use footfall_motion::skeleton_fit::FitFinding;
use footfall_motion::switches::{Switch, SwitchResidual, analyse_switches};
use std::path::{Path, PathBuf};

/// A motion, whole.
#[derive(Clone, Debug)]
pub(crate) struct Motion {
    /// The file, for a motion that was read from one.
    pub(crate) path: Option<PathBuf>,
    /// Name in the list.
    pub(crate) name: String,
    /// The motion, its contacts and walks.
    pub(crate) recording: Recording,
    /// Changes of the legs' roles, from joint angles alone.
    pub(crate) switches: Vec<Switch>,
    /// Phases of the motion, from event to event.
    pub(crate) phases: Vec<Phase>,
    /// Residual in which the switches were detected.
    pub(crate) residual: Option<SwitchResidual>,
}

impl Motion {
    /// Reads a file.
    pub(crate) fn read(path: &Path) -> Result<Self, RecordingError> {
        let recording = Recording::read(path, &RetargetOptions::default())?;
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        Ok(Self::of(
            Some(path.to_owned()),
            name.into_owned(),
            recording,
        ))
    }

    /// A motion with what the second detector says.
    pub(crate) fn of(path: Option<PathBuf>, name: String, recording: Recording) -> Self {
        let first = recording.retargeted.first_frame;
        let clip = &recording.retargeted.clip;
        // A pose that is not finite has no switches; the reader lets none through.
        let ((switches, residual), phases) = rayon::join(
            || analyse_switches(clip, first).unwrap_or_default(),
            || segment_phases(clip, &recording.contacts),
        );
        Self {
            path,
            name,
            recording,
            switches,
            phases,
            residual,
        }
    }

    /// Findings about the recording's skeleton.
    pub(crate) const fn fit(&self) -> &FitFinding {
        &self.recording.retargeted.report.fit
    }

    /// The motion on the canonical body.
    pub(crate) const fn clip(&self) -> &Clip {
        &self.recording.retargeted.clip
    }

    /// Length, seconds.
    pub(crate) fn duration_secs(&self) -> f64 {
        self.clip().duration_secs()
    }

    /// Beginning of the motion proper, seconds.
    pub(crate) fn start_secs(&self) -> f64 {
        self.recording.retargeted.first_frame as f64 / self.clip().frame_rate_hz
    }

    /// The frame that is shown at a time.
    pub(crate) fn frame_at(&self, secs: f64) -> usize {
        let frame = (secs * self.clip().frame_rate_hz).round().max(0.0) as usize;
        frame.min(self.clip().poses.len().saturating_sub(1))
    }
}

/// A joint and one component of its rotation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Curve {
    /// Index of the joint.
    pub(crate) joint: usize,
    /// 0 about the left-right axis of the parent, 1 about the vertical, 2 about the forward axis.
    pub(crate) axis: usize,
}

impl Curve {
    pub(crate) const AXES: [&'static str; 3] = ["pitch", "yaw", "roll"];

    /// The most informative curves of a walk: hips and knees.
    pub(crate) const USUAL: [Self; 4] = [
        Self::new(Joint::LeftUpperLeg, 0),
        Self::new(Joint::RightUpperLeg, 0),
        Self::new(Joint::LeftLowerLeg, 0),
        Self::new(Joint::RightLowerLeg, 0),
    ];

    pub(crate) const fn new(joint: Joint, axis: usize) -> Self {
        Self {
            joint: joint.index(),
            axis,
        }
    }

    /// For example `LeftLowerLeg pitch`.
    pub(crate) fn name(self) -> String {
        format!("{} {}", self.joint().name(), Self::AXES[self.axis])
    }

    pub(crate) const fn joint(self) -> Joint {
        Joint::ALL[self.joint % JOINT_COUNT]
    }

    /// The value in a frame, degrees: a component of the rotation vector.
    pub(crate) fn degrees(self, clip: &Clip, frame: usize) -> f32 {
        let rotation = clip.poses[frame].rotation(self.joint());
        log_map(rotation)[self.axis].to_degrees()
    }
}
