//! # Approach: vertex/face and edge/edge pairs → those that may meet; contacts of those that part
//! Paper    not in the paper.
//! Launch   a lane a pair, both kinds in one launch; a grid of any size strides. Only for a query of
//!          what approaches, before the first rung of the solver.
//! Reads    pairs, faces or edges, positions of both frames (four vertices); tolerances of bodies and
//!          radii of vertices, if they differ.
//! Writes   pairs for the solver. Contacts and undecided pairs with bounds of toi; or the earliest.
//! Before   pairs are complete.
//! After    Let d be the distance of a pair at the start, and within = {pairs : d <= separation}.
//!          {pairs not in within that come within the separation} ⊆ left.
//!          {pairs in within that come nearer than d} ⊆ left ∪ listed, those that do so at once ⊆ left.
//!          No time is late. Pairs in within that never come nearer are in neither, if the test
//!          decides it. See [`crate::prim::approach`].
//! Room     left, hits: counted past the end, grown, run again.
//! Cost     8 B pair, 12 B indices, 128 B positions (gathered). 250 operations for a pair that is
//!          beyond the separation; 500 to 2,000 for others; some microseconds if signs need integers.

use super::climb::emit;
use super::{edge_edge, of_edge_edge, of_vertex_face, radii_of_edges, radii_of_face, vertex_face};
use crate::abi::{Listed, Pair, RungArgs, ThickRungArgs};
use crate::exec::entries::append_each;
use crate::exec::{Block, Lane};
use crate::math::Real;
use crate::prim::approach::{Course, Motion};
use crate::prim::cubic::Moving;
use crate::prim::inclusion::Params;
use crate::prim::isolate::{Edges, Face};

/// Both kinds.
pub fn approach<R: Real, B: Block>(block: &mut B, args: &ThickRungArgs<R>) {
    let rung = &args.rung;
    let count = rung.vf.pairs.listed(block);
    append_each(block, count, rung.vf.left, |lane, i| {
        let pair = rung.vf.pairs.get(lane, i);
        let p = of_query(args, of_vertex_face(lane, rung, pair));
        let (v, [x, y, z]) = vertex_face(lane, &rung.frames, rung.faces, pair);
        let radii = differ(args).then(|| radii_of_face(lane, args.radii, rung.faces, pair));
        let vectors = Face::new(v, [x, y, z], &p).of_four();
        left(lane, rung, (&rung.vf, pair), course([v, x, y, z], &vectors, radii, &p))
    });
    let count = rung.ee.pairs.listed(block);
    append_each(block, count, rung.ee.left, |lane, i| {
        let pair = rung.ee.pairs.get(lane, i);
        let p = of_query(args, of_edge_edge(lane, rung, pair));
        let [x, y] = edge_edge(lane, &rung.frames, rung.edges, pair);
        let radii = differ(args).then(|| radii_of_edges(lane, args.radii, rung.edges, pair));
        let vectors = Edges::new(x, y, &p);
        left(lane, rung, (&rung.ee, pair), course([x[0], x[1], y[0], y[1]], &vectors, radii, &p))
    });
}

/// Whether radii differ between vertices. Else they are part of the separation.
#[inline(always)]
fn differ<R: Real>(args: &ThickRungArgs<R>) -> bool {
    !args.radii.is_empty()
}

/// Parameters of a pair. With radii of vertices the separation is that of the query.
#[inline(always)]
fn of_query<R: Real>(args: &ThickRungArgs<R>, of_bodies: Params) -> Params {
    let Params { min_separation, .. } = if differ(args) { args.rung.params } else { of_bodies };
    Params { min_separation, ..of_bodies }
}

#[inline(always)]
fn course<R: Real>(
    vertices: [Moving<R>; 4],
    vectors: &Edges<f64>,
    radii: Option<[f64; 4]>,
    p: &Params,
) -> Course {
    let vertices = vertices.map(|vertex| [vertex.t0, vertex.t1]);
    Motion { vertices: &vertices, pair: vectors }.course(radii.unwrap_or_default(), p)
}

/// A pair for the solver; lists one that is known.
#[inline(always)]
fn left<R: Real, L: Lane>(
    lane: &L,
    rung: &RungArgs<R>,
    (of, pair): (&Listed, Pair),
    course: Course,
) -> Option<Pair> {
    if let Course::Known(verdict) = course {
        emit(lane, rung, of, pair, verdict);
    }
    (course == Course::Solver).then_some(pair)
}
