//! Polygons in integers, none touching itself.

use super::judge::{Flat, area};
use rand::{Rng, rngs::SmallRng};

/// Teeth of some length, upright.
pub fn comb(teeth: i64, length: i64) -> Vec<Flat> {
    let tooth = |k: i64| [[4 * k + 2, length], [4 * k + 1, 1], [4 * k - 1, 1]];
    let back = [[-1, 0], [4 * teeth - 1, 0], [4 * teeth - 1, 1]];
    back.into_iter().chain((0..teeth).rev().flat_map(tooth)).collect()
}

/// A pipeline that winds inward by right angles.
pub fn spiral(turns: i64) -> Vec<Flat> {
    let size = 4 * turns + 8;
    let corner = |k: i64, inset: i64| {
        let (low, high) = (inset + 4 * (k / 4), size - inset - 4 * (k / 4));
        match k % 4 {
            0 => [low - 4 * i64::from(k > 0), low],
            1 => [high, low],
            2 => [high, high],
            _ => [low, high],
        }
    };
    let outer: Vec<Flat> = (0..2 * turns).map(|k| corner(k, 0)).collect();
    let inner = (0..2 * turns).map(|k| {
        let p = corner(k, 1);
        if k == 0 { [0, 1] } else { p }
    });
    let mut inner: Vec<Flat> = inner.collect();
    inner.reverse();
    outer.into_iter().chain(inner).collect()
}

/// Shapes with names; every sum of areas is their own.
pub fn named() -> Vec<(&'static str, Vec<Flat>)> {
    let star = |k: i64| {
        let t = k as f64 * std::f64::consts::PI / 9.0;
        let r = if k % 2 == 0 { 1e3 } else { 2e2 };
        [(r * t.cos()) as i64, (r * t.sin()) as i64]
    };
    vec![
        ("dart", vec![[0, 0], [3, 0], [1, 1], [0, 3]]),
        ("l", vec![[0, 0], [4, 0], [4, 1], [1, 1], [1, 4], [0, 4]]),
        (
            "l with flat corners",
            vec![[0, 0], [2, 0], [4, 0], [4, 1], [2, 1], [1, 1], [1, 2], [1, 4], [0, 4], [0, 2]],
        ),
        ("u", vec![[0, 0], [9, 0], [9, 9], [8, 9], [8, 1], [1, 1], [1, 9], [0, 9]]),
        (
            "cross",
            vec![
                [1, 0],
                [2, 0],
                [2, 1],
                [3, 1],
                [3, 2],
                [2, 2],
                [2, 3],
                [1, 3],
                [1, 2],
                [0, 2],
                [0, 1],
                [1, 1],
            ],
        ),
        ("star", (0..18).map(star).collect()),
        ("comb", comb(6, 40)),
        ("spiral", spiral(7)),
    ]
}

/// A random polygon: corners in any order, and crossings undone until there is none. Without flat corners only by
/// chance: small grids have many.
pub fn simple(rng: &mut SmallRng, corners: usize, size: i64) -> Vec<Flat> {
    let size = size.max(corners as i64);
    loop {
        let mut flat: Vec<Flat> = Vec::new();
        while flat.len() < corners {
            let p = [rng.random_range(0..size), rng.random_range(0..size)];
            if !flat.contains(&p) {
                flat.push(p);
            }
        }
        for _ in 0..200 {
            match touching(&flat) {
                None if area(&flat) != 0 => return flat,
                None => break,
                Some((i, j)) => flat[i + 1..=j].reverse(),
            }
        }
    }
}

/// Two edges that share more than a corner that both end in.
fn touching(flat: &[Flat]) -> Option<(usize, usize)> {
    let n = flat.len();
    let pairs = (0..n).flat_map(|i| (i + 1..n).map(move |j| (i, j)));
    pairs.into_iter().find(|&(i, j)| {
        let [a, b, c, d] = [i, (i + 1) % n, j, (j + 1) % n].map(|k| flat[k]);
        let turn = |p: Flat, q: Flat, r: Flat| {
            ((q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])).signum()
        };
        let on = |p: Flat, q: Flat, r: Flat| {
            turn(p, q, r) == 0 && (0..2).all(|k| p[k].min(q[k]) <= r[k] && r[k] <= p[k].max(q[k]))
        };
        if j == i + 1 {
            return on(a, b, d) || on(c, d, a);
        }
        if i == 0 && j == n - 1 {
            return on(a, b, c) || on(c, d, b);
        }
        (turn(a, b, c) * turn(a, b, d) < 0 && turn(c, d, a) * turn(c, d, b) < 0)
            || on(a, b, c)
            || on(a, b, d)
            || on(c, d, a)
            || on(c, d, b)
    })
}
