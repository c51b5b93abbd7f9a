//! `check` of known shapes: answers that follow from how they are made.

use super::check::{checked, counts};
use super::{Folder, ok, refused};

/// A closed box as quads, from one corner to the other.
fn cuboid(low: [i32; 3], high: [i32; 3], first: usize) -> String {
    let at = |k: usize, bit: usize| if bit == 0 { low[k] } else { high[k] };
    let mut text: String =
        (0..8).map(|c| format!("v {} {} {}\n", at(0, c & 1), at(1, c >> 1 & 1), at(2, c >> 2))).collect();
    for [a, b, c, d] in [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]] {
        text += &format!("f {} {} {} {}\n", a + first, b + first, c + first, d + first);
    }
    text
}

#[test]
fn closed_boxes_are_free_and_boxes_in_each_other_are_clusters() {
    let folder = Folder::new("check-boxes");
    let mesh = |boxes: &[[[i32; 3]; 2]]| {
        let all = boxes.iter().enumerate();
        let text: String = all.map(|(at, [low, high])| cuboid(*low, *high, 8 * at + 1)).collect();
        folder.write("boxes.obj", &text)
    };
    let (status, told) = checked(&[&mesh(&[[[0; 3], [4; 3]]])]);
    assert_eq!((status, counts(&told)), (0, vec![]));
    // One inside another, and one next to them: nothing meets.
    let (status, told) = checked(&[&mesh(&[[[0; 3], [9; 3]], [[2; 3], [4; 3]], [[20; 3], [24; 3]]])]);
    assert_eq!((status, counts(&told)), (0, vec![]));
    // Two that cross at a corner: three sides of each, each crossing two of the other's.
    let crossed = [[[0; 3], [4; 3]], [[2; 3], [7; 3]]];
    let (status, told) = checked(&[&mesh(&crossed)]);
    assert_eq!((status, counts(&told)), (1, vec![("clusters", 1), ("crossing", 6)]));
    assert_eq!(told["clusters"]["first"][0]["low"], serde_json::json!([2.0, 2.0, 2.0]));
    assert_eq!(told["clusters"]["first"][0]["high"], serde_json::json!([4.0, 4.0, 4.0]));
    // Two such places are two clusters.
    let far = crossed.map(|corners| corners.map(|corner| corner.map(|x| x + 100)));
    let (_, told) = checked(&[&mesh(&[crossed, far].concat())]);
    assert_eq!(counts(&told), vec![("clusters", 2), ("crossing", 12)]);
    // Two that stand on each other, the upper one smaller: they overlap in one face.
    let (status, told) = checked(&[&mesh(&[[[0, 0, 0], [4, 4, 4]], [[1, 1, 4], [3, 3, 6]]])]);
    assert_eq!(
        (status, told["overlapping"]["count"].as_u64(), told["crossing"]["count"].as_u64()),
        (1, Some(1), Some(0))
    );
    assert_eq!(told["touching"]["count"].as_u64(), Some(4), "its sides stand on the face: {told}");
}

#[test]
fn a_generated_scene_has_the_pairs_that_detect_lists() {
    let folder = Folder::new("check-scene");
    ok(&["lab", "scene", "draped", "--triangles", "2000", "--out", folder.name()]);
    let mesh = folder.path("draped_t0.ply");
    let (status, told) = checked(&[&mesh, "--first", "1000000"]);
    assert_eq!(status, 1);
    let count = |key: &str| told[key]["count"].as_u64().expect("a count");
    let csv = folder.path("a.csv");
    ok(&["detect", &mesh, "--adjacent", "--geometry", "--out", &csv]);
    let text = folder.read("a.csv");
    let kinds = |kind: &str| text.lines().filter(|line| line.contains(&format!(",{kind},"))).count() as u64;
    assert!(kinds("crossing") > 10, "{text}");
    assert_eq!(count("crossing"), kinds("crossing"));
    assert_eq!(count("overlapping"), kinds("overlap"));
    assert_eq!(count("touching"), kinds("point") + kinds("segment"));
    // Clusters hold all crossing pairs.
    let clusters = told["clusters"]["first"].as_array().expect("clusters");
    let pairs: u64 = clusters.iter().filter_map(|cluster| cluster["pairs"].as_u64()).sum();
    assert_eq!(pairs, count("crossing"));
}

#[test]
fn files_that_cannot_be_read_are_refused() {
    let folder = Folder::new("check-refused");
    assert!(refused(3, &["check", &folder.path("no.obj")]).contains("no.obj: cannot be read"));
    let note = folder.write("note.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2\n");
    assert!(refused(3, &["check", &note, "--strict"]).contains("line 5"));
    let (status, told) = checked(&[&note]);
    assert!(status == 0 && told["notes"][0].as_str().is_some_and(|note| note.contains("left out")), "{told}");
    assert!(refused(2, &["check", &note, "--each"]).contains("--each has no effect: there is one mesh"));
    assert!(refused(2, &["check"]).contains("MESH"));
}
