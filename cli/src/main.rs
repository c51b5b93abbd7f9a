//! The program: `detect`, `check`, `explain`, `picture`, `view`, `selftest`, `completions`, `man`; and
//! `lab` for measurements.

mod args;
mod check;
mod detect;
mod explain;
mod lab;
mod memory;
mod meshes;
mod output;
mod paint;
mod picture;
mod progress;
mod report;
mod rows;
mod selftest;
mod sequence;
mod shell;
mod stop;
mod view;
mod vtp;

use args::Command;
use nearmiss::error::Error;
use output::say;
use std::path::Path;
use std::process::ExitCode;

/// Exit codes: 0 done (contacts or not), 1 a fault that `check` or `--fail-on` looks for, 2 bad arguments, 3 bad input, 4 device, memory or output, or
/// a check that fails. SIGINT and SIGTERM give 130 and 143.
fn main() -> ExitCode {
    stop::listen();
    let done = match args::parse() {
        Ok(Ok(command)) => run(command),
        Ok(Err(code)) => Ok(code),
        Err(error) => Err(error),
    };
    match done {
        Ok(code) => code,
        Err(error) => {
            say(&error.to_string());
            ExitCode::from(error.exit_code())
        }
    }
}

fn run(command: Command) -> Result<ExitCode, Error> {
    match command {
        Command::Detect(args) => detect::detect(&args),
        Command::Check(args) => check::check(&args),
        Command::Explain(args) => explain::explain(&args),
        Command::Picture(args) => picture::picture(&args),
        Command::View(args) => view::view(&args),
        Command::Selftest(args) => selftest::selftest(&args),
        Command::Completions(args) => shell::completions(&args),
        Command::Man(args) => shell::man(&args),
        Command::Lab(args) => lab::lab(&args),
    }
}

/// A mesh's name: its file's, without folder and extension, and without `.gz`.
fn stem(file: &Path) -> String {
    output::unpacked(file).file_stem().map_or("mesh".into(), |stem| stem.to_string_lossy().into_owned())
}
