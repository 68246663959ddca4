//! Runs the program and looks at what came out.

use serde_json::Value;
use std::path::Path;
use std::process::{Command, Output};

/// Outcome of a run.
pub(crate) struct Run {
    /// Exit code.
    pub(crate) code: i32,
    /// Standard output.
    pub(crate) stdout: String,
    /// Standard error.
    pub(crate) stderr: String,
}

/// Runs `footfall` with these arguments in a folder.
pub(crate) fn footfall(folder: &Path, arguments: &[&str]) -> Run {
    let Output {
        status,
        stdout,
        stderr,
    } = Command::new(env!("CARGO_BIN_EXE_footfall"))
        .args(arguments)
        .current_dir(folder)
        .output()
        .expect("the program starts");
    Run {
        code: status.code().expect("the program was not killed"),
        stdout: String::from_utf8(stdout).expect("stdout is text"),
        stderr: String::from_utf8(stderr).expect("stderr is text"),
    }
}

impl Run {
    /// The JSON object on stdout of a run that went well.
    pub(crate) fn json(&self) -> Value {
        assert_eq!(self.code, 0, "{}", self.stderr);
        assert_eq!(
            self.stdout.trim_end().lines().count(),
            1,
            "one object, one line: {}",
            self.stdout
        );
        let value: Value = serde_json::from_str(&self.stdout).expect("stdout is JSON");
        assert!(value.is_object(), "{value}");
        value
    }

    /// Asserts that the run failed with one line on stderr that holds all of these, and nothing on stdout.
    pub(crate) fn fails_with(&self, parts: &[&str]) {
        assert_eq!(
            self.code, 1,
            "stdout {} stderr {}",
            self.stdout, self.stderr
        );
        assert_eq!(self.stdout, "");
        let errors: Vec<&str> = self
            .stderr
            .lines()
            .filter(|line| line.starts_with("error: "))
            .collect();
        assert_eq!(errors.len(), 1, "{}", self.stderr);
        assert_eq!(
            self.stderr.lines().last(),
            Some(errors[0]),
            "the error comes last: {}",
            self.stderr
        );
        for part in parts {
            assert!(
                errors[0].contains(part),
                "'{part}' is not in: {}",
                errors[0]
            );
        }
        assert!(!self.stderr.contains("panicked"), "{}", self.stderr);
    }
}
