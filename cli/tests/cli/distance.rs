//! `--distance`: text, JSON, files, and what is refused.

use super::{Folder, ok, run, summary};

/// A triangle, and one over it.
const LOW: &str = "v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\n";
const HIGH: &str = "v 9 9 9\nv 1 1 0.25\nv 1 2 1\nv 2 1 1\nf 2 3 4\n";

#[test]
fn the_nearest_triangles_are_told() {
    let folder = Folder::new("distance");
    let (low, high) = (folder.write("low.obj", LOW), folder.write("high.obj", HIGH));
    let asked = ["detect", &low, "--with", &high, "--backend", "cpu", "--distance"];
    let text = ok(&[&asked[..], &["-v"]].concat());
    assert!(text.contains("distance by bounded"), "{text}");
    assert!(text.starts_with("distance 0.25, triangle 0 of body 0 and 0 of body 1; "), "{text}");
    assert!(text.contains("from [1.0, 1.0, 0.0] to [1.0, 1.0, 0.25]"), "{text}");
    let all = summary(&[&asked[..], &["--json"]].concat());
    assert_eq!((&all["query"], &all["traversal"]), (&"distance".into(), &"nearest-first".into()), "{all}");
    let nearest = &all["nearest"];
    assert_eq!(
        (&nearest["distance"], &nearest["bodies"]),
        (&0.25.into(), &serde_json::json!([0, 1])),
        "{all}"
    );
    assert_eq!(nearest["weights"], serde_json::json!([[0.5, 0.25, 0.25], [1.0, 0.0, 0.0]]), "{all}");

    let csv = folder.path("distance.csv");
    ok(&[&asked[..], &["--out", &csv]].concat());
    let rows = "body_a,body_b,tri_a,tri_b,distance,x_a,y_a,z_a,x_b,y_b,z_b\n0,1,0,0,0.25,1,1,0,1,1,0.25\n";
    assert_eq!(std::fs::read_to_string(&csv).expect("written"), rows);
    let json = folder.path("distance.json");
    ok(&[&asked[..], &["--out", &json]].concat());
    let told: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(&json).expect("written")).expect("JSON");
    assert_eq!(told["contacts"][0]["distance"], 0.25, "{told}");
    let plan = ok(&["lab", "plan", &low, "--with", &high, "--backend", "cpu", "--distance"]);
    assert!(plan.contains("nearest first, then per leaf") && plan.contains("pairs within a body"), "{plan}");
}

/// A ball of three vertices comes down on a triangle, frame after frame.
#[test]
fn a_scene_of_frames_tells_each_distance() {
    let folder = Folder::new("distance-frames");
    folder.write("low.obj", LOW);
    folder.write("high.obj", HIGH);
    let pose = |z: f64| format!("{{ translation = [0.0, 0.0, {z:?}] }}");
    let scene = format!(
        "[[body]]\nkind = \"fixed\"\nmeshes = [\"low.obj\"]\n\
         [[body]]\nkind = \"rigid\"\nmeshes = [\"high.obj\"]\nposes = [{}, {}, {}]\n",
        pose(1.0),
        pose(0.0),
        pose(0.5)
    );
    let text = ok(&["detect", &folder.write("scene.toml", &scene), "--backend", "cpu", "--distance"]);
    for line in ["frame 0: distance 1.25,", "frame 1: distance 0.25,", "frame 2: distance 0.75,"] {
        assert!(text.contains(line), "{text}");
    }
    assert!(text.contains("least distance 0.25, in frame 1 of 3;"), "{text}");
}

#[test]
fn one_mesh_has_no_distance_and_says_why() {
    let folder = Folder::new("no-distance");
    let low = folder.write("low.obj", LOW);
    let text = ok(&["detect", &low, "--backend", "cpu", "--distance"]);
    assert!(text.contains("no two bodies may meet: give a second one"), "{text}");
    let all = summary(&["detect", &low, "--distance", "--json"]);
    assert_eq!((&all["nearest"], &all["contacts"]), (&serde_json::Value::Null, &0.into()), "{all}");
}

#[test]
fn options_that_a_distance_does_not_take_are_refused() {
    let folder = Folder::new("distance-refused");
    let low = folder.write("low.obj", LOW);
    for (option, what) in [
        (&["--traversal", "queue"][..], "a distance has its own walk"),
        (&["--tolerance", "1e-3"], "the distance at t = 0 has no such limit"),
        (&["--adjacent"], "never within one"),
        (&["--near", "1"], "cannot be used with"),
        (&["--earliest"], "cannot be used with"),
        (&["--solver", "exact"], "--solver exact cannot be used with a distance query; use one of: bounded"),
    ] {
        let said = run(&[&["detect", &low, "--distance"], option].concat());
        let text = String::from_utf8_lossy(&said.stderr);
        assert!(said.status.code() == Some(2) && text.contains(what), "{option:?}: {text}");
    }
}
