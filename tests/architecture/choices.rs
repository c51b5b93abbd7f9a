//! A volume is a file and an entry of a list, and the narrow phase of a kind of query a file and a line.

use super::sources::{NONE, Source, lines, planted, rust, says};

/// The volumes, and what the names of their kernels end with.
const VOLUMES: [(&str, &str); 3] = [("Aabb", "_aabb"), ("Linear", "_linear"), ("Obb", "_obb")];

/// Sources without files of tests.
fn without_tests(mut sources: Vec<Source>) -> Vec<Source> {
    const TESTS: [&str; 4] =
        ["typed/in_order.rs", "typed/near.rs", "typed/submitted.rs", "broad/tiles/faults.rs"];
    sources.retain(|(name, _)| name.strip_prefix("host/pipeline/").is_none_or(|file| !TESTS.contains(&file)));
    sources
}

/// Sources that serve any volume: without the volumes' own files, and without tests.
fn serves_volumes() -> Vec<Source> {
    let kernels = ["abi", "bv/mod.rs", "bvh", "entry", "entry.rs", "queue", "stage"];
    let rooms = kernels.map(|room| format!("kernels/src/{room}"));
    let rooms: Vec<&str> = rooms.iter().map(String::as_str).chain(["emulator", "host"]).collect();
    let mut sources = without_tests(rust(&rooms));
    // Boxes of the tiles of meshes are oriented with any volume.
    sources.retain(|(name, _)| name != "host/pipeline/instances/oriented.rs");
    for (_, text) in &mut sources {
        text.truncate(text.find("#[cfg(test)]\nmod tests").unwrap_or(text.len()));
    }
    sources
}

/// The lines that name a volume, or a kernel of it. A default among the choices does not count: it says nothing of the others.
fn names((volume, kernel): (&str, &str), sources: &[Source]) -> Vec<String> {
    lines(sources, |_, code| {
        let code = code.replace(&format!("BoundingVolume::{volume}"), "");
        says(&code, volume) || code.contains(kernel)
    })
}

/// Those that are more than to make it known: `pub use` and its entry, in one file.
fn knows_a_volume(volume: (&str, &str), sources: &[Source]) -> Vec<String> {
    let makes_known = |line: &String| {
        let Some((_, code)) = line.split_once(": ") else { return false };
        line.starts_with("kernels/src/bv/mod.rs:")
            && (code.starts_with("pub use ") || code.starts_with(&format!("{} = \"", volume.0)))
    };
    names(volume, sources).into_iter().filter(|line| !makes_known(line)).collect()
}

#[test]
fn a_volume_is_a_file_and_an_entry_of_a_list() {
    let sources = serves_volumes();
    for volume in VOLUMES {
        assert_eq!(knows_a_volume(volume, &sources), NONE);
        assert_eq!(names(volume, &sources).len(), 2, "what it is used by, and its entry");
    }
}

#[test]
fn a_second_place_that_knows_a_volume_is_noticed() {
    for line in [
        "type Fit = entry::fit<R, Obb>;",
        "BoundingVolume::Obb => typed::<Obb>(device),",
        "traverse_leaves_obb: traverse::leaves,",
        "use crate::bv::{Aabb, Obb};",
    ] {
        let mut sources = serves_volumes();
        sources.extend(planted("host/pipeline/mod.rs", line));
        assert_eq!(knows_a_volume(VOLUMES[2], &sources), [format!("host/pipeline/mod.rs:1: {line}")]);
    }
    let harmless = planted(
        "host/query/volume.rs",
        "if rests { BoundingVolume::Obb } else { BoundingVolume::Linear } // not Obb",
    );
    assert_eq!(knows_a_volume(VOLUMES[2], &harmless), NONE);
}

/// Lines of the pipeline that distinguish kinds of queries.
fn tells_kinds_apart(sources: &[Source]) -> Vec<String> {
    let kinds = ["Discrete", "Continuous", "Earliest", "Near"];
    let apart = |code: &str, kind: &str| {
        code.contains(&format!("Query::{kind}(")) || code.contains(&format!("QueryKind::{kind}"))
    };
    lines(sources, |_, code| kinds.iter().any(|kind| apart(code, kind)))
}

#[test]
fn a_narrow_phase_is_a_file_and_a_line() {
    let found = tells_kinds_apart(&without_tests(rust(&["host/pipeline"])));
    assert_eq!(found.len(), 4, "a line a kind: {found:?}");
    assert!(found.iter().all(|line| line.starts_with("host/pipeline/narrow/mod.rs:")), "{found:?}");
}

#[test]
fn a_second_place_that_tells_kinds_apart_is_noticed() {
    for line in ["if query.kind() == QueryKind::Near {", "Query::Continuous(query) => 64,"] {
        assert_eq!(tells_kinds_apart(&planted("a.rs", line)), [format!("a.rs:1: {line}")]);
    }
    assert_eq!(tells_kinds_apart(&planted("a.rs", "query.kind().is_at_rest() // Query::Near(")), NONE);
}
