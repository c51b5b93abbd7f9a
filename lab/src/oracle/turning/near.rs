//! The point of a hull next to the origin, in doubles: only a direction to try.

type Point = [f64; 3];

fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
fn less(a: Point, b: Point) -> Point {
    [0, 1, 2].map(|k| a[k] - b[k])
}

fn plus(a: Point, k: f64, b: Point) -> Point {
    [0, 1, 2].map(|i| a[i] + k * b[i])
}
fn cross(a: Point, b: Point) -> Point {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The point next to the origin.
pub fn nearest(w: &[Option<Point>; 4]) -> Point {
    let weights = weights(w);
    let mut sum = [0.0; 3];
    for (w, k) in w.iter().zip(weights) {
        let w = w.unwrap_or([0.0; 3]);
        sum = [0, 1, 2].map(|i| sum[i] + k * w[i]);
    }
    sum
}

/// Its weights, each in [0, 1]; their sum is 1 up to rounding. The least of all pieces of the
/// border, and of the inside.
pub fn weights(w: &[Option<Point>; 4]) -> [f64; 4] {
    let corner = |k: usize| w[k].unwrap_or([0.0; 3]);
    let (border, side): (&[usize], _) = if w[3].is_none() { (&[0, 1, 2], 3) } else { (&[0, 1, 3, 2], 4) };
    let mut best = ([1.0, 0.0, 0.0, 0.0], f64::INFINITY);
    let mut consider = |k: [f64; 4]| {
        let x: Point = [0, 1, 2].map(|i| (0..4).map(|c| k[c] * corner(c)[i]).sum());
        if dot(x, x) < best.1 {
            best = (k, dot(x, x));
        }
    };
    for i in 0..side {
        let (a, b) = (border[i], border[(i + 1) % side]);
        let e = less(corner(b), corner(a));
        let t = (-dot(corner(a), e) / dot(e, e)).clamp(0.0, 1.0);
        let t = if t.is_nan() { 0.0 } else { t };
        let mut k = [0.0; 4];
        (k[a], k[b]) = (1.0 - t, t);
        consider(k);
    }
    // Inside: along both edges from the first corner.
    let (a, p, q) = (corner(0), less(corner(1), corner(0)), less(corner(2), corner(0)));
    let n = cross(p, q);
    let (u, v) = (dot(cross(q, a), n) / dot(n, n), dot(cross(a, p), n) / dot(n, n));
    if side == 3 && u >= 0.0 && v >= 0.0 && u + v <= 1.0 {
        consider([1.0 - u - v, u, v, 0.0]);
    }
    if side == 4 && u + v > f64::NEG_INFINITY {
        // Each is bettered in turn: a few digits that the first solution lacks.
        let mut u = u.clamp(0.0, 1.0);
        for _ in 0..4 {
            let better = |x: Point, e: Point| (-dot(x, e) / dot(e, e)).clamp(0.0, 1.0);
            let v = better(plus(a, u, p), q);
            u = better(plus(a, v, q), p);
            consider([(1.0 - u) * (1.0 - v), u * (1.0 - v), (1.0 - u) * v, u * v]);
        }
    }
    best.0
}
