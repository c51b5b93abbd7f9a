//! Hundreds of balls that bounce off each other, off five blocks and off the sides of a box: a
//! substitute for UNC's n-body.

use super::Rng;
use super::animation::Act;
use super::known::{at_least_one, strip_faces};
use super::sphere::{Sphere, sphere};
use nearmiss::Error;
use nearmiss_kernels::math::Vec3;

type V = Vec3<f64>;

/// Frames after which balls have met.
pub(super) const OPENING: u64 = 10;

/// Small and large radius.
const RADII: [f64; 2] = [0.22, 0.37];
/// Sides of the box for a full number of balls.
const BOX: [f64; 3] = [9.0, 9.0, 10.0];
const FULL: f64 = 300.0;
/// Place and size of the blocks in the box, as fractions of its sides: from, to.
const BLOCKS: [[[f64; 2]; 3]; 5] = [
    [[0.25, 0.70], [0.25, 0.70], [0.0, 0.3]],
    [[0.05, 0.35], [0.05, 0.35], [0.0, 0.6]],
    [[0.10, 0.25], [0.75, 0.90], [0.0, 0.3]],
    [[0.72, 0.92], [0.05, 0.25], [0.0, 0.7]],
    [[0.78, 0.88], [0.78, 0.88], [0.0, 0.5]],
];
/// Most cells along the edge of a block.
const CELLS: u32 = 6;
/// Speed of the largest ball per frame; lighter balls are faster, and a few much faster.
const SPEED: f64 = 0.2;
/// Fraction of its own speed that a ball regains in a frame after any loss.
const DRIVE: f64 = 0.5;
/// Fraction of the speed of approach that balls keep when they meet: little, so that many touch for
/// a while, as UNC's do.
const BOUNCE: f64 = 0.2;
/// Substeps per frame: few, so that a ball is well into another before they bounce, as in UNC's
/// scene.
const SUBSTEPS: u32 = 2;
/// Tries to place a ball in a free place; after them it may overlap another.
const TRIES: u32 = 64;

struct Ball {
    centre: V,
    velocity: V,
    radius: f64,
    /// Its own speed.
    speed: f64,
}

pub(super) struct NBody {
    balls: Vec<Ball>,
    blocks: Vec<[[f64; 2]; 3]>,
    sides: V,
    shape: Sphere,
    /// Points of the blocks, which rest.
    resting: Vec<[f64; 3]>,
    faces: Vec<[u32; 3]>,
    order: Vec<u32>,
}

impl NBody {
    /// Makes balls of 512 triangles, or less for few triangles, and blocks of up to 432.
    pub fn new(triangles: usize, seed: u64) -> NBody {
        let mut frequency = 8;
        while frequency > 1 && triangles < 60 * 8 * frequency * frequency {
            frequency /= 2;
        }
        let of_each = 8 * frequency * frequency;
        // At most a fiftieth of the triangles is in the blocks, if there are enough for them.
        let cells = ((triangles as f64 / 3000.0).sqrt().floor() as u32).clamp(1, CELLS);
        let left = triangles.saturating_sub(60 * (cells * cells) as usize);
        let count = at_least_one(left as f64 / of_each as f64) as usize;

        let mut rng = Rng::new(seed);
        let scale = cube_root(count as f64 / FULL);
        let sides = Vec3(BOX) * scale;
        let blocks: Vec<_> =
            BLOCKS.map(|block| [0, 1, 2].map(|axis| block[axis].map(|part| part * sides[axis]))).to_vec();
        let mut bodies = NBody {
            balls: Vec::with_capacity(count),
            blocks,
            sides,
            shape: sphere(frequency as u32),
            resting: Vec::new(),
            faces: Vec::new(),
            order: (0..count as u32).collect(),
        };
        bodies.place(count, &mut rng);
        bodies.draw(cells);
        bodies
    }

    /// Places balls at random, clear of each other and of the blocks if such a place is found soon.
    fn place(&mut self, count: usize, rng: &mut Rng) {
        for _ in 0..count {
            let radius = RADII[0] + (RADII[1] - RADII[0]) * rng.unit();
            let mut centre = Vec3([0.0; 3]);
            for _ in 0..TRIES {
                centre = Vec3([0, 1, 2].map(|k| radius + (self.sides[k] - 2.0 * radius) * rng.unit()));
                let clear = |other: &Ball| {
                    let (d, reach) = (other.centre - centre, other.radius + radius);
                    d.dot(d) > reach * reach
                };
                let outside =
                    |block: &[[f64; 2]; 3]| beyond(block, centre).is_some_and(|d| d.dot(d) > radius * radius);
                if self.blocks.iter().all(outside) && self.balls.iter().all(clear) {
                    break;
                }
            }
            let direction = Vec3(rng.point(1.0));
            let light = RADII[1] / radius;
            let speed = SPEED * light * light * light * (0.25 + 0.3 / (1.08 - rng.unit()));
            self.balls.push(Ball { centre, velocity: direction * speed, radius, speed });
        }
    }

    fn draw(&mut self, cells: u32) {
        let points = self.shape.points.len() as u32;
        for ball in 0..self.balls.len() as u32 {
            self.faces.extend(self.shape.faces.iter().map(|face| face.map(|i| i + ball * points)));
        }
        let first = self.balls.len() as u32 * points;
        for block in self.blocks.clone() {
            for axis in 0..3 {
                for side in 0..2 {
                    let mut rows = vec![Vec::new(); cells as usize + 1];
                    for (i, row) in rows.iter_mut().enumerate() {
                        for j in 0..=cells {
                            let part = |axis: usize, k: u32| {
                                let [from, to] = block[axis];
                                from + (to - from) * f64::from(k) / f64::from(cells)
                            };
                            let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
                            let mut p = [0.0; 3];
                            (p[axis], p[next], p[last]) =
                                (block[axis][side], part(next, i as u32), part(last, j));
                            row.push(first + self.resting.len() as u32);
                            self.resting.push(p);
                        }
                    }
                    rows.windows(2).for_each(|pair| self.faces.extend(strip_faces(&pair[0], &pair[1])));
                }
            }
        }
    }

    pub fn faces(&self) -> &[[u32; 3]] {
        &self.faces
    }

    fn step(&mut self, h: f64) {
        for ball in &mut self.balls {
            let speed = ball.velocity.dot(ball.velocity).sqrt();
            if speed > 0.0 {
                ball.velocity = ball.velocity * (1.0 + DRIVE * h * (ball.speed / speed - 1.0));
            }
            ball.centre = ball.centre + ball.velocity * h;
            for k in 0..3 {
                let (low, high) = (ball.radius, self.sides[k] - ball.radius);
                if ball.centre.0[k] < low || ball.centre.0[k] > high {
                    let inward = if ball.centre.0[k] < low { 1.0 } else { -1.0 };
                    ball.velocity.0[k] = inward * ball.velocity.0[k].abs();
                }
            }
            for block in &self.blocks {
                let Some(out) = beyond(block, ball.centre) else { continue };
                let square = out.dot(out);
                let against = ball.velocity.dot(out);
                if square > 0.0 && square < ball.radius * ball.radius && against < 0.0 {
                    ball.velocity = ball.velocity - out * (2.0 * against / square);
                }
            }
        }
        self.meet();
    }

    /// Collides balls that overlap and approach: they exchange momentum and lose most of their
    /// approach. A sweep along x finds them.
    fn meet(&mut self) {
        let balls = &mut self.balls;
        let low = |ball: &Ball| ball.centre[0] - ball.radius;
        self.order
            .sort_by(|&a, &b| low(&balls[a as usize]).total_cmp(&low(&balls[b as usize])).then(a.cmp(&b)));
        for (at, &a) in self.order.iter().enumerate() {
            let a = a as usize;
            for &b in &self.order[at + 1..] {
                let b = b as usize;
                if low(&balls[b]) > balls[a].centre[0] + balls[a].radius {
                    break;
                }
                let (d, touch) = (balls[b].centre - balls[a].centre, balls[a].radius + balls[b].radius);
                let square = d.dot(d);
                let approach = (balls[b].velocity - balls[a].velocity).dot(d);
                if square == 0.0 || square > touch * touch || approach >= 0.0 {
                    continue;
                }
                let mass = |ball: &Ball| ball.radius * ball.radius * ball.radius;
                let (ma, mb) = (mass(&balls[a]), mass(&balls[b]));
                let push = d * ((1.0 + BOUNCE) * approach / (square * (ma + mb)));
                balls[a].velocity = balls[a].velocity + push * mb;
                balls[b].velocity = balls[b].velocity - push * ma;
            }
        }
    }
}

impl Act for NBody {
    fn positions(&self) -> Vec<[f32; 3]> {
        let place = |ball: &Ball| {
            let (centre, radius) = (ball.centre, ball.radius);
            self.shape.points.iter().map(move |&p| centre + Vec3(p) * radius)
        };
        let balls = self.balls.iter().flat_map(place);
        balls.chain(self.resting.iter().copied().map(Vec3)).map(|p| p.0.map(|x| x as f32)).collect()
    }

    fn advance(&mut self) -> Result<(), Error> {
        for _ in 0..SUBSTEPS {
            self.step(1.0 / f64::from(SUBSTEPS));
        }
        Ok(())
    }
}

/// Returns the vector from the nearest point of a block to `p`; `None` if `p` is in the block.
fn beyond(block: &[[f64; 2]; 3], p: V) -> Option<V> {
    let out = Vec3([0, 1, 2].map(|k| p[k] - p[k].clamp(block[k][0], block[k][1])));
    (out.dot(out) > 0.0).then_some(out)
}

/// Returns the cube root by Newton's method: the same on every machine, unlike the library's.
fn cube_root(x: f64) -> f64 {
    (0..64).fold(x.max(1.0), |root, _| (2.0 * root + x / (root * root)) / 3.0)
}
