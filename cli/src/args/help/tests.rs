//! Every option of every command: its group, and the words and width of its help.

use super::command;
use crate::args::{ACCURACY, MACHINE, OUTPUT, QUERY, RESEARCH};
use clap::{Arg, Command};

/// Most columns of a line about an option, and of a page.
const LINE: usize = 70;
const PAGE: usize = 100;
/// Most lines of `detect -h`.
const SHORT: usize = 40;

/// Words of the paper and of experiments: not in the short help of a product command.
const OF_RESEARCH: [&str; 19] = [
    "paper",
    "thesis",
    "figure",
    "lab",
    "research",
    "obb",
    "aabb",
    "morton",
    "hilbert",
    "treelet",
    "refit",
    "traversal",
    "walk",
    "queue",
    "front",
    "steal",
    "broad",
    "volume",
    "gtx",
];
/// Words that no page has.
const NOWHERE: [&str; 9] =
    ["seed's", "the seed ", "anew", "ask", "asked", "asks", "told", "unresolved", "degraded"];
/// Beginnings that are no verb.
const NO_VERB: [&str; 16] = [
    "A", "An", "The", "What", "Which", "Where", "Who", "How", "When", "Of", "Only", "With", "Without",
    "Whether", "All", "In",
];

/// Each command by its path, `detect` or `lab bench`.
fn every() -> Vec<(String, Command)> {
    fn below(path: &str, command: &Command, all: &mut Vec<(String, Command)>) {
        for own in command.get_subcommands() {
            let path = format!("{path} {}", own.get_name()).trim().to_owned();
            below(&path, own, all);
            all.push((path, own.clone()));
        }
    }
    let mut all = Vec::new();
    below("", &command(), &mut all);
    all
}

fn page(command: &Command, long: bool) -> String {
    let mut command = command.clone();
    if long { command.render_long_help().to_string() } else { command.render_help().to_string() }
}

/// Words of a text, with the marks of English removed.
fn words(text: &str) -> Vec<String> {
    let split = text.split(|c: char| !(c.is_alphanumeric() || c == '\''));
    split.filter(|word| !word.is_empty()).map(str::to_lowercase).collect()
}

/// The first fault of an option.
fn fault(arg: &Arg) -> Option<String> {
    let name = arg.get_id().as_str();
    let help = arg.get_help().map(ToString::to_string).unwrap_or_default();
    let groups = [QUERY, ACCURACY, OUTPUT, MACHINE, RESEARCH];
    let first = help.split(' ').next().unwrap_or_default();
    if !arg.is_positional() && !arg.get_help_heading().is_some_and(|group| groups.contains(&group)) {
        Some(format!("{name} is in no group"))
    } else if help.chars().count() > LINE {
        Some(format!("{name} has {} columns: {help}", help.chars().count()))
    } else if !first.starts_with(char::is_uppercase) || NO_VERB.contains(&first) {
        Some(format!("{name} does not begin with a verb: {help}"))
    } else {
        help.ends_with('.').then(|| format!("{name} ends with a full stop: {help}"))
    }
}

/// The first fault of a page.
fn page_fault(page: &str, banned: &[&str]) -> Option<String> {
    let wide = page.lines().find(|line| line.chars().count() > PAGE);
    let words = words(page);
    let word = |banned: &&&str| match banned.split_once(' ') {
        None => words.iter().any(|word| word == **banned),
        Some(_) => page.to_lowercase().contains(**banned),
    };
    wide.map(|line| format!("too wide: {line}"))
        .or_else(|| banned.iter().find(word).map(|banned| format!("has the word {banned}")))
}

/// The first fault of `detect -h`.
fn short_fault(page: &str) -> Option<String> {
    let lines = page.lines().count();
    let plural = |word: &&str| [(*word).to_owned(), format!("{word}s")];
    let banned: Vec<String> = OF_RESEARCH.iter().flat_map(plural).collect();
    let banned: Vec<&str> = banned.iter().map(String::as_str).collect();
    page_fault(page, &banned).or_else(|| (lines > SHORT).then(|| format!("{lines} lines")))
}

#[test]
fn every_option_has_a_group_and_a_line_with_a_verb() {
    for (path, command) in every() {
        let faults: Vec<String> = command.get_arguments().filter_map(fault).collect();
        assert_eq!(faults, [""; 0], "{path}");
    }
    // Each fault is named.
    let option = || Arg::new("planted").long("planted").help_heading(QUERY).help("Set a fault");
    assert_eq!(fault(&option()), None);
    for (planted, named) in [
        (Arg::new("planted").long("planted").help("Set a fault"), "is in no group"),
        (option().help_heading("Options"), "is in no group"),
        (option().help("Set ".to_owned() + &"a fault ".repeat(9)), "columns"),
        (option().help("The fault of an option"), "verb"),
        (option().help("set a fault"), "verb"),
        (option().help("Set a fault."), "full stop"),
    ] {
        assert!(fault(&planted).is_some_and(|fault| fault.contains(named)), "{named}");
    }
}

#[test]
fn the_help_of_detect_is_short_and_of_the_product() {
    let all = every();
    for name in ["detect", "picture", "view", "explain", "selftest", "completions", "man"] {
        let (_, command) = all.iter().find(|(path, _)| path == name).expect("a command of the product");
        assert_eq!(short_fault(&page(command, false)), None, "{name}");
    }
    // Options of research are in the long help, under their heading.
    let detect = &all.iter().find(|(path, _)| path == "detect").expect("a command").1;
    let long = page(detect, true);
    let research = long.split_once("\nResearch:\n").expect("a heading").1;
    let hidden = detect.get_arguments().filter(|arg| arg.get_help_heading() == Some(RESEARCH));
    for arg in hidden {
        let name = format!("--{} ", arg.get_long().expect("a name"));
        assert!(research.contains(&name), "{name}");
    }
    // Each fault is named.
    let short = page(detect, false);
    for (planted, named) in [
        (format!("{short}  --refit  Choose a way\n"), "refit"),
        (format!("{short}  --way  Choose one of the paper's queues\n"), "queues"),
        (format!("{short}{}\n", "x".repeat(PAGE + 1)), "wide"),
        (short.clone() + &"a line\n".repeat(SHORT), "lines"),
    ] {
        assert!(short_fault(&planted).is_some_and(|fault| fault.contains(named)), "{named}");
    }
}

#[test]
fn every_page_fits_and_has_plain_words() {
    for (path, command) in every() {
        for long in [false, true] {
            assert_eq!(page_fault(&page(&command, long), &NOWHERE), None, "{path}");
        }
    }
    assert!(page_fault("The seed of it\n", &NOWHERE).is_some_and(|fault| fault.contains("seed")));
    assert!(page_fault("Pairs that are asked\n", &NOWHERE).is_some_and(|fault| fault.contains("asked")));
    assert_eq!(page_fault("The seeds\n", &NOWHERE), None);
}

#[test]
fn long_lines_are_wrapped() {
    let text = super::wrapped(&"word ".repeat(40), 30).to_string();
    assert!(text.lines().all(|line| line.len() <= 30) && text.lines().count() > 5, "{text}");
    assert_eq!(super::wrapped("one\n\ntwo", 9).to_string(), "one\n\ntwo");
    let linked = "By [`a::b`](crate::a::b) alone, or [`c`](d).";
    assert_eq!(super::value(linked).to_string(), "By a::b alone, or c.");
}
