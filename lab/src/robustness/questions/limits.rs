//! Limits of the parameters: tolerance, separation, the end of the step; and of size.

use super::Expect::{Apart, Meets, Near, Sure};
use super::{EDGE, FACE, Question, and, ee, vf, with};

pub fn questions() -> Vec<Question> {
    let mut all = ends();
    all.extend(separations());
    all.extend(tolerances());
    all.extend(sizes());
    all
}

fn still(z: f64) -> super::Four {
    with([2.0, 2.0, z], FACE)
}

/// Steps that end early.
fn ends() -> Vec<Question> {
    let until = |end: f64, q: Question| Question { end, ..q };
    vec![
        until(0.5, vf(("X31", "at the end of half a step"), still(1.0), still(-1.0), Meets(0.5))),
        until(0.5, vf(("X32", "after the end of half a step"), still(1.1), still(-0.9), Apart)),
        until(0.1, vf(("X31", "an end off the grid"), still(1.0), still(-9.0), Meets(0.1))),
    ]
}

/// Contact at a distance.
fn separations() -> Vec<Question> {
    let apart = |separation: f64, q: Question| Question { separation, tolerance: 1e-6, ..q };
    let edges = |z: f64| and(EDGE, [[1.0, -1.0, z], [1.0, 1.0, z]]);
    let mut all = vec![
        apart(1.0, vf(("X38", "nearer at the start"), still(0.5), still(0.75), Sure(0.0))),
        apart(1.0, vf(("X38", "at it at the start"), still(1.0), still(2.0), Meets(0.0))),
        apart(1.0, vf(("X38", "beyond it"), still(1.001), still(1.5), Apart)),
        apart(1.0, vf(("X38", "coming near"), still(3.0), still(-1.0), Sure(0.5))),
        apart(1e9, vf(("X38", "far more than they are long"), still(3.0), still(-1.0), Sure(0.0))),
        apart(1.0, ee(("X38", "edges"), edges(3.0), edges(-1.0), Sure(0.5))),
        apart(1e-12, vf(("X39", "far below f32"), still(3.0), still(-1.0), Meets(0.75))),
    ];
    // A path past a corner at that distance, across all three axes. It is nearest at t = 1/2, and
    // reaches the distance a little before.
    let d = 1.0 / 3f64.sqrt();
    let before = (1.0f64 - 0.999 * 0.999).sqrt() / 2f64.sqrt() / 8.0;
    let by = |factor: f64, s: f64| with([-d * factor + s, -d * factor - s, d * factor], FACE);
    for (what, factor, expect) in [
        ("flying by", 1.001, Apart),
        ("flying by, nearer", 0.999, Sure(0.5 - before)),
        // The nearest place is off by the rounding of its own coordinates.
        ("flying by at it, but for 1e-7 more", 1.0 + 1e-7, Near),
    ] {
        all.push(apart(1.0, vf(("X38", what), by(factor, -4.0), by(factor, 4.0), expect)));
    }
    all.push(Question {
        early: 1e-2,
        blur: 1e-9,
        ..apart(
            1.0,
            vf(
                ("X38", "flying by at it, but for 1e-7 less"),
                by(1.0 - 1e-7, -4.0),
                by(1.0 - 1e-7, 4.0),
                Meets(0.5 - (2e-7f64).sqrt() / 2f64.sqrt() / 8.0),
            ),
        )
    });
    all
}

/// Tolerances that are zero or almost zero.
fn tolerances() -> Vec<Question> {
    let mut all = Vec::new();
    for tolerance in [0.0, 5e-324, 1e-300, 1e-12] {
        let adjusted = |q: Question| Question { tolerance, early: 1e-4, ..q };
        all.push(adjusted(vf(("X40", "hardly a tolerance"), still(3.0), still(-1.0), Meets(0.75))));
        all.push(adjusted(vf(("X40", "hardly a tolerance, apart"), still(3.0), still(1.0), Apart)));
    }
    for tolerance in [1.0, 1e300] {
        let adjusted = |q: Question| Question { tolerance, early: 1.0, ..q };
        all.push(adjusted(vf(("X40", "a tolerance beyond all"), still(3.0), still(-1.0), Meets(0.75))));
    }
    // Half of the distance at the start.
    let leaving = vf(("X34", "farther than the tolerance, leaving"), still(1e-6), still(5.0), Apart);
    all.push(Question { tolerance: 5e-7, is_fine: true, ..leaving });
    all
}

/// Sizes, and pairs of very different sizes.
fn sizes() -> Vec<Question> {
    let sized = |id, what, size: f64, z: [f64; 2], expect| {
        let [from, to] = z.map(|z| still(z).map(|p| p.map(|x| x * size)));
        Question { tolerance: 1e-5 * size, ..vf((id, what), from, to, expect) }
    };
    let mut all = Vec::new();
    let scales = [1e30, 1e-30, 1e15, 1e-15, 2f64.powi(-100), 2f64.powi(-900), 2f64.powi(400)];
    for size in scales {
        let id = if size == 2f64.powi(-100) { "X05" } else { "X07" };
        all.push(Question { blur: 1e-15, ..sized(id, "scaled", size, [3.0, -1.0], Sure(0.75)) });
        all.push(sized(id, "scaled, apart", size, [3.0, 1.0], Apart));
    }
    // Rounded to subnormal floats first: a length has 14,272 units in the last place.
    let tiny = |z: f64| still(z).map(|p| p.map(|x| f64::from((x * 1e-41) as f32)));
    let subnormal = vf(("X06", "subnormal floats"), tiny(3.0), tiny(-1.0), Meets(0.75));
    all.push(Question { tolerance: 1e-44, blur: 1e-3, early: 1e-2, ..subnormal });
    let tiny = |z: f64| still(z).map(|p| p.map(|x| x * 5e-324));
    let least = vf(("X06", "the least doubles"), tiny(3.0), tiny(-1.0), Meets(0.75));
    all.push(Question { tolerance: 5e-324, early: 1.0, is_fine: true, ..least });
    // An edge of length two million across one of a thousandth.
    let mixed = |z: f64| and([[-1e6, 0.0, 0.0], [1e6, 0.0, 0.0]], [[0.25, -5e-4, z], [0.25, 5e-4, z]]);
    let small = ee(("X08", "a million and a thousandth"), mixed(1e-3), mixed(-1e-3), Sure(0.5));
    all.push(Question { is_fine: true, tolerance: 1e-7, ..small });
    // Far from the origin, with all numbers exact, even in f32.
    let far = |z: f64| with([2.0, 2.0, z], FACE).map(|p| [p[0] + 1e7, p[1] - 1e7, p[2] + 8e6]);
    all.push(vf(("X09", "far from the origin"), far(3.0), far(-1.0), Sure(0.75)));
    all.push(vf(("X10", "far from the origin, apart"), far(3.0), far(1.0), Apart));
    // Far from the origin, with a fraction that no float there holds.
    let fine = |z: f64| with([2.1, 2.3, z], FACE).map(|p| [p[0] + 1e7, p[1] + 1e7, p[2]]);
    all.push(vf(("X09", "far from the origin, off the grid of floats"), fine(3.0), fine(-1.0), Sure(0.75)));
    // Times must be as exact for a large face as for a small one (parry#429). So must those for a
    // shallow face (bullet3#2157).
    for side in [10.0, 100.0, 1000.0] {
        let at = |z: f64| with([side / 4.0, side / 4.0, z], FACE.map(|p| p.map(|x| x / 8.0 * side)));
        let tile = vf(("parry#429", "a tile of any size"), at(3.0), at(-1.0), Sure(0.75));
        all.push(Question { early: 1e-4, ..tile });
    }
    let wide = |z: f64| with([20.0, 20.0, z], FACE.map(|p| p.map(|x| x * 10.5)));
    let shallow = vf(("bullet3#2157", "84 wide, 0.05 deep"), wide(0.05), wide(-0.05), Sure(0.5));
    all.push(Question { early: 2e-3, ..shallow });
    all
}
