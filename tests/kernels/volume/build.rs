//! Wild triangles, still and moving, and the volumes around them.

use nearmiss_kernels::bv::Volume;
use nearmiss_kernels::math::{Real, Vec3};
use nearmiss_lab::scene::Rng;

/// A triangle's corners at both ends of the step.
pub type Swept<R> = [[Vec3<R>; 3]; 2];

/// A place, a size and a kind of shape for the triangles of a case.
pub struct Wild {
    pub rng: Rng,
    size: f64,
    at: [f64; 3],
    kind: u64,
}

impl Wild {
    pub fn new(seed: u64) -> Wild {
        Wild { rng: Rng::new(seed), size: 1.0, at: [0.0; 3], kind: 0 }
    }

    /// Another place, size and kind. `largest` is the power of ten that sizes end at.
    pub fn turn(&mut self, largest: f64) {
        let rng = &mut self.rng;
        let pick = rng.bits();
        self.size = match pick % 4 {
            0 => 10f64.powf(rng.around(largest)),
            1 => 10f64.powf(rng.around(3.0)),
            _ => 1.0,
        };
        let far = [0.0, 0.0, 1.0, 1e3, 1e6, 1e7][(pick >> 8) as usize % 6];
        self.at = rng.point(far * self.size);
        self.kind = (pick >> 16) % 8;
    }

    /// A point, slivers and other degenerate shapes by kind.
    fn direction(&mut self) -> [f64; 3] {
        let rng = &mut self.rng;
        let [x, y, z] = rng.point(1.0);
        match self.kind {
            0 => [x, y * 1e-4, z * 1e-7],
            1 => [x, y, 0.0],
            2 => [x, x, x],
            3 => [x, x + 1e-6 * y, x + 1e-7 * z],
            4 => [x.round(), y.round(), z.round()],
            5 if rng.bits().is_multiple_of(3) => [0.0; 3],
            _ => [x, y, z],
        }
    }

    /// A triangle near the place; it moves a little, as far as it is large, or not at all.
    pub fn triangle<R: Real>(&mut self) -> Swept<R> {
        let spread = self.rng.unit() * 4.0;
        let centre = self.rng.point(spread);
        let step = [0.0, 1e-3, 1.0][(self.rng.bits() % 3) as usize];
        let corners = [(); 3].map(|()| {
            let (d, move_by) = (self.direction(), self.direction());
            let at = |t: f64| {
                Vec3(
                    [0, 1, 2]
                        .map(|k| R::of(self.at[k] + self.size * (centre[k] + d[k] + t * step * move_by[k]))),
                )
            };
            [at(0.0), at(1.0)]
        });
        [corners.map(|c| c[0]), corners.map(|c| c[1])]
    }
}

/// The leaf of a triangle: still if it does not move.
pub fn leaf<V: Volume, R: Real>([t0, t1]: Swept<R>) -> V {
    if t0 == t1 { V::still(t0) } else { V::moving(t0, t1) }
}

/// Merges pairwise until one is left: levels of a tree.
pub fn root<V: Volume>(mut level: Vec<V>) -> V {
    while level.len() > 1 {
        level = level.chunks(2).map(|two| two[0].merge(two.last().expect("one"))).collect();
    }
    level[0]
}
