//! Lines and points of files are edges and points of the mesh.

use super::formats::{read, refused};
use nearmiss_io::{Format, Treated, encode_ply};

#[test]
fn lines_and_points_are_edges_and_points() {
    let points = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    let obj = read(Format::Obj, format!("{points}l 1 2/7 -1\np 1 3\nf 1 2 3\nl 2\nl 2 2\n"));
    assert_eq!(obj.mesh().faces(), [[0, 1, 2]]);
    assert_eq!((obj.mesh().edges(), obj.mesh().points()), (&[[0, 1], [1, 2]][..], &[0, 2, 1][..]));
    assert_eq!((obj.file_face(0), obj.file_face_count()), (0, 1));
    let [note] = obj.notes() else { panic!("{:?}", obj.notes()) };
    assert_eq!((note.treated, note.count), (Treated::LeftOut, 1));
    assert!(refused(Format::Obj, format!("{points}l 1 4\n")).contains("line 4"));
    assert!(refused(Format::Obj, format!("{points}p 0\n")).contains("line 4"));
    let off = read(Format::Off, "OFF\n3 4 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n2 0 1\n1 2\n0\n");
    assert_eq!(off.mesh().faces(), [[0, 1, 2]]);
    assert_eq!((off.mesh().edges(), off.mesh().points()), (&[[0, 1]][..], &[2][..]));
    assert_eq!((off.notes()[0].treated, off.file_face_count()), (Treated::LeftOut, 4));
    // Elements of no face come behind all faces, those that were left out too.
    assert_eq!([0, 1, 2].map(|element| off.polygons().file_element(element, 1)), [0, 4, 5]);
    let square = format!("{points}v 1 1 0\nf 1 2 4 3\np 1\nl 2 3\n");
    let file = read(Format::Obj, &square);
    assert_eq!([1, 2, 3].map(|element| file.polygons().file_element(element, 2)), [0, 1, 2]);
    assert_eq!((file.mesh().edges(), file.mesh().points()), (&[[1, 2]][..], &[0][..]));
    // No face at all.
    let alone = read(Format::Obj, format!("{points}l 1 2 3\n"));
    assert_eq!((alone.mesh().face_count(), alone.mesh().edges().len()), (0, 2));
    assert!(refused(Format::Obj, points).contains("no triangles, edges or points"));
}

fn edges_of_ply(columns: &str, entries: &str) -> String {
    let count = entries.lines().count();
    format!(
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
         element face 1\nproperty list uchar int vertex_indices\nelement edge {count}\n{columns}end_header\n\
         0 0 0\n1 0 0\n0 1 0\n3 3 3\n3 0 1 2\n{entries}"
    )
}

#[test]
fn edges_of_ply_are_read_and_written() {
    let columns = "property int vertex1\nproperty uchar red\nproperty int vertex2\n";
    let file = read(Format::Ply, edges_of_ply(columns, "0 7 3\n3 7 3\n1 7 2\n"));
    assert_eq!((file.mesh().edges(), file.mesh().points()), (&[[0, 3], [1, 2]][..], &[3][..]));
    assert!(file.notes().is_empty());
    let mut bytes = Vec::new();
    encode_ply(file.mesh(), &mut bytes).expect("room");
    let again = read(Format::Ply, &bytes);
    assert_eq!(again.mesh(), file.mesh());
    let far = refused(Format::Ply, edges_of_ply(columns, "0 7 3\n1 7 4\n"));
    assert!(far.contains("edge 1 names vertex 4, but there are 4 vertices"), "{far}");
    let before = refused(Format::Ply, edges_of_ply(columns, "-1 7 3\n"));
    assert!(before.contains("edge 0 names vertex -1"), "{before}");
    // Other columns are no edges that are known: a note, never silence.
    let other = read(Format::Ply, edges_of_ply("property float a\nproperty int vertex2\n", "0 1\n"));
    assert_eq!((other.mesh().edges().len(), other.notes()[0].treated), (0, Treated::NotRead));
}

#[test]
fn frames_have_the_same_edges_and_points() {
    let file = |rest: &str| read(Format::Obj, format!("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\n{rest}"));
    let first = file("f 1 2 4 3\nl 1 4\np 2\n");
    assert!(file("f 1 2 4 3\nl 1 4\np 2\n").cut_as(&first).is_ok());
    for (rest, what) in [("f 1 2 4 3\nl 1 3\np 2\n", "edges"), ("f 1 2 4 3\nl 1 4\n", "points")] {
        let error = file(rest).cut_as(&first).expect_err("other elements").to_string();
        assert!(error.contains(&format!("has other {what} than the first frame")), "{error}");
    }
}
