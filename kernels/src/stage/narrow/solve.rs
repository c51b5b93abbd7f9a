//! # Solve: vertex/face and edge/edge candidates → contacts with their first time
//! Paper    section 6.2.5, "we solve the cubic equation for each of the 15 elementary tests".
//! Launch   `vf` and `ee`, a lane a candidate; a grid of any size strides.
//! Reads    candidates that may meet, faces or edges, positions of both frames (four vertices).
//! Writes   contacts with toi, as if proven, which they are not; or, when only the earliest is asked for, one number.
//! Before   candidates are complete.
//! After    the contacts that the cubic, the seed's, finds. It can miss and be late: see [`crate::prim::cubic`].
//! Room     hits: counted past the end, grown, run again.
//! Cost     8 B candidate, 12 B indices, 128 B positions (gathered); 400 to 1,500 operations.

use super::{append_each, edge_edge, lower, vertex_face};
use crate::abi::{Hit, Pair, SolveArgs, counter};
use crate::exec::Block;
use crate::math::Real;
use crate::prim::cubic::{ee_toi, vf_toi};
use crate::prim::inclusion::Verdict;

/// Vertex/face, positions in R, the cubic in S.
pub fn vf<R: Real, S: Real, B: Block>(b: &mut B, a: &SolveArgs<R>) {
    solve(b, a, |l, pair| {
        let (v, [x, y, z]) = vertex_face(l, (&a.frames, a.faces), pair);
        // What the cubic finds depends on roundings: f32 numbers have those of f32, whatever else is in the scene.
        let toi = if v.is_single() && x.is_single() && y.is_single() && z.is_single() {
            vf_toi::<f32, S>(v.narrow(), [x.narrow(), y.narrow(), z.narrow()])
        } else {
            vf_toi::<R, S>(v, [x, y, z])
        };
        toi.map(contact)
    });
}

/// Edge/edge, positions in R, the cubic in S.
pub fn ee<R: Real, S: Real, B: Block>(b: &mut B, a: &SolveArgs<R>) {
    solve(b, a, |l, pair| {
        let [x, y] = edge_edge(l, (&a.frames, a.edges), pair);
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

/// Solves each candidate; keeps every contact, or only the smallest time; counts what is left unresolved.
fn solve<R: Real, B: Block>(b: &mut B, a: &SolveArgs<R>, ask: impl Fn(&B::Lane, Pair) -> Option<Verdict>) {
    let count = a.survivors.listed(b);
    append_each(b, count, a.hits, |l, i| {
        let pair = a.survivors.get(l, i);
        let verdict = ask(l, pair)?;
        if !a.earliest.is_empty() {
            lower(l, a.earliest, verdict);
            return None;
        }
        if !verdict.is_contact() {
            a.counters.add(l, counter::UNRESOLVED, 1);
        }
        Some(Hit { a: pair.a, b: pair.b, verdict })
    });
}
