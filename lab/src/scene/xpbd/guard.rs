//! Keeps a cloth free of intersections by nearmiss's own detection.
//!
//! A substep is proposed as a straight motion of every vertex. Features that meet on the way are
//! pushed apart. Features that still meet are held, and those that meet held ones are held next, in
//! growing zones. Held vertices stay at their start or, in a cloth that hangs from a body, move
//! rigidly with the body. If all vertices move so, features that are apart stay apart: straight
//! lines between the ends of the step are an affine map. The end is accepted only if the exact
//! discrete query finds no pair of triangles that meet; else nothing moves at all. The start had no
//! such pair. By induction no accepted state has one, even if the continuous solver missed
//! contacts.

use super::V;
use crate::OneQuery;
use nearmiss::contacts::{Contact, Kind};
use nearmiss::device::{Backend, Device};
use nearmiss::error::Error;
use nearmiss::mesh::{Body, Mesh, Positions, Topology};
use nearmiss::query::{Continuous, Discrete, Query};
use nearmiss::research::{ContinuousSolver, Precision, TriangleTest, WithSolver};
use nearmiss_kernels::math::Vec3;

/// Rounds that push meeting features apart.
const PUSHES: u32 = 4;
/// Rounds that hold features that still meet; after them all are held.
const HOLDS: u32 = 24;
/// Distance of features after a push, in mean edges.
const GAP: f64 = 0.02;

/// Outcome of a proposed step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Outcome {
    /// The step was taken, possibly changed.
    Moved,
    /// Nothing moved.
    Stopped,
}

pub(super) struct Guard {
    name: String,
    continuous: OneQuery,
    discrete: OneQuery,
    faces: Vec<[u32; 3]>,
    edges: Vec<[u32; 2]>,
    gap: f64,
}

/// The cubic: it lists no near misses, which would be pushed apart without need. [`meeting`] finds
/// the contacts that it misses.
fn passing() -> Query {
    Continuous::by(ContinuousSolver::Cubic(Precision::F64)).into()
}

/// All pairs that meet, including triangles with a common vertex.
fn meeting() -> Query {
    Query::from(Discrete::by(TriangleTest::Exact { adjacent: true }))
}

impl Guard {
    /// Makes a guard of a mesh at positions `x`, which it rounds to floats: the checked positions
    /// are the written ones.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] if triangles meet already; errors of detection.
    pub fn new(name: &str, x: &mut [V], faces: &[[u32; 3]]) -> Result<Guard, Error> {
        round(x);
        let edges = Topology::new(faces, x.len()).edges;
        let lengths = edges.iter().map(|e| {
            let d = x[e[0] as usize] - x[e[1] as usize];
            d.dot(d).sqrt()
        });
        let gap = GAP * lengths.sum::<f64>() / edges.len().max(1) as f64;
        let device = Device::open(Backend::Cpu, None)?;
        let still = frame(name, x, faces)?;
        let moving = Body::moving(still.clone(), still.clone())?;
        let mut guard = Guard {
            name: name.into(),
            continuous: OneQuery::new(device.clone(), vec![moving], passing())?,
            discrete: OneQuery::new(device, vec![Body::deformable(still)], meeting())?,
            faces: faces.to_vec(),
            edges,
            gap,
        };
        if !guard.is_free(x)? {
            return Err(Error::InvalidArgument {
                what: format!("{name}: triangles meet in the first frame, so contact cannot be kept"),
                advice: "use the scene without contact".into(),
            });
        }
        Ok(guard)
    }

    /// Changes the step from `before` to `x` so that it ends free of intersections and in floats,
    /// as `before` is. `held` has the ends of held vertices. `w` has inverse masses: a vertex of 0
    /// goes to its prescribed end, or nothing moves.
    ///
    /// # Errors
    /// Errors of detection.
    pub fn limit(&mut self, before: &[V], x: &mut [V], held: &[V], w: &[f64]) -> Result<Outcome, Error> {
        let mut is_held = vec![false; x.len()];
        for turn in 0..=PUSHES + HOLDS {
            if turn == PUSHES + HOLDS {
                hold(x, held, |v| w[v] > 0.0);
            }
            round(x);
            let contacts = self.contacts(before, x)?;
            if contacts.is_empty() && self.is_free(x)? {
                return Ok(Outcome::Moved);
            }
            for contact in &contacts {
                let (vertices, weights) = self.stencil(contact, before, x);
                if turn < PUSHES {
                    self.push(&vertices, &weights, contact.toi, before, x, w);
                } else {
                    vertices.iter().filter(|&&v| w[v] > 0.0).for_each(|&v| is_held[v] = true);
                }
            }
            if contacts.is_empty() {
                // The solver missed a contact: no zone is known, so all vertices are held.
                is_held.iter_mut().zip(w).for_each(|(is_held, &w)| *is_held = w > 0.0);
            }
            hold(x, held, |v| is_held[v]);
        }
        x.copy_from_slice(before);
        Ok(Outcome::Stopped)
    }

    fn contacts(&mut self, before: &[V], x: &[V]) -> Result<Vec<Contact>, Error> {
        let (t0, t1) = (frame(&self.name, before, &self.faces)?, frame(&self.name, x, &self.faces)?);
        self.continuous.move_to(0, Body::moving(t0, t1)?)?;
        Ok(self.continuous.detect()?.contacts().to_vec())
    }

    fn is_free(&mut self, x: &[V]) -> Result<bool, Error> {
        self.discrete.move_to(0, Body::deformable(frame(&self.name, x, &self.faces)?))?;
        Ok(self.discrete.detect()?.is_empty())
    }

    /// Returns the four vertices of a contact, and weights that give the difference of its two
    /// points when they meet. Weights are positive on the first feature, negative on the second.
    fn stencil(&self, contact: &Contact, before: &[V], x: &[V]) -> ([usize; 4], [f64; 4]) {
        let (a, b) = (contact.feature_a as usize, contact.feature_b as usize);
        let at = |v: usize| before[v] + (x[v] - before[v]) * contact.toi;
        if contact.kind == Kind::Ee {
            let v =
                [self.edges[a][0], self.edges[a][1], self.edges[b][0], self.edges[b][1]].map(|v| v as usize);
            let [p, q, r, s] = v.map(at);
            let (d, e, f) = (q - p, s - r, p - r);
            let (dd, de, ee) = (d.dot(d), d.dot(e), e.dot(e));
            let across = dd * ee - de * de;
            // Parallel edges: their midpoints suffice.
            let along = if across > 0.0 { (de * e.dot(f) - ee * d.dot(f)) / across } else { 0.5 };
            let along = along.clamp(0.0, 1.0);
            let other = if ee > 0.0 { ((e.dot(f) + along * de) / ee).clamp(0.0, 1.0) } else { 0.5 };
            (v, [1.0 - along, along, other - 1.0, -other])
        } else {
            let face = self.faces[b].map(|v| v as usize);
            let (p, [q, r, s]) = (at(a), face.map(at));
            let normal = (r - q).cross(s - q);
            let area = normal.dot(normal);
            let part = |u: V, v: V| if area > 0.0 { u.cross(v).dot(normal) / area } else { 1.0 / 3.0 };
            let (j, k) = (part(p - q, s - q).clamp(0.0, 1.0), part(r - q, p - q).clamp(0.0, 1.0));
            ([a, face[0], face[1], face[2]], [1.0, j + k - 1.0, -j, -k])
        }
    }

    /// Moves the ends of the step so that the two points have the gap between them, on their
    /// original sides.
    fn push(
        &self,
        vertices: &[usize; 4],
        weights: &[f64; 4],
        toi: f64,
        before: &[V],
        x: &mut [V],
        w: &[f64],
    ) {
        let sum = |at: &dyn Fn(usize) -> V| {
            let parts = vertices.iter().zip(weights).map(|(&v, &weight)| at(v) * weight);
            parts.fold(Vec3([0.0; 3]), |sum, part| sum + part)
        };
        // At the contact the difference of the points is zero; just before, it gives the direction.
        let start = sum(&|v| before[v]);
        let met = vertices.map(|v| before[v] + (x[v] - before[v]) * toi);
        let mut normal = if weights[1] > 0.0 || weights[0] != 1.0 {
            (met[1] - met[0]).cross(met[3] - met[2])
        } else {
            (met[2] - met[1]).cross(met[3] - met[1])
        };
        if normal.dot(normal) == 0.0 {
            normal = start;
        }
        if normal.dot(start) < 0.0 {
            normal = -normal;
        }
        let length = normal.dot(normal).sqrt();
        let mobile: f64 = vertices.iter().zip(weights).map(|(&v, weight)| w[v] * weight * weight).sum();
        if length == 0.0 || mobile == 0.0 {
            return;
        }
        let normal = normal * (1.0 / length);
        let missing = self.gap - normal.dot(sum(&|v| x[v]));
        if missing > 0.0 {
            for (&v, weight) in vertices.iter().zip(weights) {
                x[v] = x[v] + normal * (missing * w[v] * weight / mobile);
            }
        }
    }
}

/// Moves the vertices that `which` selects to their held ends.
fn hold(x: &mut [V], held: &[V], which: impl Fn(usize) -> bool) {
    x.iter_mut().zip(held).enumerate().filter(|(v, _)| which(*v)).for_each(|(_, (x, held))| *x = *held);
}

/// Rounds to floats.
fn round(x: &mut [V]) {
    x.iter_mut().for_each(|p| *p = p.map(|c| f64::from(c as f32)));
}

fn frame(name: &str, x: &[V], faces: &[[u32; 3]]) -> Result<Mesh, Error> {
    Mesh::new(name, Positions::F32(x.iter().map(|p| p.0.map(|c| c as f32)).collect()), faces.to_vec())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]

    use super::*;

    /// Returns a triangle at that height above another, which is much larger.
    fn above(height: f64) -> (Vec<V>, Vec<[u32; 3]>) {
        let low = [[-4.0, -4.0, 0.0], [4.0, -4.0, 0.0], [0.0, 6.0, 0.0]];
        let high = [[-1.0, 0.0, height], [1.0, 0.0, height], [0.0, 1.0, height + 0.5]];
        (low.into_iter().chain(high).map(Vec3).collect(), vec![[0, 1, 2], [3, 4, 5]])
    }

    #[test]
    fn a_triangle_that_falls_through_another_ends_above_it() {
        let (before, faces) = above(1.0);
        let mut guard = Guard::new("fall", &mut before.clone(), &faces).unwrap();
        let mut x = above(-1.0).0;
        let w = [0.0, 0.0, 0.0, 1.0, 1.0, 1.0];
        assert!(!guard.contacts(&before, &x).unwrap().is_empty());
        assert_eq!(guard.limit(&before, &mut x, &before, &w).unwrap(), Outcome::Moved);
        assert!(x[3..].iter().all(|p| p[2] > 0.0) && x[3] != before[3], "{x:?}");
        assert!(guard.contacts(&before, &x).unwrap().is_empty() && guard.is_free(&x).unwrap());
    }

    #[test]
    fn what_cannot_be_held_stops() {
        let (before, faces) = above(1.0);
        let mut guard = Guard::new("stop", &mut before.clone(), &faces).unwrap();
        let mut x = above(-1.0).0;
        assert_eq!(guard.limit(&before, &mut x, &before, &[0.0; 6]).unwrap(), Outcome::Stopped);
        assert_eq!(x, before);
    }

    #[test]
    fn triangles_that_meet_from_the_start_are_refused() {
        let (mut x, faces) = above(-0.25);
        let text = Guard::new("deep", &mut x, &faces).err().unwrap().to_string();
        assert!(text.contains("triangles meet in the first frame"), "{text}");
    }
}
