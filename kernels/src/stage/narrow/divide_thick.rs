//! # Divide by thickness: candidates → those without a thickness, and those with one
//! Paper    not in the paper, whose vertices are points.
//! Launch   a lane a pair; a grid of any size strides. Only in a step in which two features without a
//!          thickness may meet, and others have one. [`sift`] only if a body has vertices of both
//!          sorts.
//! Reads    candidate pairs, faces or edges, the radius of each vertex.
//! Writes   [`divide`]: triangle pairs, in one of two lists, or in both. [`sift`]: pairs of features.
//! Before   radii are at least 0.
//! After    [`divide`]: thin = {(a, b) in pairs : a and b each have a vertex of radius 0},
//!          thick = {(a, b) in pairs : a or b has a vertex of radius above 0}.
//!          All pairs of features of radius 0 have owners in thin, all others in thick.
//!          [`sift`]: of thin those without a radius above 0, of thick those with one.
//!          So each pair of features is in one list, and that depends on its own vertices alone.
//! Room     all lists: counted past the end, grown, run again.
//! Cost     8 B pair, 24 B faces, 48 B radii (gathered).

use super::{radii_of_edges, radii_of_face};
use crate::abi::{DivideThickArgs, Output, Pair, SiftThickArgs};
use crate::exec::entries::{Entries, append_each, stride};
use crate::exec::{Block, Lane};

/// The pairs of triangles.
pub fn divide<B: Block>(block: &mut B, args: &DivideThickArgs) {
    let count = args.pairs.listed(block);
    let (mut thin, mut thick) = (Entries::new(block), Entries::new(block));
    stride(block, count, |block, base| {
        for (is_thick, entries, list) in [(false, &mut thin, args.thin), (true, &mut thick, args.thick)] {
            block.phase(|lane| {
                let i = base + lane.lane();
                let pair = (i < count).then(|| args.pairs.get(lane, i));
                let of_kind = pair.filter(|pair| {
                    let has = |triangle| {
                        let radii = lane.read(args.faces, triangle).map(|v| lane.read(args.radii, v));
                        has_vertex(radii, is_thick)
                    };
                    if is_thick { has(pair.a) || has(pair.b) } else { has(pair.a) && has(pair.b) }
                });
                entries.set(lane, of_kind);
            });
            entries.append(block, list);
        }
    });
}

/// Whether one of three vertices has a thickness, or one has none.
#[inline(always)]
fn has_vertex([x, y, z]: [f64; 3], thick: bool) -> bool {
    (x > 0.0) == thick || (y > 0.0) == thick || (z > 0.0) == thick
}

/// The pairs of features of both kinds.
pub fn sift<B: Block>(block: &mut B, args: &SiftThickArgs) {
    let of_face = |lane: &B::Lane, pair| is_thick(radii_of_face(lane, args.radii, args.faces, pair));
    let of_edges = |lane: &B::Lane, pair| is_thick(radii_of_edges(lane, args.radii, args.edges, pair));
    keep(block, (args.thin_vf, args.all_thin_vf), |lane, pair| !of_face(lane, pair));
    keep(block, (args.thin_ee, args.all_thin_ee), |lane, pair| !of_edges(lane, pair));
    keep(block, (args.thick_vf, args.some_thick_vf), of_face);
    keep(block, (args.thick_ee, args.some_thick_ee), of_edges);
}

/// Whether a control vector has a radius: then one of its vertices has one.
#[inline(always)]
fn is_thick([a, b, c, d]: [f64; 4]) -> bool {
    a > 0.0 || b > 0.0 || c > 0.0 || d > 0.0
}

/// The pairs of a list that are of a sort.
#[inline(always)]
fn keep<B: Block>(
    block: &mut B,
    (from, to): (Output<Pair>, Output<Pair>),
    is_kept: impl Fn(&B::Lane, Pair) -> bool,
) {
    let count = from.listed(block);
    append_each(block, count, to, |lane, i| {
        let pair = from.get(lane, i);
        is_kept(lane, pair).then_some(pair)
    });
}
