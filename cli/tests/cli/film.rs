//! Films: files with numbers, frames that cannot be used, and what fails a run.

use super::{Folder, err, ok, out, refused, run, summary};
use serde_json::Value;

/// A triangle that falls through a floor: frames 1001 to 1004 at heights 3, 1, -1 and -3.
pub fn falling(folder: &Folder) -> Vec<String> {
    let floor = "v 0 0 0\nv 9 0 0\nv 0 9 0\n";
    let frame = |(at, z): (usize, f64)| {
        let text = format!("{floor}v 1 1 {z}\nv 2 1 {z}\nv 1 2 {}\nf 1 2 3\nf 4 5 6\n", z + 1.0);
        folder.write(&format!("cloth_v2.{}.obj", 1001 + at), &text)
    };
    [3.0, 1.0, -0.5, -3.0].into_iter().enumerate().map(frame).collect()
}

fn detect<'a>(files: &'a [String], more: &[&'a str]) -> Vec<&'a str> {
    let files = files.iter().map(String::as_str);
    std::iter::once("detect").chain(files).chain(more.iter().copied()).collect()
}

/// Rows of a CSV by the names of their columns.
fn rows(text: &str) -> Vec<Vec<(String, String)>> {
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let head = reader.headers().expect("a head").clone();
    let row = |row: csv::Result<csv::StringRecord>| {
        head.iter().map(str::to_owned).zip(row.expect("as long").iter().map(str::to_owned)).collect()
    };
    reader.records().map(row).collect()
}

fn field<'a>(row: &'a [(String, String)], name: &str) -> &'a str {
    &row.iter().find(|(own, _)| own == name).unwrap_or_else(|| panic!("{name} of {row:?}")).1
}

#[test]
fn rows_and_lines_name_files_and_frames() {
    let folder = Folder::new("film");
    let files = falling(&folder);
    let [csv, json] = ["a.csv", "a.json"].map(|name| folder.path(name));
    let text = ok(&detect(&files, &["--discrete", "--out", &csv]));
    assert!(text.contains(&format!("frame 1003 ({}): 1 contact; ", files[2])), "{text}");
    assert!(text.contains("1 contact in 4 frames, first in frame 1003; "), "{text}");
    let all = rows(&folder.read("a.csv"));
    assert_eq!(all.len(), 1);
    let named = ["step", "frame", "file"].map(|name| field(&all[0], name));
    assert_eq!(named, ["2", "1003", &files[2]]);
    // The JSON has the same, and what is printed.
    let printed = summary(&detect(&files, &["--discrete", "--out", &json, "--json"]));
    let written: Value = serde_json::from_str(&folder.read("a.json")).expect("JSON");
    for step in [&printed["steps"][2], &written["steps"][2], &written["steps"][2]["summary"]] {
        assert_eq!((step["step"].as_u64(), step["frame"].as_u64()), (Some(2), Some(1003)), "{step}");
        assert_eq!(step["file"].as_str(), Some(&files[2][..]));
    }
    // A step has the number of its start.
    let text = ok(&detect(&files, &[]));
    assert!(text.contains(&format!("step 1002 ({}): ", files[1])), "{text}");
    assert!(text.contains(", first in step 1002 at t = "), "{text}");
}

#[test]
fn two_frames_at_rest_are_a_film() {
    let folder = Folder::new("film-two");
    let files = falling(&folder);
    let (free, crosses) = (&files[0], &files[2]);
    for query in [&["--discrete"][..], &["--near", "0.1"], &["--distance"]] {
        let args = [&["detect", free, crosses][..], query, &["--fail-on", "contacts"]].concat();
        let done = run(&args);
        assert_eq!(done.status.code(), Some(1), "{query:?}");
        assert!(out(&done).contains("frame 1003"), "{}", out(&done));
    }
    assert_eq!(run(&["detect", free, free, "--discrete", "--fail-on", "contacts"]).status.code(), Some(0));
    // In motion they are one step.
    assert!(!ok(&["detect", free, crosses]).contains("step"));
    let pairs = ok(&[&["detect", free, crosses][..], &["--near", "1"]].concat());
    assert!(pairs.contains("pairs in 2 frames"), "{pairs}");
}

#[test]
fn gaps_are_notes() {
    let folder = Folder::new("film-gaps");
    let mut files = falling(&folder);
    assert_eq!(err(&run(&detect(&files, &["--discrete"]))), "");
    let far = folder.path("cloth_v2.1009.obj");
    std::fs::copy(&files[3], &far).expect("copied");
    files.push(far);
    let said = err(&run(&detect(&files, &["--discrete"])));
    assert!(said.contains("4 frames are missing; the first between 1004 ("), "{said}");
    files.swap(0, 2);
    let said = err(&run(&detect(&files, &["--discrete"])));
    assert!(said.contains(" comes after frame 1003; give files in order"), "{said}");
}

#[test]
fn bad_frames_are_passed_over_and_named() {
    let folder = Folder::new("film-bad");
    let good = falling(&folder);
    let other = folder.write("cloth_v2.1005.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    let torn = folder.write("cloth_v2.1000.obj", "v 0 0\n");
    let missing = folder.path("cloth_v2.1006.obj");
    let files = [vec![torn.clone()], good.clone(), vec![other.clone(), missing.clone()]].concat();
    let [csv, json] = ["a.csv", "a.json"].map(|name| folder.path(name));
    // Without the option the first bad one ends the run.
    assert!(refused(3, &detect(&files, &["--discrete"])).contains("cloth_v2.1000.obj: line 1"));
    for (question, tested) in [("--discrete", 4), ("--near=0.5", 4), ("--continuous", 3), ("--earliest", 3)] {
        let done = run(&detect(&files, &[question, "--keep-going", "--out", &csv]));
        assert_eq!(done.status.code(), Some(3), "{}", err(&done));
        let text = out(&done);
        assert!(text.contains(&format!("({torn}): not tested: {torn}: line 1")), "{text}");
        assert!(text.contains(" vertices, but the first frame"), "{text}");
        let untested = text.lines().filter(|line| line.contains(": not tested: ")).count();
        assert_eq!(untested, files.len() - 4, "{question}: {text}");
        // Each has a row with the reason, and answers are those of the good frames alone.
        let all = rows(&folder.read("a.csv"));
        let reasons = all.iter().filter(|row| !field(row, "reason").is_empty());
        let steps: Vec<&str> = reasons.map(|row| field(row, "frame")).collect();
        assert_eq!(steps.len(), untested, "{question}");
        assert!(
            steps.starts_with(&["1000"]) && steps.ends_with(&[if tested == 4 { "1006" } else { "1005" }])
        );
        let json_of = |files: &[String], code, more: &[&str]| -> Vec<Value> {
            let done = run(&[&detect(files, &[question, "--out", &json, "--json"])[..], more].concat());
            assert_eq!(done.status.code(), Some(code), "{}", err(&done));
            let mut whole: Value = serde_json::from_str(&folder.read("a.json")).expect("JSON");
            let printed: Value = serde_json::from_str(&out(&done)).expect("JSON");
            let reasons = |all: &Value| -> Vec<Value> {
                all["steps"].as_array().expect("steps").iter().map(|step| step["reason"].clone()).collect()
            };
            assert_eq!(reasons(&whole), reasons(&printed));
            whole["steps"].as_array_mut().expect("steps").drain(..).collect()
        };
        let (partial, whole) = (json_of(&files, 3, &["--keep-going"]), json_of(&good, 0, &[]));
        let rows_of = |steps: &[Value]| -> Vec<Value> {
            let tested = steps.iter().filter(|step| step["reason"].is_null());
            tested.map(|step| step["contacts"].clone()).collect()
        };
        assert_eq!(rows_of(&partial), rows_of(&whole), "{question}");
        assert_eq!(rows_of(&whole).len(), tested);
    }
    // If all are bad there is nothing to test.
    let none = [torn.clone(), missing.clone(), missing];
    assert!(refused(3, &detect(&none, &["--keep-going"])).contains("cloth_v2.1000.obj: line 1"));
    // Good frames leave the status as it is.
    ok(&detect(&good, &["--discrete", "--keep-going"]));
    assert!(refused(2, &detect(&good[..2], &["--keep-going"])).contains("--keep-going has no effect"));
}

#[test]
fn a_run_fails_if_something_meets() {
    let folder = Folder::new("film-fails");
    let files = falling(&folder);
    let status = |files: &[String], more: &[&str]| {
        let done = run(&[&detect(files, &["--fail-on", "contacts"])[..], more].concat());
        done.status.code().unwrap_or_else(|| panic!("{}", err(&done)))
    };
    let through = folder.write("through.obj", "v 1 1 -1\nv 1 1 2\nv 1 2 2\nf 1 2 3\n");
    // One frame, a step that meets, one that starts crossing and rests, and sequences.
    for (files, more, expected) in [
        (&files[..1], &[][..], 0),
        (&files[2..3], &[], 1),
        (&files[..2], &[], 0),
        (&files[1..3], &[], 1),
        (&files[..3], &["--discrete"], 1),
        (&files[..3], &["--near", "1e-9"], 1),
        (&files[..2], &["--near", "0.1"], 0),
        (&files[..], &[], 1),
        (&files[..], &["--earliest"], 1),
        (&files[..1], &["--with", &through, "--distance"], 1),
        (&files[3..], &["--with", &files[3], "--distance"], 1),
    ] {
        assert_eq!(status(files, more), expected, "{files:?} {more:?}");
    }
    let still = [files[2].clone(), files[2].clone()];
    assert_eq!(status(&still, &[]), 1, "it starts crossing");
    assert_eq!(status(&still, &["--assume-free"]), 0, "which was not looked at");
    // A frame that cannot be tested counts for more.
    let torn = folder.write("cloth_v2.1005.obj", "v 0\n");
    assert_eq!(status(&[files, vec![torn]].concat(), &["--discrete", "--keep-going"]), 3);
    assert!(refused(2, &["detect", "a.obj", "--fail-on", "weather"]).contains("contacts"));
}

#[test]
fn frames_at_rest_say_if_cloth_is_in_itself() {
    let folder = Folder::new("film-in-itself");
    let files = falling(&folder);
    let text = ok(&detect(&files, &["--near", "0.2"]));
    assert!(text.contains("1 triangle pair meets; "), "{text}");
    assert!(text.contains("; triangles meet in 1 frame, first in 1003; "), "{text}");
    let all = summary(&detect(&files, &["--near", "0.2", "--json"]));
    let crossing = |step: usize| all["steps"][step]["crossing"].as_u64();
    assert_eq!([0, 1, 2, 3].map(crossing), [0, 0, 1, 0].map(Some));
    // It is what the discrete query lists, and changes no row.
    let discrete = summary(&detect(&files, &["--discrete", "--json"]));
    for step in 0..4 {
        assert_eq!(discrete["steps"][step]["contacts"].as_u64(), crossing(step));
        assert!(discrete["steps"][step]["crossing"].is_null());
    }
}

#[test]
fn scenes_name_frames_by_patterns() {
    let folder = Folder::new("film-globs");
    let frame = |at: usize| {
        let text = format!("v 0 0 {at}\nv 1 0 {at}\nv 0 1 {at}\nf 1 2 3\n");
        folder.write(&format!("shots/cloth.{at}.obj"), &text)
    };
    (8..12).for_each(|at| drop(frame(at)));
    folder.write("shots/.cloth.7.obj", "v 0\n");
    folder.write("floor.obj", "v 0 0 9\nv 1 0 9\nv 0 1 9.5\nf 1 2 3\n");
    let body = |meshes: &str| {
        let floor = "[[body]]\nmesh = \"floor.obj\"\nkind = \"fixed\"\n";
        folder.write("scene.toml", &format!("{floor}[[body]]\nname = \"cloth\"\nmeshes = {meshes}\n"))
    };
    let listed =
        "[\"shots/cloth.8.obj\", \"shots/cloth.9.obj\", \"shots/cloth.10.obj\", \"shots/cloth.11.obj\"]";
    let lines = |meshes: &str| -> Vec<String> {
        let text = ok(&["detect", &body(meshes), "--discrete", "--json"]);
        let all: Value = serde_json::from_str(&text).expect("JSON");
        let steps = all["steps"].as_array().expect("steps");
        steps.iter().map(|step| format!("{} {} {}", step["frame"], step["file"], step["hash"])).collect()
    };
    let known = lines(listed);
    assert!(known.len() == 4 && known[1].starts_with("9 ") && known[2].contains("cloth.10.obj"), "{known:?}");
    for pattern in ["\"shots/cloth.*.obj\"", "[\"shots/cloth.[89].obj\", \"s*/cloth.1?.obj\"]"] {
        assert_eq!(lines(pattern), known, "{pattern}");
    }
    let said = |meshes: &str| refused(3, &["detect", &body(meshes)]);
    assert!(
        said("\"shots/cloak.*.obj\"")
            .contains("body \"cloth\" (line 4): no file matches \"shots/cloak.*.obj\"")
    );
    assert!(said("\"shots/***\"").contains("which is malformed"));
    assert!(said("7").contains("must be a pattern such as"));
    // A file whose name is a pattern is that file.
    folder.write("a[1].obj", "v 0 0 9\nv 1 0 9\nv 0 1 9\nf 1 2 3\n");
    ok(&["detect", &body("[\"a[1].obj\"]")]);
    // Bad frames of a scene are passed over too.
    folder.write("shots/cloth.9.obj", "v 0\n");
    let done = run(&["detect", &body("\"shots/cloth.*.obj\""), "--discrete", "--keep-going"]);
    assert_eq!(done.status.code(), Some(3), "{}", err(&done));
    assert!(out(&done).contains("cloth.9.obj): not tested: "), "{}", out(&done));
}
