//! Options and output files that `synth` and `dynamics synth` have in common.

use crate::output;
use anyhow::{Context as _, Result, ensure};
use footfall_core::{FrameSpan, Side};
use footfall_motion::bvh::{self, clip_to_bvh};
use footfall_motion::contact_file::{ContactFile, StepEntry};
use footfall_synth::SynthesizedWalk;
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Options of a walk, and its output files.
#[derive(Debug, clap::Args)]
pub(super) struct WalkArgs {
    /// Seed of the walker, and of its walk
    #[arg(long, default_value_t = 1)]
    pub(super) seed: u64,
    /// Frames per second [default: the model's]
    #[arg(long)]
    pub(super) fps: Option<f64>,
    /// Speed over the ground in m/s [default: the recordings']
    #[arg(long)]
    pub(super) speed: Option<f32>,
    /// Turning in degrees per second, positive to the left
    #[arg(
        long,
        default_value_t = 0.0,
        allow_negative_numbers = true,
        value_name = "DEG_PER_S"
    )]
    pub(super) turn: f32,
    /// Direction of travel relative to the facing direction: 0 forwards, 90 to the left, 180 backwards. Unless it is 0, a trained walk begins and
    /// ends standing
    #[arg(
        long,
        default_value_t = 0.0,
        allow_negative_numbers = true,
        value_name = "DEGREES"
    )]
    pub(super) direction: f32,
    /// Variation of the walker and its steps about the average: 0 none, 1 as in the recordings
    #[arg(long, default_value_t = 1.0)]
    pub(super) variation: f32,
    /// Output file
    #[arg(short, long, value_name = "OUT.bvh")]
    pub(super) output: PathBuf,
    /// Output file for the contacts, in the format of `footfall contacts --json`
    #[arg(long, value_name = "OUT.json")]
    contacts: Option<PathBuf>,
}

/// Facts about a walk, for the report.
#[derive(Serialize)]
pub(super) struct WalkFacts<'a> {
    output: &'a Path,
    contacts: Option<&'a Path>,
    pub(super) fps: f64,
    pub(super) frames: usize,
    pub(super) seconds: f64,
    seed: u64,
    pub(super) speed_mps: f32,
}

impl WalkArgs {
    /// Checks what can be checked before anything is read or written.
    pub(super) fn check(&self, inputs: &[&Path]) -> Result<()> {
        for output in [Some(&self.output), self.contacts.as_ref()]
            .into_iter()
            .flatten()
        {
            output::refuse_overwrite(inputs, output)?;
        }
        ensure!(
            self.contacts.as_ref() != Some(&self.output),
            "{} is the output of both motion and contacts; pass another name to --contacts",
            self.output.display()
        );
        ensure!(
            self.fps.is_none_or(|fps| (1.0..=1000.0).contains(&fps)),
            "cannot write {} frames per second; set --fps to 1 to 1000",
            self.fps.unwrap_or_default()
        );
        Ok(())
    }

    /// Checks that a walk goes somewhere.
    pub(super) fn check_speed(&self) -> Result<()> {
        ensure!(
            self.speed
                .is_none_or(|speed| speed > 0.0 && speed.is_finite()),
            "a walk at {} m/s does not move; set --speed above zero",
            self.speed.unwrap_or_default()
        );
        Ok(())
    }

    /// Writes a walk and its contacts.
    pub(super) fn write(&self, walk: &SynthesizedWalk) -> Result<WalkFacts<'_>> {
        let clip = &walk.clip;
        output::write_atomic(&self.output, bvh::write(&clip_to_bvh(clip)).as_bytes())?;
        if let Some(path) = &self.contacts {
            let text = serde_json::to_string(&contact_report(walk)).context("the contacts")?;
            output::write_atomic(path, format!("{text}\n").as_bytes())?;
        }
        let seconds = clip.duration_secs();
        let way = match (clip.poses.first(), clip.poses.last()) {
            (Some(first), Some(last)) => (last.root_position - first.root_position)
                .with_y(0.0)
                .length(),
            _ => 0.0,
        };
        Ok(WalkFacts {
            output: &self.output,
            contacts: self.contacts.as_deref(),
            fps: clip.frame_rate_hz,
            frames: clip.poses.len(),
            seconds,
            seed: self.seed,
            speed_mps: way / (seconds as f32).max(f32::MIN_POSITIVE),
        })
    }
}

/// Contacts and steps of a generated walk. It begins and ends in full stride, so every step is inside.
fn contact_report(walk: &SynthesizedWalk) -> ContactFile {
    let clip = &walk.clip;
    let stances = Side::BOTH.map(|side| walk.contacts[side.index()].as_slice());
    let mut report = ContactFile::from_spans(
        clip.frame_rate_hz,
        clip.poses.len(),
        stances,
        &walk.events(),
    );
    let mut landings: Vec<(usize, Side)> = Side::BOTH
        .into_iter()
        .flat_map(|side| landings(stances[side.index()], side))
        .collect();
    landings.sort_unstable();
    report.steps = landings
        .windows(2)
        .map(|pair| StepEntry {
            foot: pair[0].1.name().to_owned(),
            first: pair[0].0,
            last: pair[1].0.saturating_sub(1),
            position: "inside".to_owned(),
            walk: 0,
        })
        .collect();
    report
}

/// Frames of initial contact. The walk begins with one of the left foot; the right foot's first stance began before.
fn landings(stances: &[FrameSpan], side: Side) -> Vec<(usize, Side)> {
    stances
        .iter()
        .filter(|stance| side == Side::Left || stance.first > 0)
        .map(|stance| (stance.first, side))
        .collect()
}
