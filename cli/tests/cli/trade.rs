//! `nearmiss lab trade`: rows, files and the headline, of small inputs; and that planted truths show.

use serde_json::Value;
use std::process::{Command, Output};
use support::folder::Folder;

fn run(args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_nearmiss"))
        .args(["lab", "trade"])
        .args(args)
        .output()
        .expect("the program starts")
}

fn json(args: &[&str]) -> Value {
    let output = run(&[args, &["--json", "--backend", "cpu"]].concat());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).expect("JSON")
}

fn rows<'a>(all: &'a Value, what: &str) -> &'a [Value] {
    all[what].as_array().expect("rows")
}

fn is_certain(row: &Value) -> bool {
    let solver = row["solver"].as_str().expect("a name");
    solver == "exact" || solver.starts_with("certified")
}

/// All that is made here: certain choices make no error anywhere, and every file is written.
#[test]
fn a_small_trade_has_every_part() {
    let folder = Folder::new("trade-small");
    let all = json(&["--cases", "2", "--triangles", "300", "--frames", "2", "--out", &folder.path("out")]);
    for row in rows(&all, "choices").iter().chain(rows(&all, "sweeps")) {
        assert!(row["input"].is_string() && row["ns"].as_f64() > Some(0.0), "{row}");
        if is_certain(row) && row["precision"] != "f32 cast" {
            for column in ["missed", "late", "false_certificates", "unknown"] {
                assert_eq!(row[column], 0, "{column}: {row}");
            }
            assert!(row["violations"].as_u64().unwrap_or(0) == 0, "{row}");
        }
    }
    let of = |what: &str, column: &str, value: &str| {
        rows(&all, what).iter().filter(|r| r[column] == value).count()
    };
    for solver in ["exact", "moller", "certified", "certified-f32", "certified-f64", "cubic-f64", "cubic-f32"]
    {
        assert!(of("choices", "solver", solver) >= 2, "{solver}");
    }
    for bv in ["aabb", "linear", "obb"] {
        assert!(of("choices", "bv", bv) >= 2, "{bv}");
    }
    // Positions cast to f32 far from the origin are another scene, and that shows.
    let cast =
        |row: &&Value| row["precision"] == "f32 cast" && row["solver"] == "certified" && row["at"] == 1e5;
    let far = rows(&all, "sweeps").iter().find(cast).expect("a row");
    assert!(far["missed"].as_u64() > Some(0) || far["late"].as_u64() > Some(0), "{far}");
    let headline = all["headline"].as_str().expect("a line");
    assert!(headline.starts_with("0 missed, 0 late") && headline.contains("1e-4 edge lengths"), "{headline}");
    let funnel: Vec<u64> = rows(&all, "funnel").iter().take(3).filter_map(|r| r["pairs"].as_u64()).collect();
    assert!(funnel[0] > funnel[1] && funnel[1] > 0 && funnel[1] >= funnel[2], "{funnel:?}");
    assert!(!rows(&all, "refit").is_empty());
    for name in ["trade", "trade-sweeps", "trade-funnel", "trade-refit"] {
        let csv = std::fs::read_to_string(folder.path(&format!("out/{name}.csv"))).expect("a file");
        assert!(csv.lines().count() > 2, "{name}");
    }
    let head = std::fs::read_to_string(folder.path("out/trade.csv")).expect("a file");
    assert!(
        head.starts_with("input,reference,solver,tolerance_edges,tolerance,precision,bv,"),
        "{head:.100}"
    );
    for name in ["trade-pareto", "trade-tolerance", "trade-sweeps", "trade-funnel", "trade-refit"] {
        let svg = std::fs::read_to_string(folder.path(&format!("out/{name}.svg"))).expect("a picture");
        assert!(svg.contains("<svg") && svg.contains("nearmiss on"), "{name}");
    }
}

/// A vertex falls through a face, at 1/2; and one that stops above it.
const QUERY: [&str; 2] = [
    "1,4,1,4,1,1,1\n0,1,0,1,0,1,1\n1,1,0,1,0,1,1\n0,1,1,1,0,1,1\n\
     1,4,1,4,-1,1,1\n0,1,0,1,0,1,1\n1,1,0,1,0,1,1\n0,1,1,1,0,1,1\n",
    "1,4,1,4,1,1,0\n0,1,0,1,0,1,0\n1,1,0,1,0,1,0\n0,1,1,1,0,1,0\n\
     1,4,1,4,1,2,0\n0,1,0,1,0,1,0\n1,1,0,1,0,1,0\n0,1,1,1,0,1,0\n",
];

#[test]
fn query_files_are_read_decided_and_judged() {
    let folder = Folder::new("trade-queries");
    folder.write("set/vertex-face/a.csv", &QUERY.concat());
    let all = json(&["--queries", &folder.path("set")]);
    let choices = rows(&all, "choices");
    assert!(choices.len() > 10 && rows(&all, "sweeps").is_empty());
    for row in choices {
        assert_eq!((&row["cases"], &row["contacts"]), (&2.into(), &1.into()), "{row}");
        assert_eq!(
            (&row["missed"], &row["late"], &row["false_alarms"]),
            (&0.into(), &0.into(), &0.into()),
            "{row}"
        );
    }
    // The tolerance of the public comparison is among them.
    assert!(choices.iter().any(|row| (row["tolerance"].as_f64().unwrap_or(0.0) - 1e-6).abs() < 1e-12));
    // A column that is wrong is noticed, with the query.
    folder.write("wrong/vertex-face/a.csv", &QUERY.concat().replace(",0\n", ",1\n"));
    let output = run(&["--queries", &folder.path("wrong")]);
    let text = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.code() == Some(2) && text.contains("query 2"), "{text}");
    folder.write("odd/edge-edge/a.csv", "1,2,3\n");
    for (path, why, code) in [("odd", "in the middle of a query", 3), ("nowhere", "nowhere", 2)] {
        let output = run(&["--queries", &folder.path(path)]);
        let text = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.code() == Some(code) && text.contains(why), "{path}: {text}");
    }
}

/// A scene from files against a list. A surplus contact in the list is a miss of every solver, a
/// missing one a false alarm.
#[test]
fn a_list_of_contacts_judges_a_mesh() {
    let folder = Folder::new("trade-mesh");
    let scene = ["lab", "scene", "soup-moving", "--triangles", "60", "--out", &folder.path("")];
    let made = Command::new(env!("CARGO_BIN_EXE_nearmiss")).args(scene).output().expect("the program starts");
    assert!(made.status.success(), "{}", String::from_utf8_lossy(&made.stderr));
    let mesh = [folder.path("soup-moving_t0.ply"), folder.path("soup-moving_t1.ply")];
    let found = folder.path("found.csv");
    let detect = ["detect", &mesh[0], &mesh[1], "--backend", "cpu", "--tolerance", "0", "--out", &found];
    let made =
        Command::new(env!("CARGO_BIN_EXE_nearmiss")).args(detect).output().expect("the program starts");
    assert!(made.status.success(), "{}", String::from_utf8_lossy(&made.stderr));
    let text = std::fs::read_to_string(&found).expect("a file");
    let key = |line: &str| line.split(',').take(3).collect::<Vec<_>>().join(",");
    let keys: Vec<String> = text.lines().skip(1).map(key).collect();
    assert!(keys.len() > 3, "{text}");
    let judged = |keys: &[String]| {
        let truth = folder.write("truth.csv", &(keys.join("\n") + "\n"));
        let all = json(&["--mesh", &mesh[0], &mesh[1], "--truth", &truth]);
        let row =
            rows(&all, "choices").iter().find(|row| row["solver"] == "certified-f64").expect("a row").clone();
        (row["contacts"].as_u64(), row["missed"].as_u64(), row["false_certificates"].as_u64())
    };
    let count = keys.len() as u64;
    assert_eq!(judged(&keys), (Some(count), Some(0), Some(0)));
    assert_eq!(judged(&keys[1..]), (Some(count - 1), Some(0), Some(1)));
    let mut more = keys.clone();
    more.push("vf,0,0".into());
    assert_eq!(judged(&more), (Some(count + 1), Some(1), Some(0)));
}
