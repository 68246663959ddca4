//! Linux on arm64: cross-built, and run by Debian's Godot for arm64 under an emulator of its processor.

use super::linux_x86_64::symbols;
use super::table::{Column, Row};
use super::{Settings, build, host};
use crate::apt::Apt;
use crate::binary::Binary;
use crate::library::{self, Flavour};
use crate::{demo, engine_run, fetch, godot, link, paths, process};
use anyhow::{Result, ensure};
use std::path::{Path, PathBuf};
use std::process::Command;

/// Debian's package with programs that each emulate one processor.
const EMULATORS: &str = "qemu-user-static";
/// The tests that Godot runs: all whose names contain this.
const TESTS: &str = "test_walk";
pub(super) fn check(row: &mut Row, settings: &Settings, target: &str) -> Result<()> {
    let library = build(row, settings, target)?;
    symbols(row, &Binary::read(&library)?)?;
    row.begin(Column::Run);
    if !cfg!(target_os = "linux") {
        row.open(Column::Run, "the emulator runs on Linux only");
        return Ok(());
    }
    let machine = Machine::provision()?;
    let host = host::compile("aarch64-linux-gnu.2.31", "")?;
    let answered = host::ask(|| machine.program(&host), &library)?;
    // A Godot that is no exported game loads the editor's library.
    super::library(settings, Flavour::Editor, target)?;
    let passed = machine.tests()?;
    row.done(&format!(
        "{answered}; {TESTS} in Godot under qemu: {passed}"
    ));
    Ok(())
}

/// An arm64 machine: an emulator, and the files of a Debian with Godot.
struct Machine {
    emulator: PathBuf,
    root: PathBuf,
}

impl Machine {
    fn provision() -> Result<Self> {
        let folder = fetch::once("qemu", EMULATORS, |folder| {
            Apt::fetch(folder, &[EMULATORS], "unpacking the emulator").map(drop)
        })?;
        Ok(Self {
            emulator: folder.join("root/usr/bin/qemu-aarch64-static"),
            root: godot::arm64()?,
        })
    }

    /// A program of this machine.
    fn program(&self, program: &Path) -> Command {
        let mut command = Command::new(&self.emulator);
        command.arg("-L").arg(&self.root).arg(program);
        command
    }

    /// Runs tests of the nodes, with the library that an editor loads; returns the line that counts them.
    fn tests(&self) -> Result<String> {
        let project = paths::repository_root().join("tests/godot");
        // This machine's own engine imports, which is the same on all and takes the emulated one many minutes.
        let engine = godot::provision()?;
        library::build(&library::Options::default())?;
        link::ensure()?;
        demo::import(&engine, &project, "arm64_tests")?;
        let log = paths::target_folder().join("platforms/linux-arm64.log");
        let mut godot = self.program(&self.root.join("usr/bin/godot"));
        godot
            .args(["--headless", "--audio-driver", "Dummy", "--path"])
            .arg(&project)
            .args(["--", TESTS]);
        let said = engine_run::judged(&mut godot, &log)?;
        let last = process::tail(&said, 1);
        ensure!(last.contains("passed"), "the tests did not end: {last}");
        Ok(last)
    }
}
