//! Cases of a vertex and a face.

use super::Expect::{Apart, Meets, Near, Sure};
use super::{FACE, Question, Row, vf, with};

/// Motions against [`super::FACE`] at rest.
const FALLS: [Row<[f64; 3]>; 21] = [
    ("X30", "plain", [2.0, 2.0, 3.0], [2.0, 2.0, -1.0], Sure(0.75)),
    ("X15", "in the plane, entering", [12.0, 4.0, 0.0], [-4.0, 4.0, 0.0], Meets(0.5)),
    ("X16", "in the plane, passing", [9.0, -4.0, 0.0], [9.0, 8.0, 0.0], Apart),
    ("X22", "at rest, apart", [2.0, 2.0, 1.0], [2.0, 2.0, 1.0], Apart),
    ("X22", "at rest, touching", [2.0, 2.0, 0.0], [2.0, 2.0, 0.0], Meets(0.0)),
    ("X30", "leaving", [2.0, 2.0, 0.0], [2.0, 2.0, 5.0], Meets(0.0)),
    ("X30", "leaving within the plane", [2.0, 2.0, 0.0], [20.0, 2.0, 0.0], Meets(0.0)),
    ("X31", "arriving", [2.0, 2.0, 5.0], [2.0, 2.0, 0.0], Meets(1.0)),
    ("X31", "arriving at a corner", [4.0, 8.0, 5.0], [0.0, 8.0, 0.0], Meets(1.0)),
    ("X32", "almost arriving", [2.0, 2.0, 5.0], [2.0, 2.0, 1e-3], Apart),
    ("X32", "arriving but for less than the tolerance", [2.0, 2.0, 5.0], [2.0, 2.0, 1e-15], Near),
    ("X33", "at once", [2.0, 2.0, 1e-9], [2.0, 2.0, -1.0], Meets(1e-9)),
    ("X33", "at once, below the grid of f64", [2.0, 2.0, 1e-18], [2.0, 2.0, -1.0], Meets(1e-18)),
    ("X34", "nearer than the tolerance, leaving", [2.0, 2.0, 1e-6], [2.0, 2.0, 5.0], Near),
    ("X35", "fast", [2.0, 2.0, 3e6], [2.0, 2.0, -1e6], Sure(0.75)),
    ("X35", "fast, aside", [2.0, 9.0, 3e6], [2.0, 9.0, -1e6], Apart),
    ("X36", "at a corner", [0.0, 0.0, 3.0], [0.0, 0.0, -1.0], Meets(0.75)),
    ("X36", "at a side", [4.0, 4.0, 3.0], [4.0, 4.0, -1.0], Meets(0.75)),
    ("X36", "past a side", [4.001, 4.001, 3.0], [4.001, 4.001, -1.0], Apart),
    ("X12", "a needle of a path, in the plane, along a side", [8.0, 0.0, 0.0], [16.0, 0.0, 0.0], Meets(0.0)),
    ("X16", "in the plane, towards a side, short of it", [12.0, 4.0, 0.0], [4.5, 4.0, 0.0], Apart),
];

/// Faces without extent at (2, 2, 0).
const FLAT: [(&str, [[f64; 3]; 3]); 3] = [
    ("a point", [[2.0, 2.0, 0.0]; 3]),
    ("two points", [[2.0, 2.0, 0.0], [2.0, 2.0, 0.0], [7.0, 1.0, 0.0]]),
    ("on a line", [[0.0, 2.0, 0.0], [8.0, 2.0, 0.0], [1.0, 2.0, 0.0]]),
];

pub fn questions() -> Vec<Question> {
    let mut all: Vec<Question> = FALLS
        .iter()
        .map(|&(id, what, from, to, expect)| vf((id, what), with(from, FACE), with(to, FACE), expect))
        .collect();
    let other = [[8.0, 8.0, 0.0], [8.0, 0.0, 0.0], [0.0, 8.0, 0.0]];
    let [from, to] = [3.0, -1.0].map(|z| with([4.0, 4.0, z], other));
    all.push(vf(("X36", "at the side of two, the other one"), from, to, Meets(0.75)));
    for (what, face) in FLAT {
        let to = |x, y, z| with([x, y, z], face);
        all.push(vf(("X12", what), to(2.0, 2.0, 3.0), to(2.0, 2.0, -1.0), Meets(0.75)));
        all.push(vf(("X12", what), to(2.0, 3.0, 3.0), to(2.0, 3.0, -1.0), Apart));
        all.push(vf(("X12", what), to(2.0, 2.0, 0.0), to(2.0, 2.0, 0.0), Meets(0.0)));
    }
    all.extend(turning());
    all.extend(moving());
    all
}

/// Faces that turn over through a segment at t = 1/2; and planes that a vertex touches, enters and
/// leaves.
fn turning() -> Vec<Question> {
    let upright = [[0.0, 0.0, 0.0], [8.0, 0.0, 0.0], [4.0, 8.0, 0.0]];
    let turned = [[0.0, 0.0, 0.0], [8.0, 0.0, 0.0], [4.0, -8.0, 0.0]];
    let over = |what, from, to, expect| vf(("X26", what), with(from, upright), with(to, turned), expect);
    let mut all = vec![
        over("turning over", [4.0, -1.0, 3.0], [4.0, -1.0, -1.0], Sure(0.75)),
        over("turning over, aside", [20.0, 20.0, 0.0], [20.0, 20.0, 0.0], Apart),
    ];
    // The height over the plane is 32 (t - 1/2)^2 - 8 d: at d = 0 the path is tangent to the plane,
    // inside the face. If the far corner `x` starts at -2 and ends at 14, the face is a segment at
    // 1/8: a third root, outside.
    let face = |t: f64, x: f64| [[0.0, 0.0, 0.0], [x, 0.0, 0.0], [0.0, 8.0, 8.0 * (t - 0.5)]];
    let grazing = |id, what, d: f64, x: [f64; 2], expect| {
        let at = |t: f64| with([2.0, 4.0 * t, 2.0 * (t - 0.5) + d], face(t, x[t as usize]));
        vf((id, what), at(0.0), at(1.0), expect)
    };
    let ulp = f64::EPSILON;
    // Without a search, as in f32 alone, only the time is known at which the vertex comes within
    // half the tolerance. That is earlier by its square root.
    let graze = |what, d, t| Question { is_fine: true, ..grazing("X27", what, d, [8.0; 2], Meets(t)) };
    all.extend([
        graze("tangent", 0.0, 0.5),
        graze("a bit more than tangent", ulp, 0.5 - (ulp / 4.0).sqrt()),
        grazing("X27", "a bit less than tangent", -ulp, [8.0; 2], Near),
        grazing("X27", "clearly less than tangent", -1e-3, [8.0; 2], Apart),
        grazing("X29", "in and out again", 0.0625, [8.0; 2], Sure(0.375)),
        grazing("X28", "three roots, the first outside", 0.0625, [-2.0, 14.0], Sure(0.375)),
    ]);
    all
}

/// Moving faces.
fn moving() -> Vec<Question> {
    let face = |x: f64, z: f64| FACE.map(|p| [p[0] + x, p[1], p[2] + z]);
    let rising = [with([2.0, 2.0, 3.0], FACE), with([2.0, 2.0, 3.0], face(0.0, 4.0))];
    let huge = 1048576.0;
    let together = [with([2.0, 2.0, 3.0], FACE), with([2.0 + huge, 2.0, -1.0], face(huge, 0.0))];
    // A relative motion of a thousandth within a common one of a million.
    let fine = 1.0 / 1024.0;
    let slow = [with([2.0, 2.0, fine], FACE), with([2.0 + huge, 2.0, -fine], face(huge, 0.0))];
    let quiet = |q: Question| Question { early: 0.02, is_fine: true, ..q };
    vec![
        vf(("X24", "the vertex is at rest"), rising[0], rising[1], Sure(0.75)),
        vf(("X25", "moving a million together"), together[0], together[1], Sure(0.75)),
        quiet(vf(("X25", "moving a million together, a thousandth apart"), slow[0], slow[1], Sure(0.5))),
    ]
}
