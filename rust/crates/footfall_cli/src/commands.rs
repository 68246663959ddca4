//! The commands, one module each, and what they share.

mod adapt;
mod bench;
mod completions;
mod contacts;
mod design;
mod doctor;
mod dynamics;
mod evaluate;
mod imu;
mod inspect;
mod manual;
mod retarget;
mod sheet;
mod studio;
mod study;
mod synth;
mod train;
mod training_run;
mod walk_output;

use anyhow::Result;
use clap::{Parser, Subcommand};

/// Train gait models on motion capture, and generate walks with them.
#[derive(Debug, Parser)]
#[command(
    name = "footfall",
    version,
    after_help = "Examples:\n  \
        footfall train --corpus index.csv --where category=neutral_walk -o walk.footfall\n  \
        footfall synth --model walk.footfall --steps 20 --seed 1 -o out.bvh\n  \
        footfall sheet out.bvh -o sheet.png\n\n\
        Every command has --help with examples, and --json for one JSON object on stdout."
)]
pub(crate) struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Inspect(inspect::InspectArgs),
    Retarget(retarget::RetargetArgs),
    Contacts(contacts::ContactsArgs),
    Train(train::TrainArgs),
    Adapt(adapt::AdaptArgs),
    Synth(synth::SynthArgs),
    Design(Box<design::DesignArgs>),
    Dynamics(dynamics::DynamicsArgs),
    Imu(imu::ImuArgs),
    Sheet(sheet::SheetArgs),
    Evaluate(evaluate::EvaluateArgs),
    Study(study::StudyArgs),
    Studio(studio::StudioArgs),
    Bench(bench::BenchArgs),
    Doctor(doctor::DoctorArgs),
    Completions(completions::CompletionsArgs),
    Manual(manual::ManualArgs),
}

impl Cli {
    /// Runs the command that was asked for.
    pub(crate) fn run(&self) -> Result<()> {
        match &self.command {
            Command::Inspect(args) => inspect::run(args),
            Command::Retarget(args) => retarget::run(args),
            Command::Contacts(args) => contacts::run(args),
            Command::Train(args) => train::run(args),
            Command::Adapt(args) => adapt::run(args),
            Command::Synth(args) => synth::run(args),
            Command::Design(args) => design::run(args),
            Command::Dynamics(args) => dynamics::run(args),
            Command::Imu(args) => imu::run(args),
            Command::Sheet(args) => sheet::run(args),
            Command::Evaluate(args) => evaluate::run(args),
            Command::Study(args) => study::run(args),
            Command::Studio(args) => studio::run(args),
            Command::Bench(args) => bench::run(args),
            Command::Doctor(args) => doctor::run(args),
            Command::Completions(args) => completions::run(args),
            Command::Manual(args) => manual::run(args),
        }
    }
}
