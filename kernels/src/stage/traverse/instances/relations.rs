//! # Relations: pairs of bodies → each in the frame of the other
//! Paper    Gottschalk, Lin and Manocha 1996 test boxes under a relative motion; here in two frames.
//! Launch   a lane a pair; a grid of any size strides.
//! Reads    pairs of bodies; frames, meshes and root nodes.
//! Writes   relations, in no order.
//! Before   frames are those of the poses.
//! After    relations = {(a, b) in pairs : root boxes overlap in both frames}.
//!          A pair that is left out has no two triangles with a common point.
//! Room     `relations` may be too short: counters go on, the host grows it and runs again.
//! Cost     8 B a pair in, 500 B gathered from cache, 80 B a relation out. 200 operations in f64.

use crate::abi::{Relation, RelationsArgs, counter};
use crate::exec::{Block, Lane, Slot};

/// Pairs of bodies whose root boxes meet.
pub fn relations<B: Block>(block: &mut B, args: &RelationsArgs) {
    let (count, lanes) = (args.pairs.listed(block), block.lanes());
    let mut found = block.slot(None);
    let mut places = block.slot(0u32);
    let mut base = block.block() * lanes;
    while base < count {
        block.phase(|lane| {
            let i = base + lane.lane();
            let own = if i < count { related(lane, args, i) } else { None };
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
        base += block.blocks() * lanes;
    }
    if block.block() == 0 {
        args.counters.add_once(block, counter::STEPS, count.into());
    }
}

/// The relation of a pair, if its root boxes meet.
#[inline(always)]
fn related<L: Lane>(lane: &L, args: &RelationsArgs, i: u32) -> Option<Relation> {
    let (tables, pair) = (&args.tables, args.pairs.get(lane, i));
    let of = |body: u32| {
        let mesh = lane.read(tables.meshes, lane.read(tables.bodies, body).mesh);
        (lane.read(tables.frames, body), mesh)
    };
    let ((a, of_a), (b, of_b)) = (of(pair.a), of(pair.b));
    let relation = Relation::of([pair.a, pair.b], [&a, &b], [&of_a, &of_b]);
    let first = relation.of_first(&lane.read(tables.nodes, of_a.root).volume);
    let second = relation.of_second(&lane.read(tables.nodes, of_b.root).volume);
    first.overlaps(&second).then_some(relation)
}
