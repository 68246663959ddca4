//! `cargo xtask`: the one door to provisioning, building, checking and packaging Footfall.
//!
//! Every command is one module. Progress goes to stderr; stdout holds results alone, so that other programs can read it.
#![expect(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a command line tool talks to its user"
)]
#![expect(clippy::disallowed_methods, reason = "steps are timed for the user")]

mod addon;
mod apt;
mod audit;
mod bench;
mod bench_crowd;
mod bevy;
mod binary;
mod chromium;
mod contact_sheet;
mod cross;
mod csharp;
mod demo;
mod display;
mod engine_run;
mod examples;
mod export;
mod fetch;
mod film;
mod godot;
mod golden;
mod library;
mod link;
mod mannequin;
mod models;
mod mono;
mod network;
mod newcomer;
mod open;
mod package;
mod paths;
mod pictures;
mod platforms;
mod process;
mod progress;
mod release;
mod shared_libraries;
mod skipped;
mod tidy;
mod tools;
mod verify;
mod vulkan;
mod webp;

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
    /// Find or download Godot 4.6 or newer, and print its path as the last line of stdout.
    Godot {
        /// Print the path of the release export template instead, if this Godot has one.
        #[arg(long)]
        template: bool,
    },
    /// Build the add-on's library into `addons/footfall/bin`.
    Library(library::Options),
    /// Build the library for exported games for each platform, check it as far as this machine can, and print a table.
    Platforms(platforms::Settings),
    /// Link the add-on into `demo_project` and `tests/godot`.
    Link,
    /// Make the demo's character, `demo_project/characters/mannequin.glb`.
    Mannequin,
    /// Pack the add-on into `rust/target/footfall-addon.zip`.
    Addon {
        /// Use the libraries in `addons/footfall/bin` without building.
        #[arg(long)]
        packed: bool,
    },
    /// Collect a release in a folder below `rust/target`, beginning with the add-on for every platform.
    Release(release::Settings),
    /// Check the workflows with actionlint, and the dependencies with cargo-deny; both are downloaded.
    Audit,
    /// Train the models of the add-on on the motion data in `FOOTFALL_DATA`.
    Models {
        /// Models to train [default: all]. Styles are trained on the existing walk
        which: Vec<models::Which>,
    },
    /// Compare results with those kept in `tests/golden`.
    Golden {
        /// Keep the new results instead.
        #[arg(long)]
        update: bool,
    },
    /// Generate the add-on's typed C# wrappers from the library's class reference.
    Csharp {
        /// Compare, compile and run the existing wrappers instead.
        #[arg(long)]
        check: bool,
    },
    /// Check the design's invariants.
    Tidy,
    /// Run all checks: format, rules, lints, tests, docs, the nodes in Godot, the demo.
    Verify {
        /// Steps to run, for example `clippy` or `godot-tests` [default: all]
        steps: Vec<String>,
    },
    /// Build everything and open the demo; without a display, render pictures of it.
    Demo,
    /// Film the tour of the town for the README.
    Film,
    /// Render the pictures of the README and of the store's entry.
    Pictures,
    /// Build and test the Bevy example, and render pictures of it.
    Bevy,
    /// Export the demo as a game for this machine into `rust/target/export`, and start it once without a window.
    Export {
        /// Use the library for exported games.
        #[arg(long)]
        shipped: bool,
    },
    /// Measure kernels and crowds on this machine, each beside a peer or a limit, in one table.
    Bench {
        /// Keep the measurement in `rust/benchmarks` and update `rust/BENCHMARKS.md`.
        #[arg(long)]
        keep: bool,
        /// Measure nothing; write `rust/BENCHMARKS.md` and its pictures anew from what was kept.
        #[arg(long, conflicts_with = "keep")]
        page: bool,
    },
    /// Measure crowds in headless Godot; prints one JSON object, times in ms and µs.
    BenchCrowd {
        /// Instances.
        #[arg(long, default_value_t = 10_000)]
        instances: u32,
        /// Whole skeletons.
        #[arg(long, default_value_t = 1500)]
        skeletons: u32,
        /// Print JSON, which is the default.
        #[arg(long)]
        json: bool,
    },
    /// Start Godot on a project folder, on a virtual display if there is none.
    Open {
        /// The project's folder, from the repository's root.
        project: PathBuf,
        /// Further arguments for Godot.
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
        Command::Platforms(settings) => platforms::command(settings),
        Command::Link => link::command(),
        Command::Mannequin => mannequin::command(),
        Command::Addon { packed } => addon::command(*packed),
        Command::Release(settings) => release::command(settings),
        Command::Audit => audit::command(),
        Command::Models { which } => models::command(which),
        Command::Golden { update } => golden::command(*update),
        Command::Csharp { check } => csharp::command(*check),
        Command::Tidy => tidy::command(),
        Command::Verify { steps } => verify::command(steps),
        Command::Demo => demo::command(),
        Command::Film => film::command(),
        Command::Pictures => pictures::command(),
        Command::Bevy => bevy::command(),
        Command::Export { shipped } => export::command(*shipped),
        Command::Bench { page: true, .. } => bench::page(),
        Command::Bench { keep, .. } => bench::command(*keep),
        Command::BenchCrowd {
            instances,
            skeletons,
            ..
        } => bench_crowd::command(*instances, *skeletons),
        Command::Open { project, arguments } => open::command(project, arguments),
    }
}
