//! Tiles: the arguments of their kernels.

use super::{Counters, FilterArgs, Growth, Node, NodeFilter, Output, Pair, Positions, Span, TraverseFlags};
use crate::math::Real;
use bytemuck::{Pod, Zeroable};

arguments! {
    /// `construct_tile_filters`: filters of the triangles below each node.
    TileFiltersArgs {
        /// Triangles in order: the lower halves.
        triangles: Span<u64>,
        /// Filter of each triangle.
        whose: Span<NodeFilter>,
        /// Out, and of nodes above tiles in: of every node.
        filters: Span<NodeFilter>,
        /// The first node that is written.
        first: u32,
        /// How many are.
        count: u32,
        /// The first node below them; of tiles [`NONE`](super::NONE).
        below: u32,
        /// How many nodes are below them.
        below_count: u32,
    }
    /// `fit_tiles`: volumes of triangles, of tiles and of the nodes above them.
    FitTilesArgs<R: Real, V: Pod> {
        /// Positions.
        frames: Positions<R>,
        /// Vertex indices of every triangle.
        faces: Span<[u32; 3]>,
        /// Triangles in order: the lower halves.
        triangles: Span<u64>,
        /// Out: the triangles' volumes, in order; [`NONE`](super::NONE) behind the last one.
        leaves: Span<Node<V>>,
        /// Out: tiles, and nodes above them.
        nodes: Span<Node<V>>,
        /// The first tile.
        tile: u32,
        /// The first node above tiles.
        above: u32,
        /// How much volumes grow.
        growth: Growth,
    }
    /// `refit_tiles`: nodes above other nodes.
    RefitTilesArgs<V: Pod> {
        /// In and out.
        nodes: Span<Node<V>>,
        /// The first node that is written.
        first: u32,
        /// How many are.
        count: u32,
        /// The first node below them.
        below: u32,
        /// How many nodes are below them.
        below_count: u32,
        /// The first tile below the first of them.
        tile: u32,
        /// Tiles below each.
        tiles: u32,
    }
    /// `fit_rims`: the edges opposite to the hub of each node's triangles.
    RimsArgs<R: Real, V: Pod> {
        /// Positions.
        frames: Positions<R>,
        /// Vertex indices of every triangle.
        faces: Span<[u32; 3]>,
        /// Triangles in order: the lower halves.
        triangles: Span<u64>,
        /// The [`NodeFilter::hub`] of every triangle.
        hubs: Span<u32>,
        /// Out, and of nodes above tiles in: of every node the hub as its link, and a volume.
        rims: Span<Node<V>>,
        /// The first node that is written.
        first: u32,
        /// How many are.
        count: u32,
        /// The first node below them; of tiles [`NONE`](super::NONE).
        below: u32,
        /// How many nodes are below them.
        below_count: u32,
        /// How much volumes grow.
        growth: Growth,
    }
    /// `traverse_tiles`: pairs of tiles that overlap.
    TilePairsArgs<V: Pod> {
        /// The nodes: tiles, then those above them, a level behind the other.
        nodes: Span<Node<V>>,
        /// Collision filters of the nodes.
        filters: FilterArgs,
        /// The rim of each; empty if none is made. See [`crate::stage::fit::rims`].
        rims: Span<Node<V>>,
        /// Out: pairs of tiles, the earlier first.
        tile_pairs: Output<Pair>,
        /// Counters.
        counters: Counters,
        /// The first node of the top level.
        top: u32,
        /// How many it has.
        tops: u32,
        /// The number of a tile's node in the top level is the tile's, so many bits lower.
        shift: u32,
        /// Tiles from here to `to` are tested against the others; at most the moving ones, which
        /// come first.
        from: u32,
        /// See above.
        to: u32,
        /// One of so many of these tiles; 1 for all.
        every: u32,
        /// The bits of a time: pairs that first meet later do not matter. Empty if all matter.
        known: Span<u64>,
    }
    /// `traverse_triangles`: pairs of triangles that overlap, of pairs of tiles.
    TileTrianglesArgs<V: Pod> {
        /// The triangles' volumes.
        leaves: Span<Node<V>>,
        /// The tiles.
        nodes: Span<Node<V>>,
        /// Vertex indices of every triangle.
        faces: Span<[u32; 3]>,
        /// Collision filters of the nodes.
        filters: FilterArgs,
        /// Filter of each triangle; empty if not needed.
        whose: Span<NodeFilter>,
        /// Pairs of tiles.
        tile_pairs: Output<Pair>,
        /// Out: candidate triangle pairs.
        pairs: Output<Pair>,
        /// Counters.
        counters: Counters,
        /// Tiles from here to `to` are tested with themselves: the same as in [`TilePairsArgs`].
        from: u32,
        /// See above.
        to: u32,
        /// All but [`TraverseFlags::GRAFTED`] and [`TraverseFlags::FRONT`].
        flags: TraverseFlags,
        /// One of so many of these tiles; 1 for all.
        every: u32,
        /// The bits of a time: pairs that first meet later do not matter. Empty if all matter.
        known: Span<u64>,
        /// Out: the cost of each of these tiles, in tests; see
        /// [`CANDIDATE`](crate::stage::traverse::tile_triangles::CANDIDATE). Empty if not needed.
        work: Span<u64>,
    }
}
