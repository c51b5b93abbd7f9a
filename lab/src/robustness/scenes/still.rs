//! Still scenes.

use super::Finds::{Oracle, OracleByFilter, Pairs};
use super::{Numbers, PATCH, PATCH_FACES, Scene, TRIANGLES};
use crate::oracle::Triangle;

pub fn scenes() -> Vec<Scene> {
    let mut all = degenerate();
    all.extend(neighbours());
    all.extend(flush());
    all.extend(few());
    all.extend(reported());
    all.extend(huge());
    all
}

/// Returns a triangle of side `size` with lower corner `p`, in a plane across z.
fn flat(p: [f64; 3], size: f64) -> Triangle {
    let [x, y, z] = p;
    [[x, y, z], [x + size, y, z], [x, y + size, z]]
}

/// Returns the corners of a box and its twelve triangles.
pub fn cuboid(lo: [f64; 3], hi: [f64; 3]) -> Numbers {
    let corner = |i: usize| [0, 1, 2].map(|k| if i >> k & 1 == 1 { hi[k] } else { lo[k] });
    let sides = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]];
    Numbers {
        t0: (0..8).map(corner).collect(),
        faces: sides.iter().flat_map(|s| [[s[0], s[1], s[2]], [s[0], s[2], s[3]]]).collect(),
        ..Numbers::default()
    }
}

/// Returns each triangle with its own vertices.
fn unwelded(of: &Numbers) -> Numbers {
    Numbers::loose(&(0..of.faces.len()).map(|f| of.triangle(f)).collect::<Vec<_>>())
}

/// Triangles that are points or segments, and pairs of very different sizes.
fn degenerate() -> Vec<Scene> {
    let face = flat([-1.0, -1.0, 0.0], 4.0);
    let point = |p: [f64; 3]| [p; 3];
    let segment = |p: [f64; 3], q: [f64; 3]| [p, q, q];
    let crowd = [
        face,
        point([0.0; 3]),
        segment([0.0; 3], [0.0, 0.0, 1.0]),
        [[0.0, 0.0, -1.0], [0.0, 0.0, 1.0], [0.0, 0.0, 3.0]],
        point([0.0, 0.0, 1.0]),
        segment([5.0, 5.0, 5.0], [6.0, 6.0, 6.0]),
        point([1.0, 0.0, 1e-30]),
        segment([3.0, -1.0, 0.0], [3.0, -1.0, 7.0]),
    ];
    let box_and_tile = [cuboid([-1.0; 3], [1.0; 3]), {
        let tile = Numbers::loose(&[flat([-1.0, -1.0, 0.0], 2.0)]);
        Numbers { faces: vec![[0, 1, 2], [2, 1, 0]], ..tile }
    }];
    let tiny = |x: f64| flat([x, 0.0, 0.0], 3.0).map(|p| p.map(|x| f64::from((x * 1e-41) as f32)));
    let mixed = [
        flat([0.0; 3], 1e6),
        [[3.0, 3.0, -1e-3], [3.0, 3.0, 1e-3], [3.001, 3.0, 1e-3]],
        point([1e6, 1e6, 0.0]),
    ];
    let bvh44 = [point([0.0; 3]), segment([0.0; 3], [0.0, 0.0, 1.0])];
    vec![
        Scene::new("X12", "points, segments and a face", vec![Numbers::loose(&crowd)], Oracle),
        Scene::new(
            "svenstaro/bvh#44",
            "a point and a segment",
            vec![Numbers::loose(&bvh44)],
            Pairs(vec![[0, 1]]),
        ),
        Scene::new("Falcor#435", "a box and a tile without thickness", box_and_tile.into(), Oracle),
        Scene::new(
            "X06",
            "subnormal floats",
            vec![Numbers::loose(&[tiny(0.0), tiny(2.0), tiny(6.0)])],
            Pairs(vec![[0, 1]]),
        ),
        Scene::new("X08", "a million and a thousandth", vec![Numbers::loose(&mixed)], Oracle),
    ]
}

/// Scenes of f32 numbers whose computation overflows f32: they are stored in f64.
fn huge() -> Vec<Scene> {
    const MOST: f64 = f32::MAX as f64;
    let face = flat([-1.0, -1.0, 0.0], 4.0);
    let crowd = [
        face,
        [[0.0; 3]; 3],
        [[0.0; 3], [0.0, 0.0, 1.0], [0.0, 0.0, 1.0]],
        [[0.0, 0.0, -1.0], [0.0, 0.0, 1.0], [0.0, 0.0, 3.0]],
        [[0.0, 0.0, 1.0]; 3],
        [[3.0, -1.0, 0.0], [3.0, -1.0, 7.0], [3.0, -1.0, 7.0]],
        [[1.0, 1.0, -f64::from(f32::EPSILON)], [1.0, 1.0, -1.0], [2.0, 1.0, -1.0]],
    ];
    // From one end of the floats to the other: differences overflow. A point and a far smaller
    // triangle are on it.
    let across = [[-MOST, -MOST, 0.0], [MOST, -MOST, 0.0], [0.0, MOST, 0.0]];
    let most = [
        across,
        [[0.0, 0.0, -MOST], [0.0, 0.0, MOST], [MOST, MOST, MOST]],
        [[0.0, MOST, 0.0]; 3],
        [[MOST, MOST, 0.0], [MOST, MOST, MOST], [MOST, 0.0, MOST]],
        flat([-1.0, -1.0, 0.0], 4.0),
        flat([-1.0, -1.0, f64::from(f32::MIN_POSITIVE)], 4.0),
    ];
    let mut all = vec![Scene::new("X65", "to the ends of f32", vec![Numbers::loose(&most)], Oracle)];
    all.extend([59, 61, 100, 125].map(|power| {
        let scaled = crowd.map(|t| t.map(|p| p.map(|x| x * 2f64.powi(power))));
        Scene::new("X65", &format!("times 2^{power}"), vec![Numbers::loose(&scaled)], Oracle)
    }));
    all
}

/// Triangles that share vertices, by index or by position.
fn neighbours() -> Vec<Scene> {
    let adjacent = |scene: Scene| Scene { adjacent: true, ..scene };
    let of = |t0: &[[f64; 3]], faces: &[[u32; 3]]| {
        vec![Numbers { t0: t0.to_vec(), faces: faces.to_vec(), ..Numbers::default() }]
    };
    // Two faces that share vertex 0 and cross beyond it; and a pair that only shares it.
    let cross = [
        [0.0; 3],
        [4.0, 0.0, 0.0],
        [4.0, 4.0, 0.0],
        [3.0, 1.0, -1.0],
        [3.0, 1.0, 1.0],
        [0.0, 0.0, 4.0],
        [0.0, -1.0, 4.0],
    ];
    let crossing = [[0, 1, 2], [0, 3, 4], [0, 5, 6]];
    // Neighbours over the edge 0 1: folded onto each other, opposite, upright.
    let fold =
        [[0.0; 3], [4.0, 0.0, 0.0], [1.0, 3.0, 0.0], [2.0, 2.0, 0.0], [2.0, -2.0, 0.0], [2.0, 0.0, 2.0]];
    let folded = [[0, 1, 2], [1, 0, 3], [0, 1, 4], [0, 1, 5]];
    // Three faces at one edge, pierced by a fourth.
    let fin = [
        [0.0; 3],
        [0.0, 0.0, 4.0],
        [4.0, 0.0, 1.0],
        [-4.0, 1.0, 1.0],
        [0.0, 4.0, 1.0],
        [-1.0, 1.0, 1.0],
        [1.0, 1.0, 1.5],
        [1.0, -1.0, 1.25],
    ];
    let fins = [[0, 1, 2], [1, 0, 3], [0, 1, 4], [5, 6, 7]];
    let reversed: Vec<[u32; 3]> = fins.iter().map(|f| [f[2], f[1], f[0]]).collect();
    vec![
        Scene::new("X14", "a cube that is not welded", vec![unwelded(&cuboid([0.0; 3], [1.0; 3]))], Oracle),
        adjacent(Scene::new(
            "X48",
            "a common vertex, crossing beyond it",
            of(&cross, &crossing),
            Pairs(vec![[0, 1]]),
        )),
        Scene::new("X48", "a common vertex, adjacent pairs excluded", of(&cross, &crossing), Pairs(vec![])),
        adjacent(Scene::new(
            "X49",
            "a common edge: folded, opposite, upright",
            of(&fold, &folded),
            Pairs(vec![[0, 1]]),
        )),
        Scene::new("X47", "three faces at an edge, pierced", of(&fin, &fins), Oracle),
        Scene::new("X47", "three faces at an edge, pierced, turned over", of(&fin, &reversed), Oracle),
        Scene::new("X47", "a Moebius strip and what pierces it", vec![moebius(), spikes()], Oracle),
        adjacent(Scene::new("X47", "a Moebius strip by itself", vec![moebius()], Oracle)),
    ]
}

/// Returns a strip of eight squares around the z axis that turns over once, with coordinates
/// rounded to 1/1024.
fn moebius() -> Numbers {
    let turn = |i: usize| std::f64::consts::PI * i as f64 / 8.0;
    let round = |x: f64| (x * 1024.0).round() / 1024.0;
    let t0 = (0..16)
        .map(|i| {
            let (a, side) = (2.0 * turn(i / 2), if i % 2 == 0 { 1.0 } else { -1.0 });
            let (c, s) = ((a / 2.0).cos() * side, (a / 2.0).sin() * side);
            [(4.0 + c) * a.cos(), (4.0 + c) * a.sin(), s].map(round)
        })
        .collect();
    let faces = (0..8u32).flat_map(|i| {
        let (a, b) = (2 * i, 2 * i + 1);
        // The last square joins the first with its sides swapped.
        let (c, d) = if i == 7 { (1, 0) } else { (2 * i + 2, 2 * i + 3) };
        [[a, b, c], [b, d, c]]
    });
    Numbers { t0, faces: faces.collect(), ..Numbers::default() }
}

/// Returns needles through the strip's middle.
fn spikes() -> Numbers {
    let at = |x: f64, y: f64| [[x, y, -3.0], [x, y, 3.0], [x + 0.25, y, 3.0]];
    Numbers::loose(&[at(4.0, 0.5), at(-4.0, 0.25), at(2.75, -2.75), at(0.0, 8.0)])
}

/// Cubes with flush faces: along the axes, with exact zeros, and rotated, so that rounding decides.
fn flush() -> Vec<Scene> {
    let cubes = || {
        let mut t0 = Vec::new();
        let mut faces = Vec::new();
        for at in [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.5, 0.5, 2.0]] {
            let cube = cuboid(at, at.map(|x| x + 1.0));
            faces.extend(cube.faces.iter().map(|f| f.map(|v| v + t0.len() as u32)));
            t0.extend(cube.t0);
        }
        Numbers { t0, faces, ..Numbers::default() }
    };
    // Right triangles at the origin, each in a plane of two axes: they touch along legs, never
    // along a hypotenuse.
    let [x, y, z] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let legs = [[[0.0; 3], x, y], [[0.0; 3], x, z], [[0.0; 3], y, z], [[0.0; 3], [-1.0, 0.0, 0.0], y]];
    let (c, s) = (3f64.sqrt() / 2.0, 0.5);
    let turned = |narrow: bool| {
        let turn = |[x, y, z]: [f64; 3]| {
            let p = [c * x - s * y, s * x + c * y, z];
            if narrow { p.map(|x| f64::from(x as f32)) } else { p }
        };
        let of = cubes();
        Numbers { t0: of.t0.into_iter().map(turn).collect(), wide: !narrow, ..of }
    };
    vec![
        Scene::new("X51", "cubes stacked along the axes", vec![cubes()], Oracle),
        Scene::new("X51", "triangles that touch along the axes", vec![Numbers::loose(&legs)], OracleByFilter),
        Scene::new("X52", "cubes stacked and turned by 30 degrees, in f32", vec![turned(true)], Oracle),
        Scene::new("X52", "cubes stacked and turned by 30 degrees, in f64", vec![turned(false)], Oracle),
    ]
}

/// Bodies of few triangles, and positions that are hard for a tree.
fn few() -> Vec<Scene> {
    let one = |x: f64| flat([x, 0.0, 0.0], 1.0);
    let of = |n: usize| Numbers::loose(&vec![one(0.0); n]);
    let chain = |step: f64, at: [f64; 3]| -> Vec<Triangle> {
        (0..60).map(|i| flat([at[0] + step * f64::from(i), at[1], at[2]], 1.5 * step)).collect()
    };
    let next = || Pairs((1..60).map(|b| [b - 1, b]).collect());
    let mut outlier = chain(1.0, [0.0; 3]);
    outlier.push(flat([1e6; 3], 1.0));
    let far = |wide: bool| Numbers { wide, ..Numbers::loose(&chain(2.0, [1e7, -1e7, 1e7])) };
    vec![
        Scene::new("X41", "no triangle", vec![of(0)], Pairs(vec![])),
        Scene::new("X41", "one triangle", vec![of(1)], Pairs(vec![])),
        Scene::new("X41", "two triangles", vec![of(2)], Pairs(vec![[0, 1]])),
        Scene::new("X41", "two triangles apart", vec![Numbers::loose(&[one(0.0), one(2.0)])], Pairs(vec![])),
        Scene::new("X41", "one and none", vec![of(1), of(0)], Pairs(vec![])),
        Scene::new("X41", "one and one", vec![of(1), of(1)], Pairs(vec![[0, 0]])),
        Scene::new("X44", "all on a line", vec![Numbers::loose(&chain(1.0, [0.0; 3]))], next()),
        Scene::new("X44", "all on a line but one, a million away", vec![Numbers::loose(&outlier)], next()),
        Scene::new("X09", "ten million from the origin, in f64", vec![far(true)], next()),
        Scene::new("X10", "ten million from the origin, in f32", vec![far(false)], next()),
    ]
}

/// Triangle pairs and a mesh as reported: as given, and rounded.
fn reported() -> Vec<Scene> {
    let narrow = |t: &Triangle| t.map(|p| p.map(|x| f64::from(x as f32)));
    let mut all = Vec::new();
    for (id, _, p, q, given, rounded) in &TRIANGLES {
        let pairs = |meet: bool| Pairs(if meet { vec![[0, 0]] } else { vec![] });
        let two = |p: Triangle, q: Triangle| vec![Numbers::loose(&[p]), Numbers::loose(&[q])];
        all.push(Scene::new(id, "as given", two(*p, *q), pairs(*given)));
        all.push(Scene::new(id, "rounded to f32", two(narrow(p), narrow(q)), pairs(*rounded)));
    }
    let patch = |x: &[f64; 3], round: bool| if round { x.map(|x| f64::from(x as f32)) } else { *x };
    for (what, round) in [("as given", false), ("rounded to f32", true)] {
        let t0 = PATCH.iter().map(|x| patch(x, round)).collect();
        let body = Numbers { t0, faces: PATCH_FACES.to_vec(), ..Numbers::default() };
        all.push(Scene::new("libigl2381", what, vec![body], if round { Oracle } else { Pairs(vec![]) }));
    }
    all
}
