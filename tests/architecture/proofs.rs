//! The rule about `docs/internals`: every test that a page names, as `name()`, exists and is a test.

use crate::sources::{NONE, Source, files, planted};

/// The names of all tests in some sources.
fn tests(sources: &[Source]) -> Vec<&str> {
    let mut found = Vec::new();
    for (_, text) in sources {
        let lines: Vec<&str> = text.lines().map(str::trim).collect();
        for (at, line) in lines.iter().enumerate() {
            let Some(name) = line.strip_prefix("fn ").and_then(|rest| rest.split("()").next()) else {
                continue;
            };
            let attributes = lines[..at].iter().rev().take_while(|line| line.starts_with("#["));
            found.extend(attributes.into_iter().any(|line| *line == "#[test]").then_some(name));
        }
    }
    found
}

/// The tests that pages name and that do not exist.
fn missing(pages: &[Source], sources: &[Source]) -> Vec<String> {
    let known = tests(sources);
    let mut found = Vec::new();
    for (page, text) in pages {
        let spans = text.split('`').skip(1).step_by(2);
        let names = spans.filter_map(|span| span.strip_suffix("()"));
        found.extend(names.filter(|name| !known.contains(name)).map(|name| format!("{page}: {name}")));
    }
    found
}

#[test]
fn every_test_that_a_page_names_exists() {
    let pages = files("docs/internals");
    assert!(pages.iter().any(|(_, text)| text.contains("`isolate_cubic()`")));
    assert_eq!(missing(&pages, &files("tests")), NONE);
}

#[test]
fn a_test_that_does_not_exist_is_named() {
    let sources = planted("tests/a.rs", "#[test]\nfn there() {}\nfn helper() {}");
    let page = |span: &str| planted("p.md", &format!("by {span}, in `tests/a.rs`"));
    assert_eq!(missing(&page("`there()`"), &sources), NONE);
    assert_eq!(missing(&page("`gone()`"), &sources), ["p.md: gone"]);
    assert_eq!(missing(&page("`helper()`"), &sources), ["p.md: helper"]);
}
