//! The rule about the catalogue of extremes: every id has a row in `docs/internals/robustness.md`,
//! and every row its tests. Every test exists, is a test, and runs that id if it runs over the
//! catalogue's data.

use crate::sources::{NONE, Source, files};
use nearmiss_lab::robustness::{questions, refused, scenes};

/// Cases of the catalogue that have names instead of numbers, and the acceptance tests.
const NAMED: [&str; 28] = [
    "ti1",
    "ipc-double-root-1",
    "ipc-double-root-2-1.0",
    "ipc-slow-2",
    "ipc-adversarial-accd-1e-08",
    "zhongshi-neg",
    "zhongshi-zero",
    "zhongshi-pos",
    "bsc-fn-2",
    "ti-head-filter",
    "even-parity-1",
    "f32cubic-late-1",
    "axom152",
    "geogram10",
    "loki3a",
    "g3s85a",
    "g3s85b",
    "cgal9256",
    "coal48",
    "libigl2381",
    "error bounds",
    "exact contacts",
    "sample queries",
    "cloth-ball",
    "invariances",
    "device is host",
    "properties",
    "budget",
];

/// How many failures of others the catalogue lists besides.
const REPORTS: usize = 29;

/// The tests that run over data, by their ids.
fn asked_by(test: &str) -> Option<Vec<&'static str>> {
    let all: Vec<&'static str> = match test {
        "questions_are_answered" => questions().iter().map(|q| q.id).collect(),
        "scenes_are_searched" => scenes().iter().map(|s| s.id).collect(),
        "what_cannot_be_is_refused" => refused().iter().map(|r| r.id).collect(),
        _ => return None,
    };
    Some(all)
}

/// A row: its id, and the tests of its last cell as (file, name).
type Row<'a> = (&'a str, Vec<(&'a str, &'a str)>);

fn rows(table: &str) -> Vec<Row<'_>> {
    let cells = |line: &str| line.trim_matches('|').split(" | ").count() >= 3;
    let body = |line: &&str| {
        line.starts_with("| ") && cells(line) && !line.starts_with("| ---") && !line.starts_with("| id |")
    };
    let row = |line| -> Row<'_> {
        let line: &str = line;
        let id = line.trim_start_matches("| ").split(" | ").next().unwrap_or_default();
        let last = line.trim_end_matches(" |").rsplit(" | ").next().unwrap_or_default();
        let tests = last.split('`').filter_map(|word| word.split_once("::")).collect();
        (id, tests)
    };
    table.lines().filter(body).map(row).collect()
}

/// Whether the file has a test of that name: a function that follows a `#[test]` with nothing but attributes between.
fn is_test(sources: &[Source], file: &str, name: &str) -> bool {
    let Some((_, text)) = sources.iter().find(|(path, _)| path == file) else { return false };
    let head = format!("fn {name}()");
    let lines: Vec<&str> = text.lines().map(str::trim).collect();
    lines.iter().enumerate().filter(|(_, line)| line.starts_with(&head)).any(|(at, _)| {
        lines[..at].iter().rev().take_while(|line| line.starts_with("#[")).any(|line| *line == "#[test]")
    })
}

fn broken(table: &str, sources: &[Source]) -> Vec<String> {
    let rows = rows(table);
    let mut wanted: Vec<String> = (1..=65).map(|n| format!("X{n:02}")).collect();
    wanted.extend(NAMED.map(str::to_owned));
    let mut found = Vec::new();
    for id in &wanted {
        match rows.iter().filter(|row| row.0 == id).count() {
            1 => {}
            n => found.push(format!("{id}: {n} rows")),
        }
    }
    if rows.len() != wanted.len() + REPORTS {
        found.push(format!("{} rows", rows.len()));
    }
    for (id, tests) in &rows {
        if tests.is_empty() {
            found.push(format!("{id}: no test"));
        }
        for (file, name) in tests {
            if !is_test(sources, file, name) {
                found.push(format!("{id}: {file} has no test {name}"));
            }
            let known = |ids: Vec<&str>| ids.contains(id);
            if wanted.iter().any(|w| w == id)
                && *id != "X23"
                && *file == "tests/frames/robustness.rs"
                && asked_by(name).is_some_and(|ids| !known(ids))
            {
                found.push(format!("{id}: {name} does not ask it"));
            }
        }
    }
    found
}

fn table() -> String {
    files("docs/internals/robustness.md")[0].1.clone()
}

/// Sources that have tests.
fn sources() -> Vec<Source> {
    [files("tests"), files("host"), files("lab"), files("cli")].concat()
}

#[test]
fn every_extreme_has_its_tests() {
    assert_eq!(broken(&table(), &sources()), NONE);
}

#[test]
fn an_extreme_without_a_test_is_noticed() {
    let (table, sources) = (table(), sources());
    let with = |from: &str, to: &str| {
        let changed = table.replacen(from, to, 1);
        assert_ne!(changed, table, "{from}");
        broken(&changed, &sources)
    };
    assert_eq!(with("| X17 |", "| X99 |"), ["X17: 0 rows"]);
    assert_eq!(with("| X18 |", "| X17 |"), ["X17: 2 rows", "X18: 0 rows"]);
    assert_eq!(
        with("`tests/kernels/volume/bounds.rs::a_chain_of_merges_stays_small` |\n| X57", "nothing |\n| X57"),
        ["X56: no test"]
    );
    assert_eq!(
        with("bounds.rs::a_chain_of_merges_stays_small` |\n| X57", "bounds.rs::surface` |\n| X57"),
        ["X56: tests/kernels/volume/bounds.rs has no test surface"]
    );
    assert_eq!(
        with("`tests/gpu/ptx.rs::an_inexact_instruction", "`tests/none.rs::an_inexact_instruction"),
        ["X59: tests/none.rs has no test an_inexact_instruction_is_noticed"]
    );
    assert_eq!(
        with(
            "apart | `tests/frames/robustness.rs::questions_are_answered` |",
            "apart | `tests/frames/robustness.rs::what_cannot_be_is_refused` |"
        ),
        ["X13: what_cannot_be_is_refused does not ask it"]
    );
    let more = format!("{table}\n| X99 | new | unknown | none |\n");
    assert_eq!(broken(&more, &sources), ["123 rows", "X99: no test"]);
}
