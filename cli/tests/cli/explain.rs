//! `nearmiss explain`.

use super::{Folder, ok, refused, run, summary};
use flate2::{Compression, write::GzEncoder};
use serde_json::Value;
use std::io::Write;

/// A triangle, and one that falls across it, its first corner at a third of the step.
const T0: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0.25 0.25 1\nv 0.25 0.25 4\nv 0.5 -2 4\nf 1 2 3\nf 4 5 6\n";
const T1: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0.25 0.25 -2\nv 0.25 0.25 1\nv 0.5 -2 1\nf 1 2 3\nf 4 5 6\n";

fn rows(report: &Value) -> Vec<(&str, &str)> {
    let rows = report["solvers"].as_array().expect("rows");
    rows.iter()
        .map(|r| (r["solver"].as_str().unwrap_or_default(), r["judgement"].as_str().unwrap_or_default()))
        .collect()
}

const SOLVERS: [&str; 5] = ["certified", "certified-f32", "certified-f64", "cubic-f64", "cubic-f32"];

#[test]
fn a_vertex_and_a_face_of_a_mesh() {
    let folder = Folder::new("explain-vf");
    let (t0, t1) = (folder.write("t0.obj", T0), folder.write("t1.obj", T1));
    let text = ok(&["explain", &t0, &t1, "--vf", "3", "0"]);
    for part in [
        "vertex 3 of ",
        "and face 0 of ",
        "v    (0.25, 0.25, 1) to (0.25, 0.25, -2)",
        "f2   (0, 1, 0) to (0, 1, 0)",
        "they meet first at t = 1/3, about 0.333",
        "tolerance ",
    ] {
        assert!(text.contains(part), "{part} is not in {text}");
    }
    assert!(SOLVERS.iter().all(|name| text.contains(name)) && !text.contains("MISSED"), "{text}");
    let report = summary(&["explain", &t0, &t1, "--vf", "3", "0", "--json"]);
    assert_eq!(rows(&report).iter().map(|r| r.0).collect::<Vec<_>>(), SOLVERS);
    assert!(rows(&report)[..3].iter().all(|r| r.1 == "right" || r.1 == "early"), "{report}");
    assert_eq!(report["exact"]["fraction"], "1/3");
    let toi: Vec<f64> =
        report["exact"]["toi"].as_array().expect("two").iter().filter_map(Value::as_f64).collect();
    assert!(toi[0].next_up() == toi[1] && toi[0] < 1.0 / 3.0 + 1e-16);
    // The numbers are those of detect.
    let out = folder.path("all.csv");
    ok(&["detect", &t0, &t1, "--out", &out]);
    let contacts = folder.read("all.csv");
    let found = contacts.lines().find(|line| line.starts_with("vf,3,0,")).expect("the contact");
    let toi = found.split(',').nth(3).expect("a time").parse::<f64>().expect("a number");
    assert_eq!(report["solvers"][0]["toi"].as_f64(), Some(toi));
}

/// A seam: welding gives edges other numbers, and explain follows.
#[test]
fn numbers_are_those_of_welded_meshes() {
    let folder = Folder::new("explain-weld");
    let mesh = |name: &str, z: f64| {
        let strip = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\n";
        let rod = format!("v 0.6 -1 {z}\nv 0.6 2 {z}\nv 3 3 {z}\n");
        folder.write(name, &format!("{strip}{rod}f 1 2 3\nf 4 6 5\nf 7 8 9\n"))
    };
    let (t0, t1) = (mesh("t0.obj", 1.0), mesh("t1.obj", -1.0));
    ok(&["detect", &t0, &t1, "--weld", "--out", &folder.path("all.csv")]);
    let contacts = folder.read("all.csv");
    let mut explained = 0;
    for row in contacts.lines().filter(|row| row.starts_with("ee,")) {
        let fields: Vec<&str> = row.split(',').collect();
        let args = ["explain", &t0, &t1, "--ee", fields[1], fields[2], "--json"];
        let toi = |report: Value| report["solvers"][0]["toi"].as_f64();
        let wanted = fields[3].parse::<f64>().ok();
        assert_eq!(toi(summary(&[&args[..], &["--weld"]].concat())), wanted, "{row}");
        explained += u32::from(toi(summary(&args)) != wanted);
    }
    assert!(explained > 0, "without welding the numbers are others: {contacts}");
}

#[test]
fn edges_two_bodies_and_triangles() {
    let folder = Folder::new("explain-ee");
    let (t0, t1) = (folder.write("t0.obj", T0), folder.write("t1.obj", T1));
    let out = folder.path("all.csv");
    ok(&["detect", &t0, &t1, "--out", &out]);
    let contacts = folder.read("all.csv");
    let edges: Vec<&str> = contacts.lines().filter(|line| line.starts_with("ee,")).collect();
    assert!(!edges.is_empty(), "{contacts}");
    for line in edges {
        let cells: Vec<&str> = line.split(',').collect();
        let report = summary(&["explain", &t0, &t1, "--ee", cells[1], cells[2], "--json"]);
        assert_eq!(
            (report["features"].as_str(), report["exact"]["meets"].as_bool()),
            (Some("edge-edge"), Some(true))
        );
    }
    let own = summary(&["explain", &t0, &t1, "--vf", "0", "0", "--json"]);
    assert!(own["notes"].to_string().contains("share a vertex") && own["exact"]["fraction"] == "0");
    let a = folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    let b = folder.write("b.obj", "v 0.25 0.25 -1\nv 0.25 0.25 1\nv 5 5 1\nf 1 2 3\n");
    for (kind, i, j) in [("--vf", "0", "0"), ("--ee", "2", "0"), ("--tt", "0", "0")] {
        let report = summary(&["explain", &a, "--with", &b, kind, i, j, "--json"]);
        assert_eq!(report["exact"]["meets"].as_bool(), Some(kind == "--tt"), "{kind}");
        assert!(report["of"][0].as_str().is_some_and(|of| of.ends_with("a.obj")));
    }
    let text = ok(&["explain", &a, "--with", &b, "--tt", "0", "0"]);
    assert!(text.contains("they meet") && text.contains("exact") && text.contains("moller"), "{text}");
    // A fold: two triangles with a common edge meet beyond it only if they lie on each other.
    let fold = |z: &str, y: &str| format!("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0.5 {y} {z}\nf 1 2 3\nf 1 2 4\n");
    for (name, z, y, meets) in
        [("up.obj", "1", "0", false), ("flat.obj", "0", "0.25", true), ("out.obj", "0", "-1", false)]
    {
        let mesh = folder.write(name, &fold(z, y));
        let report = summary(&["explain", &mesh, "--tt", "0", "1", "--json"]);
        assert_eq!(report["exact"]["meets"].as_bool(), Some(meets), "{name}");
        assert_eq!(rows(&report), [("exact", "right")], "{name}");
    }
}

/// The motion of the public double root on which f32 errs; as numbers, as a file of queries, packed and plain.
#[test]
fn numbers_and_files_of_queries() {
    let points = "0 0 1 0 1 1 0.125 0.25 2 0.125 0.25 -1 1 1 0 0 0 0 0.125 0.25 2 0.125 0.25 -1";
    let numbers: Vec<&str> = points.split(' ').collect();
    let given = summary(&[&["explain", "--between", "ee", "--json", "--points"][..], &numbers].concat());
    assert!(given["exact"]["meets"] == true && given["exact"].get("fraction").is_none(), "{given}");
    let folder = Folder::new("explain-queries");
    let rows = |truth: &str| {
        let eighth = |x: &str| (x.parse::<f64>().expect("a number") * 8.0).to_string();
        let row = |p: &[&str]| format!("{},8,{},8,{},8,{truth}\n", eighth(p[0]), eighth(p[1]), eighth(p[2]));
        numbers.chunks(3).map(row).collect::<String>()
    };
    let text = rows("0") + &rows("1");
    let plain = folder.write("plain.csv", &text);
    std::fs::create_dir_all(folder.path("edge-edge")).expect("a folder");
    let packed = folder.path("edge-edge/packed.csv.gz");
    let mut gz = GzEncoder::new(Vec::new(), Compression::fast());
    gz.write_all(text.as_bytes()).expect("packed");
    std::fs::write(&packed, gz.finish().expect("packed")).expect("written");
    for args in [&[&*plain, "--between", "ee"][..], &[&packed]] {
        for (row, says) in [("0", "by the file they do not meet"), ("1", "by the file they meet")] {
            let report = summary(&[&["explain", "--json", "--row", row, "--queries"], args].concat());
            assert_eq!((&report["exact"], &report["solvers"]), (&given["exact"], &given["solvers"]));
            assert!(report["notes"][0].as_str().is_some_and(|note| note.contains(says)), "{report}");
        }
    }
    for (line, text, named) in [
        (0, "1,2,3", "\"1,2,3\" a row has 7 columns"),
        (3, "1,1,x,1,1,1,0", "\"x\" is no integer"),
        (5, "1,1,1,0,1,1,0", "\"0\" is a denominator"),
        (6, "1,3,1,1,1,1,0", "\"1/3\" is no double"),
        (7, "1,1,1,1,1,1,2", "\"2\" is the answer"),
    ] {
        let whole = rows("0");
        let mut lines: Vec<&str> = whole.lines().collect();
        lines[line] = text;
        let bad = folder.write("bad.csv", &lines.join("\n"));
        let message = refused(3, &["explain", "--between", "ee", "--queries", &bad, "--row", "0"]);
        assert!(message.contains("bad.csv") && message.contains(&format!("line {}", line + 1)), "{message}");
        assert!(message.contains(named), "{message}");
    }
    let message = refused(3, &["explain", "--between", "ee", "--queries", &plain, "--row", "2"]);
    assert!(message.contains("has no query 2: it has 2 of them"), "{message}");
    assert!(refused(2, &["explain", "--queries", &plain, "--row", "0"]).contains("--between vf"));
    let endless = refused(3, &["explain", "--between", "ee", "--queries", "/dev/zero", "--row", "0"]);
    assert!(endless.contains("/dev/zero: cannot be read: it is not a regular file"), "{endless}");
}

#[test]
fn what_there_is_not_is_named() {
    let folder = Folder::new("explain-bad");
    let mesh = folder.write("m.obj", T0);
    for (args, named) in [
        (["--vf", "6", "0"], "m.obj: has no vertex 6: it has 6 of them"),
        (["--vf", "0", "2"], "m.obj: has no face 2: it has 2 of them"),
        (["--ee", "0", "6"], "m.obj: has no edge 6: it has 6 of them"),
        (["--tt", "9", "0"], "m.obj: has no face 9: it has 2 of them"),
    ] {
        let message = refused(3, &[&["explain", &mesh][..], &args].concat());
        assert!(message.contains(named), "{message}");
    }
    let loose = folder.write("loose.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 nan 0\nf 1 2 3\n");
    let message = refused(3, &["explain", &loose, "--vf", "3", "0"]);
    assert!(message.contains("loose.obj") && message.contains("vertex 3 has y = NaN"), "{message}");
    let bad: [&[&str]; 7] = [
        &["explain"],
        &["explain", &mesh],
        &["explain", "--vf", "0", "0"],
        &["explain", &mesh, "--vf", "0"],
        &["explain", &mesh, "--vf", "0", "0", "--ee", "0", "1"],
        &["explain", "--queries", "a.csv"],
        &["explain", "--between", "vf", "--points", "1", "2"],
    ];
    for args in bad {
        assert_eq!(run(args).status.code(), Some(2), "{args:?}");
    }
    let few = refused(2, &["explain", "--between", "vf", "--points", "1", "-2"]);
    assert!(few.contains("--points takes 24 numbers, got 2"), "{few}");
    let points = vec!["inf"; 24];
    let message = refused(3, &[&["explain", "--between", "vf", "--points"][..], &points].concat());
    assert!(message.contains("--points: vertex 0 has x = inf"), "{message}");
    let other = folder.write("other.obj", T0);
    let message = refused(3, &["explain", &mesh, "--with", &other, "--vf", "0", "2"]);
    assert!(message.contains("other.obj: has no face 2: it has 2 of them"), "{message}");
    assert!(
        refused(2, &["explain", &mesh, "--vf", "0", "1", "--tolerance", "nan"])
            .contains("at least 0, got NaN")
    );
}
