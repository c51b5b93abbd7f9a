//! The command line: `detect`, `plan`, `scene`, `tables`, `trade`, `selftest`.

mod args;
mod detect;
mod progress;
mod scene;
mod selftest;
mod tables;
mod trade;

use crate::error::Error;
use args::{Cli, Command};
use clap::Parser;
use std::process::ExitCode;

/// Runs the program: 0 done (contacts or not), 2 bad arguments, 3 bad input, 4 device, memory or output.
pub fn main() -> ExitCode {
    match run(Cli::parse().command) {
        Ok(code) => code,
        Err(error) => {
            eprintln!("nearmiss: {error}");
            ExitCode::from(error.exit_code())
        }
    }
}

fn run(command: Command) -> Result<ExitCode, Error> {
    match command {
        Command::Detect(args) => detect::detect(&args),
        Command::Plan(args) => detect::plan(&args),
        Command::Scene(args) => scene::scene(&args),
        Command::Tables(args) => tables::tables(&args),
        Command::Trade(args) => trade::trade(&args),
        Command::Selftest(args) => selftest::selftest(&args),
    }
}

/// Prints to standard output; a reader who has had enough is not an error.
fn print(text: &str) {
    use std::io::Write;
    let mut out = std::io::stdout().lock();
    let _ = out.write_all(text.as_bytes()).and_then(|()| out.flush());
}
