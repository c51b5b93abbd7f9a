//! The rule about measured figures: tables of pages are those that the recorded files make.

use crate::sources::{NONE, Source, files};
use nearmiss_lab::figures::{Tables, names, refill};
use std::path::Path;

fn tables() -> Tables {
    Tables::open(Path::new(env!("CARGO_MANIFEST_DIR"))).expect("benches/tables.toml")
}

fn pages() -> Vec<Source> {
    let docs = files("docs").into_iter().filter(|(name, _)| name.ends_with(".md"));
    files("README.md").into_iter().chain(docs).collect()
}

/// Pages whose tables are not those of the recorded files, with the first line that differs.
fn differ(pages: &[Source]) -> Vec<String> {
    let mut tables = tables();
    let mut found = Vec::new();
    for (name, text) in pages {
        match refill(name, text, &mut tables) {
            Err(problem) => found.push(problem),
            Ok(made) if made == *text => {}
            Ok(made) => {
                let mut lines = text.lines().zip(made.lines()).enumerate();
                let at = lines.find(|(_, (old, new))| old != new).map_or(0, |(at, _)| at + 1);
                found.push(format!("{name}:{at}: run cargo run -p nearmiss-lab --example figures"));
            }
        }
    }
    found
}

#[test]
fn tables_are_those_of_the_recorded_files() {
    assert_eq!(differ(&pages()), NONE);
}

#[test]
fn every_table_is_on_one_page() {
    let pages = pages();
    let mut shown: Vec<&str> = pages.iter().flat_map(|(_, text)| names(text)).collect();
    shown.sort_unstable();
    let tables = tables();
    let mut known: Vec<&str> = tables.names().collect();
    known.sort_unstable();
    assert!(known.len() > 10);
    assert_eq!(shown, known);
}

#[test]
fn another_figure_is_noticed() {
    let (name, page) = files("README.md").remove(0);
    let at = page.find("| gProximity").expect("a row of a peer");
    let figure = page[at..].find("0.93").expect("its time") + at;
    let planted = [&page[..figure], "0.39", &page[figure + 4..]].concat();
    let line = page[..figure].lines().count();
    assert!(differ(&[(name.clone(), planted)])[0].starts_with(&format!("README.md:{line}: ")));
    assert_eq!(differ(&[(name.clone(), page.clone())]), NONE);
    // An unknown table, and one without an end.
    let unknown = page.replace("figures: front", "figures: none");
    assert_eq!(differ(&[(name.clone(), unknown)]), ["README.md: no table none"]);
    let endless = page.replace("<!-- end -->", "");
    assert!(differ(&[(name, endless)])[0].contains("has no line"));
}
