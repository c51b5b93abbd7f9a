//! `completions` and `man`: what a shell and a manual know of the program.

use crate::args::Cli;
use crate::output::{print, stdout_failed};
use clap::CommandFactory;
use clap_complete::Shell;
use nearmiss::error::Error;
use std::process::ExitCode;

/// What `completions` takes.
#[derive(clap::Args)]
pub struct CompletionsArgs {
    /// Which shell.
    pub shell: Shell,
}

/// What `man` takes.
#[derive(clap::Args)]
pub struct ManArgs {
    /// The page of a command [default: of the program].
    #[arg(value_name = "COMMAND")]
    pub of: Option<String>,
}

/// Prints a shell's completions.
pub fn completions(args: &CompletionsArgs) -> Result<ExitCode, Error> {
    let mut text = Vec::new();
    clap_complete::generate(args.shell, &mut Cli::command(), "nearmiss", &mut text);
    put(text)
}

/// Prints a page of the manual.
pub fn man(args: &ManArgs) -> Result<ExitCode, Error> {
    let mut all = Cli::command();
    all.build();
    let page = match &args.of {
        None => all,
        Some(name) => {
            let known: Vec<_> = all.get_subcommands().map(|own| own.get_name().to_owned()).collect();
            let found = all.find_subcommand(name).cloned();
            found.ok_or_else(|| Error::InvalidArgument {
                what: format!("there is no command {name:?}"),
                advice: format!("choose one of: {}", known.join(", ")),
            })?
        }
    };
    let mut text = Vec::new();
    clap_mangen::Man::new(page).render(&mut text).map_err(|e| stdout_failed(&e))?;
    put(text)
}

fn put(text: Vec<u8>) -> Result<ExitCode, Error> {
    print(&String::from_utf8_lossy(&text))?;
    Ok(ExitCode::SUCCESS)
}
