//! Instances in motion: turns of bodies, and the vertices of candidates.
//!
//! Vertices and faces have their numbers in the scene, so that the narrow phase reads them as it reads
//! those that are all placed. Only vertices of candidates are placed: the others are memory that
//! nothing writes or reads.

use super::poses::Poses;
use crate::device::{Buffer, Device};
use crate::error::Error;
use crate::pipeline::layout::Layout;
use crate::pipeline::placing::turns::{self, Turns};
use crate::pipeline::purpose;
use crate::scene::{Body, BodyKind, DeviceMotion};
use nearmiss_kernels::abi::{
    BodiesArgs, CandidateVerticesArgs, InstanceFrame, InstanceMotion, InstanceTables, MeshSpreadArgs,
    MovingBodiesArgs, MovingRelation, NodePair, Output, POSED, Pair, Placement, Point, Positions, Span,
    TurnSource, VertexMotion,
};

/// Motions of bodies, and vertices of candidates.
pub struct InMotion {
    ends: Buffer<InstanceFrame>,
    motions: Buffer<InstanceMotion>,
    /// Bodies that may turn on their arcs.
    turns: Turns,
    faces: Buffer<[u32; 3]>,
    /// Vertices of the scene at one end, or at both: empty before a query that reads them.
    still: Buffer<Point<f64>>,
    moving: Buffer<VertexMotion<f64>>,
    /// The frame in which each vertex was placed last, and the number of the last frame.
    placed_in: Buffer<u64>,
    frame: Buffer<u64>,
    /// Vertices of bodies that deform: where they are placed, and in the scene; `None` without such.
    spread: Option<Buffer<[u32; 2]>>,
}

impl InMotion {
    /// Allocates the memory of bodies. Vertices of those that deform are copied: from where they are
    /// placed, to their numbers in the scene.
    ///
    /// # Errors
    /// Device errors.
    pub fn new(
        device: &Device,
        (bodies, layout): (&[Body], &Layout),
        spread: &[[u32; 2]],
    ) -> Result<Self, Error> {
        let of_bodies = device.of(purpose::INSTANCES);
        let vertices = layout.starts[layout.bodies()].vertex as usize;
        let (mut placed_in, mut frame) = (device.of(purpose::PLACED).buffer(vertices)?, of_bodies.buffer(1)?);
        placed_in.clear()?;
        frame.clear()?;
        Ok(InMotion {
            ends: of_bodies.buffer(bodies.len())?,
            motions: of_bodies.buffer(bodies.len())?,
            turns: Turns::new(device)?,
            faces: device.of(purpose::FACES).upload(&layout.faces)?,
            still: device.buffer(0)?,
            moving: device.buffer(0)?,
            placed_in,
            frame,
            spread: if spread.is_empty() { None } else { Some(device.of(purpose::REFITTED).upload(spread)?) },
        })
    }

    /// Allocates vertices for a query at rest or in motion.
    ///
    /// # Errors
    /// Device errors.
    pub fn reserve(&mut self, device: &Device, is_at_rest: bool) -> Result<(), Error> {
        let (device, count) = (device.of(purpose::CANDIDATE_VERTICES), self.placed_in.len());
        if is_at_rest && self.still.is_empty() {
            self.still = device.buffer(count)?;
        }
        if !is_at_rest && self.moving.is_empty() {
            self.moving = device.buffer(count)?;
        }
        Ok(())
    }

    /// Places the turns of all bodies by their poses. Given are the first vertices of each body in the
    /// scene and among those of all meshes.
    ///
    /// # Errors
    /// Device errors.
    pub fn put(
        &mut self,
        device: &Device,
        (bodies, firsts): (&[Body], &[[u32; 2]]),
        poses: &Poses,
    ) -> Result<(), Error> {
        let source = |(at, (body, &[vertex, source])): (usize, (&Body, &[u32; 2]))| {
            let pose = 2 * at as u32;
            let placement = Placement { vertex, source, pose, from: POSED, ..Placement::default() };
            let moves = body.device_motion().map_or(body.is_moving(), DeviceMotion::is_moving);
            let stands = body.is_device_resident() && !moves;
            let is_rigid = body.kind() == BodyKind::Rigid;
            if stands || !is_rigid { None } else { turns::source(body, &placement, 0.0) }
        };
        let sources: Vec<TurnSource> = bodies.iter().zip(firsts).enumerate().filter_map(source).collect();
        self.turns.hold(device, sources)?;
        self.again(device, poses)
    }

    /// Places the same turns again.
    ///
    /// # Errors
    /// Device errors.
    pub fn again(&self, device: &Device, poses: &Poses) -> Result<(), Error> {
        turns::launch(device, &self.turns.args(poses.span(), poses.arrays().found.span()))
    }

    /// Returns the frames at the end, for kernels.
    pub fn ends(&self) -> Span<InstanceFrame> {
        self.ends.span()
    }

    /// Returns the motions, for kernels.
    pub fn motions(&self) -> Span<InstanceMotion> {
        self.motions.span()
    }

    /// Returns vertex indices of every triangle of the scene, for kernels.
    pub fn faces(&self) -> Span<[u32; 3]> {
        self.faces.span()
    }

    /// Returns the vertices of candidates, at one end or in motion.
    pub fn vertices(&self, is_at_rest: bool) -> Positions<f64> {
        if is_at_rest {
            Positions { still: self.still.span(), moving: Span::EMPTY, turns: Span::EMPTY }
        } else {
            Positions { still: Span::EMPTY, moving: self.moving.span(), turns: self.turns.span() }
        }
    }

    /// Returns arguments to fit bodies around these poses of each.
    pub fn fit_args(&self, of: BodiesArgs, poses: u32) -> MovingBodiesArgs {
        MovingBodiesArgs {
            of,
            ends: self.ends.span(),
            motions: self.motions.span(),
            turns: if poses == 1 { Span::EMPTY } else { self.turns.span() },
            faces: self.faces.span(),
            frame: self.frame.span(),
            poses,
            pad: 0,
        }
    }

    /// Returns arguments to copy the vertices of bodies that deform; `None` without such.
    pub fn spread_args(&self, positions: Positions<f64>, is_at_rest: bool) -> Option<MeshSpreadArgs> {
        self.spread.as_ref().map(|moves| MeshSpreadArgs {
            positions,
            moves: moves.span(),
            vertices: self.vertices(is_at_rest),
            placed: self.placed_in.span(),
            frame: self.frame.span(),
        })
    }

    /// Returns arguments to place vertices of candidates.
    pub fn vertices_args(
        &self,
        tables: InstanceTables,
        (relations, tile_pairs, pairs): (Span<MovingRelation>, Span<NodePair>, Output<Pair>),
        is_at_rest: bool,
    ) -> CandidateVerticesArgs {
        CandidateVerticesArgs {
            tables,
            ends: self.ends.span(),
            relations,
            tile_pairs,
            pairs,
            faces: self.faces.span(),
            placed: self.placed_in.span(),
            frame: self.frame.span(),
            vertices: self.vertices(is_at_rest),
        }
    }
}
