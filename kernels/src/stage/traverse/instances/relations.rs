//! # Relations: pairs of bodies → each in the frame of the other
//! Paper    Gottschalk, Lin and Manocha 1996 test boxes under a relative motion; here in two frames.
//! Launch   a lane a pair; a grid of any size strides.
//! Reads    pairs of bodies; frames, meshes and root nodes.
//! Writes   relations, in no order.
//! Before   frames are those of the poses.
//! After    relations = {(a, b) in pairs : the list of pairs that are left out has them not, and root
//!          boxes overlap in both frames}.
//!          Bodies whose boxes do not overlap have no two triangles with a common point.
//! Room     `relations` may be too short: counters go on, the host grows it and runs again.
//! Cost     8 B a pair in, 500 B gathered from cache, 80 B a relation out. 200 operations in f64.

//!
//! [`relations_within`] keeps pairs whose root boxes have no gap beyond the distance of the query,
//! instead ([`crate::bvh::gap`]). A pair that is left out has no two triangles within it.

use crate::abi::{Relation, RelationsArgs, RelationsWithinArgs, counter};
use crate::bvh::gap::{CloseInBoth, limit};
use crate::bvh::filter::is_left_out;
use crate::bvh::relation::Both;
use crate::exec::{Block, Lane, Slot};

/// Pairs of bodies whose root boxes meet.
pub fn relations<B: Block>(block: &mut B, args: &RelationsArgs) {
    list(block, args, |_, first, second| first.overlaps(second));
}

/// Pairs of bodies whose root boxes are within a distance.
pub fn relations_within<B: Block>(block: &mut B, args: &RelationsWithinArgs) {
    let within = args.words.within;
    list(block, &args.of, |relation, first, second| {
        let limit = limit(within, relation.slack);
        CloseInBoth { both: *first, limit }.reaches(&CloseInBoth { both: *second, limit })
    });
}

/// Lists pairs whose root boxes pass a test.
#[inline(always)]
fn list<B: Block>(
    block: &mut B,
    args: &RelationsArgs,
    test: impl Fn(&Relation, &Both, &Both) -> bool + Copy,
) {
    let (count, lanes) = (args.pairs.listed(block), block.lanes());
    let share = block.share(count, lanes);
    if share.is_empty() {
        return;
    }
    let mut found = block.slot(None);
    let mut places = block.slot(0u32);
    let mut base = share.first;
    while base < share.end {
        block.phase(|lane| {
            let i = base + lane.lane();
            let own = if i < share.end { related(lane, args, i, test) } else { None };
            *places.of(lane) = own.is_some() as u32;
            *found.of(lane) = own;
            lane.meet();
        });
        let start = args.relations.append(block, &mut places);
        block.phase(|lane| {
            if let Some(relation) = *found.of(lane) {
                args.relations.put(lane, start + *places.of(lane) as u64, relation);
            }
            lane.meet();
        });
        base += share.step;
    }
    if block.block() == 0 {
        args.counters.add_once(block, counter::STEPS, count.into());
    }
}

/// The relation of a pair, if its root boxes pass the test.
#[inline(always)]
fn related<L: Lane>(
    lane: &L,
    args: &RelationsArgs,
    i: u32,
    test: impl Fn(&Relation, &Both, &Both) -> bool,
) -> Option<Relation> {
    let (tables, pair) = (&args.tables, args.pairs.get(lane, i));
    if !args.left_out.is_empty() && is_left_out(pair.a, pair.b, |k| lane.read(args.left_out, k)) {
        return None;
    }
    let of = |body: u32| {
        let mesh = lane.read(tables.meshes, lane.read(tables.bodies, body).mesh);
        (lane.read(tables.frames, body), mesh)
    };
    let ((a, of_a), (b, of_b)) = (of(pair.a), of(pair.b));
    let relation = Relation::of([pair.a, pair.b], [&a, &b], [&of_a, &of_b]);
    let first = relation.of_first(&lane.read(tables.nodes, of_a.root).volume);
    let second = relation.of_second(&lane.read(tables.nodes, of_b.root).volume);
    test(&relation, &first, &second).then_some(relation)
}
