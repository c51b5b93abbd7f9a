//! Skirts over skirts, a hair apart, on a dancer who turns: a substitute for UNC's Flamenco.

use super::Rng;
use super::turn::{around, ring, wave};
use super::xpbd::{Fabric, Obstacles, Pose, Setting, World};

/// Frames after which the skirts swing.
pub(super) const OPENING: u64 = 30;

/// Number of skirts.
const LAYERS: u32 = 6;
/// Radius of the waist of the innermost skirt, and length of a skirt.
const WAIST: f64 = 0.3;
const LENGTH: f64 = 2.0;
/// Radius gained along a skirt.
const FLARE: f64 = 1.0;
/// Distance from one skirt to the next.
const HAIR: f64 = 0.01;
/// Number of ruffles around a skirt, and how far they stand out at the hem.
const RUFFLES: f64 = 14.0;
const STAND: f64 = 0.12;
/// Random shift of vertices, in cells; always less than half of [`HAIR`].
const SHAKE: f64 = 0.02;
const FABRIC: Fabric = Fabric { stretch: 0.0, shear: 0.01, bend: 0.1 };

/// Pose of the dancer, who turns to and fro, and sways.
fn pose(time: f64) -> Pose {
    Pose::new(0.35 * wave(time / 60.0), [0.2 * wave(time / 90.0), 0.1 * wave(time / 45.0), 0.0])
}

pub(super) fn world(triangles: usize, seed: u64) -> World {
    let skirt = around(triangles as f64 / f64::from(2 * LAYERS));
    let cell = LENGTH / f64::from(skirt[0]);

    let obstacles = Obstacles { ellipsoid: None, floor: None, friction: [0.0; 2] };
    let mut world = World::new(Setting { pose, obstacles, gravity: 0.002, drag: 0.03 });
    let mut rng = Rng::new(seed);
    let shake = (SHAKE * cell).min(0.2 * HAIR);
    for layer in 0..LAYERS {
        let waist = WAIST + HAIR * f64::from(layer);
        let points = ring(skirt, |down, turns| {
            let radius = waist + down * (FLARE + STAND * wave(RUFFLES * turns));
            ([radius, -LENGTH * down], rng.point(shake))
        });
        world.cloth(&points, true, true, FABRIC);
    }
    world
}
