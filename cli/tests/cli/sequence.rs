//! `detect` of more than two frames: each step's answer is that of the step alone.

use super::{Folder, err, ok, out, refused, run, summary};
use serde_json::Value;
use std::process::{Command, Stdio};

/// Frames of balls that meet, as files.
fn frames(folder: &Folder, count: usize) -> Vec<String> {
    let dir = folder.path("");
    ok(&["lab", "scene", "n-body", "--triangles", "600", "--frames", &count.to_string(), "--out", &dir]);
    (0..count).map(|frame| folder.path(&format!("n-body_{frame:04}.ply"))).collect()
}

fn with<'a>(files: &'a [String], more: &[&'a str]) -> Vec<&'a str> {
    let files = files.iter().map(String::as_str);
    std::iter::once("detect").chain(files).chain(more.iter().copied()).collect()
}

const QUESTIONS: [&[&str]; 4] = [&["--continuous"], &["--earliest"], &["--discrete"], &["--near", "0.02"]];

#[test]
fn each_step_is_answered_as_alone() {
    let folder = Folder::new("sequence");
    let files = frames(&folder, 4);
    let mut contacts = 0;
    for question in QUESTIONS {
        let at_rest = ["--discrete", "--near"].contains(&question[0]);
        let fixed: &[&str] = if at_rest { &[] } else { &["--tolerance", "1e-6"] };
        let more = [question, fixed, &["--json", "--backend", "cpu"]].concat();
        let all = summary(&with(&files, &more));
        let steps = all["steps"].as_array().expect("steps");
        let alone: Vec<&[String]> =
            if at_rest { files.chunks(1).collect() } else { files.windows(2).collect() };
        assert_eq!(steps.len(), alone.len(), "{question:?}");
        for (at, (step, files)) in steps.iter().zip(alone).enumerate() {
            let one = summary(&with(files, &more));
            for key in ["hash", "contacts", "earliest_toi", "frames", "triangles", "tolerance", "distance"] {
                assert_eq!(step[key], one[key], "{question:?}, step {at}, {key}");
            }
            assert_eq!(step["starts_crossing"], one["starts_crossing"], "{question:?}, step {at}");
            assert_eq!(step["starts_crossing"].is_null(), at_rest, "{question:?}, step {at}");
            assert_eq!(step["step"], at);
            contacts += one["contacts"].as_u64().expect("a number");
        }
        // A rebuilt tree finds the same.
        let anew = summary(&with(&files, &[&more[..], &["--rebuild-every", "2"]].concat()));
        let hashes = |all: &Value| -> Vec<Value> {
            all["steps"].as_array().expect("steps").iter().map(|step| step["hash"].clone()).collect()
        };
        assert_eq!(hashes(&anew), hashes(&all), "{question:?}");
    }
    assert!(contacts > 100, "{contacts}");
}

#[test]
fn rows_tell_their_step() {
    let folder = Folder::new("sequence-rows");
    let files = frames(&folder, 3);
    let [csv, json] = ["a.csv", "a.json"].map(|name| folder.path(name));
    for question in QUESTIONS {
        let at_rest = ["--discrete", "--near"].contains(&question[0]);
        let fixed: &[&str] = if at_rest { &[] } else { &["--tolerance", "1e-6"] };
        let (mut rows, mut objects) = (String::new(), Vec::new());
        let alone: Vec<&[String]> =
            if at_rest { files.chunks(1).collect() } else { files.windows(2).collect() };
        for (step, files) in alone.into_iter().enumerate() {
            ok(&with(files, &[question, fixed, &["--out", &csv]].concat()));
            let text = folder.read("a.csv");
            let (head, own) = text.split_once('\n').expect("a head");
            if step == 0 {
                rows = format!("step,frame,file,{head}\n");
            }
            let first = &files[0];
            rows.extend(own.lines().map(|line| format!("{step},{step},{first},{line}\n")));
            if own.is_empty() && question == ["--earliest"] {
                rows.push_str(&format!("{step},{step},{first},\n"));
            }
            ok(&with(files, &[question, fixed, &["--out", &json]].concat()));
            objects.push(
                serde_json::from_str::<Value>(&folder.read("a.json")).expect("JSON")["contacts"].take(),
            );
        }
        let people = ok(&with(&files, &[question, fixed, &["--out", &csv, "-v"]].concat()));
        assert_eq!(folder.read("a.csv"), rows, "{question:?}");
        ok(&with(&files, &[question, fixed, &["--out", &json]].concat()));
        let whole: Value = serde_json::from_str(&folder.read("a.json")).expect("JSON");
        let steps = whole["steps"].as_array().expect("steps");
        assert!(steps.iter().map(|step| &step["contacts"]).eq(&objects), "{question:?}");
        // A line a step, and the sum.
        let name = if at_rest { "frame" } else { "step" };
        for (at, step) in steps.iter().enumerate() {
            assert_eq!(
                (step["step"].as_u64(), step["summary"]["step"].as_u64()),
                (Some(at as u64), Some(at as u64))
            );
            let line =
                people.lines().find(|line| line.starts_with(&format!("{name} {at} ("))).expect("a line");
            let hash = step["summary"]["hash"].as_str().expect("a hash");
            assert!(line.ends_with(&format!("hash {hash}")) && line.contains("wall "), "{line}");
        }
        assert!(
            people.lines().last().expect("a sum").contains(&format!(" in {} {name}s", steps.len())),
            "{people}"
        );
    }
}

/// Three frames of a triangle that falls through another, which is a mesh of its own.
fn falling(folder: &Folder) -> [String; 4] {
    let frame = |name: &str, z: i32| {
        let text = format!("v 0.25 0.25 {z}\nv 0.25 0.5 {}\nv 5 5 {}\nf 1 2 3\n", z + 4, z + 4);
        folder.write(name, &text)
    };
    let floor = folder.write("floor.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    [floor, frame("b0.obj", 3), frame("b1.obj", 1), frame("b2.obj", -1)]
}

#[test]
fn another_mesh_rests_or_has_as_many_frames() {
    let folder = Folder::new("sequence-with");
    let [floor, b0, b1, b2] = falling(&folder);
    let tois = |args: &[&str]| -> Vec<Option<f64>> {
        let all = summary(&[&["detect", "--json"], args].concat());
        all["steps"].as_array().expect("steps").iter().map(|step| step["earliest_toi"].as_f64()).collect()
    };
    let alone = tois(&[&floor, "--with", &b0, &b1, &b2]);
    assert!(alone[0].is_none() && alone[1].is_some_and(|toi| (0.499..=0.5).contains(&toi)), "{alone:?}");
    assert_eq!(tois(&[&b0, &b1, &b2, "--with", &floor]), alone);
    assert_eq!(tois(&["--with", &floor, &b0, &b1, &b2]), alone);
    assert_eq!(tois(&[&floor, &floor, &floor, "--with", &b0, &b1, &b2, "--earliest"]), alone);
    let text = refused(2, &["detect", &b0, &b1, &b2, "--with", &floor, &floor]);
    assert!(text.contains("equal numbers of frames, got 3 and 2; give as many files"), "{text}");
    // A step without motion is reported.
    let text = ok(&["detect", &b0, &b0, &b1, "--with", &floor]);
    assert!(text.contains("step 0 (") && text.matches("both frames are the same").count() == 1, "{text}");
}

#[test]
fn what_one_question_takes_is_refused() {
    for (args, said) in [
        (&["detect", "a", "b", "c", "--repeat", "3"][..], "--repeat has no effect: each of several steps"),
        (&["detect", "a", "b", "c", "--repeat", "3", "--only", "narrow"], "--only has no effect"),
        (
            &["detect", "a", "--rebuild-every", "3"],
            "--rebuild-every has no effect: the tree of the first step is new",
        ),
        (&["detect", "a", "b", "--rebuild-every", "3"], "give more frames"),
        (&["detect", "a", "b", "--rebuild", "auto"], "--rebuild has no effect"),
        (&["detect", "a", "b", "c", "--solver", "exact"], "use one of: certified"),
        (&["detect", "a", "b", "c", "--rebuild-every", "0"], "a whole number from 1"),
    ] {
        let text = refused(2, args);
        assert!(text.contains(said), "{args:?}: {text}");
    }
}

#[test]
fn nothing_is_printed_of_frames_that_cannot_be_used() {
    let folder = Folder::new("sequence-bad");
    let [_, b0, b1, _] = falling(&folder);
    let good = folder.write("good.csv", "good\n");
    let other = folder.write("other.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 3 2\n");
    let nan = folder.write("nan.obj", "v 0 0 0\nv 1 0 nan\nv 0 1 0\nf 1 2 3\n");
    for (bad, said) in [
        (folder.path("missing.obj"), "missing.obj: cannot be read"),
        (other, "other.obj: face 0 is [0, 2, 1], but in the first frame"),
        (nan, "nan.obj"),
    ] {
        let text = refused(3, &["detect", &b0, &b1, &bad, "--out", &good]);
        assert!(text.contains(said), "{text}");
        assert_eq!(folder.read("good.csv"), "good\n");
    }
}

#[test]
fn frames_of_both_precisions_are_taken() {
    let folder = Folder::new("sequence-f64");
    let [floor, b0, b1, _] = falling(&folder);
    let header = "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\nproperty double z\n\
        element face 1\nproperty list uchar int vertex_indices\nend_header\n";
    let wide = folder.write("b2.ply", &format!("{header}0.25 0.25 -1\n0.25 0.5 3\n5 5 3\n3 0 1 2\n"));
    let text = ok(&["detect", &b0, &b1, &wide, "--with", &floor, "--earliest"]);
    assert!(
        text.contains("b0.obj): no contact; ") && text.contains(", first in step 1 at t = 0.49"),
        "{text}"
    );
}

#[test]
fn seams_are_welded_where_they_stay_closed() {
    let folder = Folder::new("sequence-weld");
    // Two triangles along a seam whose vertices are there twice; in the last frame one end is open.
    let frame = |name: &str, open: f64| {
        let text = format!("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 0 0\nv 0 1 {open}\nv 1 1 0\nf 1 2 3\nf 4 6 5\n");
        folder.write(name, &text)
    };
    let [closed, open] = [frame("closed.obj", 0.0), frame("open.obj", 0.5)];
    let merged = |files: &[&str]| err(&run(&[&["detect"], files, &["--weld", "--discrete"]].concat()));
    assert!(merged(&[&closed, &closed, &closed]).contains("2 vertices merged"));
    assert!(merged(&[&closed, &closed, &open]).contains("1 vertex merged"));
}

#[cfg(target_os = "linux")]
#[test]
fn output_that_fails_is_an_error() {
    let folder = Folder::new("sequence-output");
    let files = frames(&folder, 3);
    let good = folder.write("good.csv", "good\n");
    let shell = |script: &str, args: &[&str]| {
        let program = env!("CARGO_BIN_EXE_nearmiss");
        Command::new("sh").args(["-c", script, program]).args(args).output().expect("a shell")
    };
    // The disk is full in the middle of writing, for rows and for lines; a file that was there stays.
    let near = with(&files, &["--near", "0.05", "--out", &good]);
    let full = shell("trap '' XFSZ; ulimit -f 1; exec \"$0\" \"$@\"", &near);
    assert_eq!(full.status.code(), Some(4), "{}", err(&full));
    assert!(err(&full).contains("good.csv: cannot be written: "), "{}", err(&full));
    for more in [&["--out", good.as_str()][..], &[], &["--json"]] {
        let full = shell("\"$0\" \"$@\" > /dev/full", &with(&files, more));
        assert_eq!(full.status.code(), Some(4), "{}", err(&full));
        assert!(err(&full).contains("standard output: cannot be written: "), "{}", err(&full));
    }
    assert_eq!(folder.read("good.csv"), "good\n");
    let (reader, writer) = std::io::pipe().expect("a pipe");
    drop(reader);
    let mut child = Command::new(env!("CARGO_BIN_EXE_nearmiss"));
    let child = child.args(with(&files, &[])).stdout(writer).stderr(Stdio::piped()).spawn().expect("a start");
    let ended = child.wait_with_output().expect("an end");
    assert_eq!(ended.status.code(), Some(4), "{}", err(&ended));
    let known = run(&with(&files, &["--out", &folder.path("no/such/a.csv")]));
    assert!(known.status.code() == Some(4) && out(&known).is_empty(), "before the work: {}", err(&known));
}
