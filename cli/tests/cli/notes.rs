//! Parts of a file that its reader skips, leaves out or cuts as it can: notes of `detect`, and
//! `--strict`.

use super::{Folder, err, ok, refused, run, summary};

/// Two triangles that meet.
const MEET: &str = "v 0 0 0\nv 4 0 0\nv 0 4 0\nv 1 1 -1\nv 1 1 1\nv 2 1 1\nv 9 9 9\nf 1 2 3\nf 4 5 6\n";

#[test]
fn a_byte_order_mark_loses_no_vertex() {
    let folder = Folder::new("bom");
    let plain = folder.write("plain.obj", MEET);
    let wanted = summary(&["detect", &plain, "--json", "--strict"]);
    assert_eq!(wanted["contacts"], 1);
    for (name, text) in [("bom.obj", format!("\u{feff}{MEET}")), ("cr.obj", MEET.replace('\n', "\r"))] {
        let found = summary(&["detect", &folder.write(name, &text), "--json", "--strict"]);
        assert_eq!((&found["hash"], &found["notes"]), (&wanted["hash"], &serde_json::json!([])), "{name}");
    }
    let wide = folder.path("wide.obj");
    std::fs::write(&wide, MEET.encode_utf16().flat_map(u16::to_le_bytes).collect::<Vec<_>>())
        .expect("written");
    assert!(refused(3, &["detect", &wide]).contains("wide.obj: is text in UTF-16, little-endian"));
    // A scene, and a file of queries.
    for (name, mark, end) in
        [("a.toml", "\u{feff}", "\n"), ("b.toml", "", "\r"), ("c.toml", "\u{feff}", "\r\n")]
    {
        let scene = folder.write(name, &format!("{mark}[[body]]{end}mesh = \"bom.obj\"{end}"));
        assert_eq!(summary(&["detect", &scene, "--json"])["hash"], wanted["hash"], "{name}");
    }
    let rows = "0,1,0,1,0,1,1\n".repeat(8);
    let asked = |name: &str, text: &str| {
        let file = folder.write(name, text);
        ok(&["explain", "--json", "--between", "vf", "--row", "0", "--queries", &file]).replace(&file, "")
    };
    let wanted = asked("plain.csv", &rows);
    assert_eq!(asked("bom.csv", &format!("\u{feff}{rows}")), wanted);
    assert_eq!(asked("cr.csv", &rows.replace('\n', "\r")), wanted);
}

#[test]
fn notes_are_told_and_strict_refuses_them() {
    let folder = Folder::new("notes");
    let bow = "v 0 0 5\nv 2 2 5\nv 2 0 5\nv 0 2 5\nf 8 9 10 11\n";
    let note = |lines: &str| match lines {
        "f 1 2\n" => "1 face was left out; the first: line 10: a face with 2 corners",
        "curv 0 1 1 2\ncurv 0 1 1 2\n" => "2 lines were not read; the first: line 10 begins with \"curv\"",
        "foo\n" => "1 line was skipped; the first: line 10 begins with \"foo\"",
        _ => {
            "1 face was cut as a fan around the first corner; the first: face 2, with 4 corners, crosses itself"
        }
    };
    for lines in [bow, "f 1 2\n", "curv 0 1 1 2\ncurv 0 1 1 2\n", "foo\n"] {
        let mesh = folder.write("mesh.obj", &format!("{MEET}{lines}"));
        let scene = folder.write("scene.toml", "[[body]]\nmesh = \"mesh.obj\"\n");
        let said = format!("mesh.obj: {}", note(lines));
        for file in [&mesh, &scene] {
            let found = summary(&["detect", file, "--json"]);
            assert!(
                found["contacts"].as_u64() == Some(1)
                    && found["notes"].as_array().is_some_and(|n| n.len() == 1)
            );
            assert!(found["notes"][0].as_str().is_some_and(|text| text.contains(&said)), "{found}");
            assert!(ok(&["detect", file]).contains(&said));
            for command in ["detect", "plan"] {
                let refused = refused(3, &[super::path(command), vec![file.as_str(), "--strict"]].concat());
                let reason = said.split("first: ").last().unwrap_or_default();
                assert!(refused.contains(&format!("mesh.obj: {reason}")), "{refused}");
            }
        }
        let explained = run(&["explain", &mesh, "--tt", "0", "1"]);
        assert!(explained.status.success() && err(&explained).contains(&said), "{}", err(&explained));
        // Several steps print them once.
        let steps = run(&["detect", &mesh, &mesh, &mesh, "--json"]);
        assert_eq!(err(&steps).matches(&said).count(), 1, "{}", err(&steps));
        assert!(refused(3, &["detect", &mesh, &mesh, &mesh, "--strict"]).contains("mesh.obj: "));
    }
    let odd = folder.write("odd.obj", &format!("{MEET}V 1 2 3\n"));
    assert!(refused(3, &["detect", &odd]).contains("odd.obj: line 10 begins with \"V\""));
    assert!(refused(2, &["detect", "--scene", "grid", "--strict"]).contains("--strict"));
}
