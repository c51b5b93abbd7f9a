//! Queries of pairs of bodies: words of a relation, and arguments of kernels.

use super::{
    InstanceTables, InstancesArgs, NearestHit, NodePair, NodesArgs, Output, Pair, Point, Positions, Relation,
    RelationsArgs, Span, TouchingFlags,
};
use crate::math::Real;
use bytemuck::Zeroable;

arguments! {
    /// Words of each relation. All begin as 0 and only grow.
    RelationWords {
        /// The complement of the bits of an upper bound of the least distance; 0 for none. Or one word
        /// for all relations: an upper bound of the least distance of any two bodies.
        least: Span<u64>,
        /// The complement of the key of a pair of triangles that share a point; 0 for none.
        touching: Span<u64>,
        /// The complement of the key of a pair of triangles at the least distance; 0 for none.
        first: Span<u64>,
        /// Largest distance of the query. Length.
        within: f64,
    }
    /// `traverse_relations_within`: pairs of bodies whose meshes may be within the distance.
    RelationsWithinArgs {
        /// Bodies, and lists.
        of: RelationsArgs,
        /// Words; none is read but the distance.
        words: RelationWords,
    }
    /// `traverse_bounds`, `traverse_nodes_within`: pairs of nodes that may hold the nearest pair.
    NodesWithinArgs {
        /// Bodies, and lists.
        of: NodesArgs,
        /// Words of each relation.
        words: RelationWords,
    }
    /// `traverse_corners`, `traverse_instances_within`: pairs of tiles to candidates.
    InstancesWithinArgs {
        /// Bodies, and lists.
        of: InstancesArgs,
        /// Words of each relation.
        words: RelationWords,
    }
    /// `traverse_touching`: pairs of tiles to bodies that share a point, and candidates that are left.
    TouchingArgs {
        /// Bodies, and lists.
        of: InstancesArgs,
        /// Words of each relation.
        words: RelationWords,
        /// What is wanted.
        flags: TouchingFlags,
        /// Zero.
        pad: u32,
    }
    /// `narrow_bodies_*`: candidates of pairs of bodies.
    BodiesNarrowArgs {
        /// Meshes and bodies.
        tables: InstanceTables,
        /// The relations.
        relations: Output<Relation>,
        /// Pairs of tiles.
        tile_pairs: Span<NodePair>,
        /// Words of each relation.
        words: RelationWords,
        /// Candidates.
        pairs: Output<Pair>,
        /// Out: pairs of bodies that share a point.
        meeting: Output<Pair>,
        /// Out: the nearest triangles of each pair of bodies.
        nearest: Output<NearestHit>,
        /// 1 if one pair of triangles that share a point is as good as another, else 0.
        any: u32,
        /// 1 if candidates are those left of bodies that share a point, else 0.
        of_touching: u32,
    }
    /// `refit_meshes_vertices`: vertices of the scene to those of meshes.
    MeshVerticesArgs<R: Real> {
        /// Positions in the scene.
        positions: Span<Point<R>>,
        /// A vertex of the scene, and the same among those of all meshes.
        moves: Span<[u32; 2]>,
        /// Out: vertices of all meshes.
        vertices: Span<Point<f64>>,
    }
    /// `refit_meshes_spread`: vertices of bodies that deform, among those of candidates.
    MeshSpreadArgs {
        /// The positions of these bodies, at one end or at both.
        positions: Positions<f64>,
        /// A vertex there, and its number in the scene.
        moves: Span<[u32; 2]>,
        /// Out: vertices of the scene.
        vertices: Positions<f64>,
        /// Out: the frame in which each vertex of the scene was placed last.
        placed: Span<u64>,
        /// The number of the last frame.
        frame: Span<u64>,
    }
    /// `refit_meshes_swept`: corners and boxes of triangles of bodies that deform.
    MeshSweptArgs {
        /// Meshes, in and out.
        tables: InstanceTables,
        /// A place of a triangle and its mesh.
        places: Span<[u32; 2]>,
        /// Vertex indices of every triangle of the scene.
        faces: Span<[u32; 3]>,
        /// Vertices of the scene, at one end or at both.
        vertices: Positions<f64>,
    }
    /// `refit_meshes_corners`, `refit_meshes_nodes`, `refit_meshes_records`: the volumes of meshes.
    MeshRefitArgs {
        /// Meshes, in and out.
        tables: InstanceTables,
        /// A place of a triangle and its mesh.
        places: Span<[u32; 2]>,
        /// Nodes of a level.
        nodes: Span<u32>,
        /// Meshes.
        meshes: Span<u32>,
    }
}
