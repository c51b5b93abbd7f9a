//! The program: `detect`, `picture`, `plan`, `explain`, `scene`, `tables`, `trade`, `bench`, `selftest`, `completions`, `man`.

mod args;
mod bench;
mod detect;
mod explain;
mod memory;
mod meshes;
mod output;
mod paint;
mod picture;
mod plan;
mod progress;
mod report;
mod rows;
mod scene;
mod selftest;
mod sequence;
mod shell;
mod stop;
mod tables;
mod trade;
mod vtp;

use args::{Command, ReportArgs};
use nearmiss::error::Error;
use output::{Target, print, say};
use std::path::Path;
use std::process::ExitCode;

/// 0 done (contacts or not), 2 bad arguments, 3 bad input, 4 device, memory or output, and a check
/// that fails; 130 and 143 for SIGINT and SIGTERM.
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
        Command::Picture(args) => picture::picture(&args),
        Command::Plan(args) => plan::plan(&args),
        Command::Explain(args) => explain::explain(&args),
        Command::Scene(args) => scene::scene(&args),
        Command::Tables(args) => tables::tables(&args),
        Command::Trade(args) => trade::trade(&args),
        Command::Bench(args) => bench::bench(&args),
        Command::Selftest(args) => selftest::selftest(&args),
        Command::Completions(args) => shell::completions(&args),
        Command::Man(args) => shell::man(&args),
    }
}

/// A mesh's name: its file's, without folder and extension, and without `.gz`.
fn stem(file: &Path) -> String {
    output::unpacked(file).file_stem().map_or("mesh".into(), |stem| stem.to_string_lossy().into_owned())
}

/// Writes measured figures where `--out` says, and prints them as text or JSON.
fn report<T: serde::Serialize>(
    args: &ReportArgs,
    figures: &T,
    text: impl FnOnce(&T) -> String,
    files: impl FnOnce(&T) -> Result<Vec<(String, Vec<u8>)>, Error>,
) -> Result<ExitCode, Error> {
    if let Some(out) = &args.out {
        let mut names = Vec::new();
        for (name, bytes) in files(figures)? {
            Target::open(&out.join(&name))?.write(|out| out.write_all(&bytes).map_err(|e| e.to_string()))?;
            names.push(name);
        }
        say(&format!("{} in {}", names.join(", "), out.display()));
    }
    if args.json {
        let json = serde_json::to_string(figures).map_err(|e| Error::Bug { what: e.to_string() })?;
        print(&(json + "\n"))?;
    } else {
        print(&text(figures))?;
    }
    Ok(ExitCode::SUCCESS)
}
