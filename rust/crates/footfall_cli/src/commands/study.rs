//! `footfall study`: ask people.

use crate::corpus_pair::CorpusPair;
use crate::motion_input::SkeletonArgs;
use crate::output;
use crate::study::{Excerpt, StudyOptions, excerpts, page};
use anyhow::{Context as _, Result, ensure};
use footfall_motion::corpus::Corpus;
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Write a web page for a perception study of real and synthesised walks
///
/// The page is one self-contained file with stick figures and three tests of walks in random order: real or synthetic, recognition of the style,
/// and similarity. Answers stay in the participant's browser and can be downloaded as CSV. It works offline and on phones.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  \
    footfall study --real index.csv --where category=styled_walk --synthesised made.csv -o study.html\n  \
    footfall study --real index.csv --synthesised made.csv --trials 20 --seconds 8 -o study.html")]
pub(crate) struct StudyArgs {
    #[command(flatten)]
    corpora: CorpusPair,
    #[command(flatten)]
    fit: SkeletonArgs,
    /// Output file for the page
    #[arg(short, long, value_name = "STUDY.html")]
    output: PathBuf,
    /// Maximum number of walks, or pairs of walks, in each test
    #[arg(long, default_value_t = 10, value_parser = clap::value_parser!(u16).range(1..=100))]
    trials: u16,
    /// Maximum number of pairs of a real and a synthesised walk for each style
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..=20))]
    pairs: u16,
    /// Longest walk in seconds
    #[arg(long, default_value_t = 6.0)]
    seconds: f64,
    /// Heading of the page
    #[arg(long, default_value = "Walking styles: a study")]
    title: String,
    /// Print one JSON object on stdout
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Report<'a> {
    output: &'a Path,
    bytes: usize,
    styles: &'a [String],
    pairs: usize,
    warnings: Vec<String>,
}

pub(crate) fn run(args: &StudyArgs) -> Result<()> {
    let Some(choice) = &args.corpora.synthesised else {
        anyhow::bail!(
            "a study compares real with synthesised walks; pass the index of the latter as --synthesised INDEX.csv"
        );
    };
    ensure!(
        (2.0..=30.0).contains(&args.seconds),
        "cannot show walks of {} s; set --seconds to 2 to 30",
        args.seconds
    );
    output::refuse_overwrite(&[&args.corpora.real.index, &choice.index], &args.output)?;
    let progress = output::Progress::new();
    progress.stage("reading the recordings", 0);
    let corpora = args.corpora.read(args.fit)?;
    let synthesised = corpora
        .synthesised
        .as_ref()
        .context("the synthesised recordings")?;
    for clip in corpora.real.clips.iter().chain(&synthesised.clips) {
        output::refuse_overwrite(&[&clip.row.path], &args.output)?;
    }
    let study = page(
        &shown(&corpora.real, args.seconds),
        &shown(synthesised, args.seconds),
        &StudyOptions {
            title: args.title.clone(),
            trials: usize::from(args.trials),
            pairs_per_style: usize::from(args.pairs),
        },
    )?;
    output::write_atomic(&args.output, study.html.as_bytes())?;
    progress.finish();
    let mut warnings: Vec<String> = corpora
        .skipped()
        .iter()
        .map(|reason| format!("left out {reason}"))
        .collect();
    warnings.extend(study.left_out.iter().map(|style| {
        format!(
            "left out style {style}: it needs a real and a synthesised walk of three steps or more"
        )
    }));
    for warning in &warnings {
        output::note(&format!("warning: {warning}"));
    }
    let report = Report {
        output: &args.output,
        bytes: study.html.len(),
        styles: &study.styles,
        pairs: study.pairs,
        warnings,
    };
    if args.json {
        return output::print_json(&report);
    }
    output::note(&format!(
        "{}: {} styles, {} pairs of walks, {} kB; open it in a browser",
        args.output.display(),
        report.styles.len(),
        report.pairs,
        report.bytes / 1000
    ));
    Ok(())
}

fn shown(corpus: &Corpus, seconds: f64) -> Vec<Excerpt<'_>> {
    let name = |path: &Path| {
        path.file_stem()
            .map(|stem| stem.to_string_lossy().into_owned())
    };
    let names = corpus
        .clips
        .iter()
        .map(|clip| name(&clip.row.path).unwrap_or_default());
    excerpts(corpus.clips.iter().zip(names), seconds)
}
