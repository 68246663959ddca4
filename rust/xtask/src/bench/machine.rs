//! Measurements of one machine, as they are kept.

use anyhow::{Context as _, Result};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::fs;
use std::path::Path;

/// One machine and its measurements.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Machine {
    /// Name of the processor.
    pub(super) processor: String,
    /// Threads that run at the same time.
    pub(super) threads: usize,
    /// Operating system and architecture.
    pub(super) platform: String,
    /// Version of Footfall.
    pub(super) version: String,
    /// Report of `footfall bench`.
    pub(super) kernels: Value,
    /// Report of `cargo xtask bench-crowd`.
    pub(super) crowds: Value,
}

impl Machine {
    /// This machine, with what was measured on it.
    pub(super) fn here(kernels: Value, crowds: Value) -> Self {
        let platform = format!("{} {}", std::env::consts::OS, std::env::consts::ARCH);
        Self {
            processor: processor().unwrap_or_else(|| platform.clone()),
            threads: std::thread::available_parallelism().map_or(1, usize::from),
            platform,
            version: env!("CARGO_PKG_VERSION").to_owned(),
            kernels,
            crowds,
        }
    }

    /// Name for people.
    pub(super) fn title(&self) -> String {
        format!("{}, {} threads", self.processor, self.threads)
    }

    /// Name of a file about the machine: its processor in letters and digits, its threads, and an extension.
    pub(super) fn file_name(&self, extension: &str) -> String {
        let words = self
            .processor
            .split(|letter: char| !letter.is_ascii_alphanumeric());
        let words: Vec<String> = words
            .filter(|word| !word.is_empty())
            .map(str::to_lowercase)
            .collect();
        format!("{}_{}_threads.{extension}", words.join("_"), self.threads)
    }

    /// A time of a report, by the report's and its own name. Nothing takes no time.
    pub(super) fn figure(&self, name: &str) -> Option<f64> {
        let (report, name) = name.split_once('.')?;
        let report = match report {
            "kernels" => &self.kernels,
            "crowds" => &self.crowds,
            _ => return None,
        };
        report.get(name)?.as_f64().filter(|time| *time > 0.0)
    }
}

/// Every machine that is kept, in the order of the files' names.
///
/// # Errors
/// When a file cannot be read, or holds no measurement.
pub(super) fn kept(folder: &Path) -> Result<Vec<Machine>> {
    let read = || format!("cannot read {}", folder.display());
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).with_context(read)? {
        files.push(entry.with_context(read)?.path());
    }
    files.retain(|file| file.extension().is_some_and(|own| own == "json"));
    files.sort();
    let machines = files.iter().map(|file| {
        let text =
            fs::read_to_string(file).with_context(|| format!("cannot read {}", file.display()))?;
        serde_json::from_str(&text).with_context(|| {
            format!(
                "{}: no measurement; measure anew with `cargo xtask bench --keep`",
                file.display()
            )
        })
    });
    machines.collect()
}

/// Name of the processor, where the system says it.
fn processor() -> Option<String> {
    let info = fs::read_to_string("/proc/cpuinfo").ok()?;
    let line = info.lines().find(|line| line.starts_with("model name"))?;
    let name = line.split_once(':')?.1;
    Some(name.split_whitespace().collect::<Vec<_>>().join(" "))
}
