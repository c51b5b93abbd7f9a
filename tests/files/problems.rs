//! All problems of a file in one go.

use nearmiss_io::{Format, MeshFile};

fn problems(format: Format, text: &str, most: usize) -> Vec<String> {
    let all = MeshFile::parse_problems("a", format, text.as_bytes(), most).expect("a list");
    all.iter().map(ToString::to_string).collect()
}

/// The planted places are named, in the file's order, and no other.
fn names(format: Format, text: &str, planted: &[&str]) {
    let all = problems(format, text, 20);
    assert_eq!(all.len(), planted.len(), "{all:?}");
    for (problem, place) in all.iter().zip(planted) {
        assert!(problem.contains(place), "{place}: {all:?}");
    }
    // Fewer are the first of them; the first is the one that reading returns.
    for most in 1..planted.len() {
        assert_eq!(problems(format, text, most), all[..most]);
    }
    let error = MeshFile::parse("a", format, text.as_bytes()).expect_err("refused").to_string();
    assert_eq!(error, format!("a: {}", all[0]));
}

#[test]
fn every_bad_line_is_named() {
    names(
        Format::Obj,
        "v 0 0 0\nv 1 x 0\nv 0 1 0\nf 1 2 0\nV 1\nf 1 2 3\nf 1 2 -9\nf 3 2 one\n",
        &["line 2", "line 4", "line 5", "line 7", "line 8"],
    );
    names(
        Format::Off,
        "OFF 3 3 0\n0 0 0\n1 0 q\n0 1 0\n3 0 1 3\n3 0 1 2\n3 0 1\n",
        &["line 3", "line 5", "line 7"],
    );
    let head = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
                element face 3\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n";
    names(Format::Ply, &format!("{head}3 0 1 3\n3 0 1 2\n3 -1 1 2\n"), &["face 0", "face 2"]);
}

#[test]
fn every_bad_vertex_is_named() {
    let text = "v 0 nan 0\nv 1 0 0\nv 0 1 inf\nv 0 nan 9\nf 1 2 3\n";
    names(Format::Obj, text, &["vertex 0", "vertex 2"]);
    // All references to vertices that never come are named, in the order of their lines.
    let all = problems(Format::Obj, "v 0 0 0\nf 1 2 3\nf 1 2 9\n", 20);
    let places: Vec<&str> = all.iter().filter_map(|problem| problem.split(',').next()).collect();
    let of = |line: u32, vertex: u32| format!("line {line}: vertex index {vertex}");
    assert_eq!(places, [of(2, 2), of(2, 3), of(3, 2), of(3, 9)]);
}

#[test]
fn a_good_file_has_none() {
    assert!(problems(Format::Obj, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2\nfoo\n", 20).is_empty());
    assert_eq!(problems(Format::Obj, "v 0 0 0\n", 20).len(), 1);
    assert_eq!(problems(Format::Stl, "solid\n", 20).len(), 1);
    let missing = MeshFile::problems(std::path::Path::new("no/such.obj"), 20);
    assert!(missing.expect_err("refused").to_string().contains("no/such.obj"));
}
