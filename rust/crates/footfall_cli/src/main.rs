//! The footfall command line.

mod commands;
mod corpus_pair;
mod fit_facts;
mod motion_input;
mod output;
mod sheet;
mod study;

use clap::Parser as _;
use commands::Cli;
use std::process::ExitCode;

fn main() -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) => return report_usage(&error),
    };
    match cli.run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            output::note(&format!("error: {}", one_line(&format!("{error:#}"))));
            ExitCode::FAILURE
        }
    }
}

/// Help goes out as it is; a mistake in the arguments becomes one line, with exit code 2 as shells expect.
fn report_usage(error: &clap::Error) -> ExitCode {
    if !error.use_stderr() {
        return if error.print().is_ok() {
            ExitCode::SUCCESS
        } else {
            ExitCode::FAILURE
        };
    }
    let text = error.render().to_string();
    if text.trim_start().starts_with("error:") {
        let message = text.split("\n\nUsage:").next().unwrap_or(&text);
        let message = message
            .split("\n\nFor more information")
            .next()
            .unwrap_or(message);
        output::note(&format!("{}; see `footfall --help`", one_line(message)));
    } else {
        // No command at all: the whole help serves better than a line.
        output::note(text.trim_end());
    }
    ExitCode::from(2)
}

/// The same words without line breaks.
fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}
