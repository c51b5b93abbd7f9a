//! Places of contacts: `--geometry`, `.vtp`, `--out-mesh`, `.gz`. Completions and manuals.

use super::{Folder, ok, refused};
use flate2::{Compression, read::GzDecoder, write::GzEncoder};
use std::io::{Read, Write};

/// A rod over a triangle, and a point next to it.
const MESH: &str = "v 0 0 0\nv 4 0 0\nv 0 4 0\nv 1 1 1\nv 2 1 1\nf 1 2 3\nf 4 5 5\n";

fn packed(text: &[u8]) -> Vec<u8> {
    let mut gz = GzEncoder::new(Vec::new(), Compression::default());
    gz.write_all(text).expect("memory takes all");
    gz.finish().expect("memory takes all")
}

/// The numbers of an array of a `.vtp`.
fn array(vtp: &str, name: &str) -> Vec<f64> {
    let start = vtp.find(&format!("Name=\"{name}\"")).unwrap_or_else(|| panic!("{name} in {vtp}"));
    let text = vtp[start..].split('>').nth(1).expect("values").trim_end_matches("</DataArray");
    text.split_whitespace().map(|x| x.parse().expect("a number")).collect()
}

/// The data of a PLY whose head ends with `line`.
fn behind<'a>(ply: &'a [u8], line: &str) -> &'a [u8] {
    let head = format!("{line}end_header\n").into_bytes();
    let at = ply.windows(head.len()).position(|part| part == head).expect("such a head");
    &ply[at + head.len()..]
}

#[test]
fn places_stand_behind_the_other_columns() {
    let folder = Folder::new("places");
    let mesh = folder.write("mesh.obj", MESH);
    let asked = ["detect", &mesh, "--backend", "cpu", "--near", "1", "--out"];
    ok(&[&asked[..], &[&folder.path("a.csv"), "--geometry"]].concat());
    let csv = folder.read("a.csv");
    let mut lines = csv.lines();
    let head = lines.next().expect("a head");
    assert!(head.starts_with(
        "kind,feature_a,feature_b,squared_distance,closest,owner_0,owner_1,owner_2,owner_3,vertex_0"
    ));
    let first = "vf,3,0,1,vertex-face,0,0,0,0,3,0,1,2,1,0.5,0.25,0.25,1,1,1,1,1,0,1,0,0,1";
    assert_eq!(lines.next(), Some(first));
    ok(&[&asked[..], &[&folder.path("a.json"), "--geometry"]].concat());
    let told: serde_json::Value = serde_json::from_str(&folder.read("a.json")).expect("JSON");
    let row = &told["contacts"][0];
    assert_eq!(
        (&row["kind"], &row["geometry"]["points"][0]),
        (&"vf".into(), &serde_json::json!([1.0, 1.0, 1.0]))
    );
    assert_eq!(row["geometry"]["normal"], serde_json::json!([0.0, 0.0, 1.0]));
    ok(&[&asked[..], &[&folder.path("a.vtp")]].concat());
    let vtp = folder.read("a.vtp");
    assert!(vtp.contains("NumberOfPoints=\"4\" NumberOfVerts=\"0\" NumberOfLines=\"2\""), "{vtp}");
    assert_eq!(array(&vtp, "points")[..6], [1.0, 1.0, 1.0, 1.0, 1.0, 0.0]);
    assert_eq!((array(&vtp, "feature_a"), array(&vtp, "distance")), (vec![3.0, 4.0], vec![1.0, 1.0]));
}

#[test]
fn what_touches_is_a_vertex_and_steps_are_told_apart() {
    let folder = Folder::new("touches");
    let at =
        |z: f64| MESH.replace("1 1 1\n", &format!("1 1 {z}\n")).replace("2 1 1\n", &format!("2 1 {z}\n"));
    let files = [1.0, -1.0, 1.0].map(|z| folder.write(&format!("{z}{}.obj", folder.name().len()), &at(z)));
    let vtp = folder.path("a.vtp");
    ok(&["detect", &files[0], &files[1], &files[2], "--backend", "cpu", "--out", &vtp]);
    let text = folder.read("a.vtp");
    let (rows, steps) = (array(&text, "row"), array(&text, "step"));
    assert_eq!(rows.len(), steps.len());
    assert!(steps.contains(&0.0) && steps.contains(&1.0), "{text}");
    assert_eq!(array(&text, "toi").len(), rows.len());
    let touching = folder.write("touching.obj", &at(0.0));
    ok(&["detect", &touching, "--backend", "cpu", "--near", "0.5", "--out", &vtp]);
    assert!(folder.read("a.vtp").contains("NumberOfVerts=\"2\" NumberOfLines=\"0\""));
}

/// A floor of two triangles, a post through it, and one that stands on it.
const POSTS: &str = "v 0 0 0\nv 8 0 0\nv 8 8 0\nv 0 8 0\nv 1 3 -1\nv 2 3 1\nv 1 3 1\nv 5 2 0\nv 6 2 0\nv 5 2 2\n\
                     f 1 2 3\nf 1 3 4\nf 5 6 7\nf 8 9 10\n";

#[test]
fn triangles_have_kinds_segments_and_curves() {
    let folder = Folder::new("curves");
    let mesh = folder.write("mesh.obj", POSTS);
    let asked = ["detect", &mesh, "--backend", "cpu", "--out"];
    ok(&[&asked[..], &[&folder.path("a.csv"), "--geometry"]].concat());
    let rows = "tri_a,tri_b,kind,x_0,y_0,z_0,x_1,y_1,z_1,error\n\
                0,3,segment,5,2,0,6,2,0,0\n1,2,crossing,1,3,0,1.5,3,0,0.00000000000000033306690738754696\n";
    assert_eq!(folder.read("a.csv"), rows);
    ok(&[&asked[..], &[&folder.path("a.json"), "--geometry"]].concat());
    let told: serde_json::Value = serde_json::from_str(&folder.read("a.json")).expect("JSON");
    let geometry = &told["contacts"][0]["geometry"];
    assert_eq!((&geometry["kind"], &geometry["error"]), (&"segment".into(), &0.0.into()), "{told}");
    assert_eq!(geometry["parts"], serde_json::json!([[0, 4], [0, 5]]), "{told}");
    ok(&[&asked[..], &[&folder.path("a.vtp")]].concat());
    let vtp = folder.read("a.vtp");
    assert!(vtp.contains("NumberOfPoints=\"4\" NumberOfVerts=\"0\" NumberOfLines=\"2\""), "{vtp}");
    assert_eq!(array(&vtp, "points"), [1.0, 3.0, 0.0, 1.5, 3.0, 0.0, 5.0, 2.0, 0.0, 6.0, 2.0, 0.0]);
    assert_eq!((array(&vtp, "kind"), array(&vtp, "group")), (vec![0.0, 2.0], vec![0.0, -1.0]));
    assert_eq!((array(&vtp, "row"), array(&vtp, "is_closed")), (vec![1.0, 1.0, 0.0, 0.0], vec![0.0, 0.0]));
    assert!(ok(&["detect", &mesh, "--backend", "cpu", "--only-crossing"]).starts_with("1 contact; "));
    ok(&[&asked[..], &[&folder.path("b.csv"), "--only-crossing"]].concat());
    assert_eq!(folder.read("b.csv"), "tri_a,tri_b\n1,2\n");
    // Frames: each has its curves.
    ok(&["detect", &mesh, &mesh, &mesh, "--discrete", "--backend", "cpu", "--out", &folder.path("c.vtp")]);
    let vtp = folder.read("c.vtp");
    assert_eq!(array(&vtp, "step"), [0.0, 0.0, 1.0, 1.0, 2.0, 2.0]);
}

#[test]
fn files_of_places_are_refused_where_there_are_none() {
    let grid = ["detect", "--scene", "grid", "--triangles", "16"];
    for more in [&["--out", "a.vtp"][..], &["--out", "a.csv", "--geometry"]] {
        let first = [&grid[..], &["--earliest"], more].concat();
        assert!(refused(2, &first).contains("add --first-contacts, or use --continuous or --near"));
        let by_float = [&grid[..], &["--solver", "moller"], more].concat();
        assert!(refused(2, &by_float).contains("remove --solver moller"));
    }
    let near = [&grid[..], &["--near", "1", "--out", "a.vtp", "--geometry"]].concat();
    assert!(refused(2, &near).contains("--geometry has no effect"));
    assert!(refused(2, &[&grid[..], &["--out-mesh", "a.obj"]].concat()).contains(".ply or .ply.gz"));
}

#[test]
fn what_meets_is_red() {
    let folder = Folder::new("red");
    let mesh = folder.write("mesh.obj", "v 0 0 0\nv 4 0 0\nv 0 4 0\nv 1 1 -1\nv 1 1 1\nv 2 1 1\nv 9 9 9\nv 8 9 9\nv 9 8 9\nf 1 2 3\nf 4 5 6\nf 7 8 9\n");
    let ply = folder.path("out.ply");
    for more in [&["--discrete"][..], &["--near", "1"]] {
        ok(&[&["detect", &mesh, "--backend", "cpu", "--out-mesh", &ply], more].concat());
        let bytes = std::fs::read(&ply).expect("written");
        let faces = &behind(&bytes, "property uchar blue\n")[9 * 12..];
        let colours: Vec<&[u8]> = faces.chunks(16).map(|face| &face[13..]).collect();
        assert_eq!(colours, [[210, 30, 30], [210, 30, 30], [190, 190, 190]], "{more:?}");
        // It is a mesh as any other.
        assert!(ok(&["detect", &ply, "--backend", "cpu"]).starts_with("1 contact; "));
    }
}

/// A point that meets a triangle's border alone stays undecided.
#[test]
fn what_may_meet_is_orange() {
    let folder = Folder::new("orange");
    let at = |z: f64| format!("v 0 0 0\nv 4 0 0\nv 0 4 0\nv 1 0 {z}\nf 1 2 3\nf 4 4 4\n");
    let files = [folder.write("t0.obj", &at(1.0)), folder.write("t1.obj", &at(-1.0))];
    let (ply, csv) = (folder.path("out.ply"), folder.path("out.csv"));
    let asked = ["detect", &files[0], &files[1], "--backend", "cpu"];
    ok(&[&asked[..], &["--out-mesh", &ply, "--out", &csv]].concat());
    assert!(folder.read("out.csv").lines().skip(1).all(|row| row.ends_with(",undecided")));
    let bytes = std::fs::read(&ply).expect("written");
    assert_eq!(bytes[bytes.len() - 3..], [240, 160, 30]);
}

#[test]
fn places_of_a_sequence_have_their_steps_and_names() {
    let folder = Folder::new("places-of-steps");
    folder.write("tri.obj", "v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\n");
    let scene = "[[body]]\nname = \"ground\"\nkind = \"fixed\"\nmesh = \"tri.obj\"\n\
         [[body]]\nname = \"flake\"\nkind = \"rigid\"\nmesh = \"tri.obj\"\n\
         poses = [{ translation = [0.5, 0.5, 3] }, { translation = [0.5, 0.5, -1] }, { translation = [0.5, 0.5, 1] }]\n";
    let (scene, csv, json) = (folder.write("scene.toml", scene), folder.path("a.csv"), folder.path("a.json"));
    for out in [&csv, &json] {
        ok(&["detect", &scene, "--backend", "cpu", "--geometry", "--out", out]);
    }
    let text = folder.read("a.csv");
    let rows: Vec<Vec<&str>> = text.lines().map(|row| row.split(',').collect()).collect();
    assert_eq!(rows[0][..4], ["step", "body_a", "body_b", "kind"]);
    assert!(rows.len() > 2 && rows.iter().all(|row| row.len() == rows[0].len()), "{text}");
    let steps: Vec<&str> = rows[1..].iter().map(|row| row[0]).collect();
    assert!(steps.contains(&"0") && steps.contains(&"1"), "{steps:?}");
    let names = |row: &[&str]| std::collections::BTreeSet::from([row[1].to_owned(), row[2].to_owned()]);
    let both = std::collections::BTreeSet::from(["flake".to_owned(), "ground".to_owned()]);
    assert!(rows[1..].iter().all(|row| names(row) == both), "{text}");
    let told: serde_json::Value = serde_json::from_str(&folder.read("a.json")).expect("JSON");
    let normal = &told["steps"][1]["contacts"][0]["geometry"]["normal"];
    assert_eq!(normal.as_array().map(Vec::len), Some(3), "{told}");
    // A file holds one mesh.
    let several = refused(2, &["detect", &scene, "--out-mesh", &folder.path("a.ply")]);
    assert!(several.contains("--out-mesh must have a # for the number of each of 2 frames"), "{several}");
}

#[test]
fn a_rigid_body_is_coloured_where_it_is() {
    let folder = Folder::new("rigid-red");
    folder.write("tri.obj", "v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\n");
    let scene = "[[body]]\nname = \"a\"\nkind = \"fixed\"\nmesh = \"tri.obj\"\n\
         [[body]]\nname = \"b\"\nkind = \"rigid\"\nmesh = \"tri.obj\"\nposes = [{ translation = [0.5, 0.5, 3] }]\n";
    let (scene, ply, vtp) =
        (folder.write("scene.toml", scene), folder.path("out.ply"), folder.path("out.vtp"));
    ok(&["detect", &scene, "--backend", "cpu", "--distance", "--out-mesh", &ply, "--out", &vtp]);
    let bytes = std::fs::read(&ply).expect("written");
    let points = behind(&bytes, "");
    let number = |at: usize| f64::from_le_bytes(points[at..at + 8].try_into().expect("eight bytes"));
    let heights: Vec<f64> = (0..6).map(|vertex| number(24 * vertex + 16)).collect();
    assert_eq!(heights, [0.0, 0.0, 0.0, 3.0, 3.0, 3.0]);
    let text = folder.read("out.vtp");
    // Two triangles: the number after the last kind of features.
    let triangles = f64::from(nearmiss::contacts::Kind::Ee as u8 + 1);
    assert_eq!((array(&text, "distance"), array(&text, "kind")), (vec![3.0], vec![triangles]));
    assert_eq!(array(&text, "normal")[..3], [0.0, 0.0, -1.0]);
}

#[test]
fn packed_files_are_read_and_written() {
    let folder = Folder::new("packed");
    let mesh = folder.write("mesh.obj", MESH);
    let gz = folder.path("mesh.obj.gz");
    std::fs::write(&gz, packed(MESH.as_bytes())).expect("written");
    let near = |mesh: &str, out: &str| ok(&["detect", mesh, "--backend", "cpu", "--near", "1", "--out", out]);
    near(&mesh, &folder.path("a.csv"));
    near(&gz, &folder.path("b.csv.gz"));
    let mut text = String::new();
    let bytes = std::fs::read(folder.path("b.csv.gz")).expect("written");
    GzDecoder::new(&bytes[..]).read_to_string(&mut text).expect("packed");
    assert_eq!(text, folder.read("a.csv"));
    let painted = folder.path("painted.ply.gz");
    ok(&["detect", &gz, "--backend", "cpu", "--out-mesh", &painted]);
    assert!(ok(&["detect", &painted, "--backend", "cpu"]).starts_with("0 contacts; "));
    // Damaged, cut short, and of no known format.
    let good = packed(MESH.as_bytes());
    for bad in [&good[..good.len() / 2], b"no gz", &[&good[..], b"more"].concat()] {
        std::fs::write(&gz, bad).expect("written");
        let text = refused(3, &["detect", &gz]);
        assert!(text.contains("mesh.obj.gz: its gz data cannot be unpacked: "), "{text}");
    }
    assert!(refused(3, &["detect", &folder.write("a.txt.gz", "")]).contains("\"txt\""));
}

#[test]
fn shells_and_manuals_know_the_commands() {
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let text = ok(&["completions", shell]);
        assert!(["detect", "selftest", "out-mesh"].iter().all(|word| text.contains(word)), "{shell}");
    }
    refused(2, &["completions", "csh"]);
    let page = ok(&["man"]);
    assert!(page.contains(".TH nearmiss 1") && page.contains("detect"), "{page}");
    assert!(ok(&["man", "detect"]).contains("out\\-mesh"));
    assert!(ok(&["man", "lab", "bench"]).contains("question"));
    assert!(refused(2, &["man", "nothing"]).contains("use one of: detect"));
    assert!(refused(2, &["man", "bench"]).contains("COMMAND is unknown, got bench"));
}
