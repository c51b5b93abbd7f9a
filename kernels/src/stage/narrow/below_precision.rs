//! # BelowPrecision: contacts → how many are too large for the tolerance
//! Paper    none.
//! Launch   a lane a hit, of both kinds; a grid of any size strides. Only where some pair may be that large.
//! Reads    hits, faces or edges, positions of both frames (four vertices); tolerances of bodies, if they differ.
//! Writes   a count, by one atomic a block.
//! Before   hits are complete, or their list was too short: then the frame runs again.
//! After    the count is that of hits for which some difference of coordinates of the two features, at either end of the
//!          step, times the least part that the solver can tell is above the tolerance: rounded in f64 as the host would.
//! Room     none; cannot run out.
//! Cost     8 of 32 B a hit, 12 B indices, 128 B positions (gathered); 50 operations.

use super::{edge_edge, tolerance_of, vertex_face};
use crate::abi::{BelowPrecisionArgs, Pair, counter};
use crate::exec::{Block, Lane, Slot};
use crate::math::Real;
use crate::prim::cubic::Moving;

/// Counts them.
pub fn below_precision<R: Real, B: Block>(b: &mut B, a: &BelowPrecisionArgs<R>) {
    let (vf, ee) = (a.vf.listed(b) as u64, a.ee.listed(b) as u64);
    let stride = (b.blocks() * b.lanes()) as u64;
    let mut counts = b.slot(0u32);
    b.phase(|l| {
        let uniform = a.tolerances.is_empty();
        let is_large = |one: &[Moving<R>], other: &[Moving<R>], tolerance: f64| {
            // A tolerance of 0 is never too small.
            tolerance > 0.0 && tolerance < a.finest * reach(one, other)
        };
        let mut count = 0;
        let mut i = l.global() as u64;
        while i < vf + ee {
            let large = if i < vf {
                let hit = a.vf.get(l, i as u32);
                let (v, f) = vertex_face(l, (&a.frames, a.faces), Pair { a: hit.a, b: hit.b });
                let tolerance = if uniform {
                    a.tolerance
                } else {
                    tolerance_of(l, a.tolerances, [hit.a, l.read(a.faces, hit.b)[0]])
                };
                is_large(&[v], &f, tolerance)
            } else {
                let hit = a.ee.get(l, (i - vf) as u32);
                let [x, y] = edge_edge(l, (&a.frames, a.edges), Pair { a: hit.a, b: hit.b });
                let tolerance = if uniform {
                    a.tolerance
                } else {
                    tolerance_of(l, a.tolerances, [hit.a, hit.b].map(|edge| l.read(a.edges, edge)[0]))
                };
                is_large(&x, &y, tolerance)
            };
            count += large as u32;
            i += stride;
        }
        *counts.of(l) = count;
    });
    let sum = b.scan(&mut counts);
    a.counters.add_once(b, counter::BELOW_PRECISION, sum as u64);
}

/// The largest difference of coordinates of a vertex of the one and one of the other, at either end of the step.
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
