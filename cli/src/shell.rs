//! `completions` and `man`.

use crate::args::{CompletionsArgs, ManArgs, command};
use crate::output::{print, stdout_failed};
use nearmiss::error::Error;
use std::process::ExitCode;

/// Prints a shell's completions.
pub fn completions(args: &CompletionsArgs) -> Result<ExitCode, Error> {
    let mut text = Vec::new();
    clap_complete::generate(args.shell, &mut command(), "nearmiss", &mut text);
    put(text)
}

/// Prints a page of the manual: of the program, or of a command.
pub fn man(args: &ManArgs) -> Result<ExitCode, Error> {
    let mut page = command();
    page.build();
    for name in &args.of {
        let known: Vec<_> = page.get_subcommands().map(|own| own.get_name().to_owned()).collect();
        page = page.find_subcommand(name).cloned().ok_or_else(|| Error::InvalidArgument {
            what: format!("COMMAND is unknown, got {name}"),
            advice: match known.as_slice() {
                [] => "remove it".into(),
                known => format!("use one of: {}", known.join(", ")),
            },
        })?;
    }
    let mut text = Vec::new();
    clap_mangen::Man::new(page).render(&mut text).map_err(|e| stdout_failed(&e))?;
    put(text)
}

fn put(text: Vec<u8>) -> Result<ExitCode, Error> {
    print(&String::from_utf8_lossy(&text))?;
    Ok(ExitCode::SUCCESS)
}
