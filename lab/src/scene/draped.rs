//! A cloth draped on a ball, two frames of a step.
//!
//! Made by formula, not by simulation (that is `cloth-ball`). A square cloth rests on the top of a
//! ball. It hangs down beyond the equator, in pleats that fold over each other. In the step the
//! cloth sinks and turns a little, its pleats tighten, and the ball rises into it. With 92,230
//! triangles, 5,802 pairs meet at t0 and 10,504 at t1. A vertex moves by 2.2 mean edges.

use super::known::{at_least_one, strip};
use super::soup::add;
use super::sphere::sphere;
use super::turn::wave;
use super::{Builder, Rng, room, square_root};
use nearmiss::Error;
use nearmiss::mesh::Body;

/// Half the cloth's width. The ball has about radius 1, and its equator is 2 from the middle of the
/// cloth.
const HALF: f64 = 2.8;
/// Pleats in a quarter of the way around.
const PLEATS: f64 = 6.0;
/// Radius of the ball, below the cloth's 1.
const BALL: f64 = 0.97;
/// Random shift of vertices off the formula, in cells of the cloth, so that no symmetry is exact.
const SHAKE: f64 = 0.05;

/// Parameters that differ between the two frames.
struct Frame {
    /// Height of the cloth.
    lift: f64,
    /// How far pleats lean over their neighbours, and how far they stand out.
    lean: f64,
    stand: f64,
    /// Turn of the pleats, in pleats.
    turn: f64,
    /// Height of the ball.
    ball: f64,
}

const T0: Frame = Frame { lift: 0.0, lean: 0.11, stand: 0.08, turn: 0.0, ball: 0.0 };
const T1: Frame = Frame { lift: -0.02, lean: 0.125, stand: 0.075, turn: 0.1, ball: 0.025 };

/// Makes the scene with about `triangles` (within 2 % from 1,000 on), a tenth of them in the ball.
///
/// # Errors
/// If there are more than [`super::MAX_TRIANGLES`].
pub fn draped(triangles: usize) -> Result<Body, Error> {
    room("draped", triangles as u64)?;
    let frequency = square_root(triangles as f64 / 80.0);
    let cells = (triangles as f64 / 2.0 - 4.0 * f64::from(frequency) * f64::from(frequency)).max(1.0);
    let columns = square_root(cells);
    let rows = at_least_one(cells / f64::from(columns));

    let mut scene = Builder::default();
    let mut rng = Rng::new(92);
    let shake = SHAKE * 2.0 * HALF / f64::from(columns);
    let grid: Vec<Vec<u32>> = (0..=rows)
        .map(|row| {
            let v = HALF * (2.0 * f64::from(row) / f64::from(rows) - 1.0);
            let mut vertex = |column: u32| {
                let u = HALF * (2.0 * f64::from(column) / f64::from(columns) - 1.0);
                let off = rng.point(shake);
                scene.moving(add(lies(u, v, &T0), off), add(lies(u, v, &T1), off))
            };
            (0..=columns).map(&mut vertex).collect()
        })
        .collect();
    grid.windows(2).for_each(|pair| strip(&mut scene, &pair[0], &pair[1]));

    let ball = sphere(frequency);
    let first = scene.t0.len() as u32;
    for p in ball.points {
        let p = p.map(|x| BALL * x);
        scene.moving(add(p, [0.0, 0.0, T0.ball]), add(p, [0.0, 0.0, T1.ball]));
    }
    scene.faces.extend(ball.faces.iter().map(|face| face.map(|i| i + first)));
    scene.body("draped")
}

/// Returns the position of the point (u, v) of the cloth.
fn lies(u: f64, v: f64, frame: &Frame) -> [f64; 3] {
    let r = (u * u + v * v).sqrt();
    if r == 0.0 {
        return [0.0, 0.0, 1.0 + frame.lift];
    }
    let outward = [u / r, v / r];
    // On the ball by a stereographic map; below the equator straight down.
    let t = (0.5 * r).min(1.0);
    let square = 1.0 + t * t;
    let (radius, height) = (2.0 * t / square, (1.0 - t * t) / square - 0.5 * (r - 2.0).max(0.0));
    // A meander around the ball, from above the equator on. Per pleat it stands out once, and leans
    // to both sides twice.
    let pleat = PLEATS * quarter_turns(outward) + frame.turn;
    let depth = ((r - 1.2) / 1.2).clamp(0.0, 1.0);
    let stand = radius + depth * frame.stand * (1.0 + wave(pleat));
    let lean = -depth * frame.lean * wave(2.0 * pleat);
    [outward[0] * stand - outward[1] * lean, outward[1] * stand + outward[0] * lean, height + frame.lift]
}

/// Returns how far around a direction is, in [0, 4). It measures the way along a square instead of
/// the angle, so it needs no arc tangent.
fn quarter_turns(d: [f64; 2]) -> f64 {
    let part = d[1] / (d[0].abs() + d[1].abs());
    match (d[0] >= 0.0, d[1] >= 0.0) {
        (true, true) => part,
        (false, _) => 2.0 - part,
        (true, false) => 4.0 + part,
    }
}
