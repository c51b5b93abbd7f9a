//! Sources as the rules see them.

use std::fs;
use std::path::Path;

/// A file's path from the root, with `/`, and its text.
pub type Source = (String, String);

/// Files below a folder (or one file) that hold text; build outputs are not ours.
pub fn files(of: &str) -> Vec<Source> {
    fn walk(path: &Path, found: &mut Vec<Source>) {
        let root = Path::new(env!("CARGO_MANIFEST_DIR"));
        let name = path.strip_prefix(root).expect("below the root").to_string_lossy().replace('\\', "/");
        if path.is_dir() {
            let last = path.file_name().and_then(|n| n.to_str()).unwrap_or_default();
            if path != root && (["target", ".git", "node_modules"].contains(&last)) {
                return;
            }
            let mut inside: Vec<_> =
                fs::read_dir(path).expect("a folder").map(|entry| entry.expect("an entry").path()).collect();
            inside.sort();
            inside.iter().for_each(|path| walk(path, found));
        } else if let Ok(text) = fs::read_to_string(path) {
            found.push((name, text));
        }
    }
    let mut found = Vec::new();
    walk(&Path::new(env!("CARGO_MANIFEST_DIR")).join(of), &mut found);
    found
}

/// The Rust files below some folders.
pub fn rust(of: &[&str]) -> Vec<Source> {
    let all: Vec<Source> =
        of.iter().flat_map(|of| files(of)).filter(|(name, _)| name.ends_with(".rs")).collect();
    assert!(!all.is_empty(), "no Rust files in {of:?}");
    all
}

/// All Rust that we wrote.
pub fn all_rust() -> Vec<Source> {
    rust(
        &[
            "kernels", "emulator", "host", "io", "lab", "cli", "c", "python", "tests", "benches", "build.rs",
            "fuzz", "plugs",
        ]
        .map(|of| if exists(of) { of } else { "build.rs" }),
    )
}

pub fn exists(of: &str) -> bool {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(of).exists()
}

/// A file made for a test.
pub fn planted(name: &str, text: &str) -> Vec<Source> {
    vec![(name.into(), text.into())]
}

/// The lines of code that `bad` condemns, as `file:line: text`; comments are not code.
pub fn lines(sources: &[Source], bad: impl Fn(&str, &str) -> bool) -> Vec<String> {
    let mut found = Vec::new();
    for (name, text) in sources {
        for (at, line) in text.lines().enumerate() {
            let code = line.split("//").next().unwrap_or_default();
            if bad(name, code) {
                found.push(format!("{name}:{}: {}", at + 1, line.trim()));
            }
        }
    }
    found
}

/// The path segments that follow whole-word occurrences of `word`.
pub fn after<'a>(code: &'a str, word: &'a str) -> impl Iterator<Item = &'a str> {
    let ident = |c: char| c.is_alphanumeric() || c == '_';
    code.match_indices(word).filter_map(move |(at, _)| {
        let alone = !code[..at].ends_with(ident);
        let rest = &code[at + word.len()..];
        alone.then(|| rest.split(|c| !ident(c)).next().unwrap_or_default())
    })
}

/// Whether a word stands there by itself.
pub fn says(code: &str, word: &str) -> bool {
    after(code, word).any(str::is_empty)
}

/// No line breaks the rule.
pub const NONE: Vec<String> = Vec::new();
