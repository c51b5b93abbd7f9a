//! Purposes of memory, as plans print them; lists have their own names.

/// Positions of vertices.
pub const VERTICES: &str = "positions of all vertices";
/// Positions of bodies that deform, if others are instances.
pub const DEFORMING: &str = "positions of bodies that deform";
/// Positions at t = 0 alone, if vertices have two ends.
pub const STARTS: &str = "positions of all vertices at t = 0";
/// Thickness of vertices.
pub const RADII: &str = "thickness of every vertex";
/// Three vertices per triangle.
pub const FACES: &str = "vertices of each triangle";
/// Vertices of rigid bodies without a pose.
pub const REST: &str = "vertices of rigid bodies without a pose";
/// Vertices that came from the host.
pub const UPLOADED: &str = "vertices of deformable bodies, uploaded";
/// Positions in the memory of another GPU.
pub const COPIES: &str = "positions from the memory of another GPU";
/// Poses of rigid bodies.
pub const POSES: &str = "poses of rigid bodies";
/// Meshes of instances: tiles, triangles, vertices.
pub const MESHES: &str = "meshes in their own frames, once each";
/// Bodies as instances of meshes.
pub const INSTANCES: &str = "mesh and place of each body";
/// Vertices of candidates of instances.
pub const CANDIDATE_VERTICES: &str = "positions of vertices of candidates";
/// The frames that placed them.
pub const PLACED: &str = "last frame of each vertex of candidates";
/// Lists that a refit of meshes of deformable bodies reads.
pub const REFITTED: &str = "vertices, triangles and nodes of meshes that deform";
/// Boxes of bodies, and of groups of bodies.
pub const BODY_BOXES: &str = "boxes of bodies, of groups and above, and their order";
/// Which bodies are placed, and how.
pub const PLACEMENTS: &str = "which bodies are placed, and how";
/// Links, parents, leaves and levels.
pub const TREE: &str = "the tree over moving bodies: links, parents, leaves, levels";
/// Scratch memory of the construction.
pub const SCRATCH: &str = "scratch memory of the construction";
/// The refit's treelets or arrival counters.
pub const REFIT: &str = "treelets or arrival counters of the refit";
/// Filters of nodes.
pub const FILTERS: &str = "filter of each node";
/// Volumes of all nodes.
pub const VOLUMES: &str = "volumes of all nodes";
/// Volumes of triangles, of tiles and above.
pub const TILES: &str = "volumes of triangles, of tiles and above";
/// Edges opposite to hubs.
pub const RIMS: &str = "hub of each triangle, volumes of the edges opposite to it";
/// Cost of each tile.
pub const SHARES: &str = "cost of each tile, to divide work among devices";
/// Records of bodies.
pub const RECORDS: &str = "environment, groups and ranges of each body";
/// Pairs of bodies that are left out.
pub const LEFT_OUT: &str = "pairs of bodies that are left out";
/// Pairs of vertices of which features are excluded.
pub const EXCLUDED_VERTICES: &str = "vertices whose features are not tested together";
/// Bodies at rest.
pub const REST_SHAPES: &str = "vertices of rest shapes";
/// Faces that take no part.
pub const EXCLUDED_FACES: &str = "faces that take no part";
/// Tolerances of bodies.
pub const TOLERANCES: &str = "tolerance of each body";
/// Counters of a frame.
pub const COUNTERS: &str = "counters of the frame";
/// Work of the walk.
pub const WALK: &str = "work of the walk: units and queues";
/// End points of edges.
pub const EDGES: &str = "end points of each edge";
/// Edges and owned features of triangles.
pub const FACETS: &str = "edges of each triangle, and the features that it owns";
/// The smallest time.
pub const EARLIEST: &str = "the earliest time of contact";
/// Bins, slots and keys of contacts.
pub const ORDER: &str = "bins, slots and keys of the contacts";
/// Addresses and poses in memory of the caller, and checks of its numbers.
pub const DEVICE_ARRAYS: &str = "addresses of the caller's memory, and checks of its numbers";
/// Geometry of rows, rows of features, least numbers of vertices.
pub const EXTRAS: &str = "parts of a submitted answer, on request";
/// Status of the answer, for the caller's kernels.
pub const STATUS: &str = "capacity of each list, and status of the answer";
