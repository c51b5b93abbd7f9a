//! Rules about how comments are worded: no sentence begins with a word of the list, and none has a
//! word that the field has a better one for.

use crate::sources::{NONE, Source, files, planted};
use crate::words::{badly_chosen, sentences};

/// Folders whose comments hold the rules.
const HELD: [&str; 11] =
    ["host", "io", "emulator", "lab", "cli", "python", "c", "examples", "fuzz", "tests", "plugs"];

/// The comments of a source as a page: each line keeps its number, and code is left blank.
fn comments(text: &str) -> String {
    let lines = text.lines().map(|line| {
        let Some(comment) = line.trim_start().strip_prefix("//") else { return "" };
        let comment = comment.strip_prefix(['/', '!']).unwrap_or(comment);
        comment.strip_prefix(' ').unwrap_or(comment)
    });
    lines.collect::<Vec<_>>().join("\n")
}

/// Sentences of comments that begin wrongly or have a word of the list.
fn badly_worded((name, text): &Source) -> Vec<String> {
    badly_chosen(name, &comments(text))
}

#[test]
fn comments_are_worded_plainly() {
    let sources: Vec<Source> =
        HELD.iter().flat_map(|room| files(room)).filter(|(name, _)| name.ends_with(".rs")).collect();
    let count: usize = sources.iter().map(|(_, text)| sentences(&comments(text)).len()).sum();
    assert!(sources.len() > 500 && count > 8_000, "{} sources, {count} sentences", sources.len());
    let found: Vec<String> = sources.iter().flat_map(badly_worded).collect();
    assert_eq!(found, NONE);
}

#[test]
fn badly_worded_comments_are_noticed() {
    let found = |text: &str| badly_worded(&planted("host/a.rs", text)[0]);
    for (text, expected) in [
        ("//! What it does is good.", "host/a.rs:1: begins with What"),
        ("fn a() {}\n/// It is. Of all\n/// things.", "host/a.rs:2: begins with Of"),
        ("    // It is built anew.", "host/a.rs:1: anew"),
    ] {
        assert_eq!(found(text), [expected], "{text}");
    }
    for good in [
        "let what = \"What is told.\";",
        "/// ```\n/// What is told.\n/// ```",
        "/// A list grows where it is short.\nfn told() {}",
    ] {
        assert_eq!(found(good), NONE, "{good}");
    }
}
