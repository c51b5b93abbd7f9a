//! Small scenes of the catalogue: bodies given by their numbers, with the required pairs, or the
//! required refusal.

mod moving;
mod refused;
mod reported;
mod still;

pub use refused::{Refused, refused};
pub use reported::{PATCH, PATCH_FACES, TRIANGLES};

use crate::oracle::{Triangle, triangles_meet, triangles_meet_beyond};
use nearmiss::contacts::{Contacts, Kind};
use nearmiss::error::Error;
use nearmiss::mesh::{Body, Mesh, Positions};
use nearmiss::query::{Discrete, Query};
use nearmiss::research::{TriangleTest, WithSolver};
use nearmiss::scene::CollisionFilter;

/// A body's numbers. Stored in f32 if that holds all of them, unless `wide`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Numbers {
    /// Positions of its vertices at t = 0.
    pub t0: Vec<[f64; 3]>,
    /// Positions at t = 1; empty if the body is still.
    pub t1: Vec<[f64; 3]>,
    /// Three vertices per triangle.
    pub faces: Vec<[u32; 3]>,
    /// Whether to store f64 for any numbers.
    pub wide: bool,
}

impl Numbers {
    /// Returns still triangles that share no vertex.
    pub fn loose(triangles: &[Triangle]) -> Numbers {
        let faces = (0..triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        Numbers { t0: triangles.as_flattened().to_vec(), faces, ..Numbers::default() }
    }

    /// Returns the same body, moved by `d` during the step.
    pub fn by(self, d: [f64; 3]) -> Numbers {
        let t1 = self.t0.iter().map(|p| [p[0] + d[0], p[1] + d[1], p[2] + d[2]]).collect();
        Numbers { t1, ..self }
    }

    /// Returns the body.
    ///
    /// # Errors
    /// [`Error::Input`] if a mesh is refused.
    pub fn body(&self) -> Result<Body, Error> {
        let mesh = |points: &[[f64; 3]]| {
            let narrow: Vec<[f32; 3]> = points.iter().map(|p| p.map(|x| x as f32)).collect();
            // NaN is a float too.
            let held = |(p, q): (&[f64; 3], &[f32; 3])| {
                p.iter().zip(q).all(|(x, y)| *x == f64::from(*y) || x.is_nan())
            };
            let fits = !self.wide && points.iter().zip(&narrow).all(held);
            let positions = if fits { Positions::F32(narrow) } else { Positions::F64(points.to_vec()) };
            Mesh::new("extreme", positions, self.faces.clone())
        };
        let t0 = mesh(&self.t0)?;
        if self.t1.is_empty() { Ok(Body::deformable(t0)) } else { Body::moving(t0, mesh(&self.t1)?) }
    }

    fn triangle(&self, face: usize) -> Triangle {
        self.faces[face].map(|v| self.t0[v as usize])
    }
}

/// A pair of features: their kind, their bodies and their indices.
pub type Pair = (Kind, [usize; 2], u32, u32);

/// The required answer.
#[derive(Clone, Debug, PartialEq)]
pub enum Finds {
    /// These triangle pairs and no others.
    Pairs(Vec<[u32; 2]>),
    /// The triangle pairs that the rational oracle finds.
    Oracle,
    /// The same, and the filter in floats decides every pair.
    OracleByFilter,
    /// These feature pairs with their first times, and no other certified ones.
    Contacts(Vec<(Kind, u32, u32, f64)>),
    /// At least these feature pairs, of these bodies, none before the time.
    Includes(Vec<Pair>, f64),
    /// For each of these vertices, a vertex/face contact with first time `.1`.
    EachVertex(Vec<u32>, f64),
    /// So many feature pairs, all from the start.
    AtOnce(usize),
}

/// A scene with its answer.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// Its id in `docs/internals/robustness.md`.
    pub id: &'static str,
    /// Description of its extreme.
    pub what: String,
    /// One body or two.
    pub bodies: Vec<Numbers>,
    /// Discrete: whether triangles that share a vertex count.
    pub adjacent: bool,
    /// The required answer.
    pub finds: Finds,
}

/// Returns all scenes.
pub fn scenes() -> Vec<Scene> {
    let mut all = still::scenes();
    all.extend(moving::scenes());
    all
}

/// Largest allowed earliness, as a fraction of the step.
const EARLY: f64 = 1e-3;

impl Scene {
    fn new(id: &'static str, what: &str, bodies: Vec<Numbers>, finds: Finds) -> Scene {
        Scene { id, what: what.into(), bodies, adjacent: false, finds }
    }

    /// Returns the query of the scene.
    pub fn query(&self) -> Query {
        let discrete = matches!(self.finds, Finds::Pairs(_) | Finds::Oracle | Finds::OracleByFilter);
        let adjacent = self.adjacent;
        if discrete { Discrete::by(TriangleTest::Exact { adjacent }).into() } else { Query::continuous() }
    }

    /// Returns the bodies: a single one is tested against itself, two only against each other.
    ///
    /// # Errors
    /// [`Error::Input`] if a mesh is refused.
    pub fn bodies(&self) -> Result<Vec<Body>, Error> {
        let filter = if self.bodies.len() > 1 {
            CollisionFilter::without_self_collision()
        } else {
            CollisionFilter::default()
        };
        self.bodies.iter().map(|numbers| Ok(numbers.body()?.with_filter(filter))).collect()
    }

    /// Returns the triangle pairs of a discrete scene, by the list or the oracle.
    pub fn pairs(&self) -> Vec<[u32; 2]> {
        if let Finds::Pairs(pairs) = &self.finds {
            return pairs.clone();
        }
        let (one, other) = (&self.bodies[0], &self.bodies[self.bodies.len() - 1]);
        let own = self.bodies.len() == 1;
        let mut pairs = Vec::new();
        for a in 0..one.faces.len() {
            for b in if own { a + 1 } else { 0 }..other.faces.len() {
                let (p, q) = (one.triangle(a), other.triangle(b));
                let shares = |v: &u32| own && other.faces[b].contains(v);
                let common: Vec<u32> = one.faces[a].into_iter().filter(|v| shares(v)).collect();
                let points: Vec<_> = common.iter().map(|v| one.t0[*v as usize]).collect();
                let meet = match points.len() {
                    0 => triangles_meet(&p, &q),
                    _ => self.adjacent && triangles_meet_beyond(&p, &q, &points),
                };
                if meet {
                    pairs.push([a as u32, b as u32]);
                }
            }
        }
        pairs
    }

    /// Returns the fault of an answer; `None` if it is right.
    pub fn judge(&self, found: &Contacts) -> Option<String> {
        match &self.finds {
            Finds::OracleByFilter if found.stats.uncertain_wide > 0 => {
                Some(format!("{} pairs needed exact signs", found.stats.uncertain_wide))
            }
            Finds::Pairs(_) | Finds::Oracle | Finds::OracleByFilter => {
                differ(&found.triangles(), &self.pairs())
            }
            Finds::Contacts(truth) => contacts(found, truth),
            Finds::Includes(truth, first) => includes(found, truth, *first),
            Finds::EachVertex(vertices, time) => vertices.iter().find_map(|v| {
                let mut own = found.contacts().iter().filter(|c| c.kind == Kind::Vf && c.feature_a == *v);
                let hit = own.any(|c| c.toi <= *time && *time <= c.toi_upper && c.toi >= time - EARLY);
                (!hit).then(|| format!("missed: vertex {v} falls through"))
            }),
            Finds::AtOnce(count) => {
                let late = found.contacts().iter().find(|c| c.toi != 0.0);
                late.map(|c| format!("late: {c:?}")).or_else(|| {
                    (found.len() != *count).then(|| format!("got {} contacts, expected {count}", found.len()))
                })
            }
        }
    }
}

/// Returns the first pair that is missed or invented.
fn differ(found: &[[u32; 2]], truth: &[[u32; 2]]) -> Option<String> {
    let missed = truth.iter().find(|pair| !found.contains(pair)).map(|pair| format!("missed: {pair:?}"));
    missed
        .or_else(|| found.iter().find(|pair| !truth.contains(pair)).map(|pair| format!("invented: {pair:?}")))
}

/// Checks that each contact has its time, and that no other is certified.
fn contacts(found: &Contacts, truth: &[(Kind, u32, u32, f64)]) -> Option<String> {
    let of = |kind, a, b| {
        found.contacts().iter().find(move |c| (c.kind, c.feature_a, c.feature_b) == (kind, a, b))
    };
    let wrong = truth.iter().find_map(|&(kind, a, b, t)| match of(kind, a, b) {
        None => Some(format!("missed: {kind:?} {a} {b} at {t}")),
        Some(c) if c.toi > t => Some(format!("late: got {c:?}, expected {t}")),
        Some(c) if c.toi_upper < t || c.toi < t - EARLY => {
            Some(format!("wrong time: got {c:?}, expected {t}"))
        }
        Some(_) => None,
    });
    let known =
        |c: &nearmiss::Contact| truth.iter().any(|k| (k.0, k.1, k.2) == (c.kind, c.feature_a, c.feature_b));
    wrong.or_else(|| found.contacts().iter().find(|c| !known(c)).map(|c| format!("invented: {c:?}")))
}

/// Checks that at least these pairs are found, none before the time.
fn includes(found: &Contacts, truth: &[Pair], first: f64) -> Option<String> {
    let row = |c: &nearmiss::Contact| (c.kind, c.bodies.map(|body| body.index()), c.feature_a, c.feature_b);
    let has = |k: &&Pair| found.contacts().iter().any(|c| row(c) == **k);
    let missed = truth.iter().find(|k| !has(k)).map(|k| format!("missed: {k:?}"));
    let earliest = found.earliest_toi();
    missed.or_else(|| match earliest {
        Some(t) if t > first => Some(format!("late: got {t}, expected {first}")),
        Some(t) if t < first - EARLY => Some(format!("too early: got {t}, expected {first}")),
        _ => None,
    })
}
