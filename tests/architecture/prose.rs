//! Rules about how files are written: short, finished, with a card, naming no machine.

use crate::sources::{NONE, Source, after, all_rust, exists, files, lines, planted, rust, says};

// Short rooms.

/// The ceiling, in lines.
const CEILING: usize = 400;
fn too_long(sources: &[Source]) -> Vec<String> {
    let long = sources.iter().filter(|(_, text)| text.lines().count() > CEILING);
    long.map(|(name, text)| format!("{name}: {} lines", text.lines().count())).collect()
}

#[test]
fn no_file_is_over_the_ceiling() {
    assert_eq!(too_long(&all_rust()), NONE);
}

#[test]
fn a_file_over_the_ceiling_is_noticed() {
    assert_eq!(too_long(&planted("a.rs", &"\n".repeat(CEILING + 1))), ["a.rs: 401 lines"]);
    assert_eq!(too_long(&planted("a.rs", &"\n".repeat(CEILING))), NONE);
}

// Every kernel opens with its card.

fn without_card(sources: &[Source]) -> Vec<String> {
    let mut found = Vec::new();
    for (name, text) in sources.iter().filter(|(name, _)| !name.ends_with("/mod.rs")) {
        let card: Vec<&str> = text.lines().map_while(|line| line.strip_prefix("//!")).collect();
        let title = card.first().is_some_and(|line| line.starts_with(" # ") && line.contains(": "));
        let headings = ["Launch", "Reads", "Writes", "Before", "After", "Room", "Cost"];
        let missing = headings.iter().filter(|heading| {
            !card.iter().any(|line| {
                line.split("  ")
                    .any(|part| part.trim().starts_with(&format!("{heading} ")) || part.trim() == **heading)
            })
        });
        found.extend((!title).then(|| format!("{name}: no title")));
        found.extend(missing.map(|heading| format!("{name}: no {heading}")));
    }
    found
}

#[test]
fn every_stage_opens_with_its_card() {
    assert_eq!(without_card(&rust(&["kernels/src/stage"])), NONE);
}

#[test]
fn a_missing_card_is_noticed() {
    let (_, text) = &files("kernels/src/stage/fit/leaves.rs")[0];
    assert_eq!(without_card(&planted("leaves.rs", text)), NONE);
    let without = |word: &str| text.replacen(&format!("//! {word} "), "//! Other ", 1);
    for word in ["Launch", "Reads", "Before", "After", "Room", "Cost"] {
        assert_eq!(without_card(&planted("leaves.rs", &without(word))), [format!("leaves.rs: no {word}")]);
    }
    assert_eq!(
        without_card(&planted("leaves.rs", &text.replacen("//! # ", "//! ", 1))),
        ["leaves.rs: no title"]
    );
    assert_eq!(without_card(&planted("leaves.rs", "fn fit() {}")).len(), 8);
}

// Nothing is left half done, and no test sleeps without saying why.

fn half_done(sources: &[Source]) -> Vec<String> {
    let ignore = format!("#[{}]", "ignore");
    let marks = ["todo", "unimplemented"].map(|mark| format!("{mark}!"));
    lines(sources, |_, code| {
        code.contains(&ignore) || marks.iter().any(|mark| after(code, mark).next().is_some())
    })
}

#[test]
fn nothing_is_half_done() {
    assert_eq!(half_done(&all_rust()), NONE);
}

#[test]
fn what_is_half_done_is_noticed() {
    for line in
        [format!("{}!()", "todo"), format!("x => {}!(),", "unimplemented"), format!("#[{}]", "ignore")]
    {
        assert_eq!(half_done(&planted("a.rs", &line)).len(), 1, "{line}");
    }
    assert_eq!(half_done(&planted("a.rs", "#[ignore = \"half a minute\"]")), NONE);
}

// No machine's paths.

/// Judges plant paths to condemn them.
const PLANTERS: [&str; 1] = ["tests/gpu/ptx.rs"];

fn name_a_machine(sources: &[Source]) -> Vec<String> {
    let folders = ["root", "home", "work", "Users"].map(|folder| format!("/{folder}/"));
    let path = |line: &str| {
        folders.iter().any(|folder| {
            line.match_indices(folder.as_str())
                .any(|(at, _)| !line[..at].ends_with(|c: char| c.is_alphanumeric() || "._-~}*".contains(c)))
        })
    };
    let mut found = Vec::new();
    for (name, text) in sources.iter().filter(|(name, _)| !PLANTERS.contains(&name.as_str())) {
        let bad = text.lines().enumerate().filter(|(_, line)| path(line));
        found.extend(bad.map(|(at, line)| format!("{name}:{}: {}", at + 1, line.trim())));
    }
    found
}

#[test]
fn no_text_names_a_machine() {
    let own = ["Cargo.toml", "build.rs", "README.md", "CHANGELOG.md", "CONTRIBUTING.md", "rustfmt.toml"];
    let folders = [
        ".ci", ".cargo", ".github", "benches", "c", "cli", "docs", "emulator", "examples", "fuzz", "host",
        "io", "python", "kernels", "lab", "tests",
    ];
    let ours =
        own.iter().chain(&folders).filter(|of| exists(of)).flat_map(|of| files(of)).collect::<Vec<_>>();
    assert!(ours.len() > 100, "only {} files", ours.len());
    assert_eq!(name_a_machine(&ours), NONE);
}

#[test]
fn a_path_of_a_machine_is_noticed() {
    for folder in ["root", "home/ann", "work", "Users/ann"] {
        assert_eq!(name_a_machine(&planted("a.md", &format!("see /{folder}/x"))).len(), 1, "{folder}");
    }
    assert_eq!(name_a_machine(&planted("a.md", "../work/x, https://a.org/home/x, /homework/")), NONE);
}

// A tolerance has a surname.

fn bare_epsilon(sources: &[Source]) -> Vec<String> {
    lines(sources, |_, code| {
        let code = code.to_lowercase().replace("f32::epsilon", "").replace("f64::epsilon", "");
        ["epsilon", "eps"].iter().any(|word| says(&code, word))
    })
}

#[test]
fn no_epsilon_without_a_surname() {
    assert_eq!(bare_epsilon(&rust(&["kernels"])), NONE);
    for line in ["let eps = 1e-6;", "const EPSILON: f32 = 1e-5;", "x.abs() < epsilon"] {
        assert_eq!(bare_epsilon(&planted("k.rs", line)).len(), 1, "{line}");
    }
    assert_eq!(bare_epsilon(&planted("k.rs", "const EPS_PARALLEL: f32 = f32::EPSILON; // epsilon")), NONE);
}
