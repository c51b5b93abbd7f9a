//! Contacts as rows of CSV and of JSON.
//!
//! | answer | columns |
//! | --- | --- |
//! | triangle pairs | `tri_a`, `tri_b`, or `face_a`, `face_b`; with --geometry `kind`, `x_0` to `z_1`, `error` |
//! | contacts | `kind`, `feature_a`, `feature_b`, `toi`, `toi_upper`, `status` |
//! | near pairs | `kind`, `feature_a`, `feature_b`, `squared_distance`, `weight_0` to `weight_3`, `closest` |
//! | the nearest triangles | `tri_a`, `tri_b`, `distance`, and the points `x_a` to `z_b` |
//! | pairs of bodies | `body_a`, `body_b` alone |
//! | distances of bodies | as the nearest triangles |
//! | the first time | `earliest_toi` |
//!
//! Before these are `step`, `frame` and `file` of a sequence, `reason` with --keep-going, and `body_a`,
//! `body_b` if there are several bodies.

use crate::sequence::Moment;
use nearmiss::contacts::{
    Contact, ContactGeometry, Geometry, NearPair, NearestTriangles, PairGeometry, PairKind, Part, Rows,
    Status, TrianglePair,
};
use nearmiss::scene::BodyId;
use serde::{Serialize, Serializer};
use std::io::Write;

/// The columns of each row.
#[derive(Clone, Copy)]
pub struct Columns<'a> {
    /// The step of a sequence.
    pub moment: Option<&'a Moment>,
    /// Whether there is a column for the reason why a step is not tested.
    pub has_reason: bool,
    /// The names of several bodies.
    pub names: Option<&'a [String]>,
    /// Whether rows name faces of the file instead of triangles.
    pub faces: bool,
    /// The places of contacts, in columns after the others.
    pub geometry: Option<&'a Geometry>,
}

impl Columns<'_> {
    /// Writes the names of the columns; returns their number.
    pub fn head(&self, csv: &mut csv::Writer<impl Write>, answer: &Rows) -> Result<usize, String> {
        let triangles = if self.faces { ["face_a", "face_b"] } else { ["tri_a", "tri_b"] };
        let (own, bodies): (&[&str], bool) = match answer {
            Rows::Pairs(_) => (&triangles, true),
            Rows::Contacts(_) => (&CONTACT, true),
            Rows::Earliest(_) => (&["earliest_toi"], false),
            Rows::Distance(_) | Rows::BodyDistances(_) => (&NEAREST, true),
            Rows::BodyPairs(_) => (&[], true),
            // The weights are then those of the geometry.
            Rows::Near(_) if self.geometry.is_some() => (&NEAR_AND_GEOMETRY, true),
            Rows::Near(_) => (&NEAR, true),
        };
        let bodies = (bodies && self.names.is_some()).then_some(["body_a", "body_b"]);
        let all = self.before("").map(|(name, _)| name);
        let all = all.chain(bodies.into_iter().flatten()).chain(own.iter().copied());
        let places: &[&str] = match (self.geometry, answer) {
            (None, _) => &[],
            (Some(_), Rows::Pairs(_)) => &PAIR_GEOMETRY,
            (Some(_), _) => &GEOMETRY,
        };
        let all: Vec<&str> = all.chain(places.iter().copied()).collect();
        csv.write_record(&all).map_err(|e| e.to_string())?;
        Ok(all.len())
    }

    /// The columns of the step, with their names.
    fn before(&self, reason: &str) -> impl Iterator<Item = (&'static str, String)> {
        let step = self.moment.map(|moment| ("step", moment.step.to_string()));
        let frame = self.moment.and_then(|moment| moment.frame).map(|frame| ("frame", frame.to_string()));
        let file = self.moment.and_then(|moment| moment.file.clone()).map(|file| ("file", file));
        let reason = self.has_reason.then(|| ("reason", reason.to_owned()));
        step.into_iter().chain(frame).chain(file).chain(reason)
    }

    /// A row of a step that is not tested, for a file with so many columns.
    pub fn untested(
        &self,
        csv: &mut csv::Writer<impl Write>,
        reason: &str,
        columns: usize,
    ) -> Result<(), String> {
        let mut row: Vec<String> = self.before(reason).map(|(_, field)| field).collect();
        row.resize(columns, String::new());
        csv.write_record(row).map_err(|e| e.to_string())
    }

    /// A row a contact. A number is printed as the shortest decimal that reads back to the same bits.
    pub fn rows(&self, csv: &mut csv::Writer<impl Write>, answer: &Rows) -> Result<(), String> {
        let wrote = match answer {
            Rows::Pairs(pairs) => pairs.iter().enumerate().try_for_each(|(at, pair)| {
                let own = pair.triangles.map(|triangle| triangle.to_string());
                self.row(csv, Some(pair.bodies), &self.with(at, &own))
            }),
            Rows::Contacts(all) => all
                .iter()
                .enumerate()
                .try_for_each(|(at, c)| self.row(csv, Some(c.bodies), &self.with(at, &contact(c)))),
            // A step without a contact has a row without a time.
            Rows::Earliest(None) if self.moment.is_some() => self.row(csv, None, &[String::new()]),
            Rows::Earliest(toi) => toi.iter().try_for_each(|toi| self.row(csv, None, &[toi.to_string()])),
            Rows::Near(pairs) => pairs.iter().enumerate().try_for_each(|(at, p)| {
                self.row(csv, Some(p.bodies), &self.with(at, &near(p, self.geometry.is_none())))
            }),
            Rows::Distance(found) => {
                found.iter().try_for_each(|n| self.row(csv, Some(n.bodies), &nearest(n)))
            }
            Rows::BodyDistances(all) => {
                all.iter().try_for_each(|n| self.row(csv, Some(n.bodies), &nearest(n)))
            }
            Rows::BodyPairs(pairs) => pairs.iter().try_for_each(|pair| self.row(csv, Some(pair.bodies), &[])),
        };
        wrote.map_err(|e| e.to_string())
    }

    /// A row, and the place of its contact.
    fn with(&self, at: usize, own: &[String]) -> Vec<String> {
        let mut all = own.to_vec();
        match self.geometry {
            Some(Geometry::Contacts(contacts)) => all.extend(contacts.get(at).into_iter().flat_map(place)),
            Some(Geometry::Pairs(pairs)) => all.extend(pairs.get(at).into_iter().flat_map(pair_place)),
            None => {}
        }
        all
    }

    fn row(
        &self,
        csv: &mut csv::Writer<impl Write>,
        bodies: Option<[BodyId; 2]>,
        own: &[String],
    ) -> csv::Result<()> {
        self.before("").try_for_each(|(_, field)| csv.write_field(field))?;
        if let (Some(names), Some(bodies)) = (self.names, bodies) {
            bodies.iter().try_for_each(|body| csv.write_field(&names[body.index()]))?;
        }
        csv.write_record(own)
    }
}

const CONTACT: [&str; 6] = ["kind", "feature_a", "feature_b", "toi", "toi_upper", "status"];
const NEAR: [&str; 9] = [
    "kind",
    "feature_a",
    "feature_b",
    "squared_distance",
    "weight_0",
    "weight_1",
    "weight_2",
    "weight_3",
    "closest",
];
const NEAR_AND_GEOMETRY: [&str; 5] = ["kind", "feature_a", "feature_b", "squared_distance", "closest"];
const NEAREST: [&str; 9] = ["tri_a", "tri_b", "distance", "x_a", "y_a", "z_a", "x_b", "y_b", "z_b"];

/// The place of a contact. Vertex `i` is one of the body `owner_i`.
const GEOMETRY: [&str; 22] = [
    "owner_0", "owner_1", "owner_2", "owner_3", "vertex_0", "vertex_1", "vertex_2", "vertex_3", "weight_0",
    "weight_1", "weight_2", "weight_3", "x_a", "y_a", "z_a", "x_b", "y_b", "z_b", "distance", "normal_x",
    "normal_y", "normal_z",
];

/// How two triangles meet, and the ends of their common segment; these are empty for an overlap.
const PAIR_GEOMETRY: [&str; 8] = ["kind", "x_0", "y_0", "z_0", "x_1", "y_1", "z_1", "error"];

fn pair_place(g: &PairGeometry) -> [String; 8] {
    let end = |end: usize, k: usize| g.ends.map_or(String::new(), |ends| ends[end][k].to_string());
    let [x, y, z] = [0, 1, 2].map(|k| end(0, k));
    let [u, v, w] = [0, 1, 2].map(|k| end(1, k));
    let error = g.ends.map_or(String::new(), |_| g.error.to_string());
    [pair_kind(g.kind).into(), x, y, z, u, v, w, error]
}

/// The name of a way to meet.
pub const fn pair_kind(kind: PairKind) -> &'static str {
    match kind {
        PairKind::Crossing => "crossing",
        PairKind::Point => "point",
        PairKind::Segment => "segment",
        PairKind::Overlap => "overlap",
    }
}

fn place(g: &ContactGeometry) -> impl Iterator<Item = String> + use<> {
    let numbers = g.weights.into_iter().chain(g.points.into_iter().flatten());
    let numbers = numbers.chain([g.distance]).chain(g.normal).map(|x| x.to_string());
    let owners = g.owner.map(|body| body.index().to_string());
    owners.into_iter().chain(g.vertices.map(|vertex| vertex.to_string())).chain(numbers)
}

/// The name of a certainty.
pub const fn status(status: Status) -> &'static str {
    match status {
        Status::Unverified => "unverified",
        Status::Certified => "certified",
        Status::Undecided => "undecided",
    }
}

fn near(pair: &NearPair, weighted: bool) -> Vec<String> {
    let own = [pair.kind.name().into(), pair.feature_a.to_string(), pair.feature_b.to_string()];
    let weights = weighted.then(|| pair.weights().map(|weight| weight.to_string()));
    let weights = weights.into_iter().flatten();
    let distance = [pair.squared_distance.to_string()];
    own.into_iter().chain(distance).chain(weights).chain([pair.closest.name().into()]).collect()
}

fn nearest(n: &NearestTriangles) -> [String; 9] {
    let [a, b] = n.triangles.map(|i| i.to_string());
    let [[x, y, z], [u, v, w]] = n.points.map(|point| point.map(|x| x.to_string()));
    [a, b, n.distance.to_string(), x, y, z, u, v, w]
}

fn contact(c: &Contact) -> [String; 6] {
    let [a, b] = [c.feature_a, c.feature_b].map(|i| i.to_string());
    [c.kind.name().into(), a, b, c.toi.to_string(), c.toi_upper.to_string(), status(c.status).into()]
}

/// The names of bodies that have none in a file: their numbers, if there are several.
pub fn numbered(bodies: usize) -> Option<Vec<String>> {
    (bodies > 1).then(|| (0..bodies).map(|body| body.to_string()).collect())
}

/// An answer as rows of JSON.
pub struct JsonRows<'a> {
    /// The answer.
    pub answer: &'a Rows,
    /// The names of several bodies.
    pub names: Option<&'a [String]>,
    /// The place of each contact: `geometry` of its row.
    pub geometry: Option<&'a Geometry>,
}

/// A row, the names of its bodies, and its place.
#[derive(Serialize)]
struct Placed<'a, T> {
    #[serde(skip_serializing_if = "Option::is_none")]
    body_a: Option<&'a str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    body_b: Option<&'a str>,
    #[serde(flatten)]
    row: T,
    #[serde(skip_serializing_if = "Option::is_none")]
    geometry: Option<Place<'a>>,
}

#[derive(Serialize)]
#[serde(untagged)]
enum Place<'a> {
    Contact(ContactPlace<'a>),
    Pair(PairPlace),
}

#[derive(Serialize)]
struct PairPlace {
    kind: PairKind,
    ends: Option<[[f64; 3]; 2]>,
    error: f64,
    parts: Option<[[u8; 2]; 2]>,
}

#[derive(Serialize)]
struct ContactPlace<'a> {
    owner: [usize; 4],
    vertices: &'a [u32; 4],
    weights: &'a [f64; 4],
    points: &'a [[f64; 3]; 2],
    distance: f64,
    normal: &'a [f64; 3],
}

/// A row that is its bodies.
#[derive(Serialize)]
struct Nothing {}

#[derive(Serialize)]
struct Triangles {
    triangles: [u32; 2],
}

#[derive(Serialize)]
struct Meeting {
    kind: &'static str,
    feature_a: u32,
    feature_b: u32,
    toi: f64,
    toi_upper: f64,
    status: &'static str,
}

#[derive(Serialize)]
struct Nearness {
    kind: &'static str,
    feature_a: u32,
    feature_b: u32,
    squared_distance: f64,
    weights: [f64; 4],
    closest: nearmiss::contacts::Closest,
}

#[derive(Serialize)]
struct Nearest {
    triangles: [u32; 2],
    distance: f64,
    weights: [[f64; 3]; 2],
    points: [[f64; 3]; 2],
}

impl Serialize for JsonRows<'_> {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        match self.answer {
            Rows::Pairs(pairs) => {
                to.collect_seq(pairs.iter().enumerate().map(|(at, &TrianglePair { bodies, triangles })| {
                    self.placed(Some(at), bodies, Triangles { triangles })
                }))
            }
            Rows::Contacts(all) => to.collect_seq(all.iter().enumerate().map(|(at, c)| {
                let row = Meeting {
                    kind: c.kind.name(),
                    feature_a: c.feature_a,
                    feature_b: c.feature_b,
                    toi: c.toi,
                    toi_upper: c.toi_upper,
                    status: status(c.status),
                };
                self.placed(Some(at), c.bodies, row)
            })),
            Rows::Earliest(toi) => toi.serialize(to),
            Rows::Distance(found) => to.collect_seq(found.iter().map(|nearest| self.nearest(nearest))),
            Rows::BodyDistances(all) => to.collect_seq(all.iter().map(|nearest| self.nearest(nearest))),
            Rows::BodyPairs(pairs) => {
                to.collect_seq(pairs.iter().map(|pair| self.placed(None, pair.bodies, Nothing {})))
            }
            Rows::Near(near) => to.collect_seq(near.iter().enumerate().map(|(at, pair)| {
                let row = Nearness {
                    kind: pair.kind.name(),
                    feature_a: pair.feature_a,
                    feature_b: pair.feature_b,
                    squared_distance: pair.squared_distance,
                    weights: pair.weights(),
                    closest: pair.closest,
                };
                self.placed(Some(at), pair.bodies, row)
            })),
        }
    }
}

impl<'a> JsonRows<'a> {
    /// A row of the nearest triangles of two bodies.
    fn nearest(&self, nearest: &NearestTriangles) -> Placed<'a, Nearest> {
        let NearestTriangles { bodies, triangles, distance, weights, points } = *nearest;
        self.placed(None, bodies, Nearest { triangles, distance, weights, points })
    }

    /// A row with the names of its bodies, and the place of contact `at`.
    fn placed<T>(&self, at: Option<usize>, bodies: [BodyId; 2], row: T) -> Placed<'a, T> {
        let [body_a, body_b] = bodies.map(|body| self.names.map(|names| names[body.index()].as_str()));
        let geometry = at.zip(self.geometry).and_then(|(at, all)| match all {
            Geometry::Contacts(all) => all.get(at).map(|g| Place::Contact(contact_place(g))),
            Geometry::Pairs(all) => all.get(at).map(|g| {
                let parts = g.parts.map(|ends| ends.map(|parts| parts.map(Part::number)));
                Place::Pair(PairPlace { kind: g.kind, ends: g.ends, error: g.error, parts })
            }),
        });
        Placed { body_a, body_b, row, geometry }
    }
}

fn contact_place(g: &ContactGeometry) -> ContactPlace<'_> {
    ContactPlace {
        owner: g.owner.map(|body| body.index()),
        vertices: &g.vertices,
        weights: &g.weights,
        points: &g.points,
        distance: g.distance,
        normal: &g.normal,
    }
}
