//! Numbers compared with a text file under `tests/golden`, within a stated absolute tolerance.
//!
//! `FOOTFALL_UPDATE_GOLDEN=1` writes the files anew.

use crate::data::repository;
use std::fmt::Write as _;
use std::fs;

/// Compares rows of numbers with `tests/golden/<name>.txt`.
///
/// # Panics
/// With the first row and column that differ by more than `tolerance`, or when the shape differs or the file is missing.
pub fn assert_golden(name: &str, tolerance: f64, rows: &[(String, Vec<f64>)]) {
    let path = repository()
        .join("tests/golden")
        .join(format!("{name}.txt"));
    let mut text =
        format!("# {name}: absolute tolerance {tolerance}; made by FOOTFALL_UPDATE_GOLDEN=1\n");
    for (label, values) in rows {
        let numbers: Vec<String> = values.iter().map(|value| format!("{value:.6}")).collect();
        writeln!(text, "{label}: {}", numbers.join(" ")).expect("a string takes all text");
    }
    if std::env::var_os("FOOTFALL_UPDATE_GOLDEN").is_some_and(|value| value == "1") {
        fs::write(&path, text).expect("the golden file can be written");
        return;
    }
    let kept = fs::read_to_string(&path).unwrap_or_else(|error| {
        panic!(
            "{}: {error}; make it with FOOTFALL_UPDATE_GOLDEN=1",
            path.display()
        )
    });
    let kept: Vec<&str> = kept.lines().filter(|line| !line.starts_with('#')).collect();
    assert_eq!(kept.len(), rows.len(), "{name}: number of rows");
    for (line, (label, values)) in kept.iter().zip(rows) {
        let (kept_label, numbers) = line.split_once(": ").expect("label: numbers");
        assert_eq!(kept_label, label, "{name}: order of rows");
        let numbers: Vec<f64> = numbers
            .split_whitespace()
            .map(|number| number.parse().expect("a number"))
            .collect();
        assert_eq!(
            numbers.len(),
            values.len(),
            "{name}: numbers in row {label}"
        );
        for (column, (kept, now)) in numbers.iter().zip(values).enumerate() {
            assert!(
                (kept - now).abs() <= tolerance,
                "{name}: {label}, column {column}: {now} is not {kept}"
            );
        }
    }
}
