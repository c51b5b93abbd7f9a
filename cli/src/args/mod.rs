//! What the command line takes: a file a command.

mod bench;
mod detect;
mod files;
mod idle;
mod machine;
mod number;
pub mod picture;
mod query;
mod scene;
mod selftest;
mod tables;
mod trade;

pub use bench::BenchArgs;
pub use detect::{DetectArgs, PlanArgs};
pub use machine::{MachineArgs, ReportArgs};
pub use number::whole;
pub use picture::PictureArgs;
pub use scene::SceneArgs;
pub use selftest::SelftestArgs;
pub use tables::{Profile, Table, TablesArgs};
pub use trade::TradeArgs;

use crate::explain::ExplainArgs;
use crate::output::stdout_failed;
use crate::shell::{CompletionsArgs, ManArgs};
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::{ArgMatches, CommandFactory, FromArgMatches, Parser, Subcommand};
use nearmiss::error::Error;
use nearmiss::query::Named;
use std::io::Write;
use std::process::ExitCode;

/// Collision detection for deformable triangle meshes.
#[derive(Parser)]
#[command(name = "nearmiss", version, arg_required_else_help = true)]
pub struct Cli {
    #[command(subcommand)]
    pub command: Command,
}

#[derive(Subcommand)]
pub enum Command {
    /// Find what touches: in one mesh, (--with) between two, or in a scene of many; in one frame, or step after step.
    Detect(Box<DetectArgs>),
    /// Ask a frame and draw it: what meets is red.
    Picture(Box<PictureArgs>),
    /// Ask a frame and say what detect runs, holds and moves for each with the same arguments, what there is not, and why.
    Plan(Box<PlanArgs>),
    /// Say what every solver answers about one pair, and what the exact answer is.
    Explain(Box<ExplainArgs>),
    /// Write a benchmark scene as PLY frames.
    Scene(SceneArgs),
    /// The thesis's figures 6.12 to 6.14, ours beside theirs: a table, CSV files and pictures.
    Tables(TablesArgs),
    /// What each faster choice costs in misses, lateness and false alarms, measured here: a table, CSV files and pictures.
    Trade(TradeArgs),
    /// How long frames take, stage by stage, of a fixed list of cases; and beside an earlier run.
    Bench(BenchArgs),
    /// Check this machine: known answers, and the GPU and the CPU to the bit.
    Selftest(SelftestArgs),
    /// Print what a shell completes commands and options by.
    Completions(CompletionsArgs),
    /// Print a page of the manual, as troff: of the program, or of a command.
    Man(ManArgs),
}

/// Takes the name of one of the library's choices, and tells all of them in the help.
fn choice<T: Named>() -> impl TypedValueParser<Value = T> {
    let all = T::ALL.iter().map(|choice| PossibleValue::new(choice.name()).help(choice.about()));
    PossibleValuesParser::new(all).try_map(|name| T::of(&name).ok_or("no such choice"))
}

/// The command, or the exit status where clap has said all that there is to say.
///
/// # Errors
/// [`Error::InvalidArgument`] for options that do not go together, or that would do nothing; [`Error::Output`] for help that cannot be
/// printed.
pub fn parse() -> Result<Result<Command, ExitCode>, Error> {
    let parsed = Cli::command().try_get_matches().and_then(|all| {
        let cli = Cli::from_arg_matches(&all)?;
        Ok((cli.command, all))
    });
    match parsed {
        Ok((mut command, all)) => {
            if let Some((_, own)) = all.subcommand() {
                sort_out(&mut command, own)?;
                idle::check(&command, own)?;
            }
            Ok(Ok(command))
        }
        Err(said) => {
            let printed = said.print().and_then(|()| std::io::stdout().flush());
            match printed {
                Err(e) if !said.use_stderr() => Err(stdout_failed(&e)),
                // The status says the rest: 2, or 0 after help.
                _ => Ok(Err(ExitCode::from(if said.use_stderr() { 2 } else { 0 }))),
            }
        }
    }
}

/// Gives both meshes of a question their files.
fn several(own: &ArgMatches, args: &mut DetectArgs) -> Result<(), Error> {
    files::part(own, &mut args.meshes, &mut args.with);
    files::as_many(&args.meshes, &args.with)
}

/// Gives each mesh its files.
fn sort_out(command: &mut Command, own: &ArgMatches) -> Result<(), Error> {
    match command {
        Command::Detect(args) => several(own, args),
        Command::Plan(args) => {
            several(own, &mut args.detect)?;
            files::at_most_two(&args.detect.meshes, &args.detect.with)
        }
        Command::Picture(args) => several(own, &mut args.detect),
        Command::Explain(args) => {
            files::part(own, &mut args.meshes, &mut args.with);
            files::at_most_two(&args.meshes, &args.with)
        }
        Command::Bench(args) => {
            args.part(own);
            Ok(())
        }
        _ => Ok(()),
    }
}
