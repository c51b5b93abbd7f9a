//! SIGINT and SIGTERM during any work: status 130 and 143, one line, no half file.

use super::Folder;
use std::io::Read;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// The program at work, silent but for standard error.
fn start(args: &[&str]) -> Child {
    let mut program = Command::new(env!("CARGO_BIN_EXE_nearmiss"));
    program.args(args).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().expect("the program starts")
}

/// Sends a signal; status, what was said, and how long it took.
fn end(mut program: Child, signal: &str) -> (Option<i32>, String, Duration) {
    let sent = Instant::now();
    let done = Command::new("kill").args([signal, &program.id().to_string()]).status().expect("kill");
    assert!(done.success(), "the program had ended before {signal}");
    let status = program.wait().expect("ended");
    let took = sent.elapsed();
    let mut said = String::new();
    program.stderr.take().expect("piped").read_to_string(&mut said).expect("text");
    (status.code(), said, took)
}

/// Files of a folder: those that are being made too.
fn files(folder: &Path) -> Vec<String> {
    let names = std::fs::read_dir(folder).expect("a folder");
    names.map(|file| file.expect("a file").file_name().to_string_lossy().into_owned()).collect()
}

#[test]
fn every_command_ends_by_a_signal() {
    let folder = Folder::new("interrupted");
    std::fs::create_dir(folder.path("out")).expect("a folder");
    let out = folder.path("out");
    let csv = folder.path("out/a.csv");
    // A mesh that takes seconds to read.
    let mut obj = String::from("v 0 0 0\nv 1 0 0\nv 0 1 0\n");
    obj.push_str(&"f 1 2 3\n".repeat(3_000_000));
    let obj = folder.write("large.obj", &obj);
    let commands: [&[&str]; 8] = [
        &["detect", "--scene", "identical", "--triangles", "20000", "--out", &csv],
        &["detect", "--scene", "cloth-ball", "--triangles", "92230", "--repeat", "1000", "--out", &csv],
        &["detect", &obj, "--out", &csv],
        &["lab", "trade", "--full", "--out", &out],
        &["lab", "tables", "--out", &out],
        &["lab", "bench", "--out", &out],
        &["selftest"],
        &["lab", "plan", "--scene", "identical", "--triangles", "20000"],
    ];
    for (at, command) in commands.into_iter().enumerate() {
        let (signal, status) = if at % 2 == 0 { ("-INT", 130) } else { ("-TERM", 143) };
        let program = start(command);
        std::thread::sleep(Duration::from_millis(300));
        let (code, said, took) = end(program, signal);
        assert_eq!(code, Some(status), "{command:?}: {said}");
        let last = said.lines().last().unwrap_or_default();
        assert!(last.starts_with("nearmiss: ended by SIG"), "{command:?}: {said}");
        assert!(took < Duration::from_secs(5), "{command:?}: {took:?}");
        assert_eq!(files(Path::new(&out)), [""; 0], "{command:?}");
    }
}

#[test]
fn rows_that_are_half_written_go() {
    let folder = Folder::new("half-written");
    for (name, before) in [("new.csv", None), ("old.csv", Some("what was there"))] {
        let csv = folder.path(name);
        if let Some(text) = before {
            std::fs::write(&csv, text).expect("written");
        }
        let scene = ["detect", "--scene", "identical", "--triangles", "1600", "--out", &csv];
        let program = start(&scene);
        // Until there is a part of the answer.
        let parent = Path::new(&csv).parent().expect("a folder");
        let is_begun = |name: &String| {
            name.starts_with(".nearmiss-")
                && std::fs::metadata(parent.join(name)).is_ok_and(|file| file.len() > 0)
        };
        let start = Instant::now();
        while !files(parent).iter().any(is_begun) {
            assert!(start.elapsed() < Duration::from_secs(300), "no rows are written");
            std::thread::sleep(Duration::from_millis(1));
        }
        let (code, said, _) = end(program, "-INT");
        assert_eq!(code, Some(130), "{said}");
        assert_eq!(std::fs::read_to_string(&csv).ok().as_deref(), before, "as it was before");
        assert!(files(parent).iter().all(|name| !name.starts_with(".nearmiss-")), "{:?}", files(parent));
    }
}
