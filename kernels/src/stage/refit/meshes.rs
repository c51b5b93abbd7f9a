//! # Meshes: positions of deformable bodies → their volumes as instances
//! Paper    the thesis, section 6.2.4, "Parallel hierarchy refitting", for the levels.
//! Launch   `vertices` a lane a vertex, `corners` a lane a triangle, `nodes` a lane a node, once a
//!          level from the tiles up, `records` a lane a mesh; a grid of any size strides.
//! Reads    positions in the scene; triangles of meshes, nodes below.
//! Writes   vertices of meshes; corners and boxes of triangles; boxes of nodes; boxes and radii of
//!          meshes.
//! Before   positions are finite. Each of these meshes has one body, whose pose is none.
//! After    vertices = positions, exactly. Corners are these about the mesh's centre, rounded to f32.
//!          Boxes hold the corners below them; those of a mesh hold them before rounding.
//!          Triangles keep their places, and meshes their centres. So the boxes of a mesh that
//!          deforms much are loose, and never too small.
//! Room     fixed; cannot run out.
//! Cost     24 B a vertex, 48 B, 32 B and 24 B a triangle out; 32 B a node below.
//!
//! [`spread`] and [`swept`] stand for the first two if triangles become candidates of features or of a
//! query next to rigid bodies. `spread`, a lane a vertex, copies positions of the scene to their
//! numbers among the vertices of candidates, and notes them as placed in the frame that comes: 32 B or
//! 64 B in and out. `swept` reads these. In a step, boxes hold corners at both ends.

use crate::abi::{
    InstanceTables, MeshLeaf, MeshRecord, MeshRefitArgs, MeshSpreadArgs, MeshSweptArgs, MeshTriangle,
    MeshVerticesArgs, NONE, Point,
};
use crate::bv::FrameBox;
use crate::bvh::relation::corners_box;
use crate::bvh::tiles::TILE;
use crate::exec::{Block, Lane};
use crate::math::tolerance::U32;
use crate::math::{Real, Vec3};

/// At least the root of 3: a radius from the largest coordinate. Squares of large ones overflow.
const ROOT_3: f64 = 1.7321;

/// Runs `body` for each of `count` items, a lane each.
#[inline(always)]
fn each<B: Block>(block: &mut B, count: u32, mut body: impl FnMut(&B::Lane, u32)) {
    let lanes = block.lanes();
    let mut base = block.block() * lanes;
    while base < count {
        block.phase(|lane| {
            let i = base + lane.lane();
            if i < count {
                body(lane, i);
            }
            lane.meet();
        });
        base += block.blocks() * lanes;
    }
}

/// Vertices of meshes.
pub fn vertices<R: Real, B: Block>(block: &mut B, args: &MeshVerticesArgs<R>) {
    each(block, args.moves.len() as u32, |lane, i| {
        let [from, to] = lane.read(args.moves, i);
        let at: Vec3<f64> = lane.read(args.positions, from).at.map(|x| x.wide());
        let point: Point<f64> = at.into();
        lane.write(args.vertices, to, point);
    });
}

/// Corners and boxes of triangles.
pub fn corners<B: Block>(block: &mut B, args: &MeshRefitArgs) {
    let tables = &args.tables;
    each(block, args.places.len() as u32, |lane, i| {
        let [place, mesh] = lane.read(args.places, i);
        let centre = Vec3(lane.read(tables.meshes, mesh).centre);
        let vertices = lane.read(tables.triangles, place).vertices;
        let corner = |v: u32| (lane.read(tables.vertices, v).at - centre).map(|x| x as f32).0;
        let corners = [corner(vertices[0]), corner(vertices[1]), corner(vertices[2])];
        let number = lane.read(tables.leaves, place).number;
        lane.write(tables.triangles, place, MeshTriangle { corners, vertices });
        put_box(lane, tables, place, MeshLeaf { volume: corners_box(&corners), number, pad: 0 });
    });
}

/// Writes the box of a triangle, also by columns.
#[inline(always)]
fn put_box<L: Lane>(lane: &L, tables: &InstanceTables, place: u32, leaf: MeshLeaf) {
    lane.write(tables.leaves, place, leaf);
    let (columns, mut k) = (leaf.columns(), 0);
    while k < MeshLeaf::COLUMNS {
        let first = place / TILE * MeshLeaf::COLUMNS * TILE;
        lane.write(tables.columns, first + k * TILE + place % TILE, columns[k as usize]);
        k += 1;
    }
}

/// Vertices of bodies that deform, among those of candidates.
pub fn spread<B: Block>(block: &mut B, args: &MeshSpreadArgs) {
    let is_still = args.vertices.moving.is_empty();
    each(block, args.moves.len() as u32, |lane, i| {
        let [from, to] = lane.read(args.moves, i);
        if is_still {
            lane.write(args.vertices.still, to, lane.read(args.positions.still, from));
        } else {
            lane.write(args.vertices.moving, to, lane.read(args.positions.moving, from));
        }
        lane.write(args.placed, to, lane.read(args.frame, 0) + 1);
    });
}

/// Corners at the start of the step, and boxes around both ends, of triangles of bodies that deform.
pub fn swept<B: Block>(block: &mut B, args: &MeshSweptArgs) {
    let (tables, is_still) = (&args.tables, args.vertices.moving.is_empty());
    each(block, args.places.len() as u32, |lane, i| {
        let [place, mesh] = lane.read(args.places, i);
        let (MeshRecord { centre, body, .. }, number) =
            (lane.read(tables.meshes, mesh), lane.read(tables.leaves, place).number);
        let [x, y, z] = lane.read(args.faces, lane.read(tables.bodies, body).triangle + number);
        let about = |at: Vec3<f64>| (at - Vec3(centre)).map(|x| x as f32).0;
        let ends = |vertex: u32| {
            if is_still {
                let at = about(lane.read(args.vertices.still, vertex).at);
                (at, at)
            } else {
                let motion = lane.read(args.vertices.moving, vertex);
                (about(motion.t0.at), about(motion.t1.at))
            }
        };
        let (p, q, r) = (ends(x), ends(y), ends(z));
        let corners = [p.0, q.0, r.0];
        let volume = corners_box(&corners).merge(corners_box(&[p.1, q.1, r.1]));
        let vertices = lane.read(tables.triangles, place).vertices;
        lane.write(tables.triangles, place, MeshTriangle { corners, vertices });
        put_box(lane, tables, place, MeshLeaf { volume, number, pad: 0 });
    });
}

/// Boxes of nodes of a level.
pub fn nodes<B: Block>(block: &mut B, args: &MeshRefitArgs) {
    let tables = &args.tables;
    each(block, args.nodes.len() as u32, |lane, i| {
        let at = lane.read(args.nodes, i);
        let mut node = lane.read(tables.nodes, at);
        let (mut volume, mut k) = (FrameBox::EMPTY, 0);
        if node.count == 0 {
            while k < TILE {
                let leaf = lane.read(tables.leaves, at * TILE + k);
                if leaf.number != NONE {
                    volume = volume.merge(leaf.volume);
                }
                k += 1;
            }
        } else {
            while k < node.count {
                volume = volume.merge(lane.read(tables.nodes, node.first + k).volume);
                k += 1;
            }
        }
        node.volume = volume;
        lane.write(tables.nodes, at, node);
    });
}

/// Boxes and radii of meshes.
pub fn records<B: Block>(block: &mut B, args: &MeshRefitArgs) {
    let tables = &args.tables;
    each(block, args.meshes.len() as u32, |lane, i| {
        let at = lane.read(args.meshes, i);
        let mut mesh = lane.read(tables.meshes, at);
        let FrameBox { lo, hi } = lane.read(tables.nodes, mesh.root).volume;
        // A coordinate is rounded to f32 once: half an ulp.
        let out = |x: f32| 2.0 * U32 as f64 * x.wide().abs() + f32::MIN_POSITIVE.wide();
        let (mut largest, mut k) = (0.0_f64, 0);
        while k < 3 {
            mesh.lo[k] = lo[k].wide() - out(lo[k]);
            mesh.hi[k] = hi[k].wide() + out(hi[k]);
            largest = largest.greater(mesh.lo[k].abs()).greater(mesh.hi[k].abs());
            k += 1;
        }
        mesh.radius = ROOT_3 * largest;
        lane.write(tables.meshes, at, mesh);
    });
}
