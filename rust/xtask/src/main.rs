//! `cargo xtask`: the one door to provisioning, building, checking and packaging Footfall.
//!
//! Every command is one module. Progress goes to stderr; stdout holds results alone, so that other programs can read it.
#![expect(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a command line tool talks to its user"
)]
#![expect(clippy::disallowed_methods, reason = "steps are timed for the user")]

mod display;
mod godot;
mod library;
mod link;
mod mannequin;
mod open;
mod paths;
mod process;
mod progress;

use clap::{Parser, Subcommand};
use std::path::PathBuf;
use std::process::ExitCode;

/// Automation for the Footfall repository.
#[derive(Parser)]
#[command(name = "cargo xtask", version, about, disable_help_subcommand = true)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Find or fetch Godot 4.6 or newer; its path is the last line of stdout.
    Godot {
        /// Print the path of the release export template instead, where this Godot comes with one.
        #[arg(long)]
        template: bool,
    },
    /// Build the add-on's library and put it into `addons/footfall/bin`.
    Library(library::Options),
    /// Make the add-on visible inside `demo_project` and `tests/godot`, without a second copy.
    Link,
    /// Make the demo's character, `demo_project/characters/mannequin.glb`.
    Mannequin,
    /// Start Godot on a project folder, on a display in memory where there is none.
    Open {
        /// The project's folder, from the repository's root.
        project: PathBuf,
        /// What Godot is given besides.
        #[arg(last = true)]
        arguments: Vec<String>,
    },
}

fn main() -> ExitCode {
    match run(&Arguments::parse().command) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::FAILURE
        }
    }
}

fn run(command: &Command) -> anyhow::Result<()> {
    match command {
        Command::Godot { template } => godot::command(*template),
        Command::Library(options) => library::build(options),
        Command::Link => link::command(),
        Command::Mannequin => mannequin::command(),
        Command::Open { project, arguments } => open::command(project, arguments),
    }
}
