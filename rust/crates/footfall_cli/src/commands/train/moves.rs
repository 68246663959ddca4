//! Jumps and crouches of a model: the recordings that show them, and learning from them.

use super::TrainArgs;
use crate::commands::training_run::TrainingRun;
use anyhow::{Context as _, Result};
use footfall_core::Clip;
use footfall_model::GaitModel;
use footfall_motion::corpus::Corpus;
use footfall_train::{crouching, jumping};

/// Recordings of people who jump and who crouch, if some are asked for.
pub(super) struct Moves {
    jumping: Option<Corpus>,
    crouching: Option<Corpus>,
}

impl Moves {
    pub(super) fn read(args: &TrainArgs, run: &TrainingRun<'_>) -> Result<Self> {
        Ok(Self {
            jumping: run.read_further(&args.jumping)?,
            crouching: run.read_further(&args.crouching)?,
        })
    }

    pub(super) fn corpora(&self) -> [Option<&Corpus>; 2] {
        [self.jumping.as_ref(), self.crouching.as_ref()]
    }

    /// Adds to a model what the recordings show.
    pub(super) fn learn(&self, args: &TrainArgs, model: &mut GaitModel) -> Result<()> {
        if let Some(corpus) = &self.jumping {
            let learned = jumping::learn(&clips(corpus), model.standing.as_ref()).with_context(|| {
                format!(
                    "{}: the recordings of --jumping show fewer than three two-footed jumps out of standing; widen it",
                    args.corpus.index.display()
                )
            })?;
            model.jump = Some(learned.model);
        }
        if let Some(corpus) = &self.crouching {
            let learned = crouching::learn(&clips(corpus), model.standing.as_ref()).with_context(|| {
                format!(
                    "{}: the recordings of --crouching have no person who walks both upright and crouched for several seconds; widen it",
                    args.corpus.index.display()
                )
            })?;
            model.crouch = Some(learned.model);
        }
        Ok(())
    }
}

fn clips(corpus: &Corpus) -> Vec<(&Clip, usize)> {
    let clips = corpus.clips.iter();
    clips
        .map(|clip| (&clip.retargeted.clip, clip.retargeted.first_frame))
        .collect()
}
