//! Seams and polygons: `--weld`, the hint at it, `--file-faces`.

use super::{err, ok, run, summary};
use support::folder::Folder;

/// A strip of `n` squares as an OBJ file, every square with corners of its own, bent so that neighbours touch in their seam only.
fn seams(n: u32) -> String {
    let square = |k: u32| {
        let corner = |dx: u32, y: u32| format!("v {} {y} {}\n", k + dx, (k + dx) * (k + dx) % 7);
        [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)].concat()
    };
    let face = |k: u32| format!("f {} {} {} {}\n", 4 * k + 1, 4 * k + 2, 4 * k + 3, 4 * k + 4);
    (0..n).map(square).chain((0..n).map(face)).collect()
}

#[test]
fn seams_that_meet_themselves_are_told_and_welded() {
    let folder = Folder::new("weld");
    let strip = folder.write("strip.obj", &seams(600));
    let whole = summary(&["detect", &strip, "--backend", "cpu", "--json"]);
    assert!(whole["contacts"].as_u64().is_some_and(|n| n >= 1_000), "{whole}");
    let notes = whole["notes"].to_string();
    assert!(notes.contains("1198 vertices share their place") && notes.contains("--weld"), "{notes}");

    let welded = run(&["detect", &strip, "--backend", "cpu", "--json", "--weld"]);
    assert!(err(&welded).contains("1198 vertices merged"), "{}", err(&welded));
    let welded: serde_json::Value = serde_json::from_slice(&welded.stdout).expect("JSON");
    assert_eq!((&welded["contacts"], &welded["notes"]), (&0.into(), &serde_json::json!([])), "{welded}");

    // Few contacts are no matter for a hint.
    let short = folder.write("short.obj", &seams(3));
    assert_eq!(summary(&["detect", &short, "--backend", "cpu", "--json"])["notes"], serde_json::json!([]));
}

#[test]
fn contacts_are_told_in_the_faces_of_the_file() {
    let folder = Folder::new("file-faces");
    // A triangle, an L of six corners with a notch, and a needle through the L that also moves down.
    let mesh = |z: f64| {
        format!(
            "v 9 9 9\nv 9 8 9\nv 8 9 9\nv 0 0 0\nv 4 0 0\nv 4 2 0\nv 2 2 0\nv 2 4 0\nv 0 4 0\nv 1 1 {}\nv 1.1 1 {}\nv 1 1.1 {}\n\
             f 1 2 3\nf 4 5 6 7 8 9\nf 10 11 12\n",
            z - 0.5,
            z + 0.5,
            z + 0.5
        )
    };
    let [t0, t1] = [("t0.obj", 0.0), ("t1.obj", -2.0)].map(|(name, z)| folder.write(name, &mesh(z)));
    let [out, plain] = ["faces.csv", "triangles.csv"].map(|name| folder.path(name));
    ok(&["detect", &t0, "--backend", "cpu", "--file-faces", "--out", &out]);
    assert_eq!(folder.read("faces.csv"), "face_a,face_b\n1,2\n");
    ok(&["detect", &t0, "--backend", "cpu", "--out", &plain]);
    assert!(
        folder.read("triangles.csv").lines().skip(1).all(|row| row.ends_with(",5")),
        "four of the L before it"
    );

    ok(&["detect", &t0, &t1, "--continuous", "--backend", "cpu", "--file-faces", "--out", &out]);
    let rows = folder.read("faces.csv");
    // Vertices 10 and 11 come down from above; each meets the L, face 1 of the file, once.
    for vertex in ["10", "11"] {
        let met = rows.lines().filter(|row| row.starts_with(&format!("vf,{vertex},"))).collect::<Vec<_>>();
        assert!(met.len() == 1 && met[0].starts_with(&format!("vf,{vertex},1,")), "{rows}");
    }
    let refused = run(&["detect", &t0, "--file-faces"]);
    assert_eq!(refused.status.code(), Some(2));
    assert!(err(&refused).contains("--out"), "{}", err(&refused));
}
