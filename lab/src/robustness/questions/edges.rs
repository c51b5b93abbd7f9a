//! Cases of two edges.

use super::Expect::{Apart, Meets, Sure};
use super::{EDGE, Question, Row, and, ee};

type Ends = [[f64; 3]; 2];

/// Edges along y at x, across the edge; along x; and in the opposite direction.
const fn across(x: f64, z: f64) -> Ends {
    [[x, -1.0, z], [x, 1.0, z]]
}
const fn along(x: f64, y: f64) -> Ends {
    [[x, y, 0.0], [x + 3.0, y, 0.0]]
}
const fn against(x: f64, y: f64) -> Ends {
    [[x + 3.0, y, 0.0], [x, y, 0.0]]
}
const fn point(y: f64, z: f64) -> Ends {
    [[1.0, y, z]; 2]
}

/// Motions against [`super::EDGE`] at rest.
const MOVES: [Row<Ends>; 17] = [
    ("X29", "plain", across(1.0, 3.0), across(1.0, -1.0), Sure(0.75)),
    ("X18", "plain, beyond the end", across(5.0, 3.0), across(5.0, -1.0), Apart),
    ("X17", "parallel", along(3.0, 2.0), along(3.0, -2.0), Meets(0.5)),
    ("X17", "parallel, ends that meet", along(4.0, 2.0), along(4.0, -2.0), Meets(0.5)),
    ("X18", "on one line, apart", along(5.0, 0.0), along(6.0, 0.0), Apart),
    ("X18", "parallel, passing beyond", along(5.0, 2.0), along(5.0, -2.0), Apart),
    ("X19", "sliding to an end", along(6.0, 0.0), along(2.0, 0.0), Meets(0.5)),
    ("X20", "the other way", against(6.0, 0.0), against(2.0, 0.0), Meets(0.5)),
    ("X20", "through each other", against(8.0, 0.0), against(-8.0, 0.0), Meets(0.25)),
    ("X22", "at rest, crossing", across(1.0, 0.0), across(1.0, 0.0), Meets(0.0)),
    ("X22", "at rest, apart", across(1.0, 1.0), across(1.0, 1.0), Apart),
    ("X22", "at rest, on each other", along(1.0, 0.0), along(1.0, 0.0), Meets(0.0)),
    ("X13", "a point", point(0.0, 3.0), point(0.0, -1.0), Meets(0.75)),
    ("X13", "a point, aside", point(1.0, 3.0), point(1.0, -1.0), Apart),
    ("X15", "coplanar, crossing in mid-step (dart#2700)", across(8.0, 0.0), across(-8.0, 0.0), Meets(0.25)),
    ("X15", "coplanar, ends that slide by (dart#3359)", across(-8.0, 0.0), across(8.0, 0.0), Meets(0.5)),
    ("X35", "a million lengths a step", across(1.0, 3e6), across(1.0, -1e6), Sure(0.75)),
];

/// Exponents k of the angle 10^-k of almost parallel edges.
const TILTS: std::ops::Range<i32> = 1..17;

pub fn questions() -> Vec<Question> {
    let mut all: Vec<Question> = MOVES
        .iter()
        .map(|&(id, what, from, to, expect)| ee((id, what), and(EDGE, from), and(EDGE, to), expect))
        .collect();
    let points = |z: f64| and([[1.0, 1.0, 0.0]; 2], [[1.0, 1.0, z]; 2]);
    all.extend([
        ee(("X13", "two points"), points(3.0), points(-1.0), Meets(0.75)),
        ee(("X13", "two points, apart"), points(3.0), points(1.0), Apart),
        ee(("X13", "two points, always together"), points(0.0), points(0.0), Sure(0.0)),
    ]);
    all.extend(TILTS.map(|k| {
        let tilt = 10f64.powi(-k);
        let at = |z: f64| and(EDGE, [[1.0, -tilt, z], [3.0, tilt, z]]);
        ee(("X21", "nearly parallel"), at(2.0), at(-2.0), Meets(0.5))
    }));
    // The answer does not depend on which edge moves, nor on a common motion.
    let raised = EDGE.map(|x| [x[0], x[1], 4.0]);
    let shifted = and(EDGE, across(1.0, -1.0)).map(|p| [p[0], p[1] + 1048576.0, p[2] + 1048576.0]);
    let from = and(EDGE, across(1.0, 3.0));
    all.extend([
        ee(("X24", "the other one moves"), from, and(raised, across(1.0, 3.0)), Sure(0.75)),
        ee(("X25", "moving a million together"), from, shifted, Sure(0.75)),
    ]);
    // In and out again: the first of two roots at (5 - sqrt(15)) / 10.
    let t0 = [[0.0, 0.0, 1.0], [0.0, 1.0, 1.0], [0.1, 0.2, 2.0], [0.1, 0.2, -1.0]];
    let t1 = [[1.0, 1.0, 0.0], [0.0, 0.0, 0.0], [0.1, 0.2, 2.0], [0.1, 0.2, -1.0]];
    all.push(ee(("X29", "in and out again"), t0, t1, Sure(0.11270166537925833)));
    all
}
