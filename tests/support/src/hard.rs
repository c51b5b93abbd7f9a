//! Small scenes with a slow search for the first contact: no test separates their features, or
//! finds the place of contact. Each once took seconds or minutes; only their answer is quadratic.
//! Shared with `benches/stages.rs`.

use nearmiss::mesh::{Body, Mesh, Positions};
use nearmiss_lab::scene::Rng;

type Corner = [f64; 3];

/// A body of triangles that share no vertex, by its positions at both ends of the step.
fn loose(name: &str, triangles: &[[[Corner; 3]; 2]]) -> Body {
    let faces: Vec<_> = (0..triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let mesh = |t: usize| {
        let points = triangles.iter().flat_map(|moved| moved[t]).map(|p| p.map(|x| x as f32)).collect();
        Mesh::new(name, Positions::F32(points), faces.clone()).expect("a mesh")
    };
    Body::moving(mesh(0), mesh(1)).expect("two frames")
}

/// A number from -1 to 1, of 10 bits: sums of a few are exact in f32.
fn number(rng: &mut Rng) -> f64 {
    ((rng.bits() & 1023) as f64 - 512.0) / 512.0
}

/// A triangle at rest, or moved.
fn moved(corners: [Corner; 3], by: Corner) -> [[Corner; 3]; 2] {
    [corners, corners.map(|p| [0, 1, 2].map(|k| p[k] + by[k]))]
}

/// `n` equal triangles, which move by `by`.
fn equal(name: &str, n: usize, by: Corner) -> Body {
    loose(name, &vec![moved([[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], by); n])
}

/// `n` triangles in a plane, each with its own motion within the plane.
fn coplanar(n: usize) -> Body {
    let mut rng = Rng::new(3);
    let at = |[x, y]: [f64; 2]| [x, y, x + y];
    let triangle = |_| {
        let mut spot = |size: f64| at([0; 2].map(|_| size * number(&mut rng)));
        let place = spot(4.0);
        let corners = [0; 3].map(|_| spot(1.0)).map(|p| [0, 1, 2].map(|k| p[k] + place[k]));
        moved(corners, spot(2.0))
    };
    loose("coplanar", &(0..n).map(triangle).collect::<Vec<_>>())
}

/// `n` triangles along a line, `thick` off it, each with its own motion along the line.
fn slivers(name: &str, n: usize, thick: f64) -> Body {
    let mut rng = Rng::new(4);
    let triangle = |_| {
        let mut along = |size: f64| size * number(&mut rng);
        let place = along(4.0);
        let corners = [0; 3].map(|_| {
            let s = place + along(2.0);
            [s + thick * along(1.0), s + thick * along(1.0), s]
        });
        moved(corners, [along(2.0); 3])
    };
    loose(name, &(0..n).map(triangle).collect::<Vec<_>>())
}

/// Corner `i` of `n` on the unit circle.
pub fn around(i: usize, n: usize) -> [f64; 3] {
    let (sin, cos) = (std::f64::consts::TAU * i as f64 / n as f64).sin_cos();
    [cos, sin, 0.0]
}

/// A flat fan of `n` triangles at rest, each with its own corner in the middle: all touch there.
fn split_fan(n: usize) -> Body {
    let triangle = |i| moved([[0.0; 3], around(i, n), around(i + 1, n)], [0.0; 3]);
    loose("split fan", &(0..n).map(triangle).collect::<Vec<_>>())
}

/// All scenes, by name; each has a `part`-th of its triangles.
pub fn hard(part: usize) -> Vec<(&'static str, Body)> {
    vec![
        ("slivers-100", slivers("slivers", 100 / part, 1.0 / 1024.0)),
        ("equal-500-at-rest", equal("at rest", 500 / part, [0.0; 3])),
        ("equal-500-in-their-plane", equal("in their plane", 500 / part, [0.5, 0.25, 0.0])),
        ("coplanar-300", coplanar(300 / part)),
        ("collinear-300", slivers("collinear", 300 / part, 0.0)),
        ("split-fan-1000", split_fan(1000 / part)),
    ]
}
