//! Contacts as a file of VTK's PolyData (`.vtp`), which `ParaView` and `pyvista` read.
//!
//! Numbers are written in full, so that they read back to the same bits. A contact has two points:
//! the nearest ones of both features. Two distinct points are joined by a line; two equal ones are a
//! vertex. VTK lists all vertices before all lines, and `row` is the row of each in a CSV. Triangle
//! pairs have cells of their own: see [`meetings`].

mod meetings;

use crate::detect::Places;
use meetings::Meetings;
use nearmiss::contacts::{ContactGeometry, Kind, NearestTriangles, Rows};
use std::fmt::Display;
use std::io::{self, Write};

/// One contact.
struct Entry {
    step: usize,
    kind: u8,
    bodies: [usize; 2],
    features: [u32; 2],
    /// Times, and the number of the status; of what stands still none.
    time: Option<([f64; 2], u8)>,
    points: [[f64; 3]; 2],
    distance: f64,
    normal: [f64; 3],
}

/// Contacts, of one step or of several.
#[derive(Default)]
pub struct Vtp {
    entries: Vec<Entry>,
    /// Triangle pairs, of a discrete query.
    meetings: Option<Meetings>,
    steps: bool,
}

/// The number of two triangles, of a distance.
const TRIANGLES: u8 = Kind::Ee as u8 + 1;

/// The number of a kind: later kinds come behind two triangles.
fn number(kind: Kind) -> u8 {
    match kind {
        Kind::Vf | Kind::Ee => kind as u8,
        Kind::Ev | Kind::Vv => kind as u8 + 1,
    }
}

impl Vtp {
    /// Takes the contacts of an answer; `step` of a sequence.
    pub fn add(&mut self, step: Option<usize>, answer: &Rows, places: &Places) {
        self.steps |= step.is_some();
        let (step, geometry) = (step.unwrap_or(0), places.geometry.contacts());
        let entry = |kind, features, time, g: &ContactGeometry| Entry {
            step,
            kind: number(kind),
            bodies: g.bodies.map(|body| body.index()),
            features,
            time,
            points: g.points,
            distance: g.distance,
            normal: g.normal,
        };
        match answer {
            Rows::Contacts(all) => self.entries.extend(all.iter().zip(geometry).map(|(c, g)| {
                entry(c.kind, [c.feature_a, c.feature_b], Some(([c.toi, c.toi_upper], c.status as u8)), g)
            })),
            Rows::Near(all) => {
                self.entries.extend(
                    all.iter().zip(geometry).map(|(p, g)| entry(p.kind, [p.feature_a, p.feature_b], None, g)),
                );
            }
            Rows::Distance(Some(nearest)) => self.entries.push(of_triangles(step, nearest)),
            Rows::BodyDistances(all) => {
                self.entries.extend(all.iter().map(|nearest| of_triangles(step, nearest)));
            }
            // `args` refuses a time, and pairs of bodies.
            Rows::Distance(None) | Rows::BodyPairs(_) | Rows::Earliest(_) => {}
            Rows::Pairs(_) => self.meetings.get_or_insert_default().add(step, places),
        }
    }

    /// Writes the file.
    pub fn write(&self, out: &mut dyn Write) -> io::Result<()> {
        out.write_all(b"<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\">\n<PolyData>\n")?;
        match &self.meetings {
            Some(meetings) => meetings.write(out, self.steps)?,
            None => self.piece(out)?,
        }
        out.write_all(b"</PolyData>\n</VTKFile>\n")
    }

    /// Writes the contacts.
    fn piece(&self, out: &mut dyn Write) -> io::Result<()> {
        let apart = |&at: &usize| self.entries[at].points[0] != self.entries[at].points[1];
        let (lines, vertices): (Vec<usize>, Vec<usize>) = (0..self.entries.len()).partition(apart);
        let (points, verts) = (2 * self.entries.len(), vertices.len());
        writeln!(
            out,
            "<Piece NumberOfPoints=\"{points}\" NumberOfVerts=\"{verts}\" NumberOfLines=\"{}\" NumberOfStrips=\"0\" NumberOfPolys=\"0\">",
            lines.len()
        )?;
        section(out, "PointData Normals=\"normal\"", |out| {
            let normals = self.entries.iter().flat_map(|e| [e.normal, e.normal]).flatten();
            array(out, "Float64", "normal", 3, normals.map(exponent))
        })?;
        section(out, "CellData Scalars=\"kind\"", |out| self.cells(out, &[&vertices[..], &lines].concat()))?;
        section(out, "Points", |out| {
            array(
                out,
                "Float64",
                "points",
                3,
                self.entries.iter().flat_map(|e| e.points).flatten().map(exponent),
            )
        })?;
        for (name, cells, size) in [("Verts", &vertices, 1), ("Lines", &lines, 2)] {
            section(out, name, |out| {
                array(out, "Int64", "connectivity", 1, cells.iter().flat_map(|at| 2 * at..2 * at + size))?;
                array(out, "Int64", "offsets", 1, (1..=cells.len()).map(|end| end * size))
            })?;
        }
        out.write_all(b"</Piece>\n")
    }

    /// The data of each cell, in the order of the cells.
    fn cells(&self, out: &mut dyn Write, order: &[usize]) -> io::Result<()> {
        let all = || order.iter().map(|&at| &self.entries[at]);
        array(out, "Int64", "row", 1, order.iter())?;
        if self.steps {
            array(out, "Int64", "step", 1, all().map(|e| e.step))?;
        }
        array(out, "UInt8", "kind", 1, all().map(|e| e.kind))?;
        array(out, "Int64", "bodies", 2, all().flat_map(|e| e.bodies))?;
        array(out, "Int64", "feature_a", 1, all().map(|e| e.features[0]))?;
        array(out, "Int64", "feature_b", 1, all().map(|e| e.features[1]))?;
        array(out, "Float64", "distance", 1, all().map(|e| exponent(e.distance)))?;
        if self.entries.iter().any(|e| e.time.is_some()) {
            let times = |end: usize| all().filter_map(move |e| e.time.map(|(toi, _)| exponent(toi[end])));
            array(out, "Float64", "toi", 1, times(0))?;
            array(out, "Float64", "toi_upper", 1, times(1))?;
            array(out, "UInt8", "status", 1, all().filter_map(|e| e.time.map(|(_, status)| status)))?;
        }
        Ok(())
    }
}

/// Two triangles and their nearest points; the direction is that between these.
fn of_triangles(step: usize, nearest: &NearestTriangles) -> Entry {
    let [p, q] = nearest.points;
    let apart = [p[0] - q[0], p[1] - q[1], p[2] - q[2]];
    let most = apart.iter().fold(0.0f64, |most, x| most.max(x.abs()));
    let scaled = apart.map(|x| if most > 0.0 { x / most } else { 0.0 });
    let length = scaled.iter().map(|x| x * x).sum::<f64>().sqrt();
    Entry {
        step,
        kind: TRIANGLES,
        bodies: nearest.bodies.map(|body| body.index()),
        features: nearest.triangles,
        time: None,
        points: nearest.points,
        distance: nearest.distance,
        normal: scaled.map(|x| if length > 0.0 { x / length } else { 0.0 }),
    }
}

/// A number as VTK reads it, to the same bits: without an exponent small ones would have hundreds of digits.
fn exponent(x: f64) -> String {
    format!("{x:e}")
}

fn section(
    out: &mut dyn Write,
    head: &str,
    inside: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> io::Result<()> {
    writeln!(out, "<{head}>")?;
    inside(out)?;
    writeln!(out, "</{}>", head.split(' ').next().unwrap_or(head))
}

fn array<T: Display>(
    out: &mut dyn Write,
    kind: &str,
    name: &str,
    components: usize,
    values: impl Iterator<Item = T>,
) -> io::Result<()> {
    let many = if components > 1 { format!(" NumberOfComponents=\"{components}\"") } else { String::new() };
    writeln!(out, "<DataArray type=\"{kind}\" Name=\"{name}\"{many} format=\"ascii\">")?;
    for (at, value) in values.enumerate() {
        let end = if (at + 1) % components == 0 { '\n' } else { ' ' };
        write!(out, "{value}{end}")?;
    }
    writeln!(out, "</DataArray>")
}
