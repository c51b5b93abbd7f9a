//! Curves of known shapes, the laws of their arrays, and a judge that compares coordinates.

use super::{apart, count, cuboid, curves, face, geometry, sphere};
use nearmiss::contacts::{Curves, PairGeometry, PairKind, crossing_curves};
use nearmiss::mesh::Positions;
use nearmiss::scene::Scene;
use nearmiss::{Body, Discrete, Mesh};
use std::collections::{BTreeMap, BTreeSet};
use support::engine;

type Bits = [u64; 3];

fn bits(point: [f64; 3]) -> Bits {
    point.map(f64::to_bits)
}

/// The fault of curves, if any. Joints are found by coordinates, which are exact points rounded: in a
/// scene in general position equal bits are equal points.
fn fault(curves: &Curves, geometry: &[PairGeometry], scene: &Scene) -> Option<String> {
    let crossing: Vec<usize> =
        (0..geometry.len()).filter(|&row| geometry[row].kind == PairKind::Crossing).collect();
    let ends = |row: usize| geometry[row].ends.expect("ends").map(bits);
    // Every row once.
    let mut rows: Vec<usize> = curves.rows.iter().map(|&row| row as usize).collect();
    rows.sort_unstable();
    if rows != crossing {
        return Some("a row is missing, or there twice".into());
    }
    let mut at: BTreeMap<Bits, Vec<usize>> = BTreeMap::new();
    crossing.iter().for_each(|&row| ends(row).iter().for_each(|&end| at.entry(end).or_default().push(row)));
    for (k, curve) in curves.iter().enumerate() {
        if curve.points.len() != curve.rows.len() + 1 {
            return Some(format!("curve {k} has {} points", curve.points.len()));
        }
        for (segment, &row) in curve.points.windows(2).zip(curve.rows) {
            let [from, to] = ends(row as usize);
            let own = [bits(segment[0]), bits(segment[1])];
            if own != [from, to] && own != [to, from] {
                return Some(format!("row {row} is elsewhere"));
            }
        }
        let (first, last) = (bits(curve.points[0]), bits(*curve.points.last().expect("a point")));
        if (first == last) != curve.is_closed {
            return Some(format!("curve {k} is closed, or not"));
        }
        // Inside, exactly one other row goes on; at the ends of an open curve none or several do.
        let inside = &curve.points[1..curve.points.len() - 1];
        if inside.iter().any(|&point| at[&bits(point)].len() != 2) {
            return Some(format!("curve {k} goes on beyond a fork"));
        }
        if !curve.is_closed && [first, last].iter().any(|end| at[end].len() == 2) {
            return Some(format!("curve {k} ends early"));
        }
    }
    // Groups: rows that share a triangle or an end, by a search of its own.
    let shares = |a: usize, b: usize| {
        let faces = |row: usize| [0, 1].map(|k| (geometry[row].bodies[k], geometry[row].triangles[k]));
        faces(a).iter().any(|own| faces(b).contains(own)) || ends(a).iter().any(|own| ends(b).contains(own))
    };
    let mut left: BTreeSet<usize> = crossing.iter().copied().collect();
    let mut number = 0;
    while let Some(first) = left.pop_first() {
        let mut found = vec![first];
        while let Some(row) = found.pop() {
            if curves.row_groups[row] != Some(number) {
                return Some(format!("row {row} is in another group"));
            }
            let next: Vec<usize> = left.iter().copied().filter(|&other| shares(row, other)).collect();
            left.retain(|row| !next.contains(row));
            found.extend(next);
        }
        number += 1;
    }
    let group = |row: u32| curves.row_groups[row as usize];
    if curves.iter().any(|curve| curve.rows.iter().any(|&row| group(row) != Some(curve.group))) {
        return Some("a curve is of another group".into());
    }
    // Triangles of consecutive rows have a common vertex on each side.
    for curve in curves.iter() {
        for two in curve.rows.windows(2) {
            for side in 0..2 {
                let of = |row: u32| {
                    let pair = &geometry[row as usize];
                    face(scene, pair.bodies[side], pair.triangles[side])
                };
                if !of(two[0]).iter().any(|vertex| of(two[1]).contains(vertex)) {
                    return Some(format!("rows {two:?} are no neighbours"));
                }
            }
        }
    }
    None
}

fn length(points: &[[f64; 3]]) -> f64 {
    let part = |p: &[[f64; 3]]| (0..3).map(|k| (p[1][k] - p[0][k]).powi(2)).sum::<f64>().sqrt();
    points.windows(2).map(part).sum()
}

/// A column through a slab: a closed curve around it above, and one below. Both have its outline.
#[test]
fn a_column_through_a_slab() {
    let scene = apart([cuboid([0.0, 0.0, 0.0], [8.0, 8.0, 1.0]), cuboid([2.1, 3.2, -4.0], [4.6, 4.4, 5.0])]);
    let (curves, geometry) = curves(&scene);
    assert_eq!(fault(&curves, &geometry, &scene), None);
    assert_eq!((curves.len(), &*curves.is_closed, &*curves.groups), (2, &[true; 2][..], &[0; 2][..]));
    for curve in curves.iter() {
        let z = curve.points[0][2];
        assert!((z == 0.0 || z == 1.0) && curve.points.iter().all(|point| point[2] == z));
        assert!((length(curve.points) - 7.4).abs() < 1e-12, "{}", length(curve.points));
    }
    assert_ne!(curves.points[0][2], curves.points[curves.points.len() - 1][2]);
}

/// Two spheres: one closed curve, in any order of bodies, triangles and corners. A third sphere
/// farther off has a curve and a group of its own.
#[test]
fn spheres_cross_in_closed_curves() {
    let meshes = || [sphere(12, 1.0, [0.0; 3]), sphere(9, 0.8, [0.9, 0.3, 0.2])];
    let scene = apart(meshes());
    let (one, all) = curves(&scene);
    assert_eq!(fault(&one, &all, &scene), None);
    assert_eq!((one.len(), &*one.is_closed, count(&all, PairKind::Crossing)), (1, &[true][..], all.len()));
    let outline = |curves: &Curves| {
        let mut points: Vec<Bits> = curves.points.iter().map(|&point| bits(point)).collect();
        points.sort_unstable();
        points.dedup();
        points
    };
    // Another order of bodies, triangles and corners.
    let turned = meshes().map(|mesh| {
        let faces = mesh.faces().iter().rev().map(|&[a, b, c]| [c, a, b]).collect();
        Mesh::new("turned", mesh.positions().clone(), faces).expect("a mesh")
    });
    let [p, q] = turned;
    let other = apart([q, p]);
    let (again, geometry) = curves(&other);
    assert_eq!(fault(&again, &geometry, &other), None);
    assert_eq!(outline(&again), outline(&one));
    // Normals point outwards in both, so the curve runs the same way around, against the exchange.
    let area = |curves: &Curves| {
        let turn = |p: &[[f64; 3]]| p[0][1] * p[1][2] - p[0][2] * p[1][1];
        curves.points.windows(2).map(turn).sum::<f64>()
    };
    assert!((area(&one) + area(&again)).abs() < 1e-9 && area(&one).abs() > 1.0, "{}", area(&one));
    let [p, q] = meshes();
    let three = apart([p, q, sphere(6, 0.5, [0.0, 0.0, -1.0])]);
    let (both, geometry) = curves(&three);
    assert_eq!(fault(&both, &geometry, &three), None);
    assert_eq!((both.len(), &*both.is_closed, &*both.groups), (2, &[true; 2][..], &[0, 1][..]));
}

/// A square through a box ends at its border; a seam ends a curve, and welding joins it.
#[test]
fn borders_and_seams_end_curves() {
    let square = |faces: Vec<[u32; 3]>, points: Vec<[f64; 3]>| {
        Mesh::new("square", Positions::F64(points), faces).expect("a mesh")
    };
    let (a, b, c, d) = ([-1.0, 0.3, 0.4], [0.5, 0.3, 0.45], [0.5, 0.7, 0.55], [-1.0, 0.8, 0.5]);
    let one = square(vec![[0, 1, 2], [0, 2, 3]], vec![a, b, c, d]);
    let seam = square(vec![[0, 1, 2], [3, 4, 5]], vec![a, b, c, a, c, d]);
    let cube = || cuboid([0.0; 3], [1.0; 3]);
    for (mesh, wanted) in [(one, 1), (seam.clone(), 2)] {
        let scene = apart([cube(), mesh]);
        let (curves, geometry) = curves(&scene);
        assert_eq!((curves.len(), curves.is_closed.contains(&true)), (wanted, false));
        if wanted == 1 {
            assert_eq!(fault(&curves, &geometry, &scene), None);
        }
    }
    let (welded, merged) = Body::deformable(seam).weld();
    let mut scene = Scene::new();
    scene.add(Body::deformable(cube()));
    scene.add(welded);
    assert_eq!((merged, curves(&scene).0.len()), (2, 1));
}

/// Nothing that touches is in a curve.
#[test]
fn touches_have_no_curves() {
    let scene = apart([cuboid([0.0; 3], [1.0; 3]), cuboid([1.0, 0.25, 0.25], [2.0; 3])]);
    let (curves, geometry) = curves(&scene);
    assert!(!geometry.is_empty() && curves.is_empty() && curves.starts == [0]);
    assert!(curves.row_groups.iter().all(Option::is_none));
    let none = crossing_curves(&[], &[]).expect("no curves");
    assert_eq!((none.len(), &*none.starts), (0, &[0][..]));
}

#[test]
fn planted_faults_are_found() {
    let scene = apart([sphere(8, 1.0, [0.0; 3]), sphere(9, 0.8, [0.9, 0.3, 0.2])]);
    let geometry = geometry(engine(), &scene, &Discrete::default());
    let good = crossing_curves(&geometry, scene.bodies()).expect("curves");
    assert_eq!(fault(&good, &geometry, &scene), None);
    let condemned = |change: &dyn Fn(&mut Curves)| {
        let mut planted = good.clone();
        change(&mut planted);
        assert_ne!(planted, good);
        fault(&planted, &geometry, &scene).expect("a fault")
    };
    let last = good.points.len() - 1;
    condemned(&|curves| curves.points[3][1] = curves.points[3][1].next_up());
    condemned(&|curves| curves.rows[2] = curves.rows[1]);
    condemned(&|curves| curves.rows.swap(2, 5));
    condemned(&|curves| curves.is_closed[0] = false);
    condemned(&|curves| curves.groups[0] = 1);
    condemned(&|curves| curves.row_groups[4] = Some(1));
    condemned(&|curves| curves.row_groups[4] = None);
    // Cut in two open curves.
    condemned(&|curves| {
        curves.points.insert(5, curves.points[4]);
        curves.starts = vec![0, 5, last + 2];
        curves.is_closed = vec![false; 2];
        curves.groups = vec![0; 2];
    });
}
