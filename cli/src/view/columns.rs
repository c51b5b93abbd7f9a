//! The rows of an answer as arrays of numbers: the page reads them by the names of their columns.

use super::page::About;
use crate::rows::{pair_kind, status};
use nearmiss::contacts::{Contacts, Geometry, Kind, NearestTriangles, PairKind, Rows, Status};
use nearmiss::query::{Query, QueryKind};
use nearmiss::research::QueryExt;
use nearmiss::scene::BodyId;
use serde::Serialize;

/// The columns of all rows.
#[derive(Serialize)]
pub struct Columns {
    /// Whole numbers.
    words: Vec<&'static str>,
    /// Lengths, times, weights and coordinates.
    numbers: Vec<&'static str>,
    /// Those that the list shows.
    shown: Vec<&'static str>,
    /// The names behind the numbers of a column.
    #[serde(skip)]
    pub names: Names,
    /// Whether rows have the geometry of the contacts.
    #[serde(skip)]
    pub has_geometry: bool,
}

/// The names of kinds and of states, in the order of their numbers.
#[derive(Clone, Copy, Default, Serialize)]
pub struct Names {
    kind: &'static [&'static str],
    status: &'static [&'static str],
}

const BODIES: [&str; 2] = ["body_a", "body_b"];
const TRIANGLES: [&str; 2] = ["tri_a", "tri_b"];
const FEATURES: [&str; 3] = ["kind", "feature_a", "feature_b"];
const VERTICES: [&str; 4] = ["vertex_0", "vertex_1", "vertex_2", "vertex_3"];
const WEIGHTS: [&str; 4] = ["weight_0", "weight_1", "weight_2", "weight_3"];
const TIMES: [&str; 2] = ["toi", "toi_upper"];
const ENDS: [&str; 6] = ["x_0", "y_0", "z_0", "x_1", "y_1", "z_1"];
const POINTS: [&str; 6] = ["x_a", "y_a", "z_a", "x_b", "y_b", "z_b"];
const KINDS: [&str; 4] = [Kind::Vf.name(), Kind::Ee.name(), Kind::Ev.name(), Kind::Vv.name()];
const STATUS: [&str; 3] = [status(Status::Unverified), status(Status::Certified), status(Status::Undecided)];
const MEETINGS: [&str; 4] = [
    pair_kind(PairKind::Crossing),
    pair_kind(PairKind::Point),
    pair_kind(PairKind::Segment),
    pair_kind(PairKind::Overlap),
];

/// A row's arrays, in the order of the columns.
#[derive(Default)]
pub struct Arrays {
    pub words: Vec<u32>,
    pub numbers: Vec<f64>,
}

impl Columns {
    /// The columns of a query's rows. `body_a` and `body_b` come first.
    pub fn of(query: &Query, bodies: usize) -> Columns {
        let features = Names { kind: &KINDS, status: &STATUS };
        let meetings = Names { kind: &MEETINGS, ..Names::default() };
        // Pairs of a solver that can be wrong may have no common point.
        let is_exact = query.solver().is_certain();
        let (words, numbers, names): (Vec<&[&str]>, Vec<&[&str]>, Names) = match query.kind() {
            QueryKind::Discrete if is_exact => {
                (vec![&BODIES, &TRIANGLES, &FEATURES[..1]], vec![&ENDS], meetings)
            }
            QueryKind::Discrete => (vec![&BODIES, &TRIANGLES], vec![], Names::default()),
            QueryKind::Continuous => {
                (vec![&BODIES, &FEATURES, &["status"], &VERTICES], vec![&TIMES, &WEIGHTS], features)
            }
            QueryKind::Near => (vec![&BODIES, &FEATURES, &VERTICES], vec![&["distance"], &WEIGHTS], features),
            QueryKind::Distance | QueryKind::BodyDistances => {
                (vec![&BODIES, &TRIANGLES], vec![&["distance"], &POINTS], Names::default())
            }
            QueryKind::BodyPairs => (vec![&BODIES], vec![], Names::default()),
            // `args` refuses the earliest time, which has no rows.
            _ => (vec![], vec![], Names::default()),
        };
        let (words, numbers) = (words.concat(), numbers.concat());
        let is_place = |name: &&str| VERTICES.contains(name) || WEIGHTS.contains(name);
        let is_end = |name: &&str| ENDS.contains(name) || POINTS.contains(name);
        let is_shown =
            |name: &&str| !is_place(name) && !is_end(name) && (bodies > 1 || !BODIES.contains(name));
        let mut shown: Vec<&str> = words.iter().chain(&numbers).copied().filter(is_shown).collect();
        // As in a file of contacts.
        shown.sort_by_key(|name| *name == "status");
        let is_of_features = matches!(query.kind(), QueryKind::Continuous | QueryKind::Near);
        let has_geometry = is_of_features || (query.kind() == QueryKind::Discrete && is_exact);
        Columns { words, numbers, shown, names, has_geometry }
    }
}

impl About {
    /// The rows of an answer. `starts` has the first vertex of each body among those of all.
    pub fn rows(&self, found: &Contacts, geometry: &Geometry, starts: &[u32]) -> Arrays {
        let mut to = Arrays::default();
        let features = |to: &mut Arrays, at: usize, numbers: &[f64]| {
            let Some(own) = geometry.contacts().get(at) else { return };
            let vertex = |k: usize| starts[own.owner[k].index()] + own.vertices[k];
            to.words.extend([0, 1, 2, 3].map(vertex));
            to.numbers.extend(numbers.iter().chain(&own.weights));
        };
        match &found.rows {
            Rows::Pairs(all) => {
                for (at, pair) in all.iter().enumerate() {
                    to.words.extend(numbers(pair.bodies).into_iter().chain(pair.triangles));
                    if let Some(own) = geometry.pairs().get(at) {
                        to.words.push(own.kind as u32);
                        // Two triangles that share an area have no segment.
                        let ends = own.ends.map(|ends| ends.map(|point| self.near_origin(point)));
                        to.numbers.extend(ends.unwrap_or([[f64::NAN; 3]; 2]).as_flattened());
                    }
                }
            }
            Rows::Contacts(all) => {
                for (at, row) in all.iter().enumerate() {
                    to.words.extend(numbers(row.bodies));
                    to.words.extend([row.kind as u32, row.feature_a, row.feature_b, row.status as u32]);
                    features(&mut to, at, &[row.toi, row.toi_upper]);
                }
            }
            Rows::Near(all) => {
                for (at, row) in all.iter().enumerate() {
                    to.words.extend(numbers(row.bodies));
                    to.words.extend([row.kind as u32, row.feature_a, row.feature_b]);
                    let distance = geometry.contacts().get(at).map_or(f64::NAN, |own| own.distance);
                    features(&mut to, at, &[distance]);
                }
            }
            Rows::Distance(all) => all.iter().for_each(|row| self.nearest(&mut to, row)),
            Rows::BodyDistances(all) => all.iter().for_each(|row| self.nearest(&mut to, row)),
            Rows::BodyPairs(all) => all.iter().for_each(|row| to.words.extend(numbers(row.bodies))),
            Rows::Earliest(_) => {}
        }
        to
    }

    fn nearest(&self, to: &mut Arrays, row: &NearestTriangles) {
        to.words.extend(numbers(row.bodies).into_iter().chain(row.triangles));
        to.numbers.push(row.distance);
        to.numbers.extend(row.points.map(|point| self.near_origin(point)).as_flattened());
    }
}

fn numbers(bodies: [BodyId; 2]) -> [u32; 2] {
    bodies.map(|body| body.index() as u32)
}
