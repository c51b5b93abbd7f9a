//! Where public test data lies: its sources and licences are in docs/accuracy.md. It is not part of the project.

use std::io::Write;
use std::path::PathBuf;

/// A file or folder of the public test data: below `NEARMISS_DATA`, else beside the repository. Where it is absent the
/// test that asks says so and skips; with `NEARMISS_REQUIRE_DATA`, as in CI, that is a failure.
pub fn data(path: &str) -> Option<PathBuf> {
    let root = std::env::var_os("NEARMISS_DATA")
        .map_or_else(|| PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/data")), PathBuf::from);
    let path = root.join(path);
    if path.exists() {
        return Some(path);
    }
    let absent = format!("no {} (set NEARMISS_DATA to the folder of public test data)", path.display());
    assert!(std::env::var_os("NEARMISS_REQUIRE_DATA").is_none(), "required: {absent}");
    // Not `eprintln!`, which the test harness swallows where a test passes: a skipped test must not look green.
    let _ = writeln!(std::io::stderr(), "skipped: {absent}");
    None
}
