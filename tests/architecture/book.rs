//! Rules about the book: every page of `docs` is in its contents, every link leads somewhere, and every block of code says by whom it is run.

use crate::sources::{NONE, Source, exists, files, planted};
use std::path::{Component, Path, PathBuf};

const CONTENTS: &str = "docs/SUMMARY.md";

/// The page by which a folder opens, and the pages whose blocks are all marked.
const MARKED: [&str; 4] = ["docs/README.md", "docs/concepts.md", "docs/guarantees.md", "docs/reference.md"];

fn is_marked(name: &str) -> bool {
    MARKED.contains(&name) || name.starts_with("docs/for/")
}

fn pages() -> Vec<Source> {
    files("docs").into_iter().filter(|(name, _)| name.ends_with(".md")).collect()
}

/// Lines with their numbers, without those of blocks of code and of comments.
fn prose(text: &str) -> Vec<(usize, String)> {
    let mut inside = false;
    let mut found = Vec::new();
    for (at, line) in text.lines().enumerate() {
        let fence = line.trim_start().starts_with("```");
        inside ^= fence;
        if !inside && !fence && !line.trim_start().starts_with("<!--") {
            // Text between backticks is code.
            found.push((at + 1, line.split('`').step_by(2).collect::<Vec<_>>().join("code")));
        }
    }
    found
}

/// Targets of the links and images of a page, with their lines.
fn links(text: &str) -> Vec<(usize, String)> {
    let mut found = Vec::new();
    for (at, line) in prose(text) {
        let targets = line.split("](").skip(1).filter_map(|rest| rest.split(')').next());
        found.extend(targets.map(|target| (at, target.split(' ').next().unwrap_or_default().to_owned())));
    }
    found
}

/// The path that a link of a page leads to, from the root.
fn resolved(page: &str, target: &str) -> String {
    let mut path = PathBuf::new();
    let folder = Path::new(page).parent().unwrap_or(Path::new(""));
    for part in folder.join(target).components() {
        match part {
            Component::ParentDir if path.pop() => {}
            Component::CurDir => {}
            other => path.push(other),
        }
    }
    path.to_string_lossy().replace('\\', "/")
}

/// Pages that the contents do not name, or name twice.
fn not_in_contents(contents: &str, pages: &[Source]) -> Vec<String> {
    let named: Vec<String> = links(contents).iter().map(|(_, target)| resolved(CONTENTS, target)).collect();
    let pages = pages.iter().map(|(name, _)| name).filter(|name| *name != CONTENTS);
    let times = pages.map(|page| (page, named.iter().filter(|name| *name == page).count()));
    times
        .filter(|(_, times)| *times != 1)
        .map(|(page, times)| format!("{page}: named {times} times"))
        .collect()
}

/// The anchor of a heading.
fn anchor(heading: &str) -> String {
    let kept = heading.trim().to_lowercase().replace(' ', "-");
    kept.chars().filter(|c| c.is_alphanumeric() || "-_".contains(*c)).collect()
}

/// Links to what is not there: no such file, or no such heading in a page.
fn lead_nowhere(pages: &[Source]) -> Vec<String> {
    let mut found = Vec::new();
    for (name, text) in pages {
        for (at, target) in links(text) {
            let (path, heading) = target.split_once('#').unwrap_or((&target, ""));
            if target.contains("://") || target.starts_with("mailto:") {
                continue;
            }
            let to = if path.is_empty() { name.clone() } else { resolved(name, path) };
            let known = pages.iter().find(|(page, _)| *page == to).map(|(_, text)| text);
            let is_there = known.is_some() || exists(&to);
            let has_heading = heading.is_empty()
                || known.is_some_and(|text| {
                    let headings = text.lines().filter(|line| line.starts_with('#'));
                    headings.into_iter().any(|line| anchor(line.trim_start_matches('#')) == heading)
                });
            found.extend((!is_there || !has_heading).then(|| format!("{name}:{at}: {target}")));
        }
    }
    found
}

/// Whether lines stand in a file one after the other, however far they are indented.
fn stands_in(file: &str, block: &[&str]) -> bool {
    let found = if exists(file) { files(file) } else { Vec::new() };
    let lines: Vec<&str> = found.iter().flat_map(|(_, text)| text.lines().map(str::trim)).collect();
    !block.is_empty() && lines.windows(block.len()).any(|window| window == block)
}

/// The blocks of code that do not say by whom they are run.
///
/// The line before a block is `<!-- run by CI -->` or `<!-- needs …: run by FILE -->`, and its lines then stand in that file one after the
/// other; of a text that a block of shell or C prints, `<!-- printed -->`, right behind that block. A page with Rust is read by
/// `cargo test --doc`, which runs all of it.
fn not_marked(pages: &[Source], tested: &str) -> Vec<String> {
    const RUN: [&str; 4] = ["sh", "python", "rust", "c"];
    let mut found = Vec::new();
    for (name, text) in pages.iter().filter(|(name, _)| is_marked(name)) {
        let lines: Vec<&str> = text.lines().collect();
        // Whether the last thing on the page was a block that is run here.
        let (mut inside, mut ran) = (false, false);
        for (at, line) in lines.iter().enumerate() {
            let Some(language) = line.trim_start().strip_prefix("```") else {
                ran &= inside || line.is_empty() || line.starts_with("<!-- printed");
                continue;
            };
            inside = !inside;
            if !inside {
                continue;
            }
            let mark = if at > 0 { lines[at - 1] } else { "" };
            let block = lines[at + 1..].iter().map(|line| line.trim()).take_while(|line| *line != "```");
            let needs = mark
                .strip_prefix("<!-- needs ")
                .and_then(|mark| mark.strip_suffix(" -->")?.split_once(": run by "))
                .is_some_and(|(_, file)| stands_in(file, &block.collect::<Vec<_>>()));
            let by_ci = mark == "<!-- run by CI -->" && RUN.contains(&language);
            let printed = mark == "<!-- printed -->" && language == "text" && ran;
            found.extend((!needs && !by_ci && !printed).then(|| format!("{name}:{}: ```{language}", at + 1)));
            if language == "rust" && !tested.contains(&format!("include_str!(\"../{name}\")")) {
                found.push(format!("{name}:{}: no doctest has this page", at + 1));
            }
            ran = by_ci && ["sh", "c"].contains(&language);
        }
    }
    found
}

#[test]
fn every_page_is_in_the_book() {
    let (contents, pages) = (&files(CONTENTS)[0].1, pages());
    assert!(pages.len() > 15, "only {} pages", pages.len());
    assert_eq!(not_in_contents(contents, &pages), NONE);
    for page in MARKED {
        assert!(exists(page), "{page}");
    }
}

#[test]
fn a_page_that_is_not_in_the_book_is_noticed() {
    let contents = "- [A](a.md)\n- [B](for/b.md)\n- [B again](./for/b.md)\n<!-- [C](c.md) -->";
    let pages: Vec<Source> = ["docs/SUMMARY.md", "docs/a.md", "docs/for/b.md", "docs/c.md"]
        .iter()
        .flat_map(|of| planted(of, ""))
        .collect();
    assert_eq!(
        not_in_contents(contents, &pages),
        ["docs/for/b.md: named 2 times", "docs/c.md: named 0 times"]
    );
}

#[test]
fn every_link_leads_somewhere() {
    let mut pages = pages();
    let others = ["python", "plugs/interop", "plugs/mpi", "plugs/wasm", "benches"];
    let others = others.map(|folder| format!("{folder}/README.md"));
    for page in ["README.md", "CONTRIBUTING.md"].into_iter().chain(others.iter().map(String::as_str)) {
        pages.extend(files(page));
    }
    let all: usize = pages.iter().map(|(_, text)| links(text).len()).sum();
    assert!(all > 60, "only {all} links");
    assert_eq!(lead_nowhere(&pages), NONE);
}

#[test]
fn a_link_that_leads_nowhere_is_noticed() {
    for bad in [
        "see [this](none.md)",
        "![picture](pictures/none.png)",
        "[up](../none/README.md \"a title\")",
        "[heading](#no-such-thing)",
        "[heading](b.md#no-such-thing)",
    ] {
        let mut pages = planted("docs/a.md", &format!("# A thing, and another\n\n{bad}"));
        pages.extend(planted("docs/b.md", "# B"));
        assert_eq!(lead_nowhere(&pages).len(), 1, "{bad}");
        assert!(lead_nowhere(&pages)[0].starts_with("docs/a.md:3: "), "{bad}");
    }
    let good = "# A thing, and another\n[x](#a-thing-and-another) [y](https://a.org/b.md) `[z](none.md)` [r](../README.md)\n\
                <!-- picture: [p](none.png) -->\n```text\n[q](none.md)\n```\n[l](../LICENSE-MIT)";
    assert_eq!(lead_nowhere(&planted("docs/a.md", good)), NONE);
}

#[test]
fn every_block_says_by_whom_it_is_run() {
    let doctests = &files("host/lib.rs")[0].1;
    assert_eq!(not_marked(&pages(), doctests), NONE);
}

#[test]
fn a_block_that_nobody_runs_is_noticed() {
    let block = |mark: &str, language: &str| format!("{mark}\n```{language}\nx\n```\n");
    for (mark, language) in [
        ("", "sh"),
        ("<!-- run by CI -->", "text"),
        ("<!-- run by CI -->", ""),
        ("<!-- runs -->", "python"),
        ("<!-- needs a GPU -->", "python"),
        ("<!-- needs a GPU: run by python/tests/test_gpu.py -->", "python"),
        ("<!-- needs a GPU: run by none.py -->", "python"),
        ("<!-- printed -->", "text"),
    ] {
        let found = not_marked(&planted("docs/for/a.md", &block(mark, language)), "");
        assert_eq!(found, [format!("docs/for/a.md:2: ```{language}")], "{mark}");
        assert_eq!(not_marked(&planted("docs/internals/map.md", &block(mark, language)), ""), NONE);
    }
    let run = block("<!-- run by CI -->", "sh");
    let printed = block("<!-- printed -->", "text");
    assert_eq!(not_marked(&planted("docs/for/a.md", &format!("{run}\n{printed}")), ""), NONE);
    assert_eq!(not_marked(&planted("docs/for/a.md", &format!("{run}\nwords\n\n{printed}")), "").len(), 1);
    let needs = "<!-- needs a GPU: run by python/tests/test_gpu.py -->\n```python\nimport numpy as np\n```\n";
    assert_eq!(not_marked(&planted("docs/concepts.md", needs), ""), NONE);
    // Rust that no doctest has.
    let rust = planted("docs/for/a.md", &block("<!-- run by CI -->", "rust"));
    assert_eq!(not_marked(&rust, ""), ["docs/for/a.md:2: no doctest has this page"]);
    assert_eq!(not_marked(&rust, "#[doc = include_str!(\"../docs/for/a.md\")]"), NONE);
}
