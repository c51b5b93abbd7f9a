//! Contacts as rows of CSV and of JSON.

use nearmiss::contacts::{Answer, Contact, Kind, NearPair, NearestTriangles, Status, TrianglePair};
use nearmiss::scene::BodyId;
use serde::{Serialize, Serializer};
use std::io::Write;

/// What stands before each row, and how triangles are called.
#[derive(Clone, Copy)]
pub struct Columns<'a> {
    /// Of a sequence, which of its questions is answered.
    pub step: Option<usize>,
    /// Of a scene, the bodies' names.
    pub names: Option<&'a [String]>,
    /// Whether triangles are told as faces of the file.
    pub faces: bool,
}

impl Columns<'_> {
    /// The names of the columns.
    pub fn head(&self, csv: &mut csv::Writer<impl Write>, answer: &Answer) -> Result<(), String> {
        let triangles = if self.faces { ["face_a", "face_b"] } else { ["tri_a", "tri_b"] };
        let (own, bodies): (&[&str], bool) = match answer {
            Answer::Pairs(_) => (&triangles, true),
            Answer::Contacts(_) => (&["kind", "a", "b", "toi", "toi_hi", "status"], true),
            Answer::Earliest(_) => (&["earliest_toi"], false),
            Answer::Distance(_) => (&NEAREST, true),
            Answer::Near(_) => (&["kind", "a", "b", "squared_distance", "w0", "w1", "w2", "closest"], true),
        };
        let step = self.step.map(|_| "step");
        let bodies = self.names.filter(|_| bodies).map(|_| ["body_a", "body_b"]);
        let all = step.into_iter().chain(bodies.into_iter().flatten()).chain(own.iter().copied());
        csv.write_record(all).map_err(|e| e.to_string())
    }

    /// A row a contact. A number is printed as the shortest decimal that reads back to the same bits.
    pub fn rows(&self, csv: &mut csv::Writer<impl Write>, answer: &Answer) -> Result<(), String> {
        let wrote = match answer {
            Answer::Pairs(pairs) => pairs.iter().try_for_each(|pair| {
                self.row(csv, Some(pair.bodies), &pair.triangles.map(|triangle| triangle.to_string()))
            }),
            Answer::Contacts(all) => all.iter().try_for_each(|c| self.row(csv, Some(c.bodies), &contact(c))),
            // Of a sequence a step without a contact has its row too, and in it no time.
            Answer::Earliest(None) if self.step.is_some() => self.row(csv, None, &[String::new()]),
            Answer::Earliest(toi) => toi.iter().try_for_each(|toi| self.row(csv, None, &[toi.to_string()])),
            Answer::Near(pairs) => pairs.iter().try_for_each(|p| self.row(csv, Some(p.bodies), &near(p))),
            Answer::Distance(found) => {
                found.iter().try_for_each(|n| self.row(csv, Some(n.bodies), &nearest(n)))
            }
        };
        wrote.map_err(|e| e.to_string())
    }

    fn row(
        &self,
        csv: &mut csv::Writer<impl Write>,
        bodies: Option<[BodyId; 2]>,
        own: &[String],
    ) -> csv::Result<()> {
        if let Some(step) = self.step {
            csv.write_field(step.to_string())?;
        }
        if let (Some(names), Some(bodies)) = (self.names, bodies) {
            bodies.iter().try_for_each(|body| csv.write_field(&names[body.index()]))?;
        }
        csv.write_record(own)
    }
}

fn kind(kind: Kind) -> String {
    match kind {
        Kind::Vf => "vf".into(),
        Kind::Fv => "fv".into(),
        Kind::Ee => "ee".into(),
    }
}

fn near(pair: &NearPair) -> [String; 8] {
    let [a, b] = [pair.a, pair.b].map(|i| i.to_string());
    let [x, y, z] = pair.weights.map(|weight| weight.to_string());
    [kind(pair.kind), a, b, pair.squared_distance.to_string(), x, y, z, pair.closest.name().into()]
}

/// The columns of the nearest triangles.
const NEAREST: [&str; 9] = ["tri_a", "tri_b", "distance", "x_a", "y_a", "z_a", "x_b", "y_b", "z_b"];

fn nearest(n: &NearestTriangles) -> [String; 9] {
    let [a, b] = n.triangles.map(|i| i.to_string());
    let [[x, y, z], [u, v, w]] = n.points.map(|point| point.map(|x| x.to_string()));
    [a, b, n.distance.to_string(), x, y, z, u, v, w]
}

fn contact(c: &Contact) -> [String; 6] {
    let status = match c.status {
        Status::Contact => "contact",
        Status::Certified => "certified",
        Status::Unresolved => "unresolved",
    };
    let [a, b] = [c.a, c.b].map(|i| i.to_string());
    [kind(c.kind), a, b, c.toi.to_string(), c.toi_hi.to_string(), status.into()]
}

/// An answer as rows of JSON: of a scene its bodies by their names.
pub struct Rows<'a> {
    /// The answer.
    pub answer: &'a Answer,
    /// Of a scene, the bodies' names.
    pub names: Option<&'a [String]>,
}

/// A row whose bodies are told by their names.
#[derive(Serialize)]
struct Named<'a, T> {
    body_a: &'a str,
    body_b: &'a str,
    #[serde(flatten)]
    row: T,
}

#[derive(Serialize)]
struct Triangles {
    triangles: [u32; 2],
}

#[derive(Serialize)]
struct Meeting {
    kind: Kind,
    a: u32,
    b: u32,
    toi: f64,
    toi_hi: f64,
    status: Status,
}

#[derive(Serialize)]
struct Nearness {
    kind: Kind,
    a: u32,
    b: u32,
    squared_distance: f64,
    weights: [f64; 3],
    closest: nearmiss::contacts::Closest,
}

#[derive(Serialize)]
struct Nearest {
    triangles: [u32; 2],
    distance: f64,
    weights: [[f64; 3]; 2],
    points: [[f64; 3]; 2],
}

impl Serialize for Rows<'_> {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        let Some(names) = self.names else {
            return match self.answer {
                Answer::Pairs(pairs) => to.collect_seq(pairs.iter().map(|pair| pair.triangles)),
                Answer::Contacts(all) => all.serialize(to),
                Answer::Earliest(toi) => toi.serialize(to),
                Answer::Near(near) => near.serialize(to),
                Answer::Distance(nearest) => to.collect_seq(nearest),
            };
        };
        let [of_a, of_b] = [0, 1].map(|k| move |bodies: [BodyId; 2]| names[bodies[k].index()].as_str());
        match self.answer {
            Answer::Pairs(pairs) => {
                to.collect_seq(pairs.iter().map(|&TrianglePair { bodies, triangles }| Named {
                    body_a: of_a(bodies),
                    body_b: of_b(bodies),
                    row: Triangles { triangles },
                }))
            }
            Answer::Contacts(all) => to.collect_seq(all.iter().map(|c| {
                let &Contact { kind, bodies, a, b, toi, toi_hi, status } = c;
                let row = Meeting { kind, a, b, toi, toi_hi, status };
                Named { body_a: of_a(bodies), body_b: of_b(bodies), row }
            })),
            Answer::Earliest(toi) => toi.serialize(to),
            Answer::Distance(found) => to.collect_seq(found.iter().map(|nearest| {
                let &NearestTriangles { bodies, triangles, distance, weights, points } = nearest;
                let row = Nearest { triangles, distance, weights, points };
                Named { body_a: of_a(bodies), body_b: of_b(bodies), row }
            })),
            Answer::Near(near) => to.collect_seq(near.iter().map(|pair| {
                let &NearPair { kind, bodies, a, b, squared_distance, weights, closest } = pair;
                let row = Nearness { kind, a, b, squared_distance, weights, closest };
                Named { body_a: of_a(bodies), body_b: of_b(bodies), row }
            })),
        }
    }
}
