//! What is printed of a result.

use super::{Caveat, Front, NearestTriangles, Note, Queues};
use crate::query::{Broad, QueryKind, Refit, Solver, Traversal};
use crate::stages::Stages;

/// What the command line prints of a result, as JSON or for people.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Summary {
    /// Triangles of all bodies.
    pub triangles: usize,
    /// Vertices of all bodies.
    pub vertices: usize,
    /// Frames: 1 still, 2 moving.
    pub frames: usize,
    /// What was asked.
    pub query: QueryKind,
    /// The bounding volume.
    pub bv: &'static str,
    /// What found candidates.
    pub broad: Broad,
    /// The refit, of trees.
    pub refit: Option<Refit>,
    /// The walk, of trees.
    pub traversal: Option<Traversal>,
    /// The test.
    pub solver: Solver,
    /// `cpu` or `cuda`.
    pub backend: &'static str,
    /// The machine's name.
    pub device: String,
    /// Triangle pairs that the volumes let through.
    pub triangle_pairs: u64,
    /// Pairs that the narrow test was asked.
    pub candidates: u64,
    /// Contacts found.
    pub contacts: usize,
    /// How many of the contacts are neither confirmed nor refuted; of an earliest query 1 if its
    /// time is that of such a pair, else 0.
    pub undecided: u64,
    /// In what the frame came to less than all that was asked; empty where nothing did.
    pub caveats: Vec<Caveat>,
    /// The tolerance of a certified solver, a length: the smallest, if pairs have several.
    pub tolerance: Option<f64>,
    /// The largest of them, if pairs have several.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub largest_tolerance: Option<f64>,
    /// The separation of a certified solver, a length; 0 for touching.
    pub separation: Option<f64>,
    /// The distance of a near query, a length.
    pub distance: Option<f64>,
    /// Of a distance query the nearest triangles, how far apart they are, and where.
    pub nearest: Option<NearestTriangles>,
    /// The smallest time of contact.
    pub earliest_toi: Option<f64>,
    /// Triangle pairs that share a point at the start of the step; none of a query that does not
    /// check it.
    pub starts_crossing: Option<u64>,
    /// Hash of the canonical answer, sixteen hexadecimal digits.
    pub hash: String,
    /// How often a list was too short and grew, and a part of the frame ran again; the answer is whole.
    pub reruns: u64,
    /// In how many slices the frame was asked, for want of memory; 1 is the whole at once.
    pub slices: u32,
    /// How often tiles or trees have been made, see [`Detector::builds`](crate::Detector::builds).
    pub builds: u64,
    /// What the traversal's work queues did.
    pub queues: Queues,
    /// What the traversal's front saved or cost.
    pub front: Front,
    /// Milliseconds by stage.
    pub ms: Stages,
    /// Most device memory held at once.
    pub bytes: u64,
    /// Notes for the user, a sentence each; mostly none.
    pub notes: Vec<Note>,
}
