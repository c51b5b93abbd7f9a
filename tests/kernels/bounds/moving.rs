//! The box that moves: `bv::linear`.

use super::exact::Exact;
use super::hunt::{Hunt, held, plain};
use nearmiss_kernels::bv::{Linear, Volume};
use nearmiss_kernels::math::tolerance::{MOVING_MIXTURE, MOVING_TIME};

const FAR: f32 = 1e6;

/// Two boxes that bound a time on two axes: from when on the first, until when on the second; nothing else does.
fn boxes(x: &[f32; 8]) -> [Linear; 2] {
    let a = Linear {
        lo0: [x[0], x[4], -FAR],
        hi0: [FAR; 3],
        lo1: [x[1], x[5], -FAR],
        hi1: [FAR; 3],
        pad: [0; 2],
    };
    let b = Linear {
        lo0: [-FAR; 3],
        hi0: [x[2], x[6], FAR],
        lo1: [-FAR; 3],
        hi1: [x[3], x[7], FAR],
        pad: [0; 2],
    };
    [a, b]
}

/// When the line from `a` to `b` is zero; they are on either side.
fn crossing(a: Exact, b: Exact) -> f64 {
    a.over(&(&a - &b))
}

/// Measured: how much later the computed begin of an overlap is than the exact one, and how much earlier the computed end,
/// both together, of what decides, with the products that compare them.
#[test]
fn moving_time() {
    let ratio = |x: &[f64]| {
        let x: [f32; 8] = std::array::from_fn(|i| x[i] as f32);
        let [a, b] = boxes(&x);
        let window = a.window(&b);
        let d = |i: usize, j: usize| Exact::of(x[i]) - Exact::of(x[j]);
        let [p, q, r, s] = [d(2, 0), d(3, 1), d(6, 4), d(7, 5)];
        let zero = Exact::zero();
        if window.is_apart || p >= zero || q <= zero || r <= zero || s >= zero {
            return f64::NAN;
        }
        let ([from, of_from], [to, of_to]) = (window.from, window.to);
        let apart = f64::from(from * of_to) - f64::from(to * of_from);
        let computed = apart / (f64::from(of_from) * f64::from(of_to));
        let exact = crossing(p, q) - crossing(r, s);
        (computed - exact) / f64::from(MOVING_TIME)
    };
    held("MOVING_TIME", "f32", &Hunt { starts: 24, ..Hunt::new(41) }.most::<f32>(|r| plain(r, 8), ratio));
}

/// Measured: how much of the slack a bound at a time uses up.
#[test]
fn moving_mixture() {
    let ratio = |x: &[f64]| {
        let [start, end, time] = [0, 1, 2].map(|i| x[i] as f32);
        let time = time.abs();
        if !(time > 0.0 && time < 1.0) {
            return f64::NAN;
        }
        let moving = Linear { lo0: [-FAR; 3], hi0: [start; 3], lo1: [-FAR; 3], hi1: [end; 3], pad: [0; 2] };
        let [from, to, at] = [start, end, time].map(|x| Exact::of(f64::from(x)));
        let exact = from * (Exact::of(1.0) - at.clone()) + to * at;
        let slack = start.abs().max(end.abs()) * MOVING_MIXTURE;
        let left = Exact::of(f64::from(moving.until(time).hi1[0])) - exact;
        1.0 - left.over(&Exact::of(f64::from(slack)))
    };
    held("MOVING_MIXTURE", "f32", &Hunt { starts: 24, ..Hunt::new(43) }.most::<f32>(|r| plain(r, 3), ratio));
}
