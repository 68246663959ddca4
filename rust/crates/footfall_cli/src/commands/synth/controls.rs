//! Tables of controls over time: what a walker is asked to do, row by row.

use anyhow::{Context as _, Result, bail, ensure};
use footfall_model::GaitModel;
use footfall_synth::{Controls, GaitChoice, Move};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// Time for which the last row applies.
pub(super) const LAST_SECS: f64 = 1.0;

/// Longer recordings are a slip of the keyboard.
const LONGEST_SECS: f64 = 3600.0;

const COLUMNS: [&str; 7] = [
    "time_s",
    "speed_mps",
    "turn_dps",
    "direction_deg",
    "gait",
    "crouch",
    "jump_m",
];

/// A table.
#[derive(Debug, PartialEq)]
pub(super) struct Table {
    pub(super) moves: Vec<Move>,
    /// When the last row ends.
    pub(super) seconds: f64,
    /// Columns that not every model knows, and the line of the first row that uses each.
    uses: BTreeMap<&'static str, u64>,
}

/// Reads a table of controls.
pub(super) fn read(path: &Path) -> Result<Table> {
    let text =
        fs::read_to_string(path).with_context(|| format!("cannot read {}", path.display()))?;
    parse(&text).with_context(|| path.display().to_string())
}

fn parse(text: &str) -> Result<Table> {
    let mut reader = csv::ReaderBuilder::new()
        .trim(csv::Trim::All)
        .from_reader(text.as_bytes());
    let header = reader.headers()?.clone();
    for name in &header {
        ensure!(
            COLUMNS.contains(&name),
            "unknown column '{name}'; the columns of a table of controls are {}",
            COLUMNS.join(", ")
        );
    }
    ensure!(
        header.iter().any(|name| name == COLUMNS[0]),
        "there is no column time_s; add the time at which each row begins"
    );
    let mut moves: Vec<Move> = Vec::new();
    let mut uses = BTreeMap::new();
    for record in reader.records() {
        let record = record?;
        let line = record.position().map_or(0, csv::Position::line);
        let cell = |name: &str| {
            let column = header.iter().position(|column| column == name);
            column.and_then(|column| record.get(column)).unwrap_or("")
        };
        let number = |name: &str| -> Result<f32> {
            let text = cell(name);
            if text.is_empty() {
                return Ok(0.0);
            }
            let value: f32 = text
                .parse()
                .with_context(|| format!("line {line}: {name} '{text}' is not a number"))?;
            ensure!(
                value.is_finite(),
                "line {line}: {name} {value} is not finite"
            );
            Ok(value)
        };
        let time_secs = f64::from(number("time_s")?);
        let earlier = moves.last().map_or(0.0, |last| last.time_secs);
        ensure!(
            time_secs >= earlier && time_secs <= LONGEST_SECS,
            "line {line}: time_s {time_secs} does not follow {earlier}, or exceeds {LONGEST_SECS} s; sort the rows by time"
        );
        for name in ["crouch", "jump_m"] {
            if number(name)? > 0.0 {
                uses.entry(name).or_insert(line);
            }
        }
        moves.push(Move {
            time_secs,
            controls: Controls {
                speed_mps: number("speed_mps")?,
                turn_rate_radps: number("turn_dps")?.to_radians(),
                direction_rad: number("direction_deg")?.to_radians(),
                gait: gait(cell("gait"), line)?,
                crouch: number("crouch")?,
            },
            jump_m: number("jump_m")?,
        });
    }
    let Some(last) = moves.last() else {
        bail!("the table has no rows; give at least one");
    };
    Ok(Table {
        seconds: last.time_secs + LAST_SECS,
        uses,
        moves,
    })
}

impl Table {
    /// Warnings about columns of the table that a model cannot obey.
    pub(super) fn warnings(&self, model: &GaitModel) -> Vec<String> {
        let knows = [
            ("crouch", model.crouch.is_some()),
            ("jump_m", model.jump.is_some()),
        ];
        let lacks = knows.iter().filter(|(_, knows)| !knows);
        lacks
            .filter_map(|(name, _)| {
                let line = self.uses.get(name)?;
                Some(format!(
                    "line {line}: the model has no {name}, 0 is used; train it with `footfall train --jumping` and `--crouching`"
                ))
            })
            .collect()
    }
}

fn gait(text: &str, line: u64) -> Result<GaitChoice> {
    match text {
        "" | "auto" => Ok(GaitChoice::Auto),
        "walk" => Ok(GaitChoice::Walk),
        "run" => Ok(GaitChoice::Run),
        other => bail!("line {line}: gait '{other}' is unknown; write auto, walk or run"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn missing_columns_and_cells_keep_their_defaults() -> Result<()> {
        let table = parse("time_s, speed_mps, gait\n0,1.4,\n2.5,,run\n")?;
        let [walk, run] = &table.moves[..] else {
            bail!("{table:?}")
        };
        assert_eq!(walk.controls.gait, GaitChoice::Auto);
        assert!((walk.controls.speed_mps - 1.4).abs() < 1e-6);
        assert_eq!(
            (run.controls.speed_mps, run.controls.gait),
            (0.0, GaitChoice::Run)
        );
        assert!((table.seconds - 3.5).abs() < 1e-9 && table.uses.is_empty());
        Ok(())
    }

    #[test]
    fn jumps_and_crouches_are_read_and_their_first_lines_kept() -> Result<()> {
        let table = parse("time_s,jump_m,crouch\n0,0,0.5\n1,0.4,1\n")?;
        assert!((table.moves[1].jump_m - 0.4).abs() < 1e-6);
        assert!((table.moves[0].controls.crouch - 0.5).abs() < 1e-6);
        assert_eq!(table.uses, BTreeMap::from([("crouch", 2), ("jump_m", 3)]));
        Ok(())
    }

    #[test]
    fn bad_tables_name_the_line() {
        for (text, says) in [
            ("time_s,speed\n0,1\n", "unknown column 'speed'"),
            ("speed_mps\n1\n", "time_s"),
            ("time_s\n", "no rows"),
            ("time_s,gait\n0,hop\n", "line 2"),
            ("time_s\n1\n0.5\n", "line 3"),
            ("time_s,speed_mps\n0,fast\n", "line 2"),
            ("time_s,speed_mps\n0,NaN\n", "line 2"),
        ] {
            let error = parse(text).map_err(|error| format!("{error:#}"));
            assert!(
                error.as_ref().is_err_and(|error| error.contains(says)),
                "{text}: {error:?}"
            );
        }
    }
}
