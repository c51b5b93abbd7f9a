//! Argument blocks of the last stage: from triangle pairs to contacts.

use super::{
    Begun, BodyTolerance, Counters, DiscreteFlags, ExclusionTables, Facet, Hit, NearHit, NearestHit, Output,
    Pair, Point, Positions, RungFlags, Span,
};
use crate::math::Real;
use crate::prim::inclusion::Params;
use bytemuck::Zeroable;

arguments! {
    /// `narrow_sift`: triangle pairs to vertex/face and edge/edge candidates.
    FeaturesArgs<R: Real> {
        /// Positions.
        frames: Positions<R>,
        /// Every triangle's vertices and edges, and what it owns of them.
        facets: Span<Facet>,
        /// Candidate triangle pairs.
        pairs: Output<Pair>,
        /// Out: vertex, face.
        vf: Output<Pair>,
        /// Out: edge, edge.
        ee: Output<Pair>,
        /// Features whose boxes come within it are listed, a length; 0 for touching.
        gap: f64,
        /// The bits of a time: pairs that first meet later do not matter. Empty if all matter.
        known: Span<u64>,
    }
    /// `narrow_divide`: candidates of bodies that turn and may meet, and of those that go straight.
    DivideArgs {
        /// Positions, and the bodies that may turn.
        frames: Positions<f64>,
        /// Every triangle's vertices and edges, and what it owns of them.
        facets: Span<Facet>,
        /// Candidate triangle pairs.
        pairs: Output<Pair>,
        /// Out: those of which neither body turns.
        straight: Output<Pair>,
        /// Out: the others, if no direction parts them.
        turning: Output<Pair>,
        /// Triangles that stay farther apart are left out: a length.
        gap: f64,
    }
    /// `narrow_divide_thick`: candidates that may hold two features without a thickness, and those with
    /// one.
    DivideThickArgs {
        /// The thickness of every vertex.
        radii: Span<f64>,
        /// Vertex indices of every triangle.
        faces: Span<[u32; 3]>,
        /// Candidate triangle pairs.
        pairs: Output<Pair>,
        /// Out: those of which each triangle has a vertex without a thickness.
        thin: Output<Pair>,
        /// Out: those of which one triangle has a vertex with a thickness.
        thick: Output<Pair>,
    }
    /// `narrow_sift_thick`: pairs of features without a thickness, and those with one.
    SiftThickArgs {
        /// The thickness of every vertex.
        radii: Span<f64>,
        /// Vertex indices of every triangle.
        faces: Span<[u32; 3]>,
        /// End points of every edge.
        edges: Span<[u32; 2]>,
        /// Vertex/face candidates of thin pairs of triangles.
        thin_vf: Output<Pair>,
        /// Edge/edge candidates of those.
        thin_ee: Output<Pair>,
        /// Vertex/face candidates of thick pairs of triangles.
        thick_vf: Output<Pair>,
        /// Edge/edge candidates of those.
        thick_ee: Output<Pair>,
        /// Out: those of `thin_vf` of which no vertex has a thickness.
        all_thin_vf: Output<Pair>,
        /// Out: those of `thin_ee` of which no vertex has one.
        all_thin_ee: Output<Pair>,
        /// Out: those of `thick_vf` of which a vertex has one.
        some_thick_vf: Output<Pair>,
        /// Out: those of `thick_ee` of which a vertex has one.
        some_thick_ee: Output<Pair>,
    }
    /// `narrow_turning_chords`, `narrow_turning_features`: triangle pairs of bodies that turn, to pairs of
    /// features.
    TurningFeaturesArgs {
        /// Positions.
        frames: Positions<f64>,
        /// Vertices of rigid bodies, as they are without a pose.
        rest: Span<Point<f64>>,
        /// Every triangle's vertices and edges, and what it owns of them.
        facets: Span<Facet>,
        /// Triangle pairs.
        pairs: Output<Pair>,
        /// Out: those that leave their chords far, from one launch to the other.
        far: Output<Pair>,
        /// Out: vertex, face.
        vf: Output<Pair>,
        /// Out: edge, edge.
        ee: Output<Pair>,
        /// Triangles that stay farther apart are left out: a length.
        gap: f64,
    }
    /// `narrow_moller`, `narrow_filter`, `narrow_wide`, `narrow_exact`, and those of the start of a
    /// step: triangle pairs that meet.
    DiscreteArgs<R: Real> {
        /// Positions: the only ones, or those of a step, whose start is read.
        frames: Positions<R>,
        /// Vertex indices of every triangle.
        faces: Span<[u32; 3]>,
        /// Pairs to test.
        pairs: Output<Pair>,
        /// Out: pairs that meet.
        contacts: Output<Pair>,
        /// Out: pairs that a filter leaves to the next one; empty for the last one.
        uncertain: Output<Pair>,
        /// Flags of the test.
        flags: DiscreteFlags,
        /// Zero.
        pad: u32,
    }
    /// `narrow_reject`: candidates that certainly stay apart, left out.
    CullArgs<R: Real> {
        /// Positions.
        frames: Positions<R>,
        /// Vertex indices of every triangle.
        faces: Span<[u32; 3]>,
        /// End points of every edge.
        edges: Span<[u32; 2]>,
        /// Vertex/face candidates.
        vf: Output<Pair>,
        /// Edge/edge candidates.
        ee: Output<Pair>,
        /// Out: vertex/face pairs that may meet.
        may_vf: Output<Pair>,
        /// Out: edge/edge pairs that may meet.
        may_ee: Output<Pair>,
        /// Parameters of the query.
        params: Params,
        /// The bits of a time: pairs that cannot meet before it are left out too. Empty if all are
        /// wanted.
        known: Span<u64>,
    }
    /// `narrow_first_pairs`: tested pairs that may begin at the earliest time.
    FirstPairsArgs<R: Real> {
        /// Tested pairs, lists of those that are kept, parameters. The known time is that of
        /// [`super::earliest`].
        tested: CullArgs<R>,
        /// 1: keeps all pairs if there is a time, as for a solver without a horizon. Else 0.
        all: u32,
        /// Zero.
        pad: u32,
    }
    /// `narrow_first_hits`: contacts at the earliest time.
    FirstHitsArgs {
        /// Vertex/face contacts.
        vf: Output<Hit>,
        /// Edge/edge contacts.
        ee: Output<Hit>,
        /// Out: those of vertices and faces at that time.
        first_vf: Output<Hit>,
        /// Out: those of edges.
        first_ee: Output<Hit>,
        /// The words of [`super::earliest`].
        earliest: Span<u64>,
    }
    /// `narrow_vf`, `narrow_ee`: the first time of contact of two primitives in motion.
    SolveArgs<R: Real> {
        /// Positions.
        frames: Positions<R>,
        /// Vertex indices of every triangle (`narrow_vf`).
        faces: Span<[u32; 3]>,
        /// End points of every edge (`narrow_ee`).
        edges: Span<[u32; 2]>,
        /// Candidates that may meet.
        survivors: Output<Pair>,
        /// Out: contacts; empty if only the earliest is wanted.
        hits: Output<Hit>,
        /// Out: the least toi so far, the words of [`super::earliest`]; or empty.
        earliest: Span<u64>,
        /// Counters.
        counters: Counters,
    }
    /// `narrow_least`, `narrow_witness`, `narrow_nearest`: of the candidates the nearest pair.
    LeastArgs<R: Real> {
        /// Positions.
        positions: Span<Point<R>>,
        /// Vertex indices of every triangle.
        faces: Span<[u32; 3]>,
        /// Candidate triangle pairs.
        pairs: Output<Pair>,
        /// Those of them that share a point.
        meeting: Output<Pair>,
        /// Out: one.
        nearest: Output<NearestHit>,
        /// Counters.
        counters: Counters,
    }
    /// `narrow_near`: the features at rest that are within a distance.
    NearArgs<R: Real> {
        /// Positions.
        positions: Span<Point<R>>,
        /// Vertex indices of every triangle.
        faces: Span<[u32; 3]>,
        /// End points of every edge.
        edges: Span<[u32; 2]>,
        /// Vertex/face candidates.
        vf: Output<Pair>,
        /// Edge/edge candidates.
        ee: Output<Pair>,
        /// Out: vertices and faces within the distance.
        vf_hits: Output<NearHit>,
        /// Out: edges within the distance.
        ee_hits: Output<NearHit>,
        /// Counters.
        counters: Counters,
        /// The distance, a length.
        distance: f64,
    }
    /// `narrow_near_thick`, `narrow_near_open`: the same, of vertices with a thickness.
    ThickNearArgs<R: Real> {
        /// Candidates, lists, the distance.
        near: NearArgs<R>,
        /// Vertex/face pairs that radii of corners leave open: out of the first, in for the second.
        /// Empty if radii are the same within each body, and no pairs are excluded.
        vf_open: Output<Pair>,
        /// Edge/edge pairs that they leave open.
        ee_open: Output<Pair>,
        /// The thickness of every vertex.
        radii: Span<f64>,
        /// Pairs that the scene excludes.
        tables: ExclusionTables,
    }
    /// `narrow_below_precision`: hits too large for the solver's precision to resolve the tolerance.
    BelowPrecisionArgs<R: Real> {
        /// Positions.
        frames: Positions<R>,
        /// Vertex indices of every triangle.
        faces: Span<[u32; 3]>,
        /// End points of every edge.
        edges: Span<[u32; 2]>,
        /// Vertex/face hits.
        vf: Output<Hit>,
        /// Edge/edge hits.
        ee: Output<Hit>,
        /// Counters.
        counters: Counters,
        /// The tolerance, a length, if all pairs have the same.
        tolerance: f64,
        /// The tolerances of bodies, by their first vertices; empty if all pairs have the same.
        tolerances: Span<BodyTolerance>,
        /// The least part of a pair's extent that the solver resolves.
        finest: f64,
    }
    /// Pairs of one kind for a rung, and its output lists.
    Listed {
        /// Pairs; empty if `begun` has them.
        pairs: Output<Pair>,
        /// With a separation: pairs with the time that f32 has proven. Out in f32, in in f64; empty
        /// if f64 is alone. Out of `narrow_approach_signs` and `_exact`, in of `_advance`: pairs with
        /// a time before which they do not come nearer.
        begun: Output<Begun>,
        /// Out: contacts and undecided pairs; empty if only the earliest is wanted.
        hits: Output<Hit>,
        /// Out: pairs for the next rung; empty without one.
        left: Output<Pair>,
    }
    /// `narrow_isolate`, `narrow_settle`, `narrow_slice`, `narrow_separate`: the pairs that meet,
    /// and bounds of the first time, with proof.
    RungArgs<R: Real> {
        /// Positions.
        frames: Positions<R>,
        /// Vertex indices of every triangle.
        faces: Span<[u32; 3]>,
        /// End points of every edge.
        edges: Span<[u32; 2]>,
        /// Vertex/face pairs.
        vf: Listed,
        /// Edge/edge pairs.
        ee: Listed,
        /// Out: vertex/face pairs to settle, from a long list in f64. Or those for the next launch of
        /// `narrow_approach`.
        vf_asked: Output<Pair>,
        /// Out: edge/edge pairs to settle, or for that launch.
        ee_asked: Output<Pair>,
        /// Out: the least toi so far, the words of [`super::earliest`]; or empty.
        earliest: Span<u64>,
        /// Counters.
        counters: Counters,
        /// The tolerances of bodies, by their first vertices; empty if all pairs have that of
        /// `params`.
        tolerances: Span<BodyTolerance>,
        /// Parameters of the query.
        params: Params,
        /// Flags of the rung.
        flags: RungFlags,
        /// Zero.
        pad: u32,
    }
    /// `narrow_part`, `narrow_separate_thick`: the pairs that come within a separation and their radii.
    /// `narrow_approach`, `narrow_approach_signs`, `narrow_approach_exact`,
    /// `narrow_approach_advance`: those that come nearer than at the start.
    ThickRungArgs<R: Real> {
        /// Pairs, lists, parameters.
        rung: RungArgs<R>,
        /// The thickness of every vertex.
        radii: Span<f64>,
    }
    /// `narrow_turning_common`, `narrow_turning`: the pairs of bodies that turn, in f64.
    TurningArgs {
        /// Pairs, lists, parameters. The second kernel leaves no pair.
        rung: RungArgs<f64>,
        /// Vertices of rigid bodies, as they are without a pose.
        rest: Span<Point<f64>>,
    }
}
