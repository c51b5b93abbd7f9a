//! The kernel table: one line an entry, or one for an entry of every volume. The PTX entries and
//! the host's list come from the same line.

/// The entries of the PTX: of a type that is the kernel, and its name.
#[cfg(target_arch = "nvptx64")]
macro_rules! entries {
    ($($kernel:ty, $name:expr;)*) => { $(
        const _: () = {
            // SAFETY: called by the driver, once a thread, with arguments of the size in TABLE.
            #[unsafe(export_name = $name)]
            unsafe extern "ptx-kernel" fn entry(args: <$kernel as Entry>::Args) {
                // SAFETY: the one block of this kernel, made at its start; the host launches it
                // with as many lanes.
                let mut block = unsafe { crate::exec::ptx::Gpu::<{ <$kernel as Entry>::LANES }>::new() };
                <$kernel as Entry>::run(&mut block, &args);
            }
        };
    )* };
}
#[cfg(not(target_arch = "nvptx64"))]
macro_rules! entries {
    ($($kernel:ty, $name:expr;)*) => {};
}

mod lanes;
#[macro_use]
mod macros;
mod name;

use crate::abi::*;
use crate::bv::{self, Contain};
use crate::bvh::centres;
use crate::bvh::course::{Moves, Rests, ThickMoves, ThickRests};
use crate::exec::Block;
use crate::math::Real;
use crate::prim::isolate::ladder::SLICES;
use crate::queue::worker;
use crate::sort;
use crate::stage::construct::{cuts, graft, morton, tile_filters, tree, treelet};
use crate::stage::fit::{
    bodies as fit_of_bodies, leaves as fit_of_leaves, moving_bodies, rims, tiles as fit_of_tiles,
};
use crate::stage::narrow::discrete::{Start, Still};
use crate::stage::narrow::placed::Placed;
use crate::stage::narrow::{
    abreast, approach, below_precision, bodies as narrow_bodies, certain, climb, cull, discrete, divide,
    divide_thick, exclude, features, first, near, nearest, separate, slice, solve, turning,
};
use crate::stage::refit::{levels, meshes as refit_of_meshes, tiles as refit_of_tiles, treelets};
use crate::stage::traverse::instances::{
    nodes, relations, touching, triangles as instance_triangles, vertices, within,
};
use crate::stage::traverse::{
    front, left_out, nearest as nearest_first, per_leaf, queue, steal, tile_triangles, tiles as tile_pairs,
};
use crate::stage::{answer, balance, order, place, starts, status, turns};
use bytemuck::NoUninit;
use core::marker::PhantomData;
use lanes::{BALANCE, NARROW, RUNG, SPREAD, WIDE};
use name::{Name, precision};

/// A kernel, for the host.
pub trait Entry: 'static {
    /// The name of the PTX entry, of the profiler's row and of this type: stage and step.
    const NAME: &'static str;
    /// Launch arguments.
    type Args: NoUninit + Send + Sync;
    /// Lanes of a block.
    const LANES: u32;
    /// Whether it works with no other number of lanes.
    const EXACT: bool = false;
    /// Bytes of shared memory of a block.
    const SHARED: u32;
    /// Most registers of a lane: fewer than the compiler would take, so that more warps are
    /// resident. `None` sets no limit.
    const REGISTERS: Option<u32> = None;
    /// Its place in [`TABLE`]; none of kernels that are not in it, as tests have.
    const PLACE: Option<usize> = None;
    /// The kernel itself.
    fn run<B: Block>(block: &mut B, args: &Self::Args);
}

/// Something that is done with every kernel of the table.
pub trait Visit {
    /// Does it.
    fn kernel<E: Entry>(&mut self);
}

/// A volume that has kernels: [`crate::volumes`] lists them.
pub trait Kernels: Contain {
    /// Its part of their names.
    const NAME: &'static str;
}

/// A line of the table: name, and bytes of the arguments.
type Line = (&'static str, usize);

const fn line<E: Entry>() -> Line {
    (E::NAME, size_of::<E::Args>())
}

/// Which sources this PTX came from; the host refuses another.
#[cfg(target_arch = "nvptx64")]
#[unsafe(no_mangle)]
pub static NEARMISS_STAMP: u64 = stamp::SOURCES;

/// Puts lines into the table; returns their end.
const fn put(all: &mut [Line], at: usize, lines: &[Line]) -> usize {
    let mut i = 0;
    while i < lines.len() {
        all[at + i] = lines[i];
        i += 1;
    }
    at + lines.len()
}

kernels! {
    place_f32: place::place::<f32, B>, [PlaceArgs<f32>], WIDE, place::SHARED;
    place_f64: place::place::<f64, B>, [PlaceArgs<f64>], WIDE, place::SHARED;
    place_starts_f32: starts::starts::<f32, B>, [StartsArgs<f32>], WIDE, 0;
    place_starts_f64: starts::starts::<f64, B>, [StartsArgs<f64>], WIDE, 0;
    place_turns: turns::turns, [TurnsArgs], NARROW, 0;
    place_poses: place::poses::poses, [PlacePosesArgs], NARROW, place::SHARED;
    construct_bounds_f32: morton::bounds::<f32, B>, [MortonArgs<f32>], WIDE, centres::shared_bytes(WIDE);
    construct_bounds_f64: morton::bounds::<f64, B>, [MortonArgs<f64>], WIDE, centres::shared_bytes(WIDE);
    construct_morton_f32: morton::morton::<f32, B>, [MortonArgs<f32>], WIDE, 0;
    construct_morton_f64: morton::morton::<f64, B>, [MortonArgs<f64>], WIDE, 0;
    construct_runs_f32: cuts::runs::<f32, B>, [CutArgs<f32>], cuts::LANES, cuts::shared_bytes(cuts::LANES);
    construct_runs_f64: cuts::runs::<f64, B>, [CutArgs<f64>], cuts::LANES, cuts::shared_bytes(cuts::LANES);
    construct_tree: tree::tree, [TreeArgs], WIDE, 0;
    construct_depth: tree::depth, [TreeArgs], WIDE, 0;
    construct_places: tree::places, [TreeArgs], WIDE, sort::shared_bytes(WIDE);
    construct_emit: tree::emit, [TreeArgs], WIDE, 0;
    construct_tile_filters: tile_filters::filters, [TileFiltersArgs], WIDE, 0;
    construct_treelets: treelet::plan, [PlanArgs], WIDE, treelet::SHARED;
    fit_bodies: fit_of_bodies::bodies, [BodiesArgs], fit_of_tiles::LANES, fit_of_tiles::shared_bytes::<bv::FrameBox>(), exact = true;
    traverse_left_out: left_out::left_out, [LeftOutArgs], WIDE, 0;
    traverse_relations: relations::relations, [RelationsArgs], NARROW, 0;
    traverse_nodes: nodes::nodes, [NodesArgs], nodes::LANES, nodes::SHARED, exact = true;
    traverse_instances: instance_triangles::candidates, [InstancesArgs], instance_triangles::LANES, instance_triangles::SHARED, exact = true;
    fit_moving_bodies: moving_bodies::bodies, [MovingBodiesArgs], fit_of_tiles::LANES, fit_of_tiles::shared_bytes::<bv::FrameBox>(), exact = true, registers = 128;
    traverse_moving_relations: relations::moving_relations, [MovingRelationsArgs], NARROW, 0;
    traverse_moving_nodes: nodes::moving_nodes, [MovingNodesArgs], nodes::LANES, nodes::SHARED, exact = true;
    traverse_moving_instances: instance_triangles::moving_candidates, [MovingInstancesArgs], instance_triangles::LANES, instance_triangles::SHARED_MOVING, exact = true;
    traverse_vertices: vertices::vertices, [CandidateVerticesArgs], WIDE, 0;
    traverse_touching: touching::touching, [TouchingArgs], instance_triangles::LANES, touching::SHARED, exact = true;
    traverse_relations_within: relations::relations_within, [RelationsWithinArgs], NARROW, 0;
    traverse_nodes_within: nodes::nodes_within, [NodesWithinArgs], nodes::LANES, nodes::SHARED_WITHIN, exact = true;
    traverse_bounds: within::bounds, [NodesWithinArgs], NARROW, 0;
    traverse_corners: within::corners, [InstancesWithinArgs], within::LANES, within::SHARED_CORNERS, exact = true;
    traverse_instances_within: within::candidates, [InstancesWithinArgs], within::LANES, within::SHARED, exact = true;
    refit_meshes_vertices_f32: refit_of_meshes::vertices::<f32, B>, [MeshVerticesArgs<f32>], WIDE, 0;
    refit_meshes_vertices_f64: refit_of_meshes::vertices::<f64, B>, [MeshVerticesArgs<f64>], WIDE, 0;
    refit_meshes_corners: refit_of_meshes::corners, [MeshRefitArgs], WIDE, 0;
    refit_meshes_spread: refit_of_meshes::spread, [MeshSpreadArgs], WIDE, 0;
    refit_meshes_swept: refit_of_meshes::swept, [MeshSweptArgs], WIDE, 0;
    refit_meshes_nodes: refit_of_meshes::nodes, [MeshRefitArgs], NARROW, 0;
    refit_meshes_records: refit_of_meshes::records, [MeshRefitArgs], NARROW, 0;
    balance_copy: balance::copy, [BalanceArgs], BALANCE, 0;
    narrow_moller_f32: discrete::moller::<f32, B>, [DiscreteArgs<f32>], WIDE, 0;
    narrow_moller_f64: discrete::moller::<f64, B>, [DiscreteArgs<f64>], WIDE, 0;
    narrow_filter_f32: discrete::filter::<f32, Still, B>, [DiscreteArgs<f32>], WIDE, discrete::shared_bytes(WIDE), registers = 64;
    narrow_filter_f64: discrete::filter::<f64, Still, B>, [DiscreteArgs<f64>], WIDE, discrete::shared_bytes(WIDE);
    narrow_wide_f32: certain::wide::<Still, B>, [DiscreteArgs<f32>], NARROW, certain::SHARED;
    narrow_exact_f32: certain::exact::<f32, Still, B>, [DiscreteArgs<f32>], NARROW, certain::SHARED;
    narrow_exact_f64: certain::exact::<f64, Still, B>, [DiscreteArgs<f64>], NARROW, certain::SHARED;
    narrow_filter_placed: discrete::filter::<f64, Placed, B>, [PlacedArgs], WIDE, 0;
    narrow_exact_placed: certain::exact::<f64, Placed, B>, [PlacedArgs], NARROW, certain::SHARED;
    narrow_start_filter_f32: discrete::filter::<f32, Start, B>, [DiscreteArgs<f32>], WIDE, discrete::shared_bytes(WIDE), registers = 64;
    narrow_start_filter_f64: discrete::filter::<f64, Start, B>, [DiscreteArgs<f64>], WIDE, discrete::shared_bytes(WIDE), registers = 128;
    narrow_start_wide_f32: certain::wide::<Start, B>, [DiscreteArgs<f32>], NARROW, certain::SHARED;
    narrow_start_exact_f32: certain::exact::<f32, Start, B>, [DiscreteArgs<f32>], NARROW, certain::SHARED;
    narrow_start_exact_f64: certain::exact::<f64, Start, B>, [DiscreteArgs<f64>], NARROW, certain::SHARED;
    narrow_features_f32: features::features::<f32, Moves, false, B>, [FeaturesArgs<f32>], features::LANES, features::shared_bytes(features::LANES), registers = 88;
    narrow_features_before_f32: features::features::<f32, Moves, true, B>, [FeaturesArgs<f32>], features::LANES, features::shared_bytes(features::LANES), registers = 88;
    narrow_features_f64: features::features::<f64, Moves, false, B>, [FeaturesArgs<f64>], features::LANES, features::shared_bytes(features::LANES);
    narrow_features_before_f64: features::features::<f64, Moves, true, B>, [FeaturesArgs<f64>], features::LANES, features::shared_bytes(features::LANES);
    narrow_features_at_rest_f32: features::features::<f32, Rests, false, B>, [FeaturesArgs<f32>], features::LANES, features::shared_bytes(features::LANES), registers = 72;
    narrow_features_at_rest_f64: features::features::<f64, Rests, false, B>, [FeaturesArgs<f64>], features::LANES, features::shared_bytes(features::LANES);
    narrow_features_thick_f32: features::features::<f32, ThickMoves, false, B>, [FeaturesArgs<f32>], features::LANES, features::shared_bytes(features::LANES), registers = 88;
    narrow_features_thick_f64: features::features::<f64, ThickMoves, false, B>, [FeaturesArgs<f64>], features::LANES, features::shared_bytes(features::LANES);
    narrow_features_thick_at_rest_f32: features::features::<f32, ThickRests, false, B>, [FeaturesArgs<f32>], features::LANES, features::shared_bytes(features::LANES), registers = 72;
    narrow_features_thick_at_rest_f64: features::features::<f64, ThickRests, false, B>, [FeaturesArgs<f64>], features::LANES, features::shared_bytes(features::LANES);
    narrow_cull_f32: cull::cull::<false, f32, B>, [CullArgs<f32>], RUNG, 0;
    narrow_cull_f64: cull::cull::<false, f64, B>, [CullArgs<f64>], RUNG, 0;
    narrow_vf_f32_f32: solve::vf::<f32, f32, B>, [SolveArgs<f32>], WIDE, 0;
    narrow_vf_f32_f64: solve::vf::<f32, f64, B>, [SolveArgs<f32>], WIDE, 0;
    narrow_vf_f64_f32: solve::vf::<f64, f32, B>, [SolveArgs<f64>], WIDE, 0;
    narrow_vf_f64_f64: solve::vf::<f64, f64, B>, [SolveArgs<f64>], WIDE, 0;
    narrow_ee_f32_f32: solve::ee::<f32, f32, B>, [SolveArgs<f32>], WIDE, 0;
    narrow_ee_f32_f64: solve::ee::<f32, f64, B>, [SolveArgs<f32>], WIDE, 0;
    narrow_ee_f64_f32: solve::ee::<f64, f32, B>, [SolveArgs<f64>], WIDE, 0;
    narrow_ee_f64_f64: solve::ee::<f64, f64, B>, [SolveArgs<f64>], WIDE, 0;
    narrow_below_precision_f32: below_precision::below_precision::<f32, B>, [BelowPrecisionArgs<f32>], WIDE, 0;
    narrow_below_precision_f64: below_precision::below_precision::<f64, B>, [BelowPrecisionArgs<f64>], WIDE, 0;
    narrow_isolate_f32_f32: climb::isolate::<f32, B>, [RungArgs<f32>], NARROW, 0, registers = 112;
    narrow_isolate_f32_f64: climb::isolate_and_settle::<f32, B>, [RungArgs<f32>], SPREAD, 0;
    narrow_isolate_f64_f32: climb::isolate::<f64, B>, [RungArgs<f64>], NARROW, 0;
    narrow_isolate_f64_f64: climb::isolate_and_settle::<f64, B>, [RungArgs<f64>], SPREAD, 0;
    narrow_settle_f32: climb::settle::<f32, B>, [RungArgs<f32>], NARROW, 0;
    narrow_settle_f64: climb::settle::<f64, B>, [RungArgs<f64>], NARROW, 0;
    narrow_slice_f32: slice::slice::<f32, B>, [RungArgs<f32>], SLICES, slice::SHARED;
    narrow_slice_f64: slice::slice::<f64, B>, [RungArgs<f64>], SLICES, slice::SHARED;
    narrow_separate_f32_f32: abreast::abreast::<f32, B>, [RungArgs<f32>], RUNG, abreast::shared_bytes(RUNG), registers = 128;
    narrow_separate_f32_f64: separate::separate::<f32, B>, [RungArgs<f32>], RUNG, separate::shared_bytes(RUNG);
    narrow_separate_f64_f32: abreast::abreast::<f64, B>, [RungArgs<f64>], RUNG, abreast::shared_bytes(RUNG);
    narrow_separate_f64_f64: separate::separate::<f64, B>, [RungArgs<f64>], RUNG, separate::shared_bytes(RUNG);
    narrow_part_f32: abreast::part::<f32, B>, [ThickRungArgs<f32>], RUNG, abreast::shared_bytes(RUNG), registers = 128;
    narrow_part_f64: abreast::part::<f64, B>, [ThickRungArgs<f64>], RUNG, abreast::shared_bytes(RUNG);
    narrow_separate_thick_f32: separate::thick::<f32, B>, [ThickRungArgs<f32>], RUNG, separate::shared_bytes(RUNG);
    narrow_separate_thick_f64: separate::thick::<f64, B>, [ThickRungArgs<f64>], RUNG, separate::shared_bytes(RUNG);
    narrow_approach_f32: approach::approach::<f32, B>, [ThickRungArgs<f32>], RUNG, 0, registers = 64;
    narrow_approach_f64: approach::approach::<f64, B>, [ThickRungArgs<f64>], RUNG, 0;
    narrow_approach_signs_f32: approach::signs::<f32, B>, [ThickRungArgs<f32>], SPREAD, 0;
    narrow_approach_signs_f64: approach::signs::<f64, B>, [ThickRungArgs<f64>], SPREAD, 0;
    narrow_approach_exact_f32: approach::exact::<f32, B>, [ThickRungArgs<f32>], SPREAD, 0;
    narrow_approach_exact_f64: approach::exact::<f64, B>, [ThickRungArgs<f64>], SPREAD, 0;
    narrow_approach_advance_f32: approach::advance::<f32, B>, [ThickRungArgs<f32>], SPREAD, 0;
    narrow_approach_advance_f64: approach::advance::<f64, B>, [ThickRungArgs<f64>], SPREAD, 0;
    narrow_first_pairs_f32: first::pairs::<f32, B>, [FirstPairsArgs<f32>], RUNG, 0;
    narrow_first_pairs_f64: first::pairs::<f64, B>, [FirstPairsArgs<f64>], RUNG, 0;
    narrow_first_hits: first::hits, [FirstHitsArgs], NARROW, 0;
    narrow_divide: divide::divide, [DivideArgs], RUNG, 0;
    narrow_divide_thick: divide_thick::divide, [DivideThickArgs], WIDE, 0;
    narrow_sift_thick: divide_thick::sift, [SiftThickArgs], WIDE, 0;
    narrow_turning_chords: turning::features::chords, [TurningFeaturesArgs], turning::features::LANES, turning::features::SHARED_OF_CHORDS;
    narrow_turning_features: turning::features::features, [TurningFeaturesArgs], turning::features::LANES, turning::features::SHARED;
    narrow_turning_common: turning::common, [TurningArgs], SPREAD, 0;
    narrow_turning: turning::solve, [TurningArgs], SPREAD, 0;
    narrow_near_f32: near::near::<f32, B>, [NearArgs<f32>], RUNG, 0, registers = 64;
    narrow_near_f64: near::near::<f64, B>, [NearArgs<f64>], RUNG, 0;
    narrow_near_thick_f32: near::thick::thick::<f32, B>, [ThickNearArgs<f32>], RUNG, 0, registers = 80;
    narrow_near_thick_f64: near::thick::thick::<f64, B>, [ThickNearArgs<f64>], RUNG, 0;
    narrow_near_open_f32: near::thick::open::<f32, B>, [ThickNearArgs<f32>], RUNG, 0;
    narrow_near_open_f64: near::thick::open::<f64, B>, [ThickNearArgs<f64>], RUNG, 0;
    narrow_near_excluding_f32: near::near_excluding::<f32, B>, [NearExcludingArgs<f32>], near::LANES, near::SHARED, registers = 64;
    narrow_near_excluding_f64: near::near_excluding::<f64, B>, [NearExcludingArgs<f64>], near::LANES, near::SHARED;
    narrow_exclude: exclude::exclude, [ExcludeArgs], RUNG, 0;
    narrow_exclude_triangles: exclude::exclude_triangles, [ExcludeTrianglesArgs], NARROW, 0;
    narrow_least_f32: nearest::least::<f32, B>, [LeastArgs<f32>], RUNG, 0;
    narrow_least_f64: nearest::least::<f64, B>, [LeastArgs<f64>], RUNG, 0;
    narrow_witness_f32: nearest::witness::<f32, B>, [LeastArgs<f32>], RUNG, 0;
    narrow_witness_f64: nearest::witness::<f64, B>, [LeastArgs<f64>], RUNG, 0;
    narrow_bodies_exact: narrow_bodies::exact, [BodiesNarrowArgs], NARROW, 0;
    narrow_bodies_meeting: narrow_bodies::meeting, [BodiesNarrowArgs], WIDE, 0;
    narrow_bodies_least: narrow_bodies::least, [BodiesNarrowArgs], RUNG, 0;
    narrow_bodies_first: narrow_bodies::first, [BodiesNarrowArgs], RUNG, 0;
    narrow_bodies_nearest: narrow_bodies::nearest, [BodiesNarrowArgs], RUNG, 0;
    narrow_nearest_f32: nearest::nearest::<f32, B>, [LeastArgs<f32>], NARROW, 0;
    narrow_nearest_f64: nearest::nearest::<f64, B>, [LeastArgs<f64>], NARROW, 0;
    order_count_pair: order::count::count::<Pair, B>, [OrderArgs<Pair>], WIDE, 0;
    order_count_hit: order::count::count::<Hit, B>, [OrderArgs<Hit>], WIDE, 0;
    order_count_near: order::count::count::<NearHit, B>, [OrderArgs<NearHit>], WIDE, 0;
    order_sums: order::starts::sums, [Bins], WIDE, 0;
    order_starts: order::starts::starts, [Bins], WIDE, 0;
    order_place_pair: order::rank::place::<Pair, B>, [OrderArgs<Pair>], WIDE, 0;
    order_place_hit: order::rank::place::<Hit, B>, [OrderArgs<Hit>], WIDE, 0;
    order_place_near: order::rank::place::<NearHit, B>, [OrderArgs<NearHit>], WIDE, 0;
    order_merge_pair: order::rank::merge::<Pair, B>, [OrderArgs<Pair>], WIDE, 0;
    order_merge_hit: order::rank::merge::<Hit, B>, [OrderArgs<Hit>], WIDE, 0;
    order_merge_near: order::rank::merge::<NearHit, B>, [OrderArgs<NearHit>], WIDE, 0;
    order_rank_pair: order::rank::rank::<Pair, B>, [OrderArgs<Pair>], WIDE, 0;
    order_rank_hit: order::rank::rank::<Hit, B>, [OrderArgs<Hit>], WIDE, 0;
    order_rank_near: order::rank::rank::<NearHit, B>, [OrderArgs<NearHit>], WIDE, 0;
    answer_geometry_hit_f32: answer::geometry::geometry::<f32, Hit, B>, [AnswerGeometryArgs<f32, Hit>], NARROW, 0;
    answer_geometry_hit_f64: answer::geometry::geometry::<f64, Hit, B>, [AnswerGeometryArgs<f64, Hit>], NARROW, 0;
    answer_geometry_near_f32: answer::geometry::geometry::<f32, NearHit, B>, [AnswerGeometryArgs<f32, NearHit>], NARROW, 0;
    answer_geometry_near_f64: answer::geometry::geometry::<f64, NearHit, B>, [AnswerGeometryArgs<f64, NearHit>], NARROW, 0;
    answer_infinite: answer::least::infinite, [AnswerInfiniteArgs], WIDE, 0;
    answer_least_hit: answer::least::least::<Hit, B>, [AnswerLeastArgs<Hit>], WIDE, 0;
    answer_least_near: answer::least::least::<NearHit, B>, [AnswerLeastArgs<NearHit>], WIDE, 0;
    answer_keys_pair: answer::groups::keys::<Pair, B>, [AnswerKeysArgs<Pair>], WIDE, 0;
    answer_keys_hit: answer::groups::keys::<Hit, B>, [AnswerKeysArgs<Hit>], WIDE, 0;
    answer_keys_near: answer::groups::keys::<NearHit, B>, [AnswerKeysArgs<NearHit>], WIDE, 0;
    answer_groups: answer::groups::groups, [AnswerGroupsArgs], WIDE, 0;
    sort_pass: sort::pass, [SortArgs], WIDE, sort::shared_bytes(WIDE);
    status_frame: status::status, [StatusArgs], NARROW, 0;
    status_again: status::again, [StatusAgainArgs], NARROW, 0;
}

kernels_of_volumes! {
    both {
        construct_graft: graft::graft::<V, B>, [GraftArgs<V>], WIDE, 0;
        refit_levels: levels::levels::<V, B>, [RefitArgs<V>], WIDE, 0;
        traverse_leaves: per_leaf::leaves::<V, B>, [TraverseArgs<V>], NARROW, per_leaf::shared_bytes(NARROW);
        traverse_units: per_leaf::units::<V, B>, [TraverseArgs<V>], NARROW, per_leaf::shared_bytes(NARROW);
        traverse_within: nearest_first::within::<V, B>, [TraverseArgs<V>], NARROW, per_leaf::shared_bytes(NARROW);
        traverse_front: front::front::<V, B>, [FrontArgs<V>], WIDE, 0;
        traverse_queue: queue::queue::<V, B>, [QueueArgs<V>], NARROW, worker::shared_bytes(NARROW);
        traverse_steal: steal::steal::<V, B>, [StealArgs<V>], NARROW, worker::shared_bytes(NARROW);
        traverse_tiles: tile_pairs::pairs::<false, V, B>, [TilePairsArgs<V>], tile_pairs::LANES, tile_pairs::SHARED, exact = true;
        traverse_tiles_before: tile_pairs::pairs::<true, V, B>, [TilePairsArgs<V>], tile_pairs::LANES, tile_pairs::SHARED, exact = true;
        traverse_triangles: tile_triangles::triangles::<false, V, B>, [TileTrianglesArgs<V>], tile_triangles::LANES, tile_triangles::shared_bytes::<V>(), exact = true;
        traverse_triangles_before: tile_triangles::triangles::<true, V, B>, [TileTrianglesArgs<V>], tile_triangles::LANES, tile_triangles::shared_bytes::<V>(), exact = true;
        refit_tiles: refit_of_tiles::tiles::<V, B>, [RefitTilesArgs<V>], refit_of_tiles::LANES, refit_of_tiles::shared_bytes::<V>(), exact = true;
    }
    each {
        traverse_sample: nearest_first::sample::<R, V, B>, [NearestArgs<R, V>], NARROW, 0;
        fit: fit_of_leaves::fit::<R, V, B>, [FitArgs<R, V>], WIDE, 0;
        fit_tiles: fit_of_tiles::tiles::<R, V, B>, [FitTilesArgs<R, V>], fit_of_tiles::LANES, fit_of_tiles::shared_bytes::<V>(), exact = true;
        fit_rims: rims::rims::<R, V, B>, [RimsArgs<R, V>], WIDE, 0;
        refit_treelets: treelets::treelets::<R, V, B>, [TreeletsArgs<R, V>], WIDE, treelets::shared_bytes::<V>();
    }
    groups {
        fit_groups: fit_of_leaves::groups::<R, V, B>, [GroupsArgs<R, V>], NARROW, 0;
    }
}

crate::volumes!(table);
