//! Everything that is found, and how it is reported.

use super::faces::{Edge, Faults, faults};
use super::pairs::{Cluster, Face, Pair, clusters, pairs};
use crate::args::CheckArgs;
use nearmiss::contacts::{PairGeometry, PairKind};
use nearmiss::mesh::Body;
use nearmiss_io::Polygons;
use serde::Serialize;
use std::collections::HashSet;

/// Everything that is found.
pub struct Findings {
    pub bodies: Vec<Body>,
    /// The number of faces in each file.
    pub face_counts: Vec<usize>,
    /// Elements of the bodies to those of the files.
    pub faces: Vec<Vec<u32>>,
    /// Pairs of faces that meet; those of faces that are there twice are not among them.
    pub pairs: Vec<Pair>,
    pub clusters: Vec<Cluster>,
    /// Faults of each mesh.
    pub faults: Vec<Faults>,
}

impl Findings {
    /// Sorts out what a query has found, and looks for all other faults.
    pub fn new(
        bodies: Vec<Body>,
        polygons: &[Polygons],
        (geometry, groups): (&[PairGeometry], &[Option<u32>]),
    ) -> Findings {
        let of = |(body, polygons): (&Body, &Polygons)| -> Vec<u32> {
            let all = 0..body.element_count() as u32;
            all.map(|element| polygons.file_element(element, body.face_count())).collect()
        };
        let faces: Vec<Vec<u32>> = bodies.iter().zip(polygons).map(of).collect();
        let face_counts =
            bodies.iter().zip(polygons).map(|(body, polygons)| polygons.count(body.face_count())).collect();
        let faults: Vec<Faults> = bodies.iter().map(faults).collect();
        let twice: HashSet<[Face; 2]> = faults
            .iter()
            .enumerate()
            .flat_map(|(mesh, own)| own.duplicate.iter().map(move |pair| (mesh, pair)))
            .map(|(mesh, pair)| pair.map(|at| Face { mesh, face: faces[mesh][at as usize] }))
            .collect();
        let mut pairs = pairs(geometry, &faces);
        pairs.retain(|pair| !twice.contains(&pair.faces));
        let clusters = clusters(geometry, groups, &faces);
        Findings { bodies, face_counts, faces, pairs, clusters, faults }
    }

    /// Pairs of a kind.
    pub fn of<'a>(&'a self, kinds: &'a [PairKind]) -> impl Iterator<Item = &'a Pair> {
        self.pairs.iter().filter(|pair| kinds.contains(&pair.kind))
    }
}

/// Pairs that touch.
pub const TOUCHING: [PairKind; 2] = [PairKind::Segment, PairKind::Point];

/// The number of things, and the first of them.
#[derive(Serialize)]
pub struct Listed<T> {
    pub count: usize,
    pub first: Vec<T>,
}

fn listed<T>(all: impl Iterator<Item = T>, most: usize) -> Listed<T> {
    let (mut first, mut count) = (Vec::new(), 0);
    for one in all {
        if count < most {
            first.push(one);
        }
        count += 1;
    }
    Listed { count, first }
}

/// A mesh of the report.
#[derive(Serialize)]
pub struct MeshReport {
    pub name: String,
    pub faces: usize,
    pub vertices: usize,
}

/// Two faces, and the meshes that they are of.
#[derive(Serialize)]
pub struct PairReport {
    pub meshes: [usize; 2],
    pub faces: [u32; 2],
}

/// A face.
#[derive(Serialize)]
pub struct FaceReport {
    pub mesh: usize,
    pub face: u32,
}

/// An edge, and how many triangles it has.
#[derive(Serialize)]
pub struct EdgeReport {
    pub mesh: usize,
    pub vertices: [u32; 2],
    pub faces: usize,
}

/// The report, as JSON has it.
#[derive(Serialize)]
pub struct Report {
    /// Whether there is no fault.
    pub free: bool,
    pub meshes: Vec<MeshReport>,
    pub crossing: Listed<PairReport>,
    pub clusters: Listed<Cluster>,
    pub overlapping: Listed<PairReport>,
    pub touching: Listed<PairReport>,
    /// Whether faces that touch are no fault.
    pub touching_allowed: bool,
    pub duplicate: Listed<PairReport>,
    pub degenerate: Listed<FaceReport>,
    pub non_manifold_edges: Listed<EdgeReport>,
    pub boundary_edges: Listed<EdgeReport>,
    pub segments: usize,
    pub points: usize,
    pub notes: Vec<String>,
}

impl Report {
    /// The report of what is found.
    pub fn new(found: &Findings, args: &CheckArgs, mut notes: Vec<String>) -> Report {
        let most = args.first;
        let pair = |pair: &Pair| PairReport {
            meshes: pair.faces.map(|face| face.mesh),
            faces: pair.faces.map(|face| face.face),
        };
        let all = || found.faults.iter().enumerate();
        let face = |mesh: usize, triangle: &u32| found.faces[mesh][*triangle as usize];
        let edge = |mesh, edge: &Edge| EdgeReport { mesh, vertices: edge.vertices, faces: edge.faces };
        let duplicate = all().flat_map(|(mesh, own)| {
            own.duplicate.iter().map(move |pair| PairReport {
                meshes: [mesh; 2],
                faces: [0, 1].map(|side| face(mesh, &pair[side])),
            })
        });
        let degenerate = all().flat_map(|(mesh, own)| {
            let mut faces: Vec<u32> = own.degenerate.iter().map(|triangle| face(mesh, triangle)).collect();
            faces.dedup();
            faces.into_iter().map(move |face| FaceReport { mesh, face })
        });
        let edges = |of: fn(&Faults) -> &Vec<Edge>| {
            listed(all().flat_map(|(mesh, own)| of(own).iter().map(move |one| edge(mesh, one))), most)
        };
        let touching = listed(found.of(&TOUCHING).map(pair), most);
        let coincident: usize = found.bodies.iter().map(Body::coincident).sum();
        if touching.count > 0 && coincident > 0 && !args.weld {
            let share = nearmiss::words::counted(
                coincident as u64,
                "vertex shares its place",
                "vertices share their place",
            );
            notes.push(format!("{share} with another: faces at seams touch; --weld merges them"));
        }
        let mut report = Report {
            free: false,
            meshes: (found.bodies.iter().zip(&found.face_counts))
                .map(|(body, faces)| MeshReport {
                    name: body.name().to_owned(),
                    faces: *faces,
                    vertices: body.vertex_count(),
                })
                .collect(),
            crossing: listed(found.of(&[PairKind::Crossing]).map(pair), most),
            clusters: listed(found.clusters.iter().cloned(), most),
            overlapping: listed(found.of(&[PairKind::Overlap]).map(pair), most),
            touching,
            touching_allowed: args.allow_touching,
            duplicate: listed(duplicate, most),
            degenerate: listed(degenerate, most),
            non_manifold_edges: edges(|own| &own.non_manifold),
            boundary_edges: edges(|own| &own.boundary),
            segments: found.faults.iter().map(|own| own.segments).sum(),
            points: found.faults.iter().map(|own| own.points).sum(),
            notes,
        };
        let touch = if report.touching_allowed { 0 } else { report.touching.count };
        let faults = [
            report.crossing.count,
            report.overlapping.count,
            report.duplicate.count,
            report.degenerate.count,
        ];
        report.free = touch == 0 && faults.iter().all(|count| *count == 0);
        report
    }
}
