//! # BelowPrecision: contacts → the number that are too large for the tolerance
//! Paper    not in the paper.
//! Launch   a lane a hit, of both kinds; a grid of any size strides. Only if some pair may be that
//!          large.
//! Reads    hits, faces or edges, positions of both frames (four vertices); tolerances of bodies,
//!          if they differ.
//! Writes   a count, by one atomic a block.
//! Before   hits are complete, or their list overflowed: then the frame runs again.
//! After    count = |{hit : tolerance > 0, finest · reach(hit) > tolerance}|.
//!          reach = the largest difference of coordinates between the two features, at either end
//!          of the step.
//!          `finest` = the least part of it that the solver resolves. Rounded in f64 as on the
//!          host.
//! Room     none; cannot run out.
//! Cost     8 of 32 B a hit, 12 B indices, 128 B positions (gathered); 50 operations.

use super::{edge_edge, tolerance_of, vertex_face};
use crate::abi::{BelowPrecisionArgs, Pair, counter};
use crate::exec::{Block, Lane, Slot};
use crate::math::Real;
use crate::prim::cubic::Moving;

/// Counts them.
pub fn below_precision<R: Real, B: Block>(block: &mut B, args: &BelowPrecisionArgs<R>) {
    let (vf, ee) = (args.vf.listed(block) as u64, args.ee.listed(block) as u64);
    let stride = (block.blocks() * block.lanes()) as u64;
    let mut counts = block.slot(0u32);
    block.phase(|lane| {
        let uniform = args.tolerances.is_empty();
        let is_large = |one: &[Moving<R>], other: &[Moving<R>], tolerance: f64| {
            // A tolerance of 0 is never too small.
            tolerance > 0.0 && tolerance < args.finest * reach(one, other)
        };
        let mut count = 0;
        let mut i = lane.global() as u64;
        while i < vf + ee {
            let large = if i < vf {
                let hit = args.vf.get(lane, i as u32);
                let (v, f) = vertex_face(lane, &args.frames, args.faces, Pair { a: hit.a, b: hit.b });
                let tolerance = if uniform {
                    args.tolerance
                } else {
                    tolerance_of(lane, args.tolerances, [hit.a, lane.read(args.faces, hit.b)[0]])
                };
                is_large(&[v], &f, tolerance)
            } else {
                let hit = args.ee.get(lane, (i - vf) as u32);
                let [x, y] = edge_edge(lane, &args.frames, args.edges, Pair { a: hit.a, b: hit.b });
                let tolerance = if uniform {
                    args.tolerance
                } else {
                    tolerance_of(
                        lane,
                        args.tolerances,
                        [hit.a, hit.b].map(|edge| lane.read(args.edges, edge)[0]),
                    )
                };
                is_large(&x, &y, tolerance)
            };
            count += large as u32;
            i += stride;
        }
        *counts.of(lane) = count;
    });
    let sum = block.scan(&mut counts);
    args.counters.add_once(block, counter::BELOW_PRECISION, sum as u64);
}

/// The largest difference of coordinates between the vertices of `one` and `other`, at either end
/// of the step.
fn reach<R: Real>(one: &[Moving<R>], other: &[Moving<R>]) -> f64 {
    let mut most = 0.0f64;
    for p in one {
        for q in other {
            for d in [p.t0.wide() - q.t0.wide(), p.t1.wide() - q.t1.wide()] {
                most = most.max(d[0].abs()).max(d[1].abs()).max(d[2].abs());
            }
        }
    }
    most
}
