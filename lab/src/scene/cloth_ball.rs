//! A square cloth falls onto a turning ball, slides, twists and folds: a substitute for UNC's cloth
//! on a ball.

use super::known::at_least_one;
use super::sphere::sphere;
use super::xpbd::{Fabric, Obstacles, Pose, Setting, World};
use super::{Rng, square_root};
use nearmiss_kernels::math::Vec3;

/// Frames after which the cloth is as folded as in UNC's frame 92.
pub(super) const OPENING: u64 = 72;

/// Half the cloth's width; the ball's radius is 1. UNC's cloth is as wide.
const HALF: f64 = 4.0;
/// Height of the ball's centre above the floor.
const CENTRE: f64 = 1.34;
/// Turns of the ball per frame.
const SPIN: f64 = 0.0085;
/// Random shift of vertices off the plane, in cells, so that no symmetry is exact.
const SHAKE: f64 = 0.05;
/// Distance from the ball at which vertices stop, in cells: triangles between them then stay
/// outside of the ball.
const MARGIN: f64 = 0.35;
const FABRIC: Fabric = Fabric { stretch: 0.0, shear: 0.1, bend: 200.0 };

fn pose(time: f64) -> Pose {
    Pose::new(SPIN * time, [0.0; 3])
}

/// One triangle in 120 is in the ball, as in UNC's.
pub(super) fn world(triangles: usize, seed: u64) -> World {
    let frequency = square_root(triangles as f64 / 960.0);
    let cells = triangles as f64 / 2.0 - 4.0 * f64::from(frequency) * f64::from(frequency);
    let columns = square_root(cells.max(1.0));
    let rows = at_least_one(cells / f64::from(columns));
    let cell = 2.0 * HALF / f64::from(columns);

    let top = CENTRE + 1.0 + (MARGIN + SHAKE) * cell;
    let obstacles = Obstacles {
        ellipsoid: Some((Vec3([0.0, 0.0, CENTRE]), [1.0 + MARGIN * cell; 2])),
        floor: Some(MARGIN * cell),
        // The ball carries the cloth along; the floor hardly holds it.
        friction: [5.0, 0.05],
    };
    let mut world = World::new(Setting { pose, obstacles, gravity: 0.003, drag: 0.02 });
    let mut rng = Rng::new(seed);
    let place = |i: u32, n: u32| HALF * (2.0 * f64::from(i) / f64::from(n) - 1.0);
    let points: Vec<Vec<[f64; 3]>> = (0..=rows)
        .map(|row| {
            let shaken = |column| {
                let [dx, dy, dz] = rng.point(SHAKE * cell);
                [place(column, columns) + dx, place(row, rows) + dy, top + dz]
            };
            (0..=columns).map(shaken).collect()
        })
        .collect();
    world.cloth(&points, false, false, FABRIC);
    let ball = sphere(frequency);
    world.carry(ball.points.iter().map(|p| [p[0], p[1], p[2] + CENTRE]), &ball.faces);
    world
}
