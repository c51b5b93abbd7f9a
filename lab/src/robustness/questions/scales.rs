//! The ends of the range of floats: a contact and a near miss of each directed family.

use super::Expect::{Apart, Meets, Near, Sure};
use super::{EDGE, FACE, Four, Question, and, ee, vf, with};

/// A family, the sizes of its three axes, and whether one axis vanishes next to another: then only
/// misses and false certificates are faults.
type Scale = (&'static str, &'static str, [f64; 3], bool);

fn scales() -> [Scale; 9] {
    let p = |e: i32| 2f64.powi(e);
    let (least, single) = (f64::from_bits(1), f64::from(f32::from_bits(1)));
    [
        ("X61", "huge for f32", [p(56); 3], false),
        ("X61", "huge for f64", [p(400); 3], false),
        ("X61", "as large as may be", [p(476); 3], false),
        ("X62", "axes of many sizes", [1.0, p(-12), p(10)], false),
        ("X62", "axes of many more", [p(30), p(-20), p(-5)], true),
        ("X63", "products that overflow and vanish in f32", [p(56), p(-75), p(-74)], true),
        ("X63", "products that overflow and vanish in f64", [p(476), p(-537), p(-537)], true),
        ("X64", "subnormal floats", [4096.0 * single; 3], false),
        ("X64", "subnormal doubles", [4096.0 * least; 3], false),
    ]
}

pub fn questions() -> Vec<Question> {
    let mut all = Vec::new();
    for (id, what, by, lost) in scales() {
        let sized = |all: Four| all.map(|p| [0, 1, 2].map(|k| p[k] * by[k]));
        let smallest = by[0].min(by[1]).min(by[2]);
        let adjusted = |q: Question| Question {
            tolerance: smallest / 1024.0,
            early: if lost { 1.0 } else { 1e-2 },
            is_fine: lost || id != "X61",
            ..q
        };
        let above = |z: f64| sized(with([2.0, 2.0, z], FACE));
        let across = |z: f64| sized(and(EDGE, [[1.0, -1.0, z], [1.0, 1.0, z]]));
        let (meets, apart) = if lost { (Meets(0.75), Near) } else { (Sure(0.75), Apart) };
        all.push(adjusted(vf((id, what), above(3.0), above(-1.0), meets)));
        all.push(adjusted(vf((id, what), above(3.0), above(1.0), apart)));
        all.push(adjusted(ee((id, what), across(3.0), across(-1.0), meets)));
        all.push(adjusted(ee((id, what), across(3.0), across(1.0), apart)));
    }
    all.extend(faint());
    all
}

/// Features that rest in a face, or on another edge. On one axis their extent is about the smallest
/// f32, compared with a million. In f32 their heights no longer match.
fn faint() -> [Question; 2] {
    let x = |parts: f64| parts * 1.375 * f64::from(f32::from_bits(1));
    let side = 524288.0;
    let face = [[0.0; 3], [x(1.0), side, 0.0], [x(1.0), 0.0, side]];
    let rest = with([x(0.375), 0.1875 * side, 0.1875 * side], face);
    let cross = and(
        [[0.0; 3], [x(1.0), side / 2.0, side / 2.0]],
        [[x(0.375), 0.375 * side, 0.0], [x(0.375), 0.0, 0.375 * side]],
    );
    let adjusted = |q: Question| Question { is_fine: true, ..q };
    [
        adjusted(vf(("X63", "at rest in a face, one axis below f32"), rest, rest, Meets(0.0))),
        adjusted(ee(("X63", "at rest on an edge, one axis below f32"), cross, cross, Meets(0.0))),
    ]
}
