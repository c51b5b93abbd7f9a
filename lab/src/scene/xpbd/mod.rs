//! A small cloth solver on the CPU: extended position-based dynamics in small substeps.
//!
//! One thread, one order: the same bits everywhere. A cloth is made of lengths ([`links`]); rigid
//! bodies and a floor stop it ([`pose`]). If a scene enables it, [`guard`] keeps it free of
//! intersections. Time is counted in frames. Cost: about 10 ns a link and substep.

mod guard;
mod links;
mod pose;

pub(super) use links::Fabric;
pub(super) use pose::{Obstacles, Pose};

use super::known::strip_faces;
use guard::{Guard, Outcome};
use links::{Link, weave};
use nearmiss::Error;
use nearmiss_kernels::math::Vec3;

/// A point or a vector.
pub(super) type V = Vec3<f64>;

/// Substeps per frame.
const SUBSTEPS: u32 = 10;

/// Cloths and the rigid body that carries or stops them.
pub(super) struct World {
    x: Vec<V>,
    before: Vec<V>,
    velocity: Vec<V>,
    /// Inverse masses: 1, or 0 for a vertex that the body carries.
    w: Vec<f64>,
    /// Vertices that the body carries, with their positions in its frame.
    carried: Vec<(u32, V)>,
    /// Whether the body carries a part of a cloth.
    hung: bool,
    links: Vec<Link>,
    faces: Vec<[u32; 3]>,
    setting: Setting,
    time: f64,
    guard: Option<Guard>,
}

/// Parameters of a scene.
#[derive(Clone, Copy)]
pub(super) struct Setting {
    /// Pose of the body at a time, in frames.
    pub pose: fn(f64) -> Pose,
    pub obstacles: Obstacles,
    /// Speed gained per frame, downward.
    pub gravity: f64,
    /// Fraction of its speed that a vertex loses per frame.
    pub drag: f64,
}

impl World {
    pub fn new(setting: Setting) -> World {
        World {
            x: Vec::new(),
            before: Vec::new(),
            velocity: Vec::new(),
            w: Vec::new(),
            carried: Vec::new(),
            hung: false,
            links: Vec::new(),
            faces: Vec::new(),
            setting,
            time: 0.0,
            guard: None,
        }
    }

    /// Adds a cloth with its points in rows, at rest in the given positions, in the body's frame at
    /// time 0. The body carries the first row if it is `hung`.
    pub fn cloth(&mut self, rows: &[Vec<[f64; 3]>], closed: bool, hung: bool, fabric: Fabric) {
        self.hung |= hung;
        let pose = (self.setting.pose)(0.0);
        let mut ids: Vec<Vec<u32>> = Vec::with_capacity(rows.len());
        for (number, row) in rows.iter().enumerate() {
            ids.push(row.iter().map(|&p| self.vertex(Vec3(p), &pose, hung && number == 0)).collect());
        }
        self.links.extend(weave(&ids, closed, fabric, &self.x));
        if closed {
            ids.iter_mut().for_each(|row| row.extend(row.first().copied()));
        }
        ids.windows(2).for_each(|pair| self.faces.extend(strip_faces(&pair[0], &pair[1])));
    }

    /// Adds a rigid mesh that the body carries.
    pub fn carry(&mut self, points: impl Iterator<Item = [f64; 3]>, faces: &[[u32; 3]]) {
        let (pose, first) = ((self.setting.pose)(0.0), self.x.len() as u32);
        for p in points {
            self.vertex(Vec3(p), &pose, true);
        }
        self.faces.extend(faces.iter().map(|face| face.map(|i| i + first)));
    }

    fn vertex(&mut self, p: V, pose: &Pose, carried: bool) -> u32 {
        let index = self.x.len() as u32;
        if carried {
            self.carried.push((index, p));
        }
        self.x.push(pose.world(p));
        self.velocity.push(Vec3([0.0; 3]));
        self.w.push(if carried { 0.0 } else { 1.0 });
        index
    }

    pub fn faces(&self) -> &[[u32; 3]] {
        &self.faces
    }

    /// Returns the current positions, rounded once.
    pub fn positions(&self) -> Vec<[f32; 3]> {
        self.x.iter().map(|p| p.0.map(|x| x as f32)).collect()
    }

    /// From now on keeps every triangle from passing through another.
    ///
    /// # Errors
    /// As [`Guard::new`].
    pub fn keep_apart(&mut self, name: &str) -> Result<(), Error> {
        self.guard = Some(Guard::new(name, &mut self.x, &self.faces)?);
        Ok(())
    }

    /// Advances by one frame.
    ///
    /// # Errors
    /// Errors of the guard's detection.
    pub fn advance(&mut self) -> Result<(), Error> {
        let h = 1.0 / f64::from(SUBSTEPS);
        (0..SUBSTEPS).try_for_each(|_| self.step(h))
    }

    fn step(&mut self, h: f64) -> Result<(), Error> {
        let (from, to) = ((self.setting.pose)(self.time), (self.setting.pose)(self.time + h));
        self.before.clone_from(&self.x);
        let (pull, keep) = (self.setting.gravity * h, 1.0 - self.setting.drag * h);
        for ((x, v), &w) in self.x.iter_mut().zip(&mut self.velocity).zip(&self.w) {
            if w > 0.0 {
                *v = Vec3([v[0], v[1], v[2] - pull]) * keep;
                *x = *x + *v * h;
            }
        }
        for &(vertex, p) in &self.carried {
            self.x[vertex as usize] = to.world(p);
        }
        // Forward, then backward: a symmetric sweep damps. One direction alone, or each in turn,
        // feeds waves that run along it.
        let per_step = 1.0 / (h * h);
        let (x, w) = (&mut self.x, &self.w);
        self.links.iter().for_each(|link| link.pull(x, w, per_step));
        self.links.iter().rev().for_each(|link| link.pull(x, w, per_step));
        for ((x, &before), &w) in self.x.iter_mut().zip(&self.before).zip(&self.w) {
            if w > 0.0 {
                *x = self.setting.obstacles.push(*x, before, &from, &to);
            }
        }
        let mut stopped = false;
        if let Some(guard) = &mut self.guard {
            // A hanging cloth is held by moving it with the body.
            let with_body = |&p: &V| if self.hung { to.world(from.local(p)) } else { p };
            let held: Vec<V> = self.before.iter().map(with_body).collect();
            stopped = guard.limit(&self.before, &mut self.x, &held, &self.w)? == Outcome::Stopped;
        }
        // A stopped step did not take place: the body stays as well.
        self.time += if stopped { 0.0 } else { h };
        for ((v, &x), &before) in self.velocity.iter_mut().zip(&self.x).zip(&self.before) {
            *v = (x - before) * (1.0 / h);
        }
        Ok(())
    }
}
