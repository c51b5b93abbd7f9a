//! Instances: bodies as meshes with poses. A mesh is on the device once, however many bodies have it.
//! A body takes some 200 bytes, and no memory for a vertex or a triangle.

mod deformed;
mod mesh;
mod motion;

pub use motion::InMotion;

use super::layout::Layout;
use super::purpose;
use crate::device::{Buffer, Device};
use crate::error::Error;
use crate::pipeline::precision::Precision;
use crate::scene::{Body, BodyKind, Pose};
use deformed::{Deformed, deforms};
use mesh::MeshTiles;
use nearmiss_kernels::abi::{
    InstanceFrame, InstanceRecord, InstanceTables, MeshLeaf, MeshNode, MeshRecord, MeshTriangle, Point,
    PoseRecord, Span,
};
use nearmiss_kernels::math::{Vec3, rigid};
use std::collections::HashMap;

/// Meshes and poses on a device.
pub struct Instances {
    meshes: Buffer<MeshRecord>,
    records: Buffer<InstanceRecord>,
    frames: Buffer<InstanceFrame>,
    nodes: Buffer<MeshNode>,
    triangles: Buffer<MeshTriangle>,
    leaves: Buffer<MeshLeaf>,
    columns: Buffer<u32>,
    vertices: Buffer<Point<f64>>,
    poses: Buffer<PoseRecord>,
    tiles: u32,
    /// Meshes that are refitted; `None` without a deformable body.
    deformed: Option<Deformed>,
    /// Motions, from the first query of features on.
    motion: Option<InMotion>,
    /// Most levels of nodes above the tiles of a mesh.
    pub levels: u32,
    /// Poses on the host, the centre of each body's mesh, and its first vertex among all meshes'.
    placed: Vec<PoseRecord>,
    centres: Vec<[f64; 3]>,
    first_vertices: Vec<u32>,
}

/// Returns the body that first has the mesh of each body with triangles. Equal meshes are one, except
/// of deformable bodies.
fn shared(bodies: &[Body]) -> Vec<Option<usize>> {
    let mut known: HashMap<u64, Vec<usize>> = HashMap::new();
    let same = |a: &Body, b: &Body| a.elements() == b.elements() && a.positions_t0() == b.positions_t0();
    let first = |(at, body): (usize, &Body)| {
        (body.element_count() > 0).then(|| {
            if deforms(body) {
                return at;
            }
            let alike = known.entry(body.fingerprint()).or_default();
            match alike.iter().find(|&&other| same(&bodies[other], body)) {
                Some(&other) => other,
                None => {
                    alike.push(at);
                    at
                }
            }
        })
    };
    bodies.iter().enumerate().map(first).collect()
}

/// The pose of a body; a body that is no rigid one is where its mesh is, exactly.
fn pose(body: &Body) -> PoseRecord {
    if body.kind() == BodyKind::Rigid { body.poses()[0].record() } else { Pose::default().record() }
}

impl Instances {
    /// Uploads meshes and poses.
    ///
    /// # Errors
    /// Device errors.
    pub fn new(device: &Device, bodies: &[Body], layout: &Layout) -> Result<Self, Error> {
        let firsts = shared(bodies);
        let (mut meshes, mut of_body): (Vec<MeshTiles>, HashMap<usize, u32>) = Default::default();
        for (at, body) in bodies.iter().enumerate().filter(|(at, _)| firsts[*at] == Some(*at)) {
            of_body.insert(at, meshes.len() as u32);
            meshes.push(MeshTiles::new(body.elements(), body.positions_t0()));
        }
        let all = Joined::of(meshes);
        let mesh = |at: usize| firsts[at].and_then(|first| of_body.get(&first)).map_or(0, |&mesh| mesh);
        let records: Vec<InstanceRecord> = (0..bodies.len())
            .map(|at| InstanceRecord { mesh: mesh(at), triangle: layout.starts[at].triangle })
            .collect();
        let centre = |record: &InstanceRecord| all.meshes.get(record.mesh as usize).map(|mesh| mesh.centre);
        let first_vertex = |record: &InstanceRecord| all.first_vertices.get(record.mesh as usize).copied();
        let placed: Vec<PoseRecord> = bodies.iter().map(pose).collect();
        let (of_meshes, of_bodies) = (device.of(purpose::MESHES), device.of(purpose::INSTANCES));
        Ok(Instances {
            meshes: of_meshes.upload(&all.meshes)?,
            records: of_bodies.upload(&records)?,
            frames: of_bodies.buffer(bodies.len())?,
            nodes: of_meshes.upload(&all.nodes)?,
            triangles: of_meshes.upload(&all.triangles)?,
            leaves: of_meshes.upload(&all.leaves)?,
            columns: of_meshes.upload(&all.columns)?,
            vertices: of_meshes.upload(&all.vertices)?,
            poses: device.of(purpose::POSES).upload(&placed)?,
            tiles: all.tiles,
            deformed: Deformed::new(device, bodies, layout, (&all, &records))?,
            motion: None,
            levels: all.levels,
            centres: records.iter().map(|record| centre(record).unwrap_or_default()).collect(),
            first_vertices: records.iter().map(|record| first_vertex(record).unwrap_or_default()).collect(),
            placed,
        })
    }

    /// Returns whether some meshes are refitted.
    pub fn deform(&self) -> bool {
        self.deformed.is_some()
    }

    /// Refits the meshes of deformable bodies to positions of the scene.
    ///
    /// # Errors
    /// Device errors.
    pub fn refit<R: Precision>(&self, device: &Device, positions: Span<Point<R>>) -> Result<(), Error> {
        self.deformed.as_ref().map_or(Ok(()), |own| own.refit(device, self.tables(), positions))
    }

    /// Uploads the poses of all bodies.
    ///
    /// # Errors
    /// Device errors.
    pub fn put(&mut self, device: &Device, bodies: &[Body]) -> Result<(), Error> {
        self.placed.clear();
        self.placed.extend(bodies.iter().map(pose));
        self.poses.write(&self.placed)?;
        self.motion.as_mut().map_or(Ok(()), |motion| motion.put(device, bodies))
    }

    /// Readies motions for a query of features, at rest or in motion.
    ///
    /// # Errors
    /// Device errors.
    pub fn ready_motion(
        &mut self,
        device: &Device,
        (bodies, layout): (&[Body], &Layout),
        is_at_rest: bool,
    ) -> Result<(), Error> {
        let motion = match &mut self.motion {
            Some(motion) => motion,
            none => {
                let mut motion = InMotion::new(device, bodies, layout, &self.first_vertices)?;
                motion.put(device, bodies)?;
                none.insert(motion)
            }
        };
        motion.reserve(device, is_at_rest)
    }

    /// Returns motions; `None` before a query of features.
    pub fn motion(&self) -> Option<&InMotion> {
        self.motion.as_ref()
    }

    /// Returns whether bodies have other poses than those on the device. By bytes: the sign of a zero
    /// may change the bits of a placed vertex.
    pub fn differ(&self, bodies: &[Body]) -> bool {
        if let Some(motion) = &self.motion {
            // It has this pose and the one at the end.
            return motion.differ(bodies);
        }
        let is_other =
            |(held, body): (&PoseRecord, &Body)| bytemuck::bytes_of(held) != bytemuck::bytes_of(&pose(body));
        self.placed.iter().zip(bodies).any(is_other)
    }

    /// Returns meshes and bodies, for kernels.
    pub fn tables(&self) -> InstanceTables {
        InstanceTables {
            meshes: self.meshes.span(),
            bodies: self.records.span(),
            frames: self.frames.span(),
            nodes: self.nodes.span(),
            triangles: self.triangles.span(),
            leaves: self.leaves.span(),
            columns: self.columns.span(),
            vertices: self.vertices.span(),
            tiles: self.tiles,
            pad: 0,
        }
    }

    /// Returns a pose for each body, for kernels.
    pub fn poses(&self) -> Span<PoseRecord> {
        self.poses.span()
    }

    /// Returns the placed centre of a body's mesh.
    pub fn centre(&self, body: usize) -> [f64; 3] {
        let pose = &self.placed[body];
        rigid::moved(&rigid::rows(pose.rotation), &pose.translation, Vec3(self.centres[body])).0
    }

    /// Returns the placed vertices of all bodies at an end of the step. Bodies without a motion have
    /// one end.
    ///
    /// # Errors
    /// Device errors.
    pub fn positions(&self, layout: &Layout, end: usize) -> Result<Vec<Vec3<f64>>, Error> {
        let vertices = self.vertices.read(self.vertices.len())?;
        let poses: Vec<&PoseRecord> = match &self.motion {
            Some(motion) => motion.placed(end).collect(),
            None => self.placed.iter().collect(),
        };
        let mut all = Vec::new();
        for (body, pose) in poses.into_iter().enumerate() {
            let count = (layout.starts[body + 1].vertex - layout.starts[body].vertex) as usize;
            let first = self.first_vertices[body] as usize;
            let rows = rigid::rows(pose.rotation);
            // A body without triangles has no mesh here.
            let own = vertices.iter().skip(first).take(count).map(|point| point.at);
            let placed = own.map(|point| rigid::moved(&rows, &pose.translation, point));
            all.extend(placed.chain(std::iter::repeat(Vec3([0.0; 3]))).take(count));
        }
        Ok(all)
    }
}

/// Meshes behind one another.
#[derive(Default)]
struct Joined {
    meshes: Vec<MeshRecord>,
    nodes: Vec<MeshNode>,
    triangles: Vec<MeshTriangle>,
    leaves: Vec<MeshLeaf>,
    columns: Vec<u32>,
    vertices: Vec<Point<f64>>,
    first_vertices: Vec<u32>,
    tiles: u32,
    levels: u32,
}

impl Joined {
    /// Joins meshes: tiles of all come first among the nodes.
    fn of(meshes: Vec<MeshTiles>) -> Joined {
        let tiles: usize = meshes.iter().map(|mesh| mesh.tiles.len()).sum();
        let mut all = Joined { tiles: tiles as u32, ..Joined::default() };
        let (mut tile, mut above) = (0, tiles as u32);
        for mesh in &meshes {
            let vertex = all.vertices.len() as u32;
            all.first_vertices.push(vertex);
            all.nodes.extend(&mesh.tiles);
            let moved = |triangle: &MeshTriangle| MeshTriangle {
                vertices: triangle.vertices.map(|v| v + vertex),
                ..*triangle
            };
            all.triangles.extend(mesh.triangles.iter().map(moved));
            all.leaves.extend(&mesh.leaves);
            all.columns.extend(&mesh.columns);
            all.vertices.extend(&mesh.vertices);
            let end = above + mesh.above.len() as u32;
            let root = if mesh.above.is_empty() { tile } else { end - 1 };
            all.meshes.push(MeshRecord { root, ..mesh.record });
            (tile, above) = (tile + mesh.tiles.len() as u32, end);
            all.levels = all.levels.max(mesh.levels);
        }
        let (mut tile, mut above) = (0, tiles as u32);
        for mesh in &meshes {
            let moved = mesh.above.iter().zip(&mesh.is_above_tiles).map(|(node, is_above_tiles)| {
                let by = if *is_above_tiles { tile } else { above };
                MeshNode { first: node.first + by, ..*node }
            });
            all.nodes.extend(moved);
            (tile, above) = (tile + mesh.tiles.len() as u32, above + mesh.above.len() as u32);
        }
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Positions;
    use crate::samples::soup;

    #[test]
    fn equal_meshes_are_one_and_others_are_not() {
        let mesh = |seed| soup(50, seed, false).frames().swap_remove(0);
        let mut moved = mesh(1);
        if let Positions::F32(points) = &mut moved.positions {
            points[0][0] += 1e-6;
        }
        let bodies = [
            Body::rigid(mesh(1)),
            Body::none(),
            Body::fixed(mesh(2)),
            Body::rigid(mesh(1)),
            Body::rigid(moved),
        ];
        assert_eq!(shared(&bodies), [Some(0), None, Some(2), Some(0), Some(4)]);
    }
}
