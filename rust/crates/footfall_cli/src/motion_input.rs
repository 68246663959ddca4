//! A motion file as every command needs it: read, placed on the canonical body, with its contacts.

use crate::fit_facts::note_people;
use crate::output;
use anyhow::{Context as _, Result};
use footfall_core::Clip;
use footfall_motion::bvh::BvhFile;
use footfall_motion::corpus::{Corpus, Where};
use footfall_motion::recording::{Recording, read_motion};
use footfall_motion::retarget::{
    JointMap, RetargetOptions, Retargeted, SkeletonFit, parse_joint_map,
};
use footfall_motion::steps::Step;
use footfall_train::imu::{BentTrunk, bent_trunks};
use std::fs;
use std::path::{Path, PathBuf};

/// Options for reading a recording's skeleton.
#[derive(Clone, Debug, Default, clap::Args)]
pub(crate) struct MapArgs {
    /// Names of an unknown skeleton's joints: a TOML file of lines such as `Hips = "pelvis"`
    #[arg(long, value_name = "NAMES.toml")]
    map: Option<PathBuf>,
    #[command(flatten)]
    fit: SkeletonArgs,
}

/// Treatment of a skeleton that fits its person badly.
#[derive(Clone, Copy, Debug, Default, clap::Args)]
pub(crate) struct SkeletonArgs {
    /// Leave hip joints and head where the recording has them
    ///
    /// Skeletons fitted to markers misplace hip joints by centimetres, so that people crouch who did not, and tilt necks and
    /// faces. Where a person's walking shows it, joints are moved, legs solved anew and heads turned, unless this option is given.
    #[arg(long)]
    pub(crate) as_recorded: bool,
    /// Accepted for command lines of older versions, which moved hip joints on request only.
    #[arg(long, hide = true, conflicts_with = "as_recorded")]
    correct_hips: bool,
}

impl SkeletonArgs {
    /// Source of the hip joints' places and of the head's carriage.
    pub(crate) const fn skeleton(self) -> SkeletonFit {
        if self.as_recorded {
            SkeletonFit::AsRecorded
        } else {
            SkeletonFit::FromRecording
        }
    }

    /// Options under which a recording is read.
    pub(crate) fn options(self) -> RetargetOptions {
        RetargetOptions {
            fit: self.skeleton(),
            ..RetargetOptions::default()
        }
    }

    /// Reads the chosen recordings of an index, and says whose skeletons were put right.
    pub(crate) fn read_corpus(self, index: &Path, conditions: &[Where]) -> Result<Corpus> {
        let corpus = Corpus::read_with(index, conditions, &self.options())?;
        note_people(&corpus.report.people);
        Ok(corpus)
    }

    /// Finds the people whose skeletons have a bent trunk that is to be set upright, and names them.
    pub(crate) fn bent_trunks(self, recordings: &[Recording]) -> Vec<BentTrunk> {
        if self.as_recorded {
            return Vec::new();
        }
        let bent = bent_trunks(recordings);
        for trunk in &bent {
            output::note(&format!(
                "trunk of {} set upright: the upper chest leans by {:.0}° as it walks",
                trunk.subject, trunk.recorded_deg
            ));
        }
        bent
    }

    /// The option as it was given, for the command that a model's file states.
    pub(crate) fn words(self) -> Option<String> {
        self.as_recorded.then(|| "--as-recorded".to_owned())
    }
}

/// Recordings that an index lists.
#[derive(Debug, clap::Args)]
pub(crate) struct CorpusArgs {
    /// Index of the recordings
    #[arg(long = "corpus", value_name = "INDEX.csv")]
    pub(crate) index: PathBuf,
    /// Condition on a column, for example `category=neutral_walk`; repeatable
    #[arg(long = "where", value_name = "COLUMN=VALUE")]
    pub(crate) conditions: Vec<Where>,
    #[command(flatten)]
    pub(crate) fit: SkeletonArgs,
}

impl CorpusArgs {
    /// Reads the chosen recordings, and says whose skeletons were put right.
    pub(crate) fn read(&self) -> Result<Corpus> {
        self.fit.read_corpus(&self.index, &self.conditions)
    }
}

impl MapArgs {
    /// Reads the joint map that was given and returns the options, with the recording's own rate unless another is given.
    pub(crate) fn read(&self, frame_rate_hz: Option<f64>) -> Result<RetargetOptions> {
        Ok(RetargetOptions {
            map: self.read_map()?,
            frame_rate_hz,
            fit: self.fit.skeleton(),
        })
    }

    fn read_map(&self) -> Result<Option<JointMap>> {
        let Some(path) = &self.map else {
            return Ok(None);
        };
        let text = fs::read_to_string(path)
            .with_context(|| format!("{}: cannot read the joint map", path.display()))?;
        let map = parse_joint_map(&text).with_context(|| path.display().to_string())?;
        Ok(Some(map))
    }
}

/// Reads a BVH or glTF file: as it stands, and on the canonical body.
pub(crate) fn read_file(path: &Path, options: &RetargetOptions) -> Result<(BvhFile, Retargeted)> {
    // The error's own text has all that its source says.
    read_motion(path, options).map_err(|error| anyhow::anyhow!(error.to_string()))
}

/// Reads a recording with its contacts: a person's where there is a file of corrections beside it, else those detected.
pub(crate) fn read_recording(path: &Path, options: &RetargetOptions) -> Result<Recording> {
    Recording::read_one_round(path, options).map_err(|error| anyhow::anyhow!(error.to_string()))
}

/// Figures that describe a recording's walking.
pub(crate) struct WalkFigures {
    /// Mean speed of the hips along the ground over the motion, m/s on the canonical body.
    pub(crate) speed_mps: f64,
    /// Steps per minute while walking; `None` without a step.
    pub(crate) cadence_per_min: Option<f64>,
}

impl WalkFigures {
    /// Measures a recording by its contacts.
    pub(crate) fn of(recording: &Recording) -> Self {
        let clip = &recording.retargeted.clip;
        let steps = || recording.walks.iter().flat_map(|walk| &walk.steps);
        let frames: usize = steps().map(Step::frames).sum();
        let cadence_per_min = (frames > 0)
            .then(|| 60.0 * steps().count() as f64 * clip.frame_rate_hz / frames as f64);
        Self {
            speed_mps: mean_speed(clip, recording.retargeted.first_frame),
            cadence_per_min,
        }
    }
}

/// Length of the way of the hips over time, sampled coarsely so that capture noise adds nothing.
fn mean_speed(clip: &Clip, first_frame: usize) -> f64 {
    let stride = ((0.25 * clip.frame_rate_hz).round() as usize).max(1);
    let last = clip.poses.len().saturating_sub(1);
    let mut way = 0.0_f64;
    let mut from = first_frame;
    while from < last {
        let to = (from + stride).min(last);
        let offset = clip.poses[to].root_position - clip.poses[from].root_position;
        way += f64::from(offset.with_y(0.0).length());
        from = to;
    }
    let secs = last.saturating_sub(first_frame) as f64 / clip.frame_rate_hz;
    if secs > 0.0 { way / secs } else { 0.0 }
}
