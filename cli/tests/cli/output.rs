//! Output that cannot be written: found before the work, reported, and exit 4.

use super::{Folder, err, ok, out, refused, run};
use std::io::Read;
use std::process::{Command, Output, Stdio};

/// Runs the program through a shell that has its arguments as `"$@"`.
fn shell(script: &str, args: &[&str]) -> Output {
    let program = env!("CARGO_BIN_EXE_nearmiss");
    Command::new("sh").args(["-c", script, program]).args(args).output().expect("a shell")
}

#[test]
fn what_cannot_be_written_is_named() {
    let folder = Folder::new("output");
    let scene = ["detect", "--scene", "grid", "--triangles", "16", "--out"];
    let nowhere = folder.path("no/such/folder/a.csv");
    assert!(refused(4, &[&scene[..], &[&nowhere]].concat()).contains("a.csv: cannot be written: "));
    std::fs::create_dir(folder.path("folder.json")).expect("a folder");
    assert!(refused(4, &[&scene[..], &[&folder.path("folder.json")]].concat()).contains("cannot be written"));
    let file = folder.write("file", "");
    assert!(
        refused(4, &["lab", "scene", "grid", "--triangles", "16", "--out", &file])
            .contains("cannot be written")
    );
    // The disk is full: every byte is refused.
    if cfg!(target_os = "linux") {
        std::os::unix::fs::symlink("/dev/full", folder.path("full.csv")).expect("a link");
        let text = refused(4, &[&scene[..], &[&folder.path("full.csv")]].concat());
        assert!(text.contains("full.csv: cannot be written: "), "{text}");
    }
}

const GRID: [&str; 5] = ["detect", "--scene", "grid", "--triangles", "16"];

#[cfg(target_os = "linux")]
#[test]
fn standard_output_that_is_full_or_closed_is_an_error() {
    let folder = Folder::new("full");
    let dir = folder.path("scene");
    let all: [&[&str]; 8] = [
        &GRID,
        &["detect", "--scene", "grid", "--triangles", "16", "--json"],
        &["lab", "plan", "--scene", "grid", "--triangles", "16"],
        &["lab", "scene", "grid", "--triangles", "16", "--out", &dir],
        &[
            "explain",
            "--between",
            "vf",
            "--points",
            "0",
            "0",
            "1",
            "0",
            "0",
            "0",
            "1",
            "0",
            "0",
            "0",
            "1",
            "0",
            "0",
            "0",
            "-1",
            "0",
            "0",
            "0",
            "1",
            "0",
            "0",
            "0",
            "1",
            "0",
        ],
        &["lab", "tables", "--scene", "n-body", "--triangles", "300", "--frames", "2", "--table", "6.12"],
        &["--help"],
        &["detect", "--help"],
    ];
    for args in all {
        let full = shell("\"$0\" \"$@\" > /dev/full", args);
        let text = err(&full);
        assert_eq!(full.status.code(), Some(4), "{args:?}: {text}");
        assert!(text.contains("nearmiss: standard output: cannot be written: "), "{args:?}: {text}");
        // A reader that has gone: the other end of the pipe is closed before the program starts.
        let (reader, writer) = std::io::pipe().expect("a pipe");
        drop(reader);
        let mut child = Command::new(env!("CARGO_BIN_EXE_nearmiss"))
            .args(args)
            .stdout(writer)
            .stderr(Stdio::piped())
            .spawn()
            .expect("the program starts");
        let mut text = String::new();
        child.stderr.take().expect("a pipe").read_to_string(&mut text).expect("text");
        assert_eq!(child.wait().expect("an end").code(), Some(4), "{args:?}: {text}");
        assert!(text.contains("standard output: cannot be written: "), "{args:?}: {text}");
    }
    // If no message can be printed, the status is still right.
    assert_eq!(shell("\"$0\" \"$@\" > /dev/full 2> /dev/full", &GRID).status.code(), Some(4));
    assert_eq!(shell("\"$0\" \"$@\" 2> /dev/full", &["detect", "no.ply"]).status.code(), Some(3));
}

#[test]
fn where_to_write_is_looked_at_before_the_work() {
    let folder = Folder::new("before");
    let (file, nowhere) = (folder.write("file", ""), folder.path("no/such/folder/a.csv"));
    let missing = folder.path("missing.ply");
    let below = format!("{file}/below");
    // Missing meshes are never opened.
    assert!(refused(4, &["detect", &missing, "--out", &nowhere]).contains("a.csv: cannot be written"));
    let tables = ["lab", "tables", "--mesh", &missing, &missing, "--out", &below];
    assert!(refused(4, &tables).contains("cannot be written"));
    let trade = ["lab", "trade", "--mesh", &missing, "--out", &below];
    assert!(refused(4, &trade).contains("cannot be written"));
    // A format that is not known, before either.
    assert!(refused(2, &["detect", &missing, "--out", "a.txt"]).contains(".csv, .json"));
}

#[test]
fn a_good_file_outlives_work_that_fails() {
    let folder = Folder::new("outlives");
    let good = folder.write("good.csv", "good\n");
    let names = || std::fs::read_dir(folder.path("")).expect("a folder").count();
    assert!(refused(3, &["detect", &folder.path("missing.ply"), "--out", &good]).contains("missing.ply"));
    assert_eq!((folder.read("good.csv").as_str(), names()), ("good\n", 1));
    let new = folder.path("new.csv");
    refused(3, &["detect", &folder.path("missing.ply"), "--out", &new]);
    assert_eq!(names(), 1, "nothing is left of a file that was not written");
    // A file may have half a kilobyte: the disk is full in the middle of writing.
    if cfg!(unix) {
        let args = ["detect", "--scene", "grid", "--triangles", "4000", "--out", &good];
        let output = shell("trap '' XFSZ; ulimit -f 1; exec \"$0\" \"$@\"", &args);
        assert_eq!(output.status.code(), Some(4), "{}", err(&output));
        assert!(err(&output).contains("good.csv: cannot be written: "), "{}", err(&output));
        assert_eq!((folder.read("good.csv").as_str(), names()), ("good\n", 1));
    }
    ok(&[&GRID[..], &["--out", &good]].concat());
    assert!(folder.read("good.csv").starts_with("tri_a,tri_b\n") && names() == 1);
}

#[cfg(unix)]
#[test]
fn links_and_pipes_are_written_through() {
    let folder = Folder::new("links");
    let file = folder.write("file.csv", "old\n");
    let link = folder.path("link.csv");
    std::os::unix::fs::symlink(&file, &link).expect("a link");
    ok(&[&GRID[..], &["--out", &link]].concat());
    assert!(std::fs::symlink_metadata(&link).expect("a link").is_symlink());
    assert!(folder.read("file.csv").starts_with("tri_a,tri_b\n"));
    let stdout = folder.path("stdout.csv");
    std::os::unix::fs::symlink("/dev/stdout", &stdout).expect("a link");
    let output = run(&[&GRID[..], &["--out", &stdout]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", err(&output));
    assert!(out(&output).starts_with("tri_a,tri_b\n") && out(&output).contains(" contacts; "));
}
