//! Standard input and output as files, formats by their first bytes, and all problems of a file.

use super::{Folder, err, ok, out, refused, run};
use flate2::{Compression, write::GzEncoder};
use std::io::Write;
use std::process::{Command, Output, Stdio};

/// Two triangles that cross.
const MESH: &str = "v 0 0 0\nv 4 0 0\nv 0 4 0\nv 1 1 -1\nv 1 2 1\nv 2 1 1\nf 1 2 3\nf 4 5 6\n";

/// Runs the program with these bytes on its standard input.
fn fed(args: &[&str], bytes: &[u8]) -> Output {
    let mut child = Command::new(env!("CARGO_BIN_EXE_nearmiss"))
        .args(args)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("a start");
    // A program that refuses its arguments reads nothing.
    let _ = child.stdin.take().expect("a pipe").write_all(bytes);
    child.wait_with_output().expect("an end")
}

/// The same mesh in other formats.
fn formats() -> Vec<Vec<u8>> {
    let off = "OFF\n6 2 0\n0 0 0\n4 0 0\n0 4 0\n1 1 -1\n1 2 1\n2 1 1\n3 0 1 2\n3 3 4 5\n";
    let facet = |a, b, c| {
        format!("facet normal 0 0 0\nouter loop\nvertex {a}\nvertex {b}\nvertex {c}\nendloop\nendfacet\n")
    };
    let [floor, wall] = [facet("0 0 0", "4 0 0", "0 4 0"), facet("1 1 -1", "1 2 1", "2 1 1")];
    let stl = format!("solid of two\n{floor}{wall}endsolid\n");
    let ply = "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\n\
               element tristrips 1\nproperty list int int vertex_indices\nend_header\n\
               0 0 0\n4 0 0\n0 4 0\n1 1 -1\n1 2 1\n2 1 1\n7 0 1 2 -1 3 4 5\n";
    let mut packer = GzEncoder::new(Vec::new(), Compression::default());
    packer.write_all(MESH.as_bytes()).expect("packed");
    let packed = packer.finish().expect("packed");
    vec![MESH.into(), off.into(), stl.into(), ply.into(), packed]
}

#[test]
fn standard_input_is_a_mesh_of_any_format() {
    let hash = |output: &Output| {
        let told: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
        assert_eq!(told["contacts"], 1, "{told}");
        told["hash"].clone()
    };
    let folder = Folder::new("stdin");
    let known = hash(&run(&["detect", &folder.write("a.obj", MESH), "--json"]));
    for bytes in formats() {
        let done = fed(&["detect", "-", "--json"], &bytes);
        assert_eq!(done.status.code(), Some(0), "{}", err(&done));
        assert_eq!(hash(&done), known);
    }
    let names = ["a.obj", "a.off", "a.stl", "a.ply", "a.obj.gz"];
    for (name, bytes) in names.iter().zip(formats()) {
        let path = folder.path(name);
        std::fs::write(&path, bytes).expect("written");
        assert_eq!(hash(&run(&["detect", &path, "--json"])), known, "{name}");
        assert_eq!(run(&["check", &path]).status.code(), Some(1), "{name}");
    }
    assert!(ok(&["detect", &folder.path("a.stl")]).contains("6 corners were welded to 6 vertices"));
    let both = fed(&["detect", "-", "--with", "-"], MESH.as_bytes());
    assert!(both.status.code() == Some(2) && err(&both).contains("which can be read once"), "{}", err(&both));
    let empty = fed(&["detect", "-"], b"");
    assert!(empty.status.code() == Some(3) && err(&empty).contains("standard input: "), "{}", err(&empty));
}

#[test]
fn standard_output_is_one_file() {
    let folder = Folder::new("stdout");
    let mesh = folder.write("a.obj", MESH);
    let csv = folder.path("a.csv");
    ok(&["detect", &mesh, "--geometry", "--out", &csv]);
    let done = run(&["detect", &mesh, "--geometry", "--out", "-"]);
    assert_eq!((done.status.code(), out(&done)), (Some(0), folder.read("a.csv")));
    assert!(err(&done).starts_with("1 contact; "), "{}", err(&done));
    let ply = folder.path("a.ply");
    ok(&["detect", &mesh, "--out-mesh", &ply]);
    let done = run(&["detect", &mesh, "--out-mesh", "-"]);
    assert!(done.stdout == std::fs::read(&ply).expect("written") && !done.stdout.is_empty());
    // A chain of both: the coloured mesh is a mesh.
    let again = fed(&["check", "-", "--first", "0"], &done.stdout);
    assert!(out(&again).contains("not free: 1 crossing pair\n"), "{}", out(&again));
    let png = run(&["picture", &mesh, "--size", "32x32", "--out", "-"]);
    assert!(png.stdout.starts_with(b"\x89PNG") && err(&png).contains("32x32, 2 triangles"), "{}", err(&png));
    for (command, more, said) in [
        ("detect", &["--out", "-", "--out-mesh", "-"][..], "which holds one file"),
        ("check", &["--out-mesh", "-", "--picture", "-"], "which holds one file"),
        ("detect", &["--out", "-", "--json"], "--json cannot be used with a file on standard output"),
        ("check", &["--picture", "-", "--json"], "--json cannot be used with a file on standard output"),
    ] {
        let text = refused(2, &[&[command, mesh.as_str()][..], more].concat());
        assert!(text.contains(said), "{text}");
    }
    // A reader that has gone is an error.
    let (reader, writer) = std::io::pipe().expect("a pipe");
    drop(reader);
    let mut child = Command::new(env!("CARGO_BIN_EXE_nearmiss"));
    let child = child.args(["detect", &mesh, "--out", "-"]).stdout(writer).stderr(Stdio::piped());
    let ended = child.spawn().expect("a start").wait_with_output().expect("an end");
    assert!(ended.status.code() == Some(4) && err(&ended).contains("standard output: "), "{}", err(&ended));
    assert!(!std::path::Path::new("-").exists());
}

#[test]
fn all_problems_of_a_file_are_listed() {
    let folder = Folder::new("problems");
    let bad = folder.write("bad.obj", "v 0 0 0\nv 1 x 0\nv 0 1 0\nf 1 2 0\nV 1\nf 1 2 3\n");
    let lines = |args: &[&str]| -> Vec<String> {
        let text = refused(3, &[args, &[bad.as_str()]].concat());
        text.lines().map(str::to_owned).collect()
    };
    let all = lines(&["detect", "--problems", "20"]);
    assert_eq!(all.len(), 3, "{all:?}");
    for (line, place) in all.iter().zip(["line 2", "line 4", "line 5"]) {
        assert!(line.starts_with(&format!("nearmiss: {bad}: {place}")), "{line}");
    }
    assert_eq!(lines(&["detect"]), all[..1]);
    assert_eq!(lines(&["detect", "--problems", "2"]), all[..2]);
    assert_eq!(lines(&["check"]), all);
    // Vertices that are not there, in the order of lines.
    let far =
        folder.write("far.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\nf 1 2 8\nf 1 x 3\nf 7 2 3\nl 1 6\n");
    let text = refused(3, &["detect", &far, "--problems", "20"]);
    let places: Vec<bool> =
        text.lines().zip([4, 5, 6, 7, 8]).map(|(text, at)| text.contains(&format!("line {at}:"))).collect();
    assert_eq!((places, text.lines().count()), (vec![true; 5], 5), "{text}");
    assert!(refused(3, &["detect", &far]).contains("line 6:"));
    // Another frame of a good mesh, too.
    let good = folder.write("good.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    let frame = refused(3, &["detect", &good, &bad, "--problems", "20"]);
    assert_eq!(frame.lines().collect::<Vec<_>>(), all);
    let done = fed(&["detect", "-", "--problems", "9"], std::fs::read(&bad).expect("a file").as_slice());
    let said = err(&done).replace("standard input", &bad);
    assert_eq!(said.lines().collect::<Vec<_>>(), all);
}
