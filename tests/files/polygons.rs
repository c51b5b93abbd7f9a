//! Polygons of files: what they are cut into, judged in integers; what is refused; which face a triangle is of.
#![allow(clippy::unwrap_used, reason = "tests")]

mod judge;
mod shapes;

use judge::{Flat, fan, judge, sign};
use nearmiss::Error;
use nearmiss::mesh::{Body, Mesh};
use nearmiss_io::{Format, MeshFile, Polygons, encode_ply};
use rand::{Rng, SeedableRng, rngs::SmallRng};
use shapes::{comb, named, simple, spiral};

/// An OBJ file with the points, and one face of them all.
fn one(points: &[[f64; 3]]) -> String {
    let mut text: String = points.iter().map(|p| format!("v {} {} {}\n", p[0], p[1], p[2])).collect();
    text += "f";
    (1..=points.len()).for_each(|corner| text += &format!(" {corner}"));
    text + "\n"
}

fn parse(text: &str) -> Result<MeshFile, String> {
    MeshFile::parse("a.obj", Format::Obj, text.as_bytes()).map_err(|error| error.to_string())
}

/// A body of two files at the ends of a step.
fn moving(t0: &MeshFile, t1: &MeshFile) -> Result<Body, Error> {
    Body::moving(t0.mesh().clone(), t1.clone().cut_as(t0)?.into_mesh())
}

/// Lifts into a plane on which one coordinate depends on the others.
fn lift(flat: &[Flat], axis: usize, tilt: [i64; 2]) -> Vec<[f64; 3]> {
    let at = |&[u, v]: &Flat| {
        let mut p = [u, v, tilt[0] * u + tilt[1] * v + 3];
        p.rotate_right((axis + 1) % 3);
        p.map(|x| x as f64)
    };
    flat.iter().map(at).collect()
}

fn cut(flat: &[Flat], axis: usize, tilt: [i64; 2]) -> Vec<[u32; 3]> {
    parse(&one(&lift(flat, axis, tilt))).unwrap().mesh().faces().to_vec()
}

fn flats(points: &[[i64; 2]]) -> Vec<[f64; 3]> {
    lift(points, 2, [0, 0])
}

/// Every start and sense of a polygon, along every axis and askew.
#[test]
fn known_polygons_are_covered_once() {
    for (name, shape) in named() {
        for turned in 0..2 * shape.len() {
            let mut flat = shape.clone();
            flat.rotate_left(turned / 2);
            if turned % 2 == 1 {
                flat.reverse();
            }
            for (axis, tilt) in
                [(0, [0, 0]), (1, [0, 0]), (2, [0, 0]), (0, [1, 2]), (1, [-3, 1]), (2, [1, -1])]
            {
                let found = judge(&flat, &cut(&flat, axis, tilt));
                assert_eq!(found, Ok(()), "{name}, {turned}, axis {axis}, {tilt:?}");
            }
        }
    }
}

#[test]
fn random_simple_polygons_are_covered_once() {
    let mut rng = SmallRng::seed_from_u64(7);
    let mut concave = 0;
    for case in 0..1500 {
        let size = [4, 9, 40, 1 << 20][case % 4];
        let flat = simple(&mut rng, 4 + case % 23, size);
        let tilt = [rng.random_range(-2..3), rng.random_range(-2..3)];
        let triangles = cut(&flat, case % 3, tilt);
        assert_eq!(judge(&flat, &triangles), Ok(()), "case {case}: {flat:?}");
        concave += usize::from(judge(&flat, &fan(flat.len())).is_err());
    }
    assert!(concave > 500, "{concave}");
}

/// The judge condemns the fan of a concave polygon, and each other fault.
#[test]
fn the_judge_notices_each_fault() {
    let l = [[0, 0], [4, 0], [4, 1], [1, 1], [1, 4], [0, 4]];
    let mut turned = l;
    turned.rotate_left(1);
    assert_eq!(judge(&l, &fan(6)), Ok(()));
    let says = |triangles: &[[u32; 3]], word: &str| {
        let found = judge(&turned, triangles).unwrap_err();
        assert!(found.contains(word), "{found}");
    };
    says(&fan(6), "turns");
    let good = cut(&turned, 2, [0, 0]);
    assert_eq!(judge(&turned, &good), Ok(()));
    says(&good[1..], "triangles");
    let with = |at: usize, triangle| {
        let mut bad = good.clone();
        bad[at] = triangle;
        bad
    };
    let double = good[0];
    says(&with(1, double), "");
    says(&with(0, [good[0][0], good[0][2], good[0][1]]), "turns");
}

/// A valid fan stays the same fan: convex polygons, also with flat or repeated corners, and
/// polygons that are visible from the first corner.
#[test]
fn right_fans_stay() {
    let ring: Vec<Flat> = (0..40)
        .map(|k| f64::from(k) * 0.157)
        .map(|t| [(1e4 * t.cos()) as i64, (1e4 * t.sin()) as i64])
        .collect();
    let shapes: [&[Flat]; 7] = [
        &ring,
        &[[0, 0], [2, 0], [2, 2], [0, 2]],
        &[[0, 0], [1, 0], [2, 0], [2, 2], [1, 2], [0, 2], [0, 1]],
        &[[0, 0], [0, 0], [2, 0], [2, 2], [2, 2], [0, 2]],
        &[[0, 0], [4, 0], [1, 1], [0, 4]],
        &[[0, 0], [5, 5], [2, 2]],
        &[[1, 1], [1, 1], [1, 1], [1, 1], [1, 1]],
    ];
    for flat in shapes {
        for tilt in [[0, 0], [2, 1]] {
            assert_eq!(cut(flat, 2, tilt), fan(flat.len()), "{flat:?}");
        }
    }
    // On a line, back and forth; and there and back again.
    assert_eq!(cut(&[[0, 0], [3, 3], [1, 1], [2, 2]], 1, [1, 0]), fan(4));
    assert_eq!(cut(&[[0, 0], [3, 0], [3, 3], [3, 0], [0, 0], [5, 1]], 1, [0, 0]), fan(6));
}

#[test]
fn polygons_may_touch_themselves() {
    let area = |flat: &[Flat]| {
        let triangles = cut(flat, 2, [0, 0]);
        assert_eq!(triangles.len(), flat.len() - 2);
        let signs = triangles.iter().map(|t| sign(flat, t));
        assert!(signs.clone().all(|s| s >= 0), "{triangles:?}");
        signs.sum::<i128>()
    };
    // A hole, joined by an edge walked twice; two holes; a hole that touches the rim.
    let hole = [[0, 0], [9, 0], [9, 9], [0, 9], [0, 0], [3, 3], [3, 6], [6, 6], [6, 3], [3, 3]];
    assert_eq!(area(&hole), 2 * (81 - 9));
    let mut two = hole.to_vec();
    two.splice(2..2, [[8, 1], [7, 1], [8, 2], [8, 1], [9, 0]]);
    assert_eq!(area(&two), 2 * 72 - 1);
    assert_eq!(area(&[[0, 0], [9, 0], [9, 9], [0, 9], [0, 0], [3, 6], [6, 3]]), 2 * 81 - 27);
    // Corners in one place: two squares.
    assert_eq!(area(&[[0, 0], [2, 0], [2, 2], [4, 2], [4, 4], [2, 4], [2, 2], [0, 2]]), 16);
    // A needle out of an L, and one into it; corners twice.
    assert_eq!(area(&[[4, 0], [4, 1], [1, 1], [1, 9], [1, 4], [0, 4], [0, 0]]), 14);
    assert_eq!(area(&[[4, 0], [4, 1], [4, 1], [1, 1], [1, 4], [0, 4], [0, 0], [0, 0], [3, 0], [1, 0]]), 14);
}

#[test]
fn faces_that_cross_themselves_are_noted() {
    let says = |points: &[[f64; 3]], parts: &[&str]| {
        let mesh = parse(&one(points)).unwrap();
        assert_eq!(mesh.mesh().faces(), fan(points.len()), "all that it winds around");
        let text = mesh.strict().unwrap_err().to_string();
        for part in ["a.obj", "face 0", "corners in order"].iter().chain(parts) {
            assert!(text.contains(part), "{part}: {text}");
        }
    };
    let crosses = "crosses itself";
    says(&flats(&[[0, 0], [2, 2], [2, 0], [0, 2]]), &[crosses, "0 and 1, and 2 and 3", "with 4 corners"]);
    says(&flats(&[[0, 0], [5, 5], [2, 0], [0, 2]]), &[crosses]);
    says(&flats(&[[0, -10], [6, 8], [-9, -3], [9, -3], [-6, 8]]), &[crosses, "with 5 corners"]);
    // Askew, rounded to floats, far away: the lines miss each other by a rounding.
    let askew = [[0.0f32, 0.0], [2.3, 2.1], [2.2, 0.1], [0.1, 1.9]];
    let askew = askew.map(|[u, v]| [100.0 + u, 0.37 * u + 0.73 * v + 900.0, v].map(f64::from));
    says(&askew, &[crosses]);
    // A bow tie with a corner where it crosses, as no edges cross; unequal halves, and equal ones without area.
    says(&flats(&[[0, 0], [1, 1], [3, 3], [3, 0], [1, 1], [0, 2]]), &["folds over itself"]);
    says(&flats(&[[0, 0], [1, 1], [2, 2], [2, 0], [1, 1], [0, 2]]), &["folds over itself"]);
    // The face is named, and what comes before it counts.
    let text = parse("v 0 0 0\nv 2 2 0\nv 2 0 0\nv 0 2 0\nf 1 3 2\nf 1 3 2 4\nf 1 2 3 4\n");
    let text = text.unwrap().strict().unwrap_err().to_string();
    assert!(
        text.contains("face 2, with 4 corners, crosses itself: its edges between the vertices 0 and 1"),
        "{text}"
    );
    // A corner that is not finite is reported first.
    assert!(parse("v 0 0 0\nv 2 2 0\nv 2 0 0\nv 0 nan 0\nf 1 2 3 4\n").unwrap_err().contains("finite"));
}

/// A quad creased over itself is no flat face that crosses itself: no cut is right, the fan is kept.
#[test]
fn creased_faces_keep_their_fan() {
    let creased = [[0.0, 0.0, 0.0], [0.1, 1.0, 0.1], [1.0, 0.0, 0.0], [0.9, 0.9, -0.1]];
    assert_eq!(parse(&one(&creased)).unwrap().mesh().faces(), fan(4));
}

#[test]
fn scale_and_place_do_not_matter() {
    for (name, shape) in named() {
        let mut flat = shape;
        flat.rotate_left(1);
        let points = lift(&flat, 0, [1, 3]);
        let plain = parse(&one(&points)).unwrap();
        for scale in [2f64.powi(-1074), 2f64.powi(-600), 2f64.powi(460)] {
            let scaled: Vec<_> = points.iter().map(|p| p.map(|x| x * scale)).collect();
            assert_eq!(
                parse(&one(&scaled)).unwrap().mesh().faces(),
                plain.mesh().faces(),
                "{name}, {scale:e}"
            );
        }
    }
}

#[test]
fn large_polygons_take_no_long_time() {
    let start = std::time::Instant::now();
    for (name, flat) in [("comb", comb(2_000, 1_000_000)), ("spiral", spiral(1_000))] {
        for (u, v) in [(1, 0), (0, 1), (1, 1), (3, 7)] {
            let turned: Vec<Flat> = flat.iter().map(|[x, y]| [u * x - v * y, v * x + u * y]).collect();
            let triangles = cut(&turned, 2, [0, 0]);
            assert_eq!(triangles.len(), flat.len() - 2);
            let sum: i128 = triangles.iter().map(|t| sign(&turned, t)).sum();
            assert!(triangles.iter().all(|t| sign(&turned, t) > 0), "{name}");
            assert_eq!(sum, judge::area(&turned), "{name}");
        }
        eprintln!("{name} of {} corners, four ways: {:?} so far", flat.len(), start.elapsed());
    }
}

#[test]
fn a_concave_polygon_beyond_the_limit_is_refused() {
    let mut flat = comb(43_691, 9);
    assert_eq!(flat.len(), (1 << 17) + 4);
    flat.rotate_left(1);
    let text = parse(&one(&flats(&flat))).unwrap_err();
    for part in ["a.obj", "face 0 has 131076 corners", "at most 131072", "split it"] {
        assert!(text.contains(part), "{text}");
    }
    // A convex one is no trouble.
    let n = 140_000i64;
    let convex: Vec<Flat> = (0..n).map(|k| [k, k * k]).collect();
    assert_eq!(cut(&convex, 2, [0, 0]).len(), 139_998);
}

const DART: &str = "v 0 0 0\nv 3 0 0\nv 1 1 0\nv 0 3 0\nv 9 9 9\nf 1 2 5\nf 2 3 4 1\nf 5 4 3\n";

/// The frame with other places of vertices 1 and 2.
fn frame(places: &str) -> String {
    DART.replace("v 3 0 0\nv 1 1 0\n", places)
}

#[test]
fn triangles_know_their_face_of_the_file() {
    let mesh = parse(DART).unwrap();
    assert_eq!(mesh.mesh().faces(), [[0, 1, 4], [0, 1, 2], [3, 0, 2], [4, 3, 2]].as_slice());
    assert_eq!([0, 1, 2, 3].map(|t| mesh.file_face(t)), [0, 1, 1, 2]);
    assert_eq!((mesh.mesh().face_count(), mesh.file_face_count()), (4, 3));
    assert_eq!([0, 1, 2, 3].map(|t| mesh.polygons().file_face(t)), [0, 1, 1, 2]);
    assert_eq!(Polygons::default().file_face(3), 3);
    let plain = parse("v 0 0 0\nv 3 0 0\nv 0 3 0\nf 1 2 3\nf 3 2 1\n").unwrap();
    assert_eq!((plain.file_face(1), plain.file_face_count()), (1, 2));
    let ply = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 4\n\
               property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n5 0 1 2 2 2\n3 0 1 2\n4 0 1 2 2\n3 0 0 0\n";
    let mesh = MeshFile::parse("a.ply", Format::Ply, ply.as_bytes()).unwrap();
    let of: Vec<u32> = (0..mesh.mesh().face_count() as u32).map(|t| mesh.file_face(t)).collect();
    assert_eq!(of, [0, 0, 0, 1, 2, 2, 3]);
}

/// Two frames have the triangles of the first, however the second would be cut.
#[test]
fn frames_are_cut_as_the_first() {
    let t0 = parse(DART).unwrap();
    let text = frame("v 1 1 0\nv 3 1 0\n");
    let t1 = parse(&text).unwrap();
    assert_ne!(t0.mesh().faces(), t1.mesh().faces());
    let body = moving(&t0, &t1).unwrap();
    assert_eq!((body.faces(), body.positions_t1()), (t0.mesh().faces(), Some(t1.mesh().positions())));
    assert_eq!(moving(&t1, &t0).unwrap().faces(), t1.mesh().faces());
    // Cut otherwise, they are no frames of one mesh.
    let apart = Body::moving(t0.mesh().clone(), t1.mesh().clone()).unwrap_err().to_string();
    assert!(apart.contains("face 1 is ") && apart.contains("in the first frame, a.obj"), "{apart}");
    let next = t0.parse_frame("b.obj", Format::Obj, text.as_bytes()).unwrap();
    assert_eq!((next.mesh().faces(), next.mesh().positions()), (t0.mesh().faces(), t1.mesh().positions()));
    assert_eq!(next.mesh().name(), "b.obj");
    assert_eq!(next.file_face(2), 1);
    // Crossing at its end, a face is still what it was at its start.
    let crossed = frame("v 2 2 0\nv 1 -1 0\n");
    assert!(parse(&crossed).unwrap().strict().is_err());
    assert!(t0.parse_frame("b.obj", Format::Obj, crossed.as_bytes()).is_ok());
    assert_eq!(parse(&crossed).unwrap().cut_as(&t0).unwrap().notes(), []);
    // Other corners, another start, more faces.
    for (from, to, part) in [
        (
            "f 2 3 4 1",
            "f 3 4 1 2",
            "face 1 is [2, 3, 0, 1], but in the first frame, a.obj, it is [1, 2, 3, 0]",
        ),
        ("f 5 4 3", "f 5 4 2", "face 2 is [4, 3, 1]"),
        ("f 5 4 3", "f 5 4 3\nf 1 1 1", "has 4 faces"),
        ("f 2 3 4 1", "f 2 3 4\nf 2 4 1", "has 4 faces"),
    ] {
        let other = DART.replace(from, to);
        let read = t0.parse_frame("b.obj", Format::Obj, other.as_bytes()).unwrap_err().to_string();
        let moved = moving(&t0, &parse(&other).unwrap()).unwrap_err().to_string();
        assert!(read.contains("b.obj: ") && read.contains(part), "{read}");
        assert!(moved.contains(part), "{moved}");
    }
    // A file of these very triangles is the same mesh.
    let cut = Mesh::new("cut", t1.mesh().positions().clone(), t0.mesh().faces().to_vec()).unwrap();
    let mut written = Vec::new();
    encode_ply(&cut, &mut written).unwrap();
    let read = t0.parse_frame("cut.ply", Format::Ply, &written).unwrap();
    assert_eq!((read.mesh().positions(), read.file_face(2)), (cut.positions(), 1));
    assert!(Body::moving(t0.into_mesh(), cut).is_ok());
}

#[test]
fn a_welded_mesh_keeps_its_triangles() {
    let text = DART.replace("v 9 9 9", "v -0 0 0");
    let file = parse(&text).unwrap();
    let (mesh, merged) = file.mesh().weld();
    assert_eq!((merged, mesh.faces()), (1, [[0, 1, 0], [0, 1, 2], [3, 0, 2], [0, 3, 2]].as_slice()));
    assert_eq!(file.file_face(2), 1);
    let next = parse(&frame("v 1 1 0\nv 3 1 0\n").replace("v 9 9 9", "v 0 0 0")).unwrap();
    let next = next.cut_as(&file).unwrap().mesh().weld().0;
    assert_eq!(Body::moving(mesh.clone(), next).unwrap().faces(), mesh.faces());
}
