//! Meshes, their frames, their edges: what is kept, what is refused, and each checker failing once.
#![allow(clippy::unwrap_used, reason = "tests")]

use nearmiss::Error;
use nearmiss::mesh::{Body, Mesh, NO_EDGE, Positions, Problem, Topology, Violation, check};
use nearmiss::scene::Thickness;
use nearmiss_io::{Format, MeshFile, encode_ply_coloured, write_ply};
use rand::{Rng, SeedableRng, rngs::SmallRng};
use std::path::PathBuf;
use support::data;
use support::folder::Folder;

const TETRAHEDRON: [[u32; 3]; 4] = [[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, 3, 0]];

fn corners() -> Vec<[f32; 3]> {
    vec![[0.0, -0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
}

fn mesh(positions: Positions, faces: &[[u32; 3]]) -> Result<Mesh, Error> {
    Mesh::new("given", positions, faces.to_vec())
}

fn problem<T: std::fmt::Debug>(result: Result<T, Error>) -> Problem {
    match result.unwrap_err() {
        Error::Input { problem, .. } => problem,
        other => panic!("not an input error: {other}"),
    }
}

#[test]
fn validation_refuses_each_fault() {
    let with = |x: f32| {
        let mut points = corners();
        points[2][1] = x;
        problem(mesh(Positions::F32(points), &TETRAHEDRON))
    };
    assert!(matches!(with(f32::NAN), Problem::NonFinite { vertex: 2, axis: 'y', value } if value.is_nan()));
    assert!(matches!(with(f32::NEG_INFINITY), Problem::NonFinite { vertex: 2, axis: 'y', .. }));
    let mut doubles = Positions::F32(corners()).to_f64();
    doubles[3][2] = 1e145;
    let found = problem(mesh(Positions::F64(doubles), &TETRAHEDRON));
    assert!(matches!(found, Problem::TooLarge { vertex: 3, axis: 'z', limit: "2^480", .. }));
    let found = problem(mesh(Positions::F32(corners()), &[[0, 1, 2], [0, 1, 4]]));
    assert_eq!(found, Problem::IndexOutOfRange { face: 1, corner: 2, index: 4, vertices: 4 });
    let found = problem(mesh(Positions::F32(vec![]), &[]).unwrap().require_elements());
    assert_eq!(found, Problem::NoElements);
}

#[test]
fn the_door_lets_odd_but_legal_meshes_in() {
    let mut points = corners();
    points.push([f32::NAN, f32::INFINITY, 0.0]); // not used
    points[1][0] = -(2.0f32.powi(60)); // the limit itself
    let faces = [[0, 1, 2], [0, 1, 2], [2, 2, 3], [1, 1, 1]];
    let kept = mesh(Positions::F32(points), &faces).unwrap();
    assert_eq!((kept.name(), kept.vertex_count(), kept.face_count()), ("given", 5, 4));
    assert_eq!(kept.positions().get_f64(0).unwrap()[1].to_bits(), (-0.0f64).to_bits());
    assert_eq!(kept.positions().get_f64(5), None);
}

/// Vertices that single precision cannot compute with are kept in double precision, to the bit.
/// Vertices that no face uses decide nothing.
#[test]
fn large_floats_are_kept_as_doubles() {
    for (x, wide) in [(2f32.powi(60), false), (2f32.powi(60).next_up(), true), (-f32::MAX, true)] {
        let mut points = corners();
        points.push([f32::MAX; 3]); // not used
        points[2][1] = x;
        let kept = mesh(Positions::F32(points.clone()), &TETRAHEDRON).unwrap();
        let doubles = Positions::F64(Positions::F32(points.clone()).to_f64());
        let wanted = if wide { doubles } else { Positions::F32(points.clone()) };
        assert_eq!(kept.positions(), &wanted, "{x:e}");
        // A fault behind a large coordinate is found all the same.
        points[3][0] = f32::NAN;
        let found = problem(mesh(Positions::F32(points), &TETRAHEDRON));
        assert!(matches!(found, Problem::NonFinite { vertex: 3, axis: 'x', .. }), "{found}");
    }
}

#[test]
fn frames_of_different_precision_become_double_exactly() {
    let t0 = mesh(Positions::F32(corners()), &TETRAHEDRON).unwrap();
    let mut points = t0.positions().to_f64();
    points[0][0] = 0.1;
    let t1 = mesh(Positions::F64(points.clone()), &TETRAHEDRON).unwrap();
    let body = Body::moving(t0.clone(), t1).unwrap();
    assert_eq!(body.positions_t0(), &Positions::F64(t0.positions().to_f64()));
    assert_eq!(body.positions_t1(), Some(&Positions::F64(points)));
    assert!(!Body::deformable(t0).is_moving());
}

#[test]
fn each_difference_of_two_frames_is_named() {
    let named = |name: &str, points: Vec<[f32; 3]>, faces: &[[u32; 3]]| {
        Mesh::new(name, Positions::F32(points), faces.to_vec()).unwrap()
    };
    let t0 = || named("a.ply", corners(), &TETRAHEDRON);
    let first = || String::from("a.ply");
    let mut more = corners();
    more.push([0.0; 3]);
    let found = problem(Body::moving(t0(), named("b.ply", more, &TETRAHEDRON)));
    assert_eq!(found, Problem::FrameVertices { first: first(), t0: 4, t1: 5 });
    let found = problem(Body::moving(t0(), named("b.ply", corners(), &TETRAHEDRON[..3])));
    assert_eq!(found, Problem::FrameFaces { first: first(), t0: 4, t1: 3 });
    let mut faces = TETRAHEDRON;
    faces[2] = [3, 2, 1];
    let error = Body::moving(t0(), named("b.ply", corners(), &faces)).unwrap_err();
    for part in ["b.ply", "a.ply", "face 2", "[3, 2, 1]", "[1, 3, 2]", "same faces"] {
        assert!(error.to_string().contains(part), "{error}");
    }
}

#[test]
fn what_is_written_reads_back_equal() {
    let folder = Folder::new("mesh");
    let path = PathBuf::from(folder.path("round.PLY"));
    let single = mesh(Positions::F32(corners()), &TETRAHEDRON).unwrap();
    let mut points = single.positions().to_f64();
    points[1] = [0.1, f64::MIN_POSITIVE / 8.0, -1e140];
    let double = mesh(Positions::F64(points), &TETRAHEDRON).unwrap();
    for written in [single, double] {
        write_ply(&written, &path).unwrap();
        let read = MeshFile::read(&path).unwrap().into_mesh();
        assert_eq!(read.faces(), written.faces());
        assert_eq!(Body::deformable(read).fingerprint(), Body::deformable(written).fingerprint());
    }
    let nowhere = folder.path("no/such/folder.ply");
    let nowhere = write_ply(&mesh(Positions::F32(corners()), &TETRAHEDRON).unwrap(), nowhere.as_ref());
    assert!(matches!(nowhere, Err(nearmiss::Error::Output { .. })));
}

#[test]
fn colours_are_one_a_triangle() {
    let mesh = mesh(Positions::F32(corners()), &TETRAHEDRON).unwrap();
    for wrong in [0, 3, 5] {
        let error = encode_ply_coloured(&mesh, &mut Vec::new(), &vec![[1, 2, 3]; wrong]).unwrap_err();
        assert_eq!(error.to_string(), format!("one colour per triangle is needed, got {wrong} for 4"));
    }
    let mut bytes = Vec::new();
    encode_ply_coloured(&mesh, &mut bytes, &[[1, 2, 3], [4, 5, 6], [7, 8, 9], [10, 11, 12]]).unwrap();
    assert_eq!(bytes[bytes.len() - 3..], [10, 11, 12]);
    let folder = Folder::new("colours");
    let path = PathBuf::from(folder.path("coloured.ply"));
    std::fs::write(&path, bytes).unwrap();
    assert_eq!(MeshFile::read(&path).unwrap().mesh().faces(), mesh.faces());
}

#[test]
fn edges_are_numbered_by_larger_then_smaller_vertex() {
    let topology = Topology::new(&TETRAHEDRON, 4);
    assert_eq!(topology.edges, [[1, 0], [2, 0], [2, 1], [3, 0], [3, 1], [3, 2]]);
    assert_eq!(topology.face_edges, [[0, 2, 1], [3, 4, 0], [4, 5, 2], [5, 3, 1]]);
    // Face 0 owns its three vertices and edges; face 1 vertex 3 and two edges; face 2 the last edge; face 3 nothing.
    assert_eq!(topology.owners, [0b111_111, 0b011_010, 0b010_000, 0]);
    assert_eq!(check(&topology, &TETRAHEDRON), Ok(()));
}

#[test]
fn repeated_indices_and_faces_have_edges_and_owners_too() {
    let faces = [[5, 5, 7], [7, 5, 5], [2, 2, 2], [0, 1, 2], [0, 1, 2], [1, 0, 9]];
    let topology = Topology::new(&faces, 10);
    assert_eq!(topology.edges, [[1, 0], [2, 0], [2, 1], [7, 5], [9, 0], [9, 1]]);
    assert_eq!(topology.face_edges[0], [NO_EDGE, 3, 3]);
    assert_eq!(topology.face_edges[2], [NO_EDGE; 3]);
    // The edge of a vertex twice has one owner; a face of one vertex owns it only if no other face has it.
    assert_eq!(topology.owners, [0b010_101, 0, 0, 0b111_111, 0, 0b110_100]);
    assert_eq!(check(&topology, &faces), Ok(()));
    assert_eq!(check(&Topology::new(&[], 0), &[]), Ok(()));
}

#[test]
fn the_topology_checker_notices_each_fault() {
    let planted = |fault: fn(&mut Topology)| {
        let mut topology = Topology::new(&TETRAHEDRON, 4);
        fault(&mut topology);
        check(&topology, &TETRAHEDRON).unwrap_err()
    };
    let lengths = Violation::Lengths { faces: 4, face_edges: 4, owners: 3 };
    assert_eq!(planted(|t| t.owners.truncate(3)), lengths);
    assert_eq!(planted(|t| t.edges[2] = [1, 2]), Violation::SmallerFirst { edge: 2 });
    assert_eq!(planted(|t| t.edges.swap(3, 4)), Violation::Order { edge: 4 });
    assert_eq!(planted(|t| t.edges[5] = [4, 0]), Violation::Missing { face: 2, k: 1 });
    assert_eq!(planted(|t| t.edges.push([9, 8])), Violation::Stray { edge: 6 });
    let face_edge = Violation::FaceEdge { face: 1, k: 1, found: 0, expected: 4 };
    assert_eq!(planted(|t| t.face_edges[1][1] = 0), face_edge);
    let owner = |face, found, expected| Violation::Owner { face, found, expected };
    assert_eq!(planted(|t| t.owners[0] &= !1), owner(0, 0b111_110, 0b111_111));
    assert_eq!(planted(|t| t.owners[3] |= 1 << 4), owner(3, 0b010_000, 0));
    assert_eq!(planted(|t| t.owners[2] |= 1 << 6), owner(2, 0b1_010_000, 0b010_000));
}

#[test]
#[cfg_attr(not(public_data), ignore = "no public test data: set NEARMISS_DATA")]
fn the_cloth_of_unc_reads_and_its_topology_holds() {
    // 46,598 vertices and 92,230 triangles: the header of the published file.
    let path = data("cloth-ball/cloth_ball92.ply");
    let t0 = MeshFile::read(&path).unwrap().into_mesh();
    assert_eq!((t0.vertex_count(), t0.face_count()), (46_598, 92_230));
    let start = std::time::Instant::now();
    let topology = Topology::new(t0.faces(), t0.vertex_count());
    eprintln!("topology of {} faces: {:?}", t0.face_count(), start.elapsed());
    assert_eq!(check(&topology, t0.faces()), Ok(()));
    let t1 = MeshFile::read(&path.with_file_name("cloth_ball93.ply")).unwrap().into_mesh();
    let body = Body::moving(t0, t1).unwrap();
    assert_eq!(body.frames().len(), 2);
}

/// Two triangles that meet in a seam of vertices twice, and one that loses a corner.
#[test]
fn a_seam_is_welded() {
    let mut points = corners(); // 0, x, y, z
    points.extend([[-0.0, 1.0, 0.0], [1.0, 0.0, -0.0], [1.0, 1.0, 0.0], [f32::NAN; 3], [f32::NAN; 3]]);
    points.push(points[0]);
    points.insert(0, [1.0, 0.0, 0.0]); // not used: the next of its place stands for it
    let faces = [[1, 2, 3], [6, 7, 5], [2, 6, 1]];
    let torn = mesh(Positions::F32(points), &faces).unwrap();
    assert_eq!(torn.coincident(), 2);
    let (welded, merged) = torn.weld();
    assert_eq!((merged, welded.coincident()), (2, 0));
    assert_eq!(welded.faces(), [[1, 2, 3], [2, 7, 3], [2, 2, 1]].as_slice());
    assert_eq!((welded.vertex_count(), welded.name()), (torn.vertex_count(), "given"));
    let bits = |mesh: &Mesh| {
        mesh.positions().to_f64().as_flattened().iter().map(|x| x.to_bits()).collect::<Vec<_>>()
    };
    assert_eq!(bits(&welded), bits(&torn));
    let edges = |mesh: &Mesh| Topology::new(&mesh.faces()[..2], mesh.vertex_count()).edges.len();
    assert_eq!((edges(&torn), edges(&welded)), (6, 5));
    assert_eq!(mesh(Positions::F32(vec![]), &[]).unwrap().weld().1, 0);
}

/// By the definition, in square time: the first used vertex at the same place in every frame.
#[test]
fn frames_are_welded_where_vertices_coincide_in_all() {
    let mut rng = SmallRng::seed_from_u64(3);
    for case in 0..200 {
        let n = 3 + case % 30;
        let mut one = |wide: bool| {
            let points: Vec<[f64; 3]> =
                (0..n).map(|_| [0; 3].map(|_| [0.0, -0.0, 1.0][rng.random_range(0..3)])).collect();
            if wide {
                Positions::F64(points)
            } else {
                Positions::F32(points.iter().map(|p| p.map(|x| x as f32)).collect())
            }
        };
        let frames = [one(false), one(case % 2 == 0), one(true)];
        let faces: Vec<[u32; 3]> =
            (0..n / 2).map(|_| [0; 3].map(|_| rng.random_range(0..n as u32))).collect();
        let used = |v: u32| faces.iter().flatten().any(|&w| w == v);
        for count in 1..4 {
            let meshes: Vec<Mesh> =
                frames[..count].iter().map(|p| mesh(p.clone(), &faces).unwrap()).collect();
            let same = |v: u32, w: u32| {
                frames[..count].iter().all(|p| p.get_f64(v as usize) == p.get_f64(w as usize))
            };
            let first = |v: u32| (0..=v).find(|&w| used(w) && same(w, v)).unwrap();
            let merged = (0..n as u32).filter(|&v| used(v) && first(v) != v).count();
            let wanted: Vec<[u32; 3]> = faces.iter().map(|face| face.map(first)).collect();
            let (welded, found) = Mesh::weld_frames(&meshes).unwrap();
            assert_eq!((welded.len(), found), (count, merged));
            assert!(welded.iter().all(|mesh| mesh.faces() == wanted), "{case}");
            assert_eq!(welded[count - 1].positions(), meshes[count - 1].positions());
            let body = match &meshes[..] {
                [still] => Body::deformable(still.clone()),
                [t0, t1] => Body::moving(t0.clone(), t1.clone()).unwrap(),
                _ => continue,
            };
            let (welded, found) = body.weld();
            assert_eq!((welded.faces(), found, body.coincident()), (wanted.as_slice(), merged, merged));
            assert_eq!((welded.coincident(), welded.positions_t1()), (0, body.positions_t1()));
        }
    }
    let t0 = mesh(Positions::F32(corners()), &TETRAHEDRON).unwrap();
    let found = problem(Mesh::weld_frames(&[
        t0.clone(),
        mesh(Positions::F32(corners()), &TETRAHEDRON[..2]).unwrap(),
    ]));
    assert!(matches!(found, Problem::FrameFaces { .. }));
    assert_eq!(Mesh::weld_frames(&[]).unwrap().1, 0);
}

#[test]
fn a_format_is_known_by_its_extension() {
    assert_eq!(Format::of("a/b.Obj".as_ref()), Ok(Format::Obj));
    assert_eq!(Format::of("a.ply/b".as_ref()), Err(Problem::UnknownExtension { found: String::new() }));
}

#[test]
fn points_of_nalgebra_keep_their_precision() {
    use nearmiss::mesh::Points;
    use nearmiss::nalgebra::Point3;
    let single = Positions::from(vec![Point3::new(0.1f32, 2.0, -3.0)]);
    assert_eq!(single, Positions::F32(vec![[0.1, 2.0, -3.0]]));
    let double = Positions::from(vec![Point3::new(0.1f64, 2.0, -3.0)]);
    assert_eq!(double, Positions::F64(vec![[0.1, 2.0, -3.0]]));
    let points = [Point3::new(0.1f32, 2.0, -3.0), Point3::new(4.0, 5.0, 6.0)];
    assert_eq!(Points::from(&points[..]), Points::F32(&[[0.1, 2.0, -3.0], [4.0, 5.0, 6.0]]));
    let points = [Point3::new(0.1f64, 2.0, -3.0)];
    assert_eq!(Points::from(&points[..]), Points::F64(&[[0.1, 2.0, -3.0]]));
}

/// No contact is lost that a vertex had before it was merged.
#[test]
fn a_welded_vertex_has_the_largest_radius() {
    let points =
        vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]];
    let mesh = mesh(Positions::F32(points), &[[0, 1, 2], [3, 5, 4]]).unwrap();
    let radii = vec![0.1, 0.2, 0.3, 0.25, 0.125, 0.4];
    let (welded, merged) = Body::deformable(mesh.clone()).with_thickness(radii.clone()).weld();
    let Thickness::Each(own) = welded.thickness() else { panic!("{:?}", welded.thickness()) };
    assert_eq!((merged, &own[..3], own[5]), (2, &[0.1, 0.25, 0.3][..], 0.4));
    let (same, _) = Body::deformable(mesh).with_thickness(0.5).weld();
    assert_eq!(*same.thickness(), Thickness::Same(0.5));
}
