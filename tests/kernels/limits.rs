//! Faults of the cubic: one small input for each class of `docs/internals/accuracy.md`, with its
//! exact answer.
//!
//! These tests hold the text to the program. If one fails because the cubic answers right, correct
//! the text.

use nearmiss_kernels::math::{Real, Vec3};
use nearmiss_kernels::prim::cubic::{Moving, vf_toi};
use nearmiss_lab::oracle::{Triangle, triangles_meet};
use nearmiss_lab::pairs::built::Motion;
use support::truth::built::toi;

/// Its wrong answer.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Says {
    Nothing,
    /// A time after the contact, by more than 1e-3.
    Late,
    /// No later than the contact.
    Right,
}

struct Class {
    name: &'static str,
    face: bool,
    /// Four points at 0, then at 1.
    motion: Motion,
    /// They meet then, in exact arithmetic.
    at: f64,
    double: Says,
    single: Says,
}

const CLASSES: [Class; 7] = [
    Class {
        name: "edges in one plane",
        face: false,
        motion: [
            [[-387, 261, 0], [0, 0, 0], [-266, 430, 0], [-282, 270, 0]],
            [[-3, 117, 0], [-384, 384, 0], [-122, -50, 0], [-90, 174, 0]],
        ],
        at: 0.5,
        double: Says::Right,
        single: Says::Late,
    },
    Class {
        name: "edges almost parallel when they meet",
        face: false,
        motion: [
            [[-8, 15, 1], [0, 0, 0], [8, 16, -16], [9, 16, -9]],
            [[8, -1, -15], [0, 16, -16], [-8, 0, 0], [-7, 0, -9]],
        ],
        at: 0.5,
        double: Says::Right,
        single: Says::Nothing,
    },
    Class {
        name: "edges almost parallel when they meet, in f64",
        face: false,
        motion: [
            [[183, 66, -47], [0, 0, 0], [128, 72, 128], [72, 237, -41]],
            [[-9, 194, 161], [176, 256, 128], [48, 184, 0], [104, 13, 183]],
        ],
        at: 0.5,
        double: Says::Nothing,
        single: Says::Right,
    },
    Class {
        name: "a face that is a sliver when it meets",
        face: true,
        motion: [
            [[-22, -8, -2], [0, 0, 0], [-23, 11, 24], [-12, -12, 5]],
            [[-2, 8, 18], [-24, 0, 16], [-19, -17, -8], [-24, 12, 17]],
        ],
        at: 0.5,
        double: Says::Right,
        single: Says::Nothing,
    },
    Class {
        name: "a face that is a sliver when it meets, in f64",
        face: true,
        motion: [
            [[677, 431, 148], [0, 0, 0], [188, 435, 179], [537, 1097, 652]],
            [[313, 979, 464], [636, 828, 648], [796, 975, 439], [453, 313, -40]],
        ],
        at: 0.5,
        double: Says::Nothing,
        single: Says::Right,
    },
    Class {
        name: "a face that only moves on",
        face: true,
        motion: [
            [[51, 153, 179], [0, 0, 0], [-78, 312, 492], [372, 306, 186]],
            [[251, 241, 227], [8, -224, -272], [-70, 88, 220], [380, 82, -86]],
        ],
        at: 0.5,
        double: Says::Right,
        single: Says::Nothing,
    },
    Class {
        name: "a tangent",
        face: false,
        motion: [
            [[-3, 93, 168], [0, 0, 0], [-114, -87, 18], [-17, 95, 168]],
            [[-147, -99, -24], [-192, 0, 144], [-66, 105, 162], [-133, -101, -24]],
        ],
        at: 0.5,
        double: Says::Right,
        single: Says::Nothing,
    },
];

fn says<S: Real>(answer: Option<S>, truth: f64) -> Says {
    match answer.map(S::wide) {
        None => Says::Nothing,
        Some(t) if t > truth + 1e-3 => Says::Late,
        Some(_) => Says::Right,
    }
}

/// Whether the features share a point at `t`, by the oracle: a point is a triangle, and so is a segment.
fn meet_at(m: &Motion, face: bool, t: f64) -> bool {
    // Small integers and halves: exact.
    let p = |i: usize| std::array::from_fn(|k| (1.0 - t) * m[0][i][k] as f64 + t * m[1][i][k] as f64);
    let [a, b]: [Triangle; 2] =
        if face { [[p(0); 3], [p(1), p(2), p(3)]] } else { [[p(0), p(1), p(1)], [p(2), p(3), p(3)]] };
    triangles_meet(&a, &b)
}

#[test]
fn known_failures() {
    for Class { name, face, motion, at, double, single } in &CLASSES {
        assert!(meet_at(motion, *face, *at), "{name}: no contact");
        assert!(!meet_at(motion, *face, at / 4.0), "{name}: always together");
        let found =
            [says(toi::<f64, f64>(motion, *face, 1.0), *at), says(toi::<f32, f32>(motion, *face, 1.0), *at)];
        assert_eq!(found, [*double, *single], "{name}, in f64 and f32: the text should say so");
    }
}

/// Far from the origin it is the rounding of the positions that loses contacts, not the solver: 2^20 away, f32 moves
/// a point by up to 1/16. Positions in f64 keep the contact, in both solvers.
#[test]
fn far_from_the_origin() {
    let far = 1048576.0;
    let at = |x: f64, y: f64, z: f64| Vec3([far + x, far + y, z]);
    let still = |p| Moving { t0: p, t1: p };
    let v = Moving { t0: at(0.19, 0.08, 1.0), t1: at(0.19, 0.08, -1.0) };
    let f = [still(at(0.0, 0.0, 0.0)), still(at(0.3, 0.0, 0.0)), still(at(0.0, 0.3, 0.0))];
    let round = |m: Moving<f64>| Moving { t0: m.t0.map(|x| x as f32), t1: m.t1.map(|x| x as f32) };
    assert_eq!(vf_toi::<f64, f64>(v, f), Some(0.5));
    assert_eq!(vf_toi::<f64, f32>(v, f), Some(0.5));
    assert_eq!(vf_toi::<f32, f32>(round(v), f.map(round)), None, "another question, rightly answered");
    assert_eq!(vf_toi::<f32, f64>(round(v), f.map(round)), None, "another question, rightly answered");
}

/// A false alarm: the points miss each other by less than the solver's tolerance.
#[test]
fn a_gap_below_the_tolerance() {
    let still = |x: f64, y: f64| Moving { t0: Vec3([x, y, 0.0]), t1: Vec3([x, y, 0.0]) };
    let f = [still(0.0, 0.0), still(1.0, 0.0), still(0.0, 1.0)];
    let falls = |gap: f64| Moving { t0: Vec3([0.25, -gap, 1.0]), t1: Vec3([0.25, -gap, -1.0]) };
    assert!(vf_toi::<f64, f64>(falls(1e-12), f).is_some() && vf_toi::<f64, f64>(falls(1e-10), f).is_none());
    assert!(vf_toi::<f64, f32>(falls(1e-6), f).is_some() && vf_toi::<f64, f32>(falls(1e-4), f).is_none());
}
