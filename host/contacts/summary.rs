//! Summary of a result, for reports.

use super::{Caveat, Front, NearestTriangles, Note, Queues};
use crate::query::{BroadPhase, QueryKind, Refit, Solver, Traversal};
use crate::stages::Stages;

/// Summary of a result, as the command line prints it in JSON or as text.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Summary {
    /// Triangles of all bodies.
    pub triangles: usize,
    /// Edges of no face, of all bodies.
    pub edges: usize,
    /// Points of no face and no edge, of all bodies.
    pub points: usize,
    /// Vertices of all bodies.
    pub vertices: usize,
    /// Frames: 1 at rest, 2 in motion.
    pub frames: usize,
    /// Kind of the query.
    pub query: QueryKind,
    /// Name of the bounding volume.
    pub bounding_volume: &'static str,
    /// Broad phase.
    pub broad_phase: BroadPhase,
    /// Refit of trees; `None` for tiles.
    pub refit: Option<Refit>,
    /// Traversal of trees; `None` for tiles.
    pub traversal: Option<Traversal>,
    /// Solver of the narrow phase.
    pub solver: Solver,
    /// `cpu` or `cuda`.
    pub backend: &'static str,
    /// Name of the machine.
    pub device: String,
    /// Triangle pairs whose volumes overlap.
    pub triangle_pairs: u64,
    /// Pairs of the narrow phase.
    pub candidates: u64,
    /// Number of contacts.
    pub contacts: usize,
    /// Number of undecided contacts; for an earliest query 1 if its time is that of an undecided
    /// pair, else 0.
    pub undecided: u64,
    /// Limits that affected the answer or its cost; empty if there were none.
    pub caveats: Vec<Caveat>,
    /// Tolerance of a certified solver, in scene units: the smallest, if pairs have several.
    pub tolerance: Option<f64>,
    /// Largest tolerance, if pairs have several.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub largest_tolerance: Option<f64>,
    /// Minimum separation of a certified solver, in scene units; 0 for touching.
    pub min_separation: Option<f64>,
    /// Whether features within that at the start are in contact only if they come nearer.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub approaching: Option<bool>,
    /// Largest distance of a near or a body-distances query, in scene units.
    pub distance: Option<f64>,
    /// Nearest triangles of a distance query, their distance and nearest points.
    pub nearest: Option<NearestTriangles>,
    /// Smallest time of contact.
    pub earliest_toi: Option<f64>,
    /// Triangle pairs that share a point at the start of the step; `None` if the query does not
    /// check it.
    pub starts_crossing: Option<u64>,
    /// Hash of the canonical answer, sixteen hexadecimal digits.
    pub hash: String,
    /// Reruns of a part of the frame after a list grew; the answer is complete.
    pub reruns: u64,
    /// Slices of the frame; more than 1 if memory was short.
    pub slices: u32,
    /// Number of builds of tiles or trees: see [`Detector::builds`](crate::Detector::builds).
    pub builds: u64,
    /// Statistics of the traversal's work queues.
    pub queues: Queues,
    /// Statistics of the traversal's front.
    pub front: Front,
    /// Milliseconds by stage.
    pub ms: Stages,
    /// Peak of device memory, in bytes.
    pub bytes: u64,
    /// Notes for the user, a sentence each; mostly none.
    pub notes: Vec<Note>,
}
