//! `detect scene.toml`: bodies of every kind, what a file may say, and what is wrong with it.

mod exclusions;
mod thickness;

use super::{Folder, ok, refused, summary};
use serde_json::Value;

/// A triangle in the plane z = 0, and one that goes through a plane a unit above its tip.
fn meshes(folder: &Folder) {
    folder.write("parts/flat.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    for (name, z) in [("tip", 0), ("tip_up", 1), ("tip_down", -1)] {
        let text = format!("v 0.25 0.25 {z}\nv 0.25 0.5 {}\nv 5 5 {}\nf 1 2 3\n", z + 4, z + 4);
        folder.write(&format!("parts/{name}.obj"), &text);
    }
}

const FLAT: &str = "[[body]]\nname = \"flat\"\nmesh = \"parts/flat.obj\"\n";

/// The flat body and another, which the text describes.
fn beside(folder: &Folder, text: &str) -> String {
    folder.write("scene.toml", &format!("{FLAT}\n[[body]]\nname = \"tip\"\n{text}\n"))
}

#[test]
fn a_rigid_body_moves_as_its_vertices_would() {
    let folder = Folder::new("scene-file");
    meshes(&folder);
    let ask =
        |text: &str, more: &[&str]| summary(&[&["detect", &beside(&folder, text), "--json"], more].concat());
    let poses = "mesh = \"parts/tip.obj\"\nkind = \"rigid\"\n\
        poses = [{ translation = [0, 0, 1] }, { translation = [0.0, 0.0, -1.0], rotation = [0, 0, 0, 1] }]";
    let vertices = "meshes = [\"parts/tip_up.obj\", \"parts/tip_down.obj\"]";
    for more in [&[][..], &["--earliest"], &["--min-separation", "0.125"]] {
        let [a, b] = [ask(poses, more), ask(vertices, more)];
        assert_eq!(a["hash"], b["hash"], "{more:?}");
        assert!(a["earliest_toi"].as_f64().is_some_and(|toi| toi <= 0.5), "{a}");
        assert_eq!((a["frames"].as_u64(), a["notes"].as_array().map(Vec::len)), (Some(2), Some(0)), "{a}");
    }
    // Options for mesh files also apply to scene files.
    let files = ["parts/flat.obj", "parts/tip_up.obj", "parts/tip_down.obj"].map(|name| folder.path(name));
    let [flat, up, down] = files.each_ref().map(String::as_str);
    let two = summary(&["detect", flat, "--with", up, down, "--json"]);
    assert_eq!(ask(vertices, &[])["hash"], two["hash"]);
    // Frames at rest are queried one by one.
    for text in [poses, vertices] {
        let found = ask(text, &["--discrete"]);
        let contacts: Vec<_> =
            found["steps"].as_array().expect("steps").iter().map(|step| step["contacts"].as_u64()).collect();
        assert_eq!(contacts, [Some(0), Some(1)]);
    }
    // A pose alone is where the body rests.
    let rests = "mesh = \"parts/tip.obj\"\nkind = \"rigid\"\nposes = [{ translation = [0, 0, -1] }]";
    assert_eq!(ask(rests, &[])["contacts"], 1);
    assert_eq!(ask("mesh = \"parts/tip_up.obj\"\nkind = \"rigid\"", &[])["contacts"], 0);
    let still = ask(rests, &["--continuous"]);
    let note = still["notes"].as_array().and_then(|notes| notes[0].as_str()).expect("a note");
    assert!(note.contains("nothing moves: there is one frame of every body"), "{note}");
}

#[test]
fn who_meets_whom_is_told() {
    let folder = Folder::new("scene-meets");
    meshes(&folder);
    let contacts = |text: &str| {
        let path = beside(&folder, &format!("mesh = \"parts/tip_down.obj\"\n{text}"));
        summary(&["detect", &path, "--json"])["contacts"].as_u64()
    };
    for (text, expected) in [
        ("", 1),
        ("environment = 1", 0),
        ("environment = \"all\"", 1),
        ("group = 2\nmask = 0xff", 1),
        ("mask = 0", 0),
        ("kind = \"fixed\"", 1),
        ("self_collision = true", 1),
    ] {
        assert_eq!(contacts(text), Some(expected), "{text}");
    }
    let none = beside(&folder, "mesh = \"parts/tip_down.obj\"\ngroup = 0");
    assert!(refused(3, &["detect", &none]).contains("in no group; set `mask = 0`"));
    // One body alone is tested against itself, unless it says that it is not.
    let crossed = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0.2 0.2 -1\nv 0.2 0.3 1\nv 5 5 1\nf 1 2 3\nf 4 5 6\n";
    folder.write("parts/crossed.obj", crossed);
    for (text, expected) in [("", 1), ("self_collision = true", 1), ("self_collision = false", 0)] {
        let path = folder.write("one.toml", &format!("[[body]]\nmesh = \"parts/crossed.obj\"\n{text}\n"));
        assert_eq!(summary(&["detect", &path, "--json"])["contacts"], expected, "{text}");
    }
}

#[test]
fn pairs_that_are_left_out_have_no_rows() {
    let folder = Folder::new("scene-left-out");
    meshes(&folder);
    let bodies = format!(
        "{FLAT}[[body]]\nmesh = \"parts/tip_down.obj\"\n[[body]]\nname = \"tip\"\n\
         meshes = [\"parts/tip_up.obj\", \"parts/tip_down.obj\"]\n"
    );
    let csv = folder.path("rows.csv");
    let rows = |list: &str, more: &[&str]| {
        let scene = folder.write("scene.toml", &format!("{list}\n{bodies}"));
        ok(&[&["detect", scene.as_str(), "--out", &csv], more].concat());
        folder.read("rows.csv")
    };
    for (more, [a, b]) in [
        (&["--discrete"][..], ["flat", "tip_down"]),
        (&["--continuous"], ["flat", "tip"]),
        (&["--near", "0.5"], ["flat", "tip_down"]),
    ] {
        let whole = rows("", more);
        let pair = |row: &&str| [a, b].iter().all(|name| row.split(',').any(|field| field == *name));
        let less: Vec<&str> = whole.lines().filter(|row| !pair(row)).collect();
        assert!(less.len() > 1 && less.len() < whole.lines().count(), "{whole}");
        for list in [format!("[[{b:?}, {a:?}]]"), format!("[[{a:?}, {b:?}], [{b:?}, {a:?}]]")] {
            let found = rows(&format!("leave_out = {list}"), more);
            assert_eq!(found.lines().collect::<Vec<_>>(), less, "{more:?}");
        }
        assert_eq!(rows("leave_out = []", more), whole);
    }
    for (text, said) in [
        (
            format!("leave_out = [[\"tip\", \"flat\"],\n[\"flat\", \"tap\"]]\n{bodies}"),
            "line 2: `leave_out` has the pair [\"flat\", \"tap\"], and no body is named \"tap\"; use the `name`",
        ),
        (
            format!("leave_out = [[\"tip\", \"tip\"]]\n{bodies}"),
            "and that is one body; set its `self_collision`",
        ),
        (format!("leave_out = [[\"tip\"]]\n{bodies}"), "line 1: invalid length 1"),
        (format!("leave_out = [\"tip\"]\n{bodies}"), "line 1: invalid type: string \"tip\""),
        (format!("{bodies}leave_out = [[\"tip\", \"flat\"]]"), "unknown field `leave_out`"),
    ] {
        let message = refused(3, &["detect", &folder.write("bad.toml", &text)]);
        assert!(message.contains("bad.toml: ") && message.contains(said), "{text}: {message}");
    }
}

#[test]
fn rows_name_bodies() {
    let folder = Folder::new("scene-rows");
    meshes(&folder);
    let text = format!(
        "{FLAT}kind = \"fixed\"\n[[body]]\nname = \"a, \\\"quoted\\\"\"\nmesh = \"parts/tip.obj\"\nkind = \"rigid\"\n\
         poses = [{{ translation = [0, 0, 1] }}, {{ translation = [0, 0, -1] }}, {{ translation = [0, 0, -2] }}]\n\
         [[body]]\nmesh = \"parts/tip_down.obj\"\n"
    );
    let scene = folder.write("scene.toml", &text);
    let [csv, json] = ["a.csv", "a.json"].map(|name| folder.path(name));
    ok(&["detect", &scene, "--discrete", "--out", &csv]);
    let rows = folder.read("a.csv");
    let pair = "\"a, \"\"quoted\"\"\"";
    let expected = format!(
        "step,body_a,body_b,tri_a,tri_b\n0,flat,tip_down,0,0\n1,flat,{pair},0,0\n1,flat,tip_down,0,0\n\
         1,{pair},tip_down,0,0\n2,flat,{pair},0,0\n2,flat,tip_down,0,0\n"
    );
    assert_eq!(rows, expected);
    for question in [&["--discrete"][..], &["--continuous"], &["--near", "0.5"], &["--earliest"]] {
        let told = |path: &str| ok(&[&["detect", scene.as_str(), "--out", path], question].concat());
        told(&csv);
        told(&json);
        let whole: Value = serde_json::from_str(&folder.read("a.json")).expect("JSON");
        let mut table = csv::Reader::from_path(&csv).expect("rows");
        let heads = table.headers().expect("a head").clone();
        let column = |name: &str| heads.iter().position(|head| head == name);
        let rows: Vec<csv::StringRecord> = table.records().map(|row| row.expect("a row")).collect();
        let mut at = 0;
        for (number, step) in whole["steps"].as_array().expect("steps").iter().enumerate() {
            let Some(all) = step["contacts"].as_array() else {
                let toi = rows[at][1].parse::<f64>().ok();
                assert_eq!((toi, rows[at][0].to_owned()), (step["contacts"].as_f64(), number.to_string()));
                at += 1;
                continue;
            };
            for row in all {
                assert_eq!(rows[at][0], number.to_string());
                for name in ["body_a", "body_b", "kind", "status", "closest"] {
                    assert_eq!(column(name).map(|column| &rows[at][column]), row[name].as_str(), "{row}");
                }
                let all = [
                    ("feature_a", &row["feature_a"]),
                    ("feature_b", &row["feature_b"]),
                    ("tri_b", &row["triangles"][1]),
                ];
                for (name, of) in all {
                    let cell = column(name).map(|column| rows[at][column].parse().expect("a number"));
                    assert_eq!(cell, of.as_u64(), "{row}");
                }
                at += 1;
            }
        }
        assert_eq!(at, rows.len(), "{question:?}");
        assert!(at > 1, "{question:?}");
    }
    assert!(ok(&["lab", "plan", &scene]).contains("continuous, within and between bodies"));
    // One frame has no column of steps, and a summary as for meshes.
    ok(&["detect", &beside(&folder, "mesh = \"parts/tip_down.obj\""), "--out", &csv, "--repeat", "2"]);
    assert_eq!(folder.read("a.csv"), "body_a,body_b,tri_a,tri_b\nflat,tip,0,0\n");
    ok(&["detect", &beside(&folder, "mesh = \"parts/tip_down.obj\""), "--out", &csv, "--file-faces"]);
    assert_eq!(folder.read("a.csv"), "body_a,body_b,face_a,face_b\nflat,tip,0,0\n");
}

#[test]
fn what_is_wrong_with_a_file_is_named() {
    let folder = Folder::new("scene-wrong");
    meshes(&folder);
    let tip = "mesh = \"parts/tip.obj\"\n";
    let poses = |text: &str| format!("{tip}kind = \"rigid\"\nposes = {text}");
    let body = "body \"tip\" (line 5)";
    let table: Vec<(String, Vec<&str>)> = vec![
        (format!("{tip}colour = 3"), vec![body, "unknown field `colour`", "`self_collision`", "docs/cli.md"]),
        (format!("{tip}kind = \"soft\""), vec![body, "unknown variant `soft`", "`rigid`", "in `kind`"]),
        (format!("{tip}group = -1"), vec![body, "-1", "in `group`"]),
        (format!("{tip}mask = 4294967296"), vec![body, "4294967296", "in `mask`"]),
        (format!("{tip}self_collision = 1"), vec![body, "integer `1`", "boolean", "in `self_collision`"]),
        (
            format!("{tip}environment = \"none\""),
            vec![body, "`environment` must be a number", "got \"none\"", "\"all\""],
        ),
        (format!("{tip}environment = -3"), vec![body, "got -3", "0 to 4294967295"]),
        (format!("{tip}environment = [1]"), vec![body, "`environment` must be", "got of type array"]),
        (format!("{tip}meshes = [\"parts/tip.obj\"]"), vec![body, "`mesh` and `meshes` exclude each other"]),
        ("kind = \"rigid\"".into(), vec![body, "`mesh` is missing", "name a file"]),
        ("meshes = []".into(), vec![body, "`meshes` is empty"]),
        ("mesh = 3".into(), vec![body, "integer `3`", "in `mesh`"]),
        (
            "meshes = [\"parts/tip.obj\", \"parts/tip.obj\"]\nkind = \"fixed\"".into(),
            vec![body, "`meshes` must name one file if the body is fixed, got 2", "make the body deformable"],
        ),
        (
            format!("{tip}poses = [{{}}]"),
            vec![body, "`poses` cannot be used if the body is deformable", "make the body rigid"],
        ),
        (poses("[]"), vec![body, "`poses` is empty"]),
        (poses("[{ spin = 1 }]"), vec![body, "unknown field `spin`", "`turn`", "in `poses`"]),
        (poses("[{ turn = 1 }]"), vec![body, "integer `1`", "`poses.turn`"]),
        (poses("[{ translation = [1, 2] }]"), vec![body, "length 2", "`poses.translation`"]),
        (poses("[{}, { rotation = [0, 0, 0, 2] }]"), vec![body, "frame 1", "2.0]", "unit quaternion"]),
        (poses("[{ translation = [0, nan, 0] }]"), vec![body, "frame 0", "NaN", "finite translation"]),
        (poses("[{ translation = [1e200, 0, 0] }]"), vec![body, "frame 0", "1e200", "2^480"]),
        (format!("{tip}name = 3"), vec!["line 8", "duplicate key"]),
        ("mesh = ".into(), vec!["line 7", "[[body]]"]),
        ("mesh = \"parts/none.obj\"".into(), vec!["none.obj: cannot be read"]),
        ("mesh = \"parts/tip.3mf\"".into(), vec!["tip.3mf: has the extension \"3mf\""]),
        (
            format!("{}\n[[body]]\nmesh = \"parts/tip.obj\"", poses("[{}, {}, {}]")),
            vec!["body \"tip\" (line 10) has the name of body \"tip\" (line 5)", "its own `name`"],
        ),
        (
            format!(
                "{}\n[[body]]\nname = \"c\"\nkind = \"rigid\"\n{tip}poses = [{{}}, {{}}]",
                poses("[{}, {}, {}]")
            ),
            vec![
                "body \"c\" (line 10) has 2 frames, and body \"tip\" (line 5) has 3",
                "as many as the others",
            ],
        ),
    ];
    for (text, said) in table {
        let path = beside(&folder, &text);
        for command in ["detect", "plan"] {
            let message = refused(3, &[super::path(command), vec![path.as_str()]].concat());
            assert_eq!(message.lines().count(), 1, "{message}");
            assert!(
                said[0].ends_with("read") || said[0].contains(".3mf") || message.contains("scene.toml: "),
                "{message}"
            );
            for word in &said {
                assert!(message.contains(word), "{text}: {word} is not in {message}");
            }
        }
    }
    for (text, said) in [
        ("", "has no bodies; add a table"),
        ("[[bodies]]\n", "line 1: unknown field `bodies`, expected one of `body`"),
        ("body = 3\n", "line 1: invalid type: integer `3`"),
        ("[[body]\n", "line 1"),
        ("[[body]]\nkind = \"fixed\"\n", "the body of line 1: `mesh` is missing"),
    ] {
        let message = refused(3, &["detect", &folder.write("bad.toml", text)]);
        assert!(message.contains("bad.toml: ") && message.contains(said), "{text}: {message}");
    }
    std::fs::write(folder.path("binary.toml"), [0xff, 0xfe, 0]).expect("written");
    assert!(refused(3, &["detect", &folder.path("binary.toml")]).contains("binary.toml: is text in UTF-16"));
    assert!(refused(3, &["detect", &folder.path("missing.toml")]).contains("missing.toml: cannot be read"));
    std::fs::create_dir(folder.path("folder.toml")).expect("a folder");
    assert!(refused(3, &["detect", &folder.path("folder.toml")]).contains("it is a directory"));
    let deep = format!("body = {}", "[".repeat(100_000));
    assert!(refused(3, &["detect", &folder.write("deep.toml", &deep)]).contains("deep.toml: "));
}

#[test]
fn many_bodies_are_read_in_their_own_time() {
    let folder = Folder::new("scene-many");
    let body = |name: usize| format!("[[body]]\nname = \"{name}\"\nmesh = \"missing.obj\"\n");
    let all: String = (0..100_000).chain([7]).map(body).collect();
    let (file, start) = (folder.write("many.toml", &all), std::time::Instant::now());
    let text = refused(3, &["detect", &file]);
    assert!(text.contains("body \"7\" (line 300001) has the name of body \"7\" (line 22)"), "{text}");
    // Each compared with each of the others would take minutes.
    assert!(start.elapsed().as_secs() < 20, "{:?}", start.elapsed());
}

#[test]
fn a_scene_stands_alone() {
    let folder = Folder::new("scene-alone");
    meshes(&folder);
    let (scene, flat) = (beside(&folder, "mesh = \"parts/tip.obj\""), folder.path("parts/flat.obj"));
    let [scene, flat] = [&scene, &flat].map(String::as_str);
    for args in [&[scene, flat][..], &[flat, scene], &[scene, scene], &[scene, "--with", flat]] {
        let text = refused(2, &[&["detect"], args].concat());
        assert!(
            text.contains("a scene (.toml) cannot be combined with other files; give it alone"),
            "{args:?}: {text}"
        );
    }
    assert!(refused(2, &["detect", scene, "--rebuild-every", "2"]).contains("--rebuild-every has no effect"));
    assert!(
        refused(3, &["explain", scene, "--vf", "0", "0"])
            .contains("\"toml\", which no reader of meshes knows")
    );
    let moving = beside(&folder, "meshes = [\"parts/tip.obj\", \"parts/tip.obj\", \"parts/tip.obj\"]");
    assert!(refused(2, &["detect", &moving, "--repeat", "2"]).contains("each of several steps runs once"));
}

#[test]
fn the_scene_of_the_programs_page_is_one() {
    let folder = Folder::new("scene-readme");
    let page = include_str!("../../../docs/cli.md");
    let text = page.split("```toml\n").nth(1).and_then(|rest| rest.split("```").next()).expect("a scene");
    for name in ["cloth_0", "cloth_1", "cloth_2", "ball", "ground"] {
        folder.write(&format!("{name}.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    }
    let all = ok(&["detect", &folder.write("scene.toml", &text.replace(".ply", ".obj")), "-v"]);
    assert!(all.starts_with("3 bodies, 3 triangles, 9 vertices, 3 frames; continuous query"), "{all}");
}

#[test]
fn self_collision_is_the_default_of_deformable_bodies() {
    let folder = Folder::new("scene-self");
    let crossed = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0.2 0.2 -1\nv 0.2 0.3 1\nv 5 5 1\nf 1 2 3\nf 4 5 6\n";
    let crossed = folder.write("crossed.obj", crossed);
    let far = folder.write("far.obj", "v 90 0 0\nv 91 0 0\nv 90 1 0\nf 1 2 3\n");
    let contacts = |args: &[&str]| summary(&[&["detect", "--json"], args].concat())["contacts"].as_u64();
    for (text, expected) in [
        ("", 1),
        ("self_collision = true", 1),
        ("self_collision = false", 0),
        ("kind = \"rigid\"", 0),
        ("kind = \"rigid\"\nself_collision = true", 1),
        ("kind = \"fixed\"", 0),
        ("kind = \"fixed\"\nself_collision = false", 0),
    ] {
        let body = format!("[[body]]\nmesh = \"crossed.obj\"\n{text}\n");
        let two = folder.write("two.toml", &format!("{body}[[body]]\nmesh = \"far.obj\"\n"));
        assert_eq!(contacts(&[&two]), Some(expected), "beside another: {text}");
        let one = folder.write("one.toml", &body);
        assert_eq!(contacts(&[&one]), Some(expected), "alone: {text}");
    }
    let fixed = "[[body]]\nmesh = \"far.obj\"\n[[body]]\nmesh = \"crossed.obj\"\nkind = \"fixed\"\nself_collision = true\n";
    let text = refused(3, &["detect", &folder.write("fixed.toml", fixed)]);
    assert!(
        text.contains("body of line 3") && text.contains("a fixed body never collides with itself"),
        "{text}"
    );
    assert_eq!(contacts(&[&crossed, "--with", &far]), Some(1));
    assert_eq!(contacts(&[&far, "--with", &crossed]), Some(1));
    assert_eq!(contacts(&[&far, "--with", &crossed, "--no-self-collision"]), Some(0));
}

#[test]
fn a_turn_and_tolerances_of_bodies_are_told() {
    let folder = Folder::new("scene-turn");
    folder.write("bar.obj", "v -2 0 0\nv 2 0 0\nv 0 0.5 0\nf 1 2 3\n");
    folder.write("ground.obj", "v -3000 -3000 -9\nv 6000 -3000 -9\nv -3000 6000 -9\nf 1 2 3\n");
    let scene = |angle: f64, kind: &str| {
        let (sin, cos) = (angle.to_radians() / 2.0).sin_cos();
        let text = format!(
            "[[body]]\nmesh = \"bar.obj\"\nkind = \"rigid\"\nself_collision = true\n\
             poses = [{{}}, {{ rotation = [0, 0, {sin}, {cos}] }}]\npath = \"straight\"\n[[body]]\nmesh = \"ground.obj\"\nkind = \"{kind}\"\n"
        );
        folder.write("scene.toml", &text)
    };
    let turned = summary(&["detect", &scene(180.0, "fixed"), "--json"]);
    let reason = &turned["caveats"][0];
    assert_eq!((reason["reason"].as_str(), reason["body"].as_u64()), (Some("turned"), Some(0)), "{turned}");
    assert!((reason["bulge"].as_f64().expect("a length") - 2.0).abs() < 1e-9, "{turned}");
    assert!(
        turned["tolerance"].as_f64().expect("a length") < 1e-3 && turned.get("largest_tolerance").is_none()
    );
    let text = ok(&["detect", &scene(90.0, "fixed")]);
    assert!(text.contains("caveat: body 0 turns by 90.0 degrees"), "{text}");
    assert!(!ok(&["detect", &scene(29.9, "fixed")]).contains("turns by"));
    let both = summary(&["detect", &scene(10.0, "deformable"), "--json"]);
    let [least, largest] =
        ["tolerance", "largest_tolerance"].map(|key| both[key].as_f64().expect("a length"));
    assert!(least < 1e-3 && largest > 0.1, "{both}");
    let plan = ok(&["lab", "plan", &scene(10.0, "deformable"), "--backend", "cpu"]);
    assert!(plan.contains(" by the pair of bodies"), "{plan}");
}
