//! Two doors: the laboratory is reached by `nearmiss::research` alone.

use super::sources::{NONE, Source, files, planted, rust, says};

/// The laboratory's door.
const RESEARCH: &str = "host/research.rs";
/// The product's types that the laboratory has more methods of.
const EXTENDED: [&str; 10] = [
    "Query",
    "QueryKind",
    "Discrete",
    "Continuous",
    "Earliest",
    "Near",
    "Distance",
    "$kind",
    "Detector",
    "Stats",
];

/// Names of the laboratory: types and traits, the modules that define them, and methods of its
/// traits.
struct Laboratory {
    names: Vec<String>,
    modules: Vec<String>,
    methods: Vec<String>,
}

fn word(text: &str) -> String {
    text.chars().take_while(|&c| c.is_alphanumeric() || c == '_' || c == '$').collect()
}

fn laboratory() -> Laboratory {
    let text = files(RESEARCH).swap_remove(0).1;
    let (mut names, mut modules, mut methods) = (Vec::new(), Vec::new(), Vec::new());
    for line in text.lines().map(str::trim) {
        if let Some((path, last)) =
            line.strip_prefix("pub use crate::").and_then(|path| path.rsplit_once("::"))
        {
            names.extend(
                last.trim_matches(['{', '}', ';']).split(", ").map(word).filter(|name| !name.is_empty()),
            );
            modules.push(path.to_owned());
        } else if let Some(name) = line.strip_prefix("pub trait ") {
            names.push(word(name));
        } else if let Some(name) = line.strip_prefix("fn ") {
            methods.push(word(name));
        }
    }
    names.retain(|name| name.starts_with(char::is_uppercase));
    Laboratory { names, modules, methods }
}

/// The public lines outside the laboratory that give away something of it, as `file:line: text`.
fn given_away(laboratory: &Laboratory, sources: &[Source]) -> Vec<String> {
    let mut found = Vec::new();
    for (file, text) in sources {
        let room = file.trim_start_matches("host/").trim_end_matches("mod.rs").trim_end_matches("lib.rs");
        let room = room.replace('/', "::");
        let mut owner = String::new();
        for (at, line) in text.lines().enumerate() {
            let code = line.split("//").next().unwrap_or_default().trim();
            if code.starts_with("#[cfg(test)]")
                && text.lines().nth(at + 1).is_some_and(|next| next.starts_with("mod tests"))
            {
                break;
            }
            let defined =
                ["pub struct ", "pub enum ", "pub trait "].iter().find_map(|of| code.strip_prefix(of));
            let implemented = code.strip_prefix("impl ").map(|of| of.rsplit(" for ").next().unwrap_or(of));
            if let Some(name) = defined.or(implemented) {
                owner = word(name);
                continue;
            }
            if line.starts_with(|c: char| c.is_alphabetic()) {
                owner.clear();
            }
            if !code.starts_with("pub ") || laboratory.names.contains(&owner) {
                continue;
            }
            let says_name = laboratory.names.iter().any(|name| says(code, name));
            let module = code.strip_prefix("pub mod ").map(|name| room.clone() + &word(name));
            let opens = module.is_some_and(|module| laboratory.modules.contains(&module));
            let method =
                code.trim_start_matches("pub ").trim_start_matches("const ").strip_prefix("fn ").map(word);
            let has_method = EXTENDED.contains(&owner.as_str())
                && method.is_some_and(|method| laboratory.methods.contains(&method));
            if says_name || opens || has_method {
                found.push(format!("{file}:{}: {}", at + 1, line.trim()));
            }
        }
    }
    found
}

/// Everything that a user may reach, and more. Without the laboratory, and without the pipeline, which
/// only the laboratory shows.
fn product() -> Vec<Source> {
    let mut sources = rust(&["host"]);
    sources.retain(|(file, _)| file != RESEARCH && !file.starts_with("host/pipeline/"));
    sources
}

#[test]
fn the_laboratory_has_one_door() {
    let laboratory = laboratory();
    for name in
        ["Search", "Traversal", "FrontShape", "ContinuousSolver", "TriangleTest", "Summary", "QueryExt"]
    {
        assert!(laboratory.names.iter().any(|known| known == name), "{name} in {:?}", laboratory.names);
    }
    assert!(laboratory.modules.iter().any(|module| module == "query::search"), "{:?}", laboratory.modules);
    assert!(laboratory.methods.iter().any(|method| method == "repeat_stage"), "{:?}", laboratory.methods);
    assert_eq!(given_away(&laboratory, &product()), NONE);
}

#[test]
fn a_second_door_is_noticed() {
    let laboratory = laboratory();
    for (file, text) in [
        ("host/query/mod.rs", "pub use search::{Rebuild, Search};"),
        ("host/query/mod.rs", "pub mod search;"),
        ("host/lib.rs", "pub mod pipeline;"),
        ("host/lib.rs", "pub use query::Traversal;"),
        ("host/contacts/mod.rs", "pub use work::{Front, Queues};"),
        ("host/query/near.rs", "pub struct Near {\n    pub search: Search,"),
        (
            "host/query/continuous.rs",
            "impl $kind {\n    pub fn by(solver: impl Into<ContinuousSolver>) -> $kind {",
        ),
        ("host/query/mod.rs", "impl Query {\n    pub fn with_broad_phase(self, name: &str) -> Query {"),
        ("host/detector/stages.rs", "impl Detector {\n    pub fn repeat_stage(&mut self, times: u32) {"),
    ] {
        assert_eq!(given_away(&laboratory, &planted(file, text)).len(), 1, "{file}: {text}");
    }
    for (file, text) in [
        ("host/query/mod.rs", "pub(crate) use search::{Refit, Search};\npub use search::Rebuild;"),
        ("host/query/mod.rs", "pub(crate) mod search;\npub mod near;"),
        ("host/query/solver.rs", "impl Solver {\n    pub fn default_for(kind: QueryKind) -> Solver {"),
        ("host/query/near.rs", "pub fn within(distance: f64) -> Near { // by Search"),
        ("host/device/mod.rs", "impl Device {\n    pub fn search(&self) -> u32 {"),
    ] {
        assert_eq!(given_away(&laboratory, &planted(file, text)), NONE, "{file}: {text}");
    }
}
