//! `nearmiss lab turns`: a small hunt, its options and its files.

use super::{Folder, ok, refused};
use serde_json::Value;

/// The rows of a hunt, without times.
fn rows(args: &[&str]) -> Vec<Value> {
    let json = ok(&[&["lab", "turns", "--json"], args].concat());
    let mut all: Value = serde_json::from_str(&json).expect("JSON");
    let rows = all["rows"].as_array_mut().expect("rows");
    for row in rows.iter_mut() {
        row.as_object_mut().expect("a row").remove("microseconds");
    }
    rows.clone()
}

#[test]
fn a_small_hunt_finds_no_fault() {
    let all = rows(&["--pairs", "2", "--times", "500"]);
    assert_eq!(all.len(), 26);
    let sum = &all[25];
    assert!(sum["family"] == "all" && sum["pairs"] == 50);
    for fault in ["missed", "late", "falsely_certain", "far_undecided"] {
        assert_eq!(sum[fault], 0, "{sum}");
    }
    let answers = ["separated", "contacts", "undecided"].map(|answer| sum[answer].as_u64().expect("a count"));
    assert!(answers.iter().sum::<u64>() == 50 && answers[0] > 0 && answers[1] > 10, "{sum}");
}

#[test]
fn each_option_has_an_effect() {
    let folder = Folder::new("turns");
    let base = ["--family", "tangent", "--pairs", "20"];
    let first = rows(&base);
    assert_eq!(first, rows(&base));
    assert!(first.len() == 2 && first[0]["family"] == "tangent" && first[0]["pairs"] == 20);
    assert_ne!(first, rows(&[&base[..], &["--seed", "2"]].concat()));
    let hasty = rows(&[&base[..], &["--times", "1"]].concat());
    assert!(hasty[0]["unjudged"].as_u64() > first[0]["unjudged"].as_u64(), "{hasty:?}");
    let two = rows(&["--family", "coin", "gears", "--pairs", "1"]);
    assert!(two.len() == 3 && two[1]["family"] == "gears");
    // Text, and a file.
    let text = ok(&["lab", "turns", "--family", "coin", "--pairs", "3", "--out", &folder.path("out")]);
    assert!(text.starts_with("Turning features") && text.contains("\n  coin"), "{text}");
    let csv = std::fs::read_to_string(folder.path("out/turns.csv")).expect("a file");
    assert!(csv.starts_with("family,pairs,") && csv.contains("\ncoin,3,"), "{csv}");
    assert!(refused(2, &["lab", "turns", "--family", "wheels"]).contains("wheels"));
}
