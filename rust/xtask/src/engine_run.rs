//! One run of Godot whose whole output is kept and judged: exit code, time, and what it complains about.

use crate::process;
use anyhow::{Context as _, Result, bail};
use std::fs::{self, File};
use std::io;
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

/// Complaints that fail a run wherever they stand. Godot's own exit code says nothing of them.
const FATAL: [&str; 7] = [
    "SCRIPT ERROR",
    "Can't open dynamic library",
    "GDExtension library not found",
    "panicked at",
    "Parse Error",
    "Failed to load script",
    "SHADER ERROR",
];
/// Errors fail a run when they name something of ours.
const OURS: [&str; 6] = [
    "GaitModel",
    "GaitGenerator3D",
    "GaitCrowd3D",
    "FootPlacement3D",
    "ootfall",
    "res://",
];
/// Tests of bad input print these around errors that they provoke.
const EXPECTED_FROM: &str = "expected errors: begin";
const EXPECTED_TO: &str = "expected errors: end";
/// A run that hangs is ended after this long.
const LIMIT: Duration = Duration::from_mins(5);

/// Runs Godot, keeps its output in `log`, and judges it.
///
/// # Errors
/// When it cannot be started, fails, hangs or complains; with the end of its output and where all of it is.
pub(crate) fn judged(command: &mut Command, log: &Path) -> Result<String> {
    judged_by(command, log, complaint)
}

/// Runs Godot as [`judged`] does, but fails on any error, whatever it names.
///
/// # Errors
/// As [`judged`].
pub(crate) fn quiet(command: &mut Command, log: &Path) -> Result<String> {
    judged_by(command, log, |said| {
        complaint(said).or_else(|| said.lines().find(|line| line.contains("ERROR")))
    })
}

fn judged_by(
    command: &mut Command,
    log: &Path,
    complaint: impl Fn(&str) -> Option<&str>,
) -> Result<String> {
    let shown = process::shown(command);
    let (status, said) = started(command, log)?;
    let problem = match status {
        None => Some(format!("did not end within {} s", LIMIT.as_secs())),
        Some(status) if !status.success() => Some(format!("failed ({status})")),
        Some(_) => complaint(&said).map(|line| format!("complained: {line}")),
    };
    let Some(problem) = problem else {
        return Ok(said);
    };
    let failed: Vec<&str> = said
        .lines()
        .filter(|line| line.starts_with("FAILED"))
        .take(10)
        .collect();
    bail!(
        "`{shown}` {problem}\n{}\n{}\n(all of it: {})",
        process::tail(&said, 30),
        failed.join("\n"),
        log.display()
    )
}

/// Runs Godot and keeps its output in `log`. Returns how it ended, `None` when it hung, and what it said.
///
/// # Errors
/// When it cannot be started.
pub(crate) fn started(command: &mut Command, log: &Path) -> Result<(Option<ExitStatus>, String)> {
    if let Some(folder) = log.parent() {
        fs::create_dir_all(folder)
            .with_context(|| format!("cannot create {}", folder.display()))?;
    }
    let output = File::create(log).with_context(|| format!("cannot write {}", log.display()))?;
    let mut child = command
        .stdin(Stdio::null())
        .stdout(output.try_clone().context("cannot share the log")?)
        .stderr(output)
        .spawn()
        .with_context(|| format!("cannot start `{}`", process::shown(command)))?;
    let begin = Instant::now();
    let status = loop {
        if let Some(status) = child.try_wait().context("cannot wait for Godot")? {
            break Some(status);
        }
        if begin.elapsed() > LIMIT {
            end(&mut child).context("cannot end Godot")?;
            break None;
        }
        std::thread::sleep(Duration::from_millis(50));
    };
    let said = String::from_utf8_lossy(&fs::read(log).context("cannot read the log")?).into_owned();
    Ok((status, said))
}

/// Ends a program and all that it has started: without its script, a display and the Godot on it would run for ever.
fn end(child: &mut Child) -> io::Result<()> {
    let started = started_by(&child.id().to_string());
    child.kill()?;
    if !started.is_empty() {
        let mut kill = Command::new("sh");
        kill.args(["-c", &format!("kill -KILL {}", started.join(" "))]);
        kill.status()?;
    }
    child.wait()?;
    Ok(())
}

/// Numbers of the processes that a process has started, and those that they have; none where the system does not list them.
fn started_by(process: &str) -> Vec<String> {
    let list = format!("/proc/{process}/task/{process}/children");
    let mut all = Vec::new();
    for child in fs::read_to_string(list)
        .unwrap_or_default()
        .split_whitespace()
    {
        all.push(child.to_owned());
        all.extend(started_by(child));
    }
    all
}

/// The first line of a log that fails the run.
fn complaint(log: &str) -> Option<&str> {
    let mut expected = false;
    log.lines().find(|line| {
        if line.contains(EXPECTED_FROM) {
            expected = true;
        } else if line.contains(EXPECTED_TO) {
            expected = false;
        }
        // A panic is never what a test wants to see.
        let fatal = FATAL.iter().any(|words| line.contains(words));
        let ours = line.contains("ERROR: ") && OURS.iter().any(|name| line.contains(name));
        fatal || (ours && !expected)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn complaints_are_found_and_expected_ones_are_not() {
        for line in FATAL {
            assert!(
                complaint(&format!("fine\nthe {line} here\n")).is_some(),
                "{line}"
            );
        }
        assert!(complaint("ERROR: GaitModel: damaged file").is_some());
        assert!(complaint("ERROR: Condition \"p_elem\" is true in a driver").is_none());
        let expected =
            "expected errors: begin\nERROR: GaitModel: damaged file\nexpected errors: end\n";
        assert!(complaint(expected).is_none());
        assert!(complaint(&format!("{expected}ERROR: GaitModel: damaged file\n")).is_some());
        assert!(
            complaint("expected errors: begin\nthread 'main' panicked at src/lib.rs\n").is_some()
        );
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_run_that_hangs_is_ended_with_all_that_it_started() {
        if !Path::new("/proc/thread-self/children").exists() {
            // This kernel lists no processes.
            return;
        }
        let mut command = Command::new("sh");
        command.args(["-c", "sleep 60 & sh -c 'sleep 60; true'; true"]);
        // If they went on, whoever reads the test's output would wait for them.
        command.stdout(Stdio::null()).stderr(Stdio::null());
        let mut child = command.spawn().expect("a shell");
        let process = child.id().to_string();
        let begin = Instant::now();
        let mut started = Vec::new();
        while started.len() < 3 && begin.elapsed() < Duration::from_secs(10) {
            started = started_by(&process);
        }
        assert_eq!(started.len(), 3, "{started:?}");
        end(&mut child).expect("it can be ended");
        let runs = |process: &String| {
            let state = fs::read_to_string(format!("/proc/{process}/stat"));
            state.is_ok_and(|state| !state.contains(") Z"))
        };
        while started.iter().any(runs) {
            assert!(begin.elapsed() < Duration::from_secs(20), "{started:?}");
        }
    }

    #[cfg(unix)]
    #[test]
    fn a_failing_run_shows_its_end_and_its_log() {
        let log = std::env::temp_dir().join(format!("footfall_run_{}.log", std::process::id()));
        let shell = |script: &str| {
            let mut command = Command::new("sh");
            command.args(["-c", script]);
            command
        };
        assert_eq!(judged(&mut shell("echo fine"), &log).unwrap(), "fine\n");
        let error = judged(&mut shell("echo last words; exit 3"), &log)
            .unwrap_err()
            .to_string();
        assert!(
            error.contains("last words") && error.contains("exit status: 3"),
            "{error}"
        );
        let error = judged(&mut shell("echo SCRIPT ERROR: x >&2"), &log)
            .unwrap_err()
            .to_string();
        assert!(error.contains("complained: SCRIPT ERROR: x"), "{error}");
        fs::remove_file(log).unwrap();
    }
}
