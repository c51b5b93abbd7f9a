//! The mesh with what meets coloured.

use crate::output::Target;
use nearmiss::contacts::{ContactGeometry, Contacts, Rows, Status};
use nearmiss::error::Error;
use nearmiss::mesh::{Body, Mesh, Positions};
use nearmiss::scene::{BodyId, BodyKind};
use nearmiss_io::encode_ply_coloured;
use std::collections::HashMap;
use std::path::Path;

/// Triangles without a contact.
pub const GREY: [u8; 3] = [190, 190, 190];
/// Triangles whose contacts are all undecided.
pub const ORANGE: [u8; 3] = [240, 160, 30];
/// Triangles in contact, or near another.
pub const RED: [u8; 3] = [210, 30, 30];

/// Triangles with 1 contact, 2 or 3, 4 to 7, 8 to 15, and 16 or more.
pub const HEAT: [[u8; 3]; 5] = [[250, 220, 60], [245, 150, 40], [220, 50, 30], [150, 10, 40], [90, 20, 120]];

/// How triangles are coloured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Paint {
    /// Whether they are in contact.
    Contact,
    /// How many contacts they have.
    Heat,
}

impl Paint {
    /// By their number of contacts, or not.
    pub fn of(heat: bool) -> Paint {
        if heat { Paint::Heat } else { Paint::Contact }
    }
}

/// All bodies as one mesh, with a colour and a number of contacts for each triangle.
pub struct Painted {
    pub mesh: Mesh,
    pub colours: Vec<[u8; 3]>,
    pub counts: Vec<u32>,
}

/// Writes the coloured mesh.
///
/// # Errors
/// [`Error::Output`].
pub fn write(target: Target, painted: &Painted) -> Result<(), Error> {
    let Painted { mesh, colours, .. } = painted;
    target.write(|mut out| encode_ply_coloured(mesh, &mut out, colours).map_err(|e| e.to_string()))
}

/// Refuses a file whose name is not that of a PLY.
///
/// # Errors
/// [`Error::InvalidArgument`].
pub fn check(path: &Path) -> Result<(), Error> {
    if crate::output::is_stdout(path) {
        return Ok(());
    }
    match crate::output::unpacked(path).extension().and_then(|e| e.to_str()) {
        Some("ply") => Ok(()),
        _ => Err(Error::InvalidArgument {
            what: format!("--out-mesh must end in .ply or .ply.gz, got {}", path.display()),
            advice: "rename the file".into(),
        }),
    }
}

/// The first vertex and the first triangle of each body in the mesh of all.
pub fn starts(bodies: &[Body]) -> Vec<(u32, usize)> {
    let next = |next: &mut (usize, usize), body: &Body| {
        let own = *next;
        *next = (own.0 + body.vertex_count(), own.1 + body.element_count());
        Some((own.0 as u32, own.1))
    };
    bodies.iter().scan((0, 0), next).collect()
}

/// A body's vertices at that time of the step, from 0 to 1; at both ends exactly.
pub fn placed(body: &Body, time: f64) -> Vec<[f64; 3]> {
    let [from, to] = if body.kind() == BodyKind::Rigid {
        let own = body.positions_t0().to_f64();
        let step = body.pose_step();
        let turns = 0.0 < time && time < 1.0 && step.turns();
        if let Some(pose) = step.at(time).filter(|_| turns) {
            return own.into_iter().map(|point| pose.apply(point)).collect();
        }
        body.poses().map(|pose| own.iter().map(|point| pose.apply(*point)).collect())
    } else {
        body.ends().map(Positions::to_f64)
    };
    let between = |(from, to): ([f64; 3], [f64; 3])| [0, 1, 2].map(|k| from[k] + time * (to[k] - from[k]));
    from.into_iter().zip(to).map(between).collect()
}

/// All bodies as one mesh at that time of the step, from 0 to 1.
///
/// # Errors
/// [`Error::Input`] for more vertices or triangles than a mesh may have.
pub fn merged(bodies: &[Body], time: f64) -> Result<Mesh, Error> {
    let (mut points, mut faces) = (Vec::new(), Vec::new());
    for (body, (first, _)) in bodies.iter().zip(starts(bodies)) {
        points.extend(placed(body, time));
        faces.extend(body.elements().iter().map(|face| face.map(|vertex| vertex + first)));
    }
    let is_single = |body: &Body| body.kind() != BodyKind::Rigid && !body.positions_t0().is_f64();
    let single = time == 0.0 && bodies.iter().all(is_single);
    let positions = if single {
        // They were of single precision: exact.
        Positions::F32(points.iter().map(|point| point.map(|x| x as f32)).collect())
    } else {
        Positions::F64(points)
    };
    Mesh::new("the coloured mesh", positions, faces)
}

/// All bodies at that time of the step, from 0 to 1, in colour. Coloured are triangles of the answer,
/// and triangles with a vertex or an edge of it.
///
/// # Errors
/// [`Error::Input`] for more vertices or triangles than a mesh may have.
pub fn paint(
    bodies: &[Body],
    time: f64,
    (found, geometry): (&Contacts, &[ContactGeometry]),
    paint: Paint,
) -> Result<Painted, Error> {
    let (mesh, starts) = (merged(bodies, time)?, starts(bodies));
    let mut met = Met::default();
    let mut counts = vec![0; mesh.face_count()];
    let mut pair = |bodies: [BodyId; 2], pair: [u32; 2]| {
        bodies.iter().zip(pair).for_each(|(body, at)| counts[starts[body.index()].1 + at as usize] += 1);
    };
    match &found.rows {
        Rows::Pairs(all) => all.iter().for_each(|p| pair(p.bodies, p.triangles)),
        Rows::Distance(all) => all.iter().for_each(|n| pair(n.bodies, n.triangles)),
        Rows::BodyDistances(all) => all.iter().for_each(|n| pair(n.bodies, n.triangles)),
        Rows::BodyPairs(all) => {
            for body in all.iter().flat_map(|pair| pair.bodies).map(|body| body.index()) {
                let (first, count) = (starts[body].1, bodies[body].element_count());
                counts[first..first + count].iter_mut().for_each(|count| *count += 1);
            }
        }
        Rows::Contacts(all) => {
            for (contact, geometry) in all.iter().zip(geometry) {
                met.add(geometry, contact.status == Status::Undecided, &starts);
            }
        }
        Rows::Near(_) => geometry.iter().for_each(|geometry| met.add(geometry, false, &starts)),
        Rows::Earliest(_) => {}
    }
    let mut colours = Vec::with_capacity(counts.len());
    for (count, face) in counts.iter_mut().zip(mesh.faces()) {
        let of_features = met.of(*face);
        *count += of_features.count;
        colours.push(match (paint, *count) {
            (_, 0) => GREY,
            (Paint::Heat, count) => HEAT[(count.ilog2() as usize).min(HEAT.len() - 1)],
            (Paint::Contact, _) if of_features.is_undecided() => ORANGE,
            (Paint::Contact, _) => RED,
        });
    }
    Ok(Painted { mesh, colours, counts })
}

/// Contacts of a feature, or of a triangle and its features.
#[derive(Clone, Copy, Default)]
struct Count {
    count: u32,
    undecided: u32,
}

impl Count {
    fn is_undecided(self) -> bool {
        self.count > 0 && self.count == self.undecided
    }
}

/// Features that meet, by their vertices.
#[derive(Default)]
struct Met {
    vertices: HashMap<u32, Count>,
    edges: HashMap<[u32; 2], Count>,
    faces: HashMap<[u32; 3], Count>,
}

impl Met {
    fn add(&mut self, of: &ContactGeometry, undecided: bool, starts: &[(u32, usize)]) {
        let [a, b] = of.bodies.map(|body| starts[body.index()].0);
        let (first, second) = of.vertices.split_at(of.kind.vertices_of_a());
        for (vertices, start) in [(first, a), (second, b)] {
            let mut own: Vec<u32> = vertices.iter().map(|vertex| vertex + start).collect();
            own.sort_unstable();
            let known = match own[..] {
                [v] => self.vertices.entry(v).or_default(),
                [v, w] => self.edges.entry([v, w]).or_default(),
                [v, w, x] => self.faces.entry([v, w, x]).or_default(),
                _ => continue,
            };
            known.count += 1;
            known.undecided += u32::from(undecided);
        }
    }

    /// Contacts of a triangle and of its features.
    fn of(&self, mut face: [u32; 3]) -> Count {
        face.sort_unstable();
        let [v, w, x] = face;
        let corners = face.iter().filter_map(|vertex| self.vertices.get(vertex));
        let edges = [[v, w], [w, x], [v, x]];
        let sides = edges.iter().filter_map(|edge| self.edges.get(edge));
        let sum =
            |a: Count, b: &Count| Count { count: a.count + b.count, undecided: a.undecided + b.undecided };
        corners.chain(sides).chain(self.faces.get(&face)).fold(Count::default(), sum)
    }
}
