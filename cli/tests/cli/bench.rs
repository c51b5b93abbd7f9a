//! `bench`: cases, files and ratios; and that planted faults show.

use super::{Folder, err, ok, out, refused, run};
use serde_json::Value;

const HEAD: &str = "machine,threads,version,case,triangles,bodies,question,stage,frames,\
                    median_ms,low_ms,high_ms,candidates,contacts,bytes,hash";
const STAGES: [&str; 11] = [
    "place",
    "construct",
    "fit",
    "refit",
    "traverse",
    "balance",
    "narrow",
    "order",
    "total",
    "launch",
    "wall",
];
const QUESTIONS: [&str; 5] = ["discrete", "continuous", "separation", "earliest", "near"];

/// Columns and their values.
type Cells<'a> = &'a [(&'a str, &'a str)];

/// A case of some triangles, and a first file of its figures.
struct Tiny {
    folder: Folder,
    mesh: [String; 2],
    first: String,
}

impl Tiny {
    fn new(name: &str) -> Tiny {
        let folder = Folder::new(name);
        ok(&["lab", "scene", "soup-moving", "--triangles", "60", "--out", folder.name()]);
        let mesh = ["t0", "t1"].map(|at| folder.path(&format!("soup-moving_{at}.ply")));
        let tiny = Tiny { first: folder.path("first/bench.csv"), folder, mesh };
        ok(&tiny.args(&["--out", &tiny.folder.path("first")]));
        tiny
    }

    /// The arguments of its query, and more.
    fn args<'a>(&'a self, more: &[&'a str]) -> Vec<&'a str> {
        let [t0, t1] = &self.mesh;
        let own = ["lab", "bench", "--case", "soup-moving_t0", "--mesh", t0, t1, "--backend", "cpu"];
        [&own[..], &["--threads", "1", "--repeat", "3"], more].concat()
    }

    fn rows(&self) -> Vec<Vec<String>> {
        let text = self.folder.read("first/bench.csv");
        text.lines().map(|line| line.split(',').map(str::to_owned).collect()).collect()
    }

    /// The first file's path, with other cells in the rows that have such ones.
    fn planted(&self, of: Cells, to: Cells) -> String {
        let mut rows = self.rows();
        let at = |column: &str| HEAD.split(',').position(|head| head == column).expect("a column");
        let mut planted = 0;
        for row in &mut rows[1..] {
            if of.iter().all(|(column, value)| row[at(column)] == *value) {
                to.iter().for_each(|(column, value)| row[at(column)] = (*value).to_owned());
                planted += 1;
            }
        }
        assert!(planted > 0, "{of:?}");
        let text: String = rows.iter().map(|row| row.join(",") + "\n").collect();
        self.folder.write("planted.csv", &text)
    }

    /// Standard output and the message of a comparison that ends with status 4.
    fn fault(&self, more: &[&str]) -> [String; 2] {
        let output = run(&self.args(more));
        assert_eq!(output.status.code(), Some(4), "{more:?}: {}", err(&output));
        [out(&output), err(&output)]
    }
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value}"))
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
    let [t0, t1] = &tiny.mesh;
    for (question, files) in [("discrete", &[t0][..]), ("continuous", &[t0, t1])] {
        let files: Vec<&str> = files.iter().map(|file| file.as_str()).collect();
        let detect = super::summary(
            &[&["detect"], &files[..], &["--backend", "cpu", "--threads", "1", "--json"]].concat(),
        );
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
fn the_same_again_has_ratios_and_no_fault() {
    let tiny = Tiny::new("bench-again");
    let args = tiny.args(&["--against", &tiny.first, "--limit", "1e9"]);
    let json = ok(&[&args[..], &["--json"]].concat());
    let all: Value = serde_json::from_str(&json).expect("JSON");
    let cases = all["cases"].as_array().expect("rows");
    assert_eq!(cases.len(), QUESTIONS.len());
    for case in cases {
        assert_eq!(case["hash"], case["earlier_hash"], "{case}");
        for times in case["stages"].as_array().expect("rows") {
            let [now, earlier] = ["median_ms", "earlier_ms"].map(|key| number(&times[key]));
            match times["ratio"].as_f64() {
                Some(ratio) => assert!((ratio * earlier - now).abs() <= 1e-9 * now, "{times}"),
                None => assert_eq!(earlier, 0.0, "{times}"),
            }
        }
    }
    let against = &all["against"];
    assert_eq!((&against["is_other_machine"], &against["machine"]), (&false.into(), &all["machine"]));
    for empty in ["faults", "only_now", "only_earlier"] {
        assert_eq!(against[empty], serde_json::json!([]), "{empty}");
    }
    let text = ok(&args);
    assert!(text.contains("  now/earlier ") && text.contains("all answers in both"), "{text}");
}

#[test]
fn another_answer_is_a_fault() {
    let tiny = Tiny::new("bench-answer");
    let now = &tiny.rows()[1][15];
    let planted = tiny.planted(&[("question", "discrete")], &[("hash", "0123456789abcdef")]);
    let [printed, said] = tiny.fault(&["--against", &planted]);
    let fault = format!("soup-moving_t0, discrete: the answer has the hash {now}, and in ");
    assert!(said.contains(&fault) && said.contains("planted.csv 0123456789abcdef; "), "{said}");
    assert!(printed.contains(&format!("FAULT {fault}")) && printed.contains("wall"), "{printed}");
    let [printed, _] = tiny.fault(&["--against", &planted, "--json"]);
    let all: Value = serde_json::from_str(&printed).expect("JSON");
    assert_eq!(all["against"]["faults"].as_array().map(Vec::len), Some(1), "{printed}");
    // All else is as it was.
    ok(&tiny.args(&["--against", &planted, "--question", "near"]));
}

#[test]
fn a_frame_that_takes_too_long_is_a_fault() {
    let tiny = Tiny::new("bench-limit");
    for stage in ["total", "wall"] {
        for short in ["0.000001", "0"] {
            let cells = [("median_ms", short), ("low_ms", "0")];
            let planted = tiny.planted(&[("question", "earliest"), ("stage", stage)], &cells);
            let [printed, said] = tiny.fault(&["--against", &planted, "--limit", "100"]);
            assert!(said.contains(&format!("soup-moving_t0, earliest: {stage} takes ")), "{said}");
            assert!(
                said.contains(&format!("planted.csv {short} ms: more than 100 times as long; ")),
                "{said}"
            );
            assert!(printed.matches("FAULT ").count() == 1, "{printed}");
            // Reported, and no fault without a limit.
            assert!(ok(&tiny.args(&["--against", &planted])).contains("now/earlier"));
        }
    }
    // A single stage has no limit.
    let planted = tiny.planted(&[("stage", "fit")], &[("median_ms", "0.000001"), ("low_ms", "0")]);
    ok(&tiny.args(&["--against", &planted, "--limit", "100"]));
}

#[test]
fn what_only_one_has_is_told() {
    let tiny = Tiny::new("bench-only");
    let planted = tiny.planted(&[("question", "near")], &[("question", "far")]);
    let against = tiny.args(&["--against", &planted]);
    let text = ok(&against);
    assert!(text.contains("planted.csv: soup-moving_t0, near\n") && text.contains("not in "), "{text}");
    assert!(text.contains("planted.csv: soup-moving_t0, far\n") && text.contains("only in "), "{text}");
    // Rows that are not chosen are not missed.
    let text = ok(&[&against[..], &["--question", "discrete"]].concat());
    assert!(!text.contains("only in ") && !text.contains("not in "), "{text}");
    // A file without any chosen row would always pass.
    let near = [&against[..], &["--question", "near"]].concat();
    assert!(refused(2, &near).contains("--against has no effect"));
    tiny.planted(&[("question", "near")], &[("case", "gone")]);
    assert!(!ok(&against).contains("gone"));
    tiny.planted(&[], &[("case", "gone")]);
    assert!(refused(2, &against).contains("--against has no effect"));
}

#[test]
fn another_machine_is_said_and_has_no_limit() {
    let tiny = Tiny::new("bench-machine");
    for cells in [("machine", "An Abacus"), ("threads", "3"), ("threads", "")] {
        let planted = tiny.planted(&[], &[cells]);
        let text = ok(&tiny.args(&["--against", &planted]));
        assert!(text.contains("another machine") && text.contains("now/earlier"), "{text}");
        let said = refused(2, &tiny.args(&["--against", &planted, "--limit", "2"]));
        assert!(
            said.contains("--limit needs a file of this machine") && said.contains("; remove it, or give"),
            "{said}"
        );
        assert!(said.contains(if cells.1.is_empty() { "planted.csv" } else { cells.1 }), "{said}");
    }
}

#[test]
fn a_file_that_is_not_one_is_named_with_its_line() {
    let tiny = Tiny::new("bench-malformed");
    let first: Cells = &[("question", "discrete"), ("stage", "construct")];
    let malformed = |cells: Cells, part: &str| {
        let planted = tiny.planted(first, cells);
        let said = refused(3, &tiny.args(&["--against", &planted]));
        assert!(said.contains("planted.csv: line 3: ") && said.contains(part), "{cells:?}: {said}");
        assert!(said.contains("; fix it, or measure again"), "{said}");
    };
    malformed(&[("median_ms", "fast")], "median_ms is \"fast\", and must be a number from 0");
    malformed(&[("triangles", "-1")], "triangles is \"-1\"");
    malformed(&[("threads", "two")], "threads is \"two\"");
    malformed(&[("bytes", "")], "bytes is \"\"");
    malformed(&[("median_ms", "NaN")], "median_ms is NaN");
    malformed(&[("high_ms", "inf")], "high_ms is inf");
    malformed(&[("low_ms", "-1")], "low_ms is -1");
    malformed(&[("median_ms", "5"), ("low_ms", "6"), ("high_ms", "7")], "from low_ms, 6, to high_ms, 7");
    malformed(&[("hash", "12")], "hash is \"12\"");
    malformed(&[("hash", "0123456789abcdeg")], "sixteen hexadecimal digits");
    malformed(&[("hash", "0123456789abcdef")], "hash of soup-moving_t0, discrete is 0123456789abcdef");
    malformed(&[("machine", "An Abacus")], "An Abacus");
    malformed(&[("version", "0.0.0")], "version 0.0.0");
    malformed(&[("stage", "place")], "the stage place of soup-moving_t0, discrete");

    let text = tiny.folder.read("first/bench.csv");
    let whole = |text: &str, part: &str| {
        let file = tiny.folder.write("whole.csv", text);
        let said = refused(3, &tiny.args(&["--against", &file]));
        assert!(said.contains("whole.csv: ") && said.contains(part), "{part}: {said}");
    };
    for column in HEAD.split(',') {
        let renamed: Vec<&str> =
            HEAD.split(',').map(|head| if head == column { "other" } else { head }).collect();
        whole(&text.replacen(HEAD, &renamed.join(","), 1), &format!("line 1: has no column {column}; give"));
    }
    whole("", "has no column machine");
    whole(&format!("{HEAD}\n"), "has no rows");
    whole(&text.replacen(",place,", ",", 1), "line: 2");
    for stage in ["total", "wall"] {
        let other = text.replacen(&format!("near,{stage},"), "near,other,", 1);
        whole(&other, &format!("has no row of soup-moving_t0, near for the stage {stage}"));
    }
    let missing = tiny.folder.path("no.csv");
    assert!(refused(3, &tiny.args(&["--against", &missing])).contains("no.csv: cannot be read: "));
    // A column and a stage more are passed over.
    let more: String = text.lines().map(|line| format!("{line},more\n")).collect();
    let more = tiny.folder.write("more.csv", &more.replace(",balance,", ",unbalance,"));
    ok(&tiny.args(&["--against", &more]));
}

#[test]
fn arguments_that_ask_nothing_are_refused() {
    let tiny = Tiny::new("bench-arguments");
    let [t0, t1] = &tiny.mesh;
    let unknown = refused(2, &["lab", "bench", "--case", "lace", "--mesh", t0]);
    assert!(unknown.contains("--case is unknown, got lace; use one of: draped, cloth-ball, "), "{unknown}");
    assert!(unknown.contains("apart, soup-moving_t0"), "{unknown}");
    assert!(
        refused(2, &["lab", "bench", "--mesh", t0, "--mesh", t0])
            .contains("--mesh names a case twice, got soup-moving_t0")
    );
    assert!(refused(2, &["lab", "bench", "--mesh", t0, t1, t1]).contains("error: "));
    assert!(refused(2, &["lab", "bench", "--question", "why"]).contains("separation"));
    assert!(
        refused(2, &tiny.args(&["--question", "distance"])).contains("--question fits none of the cases")
    );
    assert!(refused(2, &["lab", "bench", "--limit", "2"]).contains("--against"));
    for limit in ["0", "-1", "NaN", "inf", "twice"] {
        let said = refused(2, &tiny.args(&["--against", &tiny.first, "--limit", limit]));
        assert!(said.contains("give a number above 0"), "{limit}: {said}");
    }
    let cuda = ["lab", "bench", "--threads", "1", "--backend", "cuda"];
    assert!(refused(2, &cuda).contains("a GPU has no CPU threads"));
    assert!(refused(2, &["lab", "bench", "--list", "--json"]).contains("--list"));
    // The earlier file stays.
    let before = tiny.folder.read("first/bench.csv");
    let args = tiny.args(&["--against", &tiny.first, "--out"]);
    let said = refused(2, &[&args[..], &[&tiny.folder.path("first")]].concat());
    assert!(said.contains("--out would overwrite ") && said.contains("first/bench.csv"), "{said}");
    assert_eq!(tiny.folder.read("first/bench.csv"), before);
    assert!(refused(3, &["lab", "bench", "--case", "no", "--mesh", "no.ply"]).contains("no.ply"));
    assert!(refused(4, &tiny.args(&["--out", &tiny.first])).contains("cannot be written"));
}

#[test]
fn the_list_is_told_and_made() {
    let list = ok(&["lab", "bench", "--list"]);
    let names: Vec<&str> = list.lines().filter_map(|line| line.split(' ').next()).collect();
    assert_eq!(names, ["draped", "cloth-ball", "soup", "balls", "pile", "worlds", "apart"]);
    let folder = Folder::new("bench-list");
    let mesh = folder.write("still.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    let asked = ["lab", "bench", "--mesh", &mesh, "--repeat", "1", "--json", "--question"];
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
