//! Rules about how pages are worded: short sentences that begin with the thing, the field's verbs,
//! lines of 100 characters, short table cells, sizes of pages, and no measured figure outside a
//! table in README.

use crate::sources::{NONE, Source, exists, files, planted, says};

/// Pages that hold the rules, or folders of them; the number is the longest median of words.
const HELD: [(&str, usize); 17] = [
    ("README.md", 14),
    ("CONTRIBUTING.md", 14),
    ("docs/README.md", 14),
    ("docs/install.md", 14),
    ("docs/cli.md", 14),
    ("docs/concepts.md", 14),
    ("docs/guarantees.md", 14),
    ("docs/tuning.md", 14),
    ("docs/performance.md", 14),
    ("docs/limits.md", 14),
    ("docs/reference.md", 14),
    ("docs/for", 14),
    ("python/README.md", 14),
    ("plugs/interop/README.md", 14),
    ("plugs/mpi/README.md", 14),
    ("plugs/wasm/README.md", 14),
    ("docs/internals", 16),
];

/// Pages of contributors may be long, and their tables and links wide.
const INTERNALS: &str = "docs/internals/";

/// Pages whose words and openings hold the rules, but whose sentences may be long.
const DECISIONS: &str = "docs/internals/decisions/";

/// Words that the field has better ones for.
const BANNED: [&str; 24] = [
    "the seed", "anew", "hang on", "hangs on", "mend", "mends", "mended", "beside", "ask", "asks", "asked",
    "asking", "tell", "tells", "told", "worn", "lent", "lend", "lends", "guess", "guesses", "whoever",
    "whatever", "nobody",
];

/// Words that no sentence begins with.
const OPENINGS: [&str; 5] = ["What", "Of", "Who", "Whose", "Where"];

const LONGEST_SENTENCE: usize = 25;
const WIDTH: usize = 100;
const CELL: usize = 60;
const PAGE_BYTES: usize = 8192;
const README_LINES: usize = 160;

/// Units of measured figures.
const UNITS: [&str; 9] = ["ms", "µs", "us", "ns", "s", "MB", "GB", "kB", "%"];

fn held() -> Vec<(Source, usize)> {
    let there = HELD.iter().filter(|(page, _)| exists(page));
    let all = there.flat_map(|(page, median)| files(page).into_iter().map(|source| (source, *median)));
    all.filter(|((name, _), _)| name.ends_with(".md") && !name.starts_with(DECISIONS)).collect()
}

/// A line of a page.
enum Line<'a> {
    Prose(&'a str),
    Cells(&'a str),
    /// A heading, a mark or a line of code.
    Other,
}

/// Lines with their numbers. Tables that are made from recorded files are left out.
fn lines(text: &str) -> Vec<(usize, Line<'_>)> {
    let (mut is_code, mut is_made) = (false, false);
    let mut found = Vec::new();
    for (at, line) in text.lines().enumerate() {
        let trimmed = line.trim();
        is_made |= trimmed.starts_with("<!-- figures:");
        let is_fence = trimmed.starts_with("```");
        is_code ^= is_fence;
        if !is_made {
            let other = is_code || is_fence || ["#", "<!--", "!["].iter().any(|m| trimmed.starts_with(m));
            found.push((
                at + 1,
                match trimmed {
                    _ if other => Line::Other,
                    _ if trimmed.starts_with('|') => Line::Cells(line),
                    _ => Line::Prose(line),
                },
            ));
        }
        is_made &= trimmed != "<!-- end -->";
    }
    found
}

/// Text without code, and links by what they show.
fn shown(text: &str) -> String {
    let text = text.split('`').enumerate().map(|(at, part)| if at % 2 == 1 { "code" } else { part });
    let mut text: String = text.collect();
    while let Some(at) = text.find("](") {
        let end = text[at..].find(')').map_or(text.len(), |end| at + end + 1);
        text.replace_range(at..end, "");
    }
    text.replace(['[', ']', '*'], "")
}

/// Sentences with the line at which their paragraph begins.
pub fn sentences(text: &str) -> Vec<(usize, String)> {
    let mut paragraphs: Vec<(usize, String)> = Vec::new();
    let mut is_open = false;
    for (at, line) in lines(text) {
        let Line::Prose(line) = line else {
            is_open = false;
            continue;
        };
        let line = line.trim();
        let item = line.strip_prefix("- ").or_else(|| {
            let (number, rest) = line.split_once(". ")?;
            number.chars().all(|c| c.is_ascii_digit()).then_some(rest)
        });
        match paragraphs.last_mut() {
            Some((_, paragraph)) if is_open && item.is_none() && !line.is_empty() => {
                paragraph.push(' ');
                paragraph.push_str(line);
            }
            _ if line.is_empty() => {}
            _ => paragraphs.push((at, item.unwrap_or(line).to_owned())),
        }
        is_open = !line.is_empty();
    }
    let mut found = Vec::new();
    for (at, paragraph) in paragraphs {
        let text = shown(&paragraph);
        let mut begin = 0;
        for (end, mark) in text.match_indices(['.', '!', '?']) {
            let next = &text[end + mark.len()..];
            if next.is_empty() || next.starts_with(' ') {
                found.push((at, text[begin..=end].trim().to_owned()));
                begin = end + 1;
            }
        }
        let rest = text[begin..].trim();
        found.extend((!rest.is_empty()).then(|| (at, rest.to_owned())));
    }
    found
}

fn words(sentence: &str) -> usize {
    sentence.split_whitespace().filter(|word| word.chars().any(char::is_alphanumeric)).count()
}

/// Sentences that begin wrongly or have a word of the list.
pub fn badly_chosen(name: &str, text: &str) -> Vec<String> {
    let mut found = Vec::new();
    for (at, sentence) in sentences(text) {
        found.extend(opening(&sentence).map(|first| format!("{name}:{at}: begins with {first}")));
        found.extend(banned(&sentence).map(|word| format!("{name}:{at}: {word}")));
    }
    found
}

/// Sentences that are too long, begin wrongly or have a word of the list; and cells that do.
fn badly_worded((name, text): &Source, median: usize) -> Vec<String> {
    let mut found = Vec::new();
    let mut counts = Vec::new();
    for (at, sentence) in sentences(text) {
        let count = words(&sentence);
        let place = format!("{name}:{at}");
        if count > LONGEST_SENTENCE {
            found.push(format!("{place}: {count} words: {sentence}"));
        }
        found.extend(opening(&sentence).map(|first| format!("{place}: begins with {first}")));
        found.extend(banned(&sentence).map(|word| format!("{place}: {word}")));
        counts.extend((count >= 3).then_some(count));
    }
    for (at, line) in lines(text) {
        let Line::Cells(line) = line else { continue };
        if name.starts_with(INTERNALS) {
            continue;
        }
        found.extend(banned(&shown(line)).map(|word| format!("{name}:{at}: {word}")));
        let cells = shown_cells(line);
        let long = cells.iter().filter(|cell| cell.chars().count() > CELL);
        found.extend(long.map(|cell| format!("{name}:{at}: a cell of {}", cell.chars().count())));
    }
    counts.sort_unstable();
    if counts.get(counts.len() / 2).is_some_and(|middle| *middle > median) {
        found.push(format!("{name}: median {} words", counts[counts.len() / 2]));
    }
    found
}

/// The word that a sentence must not begin with, if it does.
fn opening(sentence: &str) -> Option<&str> {
    let first = sentence.split(|c: char| !c.is_alphanumeric()).next().unwrap_or_default();
    OPENINGS.contains(&first).then_some(first)
}

/// Words of the list in a text.
fn banned(text: &str) -> impl Iterator<Item = &'static str> {
    let text = text.to_lowercase();
    BANNED.into_iter().filter(move |word| says(&text, word))
}

/// Cells of a row as they are read: code is kept, targets of links are not.
fn shown_cells(line: &str) -> Vec<String> {
    let cells = line.trim().trim_matches('|').split(" | ");
    let without = |cell: &str| match (cell.find("]("), cell.rfind(')')) {
        (Some(from), Some(to)) if to > from => [&cell[..from], &cell[to + 1..]].concat(),
        _ => cell.to_owned(),
    };
    cells.map(|cell| without(cell.trim())).collect()
}

/// Lines of prose that are too wide.
fn too_wide((name, text): &Source) -> Vec<String> {
    let mut found = Vec::new();
    for (at, line) in lines(text) {
        if let Line::Prose(line) = line {
            let width = line.chars().count();
            found.extend((width > WIDTH).then(|| format!("{name}:{at}: {width} columns")));
        }
    }
    found
}

/// Pages that are too large.
fn too_large((name, text): &Source) -> Vec<String> {
    let mut found = Vec::new();
    if text.len() > PAGE_BYTES {
        found.push(format!("{name}: {} bytes", text.len()));
    }
    if name == "README.md" && text.lines().count() > README_LINES {
        found.push(format!("{name}: {} lines", text.lines().count()));
    }
    found
}

/// Numbers with a unit outside of tables that are made.
fn loose_figures((name, text): &Source) -> Vec<String> {
    let mut found = Vec::new();
    for (at, line) in lines(text) {
        let (Line::Prose(line) | Line::Cells(line)) = line else { continue };
        let shown = shown(line);
        let parts: Vec<&str> = shown.split_whitespace().collect();
        let is_number = |part: &str| part.starts_with(|c: char| c.is_ascii_digit());
        let bare = |part: &str| part.trim_matches(|c: char| !c.is_alphanumeric() && c != '%').to_owned();
        for pair in parts.windows(2) {
            let [number, unit] = [bare(pair[0]), bare(pair[1])];
            if is_number(&number) && UNITS.contains(&unit.as_str()) {
                found.push(format!("{name}:{at}: {number} {unit}"));
            }
        }
    }
    found
}

#[test]
fn pages_are_worded_plainly() {
    let held = held();
    assert!(held.len() > 12, "only {} pages", held.len());
    let sentences: usize = held.iter().map(|((_, text), _)| sentences(text).len()).sum();
    assert!(sentences > 400, "only {sentences} sentences");
    let found: Vec<String> = held.iter().flat_map(|(page, median)| badly_worded(page, *median)).collect();
    assert_eq!(found, NONE);
}

#[test]
fn decisions_have_plain_words() {
    let pages = files(DECISIONS.trim_end_matches('/'));
    assert!(pages.len() > 150, "only {} pages", pages.len());
    let found: Vec<String> = pages.iter().flat_map(|(name, text)| badly_chosen(name, text)).collect();
    assert_eq!(found, NONE);
}

#[test]
fn pages_are_narrow_and_small() {
    let held = held().into_iter().filter(|((name, _), _)| !name.starts_with(INTERNALS));
    let found = held.flat_map(|(page, _)| [too_wide(&page), too_large(&page)].concat());
    assert_eq!(found.collect::<Vec<_>>(), NONE);
}

#[test]
fn readme_has_measured_figures_in_tables_alone() {
    assert_eq!(loose_figures(&files("README.md")[0]), NONE);
}

#[test]
fn bad_wording_is_noticed() {
    let found = |text: &str| badly_worded(&planted("a.md", text)[0], 14);
    let long = "word ".repeat(26);
    for (text, expected) in [
        ("What it does is good.", "a.md:1: begins with What"),
        ("# Title\n\nIt runs. Of all\nthings.", "a.md:3: begins with Of"),
        ("- Where a list is short it grows.", "a.md:1: begins with Where"),
        ("It is built anew.", "a.md:1: anew"),
        ("The seed says so.", "a.md:1: the seed"),
        ("| it | tells |", "a.md:1: tells"),
        ("He asks [us](tell.md) now.", "a.md:1: asks"),
    ] {
        assert_eq!(found(text), [expected], "{text}");
    }
    assert!(found(&long)[0].starts_with("a.md:1: 26 words"));
    assert_eq!(found(&long)[1], "a.md: median 26 words");
    assert_eq!(found(&format!("| a | {} |", "x".repeat(61))), ["a.md:1: a cell of 61"]);
    for good in [
        "It runs `ask()` in a task. See [the page](told.md).",
        "```text\nWhat is told.\n```",
        "<!-- figures: x -->\n| ask |\n<!-- end -->",
        "| [a page](a/very/long/target/that/is/not/shown/to/anybody/who/reads/the/page.md) |",
        "One sentence of 1.5 words. Another one\nthat goes on.",
    ] {
        assert_eq!(found(good), NONE, "{good}");
    }
}

#[test]
fn wide_lines_large_pages_and_loose_figures_are_noticed() {
    let page = |text: &str| planted("README.md", text).remove(0);
    assert_eq!(too_wide(&page(&"x".repeat(101))), ["README.md:1: 101 columns"]);
    assert_eq!(too_wide(&page(&format!("| {} |\n```\n{}\n```", "x".repeat(200), "x".repeat(200)))), NONE);
    assert_eq!(too_large(&page(&"\n".repeat(161))), ["README.md: 161 lines"]);
    assert_eq!(too_large(&page(&"x".repeat(8193))), ["README.md: 8193 bytes"]);
    assert_eq!(too_large(&planted("docs/a.md", &"\n".repeat(161))[0]), NONE);
    for (text, expected) in [
        ("A frame takes 0.14 ms on a GPU.", "README.md:1: 0.14 ms"),
        ("| memory | 28 MB |", "README.md:1: 28 MB"),
        ("It takes (12 s).", "README.md:1: 12 s"),
    ] {
        assert_eq!(loose_figures(&page(text)), [expected], "{text}");
    }
    let made = "<!-- figures: x -->\n| 3 ms |\n<!-- end -->\nRust 1.95 is needed. `took 3 ms`";
    assert_eq!(loose_figures(&page(made)), NONE);
}
