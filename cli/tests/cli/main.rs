//! The program: exit codes, messages, the JSON summary, files. Scripts rely on these.

mod bench;
mod caveats;
mod check;
mod check_known;
mod distance;
mod earliest;
mod effects;
mod explain;
mod faces;
mod film;
mod film_pictures;
mod idle;
#[cfg(unix)]
mod interrupted;
#[cfg(target_os = "linux")]
mod kept;
mod memory;
mod near;
mod notes;
mod numbers;
mod output;
mod picture;
mod places;
mod plan;
mod repeat;
mod scene;
mod scene_file;
mod scene_poses;
mod selftest;
mod sequence;
mod stdio;
mod summary;
mod tables;
mod trade;
mod turns;
mod view;
mod with;
mod words;

use serde_json::Value;
use std::process::{Command, Output};
use support::folder::Folder;

const SCENE: [&str; 5] = ["detect", "--scene", "soup-moving", "--triangles", "300"];

/// Runs the program.
fn run(args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_nearmiss")).args(args).output().expect("the program starts")
}

fn out(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).expect("text")
}

fn err(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).expect("text")
}

/// A command, with the name before it if it is one of the laboratory.
fn path(command: &str) -> Vec<&str> {
    let is_of_lab = ["trade", "tables", "bench", "plan", "scene", "turns"].contains(&command);
    if is_of_lab { vec!["lab", command] } else { vec![command] }
}

/// Runs the program and expects success; its standard output.
fn ok(args: &[&str]) -> String {
    let output = run(args);
    assert_eq!(output.status.code(), Some(0), "{args:?}: {}", err(&output));
    out(&output)
}

/// Runs the program and expects that it refuses: nothing on standard output, and what it says.
fn refused(code: i32, args: &[&str]) -> String {
    let output = run(args);
    assert_eq!(output.status.code(), Some(code), "{args:?}: {}{}", out(&output), err(&output));
    assert!(output.stdout.is_empty(), "{args:?}: {}", out(&output));
    err(&output)
}

fn summary(args: &[&str]) -> Value {
    let text = ok(args);
    assert_eq!(text.lines().count(), 1, "one object on one line: {text}");
    serde_json::from_str(&text).expect("JSON")
}

#[test]
fn a_promise_is_made_where_one_is_needed() {
    for (more, promised) in [
        (&["--discrete"][..], None),
        (&["--discrete", "--solver", "moller"], Some("moller: a float test that can miss")),
        (&["--continuous"], None),
        (&["--continuous", "--solver", "cubic-f64"], Some("cubic-f64: can miss")),
        (&["--earliest", "--solver", "cubic-f32"], Some("cubic-f32: a float solver that can miss")),
    ] {
        let output = run(&[&SCENE[..], more].concat());
        let text = err(&output);
        match promised {
            None => assert_eq!(text, "", "{more:?}"),
            Some(promise) => {
                assert!(
                    text.starts_with("nearmiss: warning: the solver is ") && text.contains(promise),
                    "{text}"
                )
            }
        }
    }
}

/// The numbers under a key as they stand in a JSON text, read to the last bit (which serde_json does not).
fn numbers(json: &str, key: &str) -> Vec<f64> {
    let key = format!("\"{key}\":");
    let values = json.split(&key).skip(1);
    let texts = values.map(|rest| rest.split([',', '}']).next().unwrap_or_default());
    texts.map(|text| text.parse().unwrap_or_else(|_| panic!("{key}: {text}"))).collect()
}

#[test]
fn files_of_contacts_agree_to_the_bit() {
    let folder = Folder::new("contacts");
    let [csv, json] = ["a.csv", "a.json"].map(|name| folder.path(name));
    ok(&[&SCENE[..], &["--out", &csv]].concat());
    ok(&[&SCENE[..], &["--out", &json]].concat());
    let whole: Value = serde_json::from_str(&folder.read("a.json")).expect("JSON");
    let rows = whole["contacts"].as_array().expect("rows");
    let text = folder.read("a.csv");
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("kind,feature_a,feature_b,toi,toi_upper,status"));
    let (mut before, mut times) = (None, Vec::new());
    for (line, row) in lines.clone().zip(rows) {
        let cells: Vec<&str> = line.split(',').collect();
        assert_eq!(cells.len(), 6, "{line}");
        let id = |i: usize| cells[i].parse::<u64>().expect("an index");
        for (cell, key) in [(0, "kind"), (5, "status")] {
            assert_eq!(row[key].as_str(), Some(cells[cell]), "{line}, {row}");
        }
        assert_eq!((row["feature_a"].as_u64(), row["feature_b"].as_u64()), (Some(id(1)), Some(id(2))));
        times.push([3, 4].map(|cell| cells[cell].parse::<f64>().expect("a time").to_bits()));
        // Kinds in the order vf, ee; then the features.
        let place = (["vf", "ee"].iter().position(|kind| *kind == cells[0]), id(1), id(2));
        assert!(place.0.is_some() && before < Some(place), "canonical order: {line}");
        before = Some(place);
    }
    assert_eq!(lines.count(), rows.len());
    assert_eq!(whole["summary"]["contacts"].as_u64(), Some(rows.len() as u64));
    let [toi, toi_upper, least] =
        ["toi", "toi_upper", "earliest_toi"].map(|key| numbers(&folder.read("a.json"), key));
    assert!(times.iter().map(|time| time[0]).eq(toi.iter().copied().map(f64::to_bits)), "toi");
    assert!(times.iter().map(|time| time[1]).eq(toi_upper.iter().copied().map(f64::to_bits)), "toi_upper");
    assert!(toi.iter().zip(&toi_upper).all(|(toi, hi)| 0.0 <= *toi && toi <= hi && *hi <= 1.0));
    assert_eq!(least, [toi.iter().copied().min_by(f64::total_cmp).expect("a contact")]);

    ok(&[&SCENE[..], &["--earliest", "--out", &csv]].concat());
    let text = folder.read("a.csv");
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("earliest_toi"));
    assert_eq!(lines.next().and_then(|toi| toi.parse().ok()), least.first().copied());
    assert_eq!(lines.next(), None);
}

#[test]
fn a_file_of_pairs_is_ascending() {
    let folder = Folder::new("pairs");
    let path = folder.path("pairs.csv");
    ok(&["detect", "--scene", "grid", "--triangles", "100", "--out", &path]);
    let text = folder.read("pairs.csv");
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("tri_a,tri_b"));
    let pairs: Vec<(u32, u32)> = lines
        .map(|line| {
            let (a, b) = line.split_once(',').expect("two cells");
            (a.parse().expect("an index"), b.parse().expect("an index"))
        })
        .collect();
    // 5 cells: 100 triangles and 5 (4 x 5 - 1) pairs, see scene::grid_pairs.
    assert_eq!(pairs.len(), 95);
    assert!(pairs.iter().all(|(a, b)| a < b) && pairs.windows(2).all(|two| two[0] < two[1]));
}

#[test]
fn two_meshes_are_asked_against_each_other() {
    let folder = Folder::new("with");
    let a = folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    let b = folder.write("b.obj", "v 0.25 0.25 -1\nv 0.25 0.25 1\nv 5 5 1\nf 1 2 3\n");
    let path = folder.path("ab.csv");
    let both = summary(&["detect", &a, "--with", &b, "--json", "--out", &path]);
    assert_eq!((both["triangles"].as_u64(), both["contacts"].as_u64()), (Some(2), Some(1)));
    assert_eq!(folder.read("ab.csv"), "body_a,body_b,tri_a,tri_b\n0,1,0,0\n");
    let path = folder.path("ab.json");
    ok(&["detect", &a, "--with", &b, "--out", &path]);
    let told: Value = serde_json::from_str(&folder.read("ab.json")).expect("JSON");
    let row = serde_json::json!({ "body_a": "0", "body_b": "1", "triangles": [0, 0] });
    assert_eq!(told["contacts"], serde_json::json!([row]));
    assert_eq!(summary(&["detect", &a, "--json"])["contacts"], 0);
}

#[test]
fn bad_arguments_are_refused_with_what_is_known() {
    for (args, known) in [
        (
            &["detect", "a.ply", "--solver", "magic"][..],
            &["exact", "moller", "certified-f32", "cubic-f64"][..],
        ),
        (
            &["detect", "a.ply", "--traversal", "random"],
            &["per-leaf", "per-leaf-spill", "queue", "queue-gtx285", "steal"],
        ),
        (&["detect", "a.ply", "--refit", "twice"], &["levels", "treelets"]),
        (&["detect", "a.ply", "--backend", "abacus"], &["cpu", "cuda", "auto"]),
        (&["detect", "a.ply", "--bounding-volume", "sphere"], &["aabb"]),
        (&["lab", "scene", "cloth", "--out", "x"], &["cloth-ball", "grid", "soup"]),
        (
            &["lab", "scene", "draped", "--frames", "3", "--out", "x"],
            &["at most 2 for the scene draped, got 3", "cloth-ball", "n-body"],
        ),
        (
            &["lab", "scene", "grid", "--triangles", "4", "--frames", "2", "--out", "x"],
            &["at most 1 for the scene grid, got 2"],
        ),
        (&["lab", "scene", "grid", "--skip", "1", "--out", "x"], &["flamenco", "princess"]),
        (&["lab", "scene", "n-body", "--contact", "--out", "x"], &["cloth-ball", "princess"]),
        (&["detect", "--scene", "cloth"], &["cloth-ball", "grid", "soup"]),
        (&["detect", "--scene", "grid", "--triangles", "4", "--out", "a.xlsx"], &[".csv", ".json"]),
        (&["detect", "--scene", "grid", "--triangles", "4", "--solver", "cubic-f64"], &["exact, moller"]),
        (
            &["detect", "--scene", "soup-moving", "--triangles", "4", "--solver", "exact"],
            &["certified, certified-f32, certified-f64, cubic-f64, cubic-f32"],
        ),
        (&["detect", "--scene", "soup-moving", "--triangles", "4", "--adjacent"], &["discrete", "exact"]),
        (
            &["detect", "--scene", "grid", "--triangles", "4", "--tolerance", "1"],
            &["--tolerance cannot be used with --solver exact"],
        ),
        (&["detect", "--scene", "soup-moving", "--triangles", "4", "--tolerance", "NaN"], &["at least 0"]),
    ] {
        let text = refused(2, args);
        for name in known {
            assert!(text.contains(name), "{args:?} does not name {name}: {text}");
        }
    }
    let bad: [&[&str]; 9] = [
        &["detect"],
        &["detect", "a.ply", "--threads", "0"],
        &["detect", "a.ply", "--threads", "-1"],
        &["detect", "a.ply", "--threads", "many"],
        &["detect", "a.ply", "--repeat", "0"],
        &["detect", "a.ply", "--discrete", "--continuous"],
        &["detect", "a.ply", "--continuous", "--earliest"],
        &["detect", "a.ply", "--scene", "grid"],
        &["dance"],
    ];
    for args in bad {
        assert!(refused(2, args).contains("error: "), "{args:?}");
    }
}

#[test]
fn bad_input_is_named() {
    let folder = Folder::new("input");
    let missing = folder.path("no.ply");
    assert!(refused(3, &["detect", &missing]).contains("no.ply"));
    let bad = folder.write("bad.obj", "v 0 0 0\nv 1 0 0\nv 0 nan 0\nf 1 2 3\n");
    assert!(refused(3, &["detect", &bad]).contains("bad.obj"));
    let empty = folder.write("empty.obj", "v 0 0 0\n");
    assert!(refused(3, &["detect", &empty]).contains("empty.obj"));
    let [t0, t1] = [("t0.obj", "f 1 2 3"), ("t1.obj", "f 1 3 2")]
        .map(|(name, face)| folder.write(name, &format!("v 0 0 0\nv 1 0 0\nv 0 1 0\n{face}\n")));
    assert!(refused(3, &["detect", &t0, &t1]).contains("t1.obj"));
    assert!(refused(3, &["lab", "plan", &missing]).contains("no.ply"));
    assert!(refused(3, &["detect", "--scene", "grid", "--triangles", "0"]).contains("grid"));
}

#[cfg(not(feature = "cuda"))]
#[test]
fn a_card_that_this_program_knows_nothing_of_is_an_error() {
    let text = refused(4, &["detect", "--scene", "grid", "--triangles", "16", "--backend", "cuda"]);
    assert!(text.contains("without the feature `cuda`") && text.contains("run on the CPU"), "{text}");
    let auto = summary(&["detect", "--scene", "grid", "--triangles", "16", "--backend", "auto", "--json"]);
    assert_eq!(auto["backend"], "cpu");
}

#[test]
fn the_program_says_what_it_is() {
    assert_eq!(ok(&["--version"]).trim(), format!("nearmiss {}", env!("CARGO_PKG_VERSION")));
    let commands = |text: &str| -> Vec<String> {
        let below = text.split_once("Commands:\n").expect("commands").1;
        let lines = below.lines().take_while(|line| !line.is_empty());
        lines.filter_map(|line| line.split_whitespace().next().map(str::to_owned)).collect()
    };
    let product =
        ["detect", "check", "explain", "picture", "view", "selftest", "completions", "man", "lab", "help"];
    assert_eq!(commands(&ok(&["--help"])), product);
    let lab = ["trade", "tables", "bench", "plan", "scene", "turns", "help"];
    assert_eq!(commands(&ok(&["lab", "--help"])), lab);
    for command in &lab[..6] {
        assert!(refused(2, &[command, "--help"]).contains("unrecognized subcommand"), "{command}");
        assert!(ok(&["lab", command, "-h"]).contains(&format!("nearmiss lab {command}")), "{command}");
    }
    assert_eq!([run(&[]), run(&["lab"])].map(|output| output.status.code()), [Some(2); 2]);
}

/// Names of earlier days: refused as any unknown name. A hint comes from clap alone. The names are
/// in parts, so that a search for them finds nothing.
#[test]
fn names_that_are_gone_are_refused() {
    for (old, hint) in [
        (concat!("--", "separation"), Some("--min-separation")),
        (concat!("--no-self-", "contact"), Some("--no-self-collision")),
        (concat!("--", "broad"), Some("--broad-phase")),
        (concat!("--", "bv"), None),
        (concat!("--", "boxes"), None),
        (concat!("--", "order"), None),
    ] {
        let text = refused(2, &["detect", "a.ply", old, "1"]);
        assert!(text.contains(&format!("unexpected argument '{old}'")), "{text}");
        assert!(hint.is_none_or(|hint| text.contains(hint)), "{old}: {text}");
    }
    assert!(refused(2, &["explain", "a.ply", "--with", "b.ply", "--fv", "0", "0"]).contains("'--fv'"));
}
