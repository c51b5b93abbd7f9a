//! `nearmiss selftest`.

use super::ok;

#[test]
#[ignore = "half a minute"]
fn a_small_selftest_passes() {
    let text = ok(&["selftest", "--backend", "cpu", "--triangles", "300", "--cases", "24"]);
    assert!(text.contains("ok: every stage agrees to the bit"), "{text}");
    assert!(!text.contains("DIFFERS"));
    assert_eq!(text.lines().filter(|line| line.starts_with("extremes ")).count(), 8, "{text}");
}
