//! A wide dress on a figure that turns and sways, its train on the floor: a substitute for UNC's
//! Princess.

use super::sphere::sphere;
use super::turn::{around, ring, wave};
use super::xpbd::{Fabric, Obstacles, Pose, Setting, World};
use super::{Rng, square_root};
use nearmiss_kernels::math::Vec3;

/// Frames after which the dress has gathered.
pub(super) const OPENING: u64 = 60;

/// The figure: an ellipsoid that stands on the floor, its radius across and along, and the height
/// of its centre.
const FIGURE: [f64; 2] = [0.45, 1.5];
const CENTRE: f64 = 1.6;
/// Height and radius of the neckline, from which the dress hangs.
const NECK: [f64; 2] = [2.6, 0.42];
/// Length of the dress along its side: more than the way to the floor.
const LENGTH: f64 = 3.0;
/// Radius gained down to the hem.
const FLARE: f64 = 1.7;
/// Number of folds around the dress, and how far they stand out at the hem.
const FOLDS: f64 = 18.0;
const STAND: f64 = 0.15;
/// Random shift of vertices, and the distance from the figure at which they stop, in cells.
const SHAKE: f64 = 0.03;
const MARGIN: f64 = 0.35;
const FABRIC: Fabric = Fabric { stretch: 0.0, shear: 0.01, bend: 0.5 };

fn pose(time: f64) -> Pose {
    Pose::new(0.25 * wave(time / 80.0), [0.3 * wave(time / 120.0), 0.2 * wave(time / 70.0), 0.0])
}

/// About a tenth of the triangles is in the figure.
pub(super) fn world(triangles: usize, seed: u64) -> World {
    let frequency = square_root(triangles as f64 / 80.0);
    let cells = triangles as f64 / 2.0 - 4.0 * f64::from(frequency) * f64::from(frequency);
    let dress = around(cells);
    let cell = LENGTH / f64::from(dress[0]);

    // At the neckline the dress must begin outside of the figure.
    let margin = (MARGIN * cell).min(0.05);
    let obstacles = Obstacles {
        ellipsoid: Some((Vec3([0.0, 0.0, CENTRE]), FIGURE.map(|radius| radius + margin))),
        floor: Some(margin),
        friction: [0.3; 2],
    };
    let mut world = World::new(Setting { pose, obstacles, gravity: 0.003, drag: 0.02 });
    let mut rng = Rng::new(seed);
    // A straight line down and out, so that length, drop and flare make a right triangle.
    let drop = (LENGTH * LENGTH - FLARE * FLARE).sqrt();
    let points = ring(dress, |down, turns| {
        let radius = NECK[1] + down * (FLARE + STAND * wave(FOLDS * turns));
        ([radius, NECK[0] - drop * down], rng.point(SHAKE * cell * down))
    });
    world.cloth(&points, true, true, FABRIC);
    let figure = sphere(frequency);
    let stretched =
        figure.points.iter().map(|p| [FIGURE[0] * p[0], FIGURE[0] * p[1], FIGURE[1] * p[2] + CENTRE]);
    world.carry(stretched, &figure.faces);
    world
}
