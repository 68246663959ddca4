//! The checks themselves, but for those that have a module of their own.

use crate::{
    chromium, csharp, demo, engine_run, export, godot, library, link, open, paths, process, skipped,
};
use anyhow::{Context as _, Result, bail};
use std::env;
use std::path::Path;

/// Number of frames that the demo runs.
const DEMO_FRAMES: &str = "300";

pub(super) fn format() -> Result<()> {
    process::run(process::cargo().args(["fmt", "--all", "--check"]))
        .context("run `cargo fmt --all` in rust/")
}

pub(super) fn clippy() -> Result<()> {
    let features = ["--features", "footfall/live,footfall_godot/editor"];
    process::run(
        process::cargo()
            .args(["clippy", "--locked", "--workspace", "--all-targets"])
            .args(features)
            .args(["--", "-D", "warnings"]),
    )
}

/// Runs all tests but the nodes', which need Godot.
pub(super) fn tests() -> Result<()> {
    let mut cargo = process::cargo_without_nodes("test");
    cargo.env(skipped::LIST, skipped::list());
    if let Some(browser) = chromium::fetched() {
        let path = env::var_os("PATH").unwrap_or_default();
        let folders = env::split_paths(&path).chain([browser]);
        cargo.env(
            "PATH",
            env::join_paths(folders)
                .context("the PATH has a folder whose name is no part of a PATH")?,
        );
    }
    let status = cargo.status().context("cannot start cargo")?;
    if !status.success() {
        bail!("`{}` failed ({status})", process::shown(&cargo));
    }
    Ok(())
}

pub(super) fn docs() -> Result<()> {
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

/// Builds the library in both flavours: the editor's, and the one for exported games.
pub(super) fn build_library() -> Result<()> {
    library::build(&library::Options {
        all: true,
        ..library::Options::default()
    })
}

pub(super) fn provision() -> Result<()> {
    let engine = godot::provision()?;
    eprintln!("Godot {} at {}", engine.version, engine.program.display());
    link::ensure()
}

/// Has a browser there for the tests of pages, which are skipped without one.
pub(super) fn browser() -> Result<()> {
    chromium::provision().or_else(|error| skipped::note("chromium", &error.to_string()))
}

pub(super) fn tests_in_godot() -> Result<()> {
    let said = in_godot("tests/godot", "tests", &[])?;
    // The tests' own report is worth seeing.
    eprintln!("{}", process::tail(&said, 12));
    csharp::check()
}

/// A game of some minutes, as fast as frames come: no error, no growth, no slow frame.
pub(super) fn play_in_godot() -> Result<()> {
    let said = in_godot(
        "tests/godot",
        "play",
        &["res://play/play.tscn", "--fixed-fps", "60"],
    )?;
    eprintln!("{}", process::tail(&said, 3));
    Ok(())
}

/// Checks the parts of the add-on in the editor: dock, gizmo, preview.
pub(super) fn tests_in_the_editor() -> Result<()> {
    let arguments = ["--editor", "--", "--editor-tests"];
    let said = in_godot("tests/godot", "editor_tests", &arguments)?;
    eprintln!("{}", process::tail(&said, 1));
    Ok(())
}

pub(super) fn demo_in_godot() -> Result<()> {
    for (topic, scene) in demo::SCENES {
        // A network does not wait for frames. Long ones are the harder case.
        let pace = match topic {
            "network" => ["--max-fps", "30"],
            _ => ["--fixed-fps", "60"],
        };
        let arguments = [&[scene][..], &pace, &["--", "--frames", DEMO_FRAMES]];
        in_godot(
            "demo_project",
            &format!("demo_{topic}"),
            &arguments.concat(),
        )?;
    }
    Ok(())
}

/// Exports the demo as players get it, with the library's game flavour, and starts it.
pub(super) fn exported_demo() -> Result<()> {
    if !cfg!(target_os = "linux") {
        return skipped::note("export", "the demo is exported on Linux only");
    }
    let engine = godot::provision()?;
    if engine.release_template.is_none() {
        return skipped::note("export", "this Godot came without an export template");
    }
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
