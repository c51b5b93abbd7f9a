//! `lab plan`: the kernels, memory and transfers of a frame, and the stages that it skips.

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
         [[body]]\nname = \"b\"\nmesh = \"a.obj\"\nkind = \"fixed\"\n",
    );
    for question in [&["--discrete"][..], &["--continuous"], &["--earliest"], &["--near", "0.1"]] {
        let all = [&["lab", "plan", scene.as_str(), "--backend", "cpu"], question].concat();
        let plan = summary(&[&all[..], &["--json"]].concat());
        assert_eq!(
            sum(&plan["frame"], |stage| &stage["launches"]),
            plan["launches"].as_u64().expect("a sum")
        );
        assert_eq!(sum(&plan["buffers"], |buffer| &buffer["bytes"]), plan["bytes"].as_u64().expect("a sum"));
        // Instances have two poses each, fixed ones too.
        let (poses, uploads) = (256, 1);
        let placing = "  no placing of vertices: vertices are placed as they are read\n";
        let up = plan["transfers"].as_array().expect("transfers").iter();
        let up = up.filter(|moved| moved["what"] == "poses of rigid bodies");
        assert_eq!(up.map(|moved| moved["to_device"]["bytes"].as_u64()).collect::<Vec<_>>(), [Some(poses)]);
        assert_eq!(plan["bodies"]["rigid"], serde_json::json!([1, 2]));
        // The same for people.
        let text = ok(&all);
        for part in [
            format!("\na frame: {} launches\n", plan["launches"]),
            format!("\nmemory: {} bytes\n", plan["bytes"]),
            format!("{poses}   {uploads}  to the device: poses of rigid bodies\n"),
            placing.into(),
            "  no ordering on the device: ".into(),
        ] {
            assert!(text.contains(&part), "{part} is not in {text}");
        }
        for absent in ["no poses", "no fixed tree", "no filters"] {
            assert!(!text.contains(absent), "{absent} is in {text}");
        }
    }
}

#[test]
fn what_cannot_meet_has_no_plan() {
    let folder = Folder::new("plan-none");
    folder.write("a.obj", BOX);
    let scene = folder.write("scene.toml", "[[body]]\nmesh = \"a.obj\"\nkind = \"fixed\"\n");
    let text = ok(&["lab", "plan", &scene, "--backend", "cpu"]);
    for part in ["a frame: 0 launches", "memory: 0 bytes", "  nothing at all: fixed bodies are not tested"] {
        assert!(text.contains(part), "{part} is not in {text}");
    }
}

#[test]
fn without_a_frame_there_are_the_options_in_use() {
    let scene =
        ["lab", "plan", "--scene", "soup-moving", "--triangles", "300", "--backend", "cpu", "--no-run"];
    let plan = summary(&[&scene[..], &["--json"]].concat());
    assert!(plan.get("frame").is_none() && plan["launches"].is_null(), "{plan}");
    let text = ok(&scene);
    assert!(text.contains("solver          certified"), "{text}");
    assert!(!text.contains("a frame: ") && !text.contains("memory: "), "{text}");
    let refused = super::refused(2, &["detect", "--scene", "soup", "--no-run"]);
    assert!(refused.contains("--no-run"), "{refused}");
}

/// Times are measured by `detect` and `lab bench`; a plan counts.
#[test]
fn a_plan_has_no_times() {
    let scene = ["lab", "plan", "--scene", "soup-moving", "--triangles", "300", "--backend", "cpu"];
    let plan = summary(&[&scene[..], &["--json"]].concat());
    assert!(plan.get("times").is_none() && plan.get("model").is_none(), "{plan}");
    assert!(!plan.to_string().contains("_ms\""), "{plan}");
    assert!(plan["launches"].as_u64() > Some(0) && plan["bytes"].as_u64() > Some(0), "{plan}");
    assert_eq!(plan, summary(&[&scene[..], &["--json"]].concat()), "every number is counted");
}

#[test]
fn a_plan_is_what_would_run() {
    let plan = |more: &[&str]| ok(&[&["lab", "plan"], &SCENE[1..], more].concat());
    let usual = plan(&["--backend", "cpu", "--threads", "2"]);
    for part in [
        "300 triangles, 900 vertices, positions in f32, two frames",
        "query           continuous, of one body with itself\n",
        "CPU, 2 threads (cpu)",
        "kernels         Rust, compiled for the CPU\n",
        "broad phase     tiles: the default of this machine\n",
        "bounding volume linear\n",
        "certified: no contact is missed",
        "tolerance       7.62939453125e-6, about 1e-4 of the mean edge\n",
        "iterations      at most 4096 for a pair\n",
        "min separation  0: touching\n",
        "a frame: ",
    ] {
        assert!(usual.contains(part), "{part} is not in {usual}");
    }
    let other =
        plan(&["--discrete", "--solver", "moller", "--traversal", "per-leaf-spill", "--backend", "cpu"]);
    for part in [
        "discrete, of one body",
        "moller: a float test",
        "per leaf, spilling after 64 steps: as given",
        "levels: the default of this machine",
        "aabb\n",
    ] {
        assert!(other.contains(part), "{part} is not in {other}");
    }
    let queues = plan(&["--traversal", "queue-gtx285", "--queue", "100", "--backend", "cpu"]);
    let shape = "128 queues, 100 units on chip, 192 taken at a time, balanced by copying: as given";
    assert!(queues.contains(shape), "{queues}");
    let folder = Folder::new("plan");
    let a = folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    assert!(ok(&["lab", "plan", &a, "--with", &a]).contains("discrete, within and between bodies"));
}
