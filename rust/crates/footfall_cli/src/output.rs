//! Output of the program: files that appear whole or not at all, JSON on stdout, progress on stderr.

use anyhow::{Context as _, Result, bail};
use footfall_motion::files;
use indicatif::{ProgressBar, ProgressStyle};
use serde::Serialize;
use std::io::{self, IsTerminal as _, Write as _};
use std::path::Path;
use std::time::Duration;

/// Writes a file whole or not at all; errors name it.
pub(crate) fn write_atomic(path: &Path, bytes: &[u8]) -> Result<()> {
    files::write_atomic(path, bytes).with_context(|| {
        format!(
            "cannot write {}; check that its folder exists and that you may write there",
            path.display()
        )
    })
}

/// Refuses an output that is one of the inputs.
pub(crate) fn refuse_overwrite(inputs: &[&Path], output: &Path) -> Result<()> {
    let Ok(target) = output.canonicalize() else {
        // What does not exist yet cannot be an input.
        return Ok(());
    };
    for input in inputs {
        if input.canonicalize().is_ok_and(|source| source == target) {
            bail!(
                "{} is the input; choose another name for the output",
                output.display()
            );
        }
    }
    Ok(())
}

/// Prints one JSON object and a line end on stdout.
pub(crate) fn print_json(value: &impl Serialize) -> Result<()> {
    let text = serde_json::to_string(value).context("the result does not fit JSON")?;
    print_text(&text)
}

/// Prints a report on stdout: as JSON, or as the text that people read.
pub(crate) fn print_report<R: Serialize>(
    json: bool,
    report: &R,
    text: impl FnOnce(&R) -> String,
) -> Result<()> {
    if json {
        return print_json(report);
    }
    print_text(&text(report))
}

/// Warns of recordings that were left out.
pub(crate) fn note_left_out(reasons: impl IntoIterator<Item = impl AsRef<str>>) {
    for reason in reasons {
        note(&format!("warning: left out {}", reason.as_ref()));
    }
}

/// Prints text and a line end on stdout; a reader that went away is no error.
pub(crate) fn print_text(text: &str) -> Result<()> {
    let mut out = io::stdout().lock();
    match writeln!(out, "{text}").and_then(|()| out.flush()) {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        other => other.context("cannot write to stdout"),
    }
}

/// A line on stderr: what was done, or a warning, whose first word is coloured on a terminal.
pub(crate) fn note(text: &str) {
    let text = match (text.strip_prefix("error:"), text.strip_prefix("warning:")) {
        (Some(rest), _) => format!("{}{rest}", painted("error:", Colour::Red, &io::stderr())),
        (_, Some(rest)) => {
            format!(
                "{}{rest}",
                painted("warning:", Colour::Yellow, &io::stderr())
            )
        }
        _ => text.to_owned(),
    };
    // Without stderr nobody reads a message.
    drop(writeln!(io::stderr().lock(), "{text}"));
}

/// A colour of a terminal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Colour {
    Red,
    Green,
    Yellow,
}

/// Text for stdout, in colour where that is a terminal.
pub(crate) fn coloured(text: &str, colour: Colour) -> String {
    painted(text, colour, &io::stdout())
}

/// Bold and coloured on a terminal that may have colours (<https://no-color.org>).
fn painted(text: &str, colour: Colour, stream: &impl io::IsTerminal) -> String {
    let is_refused = std::env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty());
    if !stream.is_terminal() || is_refused {
        return text.to_owned();
    }
    let code = match colour {
        Colour::Red => 31,
        Colour::Green => 32,
        Colour::Yellow => 33,
    };
    format!("\u{1b}[1;{code}m{text}\u{1b}[0m")
}

/// Progress on stderr: a bar on a terminal, a line for each stage elsewhere.
pub(crate) struct Progress {
    bar: Option<ProgressBar>,
}

impl Progress {
    /// Begins; nothing shows before the first stage.
    pub(crate) fn new() -> Self {
        let bar = io::stderr().is_terminal().then(|| {
            let bar = ProgressBar::new_spinner();
            bar.enable_steady_tick(Duration::from_millis(120));
            bar
        });
        Self { bar }
    }

    /// A new stage of `length` units; 0 for one without a known length.
    pub(crate) fn stage(&self, message: &str, length: u64) {
        let Some(bar) = &self.bar else {
            return note(message);
        };
        let template = if length == 0 {
            "{spinner} {msg} {elapsed}"
        } else {
            "{msg} [{bar:30}] {pos}/{len} {elapsed}"
        };
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style);
        }
        bar.set_length(length);
        bar.set_position(0);
        bar.set_message(message.to_owned());
    }

    /// Shows the number of units of the stage that are done.
    pub(crate) fn reach(&self, position: u64) {
        if let Some(bar) = &self.bar {
            bar.set_position(position);
        }
    }

    /// Removes the bar.
    pub(crate) fn finish(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn a_file_is_replaced_whole_and_nothing_is_left_beside_it() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("out.txt");
        write_atomic(&path, b"one").unwrap();
        write_atomic(&path, b"two").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"two");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn a_missing_folder_is_named_and_no_part_is_left() {
        let folder = tempfile::tempdir().unwrap();
        let error = write_atomic(&folder.path().join("no/such/out.txt"), b"x").unwrap_err();
        assert!(error.to_string().contains("out.txt"), "{error}");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
    }

    #[test]
    fn the_input_is_safe_under_another_spelling() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("in.bvh");
        fs::write(&path, "x").unwrap();
        let other = folder.path().join("./in.bvh");
        let error = refuse_overwrite(&[&path], &other).unwrap_err();
        assert!(error.to_string().contains("is the input"), "{error}");
        refuse_overwrite(&[&path], &folder.path().join("out.bvh")).unwrap();
    }
}
