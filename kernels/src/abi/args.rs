//! One argument block for each kernel: its launch arguments, by value.

use super::{
    BodyRecord, Counter, Counters, FilterArgs, Growth, Inner, LeafPlace, Link, Merge, MortonFlags, Node,
    NodeFilter, Output, Pair, Point, Span, TraverseFlags, TreeBody, Treelet, TurnRecord, Unit, VertexMotion,
};
use crate::math::Real;
use bytemuck::{Pod, Zeroable};

/// Declares argument blocks: `repr(C)`, and an assertion that the fields leave no padding.
macro_rules! arguments {
    ($($(#[$doc:meta])* $name:ident $(<$($g:ident: $bound:path),*>)? {
        $($(#[$fdoc:meta])* $field:ident: $ty:ty,)*
    })*) => { $(
        $(#[$doc])*
        #[derive(Clone, Copy, Debug)]
        #[repr(C)]
        pub struct $name $(<$($g: $bound),*>)? { $($(#[$fdoc])* pub $field: $ty,)* }
        // SAFETY: every field is Zeroable, which `FITS` checks.
        unsafe impl $(<$($g: $bound),*>)? Zeroable for $name $(<$($g),*>)? {}
        // SAFETY: no field has padding, nor is there any between them; `FITS` checks both.
        unsafe impl $(<$($g: $bound),*>)? bytemuck::NoUninit for $name $(<$($g),*>)? {}
        impl $(<$($g: $bound),*>)? $name $(<$($g),*>)? {
            /// Evaluated for every block that is launched: no padding, and every field may be zero.
            pub const FITS: () = {
                const fn bytes<T: Zeroable + bytemuck::NoUninit>() -> usize { size_of::<T>() }
                assert!(0 $(+ bytes::<$ty>())* == size_of::<Self>());
            };
        }
    )* };
}

arguments! {
    /// The vertices: in motion, or still; the other is empty. Those in motion go straight, except
    /// those of bodies that turn.
    Positions<R: Real> {
        /// Vertices of a discrete query.
        still: Span<Point<R>>,
        /// Vertices of a continuous query.
        moving: Span<VertexMotion<R>>,
        /// The bodies that may turn, in the order of their vertices; empty without such.
        turns: Span<TurnRecord>,
    }
    /// `construct_bounds`, `construct_morton`: triangle centres, their box, their codes.
    MortonArgs<R: Real> {
        /// Positions.
        frames: Positions<R>,
        /// Vertex indices of every triangle.
        faces: Span<[u32; 3]>,
        /// The tree's bodies.
        bodies: Span<TreeBody>,
        /// Extents of each body's triangles, [`OF_A_BODY`](crate::bvh::centres::OF_A_BODY) words.
        extents: Span<u64>,
        /// Out: code of each triangle's centre, above the triangle.
        items: Span<u64>,
        /// Out: counts of the codes' lowest bytes.
        tiles: Tiles,
        /// How many triangles the bodies have.
        count: u32,
        /// Along which curve.
        flags: MortonFlags,
    }
    /// `construct_runs`: runs of triangles in order.
    CutArgs<R: Real> {
        /// Positions.
        frames: Positions<R>,
        /// Vertex indices of every triangle.
        faces: Span<[u32; 3]>,
        /// The tree's bodies.
        bodies: Span<TreeBody>,
        /// Extents of each body's triangles.
        extents: Span<u64>,
        /// Items in order, above each its triangle.
        items: Span<u64>,
        /// Out: the same in their new order.
        out: Span<u64>,
        /// How many triangles the bodies have.
        count: u32,
        /// Nothing.
        pad: u32,
    }
    /// How often each digit comes in each tile of a list, see [`crate::sort`].
    Tiles {
        /// Four counts a word, [`crate::sort::WORDS`] words a tile. Zeroed before items are
        /// counted.
        counts: Span<u64>,
        /// How many tiles; 0 for none.
        count: u32,
        /// How many items a tile has.
        items: u32,
    }
    /// `sort_pass`: one pass of the radix sort, over one byte of the items.
    SortArgs {
        /// Items in.
        items: Span<u64>,
        /// Items out.
        out: Span<u64>,
        /// The number of items, if only the device has it; else empty: the list is full.
        live: Span<u64>,
        /// Counts of this byte.
        tiles: Tiles,
        /// Counts of the byte of the next pass; none for the last one.
        next: Tiles,
        /// The digit is `item >> shift & 255`.
        shift: u32,
        /// The next pass's.
        next_shift: u32,
    }
    /// `construct_tree`, `construct_depth`, `construct_places`, `construct_emit`. The number of an
    /// inner node is the gap between leaves that it splits: gap i is behind leaf i.
    TreeArgs {
        /// Sorted: a Morton code above its triangle.
        items: Span<u64>,
        /// The leaves of each inner node.
        inner: Span<Inner>,
        /// Parent of each inner node.
        parents: Span<u32>,
        /// Depth of each inner node.
        depths: Span<u32>,
        /// Counts of the depths.
        tiles: Tiles,
        /// Place of each inner node in level order.
        places: Span<u32>,
        /// Out: number of levels, then the start of each, then the end of the last.
        levels: Span<u32>,
        /// Out: the tree.
        links: Span<Link>,
        /// Out: the parent of each pair of siblings, which begins at twice its index.
        pair_parents: Span<u32>,
        /// Out: each leaf's node.
        leaf_nodes: Span<u32>,
        /// Out: the first leaf below each pair of siblings; empty if not needed.
        firsts: Span<u32>,
        /// Out: filters of the triangles below each node; empty if all are of one body.
        filters: Span<NodeFilter>,
        /// All bodies of the scene; empty without filters.
        bodies: Span<BodyRecord>,
        /// The [`NodeFilter::hub`] of every triangle; empty without hubs.
        hubs: Span<u32>,
        /// Scratch, zeroed before. For each inner node: 1 if its leaves have different hubs; empty
        /// without hubs.
        mixed: Span<u64>,
        /// Out: the leaves' places; empty without treelets, as the next two are.
        leaf_places: Span<LeafPlace>,
        /// Out, zeroed before. For each chunk of leaves: how many leaves there are from the first
        /// on that begins a subtree of a treelet; 0 if none does.
        begins: Span<u64>,
        /// Out, zeroed before. For each depth: how many nodes span treelets; then as many cursors.
        tops: Span<u64>,
        /// How many leaves.
        leaves: u32,
        /// The root's index; its children follow it.
        root: u32,
    }
    /// `construct_treelets`: the plan of a refit by treelets.
    PlanArgs {
        /// The leaves of each inner node.
        inner: Span<Inner>,
        /// Parent of each inner node.
        parents: Span<u32>,
        /// Depth of each inner node.
        depths: Span<u32>,
        /// Place of each inner node in level order.
        places: Span<u32>,
        /// The parent of each pair of siblings.
        pair_parents: Span<u32>,
        /// See [`TreeArgs`].
        begins: Span<u64>,
        /// See [`TreeArgs`].
        tops: Span<u64>,
        /// Out: the treelets, one a chunk.
        treelets: Span<Treelet>,
        /// Out: merges of each treelet from its first leaf's number on, by round.
        merges: Span<Merge>,
        /// Out: merges of the nodes that span treelets, by depth.
        top: Span<Merge>,
        /// Out: the number of depths with such nodes, then the start of each depth in `top`, then
        /// the end.
        top_starts: Span<u32>,
        /// How many leaves.
        leaves: u32,
        /// The root's index.
        root: u32,
    }
    /// `fit`: the volumes of the leaves.
    FitArgs<R: Real, V: Pod> {
        /// Positions.
        frames: Positions<R>,
        /// Vertex indices of every triangle.
        faces: Span<[u32; 3]>,
        /// Each leaf's node.
        leaf_nodes: Span<u32>,
        /// The tree.
        links: Span<Link>,
        /// Out: the leaves.
        nodes: Span<Node<V>>,
        /// How much the volumes grow.
        growth: Growth,
    }
    /// `fit_groups_obb`: the oriented boxes of inner nodes of few leaves, around the points below
    /// them.
    GroupsArgs<R: Real, V: Pod> {
        /// Positions.
        frames: Positions<R>,
        /// Vertex indices of every triangle.
        faces: Span<[u32; 3]>,
        /// Triangles in leaf order: the lower halves.
        triangles: Span<u64>,
        /// The tree.
        links: Span<Link>,
        /// The parent of each pair of siblings.
        pair_parents: Span<u32>,
        /// The first leaf below each pair of siblings.
        firsts: Span<u32>,
        /// Out: the nodes.
        nodes: Span<Node<V>>,
        /// How much the volumes grow.
        growth: Growth,
        /// The root's index.
        root: u32,
        /// Zero.
        pad: u32,
    }
    /// `refit_levels`: the volumes of levels `from` to `to`, deepest first.
    RefitArgs<V: Pod> {
        /// The tree.
        links: Span<Link>,
        /// The volumes: those of the leaves in, the others out.
        nodes: Span<Node<V>>,
        /// Number of levels, then the start of each.
        levels: Span<u32>,
        /// The first leaf below each pair of siblings; empty if all nodes are merged.
        firsts: Span<u32>,
        /// The first level (nearest the root).
        from: u32,
        /// Behind the last level. More than one level only in a launch of one block.
        to: u32,
    }
    /// `refit_treelets`: all volumes, those of the leaves too.
    TreeletsArgs<R: Real, V: Pod> {
        /// Positions.
        frames: Positions<R>,
        /// Vertex indices of every triangle.
        faces: Span<[u32; 3]>,
        /// The treelets, one a block.
        treelets: Span<Treelet>,
        /// The leaves' places.
        leaf_places: Span<LeafPlace>,
        /// Merges of each treelet from its first leaf's number on, by round.
        merges: Span<Merge>,
        /// Merges of the nodes that span treelets, by depth.
        top: Span<Merge>,
        /// The number of depths with such nodes, then the start of each depth, then the end.
        top_starts: Span<u32>,
        /// One counter: tickets drawn by blocks so far, in all launches.
        ticket: Span<u64>,
        /// Out: the volumes.
        nodes: Span<Node<V>>,
        /// How much the volumes grow.
        growth: Growth,
    }
    /// `traverse_leaves`, `traverse_units`: leaf against tree.
    TraverseArgs<V: Pod> {
        /// The tree.
        nodes: Span<Node<V>>,
        /// The node of each leaf that walks.
        leaf_nodes: Span<u32>,
        /// Collision filters.
        filters: FilterArgs,
        /// Vertex indices of every triangle.
        faces: Span<[u32; 3]>,
        /// Units to walk (`traverse_units`).
        units: Output<Unit>,
        /// Out: units left when a walk's budget was used up.
        spilled: Output<Unit>,
        /// Out: candidate triangle pairs.
        pairs: Output<Pair>,
        /// Counters.
        counters: Counters,
        /// Steps of a walk before it spills the rest of its stack.
        budget: u32,
        /// All but [`TraverseFlags::FRONT`].
        flags: TraverseFlags,
    }
    /// `traverse_sample`: a bound of the least distance of two triangles.
    NearestArgs<R: Real, V: Pod> {
        /// Positions.
        positions: Span<Point<R>>,
        /// Vertex indices of every triangle.
        faces: Span<[u32; 3]>,
        /// The tree.
        nodes: Span<Node<V>>,
        /// The node of each leaf that may be a sample.
        leaf_nodes: Span<u32>,
        /// Collision filters.
        filters: FilterArgs,
        /// Counters.
        counters: Counters,
        /// How many of the leaves are samples.
        samples: u32,
        /// How many pairs of triangles a sample measures at most.
        measures: u32,
        /// Most pairs of siblings that a walk tests.
        steps: u32,
        /// [`TraverseFlags::GRAFTED`].
        flags: TraverseFlags,
        /// Which counter holds the least distance that is known before: 0 for none.
        from: Counter,
        /// Which counter takes it.
        to: Counter,
    }
}
