//! The program: three lines into the command line.

use std::process::ExitCode;

fn main() -> ExitCode {
    nearmiss::cli::main()
}
