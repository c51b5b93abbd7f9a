//! One thing is no plural.

use super::{Folder, ok, refused};

#[test]
fn one_is_singular_and_two_are_not() {
    let folder = Folder::new("words");
    let a = folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    let b = folder.write("b.obj", "v 0.25 0.25 -1\nv 0.25 0.25 1\nv 5 5 1\nf 1 2 3\n");
    let one = ok(&["detect", &a, "-v"]);
    assert!(
        one.starts_with("0 contacts; ")
            && one.contains("scene       1 triangle, 3 vertices\n")
            && one.contains(" 0 triangle pairs, 0 candidates\n"),
        "{one}"
    );
    let both = ok(&["detect", &a, "--with", &b, "-v"]);
    assert!(both.starts_with("1 contact; ") && both.contains("2 triangles, 6 vertices\n"), "{both}");
    assert!(both.contains(" 1 triangle pair, 1 candidate\n"), "{both}");
    let plan = ok(&["lab", "plan", &a, "--backend", "cpu", "--threads", "1"]);
    assert!(plan.contains(": 1 triangle, 3 vertices,") && plan.contains("CPU, 1 thread (cpu)"), "{plan}");
    let written = ok(&["lab", "scene", "single", "--out", &folder.path("out")]);
    assert!(written.ends_with(": 1 triangle\n"), "{written}");
    assert!(
        refused(2, &["lab", "scene", "soup", "--frames", "2", "--out", &folder.path("out")])
            .contains("--frames must be at most 1 for the scene soup, got 2")
    );
}
