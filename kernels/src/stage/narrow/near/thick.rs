//! # Near with a thickness: candidates → those within a distance and both radii, at rest
//! Paper    not in the paper.
//! Launch   two, each with both kinds. First a lane a candidate; a grid of any size strides. It
//!          filters in f32, on a CPU in vectors. The same lane measures the rest in f64. The radii of
//!          corners decide most.
//!          Then a lane a pair that corners leave open, in full warps, by the radii of nearest points.
//!          In one launch a warp stalls for its one open pair, and registers for it leave few warps
//!          (`benches/NOTES.md`).
//!          Excluded pairs are looked up in the second launch. So all measured pairs go there, if the
//!          scene excludes any. Without exclusions, and without radii that differ within a body, no
//!          pair is open, and there is no second launch.
//! Reads    candidates or open pairs, faces or edges, positions (four vertices), radii.
//! Writes   pairs with squared distance and nearest points; the number of pairs that are not
//!          certainly within the distance. The first one open pairs.
//! Before   candidates are complete. Positions are finite. distance >= 0. If radii differ within a
//!          body, or pairs are excluded, there are lists of open pairs.
//! After    hits ⊇ {candidates within the distance and both radii}, less those that the scene
//!          excludes ([`exclude`]). None is farther by more than the rounding of f64, see
//!          [`crate::prim::near`].
//!          Each hit is that of [`thick_vertex_face`] or [`thick_edge_edge`]: the second launch calls
//!          them, and the first one their first part.
//! Room     hits, open: counted past the end, grown, run again.
//! Departs  pairs are measured in f64 for positions of either precision, so the bound is that of
//!          f64.
//! Cost     8 B candidate, 12 B indices, 64 B positions (f64: 128 B; gathered), again for each
//!          measured pair, with 32 B radii; 32 B a hit, 8 B an open pair.
//!          About 220 operations of f32, as many of f64 for a measured pair. Both and some 300 to 600
//!          of f64 for an open one.

use crate::abi::{NearHit, Output, Pair, ThickNearArgs};
use crate::exec::entries::{append_each, stride};
use crate::exec::{Block, Lane, Slot};
use crate::math::{Real, Vec3};
use crate::prim::near::{ByCorners, ThickFilter, by_corners, thick_edge_edge, thick_vertex_face};
use crate::stage::narrow::exclude;
use crate::stage::narrow::near::counted;

/// The vertices of a vertex and a face.
#[inline(always)]
fn of_face<R: Real, L: Lane>(lane: &L, args: &ThickNearArgs<R>, pair: Pair) -> [u32; 4] {
    let [x, y, z] = lane.read(args.near.faces, pair.b);
    [pair.a, x, y, z]
}

/// The vertices of two edges.
#[inline(always)]
fn of_edges<R: Real, L: Lane>(lane: &L, args: &ThickNearArgs<R>, pair: Pair) -> [u32; 4] {
    let [[x, y], [z, w]] = [pair.a, pair.b].map(|edge| lane.read(args.near.edges, edge));
    [x, y, z, w]
}

/// Positions, and radii as they are: those in points are rounded up.
#[inline(always)]
fn exact<R: Real, L: Lane>(lane: &L, args: &ThickNearArgs<R>, of: [u32; 4]) -> ([Vec3<R>; 4], [f64; 4]) {
    let positions = of.map(|vertex| lane.read(args.near.positions, vertex).at);
    (positions, of.map(|vertex| lane.read(args.radii, vertex)))
}

/// Both kinds, as far as radii of corners decide; lists the others as open. If the scene excludes
/// pairs, all that are not beyond are open.
pub fn thick<R: Real, B: Block>(block: &mut B, args: &ThickNearArgs<R>) {
    let near = &args.near;
    let (vf, ee) = ((near.vf, near.vf_hits, args.vf_open), (near.ee, near.ee_hits, args.ee_open));
    each::<R, B, true>(block, args, vf, |lane, pair| of_face(lane, args, pair));
    each::<R, B, false>(block, args, ee, |lane, pair| of_edges(lane, args, pair));
}

/// Open pairs of both kinds, by the radii of their nearest points.
pub fn open<R: Real, B: Block>(block: &mut B, args: &ThickNearArgs<R>) {
    let ThickNearArgs { near, tables, .. } = args;
    let count = args.vf_open.listed(block);
    append_each(block, count, near.vf_hits, |lane, i| {
        let pair = args.vf_open.get(lane, i);
        let (corners, radii) = exact(lane, args, of_face(lane, args, pair));
        let found = thick_vertex_face(corners, radii, near.distance)?;
        let is_excluded = exclude::vertex_face(lane, tables, near.faces, pair);
        (!is_excluded).then(|| counted(lane, near.counters, pair, found))
    });
    let count = args.ee_open.listed(block);
    append_each(block, count, near.ee_hits, |lane, i| {
        let pair = args.ee_open.get(lane, i);
        let (corners, radii) = exact(lane, args, of_edges(lane, args, pair));
        let found = thick_edge_edge(corners, radii, near.distance)?;
        let is_excluded = exclude::edge_edge(lane, tables, near.edges, pair);
        (!is_excluded).then(|| counted(lane, near.counters, pair, found))
    });
}

/// The lists of one kind: candidates, hits, open pairs.
type Lists = (Output<Pair>, Output<NearHit>, Output<Pair>);

/// The fate of a candidate: nothing, [`HIT`] or [`OPEN`]. Both are counted in one word.
const HIT: u32 = 1;
const OPEN: u32 = 1 << 16;

/// One kind: filters the candidates of each stretch, and measures the rest.
#[inline(always)]
fn each<R: Real, B: Block, const TRIANGLE: bool>(
    block: &mut B,
    args: &ThickNearArgs<R>,
    (pairs, hits, open): Lists,
    vertices: impl Fn(&B::Lane, Pair) -> [u32; 4],
) {
    let near = &args.near;
    let filter = ThickFilter::<R, TRIANGLE>::new(near.distance);
    let (count, is_all) = (pairs.listed(block), args.tables.is_empty());
    let mut found = block.slot(NearHit::default());
    let (mut wishes, mut places) = (block.slot(0u32), block.slot(0u32));
    stride(block, count, |block, base| {
        block.map_rows(
            &filter,
            |lane| {
                let i = base + lane.lane();
                (i < count).then(|| pairs.get(lane, i))
            },
            |lane, pair| Some(vertices(lane, pair).map(|vertex| lane.read(near.positions, vertex))),
            |lane, result| {
                let mut wish = 0;
                if let Some((pair, keep)) = result
                    && keep != 0
                {
                    let (corners, radii) = exact(lane, args, vertices(lane, pair));
                    match by_corners::<R, TRIANGLE>(corners, radii, near.distance) {
                        ByCorners::Beyond => {}
                        ByCorners::Within(at) if is_all => {
                            *found.of(lane) = counted(lane, near.counters, pair, at);
                            wish = HIT;
                        }
                        _ => {
                            *found.of(lane) = NearHit { a: pair.a, b: pair.b, ..NearHit::default() };
                            wish = OPEN;
                        }
                    }
                }
                *wishes.of(lane) = wish;
                *places.of(lane) = wish;
                lane.meet();
            },
        );
        let total = block.scan(&mut places);
        let wanted = [(total & (OPEN - 1)) as u64, (total / OPEN) as u64];
        let [first_hit, first_open] = block.reserve_both([hits.count(), open.count()], wanted);
        block.phase(|lane| {
            let (wish, before, hit) = (*wishes.of(lane), *places.of(lane), *found.of(lane));
            if wish == HIT {
                hits.put(lane, first_hit + (before & (OPEN - 1)) as u64, hit);
            }
            if wish == OPEN {
                open.put(lane, first_open + (before / OPEN) as u64, Pair { a: hit.a, b: hit.b });
            }
        });
    });
}
