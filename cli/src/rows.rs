//! Contacts as rows of CSV and of JSON.

use nearmiss::contacts::{
    Contact, ContactGeometry, Kind, NearPair, NearestTriangles, Rows, Status, TrianglePair,
};
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
    /// Where each contact is, in columns behind the others.
    pub geometry: Option<&'a [ContactGeometry]>,
}

impl Columns<'_> {
    /// The names of the columns.
    pub fn head(&self, csv: &mut csv::Writer<impl Write>, answer: &Rows) -> Result<(), String> {
        let triangles = if self.faces { ["face_a", "face_b"] } else { ["tri_a", "tri_b"] };
        let (own, bodies): (&[&str], bool) = match answer {
            Rows::Pairs(_) => (&triangles, true),
            Rows::Contacts(_) => (&["kind", "feature_a", "feature_b", "toi", "toi_upper", "status"], true),
            Rows::Earliest(_) => (&["earliest_toi"], false),
            Rows::Distance(_) => (&NEAREST, true),
            Rows::Near(_) => (&NEAR, true),
        };
        let step = self.step.map(|_| "step");
        let bodies = Some(())
            .filter(|()| bodies && (self.names.is_some() || self.geometry.is_some()))
            .map(|()| ["body_a", "body_b"]);
        let all = step.into_iter().chain(bodies.into_iter().flatten()).chain(own.iter().copied());
        let all = all.chain(self.geometry.into_iter().flat_map(|_| GEOMETRY));
        csv.write_record(all).map_err(|e| e.to_string())
    }

    /// A row a contact. A number is printed as the shortest decimal that reads back to the same bits.
    pub fn rows(&self, csv: &mut csv::Writer<impl Write>, answer: &Rows) -> Result<(), String> {
        let wrote = match answer {
            Rows::Pairs(pairs) => pairs.iter().try_for_each(|pair| {
                self.row(csv, Some(pair.bodies), &pair.triangles.map(|triangle| triangle.to_string()))
            }),
            Rows::Contacts(all) => all
                .iter()
                .enumerate()
                .try_for_each(|(at, c)| self.row(csv, Some(c.bodies), &self.with(at, &contact(c)))),
            // Of a sequence a step without a contact has its row too, and in it no time.
            Rows::Earliest(None) if self.step.is_some() => self.row(csv, None, &[String::new()]),
            Rows::Earliest(toi) => toi.iter().try_for_each(|toi| self.row(csv, None, &[toi.to_string()])),
            Rows::Near(pairs) => pairs
                .iter()
                .enumerate()
                .try_for_each(|(at, p)| self.row(csv, Some(p.bodies), &self.with(at, &near(p)))),
            Rows::Distance(found) => {
                found.iter().try_for_each(|n| self.row(csv, Some(n.bodies), &nearest(n)))
            }
        };
        wrote.map_err(|e| e.to_string())
    }

    /// A row, and behind it where the contact is.
    fn with(&self, at: usize, own: &[String]) -> Vec<String> {
        let place = self.geometry.and_then(|all| all.get(at)).map(place);
        own.iter().cloned().chain(place.into_iter().flatten()).collect()
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
        } else if let (Some(_), Some(bodies)) = (self.geometry, bodies) {
            bodies.iter().try_for_each(|body| csv.write_field(body.index().to_string()))?;
        }
        csv.write_record(own)
    }
}

/// The columns of where a contact is: of a `vf` row the vertex and the face's corners, of an `ee` row the ends of both edges.
const GEOMETRY: [&str; 18] = [
    "vertex_0", "vertex_1", "vertex_2", "vertex_3", "weight_0", "weight_1", "weight_2", "weight_3", "x_a",
    "y_a", "z_a", "x_b", "y_b", "z_b", "distance", "normal_x", "normal_y", "normal_z",
];

fn place(g: &ContactGeometry) -> impl Iterator<Item = String> + use<> {
    let numbers = g.weights.into_iter().chain(g.points.into_iter().flatten());
    let numbers = numbers.chain([g.distance]).chain(g.normal).map(|x| x.to_string());
    g.vertices.map(|vertex| vertex.to_string()).into_iter().chain(numbers)
}

fn kind(kind: Kind) -> String {
    match kind {
        Kind::Vf => "vf".into(),
        Kind::Ee => "ee".into(),
    }
}

fn near(pair: &NearPair) -> [String; 9] {
    let [a, b] = [pair.feature_a, pair.feature_b].map(|i| i.to_string());
    let [w, x, y, z] = pair.weights.map(|weight| weight.to_string());
    [kind(pair.kind), a, b, pair.squared_distance.to_string(), w, x, y, z, pair.closest.name().into()]
}

/// The columns of a near pair.
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

/// The columns of the nearest triangles.
const NEAREST: [&str; 9] = ["tri_a", "tri_b", "distance", "x_a", "y_a", "z_a", "x_b", "y_b", "z_b"];

fn nearest(n: &NearestTriangles) -> [String; 9] {
    let [a, b] = n.triangles.map(|i| i.to_string());
    let [[x, y, z], [u, v, w]] = n.points.map(|point| point.map(|x| x.to_string()));
    [a, b, n.distance.to_string(), x, y, z, u, v, w]
}

fn contact(c: &Contact) -> [String; 6] {
    let status = match c.status {
        Status::Unverified => "unverified",
        Status::Certified => "certified",
        Status::Undecided => "undecided",
    };
    let [a, b] = [c.feature_a, c.feature_b].map(|i| i.to_string());
    [kind(c.kind), a, b, c.toi.to_string(), c.toi_upper.to_string(), status.into()]
}

/// An answer as rows of JSON: of a scene its bodies by their names.
pub struct JsonRows<'a> {
    /// The answer.
    pub answer: &'a Rows,
    /// Of a scene, the bodies' names.
    pub names: Option<&'a [String]>,
    /// Where each contact is: `geometry` of its row.
    pub geometry: Option<&'a [ContactGeometry]>,
}

/// A row, and where its contact is.
#[derive(Serialize)]
struct Placed<'a, T> {
    body_a: String,
    body_b: String,
    #[serde(flatten)]
    row: T,
    geometry: &'a ContactGeometry,
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
    feature_a: u32,
    feature_b: u32,
    toi: f64,
    toi_upper: f64,
    status: Status,
}

#[derive(Serialize)]
struct Nearness {
    kind: Kind,
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
        if let Some(geometry) = self.geometry {
            return self.placed(geometry, to);
        }
        let Some(names) = self.names else {
            return match self.answer {
                Rows::Pairs(pairs) => to.collect_seq(pairs.iter().map(|pair| pair.triangles)),
                Rows::Contacts(all) => all.serialize(to),
                Rows::Earliest(toi) => toi.serialize(to),
                Rows::Near(near) => near.serialize(to),
                Rows::Distance(nearest) => to.collect_seq(nearest),
            };
        };
        let [of_a, of_b] = [0, 1].map(|k| move |bodies: [BodyId; 2]| names[bodies[k].index()].as_str());
        match self.answer {
            Rows::Pairs(pairs) => to.collect_seq(pairs.iter().map(|&TrianglePair { bodies, triangles }| {
                Named { body_a: of_a(bodies), body_b: of_b(bodies), row: Triangles { triangles } }
            })),
            Rows::Contacts(all) => to.collect_seq(all.iter().map(|c| {
                let &Contact { kind, bodies, feature_a, feature_b, toi, toi_upper, status } = c;
                let row = Meeting { kind, feature_a, feature_b, toi, toi_upper, status };
                Named { body_a: of_a(bodies), body_b: of_b(bodies), row }
            })),
            Rows::Earliest(toi) => toi.serialize(to),
            Rows::Distance(found) => to.collect_seq(found.iter().map(|nearest| {
                let &NearestTriangles { bodies, triangles, distance, weights, points } = nearest;
                let row = Nearest { triangles, distance, weights, points };
                Named { body_a: of_a(bodies), body_b: of_b(bodies), row }
            })),
            Rows::Near(near) => to.collect_seq(near.iter().map(|pair| {
                let &NearPair { kind, bodies, feature_a, feature_b, squared_distance, weights, closest } =
                    pair;
                let row = Nearness { kind, feature_a, feature_b, squared_distance, weights, closest };
                Named { body_a: of_a(bodies), body_b: of_b(bodies), row }
            })),
        }
    }
}

impl JsonRows<'_> {
    /// JsonRows with where each contact is; of a scene its bodies by their names, else by their numbers.
    fn placed<S: Serializer>(&self, geometry: &[ContactGeometry], to: S) -> Result<S::Ok, S::Error> {
        let name =
            |body: BodyId| self.names.map_or_else(|| body.index().to_string(), |n| n[body.index()].clone());
        fn row<T: Serialize>(
            row: T,
            geometry: &ContactGeometry,
            [body_a, body_b]: [String; 2],
        ) -> Placed<'_, T> {
            Placed { body_a, body_b, row, geometry }
        }
        match self.answer {
            Rows::Contacts(all) => {
                to.collect_seq(all.iter().zip(geometry).map(|(c, g)| row(c, g, g.bodies.map(name))))
            }
            Rows::Near(all) => {
                to.collect_seq(all.iter().zip(geometry).map(|(p, g)| row(p, g, g.bodies.map(name))))
            }
            // `args` refuses the geometry of these.
            Rows::Pairs(_) | Rows::Earliest(_) | Rows::Distance(_) => to.collect_seq([(); 0]),
        }
    }
}
