//! `cargo verify`: everything that must hold before a change goes in, in the order in which it fails soonest.

mod checks;

use crate::{examples, network, newcomer, package, skipped, tidy};
use anyhow::{Context as _, Result, bail};
use std::thread;
use std::time::Instant;

/// One thing to check.
#[derive(Clone, Copy)]
struct Step {
    name: &'static str,
    check: fn() -> Result<()>,
}

const fn step(name: &'static str, check: fn() -> Result<()>) -> Step {
    Step { name, check }
}

/// Steps that run one after another.
type Lane = &'static [Step];

/// Stages that run one after another; the lanes of a stage run side by side. Lanes of one stage must not write the same files.
const STAGES: [&[Lane]; 4] = [
    &[&[step("format", checks::format), step("tidy", tidy::command)]],
    // The second lane waits for downloads.
    &[
        &[step("clippy", checks::clippy)],
        &[
            step("godot", checks::provision),
            step("chromium", checks::browser),
        ],
    ],
    &[&[
        step("tests", checks::tests),
        step("examples", examples::check),
        step("package", package::check),
        step("docs", checks::docs),
        step("library", checks::build_library),
        // It measures frames, so nothing may run beside it.
        step("godot-play", checks::play_in_godot),
        // It replaces the library of the project that others play.
        step("godot-editor", checks::tests_in_the_editor),
        // Peers whose frames wait for a processor make some steps elsewhere.
        step("godot-network", network::check),
    ]],
    // These wait for most of their time: for frames and for ports.
    &[
        &[step("godot-tests", checks::tests_in_godot)],
        &[
            step("export", checks::exported_demo),
            step("newcomer", newcomer::check),
            step("godot-demo", checks::demo_in_godot),
        ],
    ],
];

/// Runs every step, or only those that are named, and stops after the first stage in which one fails.
///
/// # Errors
/// Every failure of that stage, or a name that is no step's.
pub(crate) fn command(only: &[String]) -> Result<()> {
    let names: Vec<&str> = STAGES
        .iter()
        .flat_map(|lanes| lanes.iter().copied().flatten())
        .map(|step| step.name)
        .collect();
    if let Some(unknown) = only.iter().find(|name| !names.contains(&name.as_str())) {
        bail!(
            "there is no step `{unknown}`; the steps are {}",
            names.join(", ")
        );
    }
    let wanted = |name: &str| only.is_empty() || only.iter().any(|one| one == name);
    if wanted("tests") {
        skipped::check_promised_recordings()?;
    }
    skipped::begin()?;
    let begin = Instant::now();
    let mut times = Vec::new();
    for lanes in STAGES {
        let lanes: Vec<Vec<Step>> = lanes
            .iter()
            .map(|lane| {
                lane.iter()
                    .copied()
                    .filter(|step| wanted(step.name))
                    .collect()
            })
            .collect();
        times.extend(side_by_side(&lanes)?);
    }
    eprintln!("── seconds: {}", times.join(", "));
    eprintln!("── {}", skipped::summary()?);
    eprintln!("── all passed in {:.0} s", begin.elapsed().as_secs_f32());
    Ok(())
}

/// Runs lanes side by side until each has ended or failed; returns the steps' names with their seconds.
fn side_by_side(lanes: &[Vec<Step>]) -> Result<Vec<String>> {
    let ended: Vec<Result<Vec<String>>> = thread::scope(|scope| {
        let running: Vec<_> = lanes
            .iter()
            .map(|lane| scope.spawn(|| in_turn(lane)))
            .collect();
        let joined = running.into_iter().map(|lane| {
            lane.join()
                .unwrap_or_else(|_panic| bail!("a check panicked"))
        });
        joined.collect()
    });
    let mut times = Vec::new();
    let mut failures = Vec::new();
    for lane in ended {
        match lane {
            Ok(lane) => times.extend(lane),
            Err(failure) => failures.push(format!("{failure:#}")),
        }
    }
    if !failures.is_empty() {
        bail!("{}", failures.join("\n"));
    }
    Ok(times)
}

/// Runs steps one after another and stops at the first that fails; returns their names with their seconds.
fn in_turn(lane: &[Step]) -> Result<Vec<String>> {
    let mut times = Vec::new();
    for step in lane {
        eprintln!("── {}", step.name);
        let begin = Instant::now();
        (step.check)().with_context(|| {
            format!(
                "{} failed after {:.0} s",
                step.name,
                begin.elapsed().as_secs_f32()
            )
        })?;
        let secs = begin.elapsed().as_secs_f32();
        eprintln!("── {} passed in {secs:.0} s", step.name);
        times.push(format!("{} {secs:.0}", step.name));
    }
    Ok(times)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicU32, Ordering};

    #[test]
    fn a_failure_ends_its_own_lane_and_every_failure_is_reported() {
        static RUNS: AtomicU32 = AtomicU32::new(0);
        let passes: fn() -> Result<()> = || {
            RUNS.fetch_add(1, Ordering::Relaxed);
            Ok(())
        };
        let fails: fn() -> Result<()> = || bail!("for a reason");
        let lanes = [
            vec![step("first", fails), step("never", passes)],
            vec![step("beside", passes), step("last", fails)],
        ];
        let error = side_by_side(&lanes).unwrap_err().to_string();
        assert_eq!(
            error,
            "first failed after 0 s: for a reason\nlast failed after 0 s: for a reason"
        );
        assert_eq!(RUNS.load(Ordering::Relaxed), 1);
        let times = side_by_side(&[vec![step("one", passes)], vec![step("two", passes)]]).unwrap();
        assert_eq!(times, ["one 0", "two 0"]);
    }

    #[test]
    fn an_unknown_step_is_refused_with_the_names_of_all() {
        let error = command(&["clipy".to_owned()]).unwrap_err().to_string();
        assert!(
            error.contains("`clipy`") && error.contains("godot-tests"),
            "{error}"
        );
    }
}
