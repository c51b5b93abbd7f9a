//! `check`: every kind of fault is found where it was planted, and nowhere else.

use super::{Folder, err, out, refused, run};
use nearmiss_io::{Format, MeshFile};
use serde_json::Value;

/// Two triangles that share an edge, apart from everything else.
pub const GOOD: &str = "v 0 0 0\nv 4 0 0\nv 0 4 0\nv 4 4 1\nf 1 2 3\nf 2 4 3\n";

/// The status of a check, and its report as JSON.
pub fn checked(args: &[&str]) -> (i32, Value) {
    let done = run(&[&["check", "--json"], args].concat());
    let status = done.status.code().expect("a status");
    (status, serde_json::from_str(&out(&done)).unwrap_or_else(|e| panic!("{e}: {}", err(&done))))
}

/// The counts of a report, by their keys.
pub fn counts(told: &Value) -> Vec<(&str, u64)> {
    let all = told.as_object().expect("an object").iter();
    let count = |of: &Value| of["count"].as_u64().filter(|count| *count > 0);
    all.filter_map(|(key, of)| count(of).map(|count| (key.as_str(), count))).collect()
}

/// A mesh, its text, and the counts of its faults.
type Case<'a> = (&'a str, &'a str, &'a [(&'a str, u64)]);

#[test]
fn planted_faults_are_found_and_nothing_else() {
    let folder = Folder::new("check-planted");
    // Each fault with the faces that have it, behind the two good ones.
    let cases: [Case; 9] = [
        ("none", "", &[("boundary_edges", 4)]),
        (
            "crossing",
            "v 1 1 -1\nv 1 2 -1\nv 1 1 1\nf 5 6 7\n",
            &[("boundary_edges", 7), ("clusters", 1), ("crossing", 1)],
        ),
        ("overlap", "v .5 .5 0\nv 1 .5 0\nv .5 1 0\nf 5 6 7\n", &[("boundary_edges", 7), ("overlapping", 1)]),
        ("a touched face", "v 1 1 0\nv 1 2 1\nv 2 1 1\nf 5 6 7\n", &[("boundary_edges", 7), ("touching", 1)]),
        (
            "a touching edge",
            "v 1 1 0\nv 1 2 0\nv 2 1 1\nf 5 6 7\n",
            &[("boundary_edges", 7), ("touching", 1)],
        ),
        ("a duplicate", "f 3 2 1\n", &[("duplicate", 1), ("non_manifold_edges", 1), ("boundary_edges", 2)]),
        (
            "no area",
            "v 9 9 9\nv 10 10 10\nv 12 12 12\nf 5 6 7\n",
            &[("boundary_edges", 7), ("degenerate", 1)],
        ),
        ("a third face", "v 2 2 9\nf 2 3 5\n", &[("boundary_edges", 6), ("non_manifold_edges", 1)]),
        ("a fold", "v 1 .5 0\nf 1 2 5\n", &[("boundary_edges", 5), ("overlapping", 1)]),
    ];
    for (name, more, expected) in cases {
        let mesh = folder.write("a.obj", &format!("{GOOD}{more}"));
        let (status, told) = checked(&[&mesh]);
        let mut expected = expected.to_vec();
        expected.sort_unstable();
        assert_eq!(counts(&told), expected, "{name}: {told}");
        let harmless = ["boundary_edges", "non_manifold_edges"];
        let is_free = expected.iter().all(|(key, _)| harmless.contains(key));
        assert_eq!((told["free"].as_bool(), status), (Some(is_free), i32::from(!is_free)), "{name}");
        // Its text has the same counts.
        let text = out(&run(&["check", &mesh]));
        assert_eq!(text.contains("\nfree of faults\n"), is_free, "{text}");
        for (key, count) in expected {
            let key = key.trim_end_matches("_edges").replace('_', "-");
            let line = text.lines().find(|line| line.trim_start().starts_with(key.trim_end_matches('s')));
            assert!(line.is_some_and(|line| line.contains(&format!(" {count} "))), "{key}: {text}");
        }
    }
    // The area is exact: a sliver of a bit is none.
    let sliver = "v 9 9 9\nv 10 10 10\nv 12 12 12.000001\nf 5 6 7\n";
    let (status, told) = checked(&[&folder.write("a.obj", &format!("{GOOD}{sliver}"))]);
    assert_eq!((status, told["degenerate"]["count"].as_u64()), (0, Some(0)));
}

#[test]
fn faces_are_those_of_the_file() {
    let folder = Folder::new("check-faces");
    let quads =
        "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nv 1 1 -1\nv 3 1 -1\nv 3 1 1\nv 1 1 1\nf 1 2 3 4\nf 5 6 7 8\n";
    let mesh = folder.write("quads.obj", quads);
    let (status, told) = checked(&[&mesh]);
    assert_eq!(status, 1);
    assert_eq!(told["meshes"][0]["faces"], 2);
    assert_eq!(told["crossing"]["first"][0]["faces"], serde_json::json!([0, 1]));
    let cluster = &told["clusters"]["first"][0];
    assert_eq!((cluster["pairs"].as_u64(), cluster["faces"].as_u64()), (Some(1), Some(2)));
    assert_eq!(
        (&cluster["low"], &cluster["high"]),
        (&serde_json::json!([1.0, 1.0, 0.0]), &serde_json::json!([3.0, 1.0, 0.0]))
    );
    let text = out(&run(&["check", &mesh]));
    assert!(text.starts_with(&format!("{mesh}: 2 faces, 8 vertices\nnot free: 1 crossing pair\n")), "{text}");
    assert!(text.contains("  crossing      1 pair: 0 and 1\n"), "{text}");
    assert!(text.contains("    cluster     1 pair of 2 faces, from (1, 1, 0) to (3, 1, 0)\n"), "{text}");
}

#[test]
fn meshes_are_checked_against_each_other_or_alone() {
    let folder = Folder::new("check-several");
    let good = folder.write("good.obj", GOOD);
    let wall = folder.write("wall.obj", "v 1 1 -1\nv 1 2 -1\nv 1 1 1\nf 1 2 3\n");
    let (status, told) = checked(&[&good, &wall]);
    let first = &told["crossing"]["first"][0];
    assert_eq!(
        (status, &first["meshes"], &first["faces"]),
        (1, &serde_json::json!([0, 1]), &serde_json::json!([0, 0]))
    );
    assert!(out(&run(&["check", &good, &wall])).contains("1 pair: 0:0 and 1:0"));
    assert_eq!(checked(&[&good, &wall, "--each"]).0, 0);
    // Rods and points are bodies too, with numbers behind those of faces.
    let alone = "v 1 1 -1\nv 1 1 1\nv 9 9 9\np 3\nl 2 1\n";
    let behind = "v 1 1 -1\nv 1 1 1\nv 9 9 9\nv 5 5 5\nv 5 6 5\nv 5 5 6\nf 4 5 6\np 3\nl 2 1\n";
    for (name, text, at) in [("alone.obj", alone, 0), ("behind.obj", behind, 1)] {
        let rod = folder.write(name, text);
        let (status, told) = checked(&[&good, &rod]);
        assert_eq!((status, told["segments"].as_u64(), told["points"].as_u64()), (1, Some(1), Some(1)));
        assert_eq!(told["crossing"]["count"].as_u64(), Some(1), "{told}");
        assert_eq!(told["crossing"]["first"][0]["faces"], serde_json::json!([0, at]), "{told}");
        let painted = folder.path("painted.ply");
        assert_eq!(run(&["check", &good, &rod, "--out-mesh", &painted]).status.code(), Some(1));
    }
}

#[test]
fn a_face_that_repeats_a_vertex_is_degenerate() {
    let folder = Folder::new("check-repeats");
    let vertices = "v 0 0 0\nv 4 0 0\nv 0 4 0\nv 9 9 9\nv 9 9 9\nv 8 9 9\n";
    let told = |faces: &str, more: &[&str]| {
        let mesh = folder.write("a.obj", &format!("{vertices}{faces}"));
        let (status, told) = checked(&[&[mesh.as_str()], more].concat());
        let of = |key: &str| told[key]["count"].as_u64().expect("a count");
        (status, of("degenerate"), of("duplicate"), told["segments"].as_u64().expect("a count"))
    };
    assert_eq!(told("f 1 2 3\n", &[]), (0, 0, 0, 0));
    assert_eq!(told("f 1 2 3\nf 4 6 6\n", &[]), (1, 1, 0, 0));
    assert_eq!(told("f 1 2 3\nf 4 4 4\n", &[]), (1, 1, 0, 0));
    // The same vertices in any order and number.
    assert_eq!(told("f 1 2 3\nf 4 6 6\nf 6 4 4\n", &[]), (1, 2, 1, 0));
    // A corner that is welded away makes no thread.
    for more in [&[][..], &["--weld"]] {
        assert_eq!(told("f 1 2 3\nf 4 5 6\n", more), (1, 1, 0, 0), "{more:?}");
    }
    // A short face counts as a face of the file, wherever it is.
    let mesh = folder.write("short.obj", "v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\nf 1 2\n");
    assert_eq!(checked(&[&mesh]).1["meshes"][0]["faces"], 2);
}

#[test]
fn seams_touch_until_they_are_welded() {
    let folder = Folder::new("check-seams");
    let seam = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 4 6 5\n";
    let mesh = folder.write("seam.obj", seam);
    let (status, told) = checked(&[&mesh]);
    assert_eq!((status, told["touching"]["count"].as_u64()), (1, Some(1)));
    assert!(told["notes"][0].as_str().is_some_and(|note| note.ends_with("; --weld merges them")), "{told}");
    let (status, told) = checked(&[&mesh, "--allow-touching"]);
    assert_eq!((status, told["touching"]["count"].as_u64()), (0, Some(1)));
    let (status, told) = checked(&[&mesh, "--weld"]);
    assert_eq!((status, counts(&told)), (0, vec![("boundary_edges", 4)]));
    assert_eq!(told["notes"].as_array().map(Vec::len), Some(0));
}

#[test]
fn the_first_of_everything_are_listed() {
    let folder = Folder::new("check-first");
    let spikes = |n: usize| {
        let mut text = "v 0 0 0\nv 200 0 0\nv 0 200 0\n".to_owned();
        (0..n).for_each(|at| text += &format!("v {} 1 -1\nv {} 2 -1\nv {} 1 1\n", at + 1, at + 1, at + 1));
        text += "f 1 2 3\n";
        (0..n).for_each(|at| text += &format!("f {} {} {}\n", 3 * at + 4, 3 * at + 5, 3 * at + 6));
        folder.write("spikes.obj", &text)
    };
    let mesh = spikes(25);
    for (first, listed) in [("0", 0), ("7", 7), ("25", 25), ("1000000", 25)] {
        let (_, told) = checked(&[&mesh, "--first", first]);
        assert_eq!(told["crossing"]["count"], 25);
        assert_eq!(told["crossing"]["first"].as_array().map(Vec::len), Some(listed));
        // One face is in all of them.
        assert_eq!(told["clusters"]["count"], 1);
    }
    let text = out(&run(&["check", &mesh]));
    assert!(text.contains("25 pairs: 0 and 1, ") && text.contains("0 and 10, …"), "{text}");
    assert!(refused(2, &["check", &mesh, "--first", "-1"]).contains("give a whole number from 0"));
}

#[test]
fn faults_have_colours() {
    let folder = Folder::new("check-colours");
    let all = "v 0 0 0\nv 9 0 0\nv 0 9 0\nf 1 2 3\nv 1 1 -1\nv 1 2 -1\nv 1 1 1\nf 4 5 6\n\
               v 5 1 0\nv 6 1 0\nv 5 2 0\nv 99 0 0\nv 99 1 0\nv 99 0 1\nf 10 11 12\nf 12 11 10\n\
               v 50 50 50\nv 51 51 51\nv 53 53 53\nf 13 14 15\nv 70 0 0\nv 71 0 0\nv 70 1 0\nv 70 0 0\nv 69 0 1\nv 69 1 1\n\
               f 16 17 18\nf 19 20 21\nv 200 0 0\nv 201 0 0\nv 202 0 0\n";
    let mesh = folder.write("all.obj", all);
    let (ply, png) = (folder.path("all.ply"), folder.path("all.png"));
    let done = run(&["check", &mesh, "--out-mesh", &ply, "--picture", &png]);
    assert_eq!(done.status.code(), Some(1), "{}", err(&done));
    let bytes = std::fs::read(&ply).expect("written");
    let faces = MeshFile::parse("a", Format::Ply, &bytes).expect("a mesh").mesh().face_count();
    let colours: Vec<[u8; 3]> =
        bytes[bytes.len() - 16 * faces..].chunks(16).map(|face| [face[13], face[14], face[15]]).collect();
    let [red, blue, black, orange] = [[210, 30, 30], [40, 90, 220], [20, 20, 20], [240, 160, 30]];
    assert_eq!(colours, [red, red, blue, blue, black, orange, orange]);
    assert_eq!(super::picture::Png::read(&png).0, 1200);
    for (option, name) in [("--out-mesh", "a.obj"), ("--picture", "a.jpg")] {
        assert!(refused(2, &["check", &mesh, option, name]).contains(&format!("{option} must end in .")));
    }
    assert!(refused(2, &["check", &ply, "--out-mesh", &ply]).contains("--out-mesh would overwrite"));
}
