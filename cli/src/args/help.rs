//! The help of the program: lines that fit, and options in groups.

use super::{Cli, OUTPUT};
use clap::builder::{PossibleValue, StyledStr};
use clap::{Arg, ArgAction, Command, CommandFactory};

/// Columns of the text below an option, which is indented by ten.
const WIDTH: usize = 88;
/// Columns of the description of a value, which is indented by its name too.
const VALUE_WIDTH: usize = 68;

/// The program as clap knows it: long texts are wrapped, and `--help` is in a group as all others.
pub fn command() -> Command {
    shaped(Cli::command())
}

fn shaped(command: Command) -> Command {
    let command = command.mut_args(|arg| {
        let arg = values_below(arg);
        let long = arg.get_long_help().map(|text| wrapped(&text.to_string(), WIDTH));
        match long {
            Some(long) => arg.long_help(long),
            None => arg,
        }
    });
    let names: Vec<String> = command.get_subcommands().map(|own| own.get_name().to_owned()).collect();
    if names.is_empty() {
        return command.disable_help_flag(true).arg(help_option());
    }
    names.iter().fold(command, |command, name| command.mut_subcommand(name, shaped))
}

/// Columns before the help of an option, and those of the words around its values.
const BEFORE: usize = 30;
const AROUND: usize = 34;

/// Moves the values of an option to its long help, if its line has no room for them.
fn values_below(arg: Arg) -> Arg {
    let values = arg.get_possible_values();
    let help = arg.get_help().map(ToString::to_string).unwrap_or_default();
    let defaults = arg.get_default_values().iter().map(|value| value.len() + 1).sum::<usize>();
    let names = values.iter().map(|value| value.get_name().len() + 2).sum::<usize>();
    // A flag has the values true and false, which are never shown.
    if values.is_empty()
        || !arg.get_action().takes_values()
        || arg.is_hide_possible_values_set()
        || BEFORE + help.len() + defaults + AROUND + names <= 100
    {
        return arg;
    }
    let long = arg.get_long_help().map_or(help, ToString::to_string);
    let about = |value: &PossibleValue| match value.get_help() {
        Some(help) => format!("- {}: {}", value.get_name(), help.to_string().replace('\n', " ")),
        None => format!("- {}", value.get_name()),
    };
    let list: Vec<String> = values.iter().map(about).collect();
    arg.hide_possible_values(true).long_help(format!("{long}\n\n{}", list.join("\n")))
}

fn help_option() -> Arg {
    Arg::new("help")
        .short('h')
        .long("help")
        .action(ArgAction::Help)
        .help("Print this help; --help explains every option")
        .help_heading(OUTPUT)
}

/// Text in lines of at most so many columns. Lines that are there stay lines.
fn wrapped(text: &str, width: usize) -> StyledStr {
    let lines: Vec<String> = text.lines().flat_map(|line| broken(line, width)).collect();
    lines.join("\n").into()
}

fn broken(line: &str, width: usize) -> Vec<String> {
    let mut all = vec![String::new()];
    for word in line.split(' ') {
        let last = all.last_mut().expect("one line at least");
        if last.is_empty() {
            last.push_str(word);
        } else if last.chars().count() + 1 + word.chars().count() <= width {
            last.push(' ');
            last.push_str(word);
        } else {
            all.push(word.to_owned());
        }
    }
    all
}

/// The description of a value: the library's documentation, without its links.
pub fn value(about: &str) -> StyledStr {
    let parts = about.split("](").enumerate();
    let linkless =
        parts.map(|(at, part)| if at == 0 { part } else { part.split_once(')').map_or(part, |x| x.1) });
    let text: String = linkless.collect();
    wrapped(&text.replace(['[', '`'], ""), VALUE_WIDTH)
}

/// The help of an option whose values are these.
pub fn listed(about: &str, names: &[&str]) -> String {
    format!("{about}\n\nOne of: {}.", names.join(", "))
}

#[cfg(test)]
mod tests;
