//! Moving scenes.

use super::Finds::{AtOnce, Contacts, EachVertex, Includes};
use super::still::cuboid;
use super::{Numbers, Scene};
use nearmiss::contacts::Kind::{Ee, Vf};

/// Returns a square floor of `n` by `n` unit squares in z = 0. Each has two triangles, cut along
/// the diagonal from (0, 0) to (1, 1).
fn floor(n: u32) -> Numbers {
    let at = |i: u32, j: u32| i * (n + 1) + j;
    let t0 = (0..=n).flat_map(|i| (0..=n).map(move |j| [f64::from(i), f64::from(j), 0.0])).collect();
    let squares = (0..n).flat_map(|i| (0..n).map(move |j| (i, j)));
    let faces = squares.flat_map(|(i, j)| {
        [[at(i, j), at(i + 1, j), at(i + 1, j + 1)], [at(i, j), at(i + 1, j + 1), at(i, j + 1)]]
    });
    Numbers { t0, faces: faces.collect(), ..Numbers::default() }
}

/// Returns falling triangles, from height 3 to -1. Each has a tip, vertex 3 i, at its place, and
/// two corners above it.
fn tips(places: &[[f64; 2]]) -> Numbers {
    let tip = |[x, y]: [f64; 2]| [[x, y, 3.0], [x, y + 0.125, 13.0], [x + 0.0625, y, 13.0]];
    Numbers::loose(&places.iter().map(|p| tip(*p)).collect::<Vec<_>>()).by([0.0, 0.0, -4.0])
}

fn wide(of: Numbers) -> Numbers {
    Numbers { wide: true, ..of }
}

fn shifted(of: Numbers, d: [f64; 3]) -> Numbers {
    let add = |p: &[f64; 3]| [p[0] + d[0], p[1] + d[1], p[2] + d[2]];
    Numbers { t0: of.t0.iter().map(add).collect(), t1: of.t1.iter().map(add).collect(), ..of }
}

pub fn scenes() -> Vec<Scene> {
    let point = |z: f64| Numbers::loose(&[[[0.75, 0.5, z]; 3]]).by([0.0, 0.0, -4.0]);
    let mut all = vec![
        // A triangle that is a point falls on a face: only its three vertices meet it.
        Scene::new(
            "X12",
            "a triangle that is a point",
            vec![point(3.0), floor(1)],
            Contacts((0..3).map(|v| (Vf, v, 0, 0.75)).collect()),
        ),
        Scene::new(
            "X33",
            "contacts at the very start",
            vec![wide(shifted(point(3.0), [0.0, 0.0, -3.0 + 2f64.powi(-40)])), floor(1)],
            Contacts((0..3).map(|v| (Vf, v, 0, 2f64.powi(-42))).collect()),
        ),
        Scene::new(
            "X16",
            "nothing in the way",
            vec![shifted(point(3.0), [2.0, 0.0, 0.0]), floor(1)],
            Contacts(vec![]),
        ),
        // On the diagonal: both triangles of the square, and their edge.
        Scene::new(
            "X36",
            "a tip on the edge of two triangles",
            vec![tips(&[[0.5, 0.5]]), floor(1)],
            Includes(vec![(Vf, [0, 1], 0, 0), (Vf, [0, 1], 0, 1)], 0.75),
        ),
        Scene::new(
            "X36",
            "tips on the lines of a grid (rapier#165)",
            vec![
                tips(&[[5.0, 2.63113], [2.63113, 5.0], [3.0, 3.0], [2.5, 2.5], [0.0, 0.0], [7.0, 1.25]]),
                wide(floor(7)),
            ],
            EachVertex((0..6).map(|i| 3 * i).collect(), 0.75),
        ),
    ];
    all.extend(head_on());
    all.extend(together());
    all.extend(huge());
    all
}

/// Returns scenes of f32 numbers whose computation overflows f32: a point falls on a face. The
/// other frame or the other body needs f64.
fn huge() -> Vec<Scene> {
    const MOST: f64 = f32::MAX as f64;
    let face = |s: f64| Numbers::loose(&[[[-s, -s, 0.0], [s, -s, 0.0], [0.0, s, 0.0]]]);
    let fall =
        |t0: f64, t1: f64| Numbers { t1: vec![[0.0, 0.0, t1]; 3], ..Numbers::loose(&[[[0.0, 0.0, t0]; 3]]) };
    let met = |at: f64| Contacts((0..3).map(|v| (Vf, v, 0, at)).collect());
    let scene = |what: &str, s: f64, [t0, t1]: [f64; 2], at: f64| {
        Scene::new("X65", what, vec![fall(t0, t1), face(s)], met(at))
    };
    let mut all = vec![
        scene("to the ends of f32", MOST, [MOST, -MOST], 0.5),
        scene("from far away", 1.0, [3.0 * 2f64.powi(60), -(2f64.powi(60))], 0.75),
        scene("onto a huge face", MOST, [3.0, -1.0], 0.75),
    ];
    all.extend([61, 100, 126].map(|power| {
        let s = 2f64.powi(power);
        scene(&format!("times 2^{power}"), s, [1.5 * s, -0.5 * s], 0.75)
    }));
    all
}

/// Boxes that collide, alone and within a huge common motion (FCL#555).
fn head_on() -> Vec<Scene> {
    let boxes = |common: f64| {
        let small = cuboid([1.0, 0.25, 0.25], [2.0, 0.75, 0.75]).by([common - 1.0, 0.0, common]);
        vec![wide(cuboid([0.0; 3], [0.5, 1.0, 1.0]).by([common, 0.0, common])), wide(small)]
    };
    // The near side of the small box, x = 1, meets the side x = 1/2 of the large one at t = 1/2.
    // Corner 4 meets the upper triangle of that side, corner 2 the lower one.
    let scene = |what, common: f64| {
        Scene::new(
            "FCL#555",
            what,
            boxes(common),
            Includes(vec![(Vf, [1, 0], 4, 10), (Vf, [1, 0], 2, 11)], 0.5),
        )
    };
    let static_one = |swapped: bool| {
        let fall = tips(&[[0.25, 0.125]]);
        let bodies = if swapped { vec![floor(1), fall] } else { vec![fall, floor(1)] };
        let of = if swapped { [1, 0] } else { [0, 1] };
        Scene::new(
            "X24",
            if swapped { "one at rest, exchanged" } else { "one at rest" },
            bodies,
            Includes(vec![(Vf, of, 0, 0)], 0.75),
        )
    };
    vec![
        scene("boxes head on", 0.0),
        scene("boxes head on, a million together", 1048576.0),
        static_one(false),
        static_one(true),
    ]
}

/// Bodies that touch from the start.
fn together() -> Vec<Scene> {
    let tetra = || Numbers {
        t0: vec![[0.0; 3], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [0.0, 0.0, 4.0]],
        faces: vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]],
        ..Numbers::default()
    };
    // A tetrahedron and itself: each vertex meets the three faces at it, both ways. Each edge meets
    // itself and the four at its ends.
    let (vf, ee) = (4 * 3, 6 + 6 * 4);
    let edges = Numbers { t0: vec![[0.0; 3], [4.0, 0.0, 0.0]], faces: vec![[0, 1, 1]], ..Numbers::default() };
    let aside = Numbers { t0: vec![[4.0, 0.0, 0.0], [9.0, 0.0, 0.0]], ..edges.clone() };
    vec![
        Scene::new("X50", "a mesh and itself, at rest", vec![tetra(), tetra()], AtOnce(2 * vf + ee)),
        Scene::new(
            "X50",
            "a mesh and itself, moving",
            vec![tetra().by([1.0, 2.0, 0.5]), tetra().by([1.0, 2.0, 0.5])],
            AtOnce(2 * vf + ee),
        ),
        // Each body is a face 0 1 1 with edges 0 1 and 1 1: (4, 0, 0) is an end of each.
        Scene::new(
            "X30",
            "segments end to end, leaving",
            vec![edges, aside.by([3.0, 0.0, 0.0])],
            Includes(vec![(Ee, [0, 1], 0, 0), (Vf, [0, 1], 1, 0), (Vf, [1, 0], 0, 0)], 0.0),
        ),
    ]
}
