//! `plan`: what a frame launches, holds and moves, and what there is not.

use super::{Folder, ok, summary};
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
    for part in
        ["a frame: 0 launches", "memory: 0 bytes", "  nothing at all: what is static is not asked about"]
    {
        assert!(text.contains(part), "{part} is not in {text}");
    }
}
