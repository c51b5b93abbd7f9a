//! Rules of the architecture. A rule is a function from sources to the lines that break it, so that each can be shown
//! to hold (the repository breaks none) and to be able to fail (a planted line is named).

mod book;
mod choices;
mod comments;
mod doors;
mod figures;
mod licences;
mod package;
mod proofs;
mod prose;
mod robustness;
mod rooms;
mod sources;
mod words;

use nearmiss_kernels::entry::TABLE;
use nearmiss_kernels::{abi, bv};
use sources::{NONE, Source, after, files, lines, planted, rust};
use support::ptx;

// Kernels know no host.

/// The crates that kernels may not use, as the manifests of the library, the lab and the program name them.
fn host_crates() -> Vec<String> {
    let of = |manifest: &str| -> Vec<String> {
        let text = &files(manifest)[0].1;
        let own = text.split("\n[dependencies]\n").nth(1).expect("dependencies").split("\n[").next();
        let names = own.unwrap_or("").lines().filter_map(|line| line.split(['.', ' ']).next());
        names.filter(|name| !name.is_empty()).map(|name| name.replace('-', "_")).collect()
    };
    let all = ["Cargo.toml", "emulator/Cargo.toml", "io/Cargo.toml", "lab/Cargo.toml", "cli/Cargo.toml"]
        .iter()
        .flat_map(|manifest| of(manifest));
    all.filter(|name| name != "bytemuck" && name != "nearmiss_kernels")
        .chain(["std", "alloc", "nearmiss"].map(str::to_owned))
        .collect()
}

fn knows_the_host(sources: &[Source]) -> Vec<String> {
    let crates = host_crates();
    for known in ["rayon", "plotters", "clap", "nearmiss_lab"] {
        assert!(crates.iter().any(|name| name == known), "{crates:?}");
    }
    lines(sources, |_, code| {
        crates.iter().any(|name| after(code, &format!("{name}::")).next().is_some())
            || code.contains("extern crate")
    })
}

#[test]
fn kernels_know_no_host() {
    assert_eq!(knows_the_host(&rust(&["kernels/src"])), NONE);
    let lib = &files("kernels/src/lib.rs")[0].1;
    assert_eq!(lib.lines().next(), Some("#![no_std]"));
}

#[test]
fn a_kernel_that_knows_the_host_is_noticed() {
    for line in [
        "use std::vec::Vec;",
        "nearmiss_lab::scene::grid(1)",
        "use rayon::prelude::*;",
        "extern crate alloc;",
    ] {
        assert_eq!(knows_the_host(&planted("k.rs", &format!("\n{line}"))), [format!("k.rs:2: {line}")]);
    }
    assert_eq!(knows_the_host(&planted("k.rs", "use core::mem; // not std::mem\nmy_std::x()")), NONE);
}

// The oracle shares nothing with what it judges.

fn not_apart(sources: &[Source]) -> Vec<String> {
    const SHARED: [&str; 2] = ["oracle", "case"];
    lines(sources, |_, code| {
        code.contains("nearmiss_kernels")
            || code.contains("nearmiss::")
            || after(code, "crate::").any(|next| !SHARED.contains(&next))
    })
}

#[test]
fn the_oracle_imports_nothing_from_what_it_judges() {
    assert_eq!(not_apart(&rust(&["lab/src/oracle"])), NONE);
}

#[test]
fn an_oracle_that_asks_the_kernels_is_noticed() {
    for line in ["use nearmiss_kernels::math::Vec3;", "use nearmiss::Detector;", "use crate::{pairs};"] {
        assert_eq!(not_apart(&planted("o.rs", line)).len(), 1, "{line}");
    }
    assert_eq!(not_apart(&planted("o.rs", "use crate::case::Case;\nuse crate::oracle::exact;")), NONE);
}

// Stages meet in memory.

/// The modules of the pipeline, as its `mod.rs` lists them.
fn stages() -> Vec<String> {
    let text = &files("kernels/src/stage/mod.rs")[0].1;
    text.lines()
        .filter_map(|line| line.strip_prefix("pub mod ")?.strip_suffix(';'))
        .map(str::to_owned)
        .collect()
}

fn across_stages(sources: &[Source]) -> Vec<String> {
    let stages = stages();
    lines(sources, |name, code| {
        let inside =
            name.trim_start_matches("kernels/src/stage/").split(['/', '.']).next().unwrap_or_default();
        let of = |prefix| {
            after(code, prefix)
                .any(|next| next.is_empty() || (next != inside && stages.iter().any(|s| s == next)))
        };
        inside != "mod"
            && (of("stage::")
                || after(code, "super::").any(|next| next != inside && stages.iter().any(|s| s == next)))
    })
}

#[test]
fn stages_never_import_each_other() {
    assert_eq!(
        stages(),
        [
            "answer",
            "balance",
            "construct",
            "fit",
            "narrow",
            "order",
            "place",
            "refit",
            "starts",
            "status",
            "traverse",
            "turns"
        ]
    );
    assert_eq!(across_stages(&rust(&["kernels/src/stage"])), NONE);
}

#[test]
fn a_stage_that_imports_another_is_noticed() {
    let fit = "kernels/src/stage/fit/leaves.rs";
    for line in ["use crate::stage::refit::refit;", "use super::traverse;", "use crate::stage::{fit, refit};"]
    {
        assert_eq!(across_stages(&planted(fit, line)).len(), 1, "{line}");
    }
    let piece = "kernels/src/stage/construct/treelet.rs";
    assert_eq!(across_stages(&planted(piece, "use super::super::narrow;")).len(), 1);
    assert_eq!(across_stages(&planted(piece, "use super::tree;\nuse crate::stage::construct::tree;")), NONE);
}

// The target is named in two rooms.

fn name_the_target(sources: &[Source]) -> Vec<String> {
    let mut names: Vec<String> = sources
        .iter()
        .filter(|(_, text)| text.contains("target_arch"))
        .map(|(name, _)| name.clone())
        .collect();
    names.sort();
    names
}

#[test]
fn the_target_is_named_in_two_rooms() {
    let rooms = ["kernels/src/entry.rs", "kernels/src/exec/ptx/mod.rs"];
    assert_eq!(name_the_target(&rust(&["kernels"])), rooms);
}

#[test]
fn a_third_room_that_names_the_target_is_noticed() {
    let mut sources = rust(&["kernels"]);
    sources.extend(planted("kernels/src/bv/obb.rs", "#[cfg(target_arch = \"nvptx64\")]"));
    assert!(name_the_target(&sources).contains(&"kernels/src/bv/obb.rs".to_owned()));
}

// Names go end to end.

fn misnamed(kernels: &[&str]) -> Vec<String> {
    // The sort is what several stages do.
    let stages: Vec<_> = stages().into_iter().chain(["sort".into()]).collect();
    let known = |name: &str| {
        name.split_once('_')
            .is_some_and(|(stage, step)| stages.iter().any(|s| s == stage) && !step.is_empty())
    };
    kernels.iter().filter(|name| !known(name)).map(|name| (*name).to_owned()).collect()
}

/// Name and bytes of arguments of every entry of a PTX text, ascending.
fn entries(ptx: &str) -> Vec<(String, usize)> {
    let mut found = Vec::new();
    let mut lines = ptx.lines();
    while let Some(line) = lines.next() {
        let Some(name) = line.trim_start_matches(".visible ").strip_prefix(".entry ") else { continue };
        let bytes = lines.next().and_then(|param| param.rsplit_once('[')?.1.strip_suffix(']')?.parse().ok());
        found.push((name.trim_end_matches('(').to_owned(), bytes.unwrap_or(0)));
    }
    found.sort();
    found
}

#[test]
fn kernels_are_named_by_stage_and_step() {
    let names: Vec<&str> = TABLE.iter().map(|(name, _)| *name).collect();
    assert_eq!(misnamed(&names), NONE);
    assert_eq!(
        misnamed(&["fit_f32", "sort_pass", "fitting_f32", "refit", "sweep_all"]),
        ["fitting_f32", "refit", "sweep_all"]
    );
}

#[test]
fn the_committed_ptx_has_exactly_the_kernels_of_the_table() {
    let mut table: Vec<(String, usize)> =
        TABLE.iter().map(|(name, bytes)| ((*name).to_owned(), *bytes)).collect();
    table.sort();
    assert_eq!(entries(&ptx::committed()), table);
}

#[test]
fn another_entry_or_size_is_noticed() {
    let text = ".visible .entry b(\n\t.param .align 8 .b8 b_param_0[24]\n)\n.visible .entry a(\n\t.param .align 8 .b8 a_param_0[8]\n)";
    assert_eq!(entries(text), [("a".to_owned(), 8), ("b".to_owned(), 24)]);
    assert_eq!(entries(".func (.param .b32 r) f()"), []);
}

/// The sizes that the cards of the stages count with ("8 B pair", "32 B node", "64 B" for two siblings).
#[test]
fn records_have_the_sizes_that_the_cards_count_with() {
    let nodes = [size_of::<abi::Link>(), size_of::<abi::Node<bv::Aabb>>()];
    assert_eq!(nodes, [8, 32]);
    assert_eq!([size_of::<abi::Pair>(), size_of::<abi::Unit>(), size_of::<abi::Hit>()], [8, 8, 32]);
    assert_eq!((size_of::<abi::Inner>(), size_of::<abi::Span<u8>>()), (8, 16));
    assert_eq!((align_of::<abi::Node<bv::Aabb>>(), align_of::<abi::Pair>()), (16, 8));
}
