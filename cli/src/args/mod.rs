//! The arguments of all commands: a file for each command or group of options.

mod accuracy;
mod bench;
mod check;
mod detect;
mod explain;
mod files;
mod help;
mod idle;
mod lab;
mod machine;
mod number;
mod out;
pub mod picture;
mod plan;
mod query;
mod report;
mod research;
mod scene;
mod selftest;
mod shell;
mod tables;
mod to_query;
mod trade;
mod turns;
pub mod view;

pub use bench::{BenchArgs, Question};
pub use check::CheckArgs;
pub use detect::DetectArgs;
pub use explain::{Between, ExplainArgs};
pub use help::command;
pub use lab::{Lab, LabArgs};
pub use machine::MachineArgs;
pub use out::MEETS;
pub use picture::PictureArgs;
pub use plan::PlanArgs;
pub use report::ReportArgs;
pub use scene::SceneArgs;
pub use selftest::SelftestArgs;
pub use shell::{CompletionsArgs, ManArgs};
pub use tables::{Profile, Table, TablesArgs};
pub use trade::TradeArgs;
pub use turns::TurnsArgs;
pub use view::ViewArgs;

use crate::output::stdout_failed;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::{ArgMatches, FromArgMatches, Parser, Subcommand};
use nearmiss::error::Error;
use nearmiss::query::Named;
#[cfg(not(windows))]
use std::env::args_os;
use std::io::Write;
use std::process::ExitCode;
// Shells of Windows leave patterns of files to the program.
#[cfg(windows)]
use wild::args_os;

/// The heading of options that choose the query and its meshes.
pub const QUERY: &str = "Query";
/// The heading of options that set how exact an answer is.
pub const ACCURACY: &str = "Accuracy";
/// The heading of options that choose the output.
pub const OUTPUT: &str = "Output";
/// The heading of options that choose the machine.
pub const MACHINE: &str = "Machine";
/// The heading of options for experiments. `-h` hides those of `detect`.
pub const RESEARCH: &str = "Research";

/// Detect collisions of deforming triangle meshes.
#[derive(Parser)]
#[command(name = "nearmiss", version, arg_required_else_help = true)]
pub struct Cli {
    #[command(subcommand)]
    pub command: Command,
}

#[derive(Subcommand)]
pub enum Command {
    /// Find contacts in a mesh, between meshes, or in a scene.
    Detect(Box<DetectArgs>),
    /// Check that meshes are free: no crossings, overlaps or bad faces.
    Check(CheckArgs),
    /// Show what each solver returns for one pair, and the exact answer.
    Explain(Box<ExplainArgs>),
    /// Draw a frame as PNG; triangles in contact are red.
    Picture(Box<PictureArgs>),
    /// Write a page to look at: all frames, and the features of rows.
    View(Box<ViewArgs>),
    /// Check this machine: known answers, and GPU against CPU.
    Selftest(SelftestArgs),
    /// Print the completions of a shell.
    Completions(CompletionsArgs),
    /// Print a page of the manual.
    Man(ManArgs),
    /// Measure and experiment: trade, tables, bench, plan, scene.
    Lab(Box<LabArgs>),
}

/// Parses the name of one of the library's choices; `--help` lists all of them.
fn choice<T: Named>() -> impl TypedValueParser<Value = T> {
    let all = T::ALL.iter().map(|choice| PossibleValue::new(choice.name()).help(help::value(choice.about())));
    PossibleValuesParser::new(all).try_map(|name| T::of(&name).ok_or("no such choice"))
}

/// The command, or the exit status if clap has printed all that there is to print.
///
/// # Errors
/// [`Error::InvalidArgument`] for options that exclude each other or have no effect; [`Error::Output`] for
/// help that cannot be printed.
pub fn parse() -> Result<Result<Command, ExitCode>, Error> {
    let parsed = command().try_get_matches_from(args_os()).and_then(|all| {
        let cli = Cli::from_arg_matches(&all)?;
        Ok((cli.command, all))
    });
    match parsed {
        Ok((mut command, all)) => {
            if let Some(own) = innermost(&all) {
                sort_out(&mut command, own)?;
                idle::check(&command, own)?;
            }
            Ok(Ok(command))
        }
        Err(text) => {
            let printed = text.print().and_then(|()| std::io::stdout().flush());
            match printed {
                Err(e) if !text.use_stderr() => Err(stdout_failed(&e)),
                // The status returns the rest: 2, or 0 after help.
                _ => Ok(Err(ExitCode::from(if text.use_stderr() { 2 } else { 0 }))),
            }
        }
    }
}

/// The matches of the command itself: those of `bench` for `lab bench`.
fn innermost(all: &ArgMatches) -> Option<&ArgMatches> {
    std::iter::successors(all.subcommand(), |(_, own)| own.subcommand()).last().map(|(_, own)| own)
}

/// Gives both meshes of a query their files.
fn several(own: &ArgMatches, args: &mut DetectArgs) -> Result<(), Error> {
    files::part(own, &mut args.meshes, &mut args.query.with);
    files::as_many(&args.meshes, &args.query.with)
}

/// Gives each mesh its files.
fn sort_out(command: &mut Command, own: &ArgMatches) -> Result<(), Error> {
    match command {
        Command::Detect(args) => several(own, args),
        Command::Picture(args) => several(own, &mut args.detect),
        Command::View(args) => several(own, &mut args.detect),
        Command::Explain(args) => {
            files::part(own, &mut args.meshes, &mut args.with);
            files::at_most_two(&args.meshes, &args.with)
        }
        Command::Lab(lab) => match &mut lab.command {
            Lab::Plan(args) => {
                several(own, &mut args.detect)?;
                files::at_most_two(&args.detect.meshes, &args.detect.query.with)
            }
            Lab::Bench(args) => {
                args.part(own);
                Ok(())
            }
            _ => Ok(()),
        },
        _ => Ok(()),
    }
}
