//! The counters of a frame: their meanings, and their memory.

use super::{Output, Span};
use bytemuck::{NoUninit, Pod, Zeroable};

/// Which counter. Those that there are have names here, in this module; no number is one.
///
/// ```compile_fail,E0423
/// let which = nearmiss_kernels::abi::Counter(3);
/// ```
/// ```compile_fail,E0308
/// let which: nearmiss_kernels::abi::Counter = 3;
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(transparent)]
pub struct Counter(u32);

impl Counter {
    /// Its place among all.
    #[inline(always)]
    pub const fn place(self) -> u32 {
        self.0
    }
}

/// Rounds of the traversal that may spill; one more, without a budget, ends it.
pub const ROUNDS: u32 = 4;

/// Levels of nodes above the tiles of a mesh, at most: 2^32 triangles have 2^27 tiles, and a node
/// has 32 below.
pub const MESH_LEVELS: u32 = 6;

/// Gives each counter the next place: no two have one.
macro_rules! counters {
    ($at:expr;) => {
        /// How many counters there are.
        pub const COUNT: usize = $at as usize;
    };
    ($at:expr; $(#[$doc:meta])* $name:ident, $($rest:tt)*) => {
        $(#[$doc])*
        pub const $name: Counter = Counter($at);
        counters!($at + 1; $($rest)*);
    };
    ($at:expr; $(#[$doc:meta])* $name:ident: [$count:expr], $($rest:tt)*) => {
        $(#[$doc])*
        pub const $name: [Counter; $count as usize] = {
            let mut all = [Counter($at); $count as usize];
            let mut i = 1;
            while i < all.len() {
                all[i].0 += i as u32;
                i += 1;
            }
            all
        };
        counters!($at + $count; $($rest)*);
    };
}

// Those of lists are the exact demand, also if the list was too short.
counters! { 0;
    /// Candidate triangle pairs.
    PAIRS,
    /// Vertex/face candidates.
    VF,
    /// Edge/edge candidates.
    EE,
    /// Pairs that the discrete filter could not decide.
    UNCERTAIN,
    /// Triangle pairs in contact.
    CONTACTS,
    /// Vertex/face contacts.
    VF_HITS,
    /// Edge/edge contacts.
    EE_HITS,
    /// Node pairs tested by the traversal.
    STEPS,
    /// Vertex/face candidates that may meet.
    VF_SURVIVORS,
    /// Edge/edge candidates that may meet.
    EE_SURVIVORS,
    /// Pairs of tiles that overlap.
    TILE_PAIRS,
    /// Units spilled by each round of the traversal that may.
    SPILLED: [ROUNDS],
    /// Pairs of nodes at which the descent ended.
    ENDS,
    /// Most units that waited in the longest list of a queue, or past its end.
    QUEUED,
    /// Units that were left when the last round was over.
    UNFINISHED,
    /// Rounds of the queues that had work.
    QUEUE_ROUNDS,
    /// How often a queue ran dry.
    IDLE_EXITS,
    /// Units that a queue on chip had no room for.
    QUEUE_SPILLS,
    /// Units that a balance moved.
    MOVES,
    /// Units that a block took from the pool.
    STOLEN,
    /// Overlap tests made for pairs of the front.
    FRONT_TESTS,
    /// Pairs of the front that gave way to an ancestor.
    PRUNED,
    /// Vertex/face pairs that f32 leaves to f64.
    VF_ESCALATED,
    /// Edge/edge pairs that f32 leaves to f64.
    EE_ESCALATED,
    /// Vertex/face pairs that are certainly not near at the start, in a query of what approaches: they
    /// are left for the solver.
    VF_BEGIN_BEYOND,
    /// Edge/edge pairs that are certainly not near at the start.
    EE_BEGIN_BEYOND,
    /// Vertex/face pairs that may be near at the start.
    VF_BEGIN_NEAR,
    /// Edge/edge pairs that may be near at the start.
    EE_BEGIN_NEAR,
    /// Vertex/face pairs of them that bounds of errors do not decide.
    VF_UNBOUNDED,
    /// Edge/edge pairs of them that bounds do not decide.
    EE_UNBOUNDED,
    /// Vertex/face pairs of them whose distance may fall later.
    VF_ADVANCING,
    /// Edge/edge pairs of them whose distance may fall later.
    EE_ADVANCING,
    /// Vertex/face pairs of them that are left for the solver.
    VF_APPROACHING,
    /// Edge/edge pairs of them that are left for the solver.
    EE_APPROACHING,
    /// Hits that are neither certain contacts nor certainly none.
    UNDECIDED,
    /// Vertex/face pairs that isolation leaves.
    VF_OPEN,
    /// Edge/edge pairs that isolation leaves.
    EE_OPEN,
    /// Vertex/face pairs that a long list leaves to be settled.
    VF_ASKED,
    /// Edge/edge pairs that a long list leaves to be settled.
    EE_ASKED,
    /// Vertex/face pairs that are cut into slices.
    VF_HARD,
    /// Edge/edge pairs that are cut into slices.
    EE_HARD,
    /// Hits whose iterations ended.
    ENDED,
    /// Those of them that are neither certain contacts nor certainly none.
    ENDED_UNDECIDED,
    /// Hits too large for the tolerance.
    BELOW_PRECISION,
    /// Pairs that the discrete filter could not decide in f64 either.
    UNCERTAIN_WIDE,
    /// Contacts that were put into order.
    ORDERED,
    /// The most contacts of a first feature, if they are more than a run.
    LONGEST_BIN,
    /// The least distance before any is known: always 0, see [`Counters::shortest`].
    UNKNOWN,
    /// The least distance of the first samples.
    SAMPLED,
    /// That of all samples.
    SAMPLED_AGAIN,
    /// That of all candidates.
    NEAREST,
    /// The complement of the first pair of that distance: its smaller triangle above the other.
    WITNESS,
    /// 1 if there is such a pair.
    NEAREST_PAIRS,
    /// Triangle pairs of a step that share a point at t = 0.
    STARTS_CROSSING,
    /// Candidate triangle pairs of bodies that are not left out, in a scene that leaves out some.
    ALLOWED_PAIRS,
    /// Candidate triangle pairs of bodies of which none turns, in a step in which some may.
    STRAIGHT_PAIRS,
    /// Candidate triangle pairs of bodies of which one turns.
    TURNING_PAIRS,
    /// Those of them that leave their chords far.
    FAR_PAIRS,
    /// Vertex/face candidates of bodies that turn.
    VF_TURNING,
    /// Edge/edge candidates of bodies that turn.
    EE_TURNING,
    /// Vertex/face pairs of those that one slice leaves.
    VF_TURNING_LEFT,
    /// Edge/edge pairs that it leaves.
    EE_TURNING_LEFT,
    /// Vertex/face pairs of those that are no common case: they take the walk.
    VF_TURNING_WALKS,
    /// Edge/edge pairs that take the walk.
    EE_TURNING_WALKS,
    /// Vertex/face pairs that are not excluded, in a scene that excludes some.
    VF_KEPT,
    /// Edge/edge pairs that are not excluded.
    EE_KEPT,
    /// Vertex/face pairs of bodies that turn that are not excluded.
    VF_TURNING_KEPT,
    /// Edge/edge pairs of bodies that turn that are not excluded.
    EE_TURNING_KEPT,
    /// Triangle pairs in contact, with those that are excluded.
    ALL_CONTACTS,
    /// Triangle pairs that share a point at t = 0, with those that are excluded.
    ALL_CROSSING,
    /// Pairs of groups of bodies that overlap.
    GROUP_PAIRS,
    /// Pairs of bodies whose boxes overlap.
    BODY_PAIRS,
    /// Pairs of bodies whose meshes may meet.
    RELATIONS,
    /// Pairs of nodes of two bodies that may meet, level by level.
    NODE_PAIRS: [MESH_LEVELS],
    /// Pairs of nodes of two bodies that may hold their least distance, level by level.
    CLOSE_NODES: [MESH_LEVELS],
    /// Pairs of tiles of two bodies that may.
    CLOSE_TILES,
    /// Candidates that are left of bodies that share a point.
    TOUCHING_PAIRS,
    /// Pairs of bodies that share a point.
    MEETING_BODIES,
    /// The complement of the first pair of bodies that is known to share a point: its smaller body
    /// above the other.
    FIRST_BODIES,
    /// Pairs of bodies within a distance.
    NEAR_BODIES,
    /// Vertex/face pairs at rest that radii of corners leave open.
    VF_OPEN_NEAR,
    /// Edge/edge pairs that they leave open.
    EE_OPEN_NEAR,
    /// Candidate triangle pairs that may hold two features without a thickness, in a step in which such
    /// may meet and others have one.
    THIN_PAIRS,
    /// Candidate triangle pairs of which one has a thickness.
    THICK_PAIRS,
    /// Vertex/face candidates of the first.
    VF_THIN,
    /// Edge/edge candidates of the first.
    EE_THIN,
    /// Vertex/face pairs without a thickness, if a body has vertices with one and without.
    VF_ALL_THIN,
    /// Edge/edge pairs without a thickness.
    EE_ALL_THIN,
    /// Vertex/face pairs with a thickness.
    VF_SOME_THICK,
    /// Edge/edge pairs with a thickness.
    EE_SOME_THICK,
    /// Vertex/face pairs without a thickness that are not excluded.
    VF_THIN_KEPT,
    /// Edge/edge pairs without a thickness that are not excluded.
    EE_THIN_KEPT,
    /// Vertex/face pairs without a thickness that f32 leaves to f64.
    VF_THIN_ESCALATED,
    /// Edge/edge pairs without a thickness that f32 leaves to f64.
    EE_THIN_ESCALATED,
    /// As [`VF_BEGIN_BEYOND`], without a thickness; so below.
    VF_THIN_BEYOND,
    /// As [`EE_BEGIN_BEYOND`].
    EE_THIN_BEYOND,
    /// As [`VF_BEGIN_NEAR`].
    VF_THIN_NEAR,
    /// As [`EE_BEGIN_NEAR`].
    EE_THIN_NEAR,
    /// As [`VF_UNBOUNDED`].
    VF_THIN_UNBOUNDED,
    /// As [`EE_UNBOUNDED`].
    EE_THIN_UNBOUNDED,
    /// As [`VF_ADVANCING`].
    VF_THIN_ADVANCING,
    /// As [`EE_ADVANCING`].
    EE_THIN_ADVANCING,
    /// As [`VF_APPROACHING`].
    VF_THIN_APPROACHING,
    /// As [`EE_APPROACHING`].
    EE_THIN_APPROACHING,
}

/// The counters of a frame, in device memory.
#[derive(Clone, Copy, Debug)]
#[repr(transparent)]
pub struct Counters(Span<u64>);

// SAFETY: a span, which may be zeros.
unsafe impl Zeroable for Counters {}
// SAFETY: a span, which has no padding.
unsafe impl NoUninit for Counters {}

impl Counters {
    /// Those in that memory.
    ///
    /// # Panics
    /// When it has not one word for each: a fault of the caller.
    pub const fn new(words: Span<u64>) -> Self {
        assert!(words.len() == COUNT as u64, "a word for each counter");
        Counters(words)
    }
    /// All words, in the order of [`Counter::place`].
    #[inline(always)]
    pub const fn words(&self) -> Span<u64> {
        self.0
    }
    /// The word of one.
    pub const fn word(&self, which: Counter) -> Span<u64> {
        self.0.part(which.0 as u64, 1)
    }
    /// A list in that memory, counted by one of them.
    pub const fn output<T>(&self, items: Span<T>, by: Counter) -> Output<T> {
        Output::new(items, self.word(by))
    }
}
