//! Thickness of bodies in a scene file, and of meshes of the command line.

use super::*;

/// Two triangles, one above the other by 1.
fn triangles(folder: &Folder) -> [String; 2] {
    let at = |z: f64| format!("v 0 0 {z}\nv 1 0 {z}\nv 0 1 {z}\nf 1 2 3\n");
    [folder.write("low.obj", &at(0.0)), folder.write("high.obj", &at(1.0))]
}

fn scene(folder: &Folder, low: &str, high: &str) -> String {
    let text = format!(
        "[[body]]\nname = \"low\"\nmesh = \"low.obj\"\n{low}\n[[body]]\nname = \"high\"\nmesh = \"high.obj\"\n{high}\n"
    );
    folder.write("scene.toml", &text)
}

#[test]
fn radii_of_a_file_and_of_the_command_line_count() {
    let folder = Folder::new("scene-thickness");
    let [low, high] = triangles(&folder);
    let csv = folder.path("rows.csv");
    let rows = |args: &[&str]| {
        ok(&[args, &["--out", &csv]].concat());
        folder.read("rows.csv").lines().count() - 1
    };
    let of = |low: &str, high: &str, distance: &str| {
        rows(&["detect", &scene(&folder, low, high), "--near", distance])
    };
    assert_eq!(of("", "", "0.9"), 0);
    assert_eq!(of("thickness = 0.25", "thickness = 0.75", "0"), 15);
    // Pairs that have points at vertex 2: one for each vertex, four of edges.
    assert_eq!(of("thickness = 0.25", "thickness = [0.25, 0.25, 0.75]", "0"), 6);
    let two = ["detect", low.as_str(), "--with", high.as_str(), "--near", "0.5", "--thickness"];
    assert_eq!(rows(&[&two[..], &["0.25"]].concat()), 15);
    assert_eq!(rows(&[&two[..], &["0.2"]].concat()), 0);
}

/// A step of two bodies that touch, and of one that comes within its radius.
#[test]
fn bodies_with_one_and_without_are_in_one_step() {
    let folder = Folder::new("scene-thickness-mixed");
    let at = |name: &str, z: f64| {
        folder.write(&format!("{name}.obj"), &format!("v 0 0 {z}\nv 1 0 {z}\nv 0 1 {z}\nf 1 2 3\n"))
    };
    for (name, z) in [("low", 0.0), ("falls", 1.0), ("fell", -1.0), ("high", 4.0), ("lower", 1.5)] {
        at(name, z);
    }
    let step = |thickness: &str| {
        let text = format!(
            "[[body]]\nmesh = \"low.obj\"\nkind = \"fixed\"\n\
             [[body]]\nmeshes = [\"falls.obj\", \"fell.obj\"]\n\
             [[body]]\nmeshes = [\"high.obj\", \"lower.obj\"]\n{thickness}\n"
        );
        summary(&["detect", &folder.write("scene.toml", &text), "--continuous", "--json"])
    };
    let counts =
        ["", "thickness = 1.75"].map(|thickness| step(thickness)["contacts"].as_u64().expect("a count"));
    assert!(0 < counts[0] && counts[0] < counts[1], "{counts:?}");
}

#[test]
fn a_thickness_that_cannot_be_is_refused() {
    let folder = Folder::new("scene-thickness-bad");
    let [low, high] = triangles(&folder);
    for (own, said) in [
        ("thickness = -1", "low.obj must be from 0 to 2^60, got -1"),
        ("thickness = nan", "got NaN"),
        ("thickness = [0.1]", "1 radii for 3 vertices"),
        ("thickness = \"thick\"", "`thickness` must be a number, or a list of numbers"),
    ] {
        let message = refused(3, &["detect", &scene(&folder, own, ""), "--near", "1"]);
        assert!(message.contains(said), "{own}: {message}");
    }
    let toml = scene(&folder, "", "");
    for (args, said) in [
        (vec![low.as_str(), "--thickness", "0.1"], "--thickness has no effect: a discrete query ignores it"),
        (vec![low.as_str(), "--with", &high, "--distance", "--thickness", "0.1"], "ignores it"),
        (vec![low.as_str(), "--near", "1", "--thickness", "-1"], "must be from 0 to 2^60, got -1"),
        (vec![toml.as_str(), "--near", "1", "--thickness", "0.1"], "write `thickness = R`"),
    ] {
        let message = refused(2, &[&["detect"], &args[..]].concat());
        assert!(message.contains(said), "{args:?}: {message}");
    }
}
