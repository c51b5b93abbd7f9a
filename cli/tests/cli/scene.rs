//! `nearmiss lab scene`.

use super::{Folder, ok, summary};

#[test]
fn a_scene_that_is_written_is_the_scene() {
    let folder = Folder::new("scene");
    for name in ["draped", "cloth-ball", "grid", "soup-moving"] {
        let dir = folder.path("new/deep");
        let uses_chance = ["cloth-ball", "soup-moving"].contains(&name);
        let seed: &[&str] = if uses_chance { &["--seed", "4"] } else { &[] };
        let made = |of: &[&'static str]| [of, &["--triangles", "500"], seed].concat();
        let written = ok(&[&made(&["lab", "scene", name])[..], &["--out", &dir]].concat());
        let files: Vec<&str> = written.lines().map(|line| line.split(": ").next().expect("a path")).collect();
        assert_eq!(files.len(), if name == "grid" { 1 } else { 2 }, "{written}");
        let from_files = summary(&[&["detect", "--json"], &files[..]].concat());
        let itself = summary(&made(&["detect", "--json", "--scene", name]));
        for key in ["hash", "triangles", "vertices", "frames", "contacts", "candidates", "query"] {
            assert_eq!(from_files[key], itself[key], "{name}, {key}");
        }
    }
    let one =
        ok(&["lab", "scene", "balls", "--triangles", "64", "--frames", "1", "--out", &folder.path("one")]);
    assert_eq!(one.lines().count(), 1);
}

#[test]
fn an_animation_is_written_frame_by_frame() {
    let folder = Folder::new("animation");
    let write = |dir: &str, more: &[&str]| {
        let dir = folder.path(dir);
        let written =
            ok(&[&["lab", "scene", "flamenco", "--triangles", "300", "--out", &dir][..], more].concat());
        written.lines().map(|line| line.split(": ").next().expect("a path").to_owned()).collect::<Vec<_>>()
    };
    let all = write("all", &["--frames", "4", "--skip", "0"]);
    assert_eq!(all.len(), 4);
    assert!(all[0].ends_with("flamenco_0000.ply") && all[3].ends_with("flamenco_0003.ply"), "{all:?}");
    let bytes = |path: &String| std::fs::read(path).expect("a frame");
    let last = write("last", &["--frames", "1", "--skip", "3"]);
    assert_eq!(bytes(&last[0]), bytes(&all[3]));
    assert_ne!(bytes(&all[2]), bytes(&all[3]));
    let kept = write("kept", &["--frames", "1", "--skip", "3", "--contact"]);
    let pairs = |path: &str| summary(&["detect", path, "--adjacent", "--json"])["contacts"].as_u64();
    assert!(pairs(&last[0]) > Some(0) && pairs(&kept[0]) == Some(0));
}
