//! `plan`: what a frame launches, holds and moves, and what there is not.

use super::{Folder, SCENE, ok, summary};
use serde_json::Value;

const BOX: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0.2 0.2 -1\nv 0.2 0.3 1\nv 5 5 1\nf 1 2 3\nf 4 5 6\n";

fn sum(all: &Value, of: impl Fn(&Value) -> &Value) -> u64 {
    all.as_array().expect("a list").iter().map(|one| of(one).as_u64().expect("a number")).sum()
}

#[test]
fn the_tables_add_up() {
    let folder = Folder::new("plan-table");
    folder.write("a.obj", BOX);
    let scene = folder.write(
        "scene.toml",
        "[[body]]\nname = \"a\"\nmesh = \"a.obj\"\nkind = \"rigid\"\nposes = [{}, { translation = [0, 0, 1] }]\n\
         [[body]]\nname = \"b\"\nmesh = \"a.obj\"\nkind = \"static\"\n",
    );
    for question in [&["--discrete"][..], &["--continuous"], &["--earliest"], &["--near", "0.1"]] {
        let all = [&["plan", scene.as_str(), "--backend", "cpu"], question].concat();
        let plan = summary(&[&all[..], &["--json"]].concat());
        assert_eq!(
            sum(&plan["frame"], |stage| &stage["launches"]),
            plan["launches"].as_u64().expect("a sum")
        );
        assert_eq!(sum(&plan["buffers"], |buffer| &buffer["bytes"]), plan["bytes"].as_u64().expect("a sum"));
        let poses = if ["--discrete", "--near"].contains(&question[0]) { 64 } else { 128 };
        let up = plan["transfers"].as_array().expect("transfers").iter();
        let up = up.filter(|moved| moved["what"] == "poses of rigid bodies");
        assert_eq!(up.map(|moved| moved["to_device"]["bytes"].as_u64()).collect::<Vec<_>>(), [Some(poses)]);
        assert_eq!(plan["bodies"]["rigid"], serde_json::json!([1, 2]));
        // The same for people.
        let text = ok(&all);
        for part in [
            format!("\na frame: {} launches\n", plan["launches"]),
            format!("\nmemory: {} bytes\n", plan["bytes"]),
            format!("{poses}   1  to the device: poses of rigid bodies\n"),
            "  place        1  vertices where the frame puts them\n".into(),
            "  no ordering on the device: ".into(),
        ] {
            assert!(text.contains(&part), "{part} is not in {text}");
        }
        for absent in ["no poses", "no static tree", "no filters"] {
            assert!(!text.contains(absent), "{absent} is in {text}");
        }
    }
}

#[test]
fn what_cannot_meet_has_no_plan() {
    let folder = Folder::new("plan-none");
    folder.write("a.obj", BOX);
    let scene = folder.write("scene.toml", "[[body]]\nmesh = \"a.obj\"\nkind = \"static\"\n");
    let text = ok(&["plan", &scene, "--backend", "cpu"]);
    for part in ["a frame: 0 launches", "memory: 0 bytes", "  nothing at all: fixed bodies are not tested"] {
        assert!(text.contains(part), "{part} is not in {text}");
    }
}

#[test]
fn the_order_of_tiles_is_told() {
    let told = |more: &[&str]| {
        let scene =
            ["plan", "--scene", "soup", "--triangles", "40", "--discrete", "--no-run", "--backend", "cpu"];
        let text = ok(&[&scene[..], more].concat());
        text.lines().find(|line| line.starts_with("order ")).map(str::to_owned)
    };
    let of = |name: &str, why: &str, line: Option<String>| {
        let line = line.expect("a line");
        assert!(line.starts_with(&format!("order      {name}: ")) && line.ends_with(why), "{line}");
    };
    of("runs", "; by default", told(&[]));
    of("median", "; as asked", told(&["--order", "median"]));
    assert_eq!(told(&["--broad", "tree"]), None);
}

const STAGES: [&str; 8] = ["place", "construct", "fit", "refit", "traverse", "narrow", "order", "a frame"];

#[test]
fn times_are_predicted_and_measured() {
    for question in [&["--discrete"][..], &["--continuous"], &["--earliest"], &["--near", "0.01"]] {
        let scene = ["plan", "--scene", "soup-moving", "--triangles", "3000", "--backend", "cpu"];
        let plan = summary(&[&scene[..], question, &["--json"]].concat());
        let rows = plan["times"].as_array().expect("times");
        assert!(rows.iter().map(|row| row["stage"].as_str()).eq(STAGES.map(Some)), "{question:?}");
        for row in rows {
            let [before, after, measured] = ["before_ms", "after_ms", "measured_ms"]
                .map(|key| row[key].as_f64().unwrap_or_else(|| panic!("{key} of {row}")));
            assert!([before, after, measured].iter().all(|ms| (0.0..60_000.0).contains(ms)), "{row}");
            // Nothing is placed, and on a CPU nothing ordered; all else takes time.
            let idle = ["place", "order"].contains(&row["stage"].as_str().expect("a name"));
            assert_eq!((after > 0.0, measured > 0.0), (!idle, !idle), "{row}");
            match row["ratio"].as_f64() {
                Some(ratio) => assert!((ratio * after - measured).abs() < 1e-9 * measured, "{row}"),
                None => assert!(idle, "{row}"),
            }
        }
        // Both runs stand in the model, so that whoever doubts a prediction can make it again.
        let costs = &plan["model"]["costs"];
        let frame = &plan["model"]["samples"];
        for (at, stage) in STAGES[..7].iter().enumerate() {
            let number = |value: &Value| value.as_f64().expect("a number");
            for run in [0, 1] {
                let sample = &frame[at][run];
                let made = number(&costs[at]["launch_ms"]) * number(&sample["launches"])
                    + number(&costs[at]["item_ms"]) * number(&sample["items"]);
                // Through both points, but where that would make a cost negative.
                let positive = number(&costs[at]["launch_ms"]) > 0.0 && number(&costs[at]["item_ms"]) > 0.0;
                let off = (made - number(&sample["ms"])).abs();
                assert!(!positive || off < 1e-6 * (1.0 + made), "{stage}, {sample}: {made}");
            }
        }
    }
}

#[test]
fn without_a_frame_there_is_what_is_known_before() {
    let scene = ["plan", "--scene", "soup-moving", "--triangles", "300", "--backend", "cpu", "--no-run"];
    let plan = summary(&[&scene[..], &["--json"]].concat());
    assert!(plan.get("frame").is_none() && plan["launches"].is_null(), "{plan}");
    for row in plan["times"].as_array().expect("times") {
        assert!(row["before_ms"].is_f64() && row["measured_ms"].is_null() && row["ratio"].is_null(), "{row}");
    }
    let text = ok(&scene);
    assert!(text.contains("solver     certified") && text.contains("before     after  measured"), "{text}");
    assert!(!text.contains("a frame: ") && !text.contains("memory: "), "{text}");
    let refused = super::refused(2, &["detect", "--scene", "soup", "--no-run"]);
    assert!(refused.contains("--no-run"), "{refused}");
}

#[test]
fn a_plan_is_what_would_run() {
    let plan = |more: &[&str]| ok(&[&["plan"], &SCENE[1..], more].concat());
    let usual = plan(&["--backend", "cpu", "--threads", "2"]);
    for part in [
        "300 triangles, 900 vertices, positions in f32, two frames",
        "Continuous, self",
        "CPU, 2 threads (cpu)",
        "broad      tiles: 32 neighbours against 32, no tree; the fastest on this machine",
        "linear",
        "certified: no contact is missed",
        "tolerance  7.62939453125e-6, about 1e-4 of the mean edge; at most 4096 boxes a pair",
        "a frame: ",
    ] {
        assert!(usual.contains(part), "{part} is not in {usual}");
    }
    let other =
        plan(&["--discrete", "--solver", "moller", "--traversal", "per-leaf-spill", "--backend", "cpu"]);
    for part in [
        "Discrete, self",
        "moller: a float test",
        "as asked",
        "Levels: the fastest on this machine",
        "aabb\n",
    ] {
        assert!(other.contains(part), "{part} is not in {other}");
    }
    let queues = plan(&["--traversal", "queue-gtx285", "--queue", "100", "--backend", "cpu"]);
    for part in ["cores: Some(128)", "local: 100", "take: 192", "balance: Copy"] {
        assert!(queues.contains(part), "{part} is not in {queues}");
    }
    let folder = Folder::new("plan");
    let a = folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    assert!(ok(&["plan", &a, "--with", &a]).contains("Discrete, within and between"));
}
