//! The scene of one rank: its own triangles and those that others sent, on its device.
//!
//! Vertices and triangles of each body are in the order of the whole body. So edges keep their
//! directions, and rows their order.

use crate::error::refused;
use crate::ghosts::Ghosts;
use crate::numbers::{self, Features};
use crate::piece::Piece;
use crate::place::Place;
use nearmiss::mesh::{NO_EDGE, Positions, Topology};
use nearmiss::scene::{BodyKind, Motion, PoseStep, Scene};
use nearmiss::{Body, Detector, Device, Error, Mesh};

/// The rank that has the triangle which owns a feature.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Owner {
    /// Another rank, and the triangle is not here.
    #[default]
    Absent,
    /// Another rank, which sent the triangle.
    Ghost,
    /// This rank.
    Own,
}

/// Features of a kind: numbers in the whole body, and owners.
#[derive(Default)]
pub(crate) struct Names {
    pub numbers: Vec<u32>,
    pub owners: Vec<Owner>,
}

/// A body of the local scene.
#[derive(Default)]
pub(crate) struct LocalBody {
    pub vertices: Names,
    pub edges: Names,
    pub faces: Names,
    corners: Vec<[u32; 3]>,
    /// Local number of each vertex of each source.
    to: Vec<Vec<u32>>,
}

/// Triangles of one body from one rank.
struct Source<'a> {
    owner: Owner,
    faces: &'a [u32],
    corners: &'a [[u32; 3]],
    vertices: &'a [u32],
    edges: &'a [[u32; 3]],
    owned: &'a [u8],
    place: Place,
}

/// Sources of each body: this rank's, then those of others.
fn sources<'a>(
    pieces: &'a [Piece],
    features: &'a [Features],
    ghosts: &'a [Vec<Ghosts>],
) -> Vec<Vec<Source<'a>>> {
    let own = |(piece, features): (&'a Piece, &'a Features)| Source {
        owner: Owner::Own,
        faces: &piece.faces,
        corners: piece.body.faces(),
        vertices: &piece.vertices,
        edges: &features.edges,
        owned: &features.owned,
        place: Place::of(&piece.body, &(0..piece.vertices.len() as u32).collect::<Vec<_>>()),
    };
    let own = pieces
        .iter()
        .zip(features)
        .map(|own_one| if own_one.0.faces.is_empty() { Vec::new() } else { vec![own(own_one)] });
    let mut all: Vec<Vec<Source>> = own.collect();
    for ghosts in ghosts.iter().flatten() {
        all[ghosts.body].push(Source {
            owner: Owner::Ghost,
            faces: &ghosts.faces,
            corners: &ghosts.corners,
            vertices: &ghosts.vertices,
            edges: &ghosts.edges,
            owned: &ghosts.owned,
            place: ghosts.place.clone(),
        });
    }
    all
}

impl LocalBody {
    fn new(sources: &[Source]) -> LocalBody {
        let vertices = numbers::ascending(sources.iter().flat_map(|source| source.vertices).copied());
        let local = |&v: &u32| numbers::place(&vertices, v);
        let to: Vec<Vec<u32>> =
            sources.iter().map(|source| source.vertices.iter().map(local).collect()).collect();
        let mut order: Vec<(u32, usize, usize)> = Vec::new();
        for (at, source) in sources.iter().enumerate() {
            order.extend(source.faces.iter().enumerate().map(|(face, &number)| (number, at, face)));
        }
        order.sort_unstable();
        let corners: Vec<[u32; 3]> = order
            .iter()
            .map(|&(_, at, face)| sources[at].corners[face].map(|corner| to[at][corner as usize]))
            .collect();
        let topology = Topology::new(&corners, vertices.len());
        let edges = topology.edges.len();
        let mut body = LocalBody {
            vertices: Names { owners: vec![Owner::Absent; vertices.len()], numbers: vertices },
            edges: Names { owners: vec![Owner::Absent; edges], numbers: vec![NO_EDGE; edges] },
            faces: Names {
                numbers: order.iter().map(|(number, ..)| *number).collect(),
                owners: order.iter().map(|&(_, at, _)| sources[at].owner).collect(),
            },
            corners,
            to,
        };
        for (&(_, at, face), (corners, edges)) in
            order.iter().zip(body.corners.iter().zip(&topology.face_edges))
        {
            let source = &sources[at];
            let owns = |bit: usize| source.owned[face] >> bit & 1 == 1;
            for k in 0..3 {
                if owns(k) {
                    body.vertices.owners[corners[k] as usize] = source.owner;
                }
                if edges[k] != NO_EDGE {
                    body.edges.numbers[edges[k] as usize] = source.edges[face][k];
                }
                if owns(3 + k) {
                    body.edges.owners[edges[k] as usize] = source.owner;
                }
            }
        }
        body
    }

    /// Returns the positions of all vertices at both ends, or at one, and the step.
    ///
    /// # Errors
    /// If ranks differ in the place of a vertex, or in a pose.
    fn place(&self, name: &str, sources: &[Source]) -> Result<(Vec<Positions>, Option<PoseStep>), Error> {
        let ends = sources.iter().map(|source| source.place.ends.len()).max().unwrap_or(1);
        let mut points = vec![vec![None; self.vertices.numbers.len()]; ends];
        for (source, to) in sources.iter().zip(&self.to) {
            for (end, points) in points.iter_mut().enumerate() {
                let Some(from) = source.place.ends.get(end).or(source.place.ends.last()) else { continue };
                for (at, &to) in to.iter().enumerate() {
                    let point = from.get_f64(at).unwrap_or_default();
                    let known: &mut Option<[f64; 3]> = &mut points[to as usize];
                    if known.is_some_and(|known| known.map(f64::to_bits) != point.map(f64::to_bits)) {
                        let what = format!(
                            "vertex {} of {name} has different positions on two ranks",
                            self.vertices.numbers[to as usize]
                        );
                        return Err(refused(what, "give shared vertices the same positions on each rank"));
                    }
                    *known = Some(point);
                }
            }
        }
        let steps = || sources.iter().filter_map(|source| source.place.step);
        if steps().any(|step| Some(step) != steps().next()) {
            let what = format!("{name} has different poses on two ranks");
            return Err(refused(what, "give each rank that has a part of it the same pose"));
        }
        let is_f64 = sources.iter().any(|source| source.place.ends.iter().any(Positions::is_f64));
        let whole = |points: Vec<Option<[f64; 3]>>| {
            let points = points.into_iter().map(Option::unwrap_or_default);
            match is_f64 {
                true => Positions::F64(points.collect()),
                // They were singles.
                false => Positions::F32(points.map(|p| p.map(|x| x as f32)).collect()),
            }
        };
        Ok((points.into_iter().map(whole).collect(), steps().next()))
    }
}

/// The scene of a rank on its device.
pub(crate) struct Local {
    pub detector: Detector,
    pub bodies: Vec<LocalBody>,
}

/// All that makes a local scene.
pub(crate) struct Parts<'a> {
    pub pieces: &'a [Piece],
    pub features: &'a [Features],
    pub ghosts: &'a [Vec<Ghosts>],
    pub tolerances: &'a [f64],
    pub left_out: &'a [[usize; 2]],
    /// Whether bodies have two ends.
    pub moves: bool,
}

impl Local {
    /// Builds the scene.
    ///
    /// # Errors
    /// As of [`Detector::new`], and if ranks differ in the place of a vertex.
    pub fn new(device: &Device, parts: &Parts) -> Result<Local, Error> {
        let mut scene = Scene::new();
        let mut bodies = Vec::with_capacity(parts.pieces.len());
        let sources = sources(parts.pieces, parts.features, parts.ghosts);
        for ((piece, sources), &tolerance) in parts.pieces.iter().zip(&sources).zip(parts.tolerances) {
            let own = &piece.body;
            let local = LocalBody::new(sources);
            let (ends, step) = local.place(own.name(), sources)?;
            let start = ends.first().cloned().unwrap_or(Positions::F32(Vec::new()));
            let mesh = Mesh::new(own.name(), start, local.corners.clone())?;
            let body = match own.kind() {
                BodyKind::Fixed => Body::fixed(mesh),
                BodyKind::Rigid => Body::rigid(mesh),
                _ => Body::deformable(mesh),
            };
            let body = match motion(own.kind(), &ends, step, parts.moves) {
                Some(motion) => body.at(motion)?,
                None => body,
            };
            let body = body.with_filter(*own.filter()).with_thickness(own.thickness().clone());
            scene.add(body.with_default_tolerance(tolerance));
            bodies.push(local);
        }
        let ids: Vec<_> = scene.ids().collect();
        scene.leave_out(&parts.left_out.iter().map(|pair| pair.map(|body| ids[body])).collect::<Vec<_>>())?;
        Ok(Local { detector: Detector::new(device.clone(), scene)?, bodies })
    }

    /// Moves the bodies of the scene.
    ///
    /// # Errors
    /// As of [`Detector::update`], and if ranks differ in the place of a vertex.
    pub fn update(&mut self, parts: &Parts) -> Result<(), Error> {
        let sources = sources(parts.pieces, parts.features, parts.ghosts);
        let mut places = Vec::new();
        for (at, (piece, sources)) in parts.pieces.iter().zip(&sources).enumerate() {
            if !sources.is_empty() && piece.body.kind() != BodyKind::Fixed {
                places.push((at, self.bodies[at].place(piece.body.name(), sources)?));
            }
        }
        let ids: Vec<_> = self.detector.scene().ids().collect();
        let motions = places.iter().filter_map(|(at, (ends, step))| {
            Some((ids[*at], motion(parts.pieces[*at].body.kind(), ends, *step, parts.moves)?))
        });
        let motions: Vec<_> = motions.collect();
        self.detector.update(&motions)
    }
}

/// Motion of a body of a kind; `None` if it has no place, or never moves.
fn motion(kind: BodyKind, ends: &[Positions], step: Option<PoseStep>, moves: bool) -> Option<Motion<'_>> {
    match (kind, moves) {
        (BodyKind::Fixed, _) => None,
        (BodyKind::Rigid, true) => step.map(Motion::PoseStep),
        (BodyKind::Rigid, false) => step.map(|step| Motion::Pose(step.start())),
        (_, true) => ends.first().map(|start| Motion::step(start, ends.last().unwrap_or(start))),
        (_, false) => ends.first().map(Motion::positions),
    }
}
