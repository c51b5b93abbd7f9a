//! Licences of all that is built in: each must let a program under MIT or Apache-2.0 contain it.

use serde_json::Value;
use spdx::{Expression, ParseMode};
use std::process::Command;

/// Licences that ask no more of who ships a program than to name them.
const ALLOWED: [&str; 9] =
    ["Apache-2.0", "BSD-2-Clause", "BSD-3-Clause", "BSL-1.0", "CC0-1.0", "ISC", "MIT", "Unicode-3.0", "Zlib"];

/// Packages and their licences that are not allowed, of what `cargo metadata` tells.
fn not_allowed(metadata: &Value) -> Vec<String> {
    let packages = metadata["packages"].as_array().map_or(&[][..], Vec::as_slice);
    assert!(packages.len() > 1, "packages");
    let allowed = |licence: &str| {
        // Old packages write `MIT/Apache-2.0`.
        Expression::parse_mode(licence, ParseMode::LAX).is_ok_and(|expression| {
            expression.evaluate(|of| of.license.id().is_some_and(|id| ALLOWED.contains(&id.name)))
        })
    };
    let told =
        packages.iter().map(|package| (&package["name"], package["license"].as_str().unwrap_or("none")));
    told.filter(|(_, licence)| !allowed(licence))
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

#[test]
fn what_may_not_be_is_named() {
    let packages = |licences: &[&str]| {
        let all = licences.iter().map(|licence| serde_json::json!({ "name": "x", "license": licence }));
        serde_json::json!({ "packages": all.chain([serde_json::json!({ "name": "y" })]).collect::<Vec<_>>() })
    };
    let bad = ["GPL-3.0-only", "MIT AND LGPL-2.1-or-later", "(MIT OR Apache-2.0) AND SSPL-1.0", "my own", ""];
    let mut named: Vec<String> = bad.iter().map(|licence| format!("\"x\": {licence}")).collect();
    named.push("\"y\": none".into());
    assert_eq!(not_allowed(&packages(&bad)), named);
    let good =
        ["MIT", "MIT/Apache-2.0", "GPL-3.0-only OR MIT", "Apache-2.0 WITH LLVM-exception", "0BSD OR MIT"];
    assert_eq!(not_allowed(&packages(&good)), ["\"y\": none"]);
}
