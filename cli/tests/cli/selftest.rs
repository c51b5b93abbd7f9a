//! `nearmiss selftest`.

use super::ok;
use std::io::{BufRead, BufReader};
use std::process::{Command, Stdio};

#[test]
fn the_first_lines_come_before_the_work_is_done() {
    // Thousands of cases a family take minutes; the test reads the first lines.
    let mut child = Command::new(env!("CARGO_BIN_EXE_nearmiss"))
        .args(["selftest", "--backend", "cpu", "--triangles", "300", "--cases", "1000000"])
        .stdout(Stdio::piped())
        .spawn()
        .expect("the program starts");
    let out = BufReader::new(child.stdout.take().expect("a pipe"));
    let lines: Vec<String> = out.lines().take(3).map(|line| line.expect("text")).collect();
    assert!(lines[0].contains("selftest on CPU") && lines[1].starts_with("known answer"), "{lines:?}");
    assert!(lines[2].contains(" contact"), "{lines:?}");
    assert!(child.try_wait().expect("a state").is_none(), "it is still at work");
    child.kill().expect("killed");
    child.wait().expect("an end");
}

#[test]
#[ignore = "half a minute"]
fn a_small_selftest_passes() {
    let text = ok(&["selftest", "--backend", "cpu", "--triangles", "300", "--cases", "24"]);
    assert!(text.contains("ok: every stage agrees to the bit"), "{text}");
    assert!(!text.contains("DIFFERS"));
    assert_eq!(text.lines().filter(|line| line.starts_with("extremes ")).count(), 8, "{text}");
}
