//! Poses in files of scenes: matrices, pivots, turns and paths.

use super::{Folder, refused, summary};
use serde_json::Value;

/// A peg that stands still, and a bar that moves as the text says.
fn scene(folder: &Folder, bar: &str) -> String {
    folder.write("bar.obj", "v -2 0 0\nv 2 0 0\nv 0 0.1 0\nf 1 2 3\n");
    folder.write("peg.obj", "v 0 1.5 -1\nv 0.02 1.5 1\nv -0.02 1.5 1\nf 1 2 3\n");
    let peg = "[[body]]\nname = \"peg\"\nmesh = \"peg.obj\"\nkind = \"fixed\"\n";
    let text = format!("{peg}[[body]]\nname = \"bar\"\nmesh = \"bar.obj\"\nkind = \"rigid\"\n{bar}\n");
    folder.write("scene.toml", &text)
}

fn steps(folder: &Folder, bar: &str, query: &str) -> Value {
    summary(&["detect", &scene(folder, bar), query, "--json"])
}

const QUARTER: &str = "rotation = [0, 0, 0.70710678118654752, 0.70710678118654752]";
const HALF: &str = "rotation = [0, 0, 1, 0]";

/// The bar passes the peg on its arc, and not on straight lines.
#[test]
fn a_step_turns_unless_its_path_is_straight() {
    let folder = Folder::new("scene-path");
    let poses = format!("poses = [{{}}, {{ {HALF} }}]");
    for turns in [poses.clone(), format!("path = \"turn\"\n{poses}"), format!("pivot = [0, 0, 0]\n{poses}")] {
        let found = steps(&folder, &turns, "--continuous");
        assert!(found["contacts"].as_u64().is_some_and(|count| count > 0), "{turns}: {found}");
    }
    let straight = steps(&folder, &format!("path = \"straight\"\n{poses}"), "--continuous");
    assert_eq!(straight["contacts"], 0, "{straight}");
    assert_eq!(straight["caveats"][0]["reason"], "turned", "{straight}");
}

/// A turn ends where it leads, and the next step begins there.
#[test]
fn a_turn_gives_the_rotation_of_its_pose() {
    let folder = Folder::new("scene-turn-by");
    let quarter = std::f64::consts::FRAC_PI_2;
    let by_turns =
        format!("poses = [{{}}, {{ turn = [0, 0, {quarter}] }}, {{ turn = [0, 0, {}] }}]", -quarter);
    let by_poses = format!("poses = [{{}}, {{ {QUARTER} }}, {{}}]");
    for query in ["--discrete", "--continuous"] {
        let [a, b] = [&by_turns, &by_poses].map(|bar| steps(&folder, bar, query));
        let counts = |found: &Value| -> Vec<Option<u64>> {
            found["steps"].as_array().expect("steps").iter().map(|step| step["contacts"].as_u64()).collect()
        };
        assert_eq!(counts(&a), counts(&b), "{query}");
        assert!(counts(&a).iter().any(|count| count.is_some_and(|count| count > 0)), "{query}: {a}");
    }
    // 350 degrees meet the peg; the 10 degrees back do not. The translation is that of the pose.
    let long = steps(
        &folder,
        "poses = [{}, { turn = [0, 0, 6.1086523819801535], translation = [0, 0, 9] }]",
        "--distance",
    );
    let distances: Vec<Option<f64>> = long["steps"]
        .as_array()
        .expect("steps")
        .iter()
        .map(|step| step["nearest"]["distance"].as_f64())
        .collect();
    assert!(distances[1].is_some_and(|far| far > 7.9), "{long}");
    let around = steps(&folder, "poses = [{}, { turn = [0, 0, 6.1086523819801535] }]", "--continuous");
    assert!(around["contacts"].as_u64().is_some_and(|count| count > 0), "{around}");
    let (sin, cos) = (-5f64.to_radians()).sin_cos();
    let back =
        steps(&folder, &format!("poses = [{{}}, {{ rotation = [0, 0, {sin}, {cos}] }}]"), "--continuous");
    assert_eq!(back["contacts"], 0, "{back}");
}

#[test]
fn a_matrix_is_a_pose() {
    let folder = Folder::new("scene-matrix");
    let by_pose = format!("poses = [{{}}, {{ {QUARTER}, translation = [0.01, 0, 0.25] }}]");
    let flat = "poses = [{}, { matrix = [0, -1, 0, 0.01, 1.0, 0, 0, 0, 0, 0, 1, 0.25, 0, 0, 0, 1] }]";
    let rows = "poses = [{}, { matrix = [[0, -1, 0, 0.01], [1, 0, 0, 0], [0, 0, 1, 0.25], [0, 0, 0, 1]] }]";
    for query in ["--discrete", "--near=0.75"] {
        let [pose, flat, rows] =
            [by_pose.as_str(), flat, rows].map(|bar| steps(&folder, bar, query)["steps"][1].clone());
        assert_eq!(flat["hash"], rows["hash"], "{query}");
        assert!(
            pose["contacts"].as_u64() > Some(0) && pose["contacts"] == flat["contacts"],
            "{query}: {pose} {flat}"
        );
    }
}

#[test]
fn what_is_wrong_with_poses_is_named() {
    let folder = Folder::new("scene-poses-wrong");
    let body = "body \"bar\" (line 5): ";
    let two = "poses = [{}, {}]";
    for (bar, said) in [
        ("pivot = [0, 0, 1]", &["`pivot` has no effect: the body makes no step"][..]),
        ("path = \"turn\"\nposes = [{}]", &["`path` has no effect: the body makes no step"]),
        (
            &format!("path = \"straight\"\npivot = [0, 0, 0]\n{two}"),
            &["`pivot` has no effect on a straight `path`"],
        ),
        (&format!("path = \"curved\"\n{two}"), &["unknown variant `curved`", "`straight`"]),
        (&format!("pivot = [0, 1]\n{two}"), &["length 2", "`pivot`"]),
        (&format!("pivot = [0, inf, 0]\n{two}"), &["`poses`, the one of frame 1", "about [0.0, inf, 0.0]"]),
        ("poses = [{ turn = [0, 0, 1] }, {}]", &["frame 0: `turn` in the first pose"]),
        (
            "path = \"straight\"\nposes = [{}, { turn = [0, 0, 1] }]",
            &["frame 1: `turn` has no effect on a straight"],
        ),
        ("poses = [{}, { turn = [0, 0, 7] }]", &["frame 1: ", "turns by [0.0, 0.0, 7.0]", "at most 2 pi"]),
        ("poses = [{}, { turn = [0, nan, 0] }]", &["frame 1: ", "turns by [0.0, NaN, 0.0]"]),
        (
            "poses = [{}, { turn = [0, 0, 1], rotation = [0, 0, 0, 1] }]",
            &["`turn` and `rotation` exclude each other"],
        ),
        ("poses = [{ matrix = [1, 0, 0] }]", &["frame 0: `matrix` must be 16 numbers, or 4 rows of 4"]),
        (
            "poses = [{ matrix = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 1]] }]",
            &["`matrix` must be 16"],
        ),
        (
            "poses = [{ matrix = [[1], [0], [0], [0]], translation = [0, 0, 0] }]",
            &["`matrix` and `translation` exclude"],
        ),
        ("poses = [{ matrix = 3 }]", &["`matrix` must be 16 numbers"]),
        (
            "poses = [{}, { matrix = [2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1] }]",
            &["frame 1: the matrix of a pose: scales by 2, the length of column 0"],
        ),
        (
            "poses = [{ matrix = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 2, 3, 1] }]",
            &["has 1 in the last row, column 0"],
        ),
    ] {
        let message = refused(3, &["detect", &scene(&folder, bar)]);
        assert!(message.contains(body) && message.lines().count() == 1, "{message}");
        assert!(said.iter().all(|part| message.contains(part)), "{said:?}: {message}");
    }
    folder.write("bar.obj", "v -2 0 0\nv 2 0 0\nv 0 0.1 0\nf 1 2 3\n");
    for key in ["pivot = [0, 0, 0]", "path = \"turn\""] {
        let file = folder.write("scene.toml", &format!("[[body]]\nmesh = \"bar.obj\"\n{key}\n"));
        let message = refused(3, &["detect", &file]);
        assert!(message.contains("cannot be used if the body is deformable"), "{message}");
    }
}
