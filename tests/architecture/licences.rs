//! Licences of everything that is built in: each must let a program under MIT or Apache-2.0 contain
//! it. Packages that only tests use may have any.

use serde_json::Value;
use spdx::{Expression, ParseMode};
use std::collections::HashSet;
use std::process::Command;

/// Allowed licences, from cargo-deny's configuration.
fn allowed() -> Vec<String> {
    let told: toml::Table = include_str!("../../deny.toml").parse().expect("deny.toml is TOML");
    told["licenses"]["allow"].clone().try_into().expect("a list of names")
}

/// A list of `cargo metadata`.
fn list(of: &Value) -> &[Value] {
    of.as_array().map_or(&[], Vec::as_slice)
}

/// The packages that get into what is built: all that is reached from ours without what tests alone use.
fn built_in(metadata: &Value) -> HashSet<&str> {
    let nodes = list(&metadata["resolve"]["nodes"]);
    let mut found = HashSet::new();
    let mut next: Vec<&str> = list(&metadata["workspace_members"]).iter().filter_map(Value::as_str).collect();
    while let Some(id) = next.pop() {
        if !found.insert(id) {
            continue;
        }
        for dependency in nodes.iter().filter(|node| node["id"] == id).flat_map(|node| list(&node["deps"])) {
            let is_used = list(&dependency["dep_kinds"]).iter().any(|kind| kind["kind"] != "dev");
            next.extend(dependency["pkg"].as_str().filter(|_| is_used));
        }
    }
    found
}

/// Packages whose licences are not allowed, by the output of `cargo metadata`.
fn not_allowed(metadata: &Value) -> Vec<String> {
    let built_in = built_in(metadata);
    assert!(built_in.len() > 1, "packages");
    let packages = list(&metadata["packages"]).iter();
    let packages = packages.filter(|package| package["id"].as_str().is_some_and(|id| built_in.contains(id)));
    let names = allowed();
    assert!(names.iter().all(|name| spdx::license_id(name).is_some()), "{names:?}");
    let is_allowed = |licence: &str| {
        // Old packages write `MIT/Apache-2.0`.
        Expression::parse_mode(licence, ParseMode::LAX).is_ok_and(|expression| {
            expression
                .evaluate(|of| of.license.id().is_some_and(|id| names.iter().any(|name| name == id.name)))
        })
    };
    let told = packages.map(|package| (&package["name"], package["license"].as_str().unwrap_or("none")));
    told.filter(|(_, licence)| !is_allowed(licence))
        .map(|(name, licence)| format!("{name}: {licence}"))
        .collect()
}

#[test]
fn what_is_built_in_may_be() {
    let done = Command::new(env!("CARGO"))
        .args(["metadata", "--format-version", "1", "--all-features", "--locked"])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .expect("cargo starts");
    let metadata = serde_json::from_slice(&done.stdout).expect("cargo's JSON");
    assert_eq!(not_allowed(&metadata), Vec::<String>::new());
}

/// Output of cargo for a package `ours` that uses so many others, of these licences, in that way;
/// and one without a licence.
fn told_of(licences: &[&str], kind: &Value) -> Value {
    let licences: Vec<Value> = licences.iter().map(|of| Value::from(*of)).chain([Value::Null]).collect();
    let others = licences.iter().enumerate();
    let package = |(at, of)| serde_json::json!({ "name": "x", "id": at_id(at), "license": of });
    let ours = serde_json::json!({ "name": "ours", "id": "ours", "license": "MIT OR Apache-2.0" });
    let packages: Vec<Value> = others.map(package).chain([ours]).collect();
    let uses = |at| serde_json::json!({ "pkg": at_id(at), "dep_kinds": [{ "kind": kind }] });
    let uses: Vec<Value> = (0..licences.len()).map(uses).collect();
    serde_json::json!({
        "packages": packages,
        "workspace_members": ["ours"],
        "resolve": { "nodes": [{ "id": "ours", "deps": uses }] },
    })
}

fn at_id(at: usize) -> String {
    format!("x@{at}")
}

#[test]
fn what_may_not_be_is_named() {
    let bad = ["GPL-3.0-only", "MIT AND LGPL-2.1-or-later", "(MIT OR Apache-2.0) AND SSPL-1.0", "my own", ""];
    let mut named: Vec<String> = bad.iter().map(|licence| format!("\"x\": {licence}")).collect();
    named.push("\"x\": none".into());
    for kind in [Value::Null, "build".into()] {
        assert_eq!(not_allowed(&told_of(&bad, &kind)), named);
    }
    let good =
        ["MIT", "MIT/Apache-2.0", "GPL-3.0-only OR MIT", "Apache-2.0 WITH LLVM-exception", "0BSD OR MIT"];
    assert_eq!(not_allowed(&told_of(&good, &Value::Null)), ["\"x\": none"]);
    let for_tests = built_in(&told_of(&bad, &"dev".into())).len();
    assert_eq!(for_tests, 1);
}
