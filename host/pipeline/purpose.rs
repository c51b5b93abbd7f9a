//! What memory is for, as plans tell it; lists have their own names.

/// Where vertices are.
pub const VERTICES: &str = "positions of all vertices";
/// The same at t = 0 alone, if positions have two ends.
pub const STARTS: &str = "positions of all vertices at t = 0";
/// Three vertices a triangle.
pub const FACES: &str = "vertices of each triangle";
/// Vertices of rigid bodies without a pose.
pub const REST: &str = "vertices of rigid bodies without a pose";
/// Vertices that came from the host.
pub const UPLOADED: &str = "vertices of deformable bodies, uploaded";
/// Poses of rigid bodies.
pub const POSES: &str = "poses of rigid bodies";
/// Which bodies are placed, and how.
pub const PLACEMENTS: &str = "which bodies are placed, and how";
/// Links, parents, leaves and levels.
pub const TREE: &str = "the tree over what moves: links, parents, leaves, levels";
/// What building anew needs.
pub const SCRATCH: &str = "room to build anew";
/// What the refit needs beside the tree.
pub const REFIT: &str = "the way of the refit: treelets or arrivals";
/// Whose triangles lie below each node.
pub const FILTERS: &str = "whose triangles lie below each node";
/// Volumes of all nodes.
pub const VOLUMES: &str = "volumes of all nodes";
/// Volumes of triangles, of tiles and above.
pub const TILES: &str = "volumes of triangles, of tiles and above";
/// Edges opposite to hubs.
pub const RIMS: &str = "hub of each triangle, volumes of the edges opposite to it";
/// What each tile cost.
pub const SHARES: &str = "what each tile cost, to divide work among devices";
/// What kernels know of bodies.
pub const RECORDS: &str = "environment, groups and ranges of each body";
/// Tolerances of bodies.
pub const TOLERANCES: &str = "tolerance of each body";
/// Counters of a frame.
pub const COUNTERS: &str = "counters of the frame";
/// Work of the walk.
pub const WALK: &str = "work of the walk: units and queues";
/// End points of edges.
pub const EDGES: &str = "end points of each edge";
/// What each triangle stands for.
pub const FACETS: &str = "edges of each triangle, and what it stands for";
/// The smallest time.
pub const EARLIEST: &str = "the earliest time of contact";
/// Keys of contacts.
pub const ORDER: &str = "keys of the contacts, and their counts";
/// Places and poses in memory of the caller, and what was seen there.
pub const LENT: &str = "where the caller's memory lies, and what was seen there";
/// What tells the caller on the device how a frame went.
pub const STATUS: &str = "room of every list, and whether the answer is whole";
