//! The mesh with what meets coloured.

use nearmiss::contacts::{ContactGeometry, Contacts, Rows, Status};
use nearmiss::error::Error;
use nearmiss::mesh::{Body, Mesh, Positions};
use nearmiss::scene::BodyKind;
use std::collections::HashMap;
use std::path::Path;

/// Triangles without a contact.
pub const GREY: [u8; 3] = [190, 190, 190];
/// Triangles whose contacts are all undecided.
pub const ORANGE: [u8; 3] = [240, 160, 30];
/// Triangles in contact, or near another.
pub const RED: [u8; 3] = [210, 30, 30];

/// Refuses a file whose name is not that of a PLY.
///
/// # Errors
/// [`Error::InvalidArgument`].
pub fn check(path: &Path) -> Result<(), Error> {
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
        *next = (own.0 + body.vertex_count(), own.1 + body.face_count());
        Some((own.0 as u32, own.1))
    };
    bodies.iter().scan((0, 0), next).collect()
}

/// A body's vertices at that time of the step, from 0 to 1; at 0 exactly.
fn placed(body: &Body, time: f64) -> Vec<[f64; 3]> {
    let [from, to] = if body.kind() == BodyKind::Rigid {
        let own = body.positions_t0().to_f64();
        body.poses().map(|pose| own.iter().map(|point| pose.apply(*point)).collect())
    } else {
        body.ends().map(Positions::to_f64)
    };
    let between = |(from, to): ([f64; 3], [f64; 3])| [0, 1, 2].map(|k| from[k] + time * (to[k] - from[k]));
    from.into_iter().zip(to).map(between).collect()
}

/// All bodies as one mesh at that time of the step, from 0 to 1, with the colour of each triangle.
/// Coloured are triangles of the answer, and triangles with a vertex or an edge of it.
///
/// # Errors
/// [`Error::Input`] for more vertices or triangles than a mesh may have.
pub fn paint(
    bodies: &[Body],
    time: f64,
    found: &Contacts,
    geometry: &[ContactGeometry],
) -> Result<(Mesh, Vec<[u8; 3]>), Error> {
    let starts = starts(bodies);
    let (mut points, mut faces) = (Vec::new(), Vec::new());
    for (body, &(first, _)) in bodies.iter().zip(&starts) {
        points.extend(placed(body, time));
        faces.extend(body.faces().iter().map(|face| face.map(|vertex| vertex + first)));
    }
    let mut met = Met::default();
    let mut triangles = vec![GREY; faces.len()];
    let mut pair = |bodies: [usize; 2], pair: [u32; 2]| {
        bodies.iter().zip(pair).for_each(|(&body, at)| triangles[starts[body].1 + at as usize] = RED);
    };
    match &found.rows {
        Rows::Pairs(all) => all.iter().for_each(|p| pair(p.bodies.map(|body| body.index()), p.triangles)),
        Rows::Distance(all) => {
            all.iter().for_each(|n| pair(n.bodies.map(|body| body.index()), n.triangles));
        }
        Rows::BodyDistances(all) => {
            all.iter().for_each(|n| pair(n.bodies.map(|body| body.index()), n.triangles));
        }
        Rows::BodyPairs(all) => {
            for body in all.iter().flat_map(|pair| pair.bodies).map(|body| body.index()) {
                let (first, count) = (starts[body].1, bodies[body].face_count());
                triangles[first..first + count].fill(RED);
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
    for (colour, face) in triangles.iter_mut().zip(&faces) {
        *colour = met.colour(*face).unwrap_or(*colour);
    }
    let is_single = |body: &Body| body.kind() != BodyKind::Rigid && !body.positions_t0().is_f64();
    let single = time == 0.0 && bodies.iter().all(is_single);
    let positions = if single {
        // They were of single precision: exact.
        Positions::F32(points.iter().map(|point| point.map(|x| x as f32)).collect())
    } else {
        Positions::F64(points)
    };
    Ok((Mesh::new("the coloured mesh", positions, faces)?, triangles))
}

/// Features that meet, by their vertices; whether all contacts of each are undecided.
#[derive(Default)]
struct Met {
    vertices: HashMap<u32, bool>,
    edges: HashMap<[u32; 2], bool>,
    faces: HashMap<[u32; 3], bool>,
}

impl Met {
    fn add(&mut self, of: &ContactGeometry, undecided: bool, starts: &[(u32, usize)]) {
        let [a, b] = of.bodies.map(|body| starts[body.index()].0);
        let (first, second) = of.vertices.split_at(of.kind.vertices_of_a());
        for (vertices, start) in [(first, a), (second, b)] {
            let mut own: Vec<u32> = vertices.iter().map(|vertex| vertex + start).collect();
            own.sort_unstable();
            let known = match own[..] {
                [v] => self.vertices.entry(v).or_insert(true),
                [v, w] => self.edges.entry([v, w]).or_insert(true),
                [v, w, x] => self.faces.entry([v, w, x]).or_insert(true),
                _ => continue,
            };
            *known &= undecided;
        }
    }

    fn colour(&self, mut face: [u32; 3]) -> Option<[u8; 3]> {
        face.sort_unstable();
        let [v, w, x] = face;
        let corners = face.iter().filter_map(|vertex| self.vertices.get(vertex));
        let edges = [[v, w], [w, x], [v, x]];
        let sides = edges.iter().filter_map(|edge| self.edges.get(edge));
        let all = corners.chain(sides).chain(self.faces.get(&face));
        let undecided = all.copied().reduce(|one, other| one & other)?;
        Some(if undecided { ORANGE } else { RED })
    }
}
