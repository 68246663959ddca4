//! Many recordings into a folder with an index.

use super::{DesignArgs, Designed, describe, write_clip};
use crate::output;
use anyhow::{Context as _, Result, bail};
use footfall_design::{StyleSheet, design};
use footfall_motion::recording::Recording;
use serde::Serialize;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

#[derive(Serialize)]
struct Report {
    index: PathBuf,
    style: String,
    steps: usize,
    clips: Vec<Designed>,
    /// Recordings that could not be used, and why.
    skipped: Vec<Skipped>,
}

#[derive(Serialize)]
struct Skipped {
    path: PathBuf,
    reason: String,
}

pub(super) fn run(
    args: &DesignArgs,
    sheet: &StyleSheet,
    index: &Path,
    folder: &Path,
) -> Result<()> {
    let corpus = args.fit.read_corpus(index, &args.conditions)?;
    fs::create_dir_all(folder)
        .with_context(|| format!("cannot create the folder {}", folder.display()))?;
    let mut report = Report {
        index: folder.join("index.csv"),
        style: sheet.name.clone(),
        steps: 0,
        clips: Vec::new(),
        skipped: Vec::new(),
    };
    output::refuse_overwrite(&[index], &report.index)?;
    for skipped in &corpus.report.skipped {
        report.skipped.push(Skipped {
            path: skipped.path.clone(),
            reason: skipped.reason.clone(),
        });
    }
    let mut table = csv::Writer::from_writer(Vec::new());
    table.write_record([
        "path", "category", "style", "subject", "frames", "fps", "seconds", "steps", "license",
        "source", "notes",
    ])?;
    for (number, clip) in by_turns(&corpus.clips).into_iter().enumerate() {
        if report.steps >= args.steps as usize {
            break;
        }
        let source = &clip.row.path;
        let seed = args.seed.wrapping_add(number as u64);
        let styled = match design(
            &clip.retargeted.clip,
            &clip.contacts,
            &clip.walks,
            sheet,
            seed,
        ) {
            Ok(styled) => styled,
            Err(error) => {
                report.skipped.push(Skipped {
                    path: source.clone(),
                    reason: error.to_string(),
                });
                continue;
            }
        };
        let stem = source.file_stem().unwrap_or_default().to_string_lossy();
        let name = format!("{stem}_{}.bvh", sheet.name);
        let target = folder.join(&name);
        output::refuse_overwrite(&[source], &target)?;
        let designed = write_clip(&styled, sheet, source, &target)?;
        report.steps += designed.steps;
        let column = |name: &str| clip.row.column(name).unwrap_or_default().to_owned();
        let terms = [column("license"), column("licence"), column("terms")];
        table.write_record([
            name,
            "styled_walk".to_owned(),
            sheet.name.clone(),
            column("subject"),
            designed.frames.to_string(),
            designed.fps.to_string(),
            format!("{:.2}", designed.frames as f64 / designed.fps),
            designed.steps.to_string(),
            terms
                .into_iter()
                .find(|text| !text.is_empty())
                .unwrap_or_default(),
            column("source"),
            format!("designed with footfall design from {stem}; not an acted style"),
        ])?;
        if !args.json {
            output::note(&describe(&designed));
        }
        report.clips.push(designed);
    }
    if let (true, Some(first)) = (report.clips.is_empty(), report.skipped.first()) {
        bail!(
            "none of the selected recordings can be used; the first: {}",
            first.reason
        );
    }
    let bytes = table.into_inner().context("the index cannot be written")?;
    output::write_atomic(&report.index, &bytes)?;
    if args.json {
        return output::print_json(&report);
    }
    for skipped in &report.skipped {
        output::note(&format!(
            "left out {}: {}",
            skipped.path.display(),
            skipped.reason
        ));
    }
    output::note(&format!(
        "{}: {} steps of {} in {} clips{}",
        report.index.display(),
        report.steps,
        sheet.name,
        report.clips.len(),
        if report.steps < args.steps as usize {
            format!(
                ", fewer than the requested {}: no more recordings",
                args.steps
            )
        } else {
            String::new()
        }
    ));
    Ok(())
}

/// One recording of each walker in turn, so that a style from few steps is not one walker's.
fn by_turns(clips: &[Recording]) -> Vec<&Recording> {
    let mut seen: BTreeMap<&str, usize> = BTreeMap::new();
    let mut order: Vec<(usize, &Recording)> = clips
        .iter()
        .map(|clip| {
            let turn = seen.entry(clip.row.subject()).or_default();
            *turn += 1;
            (*turn, clip)
        })
        .collect();
    order.sort_by_key(|(turn, _)| *turn);
    order.into_iter().map(|(_, clip)| clip).collect()
}
