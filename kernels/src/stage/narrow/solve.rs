//! # Solve: vertex/face and edge/edge candidates → contacts with their first time
//! Paper    the thesis, section 6.2.5: "we solve the cubic equation for each of the 15 elementary
//!          tests".
//! Launch   `vf` and `ee`, a lane a candidate; a grid of any size strides.
//! Reads    candidates that may meet, faces or edges, positions of both frames (four vertices).
//! Writes   contacts with toi, unverified; or one number, for an earliest query.
//! Before   candidates are complete.
//! After    contacts = {candidates : the paper's cubic finds a root}. It can miss and be late: see
//!          [`crate::prim::cubic`].
//! Room     hits: counted past the end, grown, run again.
//! Cost     8 B candidate, 12 B indices, 128 B positions (gathered); 400 to 1,500 operations.

use super::{append_each, edge_edge, lower, vertex_face};
use crate::abi::{Hit, Pair, SolveArgs, counter};
use crate::exec::Block;
use crate::math::Real;
use crate::prim::cubic::{ee_toi, vf_toi};
use crate::prim::inclusion::Verdict;

/// Vertex/face, positions in R, the cubic in S.
pub fn vf<R: Real, S: Real, B: Block>(block: &mut B, args: &SolveArgs<R>) {
    solve(block, args, |lane, pair| {
        let (v, [x, y, z]) = vertex_face(lane, &args.frames, args.faces, pair);
        // The cubic depends on roundings: f32 numbers are rounded in f32, whatever else is in the
        // scene.
        let toi = if v.is_single() && x.is_single() && y.is_single() && z.is_single() {
            vf_toi::<f32, S>(v.narrow(), [x.narrow(), y.narrow(), z.narrow()])
        } else {
            vf_toi::<R, S>(v, [x, y, z])
        };
        toi.map(contact)
    });
}

/// Edge/edge, positions in R, the cubic in S.
pub fn ee<R: Real, S: Real, B: Block>(block: &mut B, args: &SolveArgs<R>) {
    solve(block, args, |lane, pair| {
        let [x, y] = edge_edge(lane, &args.frames, args.edges, pair);
        let is_single = x[0].is_single() && x[1].is_single() && y[0].is_single() && y[1].is_single();
        let toi = if is_single {
            ee_toi::<f32, S>([x[0].narrow(), x[1].narrow()], [y[0].narrow(), y[1].narrow()])
        } else {
            ee_toi::<R, S>(x, y)
        };
        toi.map(contact)
    });
}

fn contact<S: Real>(toi: S) -> Verdict {
    Verdict::contact(toi.wide(), toi.wide(), 0, false)
}

/// Solves each candidate. Keeps every contact, or only the smallest time. Counts the undecided.
fn solve<R: Real, B: Block>(
    block: &mut B,
    args: &SolveArgs<R>,
    test: impl Fn(&B::Lane, Pair) -> Option<Verdict>,
) {
    let count = args.survivors.listed(block);
    append_each(block, count, args.hits, |lane, i| {
        let pair = args.survivors.get(lane, i);
        let verdict = test(lane, pair)?;
        if !args.earliest.is_empty() {
            lower(lane, args.earliest, verdict);
            return None;
        }
        if !verdict.is_contact() {
            args.counters.add(lane, counter::UNDECIDED, 1);
        }
        Some(Hit { a: pair.a, b: pair.b, verdict })
    });
}
