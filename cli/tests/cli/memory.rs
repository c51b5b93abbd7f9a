//! Memory that ends: exit 4 with a message, never an abort.
#![cfg(target_os = "linux")]

use super::Folder;
use std::process::Command;

/// Runs the program with so many kilobytes of addresses; the exit status, none where it was killed, and what it said.
fn within(kilobytes: u32, args: &[&str]) -> (Option<i32>, String) {
    let script = format!("ulimit -v {kilobytes}; exec \"$0\" \"$@\"");
    let program = env!("CARGO_BIN_EXE_nearmiss");
    let output = Command::new("sh").args(["-c", &script, program]).args(args).output().expect("a shell");
    (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned())
}

#[test]
fn what_is_too_large_is_refused_before_it_is_made() {
    let folder = Folder::new("too-large");
    let dir = folder.path("scene");
    let huge = "134217728";
    let all: [&[&str]; 9] = [
        &["detect", "--scene", "soup", "--triangles", huge],
        &["detect", "--scene", "balls", "--triangles", huge],
        &["detect", "--scene", "n-body", "--triangles", huge],
        &["lab", "plan", "--scene", "cloth-ball", "--triangles", huge],
        &["lab", "scene", "draped", "--triangles", huge, "--out", &dir],
        &["lab", "tables", "--scene", "n-body", "--triangles", huge],
        &["lab", "tables", "--scene", "n-body", "--triangles", "20000", "--frames", "10000"],
        &["lab", "trade", "--cases", "1000000"],
        &["selftest", "--triangles", huge],
    ];
    for args in all {
        let (code, text) = within(2_000_000, args);
        assert_eq!(code, Some(4), "{args:?}: {text}");
        assert!(text.contains("bytes were needed"), "{args:?}: {text}");
    }
    // A file of which nothing is there but its size; and a header that promises what the file does not hold.
    let sparse = folder.path("sparse.ply");
    std::fs::File::create(&sparse).and_then(|file| file.set_len(1 << 40)).expect("a sparse file");
    let (code, text) = within(2_000_000, &["detect", &sparse]);
    assert!(code == Some(4) && text.contains("reading ") && text.contains("bytes were needed"), "{text}");
    let header = "ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nproperty float x\nproperty float y\n\
        property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
    let promise = folder.write("promise.ply", header);
    let (code, text) = within(2_000_000, &["detect", &promise]);
    assert!(code == Some(3) && text.contains("promise.ply"), "{text}");
}

#[test]
fn memory_that_ends_anywhere_is_no_abort() {
    let mut seen = Vec::new();
    let mut ask = |scene: &str, triangles: &str| {
        // The number of threads is given, since each takes addresses.
        let fixed = ["--backend", "cpu", "--threads", "2"];
        let asked = [&["detect", "--scene", scene, "--triangles", triangles], &fixed[..]].concat();
        let (code, text) = within(500_000, &asked);
        assert!(code == Some(0) || code == Some(4), "{scene}, {triangles}: {code:?} {text}");
        // Memory ended, or the answer was refused by its count.
        let is_said = ["bytes were needed", "bytes are needed"].iter().any(|said| text.contains(said));
        assert!(code == Some(0) || is_said, "{scene}, {triangles}: {text}");
        seen.push(code);
    };
    for scene in ["soup-moving", "draped"] {
        for triangles in ["2000", "20000", "60000", "100000", "200000", "600000"] {
            ask(scene, triangles);
        }
    }
    // Few triangles, and a list of millions of pairs.
    ask("identical", "1500");
    assert!(seen.contains(&Some(0)) && seen.contains(&Some(4)), "{seen:?}");
}

/// Threads need memory, too: where they cannot be started that is said.
#[test]
fn threads_that_cannot_be_started_are_no_panic() {
    let mut seen = std::collections::BTreeSet::new();
    let mut kilobytes = 14_000;
    // More cores want more stacks: up to where it works.
    while !seen.contains("done") {
        assert!(kilobytes < 16_000_000, "{seen:?}");
        let asked = ["detect", "--scene", "draped", "--triangles", "200", "--backend", "cpu"];
        let (code, text) = within(kilobytes, &asked);
        // Below some size the system does not load the program.
        let loads = !matches!(code, None | Some(127)) && !text.contains("shared libraries");
        match code {
            _ if !loads => {}
            Some(0) => drop(seen.insert("done")),
            Some(4) => drop(seen.insert(if text.contains("starting ") { "threads" } else { "memory" })),
            _ => panic!("{kilobytes} kB: {code:?} {text}"),
        }
        kilobytes += kilobytes / 16;
    }
    assert!(seen.contains("threads"), "{seen:?}");
}
