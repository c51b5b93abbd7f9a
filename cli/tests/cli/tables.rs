//! `nearmiss lab tables`: files, columns, pictures, refusals.

use std::process::{Command, Output};
use support::folder::Folder;

fn run(args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_nearmiss"))
        .args(["lab", "tables"])
        .args(args)
        .output()
        .expect("the program starts")
}

fn ok(args: &[&str]) -> String {
    let output = run(args);
    let err = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{args:?}: {err}");
    String::from_utf8(output.stdout).expect("text")
}

/// The message of a refusal.
fn refused(code: i32, args: &[&str]) -> String {
    let output = run(args);
    assert_eq!(output.status.code(), Some(code), "{args:?}");
    assert!(output.stdout.is_empty(), "{args:?}");
    String::from_utf8(output.stderr).expect("text")
}

/// A CSV file's head and rows.
fn read_csv(folder: &Folder, name: &str) -> (Vec<String>, Vec<Vec<String>>) {
    let mut csv = csv::Reader::from_path(folder.path(name)).expect(name);
    let texts = |record: &csv::StringRecord| record.iter().map(str::to_owned).collect::<Vec<_>>();
    let head = texts(csv.headers().expect("a head"));
    (head, csv.records().map(|row| texts(&row.expect("a row"))).collect())
}

const SMALL: [&str; 8] =
    ["--scene", "cloth-ball", "--triangles", "1000", "--frames", "3", "--backend", "cpu"];

fn small(more: &[&str]) -> String {
    ok(&[&SMALL, more].concat())
}

/// Values of a column.
fn column<'a>((head, rows): &'a (Vec<String>, Vec<Vec<String>>), name: &str) -> Vec<&'a str> {
    let at = head.iter().position(|h| h == name).unwrap_or_else(|| panic!("no column {name} in {head:?}"));
    rows.iter().map(|row| row[at].as_str()).collect()
}

fn numbers(csv: &(Vec<String>, Vec<Vec<String>>), name: &str) -> Vec<f64> {
    column(csv, name).iter().map(|x| x.parse().unwrap_or_else(|_| panic!("{name}: {x}"))).collect()
}

#[test]
fn every_figure_is_written() {
    let folder = Folder::new("tables-all");
    let text = small(&["--out", folder.name()]);
    for part in ["Figure 6.12", "Figure 6.13", "Figure 6.14", "ours on CPU", "GTX 285", "different scenes"] {
        assert!(text.contains(part), "{part}: {text}");
    }
    let shared = ["scene", "model", "triangles", "their_triangles", "device", "profile"];
    let asked = ["motion", "bv", "front"];
    let heads = [
        (
            "figure-6.12.csv",
            [&shared[..], &["stage", "bv", "frames", "ours_ms", "theirs_ms", "ratio"]].concat(),
        ),
        (
            "figure-6.13.csv",
            [
                &shared[..],
                &asked,
                &[
                    "solver",
                    "frames",
                    "ours_ms",
                    "theirs_ms",
                    "ratio",
                    "contacts_a_frame",
                    "node_tests_a_frame",
                ],
                &["triangle_pairs_a_frame", "hash", "differing", "reruns", "bytes"],
            ]
            .concat(),
        ),
        (
            "figure-6.14.csv",
            [&shared[..], &asked, &["refit", "traverse", "balance", "triangle_tests", "ms"]].concat(),
        ),
    ];
    for (name, head) in heads {
        assert_eq!(read_csv(&folder, name).0, head, "{name}");
    }
    for name in ["figure-6.12.csv", "figure-6.13.csv"] {
        let csv = read_csv(&folder, name);
        let (ours, theirs) = (numbers(&csv, "ours_ms"), numbers(&csv, "theirs_ms"));
        for ((ours, theirs), ratio) in ours.iter().zip(theirs).zip(numbers(&csv, "ratio")) {
            assert!(
                *ours > 0.0 && (ratio - ours / theirs).abs() <= 1e-12 * ratio,
                "{name}: {ours} {theirs} {ratio}"
            );
        }
    }
}

#[test]
fn a_row_stands_for_every_way_and_all_agree() {
    let folder = Folder::new("tables-ways");
    small(&["--table", "6.13", "6.14", "--out", folder.name()]);
    let frames = read_csv(&folder, "figure-6.13.csv");
    let ways = |csv| {
        let [motion, bv, front] = ["motion", "bv", "front"].map(|name| column(csv, name));
        motion.iter().zip(bv).zip(front).map(|((m, b), f)| format!("{m} {b} {f}")).collect::<Vec<_>>()
    };
    let found = ways(&frames);
    for want in ["discrete aabb false", "discrete obb false", "continuous aabb false", "continuous obb false"]
    {
        assert_eq!(found.iter().filter(|way| *way == want).count(), 1, "{want}: {found:?}");
    }
    assert_eq!(ways(&read_csv(&folder, "figure-6.14.csv")), found);
    // The thesis's figures of that scene, in the text's order.
    let theirs = column(&frames, "theirs_ms");
    let of = |want: &str| theirs[found.iter().position(|way| way == want).expect("a way")];
    assert_eq!((of("discrete aabb false"), of("continuous aabb false")), ("33.0", "47.0"));
    // Exact cells of one motion have one hash.
    let hashes: Vec<_> = column(&frames, "hash")
        .into_iter()
        .zip(column(&frames, "solver"))
        .filter(|(_, s)| *s == "exact")
        .collect();
    assert!(!hashes.is_empty() && hashes.iter().all(|hash| hash == &hashes[0]), "{hashes:?}");
    assert!(numbers(&frames, "contacts_a_frame").iter().any(|&n| n > 0.0));
    assert!(numbers(&frames, "reruns").iter().all(|&n| n == 0.0));
    let shares = read_csv(&folder, "figure-6.14.csv");
    for row in 0..shares.1.len() {
        let parts =
            ["refit", "traverse", "balance", "triangle_tests"].map(|name| numbers(&shares, name)[row]);
        assert!((parts.iter().sum::<f64>() - 100.0).abs() < 1e-9, "{parts:?}");
    }
}

#[test]
fn pictures_are_labelled() {
    let folder = Folder::new("tables-pictures");
    small(&["--out", folder.name()]);
    let pictures = [
        (
            "figure-6.12.svg",
            vec!["construct AABB", "refit AABB", "31.0", "ms (log)", "GTX 285", "ours / theirs"],
        ),
        ("figure-6.13.svg", vec!["discrete AABB", "continuous OBB", "33.0", "43.0", "ms (log)", "GTX 285"]),
        ("figure-6.14.svg", vec!["discrete AABB", "traverse", "triangle tests", "100 %"]),
    ];
    for (name, labels) in pictures {
        let svg = folder.read(name);
        assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"), "{name}");
        for label in labels.into_iter().chain(["cloth-ball", "nearmiss on CPU"]) {
            assert!(svg.contains(label), "{name}: {label}");
        }
    }
}

#[test]
fn only_what_is_asked_for_is_measured() {
    let folder = Folder::new("tables-one");
    let text = small(&["--table", "6.12", "--out", folder.name()]);
    assert!(text.contains("Figure 6.12") && !text.contains("Figure 6.13"), "{text}");
    let mut files: Vec<_> =
        std::fs::read_dir(folder.name()).expect("a folder").map(|f| f.expect("a file").file_name()).collect();
    files.sort();
    assert_eq!(files, ["figure-6.12.csv", "figure-6.12.svg"]);
}

#[test]
fn json_holds_all_rows() {
    let text = small(&["--json"]);
    assert_eq!(text.lines().count(), 1);
    let all: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    for figure in ["figure_6_12", "figure_6_13", "figure_6_14"] {
        let rows = all[figure].as_array().expect(figure);
        assert!(!rows.is_empty() && rows.iter().all(|row| row["scene"] == "cloth-ball"), "{figure}");
    }
    assert!(all["device"].as_str().expect("a name").starts_with("CPU"));
}

#[test]
fn files_are_a_scene() {
    let folder = Folder::new("tables-files");
    let made = Command::new(env!("CARGO_BIN_EXE_nearmiss"))
        .args(["lab", "scene", "soup-moving", "--triangles", "200", "--out", folder.name()])
        .output()
        .expect("the program starts");
    assert!(made.status.success());
    let frame = |t: usize| folder.path(&format!("soup-moving_t{t}.ply"));
    let files = [frame(0), frame(1), frame(0)];
    let mesh = ["--backend", "cpu", "--table", "6.13", "--mesh", &files[0], &files[1], &files[2]];
    ok(&[&mesh[..], &["--out", folder.name()]].concat());
    let csv = read_csv(&folder, "figure-6.13.csv");
    assert!(column(&csv, "scene").iter().all(|scene| *scene == "soup-moving_t0"));
    assert!(column(&csv, "ratio").iter().all(|ratio| ratio.is_empty()), "the thesis has no such scene");
    // Three frames, two steps.
    assert_eq!(
        column(&csv, "frames"),
        column(&csv, "motion").iter().map(|m| if *m == "discrete" { "3" } else { "2" }).collect::<Vec<_>>()
    );
    // The same files, as a scene that the thesis has.
    ok(&[&mesh[..], &["--scene", "cloth-ball", "--out", folder.name()]].concat());
    assert!(column(&read_csv(&folder, "figure-6.13.csv"), "ratio").iter().all(|ratio| !ratio.is_empty()));
    // A volume that the thesis has not has no ratio.
    ok(&[&mesh[..], &["--scene", "cloth-ball", "--bounding-volume", "linear", "--out", folder.name()]]
        .concat());
    let csv = read_csv(&folder, "figure-6.13.csv");
    assert!(column(&csv, "bv").iter().all(|bv| *bv == "linear"));
    assert!(column(&csv, "ratio").iter().all(|ratio| ratio.is_empty()));
    // Frames of two meshes are none.
    let other = folder.write("other.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n0 0 0\n");
    refused(3, &["--backend", "cpu", "--mesh", &files[0], &other]);
}

#[test]
fn a_tree_may_be_built_more_often() {
    let hash = |more: &[&str]| {
        let all: serde_json::Value =
            serde_json::from_str(&small(&[&["--json", "--table", "6.13"], more].concat())).expect("JSON");
        all["figure_6_13"].as_array().expect("rows").iter().map(|row| row["hash"].clone()).collect::<Vec<_>>()
    };
    assert_eq!(hash(&["--rebuild-every", "1"]), hash(&[]));
}

#[test]
fn queues_of_either_size_answer_the_same() {
    let hashes = |more: &[&str]| {
        let text = small(&[&["--json", "--table", "6.13"], more].concat());
        let all: serde_json::Value = serde_json::from_str(&text).expect("JSON");
        all["figure_6_13"].as_array().expect("rows").iter().map(|row| row["hash"].clone()).collect::<Vec<_>>()
    };
    let want = hashes(&[]);
    for profile in ["gtx285", "native"] {
        assert_eq!(hashes(&["--profile", profile]), want, "{profile}");
        let folder = Folder::new(profile);
        let text = small(&["--profile", profile, "--out", folder.name()]);
        assert!(text.contains(&format!("work queues {profile}")), "{text}");
        assert!(folder.read("figure-6.13.svg").contains(&format!("work queues {profile}")));
        assert!(column(&read_csv(&folder, "figure-6.12.csv"), "profile").iter().all(|name| *name == profile));
    }
    assert!(refused(2, &["--profile", "h200"]).contains("gtx285, native"));
}

#[test]
fn what_is_not_known_is_refused_with_what_is() {
    let unknown = refused(2, &["--scene", "cloth"]);
    assert!(unknown.contains("possible values") && unknown.contains("cloth-ball"), "{unknown}");
    let unknown = refused(2, &["--table", "6.15"]);
    assert!(unknown.contains("6.12") && unknown.contains("6.14"), "{unknown}");
    let unknown = refused(2, &["--bounding-volume", "sphere"]);
    assert!(unknown.contains("aabb, linear, obb"), "{unknown}");
    refused(2, &["--frames", "1"]);
    refused(2, &["--mesh", "one.ply"]);
    refused(2, &["--rebuild-every", "0"]);
    refused(3, &["--mesh", "not-there.ply", "nor-there.ply"]);
    assert!(
        refused(4, &[&SMALL[..], &["--table", "6.12", "--out", "Cargo.toml/x"]].concat())
            .contains("cannot be written")
    );
}
