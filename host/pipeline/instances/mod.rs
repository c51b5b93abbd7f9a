//! Instances: bodies as meshes with poses. A mesh is on the device once, however many bodies have it.
//! A body takes some 200 bytes, and no memory for a vertex or a triangle.

mod check;
mod deformed;
mod mesh;
mod motion;
mod oriented;
mod poses;

pub use deformed::deforms;
pub use motion::InMotion;

use super::layout::Layout;
use super::placing::DeviceArrays;
use super::{launch, purpose};
use crate::device::{Buffer, Device};
use crate::error::Error;
use crate::pipeline::precision::Precision;
use crate::scene::{Body, Pose};
use deformed::Deformed;
use mesh::MeshTiles;
use nearmiss_kernels::abi::{
    InstanceFrame, InstanceRecord, InstanceTables, MeshLeaf, MeshNode, MeshRecord, MeshTriangle, Point,
    PoseRecord, Positions, Span, TileBox,
};
use nearmiss_kernels::entry::refit_meshes_spread;
use nearmiss_kernels::math::{Vec3, rigid};
use poses::Poses;
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
    poses: Poses,
    tiles: u32,
    /// Meshes that are refitted; `None` without a deformable body.
    deformed: Option<Deformed>,
    /// Motions, from the first query of features on.
    motion: Option<InMotion>,
    /// Oriented boxes of tiles, from the first query on that reads them. None if all meshes are
    /// refitted.
    boxes: Option<Buffer<TileBox>>,
    /// Most levels of nodes above the tiles of a mesh.
    pub levels: u32,
    /// The centre of each body's mesh; its first vertex in the scene, and among all meshes'.
    centres: Vec<[f64; 3]>,
    first_vertices: Vec<[u32; 2]>,
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

impl Instances {
    /// Uploads meshes and poses. `starts` has each body's first vertex where vertices are placed; only
    /// those of bodies that deform are read. `found` has two poses for each body whose poses only the device has;
    /// it is empty without such.
    ///
    /// # Errors
    /// Device errors.
    pub fn new(
        device: &Device,
        (bodies, starts): (&[Body], &[u32]),
        layout: &Layout,
        found: &[Pose],
    ) -> Result<Self, Error> {
        let firsts = shared(bodies);
        let (mut meshes, mut of_body): (Vec<MeshTiles>, HashMap<usize, u32>) = Default::default();
        for (at, body) in bodies.iter().enumerate().filter(|(at, _)| firsts[*at] == Some(*at)) {
            of_body.insert(at, meshes.len() as u32);
            meshes.push(MeshTiles::new(body.elements(), body.positions_t0()));
        }
        let mut all = Joined::of(meshes);
        for (at, mesh) in of_body.iter().filter(|(at, _)| deforms(&bodies[**at])) {
            let record = &mut all.meshes[*mesh as usize];
            (record.deforms, record.body) = (1, *at as u32);
        }
        let mesh = |at: usize| firsts[at].and_then(|first| of_body.get(&first)).map_or(0, |&mesh| mesh);
        let records: Vec<InstanceRecord> = (0..bodies.len())
            .map(|at| InstanceRecord { mesh: mesh(at), triangle: layout.starts[at].triangle })
            .collect();
        let centre = |record: &InstanceRecord| all.meshes.get(record.mesh as usize).map(|mesh| mesh.centre);
        let first_vertex = |(at, record): (usize, &InstanceRecord)| {
            let of_mesh = all.first_vertices.get(record.mesh as usize).copied();
            [layout.starts[at].vertex, of_mesh.unwrap_or_default()]
        };
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
            poses: Poses::new(device, bodies, found)?,
            tiles: all.tiles,
            deformed: Deformed::new(device, (bodies, starts), layout, (&all, &records))?,
            motion: None,
            boxes: None,
            levels: all.levels,
            centres: records.iter().map(|record| centre(record).unwrap_or_default()).collect(),
            first_vertices: records.iter().enumerate().map(first_vertex).collect(),
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

    /// Copies vertices of deformable bodies from where they are placed to those of candidates.
    ///
    /// # Errors
    /// Device errors.
    pub fn spread(&self, device: &Device, from: Positions<f64>, is_at_rest: bool) -> Result<(), Error> {
        let args = self.motion.as_ref().and_then(|motion| motion.spread_args(from, is_at_rest));
        let Some(args) = args else { return Ok(()) };
        launch::striding::<refit_meshes_spread>(device, args.moves.len() as usize, &args)
    }

    /// Refits the meshes of deformable bodies to their vertices among those of candidates.
    ///
    /// # Errors
    /// Device errors.
    pub fn sweep(&self, device: &Device, is_at_rest: bool) -> Result<(), Error> {
        let Some((deformed, motion)) = self.deformed.as_ref().zip(self.motion.as_ref()) else {
            return Ok(());
        };
        deformed.sweep(device, self.tables(), (motion.faces(), motion.vertices(is_at_rest)))
    }

    /// Places all bodies: by poses of the host, or of the caller's memory.
    ///
    /// # Errors
    /// Device errors.
    pub fn put(&mut self, device: &Device, bodies: &[Body]) -> Result<(), Error> {
        let (tables, vertices) = (self.tables(), &self.first_vertices);
        self.poses.put(device, (bodies, tables), |body| vertices[body][0])?;
        self.motion.as_mut().map_or(Ok(()), |motion| motion.put(device, (bodies, vertices), &self.poses))
    }

    /// Places the bodies of the last frame again, from the same addresses in the caller's memory.
    ///
    /// # Errors
    /// Device errors.
    pub fn again(&mut self, device: &Device) -> Result<(), Error> {
        self.poses.again(device)?;
        self.motion.as_ref().map_or(Ok(()), |motion| motion.again(device, &self.poses))
    }

    /// Returns the poses of the caller's memory.
    pub fn arrays(&self) -> &DeviceArrays {
        self.poses.arrays()
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
                let spread = self.deformed.as_ref().map_or(Vec::new(), Deformed::spread);
                let mut motion = InMotion::new(device, (bodies, layout), &spread)?;
                motion.put(device, (bodies, &self.first_vertices), &self.poses)?;
                none.insert(motion)
            }
        };
        motion.reserve(device, is_at_rest)
    }

    /// Readies oriented boxes of tiles.
    ///
    /// # Errors
    /// Device errors.
    pub fn ready_boxes(&mut self, device: &Device) -> Result<(), Error> {
        let refitted = self.deformed.as_ref().map_or(0, |deformed| deformed.tiles().len());
        if self.boxes.is_some() || refitted == self.tiles as usize {
            return Ok(());
        }
        let refitted = self.deformed.as_ref().map_or(Ok(Vec::new()), |own| own.tiles().read(refitted))?;
        let triangles = self.triangles.read(self.triangles.len())?;
        let leaves = self.leaves.read(self.leaves.len())?;
        let boxes = oriented::fit(&triangles, &leaves, &refitted);
        self.boxes = Some(device.of(purpose::MESHES).upload(&boxes)?);
        Ok(())
    }

    /// Returns oriented boxes of tiles, for kernels; empty if there are none.
    pub fn boxes(&self) -> Span<TileBox> {
        self.boxes.as_ref().map_or(Span::EMPTY, Buffer::span)
    }

    /// Returns motions; `None` before a query of features.
    pub fn motion(&self) -> Option<&InMotion> {
        self.motion.as_ref()
    }

    /// Returns whether the host has poses that the device has not.
    pub fn differ(&self, bodies: &[Body]) -> bool {
        self.poses.differ(bodies)
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

    /// Returns two poses for each body, for kernels.
    pub fn poses(&self) -> Span<PoseRecord> {
        self.poses.span()
    }

    /// Returns the placed centre of each body's mesh, at the start.
    ///
    /// # Errors
    /// Device errors.
    pub fn centres(&self) -> Result<Vec<[f64; 3]>, Error> {
        let poses = self.poses.read()?;
        let placed = |(pose, &centre): (&PoseRecord, &[f64; 3])| {
            rigid::moved(&rigid::rows(pose.rotation), &pose.translation, Vec3(centre)).0
        };
        Ok(poses.iter().step_by(2).zip(&self.centres).map(placed).collect())
    }

    /// Returns the placed vertices of all bodies at an end of the step.
    ///
    /// # Errors
    /// Device errors.
    pub fn positions(&self, layout: &Layout, end: usize) -> Result<Vec<Vec3<f64>>, Error> {
        let vertices = self.vertices.read(self.vertices.len())?;
        let poses = self.poses.read()?;
        let mut all = Vec::new();
        for (body, pose) in poses.iter().skip(end).step_by(2).enumerate() {
            let count = (layout.starts[body + 1].vertex - layout.starts[body].vertex) as usize;
            let first = self.first_vertices[body][1] as usize;
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
