//! `footfall evaluate style`: classification of styles, their likeness to their model and to human motion.

mod table;

use crate::corpus_pair::CorpusPair;
use crate::motion_input::SkeletonArgs;
use crate::output;
use anyhow::{Context as _, Result};
use clap::ValueEnum;
use footfall_train::evaluate::style_report::StyleReport;
use footfall_train::evaluate::{Split, evaluate_styles};
use table::tables;

/// Measure recognition, resemblance and naturalness of styles
///
/// A classifier learns the styles of real strides (two steps each; mean, deviation and range of every joint's swing, speed,
/// cadence, widths; linear discriminant with shrunk covariance). It then classifies real strides that it has not seen and
/// synthesised strides. Without --synthesised, real recordings are compared with each other as a reference.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  \
    footfall evaluate style --real index.csv --where category=styled_walk\n  \
    footfall evaluate style --real index.csv --where category=styled_walk --synthesised made.csv --split half --json")]
pub(crate) struct StyleArgs {
    #[command(flatten)]
    corpora: CorpusPair,
    #[command(flatten)]
    fit: SkeletonArgs,
    /// Split that keeps real strides unseen: each take in turn, or each half of every recording [default: takes if every style has two]
    #[arg(long, value_enum)]
    split: Option<SplitArg>,
    /// Print one JSON object on stdout
    #[arg(long)]
    json: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum SplitArg {
    /// Each take in turn is unseen; harder, because people vary from take to take
    Take,
    /// Each half of every recording in turn is unseen
    Half,
}

pub(crate) fn run(args: &StyleArgs) -> Result<()> {
    let report = evaluate(args)?;
    output::note_left_out(&report.skipped);
    output::print_report(args.json, &report, tables)
}

/// Evaluates, and returns the report that is printed as JSON.
fn evaluate(args: &StyleArgs) -> Result<StyleReport> {
    let progress = output::Progress::new();
    progress.stage("reading the recordings", 0);
    let corpora = args.corpora.read(args.fit)?;
    let synthesised = corpora.synthesised.as_ref();
    let synthesised = synthesised.map(|corpus| corpus.clips.as_slice());
    progress.stage("judging", 0);
    let split = args.split.map(|split| match split {
        SplitArg::Take => Split::Take,
        SplitArg::Half => Split::Half,
    });
    let evaluation = evaluate_styles(&corpora.real.clips, synthesised, split)
        .with_context(|| args.corpora.real.index.display().to_string())?;
    progress.finish();
    Ok(StyleReport::new(&evaluation, corpora.skipped()))
}
