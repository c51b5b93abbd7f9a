//! Scenes of many bodies that continue forever: a pile of balls and a cloth over a floor, and many
//! small worlds in one place.

use super::sphere::{Sphere, sphere};
use super::{Rng, room};
use nearmiss::mesh::{Body, Mesh, Positions};
use nearmiss::scene::{BodyId, CollisionFilter, Motion, Pose, Scene};
use nearmiss::{Error, memory};

/// A scene, and the motion of its bodies.
#[derive(Clone, Debug)]
pub struct Bodies {
    /// The bodies, at the start of the first step.
    pub scene: Scene,
    balls: Vec<(BodyId, Ball)>,
    /// The cloth, its number of squares a side and half its width.
    cloth: Option<(BodyId, u32, f64)>,
}

/// Motion of a ball: it falls slowly, drifts and turns.
#[derive(Clone, Copy, Debug)]
struct Ball {
    start: [f64; 3],
    drift: [f64; 3],
    spin: [f64; 3],
}

/// End positions of a body in a step.
#[derive(Clone, Debug)]
pub enum Move {
    /// A rigid body's poses.
    Poses([Pose; 2]),
    /// A deformable body's positions.
    Step([Positions; 2]),
}

impl Move {
    /// Returns the motion as a detector takes it.
    pub fn input(&self) -> Motion<'_> {
        match self {
            Move::Poses(poses) => Motion::PoseStep((*poses).into()),
            Move::Step([t0, t1]) => Motion::step(t0, t1),
        }
    }
}

/// Period in steps: in its second half everything moves back, so that a scene stays together
/// forever.
const PERIOD: u32 = 64;

impl Ball {
    fn new(rng: &mut Rng, start: [f64; 3]) -> Ball {
        Ball { start, drift: rng.point(0.01), spin: rng.point(0.01) }
    }

    fn pose(&self, step: u32) -> Pose {
        let t = f64::from(there_and_back(step));
        let [x, y, z] = self.spin.map(|turn| turn * t);
        let length = (1.0 + x * x + y * y + z * z).sqrt();
        Pose {
            rotation: [x / length, y / length, z / length, 1.0 / length],
            translation: [0, 1, 2].map(|k| self.start[k] + self.drift[k] * t),
        }
    }
}

/// Returns 0, 1, up to half of the period, and down again.
fn there_and_back(step: u32) -> u32 {
    (step % PERIOD).min(PERIOD - step % PERIOD)
}

impl Bodies {
    /// Makes a pile of `balls` rigid balls of 128 triangles in layers on a fixed floor of `floor`
    /// squares a side. Neighbouring balls overlap by about a tenth. Above them a cloth of `cloth`
    /// squares a side, tested against itself too, sinks into them.
    ///
    /// # Errors
    /// If there are more than [`super::MAX_TRIANGLES`].
    pub fn pile(balls: usize, cloth: u32, floor: u32) -> Result<Bodies, Error> {
        let squares = u64::from(cloth).pow(2) + u64::from(floor).pow(2);
        room("pile", 2 * squares + 128 * balls as u64)?;
        let (mut scene, mut rng) = (Scene::new(), Rng::new(7));
        let side = (1..).find(|side: &usize| 5 * side * side >= balls).unwrap_or(1);
        let half = 0.95 * side as f64 / 2.0;
        let ball = sphere(4);
        let mut movers = Vec::new();
        for i in 0..balls {
            let cell = [i % side, i / side % side, i / side / side];
            let jitter = rng.point(0.03);
            let centre = [0, 1, 2].map(|k| 0.95 * (cell[k] as f64 + 0.5) + jitter[k]);
            let centre = [centre[0] - half, centre[1] - half, centre[2]];
            movers.push((scene.add(Body::rigid(round("ball", &ball, 0.5)?)), Ball::new(&mut rng, centre)));
        }
        let sheet = (cloth > 0).then(|| {
            let mesh = Mesh::new("cloth", waves(cloth, 1.2 * half, (0, 0.0)), squares_of(cloth))?;
            Ok::<_, Error>((
                scene.add(Body::deformable(mesh).with_filter(CollisionFilter::with_self_collision())),
                cloth,
                1.2 * half,
            ))
        });
        if floor > 0 {
            let flat = waves(floor, 2.0 * half, (0, LIFT - 0.1));
            scene.add(Body::fixed(Mesh::new("floor", flat, squares_of(floor))?));
        }
        Ok(Bodies { scene, balls: movers, cloth: sheet.transpose()? })
    }

    /// Makes `count` worlds that never meet, all in one place. Each is an environment with a floor
    /// of two fixed triangles. Above it, `balls` rigid balls of 128 triangles fill about half of a
    /// cube.
    ///
    /// # Errors
    /// If there are more than [`super::MAX_TRIANGLES`].
    pub fn worlds(count: u32, balls: u32) -> Result<Bodies, Error> {
        let triangles = u64::from(count) * (128 * u64::from(balls) + 2);
        room("worlds", triangles)?;
        memory::require("the worlds' bodies", triangles * 100)?;
        let mut scene = Scene::new();
        let ball = sphere(4);
        let half = 0.5 * super::cube_root_up(balls as usize) as f64;
        let mut movers = Vec::new();
        for world in 0..count {
            let mut rng = Rng::new(u64::from(world));
            let filter = CollisionFilter::in_environment(world);
            for _ in 0..balls {
                let mut centre = rng.point(half);
                centre[2] += half;
                let body = Body::rigid(round("ball", &ball, 0.5)?).with_filter(filter);
                movers.push((scene.add(body), Ball::new(&mut rng, centre)));
            }
            let floor = Mesh::new("floor", waves(1, 2.0 * half, (0, LIFT - 0.1)), squares_of(1))?;
            scene.add(Body::fixed(floor).with_filter(filter));
        }
        Ok(Bodies { scene, balls: movers, cloth: None })
    }

    /// Returns the end positions of all moving bodies in a step.
    pub fn step(&self, step: u32) -> Vec<(BodyId, Move)> {
        let balls = self
            .balls
            .iter()
            .map(|(id, ball)| (*id, Move::Poses([step, step + 1].map(|step| ball.pose(step)))));
        let cloth = self.cloth.map(|(id, side, half)| {
            (id, Move::Step([step, step + 1].map(|step| waves(side, half, (step, 0.0)))))
        });
        balls.chain(cloth).collect()
    }
}

/// Returns a ball as a mesh.
fn round(name: &str, ball: &Sphere, radius: f64) -> Result<Mesh, Error> {
    let points = ball.points.iter().map(|p| p.map(|x| (radius * x) as f32)).collect();
    Mesh::new(name, Positions::F32(points), ball.faces.clone())
}

/// Height of the cloth at the start: above five layers of balls.
const LIFT: f64 = 5.2;

/// Returns a square sheet of `side` squares a side, from `-half` to `half`. With many squares it
/// has folds that lean over. It is lower by `down`, and sinks a little at each step.
fn waves(side: u32, half: f64, (step, down): (u32, f64)) -> Positions {
    let sunk = down + 0.01 * f64::from(there_and_back(step));
    let at = |i: u32, j: u32| {
        let [u, v] = [i, j].map(|i| 2.0 * f64::from(i) / f64::from(side) - 1.0);
        // A fold every eight squares: up, over the next and down.
        let fold = f64::from(i % 8) / 4.0 - 1.0;
        let lean = if side > 8 { 6.0 * fold * (1.0 - fold * fold) * half / f64::from(side) } else { 0.0 };
        let rise = if side > 8 { (1.0 - fold * fold) * 6.0 * half / f64::from(side) } else { 0.0 };
        [u * half + lean, v * half, LIFT - 0.3 * (u * u + v * v) + rise - sunk].map(|x| x as f32)
    };
    Positions::F32((0..=side).flat_map(|j| (0..=side).map(move |i| at(i, j))).collect())
}

/// Returns the triangles of such a sheet.
fn squares_of(side: u32) -> Vec<[u32; 3]> {
    let square = |i: u32| {
        let low = i / side * (side + 1) + i % side;
        [[low, low + 1, low + side + 1], [low + 1, low + side + 2, low + side + 1]]
    };
    (0..side * side).flat_map(square).collect()
}
