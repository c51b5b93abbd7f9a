//! The summary of a query: its keys, its hash, and its text.

use super::{SCENE, ok, refused, summary};

const KEYS: [&str; 20] = [
    "triangles",
    "edges",
    "points",
    "vertices",
    "frames",
    "query",
    "bounding_volume",
    "refit",
    "traversal",
    "solver",
    "backend",
    "device",
    "candidates",
    "contacts",
    "undecided",
    "earliest_toi",
    "hash",
    "ms",
    "bytes",
    "triangle_pairs",
];

#[test]
fn the_summary_has_its_keys() {
    for question in ["--discrete", "--continuous", "--earliest"] {
        let summary = summary(&[&SCENE[..], &["--json", "--backend", "cpu", question]].concat());
        let missing: Vec<_> = KEYS.iter().filter(|key| summary.get(**key).is_none()).collect();
        assert!(missing.is_empty(), "{question}: {missing:?} of {summary}");
        let number = |key: &str| summary[key].as_u64().unwrap_or_else(|| panic!("{key}: {}", summary[key]));
        assert_eq!([number("triangles"), number("vertices"), number("frames")], [300, 900, 2]);
        assert!(number("candidates") > 0 && number("contacts") > 0 && number("bytes") > 0);
        assert_eq!(
            (summary["query"].as_str(), summary["backend"].as_str()),
            (Some(&question[2..]), Some("cpu"))
        );
        let hash = summary["hash"].as_str().expect("a hash");
        assert!(hash.len() == 16 && u64::from_str_radix(hash, 16).is_ok(), "{hash}");
        let ms = summary["ms"].as_object().expect("times by stage");
        for stage in ["construct", "fit", "refit", "traverse", "narrow", "total", "launch", "wall"] {
            assert!(ms[stage].as_f64().is_some_and(|ms| ms >= 0.0), "{stage}: {}", ms[stage]);
        }
        let toi = summary["earliest_toi"].as_f64();
        assert_eq!(toi.is_some(), question != "--discrete");
        assert!(toi.is_none_or(|toi| (0.0..=1.0).contains(&toi)));
    }
}

#[test]
fn choices_change_no_hash() {
    let hash = |more: &[&str]| summary(&[&SCENE[..], &["--json"], more].concat())["hash"].clone();
    let truth = hash(&[]);
    let same: [&[&str]; 11] = [
        &["--backend", "cpu"],
        &["--threads", "1"],
        &["--threads", "3", "--traversal", "per-leaf"],
        &["--traversal", "per-leaf-spill"],
        &["--traversal", "queue", "--repeat", "2"],
        &["--traversal", "queue-gtx285", "--cores", "30"],
        &["--traversal", "steal", "--cores", "3", "--queue", "5"],
        &["--solver", "certified", "--bounding-volume", "aabb", "--continuous", "--max-iterations", "4096"],
        &["--repeat", "3"],
        &["--refit", "levels"],
        &["--refit", "treelets", "--repeat", "2"],
    ];
    for more in same {
        assert_eq!(hash(more), truth, "{more:?}");
    }
    assert_ne!(hash(&["--seed", "2"]), truth);
    assert_ne!(hash(&["--discrete"]), truth);
    assert_ne!(hash(&["--tolerance", "1e-3"]), truth, "times are charged what is tolerated");
}

#[test]
fn the_summary_for_people_says_the_same() {
    let people = ok(&[&SCENE[..], &["-v"]].concat());
    let json = summary(&[&SCENE[..], &["--json"]].concat());
    for part in ["300 triangles, 900 vertices", "continuous by certified on", "tolerance 7.6"] {
        assert!(people.contains(part), "{people}");
    }
    assert!(people.starts_with(&format!("{} contacts, first at t = ", json["contacts"])), "{people}");
    assert!(people.contains(&format!("hash        {}", json["hash"].as_str().expect("a hash"))), "{people}");
    // Without -v that is one line, and what a reader must know.
    let short = ok(&SCENE);
    assert!(short.lines().skip(1).all(|line| line.starts_with("  note: ")), "{short}");
    let (first, same) = (short.lines().next().expect("a line"), people.lines().next().expect("a line"));
    assert!(first.ends_with(" MB") && first.len() < 80, "{first}");
    assert_eq!(first.split(';').next(), same.split(';').next());
    assert!(refused(2, &[&SCENE[..], &["-v", "--json"]].concat()).contains("cannot be used with"));
}
