//! The kernels for positions in f32, and those for f64.

use crate::mesh::Positions;
use nearmiss_kernels::abi::{
    AnswerGeometryArgs, BelowPrecisionArgs, CullArgs, CutArgs, DiscreteArgs, FeaturesArgs, FirstPairsArgs,
    Hit, LeastArgs, MeshVerticesArgs, MortonArgs, NearArgs, NearExcludingArgs, NearHit, PlaceArgs, Point,
    Positions as Frames, RungArgs, SolveArgs, Span, StartsArgs, ThickNearArgs, ThickRungArgs,
};
use nearmiss_kernels::entry::{self, Entry};
use nearmiss_kernels::math::{Real, Vec3};

/// A precision of positions, with its kernels.
pub trait Precision: Real + Send {
    /// Places the vertices of moved bodies.
    type Place: Entry<Args = PlaceArgs<Self>>;
    /// Copies positions at the start of the step.
    type Starts: Entry<Args = StartsArgs<Self>>;
    /// Computes the box of the triangle centres.
    type Bounds: Entry<Args = MortonArgs<Self>>;
    /// Computes codes of the triangle centres.
    type Morton: Entry<Args = MortonArgs<Self>>;
    /// Cuts runs into halves of halves.
    type Runs: Entry<Args = CutArgs<Self>>;
    /// The discrete test of Möller (1997), in floating point.
    type Moller: Entry<Args = DiscreteArgs<Self>>;
    /// The discrete filter.
    type Filter: Entry<Args = DiscreteArgs<Self>>;
    /// The discrete filter in f64, if positions are f32.
    type Wide: Entry<Args = DiscreteArgs<Self>>;
    /// Whether positions are f32: otherwise that kernel is not launched.
    const WIDENS: bool;
    /// The exact signs.
    type Exact: Entry<Args = DiscreteArgs<Self>>;
    /// The discrete filter at the start of a step.
    type StartFilter: Entry<Args = DiscreteArgs<Self>>;
    /// The same filter in f64, if positions are f32.
    type StartWide: Entry<Args = DiscreteArgs<Self>>;
    /// The exact signs at the start of a step.
    type StartExact: Entry<Args = DiscreteArgs<Self>>;
    /// Turns triangle pairs into pairs of features whose boxes meet.
    type Features: Entry<Args = FeaturesArgs<Self>>;
    /// The same of those that meet before a horizon.
    type FeaturesBefore: Entry<Args = FeaturesArgs<Self>>;
    /// The same for triangles at one time.
    type FeaturesAtRest: Entry<Args = FeaturesArgs<Self>>;
    /// Finds pairs of features within a distance, at one time.
    type Near: Entry<Args = NearArgs<Self>>;
    /// The same without pairs that the scene excludes.
    type NearExcluding: Entry<Args = NearExcludingArgs<Self>>;
    /// [`Precision::FeaturesAtRest`] for vertices with a thickness.
    type ThickAtRest: Entry<Args = FeaturesArgs<Self>>;
    /// Finds pairs of thick features within a distance, at one time, as far as corners decide.
    type ThickNear: Entry<Args = ThickNearArgs<Self>>;
    /// Finds them among the pairs that corners leave open.
    type OpenNear: Entry<Args = ThickNearArgs<Self>>;
    /// Turns triangle pairs into pairs of thick features whose boxes meet in a step.
    type ThickFeatures: Entry<Args = FeaturesArgs<Self>>;
    /// Copies vertices to the meshes of deformable bodies.
    type MeshVertices: Entry<Args = MeshVerticesArgs<Self>>;
    /// Finds the least distance of triangles.
    type Least: Entry<Args = LeastArgs<Self>>;
    /// Finds the first pair at that distance.
    type Witness: Entry<Args = LeastArgs<Self>>;
    /// Finds the nearest points of that pair.
    type Nearest: Entry<Args = LeastArgs<Self>>;
    /// Keeps pairs that may meet.
    type Cull: Entry<Args = CullArgs<Self>>;
    /// Keeps tested pairs that may begin at the earliest time.
    type FirstPairs: Entry<Args = FirstPairsArgs<Self>>;
    /// Vertex/face by the cubic in f32.
    type Vf32: Entry<Args = SolveArgs<Self>>;
    /// Vertex/face by the cubic in f64.
    type Vf64: Entry<Args = SolveArgs<Self>>;
    /// Edge/edge by the cubic in f32.
    type Ee32: Entry<Args = SolveArgs<Self>>;
    /// Edge/edge by the cubic in f64.
    type Ee64: Entry<Args = SolveArgs<Self>>;
    /// Counts listed pairs that are too large for the tolerance.
    type BelowPrecision: Entry<Args = BelowPrecisionArgs<Self>>;
    /// Geometry of contacts.
    type GeometryOfHits: Entry<Args = AnswerGeometryArgs<Self, Hit>>;
    /// Geometry of near pairs.
    type GeometryOfNear: Entry<Args = AnswerGeometryArgs<Self, NearHit>>;
    /// Pairs that may be near at the start.
    type Approach: Entry<Args = ThickRungArgs<Self>>;
    /// Those that come nearer than at the start, by bounds of errors.
    type ApproachSigns: Entry<Args = ThickRungArgs<Self>>;
    /// The same in integers, of pairs left uncertain.
    type ApproachExact: Entry<Args = ThickRungArgs<Self>>;
    /// Times at which others do, by advancement.
    type ApproachAdvance: Entry<Args = ThickRungArgs<Self>>;
    /// Isolation of roots in f32.
    type Isolate32: Entry<Args = RungArgs<Self>>;
    /// Isolation of roots in f64.
    type Isolate64: Entry<Args = RungArgs<Self>>;
    /// Touching at the start, and flat motion.
    type Settle: Entry<Args = RungArgs<Self>>;
    /// Solves the remaining pairs in slices.
    type Slice: Entry<Args = RungArgs<Self>>;
    /// Separation, in f32.
    type Separate32: Entry<Args = RungArgs<Self>>;
    /// Separation, in f64.
    type Separate64: Entry<Args = RungArgs<Self>>;
    /// Separation by the largest radius, in f32: parts pairs of features whose radii differ.
    type Part: Entry<Args = ThickRungArgs<Self>>;
    /// Separation of features whose radii differ.
    type SeparateThick: Entry<Args = ThickRungArgs<Self>>;

    /// Returns positions in this precision, exactly: f32 is only used if all bodies are f32.
    fn points(positions: &Positions) -> impl Iterator<Item = Vec3<Self>>;

    /// Returns positions and points of rigid bodies in f64; none in f32, in which no scene with a
    /// rigid body is.
    fn in_f64(frames: Frames<Self>, rest: Span<Point<Self>>) -> (Frames<f64>, Span<Point<f64>>);

    /// Returns positions and points of rigid bodies from f64; none in f32.
    fn of_f64(frames: Frames<f64>, rest: Span<Point<f64>>) -> (Frames<Self>, Span<Point<Self>>);

    /// Returns points of this precision as positions.
    fn positions(points: Vec<Vec3<Self>>) -> Positions;
}

impl Precision for f32 {
    type Place = entry::place_f32;
    type Starts = entry::place_starts_f32;
    type Bounds = entry::construct_bounds_f32;
    type Morton = entry::construct_morton_f32;
    type Runs = entry::construct_runs_f32;
    type Moller = entry::narrow_moller_f32;
    type Filter = entry::narrow_filter_f32;
    type Wide = entry::narrow_wide_f32;
    const WIDENS: bool = true;
    type Exact = entry::narrow_exact_f32;
    type StartFilter = entry::narrow_start_filter_f32;
    type StartWide = entry::narrow_start_wide_f32;
    type StartExact = entry::narrow_start_exact_f32;
    type Features = entry::narrow_features_f32;
    type FeaturesBefore = entry::narrow_features_before_f32;
    type FeaturesAtRest = entry::narrow_features_at_rest_f32;
    type Near = entry::narrow_near_f32;
    type NearExcluding = entry::narrow_near_excluding_f32;
    type ThickAtRest = entry::narrow_features_thick_at_rest_f32;
    type ThickNear = entry::narrow_near_thick_f32;
    type OpenNear = entry::narrow_near_open_f32;
    type ThickFeatures = entry::narrow_features_thick_f32;
    type MeshVertices = entry::refit_meshes_vertices_f32;
    type Least = entry::narrow_least_f32;
    type Witness = entry::narrow_witness_f32;
    type Nearest = entry::narrow_nearest_f32;
    type Cull = entry::narrow_cull_f32;
    type FirstPairs = entry::narrow_first_pairs_f32;
    type Vf32 = entry::narrow_vf_f32_f32;
    type Vf64 = entry::narrow_vf_f32_f64;
    type Ee32 = entry::narrow_ee_f32_f32;
    type Ee64 = entry::narrow_ee_f32_f64;
    type BelowPrecision = entry::narrow_below_precision_f32;
    type Isolate32 = entry::narrow_isolate_f32_f32;
    type Isolate64 = entry::narrow_isolate_f32_f64;
    type Settle = entry::narrow_settle_f32;
    type Slice = entry::narrow_slice_f32;
    type GeometryOfHits = entry::answer_geometry_hit_f32;
    type GeometryOfNear = entry::answer_geometry_near_f32;
    type Approach = entry::narrow_approach_f32;
    type ApproachSigns = entry::narrow_approach_signs_f32;
    type ApproachExact = entry::narrow_approach_exact_f32;
    type ApproachAdvance = entry::narrow_approach_advance_f32;
    type Separate32 = entry::narrow_separate_f32_f32;
    type Separate64 = entry::narrow_separate_f32_f64;
    type Part = entry::narrow_part_f32;
    type SeparateThick = entry::narrow_separate_thick_f32;

    fn points(positions: &Positions) -> impl Iterator<Item = Vec3<f32>> {
        let (singles, doubles): (&[[f32; 3]], &[[f64; 3]]) = match positions {
            Positions::F32(points) => (points, &[]),
            Positions::F64(points) => (&[], points),
        };
        singles.iter().map(|&p| Vec3(p)).chain(doubles.iter().map(|p| Vec3(p.map(|x| x as f32))))
    }

    fn in_f64(_: Frames<f32>, _: Span<Point<f32>>) -> (Frames<f64>, Span<Point<f64>>) {
        (Frames { still: Span::EMPTY, moving: Span::EMPTY, turns: Span::EMPTY }, Span::EMPTY)
    }

    fn of_f64(_: Frames<f64>, _: Span<Point<f64>>) -> (Frames<f32>, Span<Point<f32>>) {
        (Frames { still: Span::EMPTY, moving: Span::EMPTY, turns: Span::EMPTY }, Span::EMPTY)
    }

    fn positions(points: Vec<Vec3<f32>>) -> Positions {
        Positions::F32(points.into_iter().map(|p| p.0).collect())
    }
}

impl Precision for f64 {
    type Place = entry::place_f64;
    type Starts = entry::place_starts_f64;
    type Bounds = entry::construct_bounds_f64;
    type Morton = entry::construct_morton_f64;
    type Runs = entry::construct_runs_f64;
    type Moller = entry::narrow_moller_f64;
    type Filter = entry::narrow_filter_f64;
    type Wide = entry::narrow_filter_f64;
    const WIDENS: bool = false;
    type Exact = entry::narrow_exact_f64;
    type StartFilter = entry::narrow_start_filter_f64;
    type StartWide = entry::narrow_start_filter_f64;
    type StartExact = entry::narrow_start_exact_f64;
    type Features = entry::narrow_features_f64;
    type FeaturesBefore = entry::narrow_features_before_f64;
    type FeaturesAtRest = entry::narrow_features_at_rest_f64;
    type Near = entry::narrow_near_f64;
    type NearExcluding = entry::narrow_near_excluding_f64;
    type ThickAtRest = entry::narrow_features_thick_at_rest_f64;
    type ThickNear = entry::narrow_near_thick_f64;
    type OpenNear = entry::narrow_near_open_f64;
    type ThickFeatures = entry::narrow_features_thick_f64;
    type MeshVertices = entry::refit_meshes_vertices_f64;
    type Least = entry::narrow_least_f64;
    type Witness = entry::narrow_witness_f64;
    type Nearest = entry::narrow_nearest_f64;
    type Cull = entry::narrow_cull_f64;
    type FirstPairs = entry::narrow_first_pairs_f64;
    type Vf32 = entry::narrow_vf_f64_f32;
    type Vf64 = entry::narrow_vf_f64_f64;
    type Ee32 = entry::narrow_ee_f64_f32;
    type Ee64 = entry::narrow_ee_f64_f64;
    type BelowPrecision = entry::narrow_below_precision_f64;
    type Isolate32 = entry::narrow_isolate_f64_f32;
    type Isolate64 = entry::narrow_isolate_f64_f64;
    type Settle = entry::narrow_settle_f64;
    type Slice = entry::narrow_slice_f64;
    type GeometryOfHits = entry::answer_geometry_hit_f64;
    type GeometryOfNear = entry::answer_geometry_near_f64;
    type Approach = entry::narrow_approach_f64;
    type ApproachSigns = entry::narrow_approach_signs_f64;
    type ApproachExact = entry::narrow_approach_exact_f64;
    type ApproachAdvance = entry::narrow_approach_advance_f64;
    type Separate32 = entry::narrow_separate_f64_f32;
    type Separate64 = entry::narrow_separate_f64_f64;
    type Part = entry::narrow_part_f64;
    type SeparateThick = entry::narrow_separate_thick_f64;

    fn points(positions: &Positions) -> impl Iterator<Item = Vec3<f64>> {
        let (singles, doubles): (&[[f32; 3]], &[[f64; 3]]) = match positions {
            Positions::F32(points) => (points, &[]),
            Positions::F64(points) => (&[], points),
        };
        singles.iter().map(|p| Vec3(p.map(f64::from))).chain(doubles.iter().map(|&p| Vec3(p)))
    }

    fn in_f64(frames: Frames<f64>, rest: Span<Point<f64>>) -> (Frames<f64>, Span<Point<f64>>) {
        (frames, rest)
    }

    fn of_f64(frames: Frames<f64>, rest: Span<Point<f64>>) -> (Frames<f64>, Span<Point<f64>>) {
        (frames, rest)
    }

    fn positions(points: Vec<Vec3<f64>>) -> Positions {
        Positions::F64(points.into_iter().map(|p| p.0).collect())
    }
}
