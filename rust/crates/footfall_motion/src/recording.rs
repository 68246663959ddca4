//! Labelled recordings: motion on the canonical body with its contacts, walks and index row.

use crate::bvh::{self, BvhError, BvhFile};
use crate::contact_file::{ContactFile, ContactFileError};
use crate::contacts::{ContactConfig, Contacts, detect_contacts};
use crate::game_clip;
use crate::gltf::{self, GltfError};
use crate::index_row::IndexRow;
use crate::retarget::{RetargetError, RetargetOptions, Retargeted, retarget, retarget_as_recorded};
use crate::skeletal::SkeletalMotion;
use crate::steps::{Walk, running_parts, segment_walks};
use crate::walking_evidence::WalkingEvidence;
use footfall_core::Clip;
use std::path::{Path, PathBuf};

/// A recording with its labels. Trainers, evaluations and tools take slices of these.
#[derive(Clone, Debug)]
pub struct Recording {
    /// Row of the index. Without an index, the file and the person [named](Self::of_subject) by the caller.
    pub row: IndexRow,
    /// The motion on the canonical body.
    pub retargeted: Retargeted,
    /// Contacts of its feet: from a [file of corrections](ContactFile::beside) if there is one, else
    /// detected.
    pub contacts: Contacts,
    /// Contacts as detected, without corrections.
    pub detected: Contacts,
    /// Walks, by its contacts.
    pub walks: Vec<Walk>,
    /// True when the contacts are corrected by hand.
    pub is_corrected: bool,
}

/// Errors of reading a recording.
#[derive(Debug, thiserror::Error)]
pub enum RecordingError {
    /// The file is not a BVH file.
    #[error(transparent)]
    Bvh(#[from] BvhError),
    /// The file is not a glTF file with a usable animation.
    #[error(transparent)]
    Gltf(#[from] GltfError),
    /// The motion cannot be retargeted to the canonical body.
    #[error("{}: {source}", path.display())]
    Retarget {
        /// The file.
        path: PathBuf,
        /// Fault.
        source: RetargetError,
    },
    /// The corrections beside it do not fit.
    #[error(transparent)]
    Corrections(#[from] ContactFileError),
}

/// Reads a BVH or glTF file and puts its motion on the canonical body. Frames are the file's.
///
/// Clips in glTF files are [those of games](game_clip::retarget): if they walk in place they travel, and loops are found.
///
/// # Errors
/// [`RecordingError`] names the file.
pub fn read_motion(
    path: &Path,
    options: &RetargetOptions,
) -> Result<(BvhFile, Retargeted), RecordingError> {
    let (file, retargeted) = if gltf::is_gltf(path) {
        let file = gltf::read(path)?;
        let retargeted = game_clip::retarget(&file, options);
        (file, retargeted)
    } else {
        let file = bvh::read(path)?;
        let retargeted = retarget(&file, options);
        (file, retargeted)
    };
    let retargeted = retargeted.map_err(|source| RecordingError::Retarget {
        path: path.to_owned(),
        source,
    })?;
    Ok((file, retargeted))
}

/// The same with hip joints as the file has them, and its evidence about them.
pub(crate) fn read_as_recorded(
    path: &Path,
    options: &RetargetOptions,
) -> Result<(Retargeted, WalkingEvidence), RecordingError> {
    let read = if gltf::is_gltf(path) {
        game_clip::retarget_as_recorded(&gltf::read(path)?, options)
    } else {
        retarget_as_recorded(&bvh::read(path)?, options, |_, _| None)
    };
    read.map_err(|source| RecordingError::Retarget {
        path: path.to_owned(),
        source,
    })
}

impl Recording {
    /// Reads a file and what was corrected about it. Loops are [unrolled](game_clip::unroll).
    ///
    /// # Errors
    /// [`RecordingError`] names the file.
    pub fn read(path: &Path, options: &RetargetOptions) -> Result<Self, RecordingError> {
        let (_, retargeted) = read_motion(path, options)?;
        Self::of_file(path, options, retargeted)
    }

    /// Reads a file and what was corrected about it. A loop stays one round, as the file has it.
    ///
    /// # Errors
    /// [`RecordingError`] names the file.
    pub fn read_one_round(path: &Path, options: &RetargetOptions) -> Result<Self, RecordingError> {
        let (_, retargeted) = read_motion(path, options)?;
        Self::labelled(path, options, retargeted)
    }

    /// The motion of a file that was read under these options.
    pub(crate) fn of_file(
        path: &Path,
        options: &RetargetOptions,
        mut retargeted: Retargeted,
    ) -> Result<Self, RecordingError> {
        game_clip::unroll(&mut retargeted);
        Self::labelled(path, options, retargeted)
    }

    /// A motion with what was corrected about its file, else with what the detector finds.
    fn labelled(
        path: &Path,
        options: &RetargetOptions,
        retargeted: Retargeted,
    ) -> Result<Self, RecordingError> {
        let mut recording = Self::detected(retargeted);
        path.clone_into(&mut recording.row.path);
        // Frame numbers of the corrections are the file's.
        let labels = ContactFile::beside(path);
        if options.frame_rate_hz.is_none() && labels.is_file() {
            let stances = ContactFile::read(&labels, &recording.retargeted.clip)?.stances();
            recording.correct(stances);
        }
        Ok(recording)
    }

    /// Puts a clip of any engine on the canonical body, [with its travel](game_clip::retarget) and [unrolled](game_clip::unroll).
    ///
    /// # Errors
    /// [`RetargetError`] for a skeleton that is not recognised and numbers beyond all measure.
    pub fn of_clip(motion: &SkeletalMotion) -> Result<Self, RetargetError> {
        let options = RetargetOptions::default();
        let mut retargeted = game_clip::retarget(&motion.to_recording(), &options)?;
        game_clip::unroll(&mut retargeted);
        Ok(Self::detected(retargeted))
    }

    /// A motion with what the detector finds.
    pub fn detected(retargeted: Retargeted) -> Self {
        let config = ContactConfig::from_frame(retargeted.first_frame);
        let contacts = detect_contacts(&retargeted.clip, &config);
        Self {
            row: IndexRow::default(),
            walks: segment_walks(&retargeted.clip, &contacts),
            retargeted,
            detected: contacts.clone(),
            contacts,
            is_corrected: false,
        }
    }

    /// The same recording without what was put right about [the head](crate::head_carriage).
    #[must_use]
    pub fn with_head_as_recorded(&self) -> Self {
        let mut recorded = self.clone();
        recorded.retargeted.leave_head();
        recorded
    }

    /// The same recording, of a person with this name.
    #[must_use]
    pub fn of_subject(mut self, name: &str) -> Self {
        self.row.set("subject", name);
        self
    }

    /// Name of the person in it.
    pub fn subject(&self) -> &str {
        self.row.subject()
    }

    /// Name of the style that it shows.
    pub fn style(&self) -> &str {
        self.row.style()
    }

    /// The motion on the canonical body.
    pub const fn clip(&self) -> &Clip {
        &self.retargeted.clip
    }

    /// First frame of the motion proper; those before it hold an artificial T-pose, for example.
    pub const fn first_frame(&self) -> usize {
        self.retargeted.first_frame
    }

    /// Number of times that the clip shows the same steps: more than once for a loop that was unrolled.
    pub fn repeats(&self) -> usize {
        self.retargeted.report.repeats.max(1)
    }

    /// Length of what was recorded, one round of a loop, seconds.
    pub fn round_secs(&self) -> f64 {
        self.clip().duration_secs() / self.repeats() as f64
    }

    /// The same recording with those parts of its walks alone in which the person runs.
    #[must_use]
    pub fn running(mut self) -> Self {
        self.walks = running_parts(&self.retargeted.clip, &self.walks);
        self
    }

    /// Number of steps in all its walks.
    pub fn step_count(&self) -> usize {
        self.walks.iter().map(|walk| walk.steps.len()).sum()
    }

    /// Takes stances of the left and of the right foot for true, instead of whatever was corrected before.
    pub fn correct(&mut self, stances: [Vec<footfall_core::FrameSpan>; 2]) {
        self.contacts = self.detected.with_stances(stances);
        self.walks = segment_walks(&self.retargeted.clip, &self.contacts);
        self.is_corrected = true;
    }
}
