//! The kernel table: one line an entry. The PTX entries and the host's list come from the same line.

use crate::abi::*;
use crate::bv::{Aabb, Linear, Obb};
use crate::exec::Block;
use crate::prim::isolate::ladder::SLICES;
use crate::prim::isolate::separation::{Double, Single};
use crate::queue::worker;
use crate::sort;
use crate::stage::construct::{graft, morton, tree, treelet};
use crate::stage::narrow::features::{Moves, Rests};
use crate::stage::narrow::{below_precision, climb, cull, discrete, features, near, separate, slice, solve};
use crate::stage::refit::{bottom_up, levels, treelets};
use crate::stage::traverse::{front, queue, steal};
use crate::stage::{balance, fit, order, place, status, traverse};

/// A kernel as the host knows it.
pub trait Entry: 'static {
    /// The name of the PTX entry, of the profiler's row and of this type: stage and step.
    const NAME: &'static str;
    /// What it is launched with.
    type Args: Copy + Send + Sync + 'static;
    /// Lanes of a block.
    const LANES: u32;
    /// Bytes of shared memory of a block.
    const SHARED: u32;
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

/// From lines of `name: path [arguments] lanes, shared;` makes the types, the PTX entries and the list of names.
macro_rules! kernels {
    ($($name:ident: $path:expr, [$args:ty], $lanes:expr, $shared:expr;)*) => {
        $(
            #[doc = concat!("`", stringify!($name), "`")]
            #[allow(non_camel_case_types, reason = "the type is the entry's name")]
            #[derive(Clone, Copy, Debug)]
            pub struct $name;
            impl Entry for $name {
                const NAME: &'static str = stringify!($name);
                type Args = $args;
                const LANES: u32 = $lanes;
                const SHARED: u32 = $shared;
                const PLACE: Option<usize> = Some(Place::$name as usize);
                #[inline(always)]
                fn run<B: Block>(block: &mut B, args: &$args) {
                    const { <$args>::FITS };
                    ($path)(block, args)
                }
            }
        )*
        #[allow(non_camel_case_types, reason = "the kernels' names")]
        enum Place { $($name),* }

        /// Visits every kernel, in the order of [`TABLE`].
        pub fn visit(visitor: &mut impl Visit) {
            $(visitor.kernel::<$name>();)*
        }

        /// Every kernel's name and the size of its arguments in bytes.
        pub const TABLE: &[(&str, usize)] = &[$((stringify!($name), size_of::<$args>())),*];

        /// The entries of the PTX.
        #[cfg(target_arch = "nvptx64")]
        mod gpu {
            use super::*;
            use crate::exec::ptx::Gpu;
            $(
                // SAFETY: called by the driver, once a thread, with arguments of the size in TABLE.
                #[unsafe(no_mangle)]
                unsafe extern "ptx-kernel" fn $name(args: $args) {
                    // SAFETY: the one block of this kernel, made at its start.
                    let mut block = unsafe { Gpu::new() };
                    <super::$name as Entry>::run(&mut block, &args);
                }
            )*
            /// Which sources this PTX came from; the host refuses another.
            #[unsafe(no_mangle)]
            pub static NEARMISS_STAMP: u64 = stamp::SOURCES;
        }
    };
}

/// Lanes of kernels whose work is the same for every lane.
const WIDE: u32 = 256;
/// Lanes of kernels with long or uneven work: small blocks, so that few lanes wait for a long one (measured:
/// `benches/NOTES.md`).
const NARROW: u32 = 64;
/// Lanes of rejection, of the rungs of a separation and of distances: work is uneven, and two lists are appended to.
const RUNG: u32 = 128;
/// Lanes of the one block that evens the queues, as in the paper.
const BALANCE: u32 = 512;

kernels! {
    place_f32: place::place::<f32, B>, [PlaceArgs<f32>], WIDE, place::SHARED;
    place_f64: place::place::<f64, B>, [PlaceArgs<f64>], WIDE, place::SHARED;
    construct_bounds_f32: morton::bounds::<f32, B>, [MortonArgs<f32>], WIDE, morton::shared_bytes(WIDE);
    construct_bounds_f64: morton::bounds::<f64, B>, [MortonArgs<f64>], WIDE, morton::shared_bytes(WIDE);
    construct_morton_f32: morton::morton::<f32, B>, [MortonArgs<f32>], WIDE, 0;
    construct_morton_f64: morton::morton::<f64, B>, [MortonArgs<f64>], WIDE, 0;
    construct_tree: tree::tree, [TreeArgs], WIDE, 0;
    construct_depth: tree::depth, [TreeArgs], WIDE, 0;
    construct_places: tree::places, [TreeArgs], WIDE, sort::shared_bytes(WIDE);
    construct_emit: tree::emit, [TreeArgs], WIDE, 0;
    construct_graft_aabb: graft::graft::<Aabb, B>, [GraftArgs<Aabb>], WIDE, 0;
    construct_graft_linear: graft::graft::<Linear, B>, [GraftArgs<Linear>], WIDE, 0;
    construct_graft_obb: graft::graft::<Obb, B>, [GraftArgs<Obb>], WIDE, 0;
    construct_treelets: treelet::plan, [PlanArgs], WIDE, treelet::SHARED;
    fit_aabb_f32: fit::fit::<f32, Aabb, B>, [FitArgs<f32, Aabb>], WIDE, 0;
    fit_aabb_f64: fit::fit::<f64, Aabb, B>, [FitArgs<f64, Aabb>], WIDE, 0;
    fit_linear_f32: fit::fit::<f32, Linear, B>, [FitArgs<f32, Linear>], WIDE, 0;
    fit_linear_f64: fit::fit::<f64, Linear, B>, [FitArgs<f64, Linear>], WIDE, 0;
    fit_obb_f32: fit::fit::<f32, Obb, B>, [FitArgs<f32, Obb>], WIDE, 0;
    fit_obb_f64: fit::fit::<f64, Obb, B>, [FitArgs<f64, Obb>], WIDE, 0;
    fit_groups_obb_f32: fit::groups::<f32, B>, [GroupsArgs<f32, Obb>], NARROW, 0;
    fit_groups_obb_f64: fit::groups::<f64, B>, [GroupsArgs<f64, Obb>], NARROW, 0;
    refit_levels_aabb: levels::levels::<Aabb, B>, [RefitArgs<Aabb>], WIDE, 0;
    refit_levels_linear: levels::levels::<Linear, B>, [RefitArgs<Linear>], WIDE, 0;
    refit_levels_obb: levels::levels::<Obb, B>, [RefitArgs<Obb>], WIDE, 0;
    refit_treelets_aabb_f32: treelets::treelets::<f32, Aabb, B>, [TreeletsArgs<f32, Aabb>], WIDE, treelets::shared_bytes::<Aabb>();
    refit_treelets_aabb_f64: treelets::treelets::<f64, Aabb, B>, [TreeletsArgs<f64, Aabb>], WIDE, treelets::shared_bytes::<Aabb>();
    refit_treelets_linear_f32: treelets::treelets::<f32, Linear, B>, [TreeletsArgs<f32, Linear>], WIDE, treelets::shared_bytes::<Linear>();
    refit_treelets_linear_f64: treelets::treelets::<f64, Linear, B>, [TreeletsArgs<f64, Linear>], WIDE, treelets::shared_bytes::<Linear>();
    refit_treelets_obb_f32: treelets::treelets::<f32, Obb, B>, [TreeletsArgs<f32, Obb>], WIDE, treelets::shared_bytes::<Obb>();
    refit_treelets_obb_f64: treelets::treelets::<f64, Obb, B>, [TreeletsArgs<f64, Obb>], WIDE, treelets::shared_bytes::<Obb>();
    refit_bottom_up_aabb: bottom_up::bottom_up::<Aabb, B>, [BottomUpArgs<Aabb>], WIDE, 0;
    refit_bottom_up_linear: bottom_up::bottom_up::<Linear, B>, [BottomUpArgs<Linear>], WIDE, 0;
    refit_bottom_up_obb: bottom_up::bottom_up::<Obb, B>, [BottomUpArgs<Obb>], WIDE, 0;
    traverse_leaves_aabb: traverse::leaves::<Aabb, B>, [TraverseArgs<Aabb>], NARROW, traverse::shared_bytes(NARROW);
    traverse_units_aabb: traverse::units::<Aabb, B>, [TraverseArgs<Aabb>], NARROW, traverse::shared_bytes(NARROW);
    traverse_leaves_linear: traverse::leaves::<Linear, B>, [TraverseArgs<Linear>], NARROW, traverse::shared_bytes(NARROW);
    traverse_units_linear: traverse::units::<Linear, B>, [TraverseArgs<Linear>], NARROW, traverse::shared_bytes(NARROW);
    traverse_leaves_obb: traverse::leaves::<Obb, B>, [TraverseArgs<Obb>], NARROW, traverse::shared_bytes(NARROW);
    traverse_units_obb: traverse::units::<Obb, B>, [TraverseArgs<Obb>], NARROW, traverse::shared_bytes(NARROW);
    traverse_front_aabb: front::front::<Aabb, B>, [FrontArgs<Aabb>], WIDE, 0;
    traverse_front_linear: front::front::<Linear, B>, [FrontArgs<Linear>], WIDE, 0;
    traverse_front_obb: front::front::<Obb, B>, [FrontArgs<Obb>], WIDE, 0;
    traverse_queue_aabb: queue::queue::<Aabb, B>, [QueueArgs<Aabb>], NARROW, worker::shared_bytes(NARROW);
    traverse_steal_aabb: steal::steal::<Aabb, B>, [StealArgs<Aabb>], NARROW, worker::shared_bytes(NARROW);
    traverse_queue_linear: queue::queue::<Linear, B>, [QueueArgs<Linear>], NARROW, worker::shared_bytes(NARROW);
    traverse_steal_linear: steal::steal::<Linear, B>, [StealArgs<Linear>], NARROW, worker::shared_bytes(NARROW);
    traverse_queue_obb: queue::queue::<Obb, B>, [QueueArgs<Obb>], NARROW, worker::shared_bytes(NARROW);
    traverse_steal_obb: steal::steal::<Obb, B>, [StealArgs<Obb>], NARROW, worker::shared_bytes(NARROW);
    balance_copy: balance::copy, [BalanceArgs], BALANCE, 0;
    narrow_moller_f32: discrete::moller::<f32, B>, [DiscreteArgs<f32>], WIDE, 0;
    narrow_moller_f64: discrete::moller::<f64, B>, [DiscreteArgs<f64>], WIDE, 0;
    narrow_filter_f32: discrete::filter::<f32, B>, [DiscreteArgs<f32>], WIDE, 0;
    narrow_filter_f64: discrete::filter::<f64, B>, [DiscreteArgs<f64>], WIDE, 0;
    narrow_wide_f32: discrete::wide, [DiscreteArgs<f32>], NARROW, 0;
    narrow_exact_f32: discrete::exact::<f32, B>, [DiscreteArgs<f32>], NARROW, 0;
    narrow_exact_f64: discrete::exact::<f64, B>, [DiscreteArgs<f64>], NARROW, 0;
    narrow_features_f32: features::features::<f32, Moves, B>, [FeaturesArgs<f32>], NARROW, features::shared_bytes(NARROW);
    narrow_features_f64: features::features::<f64, Moves, B>, [FeaturesArgs<f64>], NARROW, features::shared_bytes(NARROW);
    narrow_features_at_rest_f32: features::features::<f32, Rests, B>, [FeaturesArgs<f32>], NARROW, features::shared_bytes(NARROW);
    narrow_features_at_rest_f64: features::features::<f64, Rests, B>, [FeaturesArgs<f64>], NARROW, features::shared_bytes(NARROW);
    narrow_cull_f32: cull::cull::<f32, B>, [CullArgs<f32>], RUNG, 0;
    narrow_cull_f64: cull::cull::<f64, B>, [CullArgs<f64>], RUNG, 0;
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
    narrow_isolate_f32_f32: climb::isolate::<f32, f32, B>, [RungArgs<f32>], NARROW, 0;
    narrow_isolate_f32_f64: climb::isolate::<f32, f64, B>, [RungArgs<f32>], NARROW, 0;
    narrow_isolate_f64_f32: climb::isolate::<f64, f32, B>, [RungArgs<f64>], NARROW, 0;
    narrow_isolate_f64_f64: climb::isolate::<f64, f64, B>, [RungArgs<f64>], NARROW, 0;
    narrow_settle_f32: climb::settle::<f32, B>, [RungArgs<f32>], NARROW, 0;
    narrow_settle_f64: climb::settle::<f64, B>, [RungArgs<f64>], NARROW, 0;
    narrow_slice_f32: slice::slice::<f32, B>, [RungArgs<f32>], SLICES, slice::SHARED;
    narrow_slice_f64: slice::slice::<f64, B>, [RungArgs<f64>], SLICES, slice::SHARED;
    narrow_separate_first_f32: climb::separate_at_once::<f32, B>, [RungArgs<f32>], RUNG, 0;
    narrow_separate_first_f64: climb::separate_at_once::<f64, B>, [RungArgs<f64>], RUNG, 0;
    narrow_separate_f32_f32: separate::separate::<f32, Single<3>, Single<4>, B>, [RungArgs<f32>], RUNG, separate::SHARED;
    narrow_separate_f32_f64: separate::separate::<f32, Double<3>, Double<4>, B>, [RungArgs<f32>], RUNG, separate::SHARED;
    narrow_separate_f64_f32: separate::separate::<f64, Single<3>, Single<4>, B>, [RungArgs<f64>], RUNG, separate::SHARED;
    narrow_separate_f64_f64: separate::separate::<f64, Double<3>, Double<4>, B>, [RungArgs<f64>], RUNG, separate::SHARED;
    narrow_near_f32: near::near::<f32, B>, [NearArgs<f32>], RUNG, 0;
    narrow_near_f64: near::near::<f64, B>, [NearArgs<f64>], RUNG, 0;
    order_keys_pair: order::keys::<Pair, B>, [OrderArgs<Pair>], WIDE, 0;
    order_keys_hit: order::keys::<Hit, B>, [OrderArgs<Hit>], WIDE, 0;
    order_keys_near: order::keys::<NearHit, B>, [OrderArgs<NearHit>], WIDE, 0;
    sort_pass: sort::pass, [SortArgs], WIDE, sort::shared_bytes(WIDE);
    order_gather_pair: order::gather::<Pair, B>, [OrderArgs<Pair>], WIDE, 0;
    order_gather_hit: order::gather::<Hit, B>, [OrderArgs<Hit>], WIDE, 0;
    order_gather_near: order::gather::<NearHit, B>, [OrderArgs<NearHit>], WIDE, 0;
    status_frame: status::status, [StatusArgs], NARROW, 0;
}
