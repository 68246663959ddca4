//! `cargo verify`: everything that must hold before a change goes in, in the order in which it fails soonest.

use crate::{
    csharp, demo, engine_run, examples, export, godot, library, link, network, newcomer, open,
    package, paths, process, skipped, tidy,
};
use anyhow::{Context as _, Result, bail};
use std::path::Path;
use std::time::Instant;

/// Number of frames that the demo runs.
const DEMO_FRAMES: &str = "300";

/// One thing to check.
struct Step {
    name: &'static str,
    check: fn() -> Result<()>,
}

const STEPS: [Step; 16] = [
    Step {
        name: "format",
        check: format,
    },
    Step {
        name: "tidy",
        check: tidy::command,
    },
    Step {
        name: "clippy",
        check: clippy,
    },
    Step {
        name: "tests",
        check: tests,
    },
    Step {
        name: "examples",
        check: examples::check,
    },
    Step {
        name: "package",
        check: package::check,
    },
    Step {
        name: "docs",
        check: docs,
    },
    Step {
        name: "library",
        check: build_library,
    },
    Step {
        name: "godot",
        check: provision,
    },
    Step {
        name: "godot-tests",
        check: tests_in_godot,
    },
    Step {
        name: "godot-play",
        check: play_in_godot,
    },
    Step {
        name: "godot-network",
        check: network::check,
    },
    Step {
        name: "godot-editor",
        check: tests_in_the_editor,
    },
    Step {
        name: "godot-demo",
        check: demo_in_godot,
    },
    Step {
        name: "export",
        check: exported_demo,
    },
    Step {
        name: "newcomer",
        check: newcomer::check,
    },
];

/// Runs every step, or only those that are named, and stops at the first that fails.
///
/// # Errors
/// The first failure, or a name that is no step's.
pub(crate) fn command(only: &[String]) -> Result<()> {
    let known = |name: &String| STEPS.iter().any(|step| step.name == name);
    if let Some(unknown) = only.iter().find(|name| !known(name)) {
        let names: Vec<&str> = STEPS.iter().map(|step| step.name).collect();
        bail!(
            "there is no step `{unknown}`; the steps are {}",
            names.join(", ")
        );
    }
    let wanted = |step: &&Step| only.is_empty() || only.iter().any(|name| name == step.name);
    let steps: Vec<&Step> = STEPS.iter().filter(wanted).collect();
    if steps.iter().any(|step| step.name == "tests") {
        skipped::check_promised_recordings()?;
    }
    skipped::begin()?;
    let begin = Instant::now();
    let mut times = Vec::new();
    for (index, step) in steps.iter().enumerate() {
        eprintln!("── {}/{} {}", index + 1, steps.len(), step.name);
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
    eprintln!("── seconds: {}", times.join(", "));
    eprintln!("── {}", skipped::summary()?);
    eprintln!("── all passed in {:.0} s", begin.elapsed().as_secs_f32());
    Ok(())
}

fn format() -> Result<()> {
    process::run(process::cargo().args(["fmt", "--all", "--check"]))
        .context("run `cargo fmt --all` in rust/")
}

fn clippy() -> Result<()> {
    let features = ["--features", "footfall/live,footfall_godot/editor"];
    process::run(
        process::cargo()
            .args(["clippy", "--locked", "--workspace", "--all-targets"])
            .args(features)
            .args(["--", "-D", "warnings"]),
    )
}

/// Runs all tests but the nodes', which need Godot.
fn tests() -> Result<()> {
    let mut cargo = process::cargo_without_nodes("test");
    cargo.env(skipped::LIST, skipped::list());
    let status = cargo.status().context("cannot start cargo")?;
    if !status.success() {
        bail!("`{}` failed ({status})", process::shown(&cargo));
    }
    Ok(())
}

fn docs() -> Result<()> {
    process::run(
        process::cargo()
            .args([
                "doc",
                "--quiet",
                "--locked",
                "--workspace",
                "--no-deps",
                "--features",
                "footfall/live,footfall_godot/editor",
            ])
            .env("RUSTDOCFLAGS", "-D warnings"),
    )
}

fn build_library() -> Result<()> {
    library::build(&library::Options::default())
}

fn provision() -> Result<()> {
    let engine = godot::provision()?;
    eprintln!("Godot {} at {}", engine.version, engine.program.display());
    link::ensure()
}

fn tests_in_godot() -> Result<()> {
    let said = in_godot("tests/godot", "tests", &[])?;
    // The tests' own report is worth seeing.
    eprintln!("{}", process::tail(&said, 12));
    csharp::check()
}

/// A game of some minutes, as fast as frames come: no error, no growth, no slow frame.
fn play_in_godot() -> Result<()> {
    let said = in_godot(
        "tests/godot",
        "play",
        &["res://play/play.tscn", "--fixed-fps", "60"],
    )?;
    eprintln!("{}", process::tail(&said, 3));
    Ok(())
}

/// Checks the parts of the add-on in the editor: dock, gizmo, preview.
fn tests_in_the_editor() -> Result<()> {
    let arguments = ["--editor", "--", "--editor-tests"];
    let said = in_godot("tests/godot", "editor_tests", &arguments)?;
    eprintln!("{}", process::tail(&said, 1));
    Ok(())
}

fn demo_in_godot() -> Result<()> {
    for (topic, scene) in demo::SCENES {
        in_godot(
            "demo_project",
            &format!("demo_{topic}"),
            &[scene, "--fixed-fps", "60", "--", "--frames", DEMO_FRAMES],
        )?;
    }
    Ok(())
}

/// Exports the demo as players get it: with the library's game flavour. The step `library` builds the editor's.
fn exported_demo() -> Result<()> {
    if !cfg!(target_os = "linux") {
        return skipped::note("export", "the demo is exported on Linux only");
    }
    let engine = godot::provision()?;
    if engine.release_template.is_none() {
        return skipped::note("export", "this Godot came without an export template");
    }
    library::build_flavour(library::Flavour::Game, &library::Options::default())?;
    let game = export::export(&engine)?;
    export::start(&engine, &game)
}

/// Imports a project and runs a scene of it, the main one if none is named, without a window.
fn in_godot(project: &str, name: &str, arguments: &[&str]) -> Result<String> {
    let engine = godot::provision()?;
    let folder = paths::repository_root().join(project);
    require(&folder.join("project.godot"))?;
    demo::import(&engine, &folder, name)?;
    let log = paths::target_folder()
        .join("verify")
        .join(format!("{name}.log"));
    engine_run::judged(open::headless(&engine, &folder).args(arguments), &log)
}

fn require(file: &Path) -> Result<()> {
    if !file.is_file() {
        bail!("{} is missing", file.display());
    }
    Ok(())
}
