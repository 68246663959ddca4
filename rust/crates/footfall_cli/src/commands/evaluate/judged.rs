//! A model, dressed in styles, and the captured recordings that it is judged beside.

use crate::commands::synth::{StyleArg, dressed};
use crate::motion_input::SkeletonArgs;
use anyhow::Result;
use footfall_model::GaitModel;
use footfall_motion::corpus::{Corpus, Where};
use std::path::PathBuf;

/// Arguments that name them.
#[derive(Debug, clap::Args)]
pub(super) struct JudgedArgs {
    /// Model to evaluate
    #[arg(long, value_name = "WALK.footfall")]
    pub(super) model: PathBuf,
    /// Style and its weight, 1 by default; repeatable
    #[arg(long = "style", value_name = "STYLE.footstyle[:WEIGHT]")]
    styles: Vec<StyleArg>,
    /// Index of the captured recordings; its column `subject` names the people
    #[arg(long, value_name = "INDEX.csv")]
    pub(super) corpus: PathBuf,
    /// Condition on a column, for example `category=neutral_walk`; repeatable
    #[arg(long = "where", value_name = "COLUMN=VALUE")]
    conditions: Vec<Where>,
    #[command(flatten)]
    fit: SkeletonArgs,
}

impl JudgedArgs {
    /// Reads both.
    ///
    /// # Errors
    /// Reads the model and the recordings; the error names the file that cannot be read and why, or says that no recording fulfils the conditions.
    pub(super) fn read(&self) -> Result<(GaitModel, Corpus)> {
        let (model, _) = dressed(&self.model, &self.styles)?;
        let corpus = self.fit.read_corpus(&self.corpus, &self.conditions)?;
        Ok((model, corpus))
    }
}
