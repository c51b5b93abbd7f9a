//! Meshes of deformable bodies: instances without a pose, whose volumes are refitted on the device.

use super::Joined;
use crate::device::{Buffer, Device};
use crate::error::Error;
use crate::pipeline::layout::Layout;
use crate::pipeline::precision::Precision;
use crate::pipeline::{launch, purpose};
use crate::scene::{Body, BodyKind};
use nearmiss_kernels::abi::{
    InstanceRecord, InstanceTables, MeshRefitArgs, MeshSweptArgs, MeshVerticesArgs, NONE, Point, Positions,
    Span,
};
use nearmiss_kernels::bvh::tiles::TILE;
use nearmiss_kernels::entry;

/// Lists that a refit reads.
pub struct Deformed {
    /// A vertex of the scene, and the same among those of all meshes.
    moves: Buffer<[u32; 2]>,
    /// A place of a triangle, and its mesh.
    places: Buffer<[u32; 2]>,
    /// Nodes of each level, from the tiles up.
    levels: Vec<Buffer<u32>>,
    meshes: Buffer<u32>,
    /// First vertices of the bodies where they are placed, and in the scene; how many.
    ranges: Vec<[u32; 3]>,
}

/// Returns whether a body's mesh is refitted.
pub fn deforms(body: &Body) -> bool {
    body.kind() == BodyKind::Deformable && body.element_count() > 0
}

/// The level of a node: 0 of a tile.
fn level(all: &Joined, node: u32) -> usize {
    let node = &all.nodes[node as usize];
    if node.count == 0 { 0 } else { 1 + level(all, node.first) }
}

/// The nodes below a node, and itself, by their levels.
fn collect(all: &Joined, at: u32, levels: &mut Vec<Vec<u32>>) {
    let own = level(all, at);
    if levels.len() <= own {
        levels.resize(own + 1, Vec::new());
    }
    levels[own].push(at);
    let node = all.nodes[at as usize];
    (0..node.count).for_each(|i| collect(all, node.first + i, levels));
}

impl Deformed {
    /// Lists vertices, triangles and nodes of deformable bodies; `None` without such a body. `starts`
    /// has each body's first vertex where vertices are placed.
    ///
    /// # Errors
    /// Device errors.
    pub fn new(
        device: &Device,
        (bodies, starts): (&[Body], &[u32]),
        layout: &Layout,
        (all, records): (&Joined, &[InstanceRecord]),
    ) -> Result<Option<Self>, Error> {
        let (mut moves, mut places, mut ranges) = (Vec::new(), Vec::new(), Vec::new());
        let (mut levels, mut meshes) = (Vec::new(), Vec::new());
        for (at, _) in bodies.iter().enumerate().filter(|(_, body)| deforms(body)) {
            let (mesh, from, in_scene) = (records[at].mesh, starts[at], layout.starts[at].vertex);
            let (to, count) = (all.first_vertices[mesh as usize], layout.starts[at + 1].vertex - in_scene);
            moves.extend((0..count).map(|v| [from + v, to + v]));
            ranges.push([from, in_scene, count]);
            let mut own = Vec::new();
            collect(all, all.meshes[mesh as usize].root, &mut own);
            let tiles = own.first().into_iter().flatten();
            let filled = tiles.flat_map(|tile| tile * TILE..(tile + 1) * TILE);
            let filled = filled.filter(|&place| all.leaves[place as usize].number != NONE);
            places.extend(filled.map(|place| [place, mesh]));
            levels.resize(levels.len().max(own.len()), Vec::new());
            levels.iter_mut().zip(own).for_each(|(all, own): (&mut Vec<u32>, _)| all.extend(own));
            meshes.push(mesh);
        }
        if meshes.is_empty() {
            return Ok(None);
        }
        let device = device.of(purpose::REFITTED);
        Ok(Some(Deformed {
            moves: device.upload(&moves)?,
            places: device.upload(&places)?,
            levels: levels.iter().map(|nodes| device.upload(nodes)).collect::<Result<_, _>>()?,
            meshes: device.upload(&meshes)?,
            ranges,
        }))
    }

    /// Returns each vertex where it is placed, and in the scene.
    pub fn spread(&self) -> Vec<[u32; 2]> {
        let of = |&[from, to, count]: &[u32; 3]| (0..count).map(move |v| [from + v, to + v]);
        self.ranges.iter().flat_map(of).collect()
    }

    /// Refits the meshes to vertices among those of candidates: around both ends in a step.
    ///
    /// # Errors
    /// Device errors.
    pub fn sweep(
        &self,
        device: &Device,
        tables: InstanceTables,
        (faces, vertices): (Span<[u32; 3]>, Positions<f64>),
    ) -> Result<(), Error> {
        let args = MeshSweptArgs { tables, places: self.places.span(), faces, vertices };
        launch::striding::<entry::refit_meshes_swept>(device, self.places.len(), &args)?;
        self.refit_nodes(device, tables)
    }

    /// Returns the tiles that are refitted; there is one.
    pub fn tiles(&self) -> &Buffer<u32> {
        &self.levels[0]
    }

    /// Refits the meshes to positions of the scene.
    ///
    /// # Errors
    /// Device errors.
    pub fn refit<R: Precision>(
        &self,
        device: &Device,
        tables: InstanceTables,
        positions: Span<Point<R>>,
    ) -> Result<(), Error> {
        let vertices = MeshVerticesArgs { positions, moves: self.moves.span(), vertices: tables.vertices };
        launch::striding::<R::MeshVertices>(device, self.moves.len(), &vertices)?;
        let args = self.args(tables);
        launch::striding::<entry::refit_meshes_corners>(device, self.places.len(), &args)?;
        self.refit_nodes(device, tables)
    }

    fn args(&self, tables: InstanceTables) -> MeshRefitArgs {
        MeshRefitArgs { tables, places: self.places.span(), nodes: Span::EMPTY, meshes: self.meshes.span() }
    }

    /// Refits nodes to the boxes of triangles, and meshes to their nodes.
    fn refit_nodes(&self, device: &Device, tables: InstanceTables) -> Result<(), Error> {
        let mut args = self.args(tables);
        for nodes in &self.levels {
            args.nodes = nodes.span();
            launch::striding::<entry::refit_meshes_nodes>(device, nodes.len(), &args)?;
        }
        launch::striding::<entry::refit_meshes_records>(device, self.meshes.len(), &args)
    }
}
