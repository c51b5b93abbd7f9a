//! Triangle pairs: known counts, and all pairs tested one by one by the rational oracle.

use nearmiss::mesh::{Body, Mesh, Positions};
use nearmiss::query::Discrete;
use nearmiss::research::{TriangleTest, WithSolver};
use nearmiss::{Device, Query};
use nearmiss_lab::oracle::{Triangle, triangles_meet, triangles_meet_beyond};
use nearmiss_lab::scene::{self, Rng};
use std::collections::BTreeSet;
use support::{ask, engine, loose, machines, still};

fn pairs(device: Device, bodies: Vec<Body>) -> Vec<[u32; 2]> {
    ask(device, bodies, Query::discrete()).triangles()
}

fn triangles(body: &Body) -> Vec<Triangle> {
    let points = body.positions_t0().to_f64();
    body.faces().iter().map(|face| face.map(|v| points[v as usize])).collect()
}

/// Whether boxes are apart, exactly: spares the oracle most pairs.
fn boxes_apart(p: &Triangle, q: &Triangle) -> bool {
    let reach = |t: &Triangle, axis: usize| {
        let x = t.map(|p| p[axis]);
        (x[0].min(x[1]).min(x[2]), x[0].max(x[1]).max(x[2]))
    };
    (0..3).any(|axis| {
        let ((lo, hi), (from, to)) = (reach(p, axis), reach(q, axis));
        hi < from || to < lo
    })
}

/// The distinct vertices that two faces of one mesh share.
fn shared(p: [u32; 3], q: [u32; 3]) -> BTreeSet<u32> {
    p.into_iter().filter(|v| q.contains(v)).collect()
}

/// All pairs of a mesh that the oracle says meet; of those that share a vertex, if at all, the ones that meet beyond.
fn oracle_of_one(body: &Body, adjacent: bool) -> Vec<[u32; 2]> {
    let (faces, all) = (body.faces(), triangles(body));
    let points = body.positions_t0().to_f64();
    let mut meeting = Vec::new();
    for a in 0..all.len() {
        for b in a + 1..all.len() {
            let common: Vec<_> = shared(faces[a], faces[b]).into_iter().map(|v| points[v as usize]).collect();
            let meets = match common.len() {
                0 => !boxes_apart(&all[a], &all[b]) && triangles_meet(&all[a], &all[b]),
                1 | 2 => adjacent && triangles_meet_beyond(&all[a], &all[b], &common),
                // A triangle that is there twice meets itself everywhere.
                _ => adjacent,
            };
            if meets {
                meeting.push([a as u32, b as u32]);
            }
        }
    }
    meeting
}

/// All pairs between two meshes that the oracle says meet.
fn oracle_of_two(one: &Body, other: &Body) -> Vec<[u32; 2]> {
    let (p, q) = (triangles(one), triangles(other));
    let mut meeting = Vec::new();
    for (a, p) in p.iter().enumerate() {
        for (b, q) in q.iter().enumerate() {
            if !boxes_apart(p, q) && triangles_meet(p, q) {
                meeting.push([a as u32, b as u32]);
            }
        }
    }
    meeting
}

/// Faces over vertices with small whole coordinates: most of them touch, lie in one plane, or have no area; the first
/// comes twice; some name a vertex twice and are segments or points.
fn crowded(seed: u64, vertices: u32, count: usize, side: u64) -> Body {
    let mut rng = Rng::new(seed);
    let mut below = |n: u64| rng.bits() % n;
    let points: Vec<_> = (0..vertices).map(|_| [(); 3].map(|()| below(side) as f32)).collect();
    let mut faces: Vec<_> = (0..count).map(|_| [(); 3].map(|()| below(vertices as u64) as u32)).collect();
    faces.push([faces[0][1], faces[0][0], faces[0][2]]);
    still(&points, &faces)
}

/// The first difference of two ascending lists.
fn difference(found: &[[u32; 2]], truth: &[[u32; 2]]) -> Option<String> {
    let (found, truth): (BTreeSet<_>, BTreeSet<_>) = (found.iter().collect(), truth.iter().collect());
    let missed = truth.difference(&found).next().map(|pair| format!("missed {pair:?}"));
    missed.or_else(|| found.difference(&truth).next().map(|pair| format!("invented {pair:?}")))
}

#[test]
fn a_grid_has_its_known_pairs_on_every_machine() {
    for cells in [1, 4] {
        for device in machines() {
            let name = device.name();
            let found = pairs(device, vec![scene::grid(cells).expect("a scene")]);
            assert_eq!(found.len() as u64, scene::grid_pairs(cells), "{cells} cells, {name}");
        }
    }
    // 10,000 triangles: several blocks of every kernel.
    let found = pairs(engine(), vec![scene::grid(50).expect("a scene")]);
    assert_eq!(found.len() as u64, scene::grid_pairs(50));
}

#[test]
fn a_line_has_none_and_equal_triangles_have_all() {
    for n in [1, 2, 3, 64, 65, 300] {
        assert!(pairs(engine(), vec![scene::line(n).expect("a scene")]).is_empty());
        let all = pairs(engine(), vec![scene::identical(n).expect("a scene")]);
        assert!(all.iter().copied().eq((0..n as u32).flat_map(|a| (a + 1..n as u32).map(move |b| [a, b]))));
    }
}

#[test]
fn a_soup_equals_the_oracle() {
    let body = scene::soup(150, 11, false).expect("a scene");
    let truth = oracle_of_one(&body, false);
    assert!(truth.len() > 15, "{}", truth.len());
    for device in machines() {
        let name = device.name();
        assert_eq!(pairs(device, vec![body.clone()]), truth, "{name}");
    }
}

#[test]
fn a_crowd_of_degenerate_triangles_equals_the_oracle() {
    for (seed, vertices, count, side) in [(1, 150, 70, 3), (2, 40, 60, 3), (3, 24, 50, 2)] {
        let body = crowded(seed, vertices, count, side);
        let flat = triangles(&body).iter().filter(|t| area_is_zero(t)).count();
        for adjacent in [false, true] {
            let truth = oracle_of_one(&body, adjacent);
            let query = Query::from(Discrete::by(TriangleTest::Exact { adjacent }));
            let contacts = ask(engine(), vec![body.clone()], query);
            assert_eq!(difference(&contacts.triangles(), &truth), None, "seed {seed}, adjacent: {adjacent}");
            assert_eq!(contacts.len(), truth.len());
            assert!(truth.len() > 100 && flat > 0, "seed {seed}: {} pairs, {flat} without area", truth.len());
        }
    }
}

#[test]
fn a_segment_from_a_shared_vertex_into_a_face_is_found() {
    let points = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [1.0, 1.0, 0.0]];
    let body = still(&points, &[[0, 0, 3], [0, 1, 2]]);
    let query = Query::from(Discrete::by(TriangleTest::Exact { adjacent: true }));
    assert_eq!(ask(engine(), vec![body], query).triangles(), [[0, 1]]);
}

fn area_is_zero(t: &Triangle) -> bool {
    let [u, v] = [1, 2].map(|k| [0, 1, 2].map(|axis| t[k][axis] - t[0][axis]));
    (0..3).all(|k| u[k] * v[(k + 1) % 3] == u[(k + 1) % 3] * v[k])
}

#[test]
fn two_bodies_equal_the_oracle() {
    let sets = [
        (scene::soup(90, 3, false), scene::soup(60, 4, false)),
        (Ok(crowded(5, 60, 40, 4)), Ok(crowded(6, 40, 30, 4))),
        (scene::grid(2), scene::soup(100, 9, false)),
    ];
    for (one, other) in sets {
        let (one, other) = (one.expect("a scene"), other.expect("a scene"));
        let truth = oracle_of_two(&one, &other);
        assert!(!truth.is_empty());
        for device in machines() {
            let name = device.name();
            assert_eq!(pairs(device, vec![one.clone(), other.clone()]), truth, "{name}");
        }
    }
}

/// One triangle, moved along x and scaled.
fn at(x: f32, size: f32) -> [[f32; 3]; 3] {
    [[x, 0.0, 0.0], [x + size, 0.0, 0.0], [x, size, size]]
}

#[test]
fn bodies_of_few_triangles() {
    for device in [engine, || support::sanitizer(support::ORDERS[1])] {
        let found = |bodies: Vec<Body>| pairs(device(), bodies);
        let [none, one, two] = [0, 1, 2].map(|n| loose(&vec![at(0.0, 1.0); n]));
        assert_eq!(found(vec![none.clone()]), [[0; 2]; 0]);
        assert_eq!(found(vec![one.clone()]), [[0; 2]; 0]);
        assert_eq!(found(vec![two.clone()]), [[0, 1]]);
        assert_eq!(found(vec![loose(&[at(0.0, 1.0), at(2.0, 1.0)])]), [[0; 2]; 0]);
        assert_eq!(found(vec![none.clone(), two.clone()]), [[0; 2]; 0]);
        assert_eq!(found(vec![two.clone(), none]), [[0; 2]; 0]);
        assert_eq!(found(vec![one.clone(), one.clone()]), [[0, 0]]);
        assert_eq!(found(vec![one.clone(), two.clone()]), [[0, 0], [0, 1]]);
        assert_eq!(found(vec![two.clone(), one]), [[0, 0], [1, 0]]);
        assert_eq!(found(vec![two.clone(), two]), [[0, 0], [0, 1], [1, 0], [1, 1]]);
    }
}

#[test]
fn places_that_strain_the_tree() {
    // Each triangle overlaps its two neighbours on a line of centres; what strains is where the line lies.
    let chain = |n: usize, step: f32| (0..n).map(|i| at(step * i as f32, 1.5 * step)).collect::<Vec<_>>();
    let neighbours = |n: u32| (1..n).map(|b| [b - 1, b]).collect::<Vec<_>>();

    assert_eq!(pairs(engine(), vec![loose(&chain(200, 1.0))]), neighbours(200));

    let mut outlier = chain(100, 1.0);
    outlier.push(at(1e6, 1.0));
    assert_eq!(pairs(engine(), vec![loose(&outlier)]), neighbours(100), "all codes but one are alike");

    // 1e7 is below 2^24: whole numbers stay exact, and steps of 2 with triangles of 3 too.
    let far: Vec<_> =
        chain(100, 2.0).iter().map(|t| t.map(|p| [p[0] + 1e7, p[1] - 1e7, p[2] + 1e7])).collect();
    assert_eq!(pairs(engine(), vec![loose(&far)]), neighbours(100), "far from the origin");

    // Twice and three times the smallest denormal.
    let tiny: Vec<_> = chain(100, 2.0).iter().map(|t| t.map(|p| p.map(|x| x * f32::from_bits(1)))).collect();
    assert_eq!(pairs(engine(), vec![loose(&tiny)]), neighbours(100), "denormal numbers");

    let large: Vec<_> = chain(100, 2.0).iter().map(|t| t.map(|p| p.map(|x| x * 2f32.powi(51)))).collect();
    assert_eq!(
        pairs(engine(), vec![loose(&large)]),
        neighbours(100),
        "numbers near the largest that are let in"
    );

    // Sizes from 2^-60 to 2^39, nested: all share the origin's corner point.
    let nested: Vec<_> = (0..100).map(|i| at(0.0, 2f32.powi(i - 60))).collect();
    assert_eq!(pairs(engine(), vec![loose(&nested)]).len(), 100 * 99 / 2);
}

#[test]
fn doubles_that_no_float_can_hold() {
    // Boxes are floats: of the large ones they know only the sign, of the small ones nothing. The signs know all.
    for scale in [2f64.powi(470), 2f64.powi(200), 2f64.powi(-200), 2f64.powi(-1074)] {
        for shift in [0.0, -60.0] {
            let chain: Vec<_> = (0..60)
                .flat_map(|i| at(2.0 * i as f32, 3.0).map(|p| p.map(|x| (f64::from(x) + shift) * scale)))
                .collect();
            let faces = (0..60).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
            let body = Body::deformable(Mesh::new("chain", Positions::F64(chain), faces).expect("a mesh"));
            let truth: Vec<_> = (1..60).map(|b| [b - 1, b]).collect();
            assert_eq!(pairs(engine(), vec![body.clone()]), truth, "{scale:e}");
            let sanitizer = support::sanitizer(support::ORDERS[1]);
            assert_eq!(pairs(sanitizer, vec![body]), truth, "{scale:e}");
        }
    }
}

#[test]
fn vertices_that_no_face_uses_are_not_seen() {
    let chain = (0..50).flat_map(|i| at(2.0 * i as f32, 3.0)).collect::<Vec<_>>();
    let mut points = vec![[f32::NAN; 3], [f32::INFINITY, 0.0, 0.0], [1e30; 3]];
    points.extend(chain);
    let faces: Vec<_> = (1..51).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let truth: Vec<_> = (1..50).map(|b| [b - 1, b]).collect();
    for device in machines() {
        assert_eq!(pairs(device, vec![still(&points, &faces)]), truth);
    }
}

#[test]
fn zero_has_no_sign() {
    let signed = |zero: f32| [[zero, zero, zero], [1.0, zero, zero], [zero, 1.0, zero]];
    let crossing = |zero: f32| [[0.25, 0.25, -1.0], [0.25, 0.25, 1.0], [zero, zero, zero]];
    for (p, q) in [(0.0, 0.0), (0.0, -0.0), (-0.0, 0.0), (-0.0, -0.0)] {
        assert_eq!(
            pairs(engine(), vec![loose(&[signed(p), signed(q), crossing(p)])]),
            [[0, 1], [0, 2], [1, 2]]
        );
    }
}

#[test]
fn doubles_are_not_rounded() {
    // Gaps of one unit in the last place of a double, which vanish in floats: the boxes overlap, the triangles do not.
    let gap = 2f64.powi(-52);
    let points: Vec<[f64; 3]> = (0..40)
        .flat_map(|i| {
            let z = 1.0 + f64::from(i) * gap;
            [[0.0, 0.0, z], [1.0, 0.0, z], [0.0, 1.0, z]]
        })
        .collect();
    let faces = (0..40).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let body = Body::deformable(Mesh::new("stack", Positions::F64(points), faces).expect("a mesh"));
    for device in machines() {
        let contacts = ask(device, vec![body.clone()], Query::discrete());
        assert_eq!((contacts.len(), contacts.stats.triangle_pairs), (0, 40 * 39 / 2));
    }
}

/// The float test is used on scenes without its errors: the pipeline is the same for both.
#[test]
fn the_float_test_finds_the_known_pairs_too() {
    let query = Query::from(Discrete::by(TriangleTest::Moller));
    for device in machines() {
        let contacts = ask(device, vec![scene::grid(4).expect("a scene")], query);
        assert_eq!((contacts.len() as u64, contacts.stats.uncertain), (scene::grid_pairs(4), 0));
    }
}
