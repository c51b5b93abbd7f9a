//! `bench`: cases and files.

use super::{Folder, ok, refused};
use serde_json::Value;

const HEAD: &str = "machine,threads,version,case,triangles,bodies,question,stage,frames,\
                    median_ms,low_ms,high_ms,candidates,contacts,bytes,hash";
const STAGES: [&str; 10] =
    ["place", "construct", "fit", "refit", "traverse", "balance", "narrow", "order", "total", "wall"];
const QUESTIONS: [&str; 5] = ["discrete", "continuous", "separation", "earliest", "near"];

/// A case of some triangles, and a first file of its figures.
struct Tiny {
    folder: Folder,
    mesh: [String; 2],
    first: String,
}

impl Tiny {
    fn new(name: &str) -> Tiny {
        let folder = Folder::new(name);
        ok(&["scene", "soup-moving", "--triangles", "60", "--out", folder.name()]);
        let mesh = ["t0", "t1"].map(|at| folder.path(&format!("soup-moving_{at}.ply")));
        let tiny = Tiny { first: folder.path("first/bench.csv"), folder, mesh };
        ok(&tiny.args(&["--out", &tiny.folder.path("first")]));
        tiny
    }

    /// The arguments that ask it, and more.
    fn args<'a>(&'a self, more: &[&'a str]) -> Vec<&'a str> {
        let [t0, t1] = &self.mesh;
        let own = ["bench", "--case", "soup-moving_t0", "--mesh", t0, t1, "--backend", "cpu"];
        [&own[..], &["--threads", "1", "--repeat", "3"], more].concat()
    }

    fn rows(&self) -> Vec<Vec<String>> {
        let text = self.folder.read("first/bench.csv");
        text.lines().map(|line| line.split(',').map(str::to_owned).collect()).collect()
    }
}

#[test]
fn a_case_is_timed_stage_by_stage() {
    let tiny = Tiny::new("bench-stages");
    let rows = tiny.rows();
    assert_eq!(rows[0].join(","), HEAD);
    let keys: Vec<[&str; 3]> = rows[1..].iter().map(|row| [&*row[3], &*row[6], &*row[7]]).collect();
    let all = QUESTIONS.iter().flat_map(|of| STAGES.map(|stage| ["soup-moving_t0", of, stage]));
    assert_eq!(keys, all.collect::<Vec<_>>());
    for row in &rows[1..] {
        assert_eq!([&row[1], &row[4], &row[5], &row[8]], ["1", "60", "1", "3"], "{row:?}");
        let [median, low, high] = [9, 10, 11].map(|at| row[at].parse::<f64>().expect("a number"));
        assert!(0.0 <= low && low <= median && median <= high, "{row:?}");
        assert!(row[7] != "total" || low > 0.0, "{row:?}");
    }
    // The answers are those of `detect`.
    for (question, option) in [("discrete", "--discrete"), ("continuous", "--continuous")] {
        let [t0, t1] = &tiny.mesh;
        let detect =
            super::summary(&["detect", t0, t1, option, "--backend", "cpu", "--threads", "1", "--json"]);
        let row = rows.iter().find(|row| row[6] == question).expect("a row");
        assert_eq!(detect["hash"], row[15], "{question}");
        assert_eq!([&detect["candidates"], &detect["contacts"]].map(Value::to_string), row[12..14]);
        assert_eq!(detect["bytes"].to_string(), row[14], "{question}: a peak of its own");
    }
    let text = ok(&tiny.args(&["--question", "near"]));
    assert!(text.contains("soup-moving_t0: 60 triangles, 1 body\nnear: ") && text.contains("  median"));
    assert!(!text.contains("continuous: ") && !text.contains("earlier"), "{text}");
}

#[test]
fn arguments_that_ask_nothing_are_refused() {
    let tiny = Tiny::new("bench-arguments");
    let [t0, t1] = &tiny.mesh;
    let unknown = refused(2, &["bench", "--case", "lace", "--mesh", t0]);
    assert!(unknown.contains("no case is named lace; choose among: draped, cloth-ball, "), "{unknown}");
    assert!(unknown.contains("apart, soup-moving_t0"), "{unknown}");
    assert!(
        refused(2, &["bench", "--mesh", t0, "--mesh", t0]).contains("two cases are named soup-moving_t0")
    );
    assert!(refused(2, &["bench", "--mesh", t0, t1, t1]).contains("error: "));
    assert!(refused(2, &["bench", "--question", "why"]).contains("separation"));
    assert!(refused(2, &tiny.args(&["--question", "distance"])).contains("no case can be asked that"));
    let cuda = ["bench", "--threads", "1", "--backend", "cuda"];
    assert!(refused(2, &cuda).contains("a GPU takes no CPU threads"));
    assert!(refused(2, &["bench", "--list", "--json"]).contains("--list"));
    assert!(refused(3, &["bench", "--case", "no", "--mesh", "no.ply"]).contains("no.ply"));
    assert!(refused(4, &tiny.args(&["--out", &tiny.first])).contains("cannot be written"));
}

#[test]
fn the_list_is_told_and_made() {
    let list = ok(&["bench", "--list"]);
    let names: Vec<&str> = list.lines().filter_map(|line| line.split(' ').next()).collect();
    assert_eq!(names, ["draped", "cloth-ball", "soup", "balls", "pile", "worlds", "apart"]);
    let help = ok(&["bench", "--help"]);
    assert!(help.contains(&names.join(", ")), "{help}");
    let folder = Folder::new("bench-list");
    let mesh = folder.write("still.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    let asked = ["bench", "--mesh", &mesh, "--repeat", "1", "--json", "--question"];
    let asked = [&asked[..], &["discrete", "earliest", "distance"]].concat();
    let all: Value = serde_json::from_str(&ok(&asked)).expect("JSON");
    let found = |case: &str, question: &str| {
        let cases = all["cases"].as_array().expect("rows");
        let of = cases.iter().find(|of| of["case"] == case && of["question"] == question)?;
        Some([&of["bodies"], &of["contacts"]].map(|n| n.as_u64().expect("a count")))
    };
    for name in ["draped", "cloth-ball", "soup", "balls"] {
        assert!(
            found(name, "discrete").is_some_and(|[bodies, pairs]| bodies == 1 && pairs > 1_000),
            "{name}"
        );
        assert_eq!(found(name, "distance"), None, "{name}");
    }
    for name in &names {
        assert!(found(name, "earliest").is_some(), "{name} moves");
    }
    assert!(found("pile", "discrete").is_some_and(|[bodies, pairs]| bodies == 202 && pairs > 1_000));
    assert!(found("worlds", "discrete").is_some_and(|[bodies, pairs]| bodies == 900 && pairs > 1_000));
    assert_eq!((found("apart", "discrete"), found("apart", "distance")), (Some([2, 0]), Some([2, 1])));
    assert_eq!((found("still", "discrete"), found("still", "distance")), (Some([1, 0]), None));
    assert_eq!(found("still", "earliest"), None, "what stands still has no step");
}
