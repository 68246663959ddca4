//! `footfall completions`: what a shell needs to complete our commands.

use super::Cli;
use crate::output;
use anyhow::{Context as _, Result};
use clap::CommandFactory as _;
use clap_complete::Shell;

/// Print the completions of a shell
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  \
    footfall completions bash > ~/.local/share/bash-completion/completions/footfall\n  \
    footfall completions zsh > ~/.zfunc/_footfall\n  \
    footfall completions fish > ~/.config/fish/completions/footfall.fish")]
pub(crate) struct CompletionsArgs {
    /// The shell
    #[arg(value_enum)]
    shell: Shell,
}

pub(crate) fn run(args: &CompletionsArgs) -> Result<()> {
    let mut text = Vec::new();
    clap_complete::generate(args.shell, &mut Cli::command(), "footfall", &mut text);
    let text = String::from_utf8(text).context("the completions")?;
    output::print_text(text.trim_end())
}
