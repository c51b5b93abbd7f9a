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
//!
//! [`moving_relations`] keeps pairs whose root boxes meet in a step, at both ends and in between
//! ([`crate::bvh::motion`]). A pair that is left out stays farther apart than `within`, or both of
//! its bodies deform: [`super::super::tiles`] has these. A body that deforms is the first of its pair.

use crate::abi::{
    Counters, InstanceTables, MeshRecord, MovingRelation, MovingRelationsArgs, Output, Pair, Relation,
    RelationsArgs, RelationsWithinArgs, Span, counter,
};
use crate::bvh::filter::is_left_out;
use crate::bvh::gap::{CloseInBoth, limit};
use crate::bvh::relation::{Both, Related};
use crate::exec::entries::append_each;
use crate::exec::{Block, Lane};

/// Pairs of bodies whose root boxes meet.
pub fn relations<B: Block>(block: &mut B, args: &RelationsArgs) {
    list(block, (args.pairs, args.left_out), args.relations, args.counters, |lane, pair| {
        related(lane, args, pair, |_, first, second| first.overlaps(second))
    });
}

/// Pairs of bodies whose root boxes are within a distance.
pub fn relations_within<B: Block>(block: &mut B, args: &RelationsWithinArgs) {
    let (of, within) = (&args.of, args.words.within);
    list(block, (of.pairs, of.left_out), of.relations, of.counters, |lane, pair| {
        related(lane, of, pair, |relation, first, second| {
            let limit = limit(within, relation.slack);
            CloseInBoth { both: *first, limit }.reaches(&CloseInBoth { both: *second, limit })
        })
    });
}

/// Pairs of bodies whose root boxes meet in a step.
pub fn moving_relations<B: Block>(block: &mut B, args: &MovingRelationsArgs) {
    let tables = &args.tables;
    list(block, (args.pairs, args.left_out), args.relations, args.counters, |lane, pair| {
        let [first, second] = [pair.a, pair.b].map(|body| mesh(lane, tables, body).deforms != 0);
        if first & second {
            return None;
        }
        let bodies = if second { [pair.b, pair.a] } else { [pair.a, pair.b] };
        let [of_a, of_b] = bodies.map(|body| mesh(lane, tables, body));
        let [a, b] = bodies.map(|body| lane.read(tables.frames, body));
        let [a_end, b_end] = bodies.map(|body| lane.read(args.ends, body));
        let [of_first, of_second] = bodies.map(|body| lane.read(args.motions, body));
        let frames = [[&a, &b], [&a_end, &b_end]];
        let motions = [&of_first, &of_second];
        let mut relation = MovingRelation::of(bodies, frames, [&of_a, &of_b], motions, args.within);
        if of_a.deforms & args.steps != 0 {
            relation.start.plane_slack = f32::INFINITY;
        }
        overlaps(lane, tables, &relation, [of_a.root, of_b.root]).then_some(relation)
    });
}

/// The mesh of a body.
#[inline(always)]
fn mesh<L: Lane>(lane: &L, tables: &InstanceTables, body: u32) -> MeshRecord {
    lane.read(tables.meshes, lane.read(tables.bodies, body).mesh)
}

/// Whether two nodes overlap.
#[inline(always)]
fn overlaps<Q: Related, L: Lane>(lane: &L, tables: &InstanceTables, relation: &Q, [a, b]: [u32; 2]) -> bool {
    let first = relation.first_in_both(&lane.read(tables.nodes, a).volume);
    first.overlaps(&relation.second_in_both(&lane.read(tables.nodes, b).volume))
}

/// Lists the relations of pairs that have one.
#[inline(always)]
fn list<Q: Related, B: Block>(
    block: &mut B,
    (pairs, left_out): (Output<Pair>, Span<u32>),
    relations: Output<Q>,
    counters: Counters,
    of: impl Fn(&B::Lane, Pair) -> Option<Q>,
) {
    let count = pairs.listed(block);
    append_each(block, count, relations, |lane, i| {
        let pair = pairs.get(lane, i);
        let is_listed = !left_out.is_empty() && is_left_out(pair.a, pair.b, |k| lane.read(left_out, k));
        if is_listed { None } else { of(lane, pair) }
    });
    if block.block() == 0 {
        counters.add_once(block, counter::STEPS, count.into());
    }
}

/// The relation of a pair, if its root boxes pass the test.
#[inline(always)]
fn related<L: Lane>(
    lane: &L,
    args: &RelationsArgs,
    pair: Pair,
    test: impl Fn(&Relation, &Both, &Both) -> bool,
) -> Option<Relation> {
    let tables = &args.tables;
    let of = |body: u32| (lane.read(tables.frames, body), mesh(lane, tables, body));
    let ((a, of_a), (b, of_b)) = (of(pair.a), of(pair.b));
    let relation = Relation::of([pair.a, pair.b], [&a, &b], [&of_a, &of_b]);
    let first = relation.of_first(&lane.read(tables.nodes, of_a.root).volume);
    let second = relation.of_second(&lane.read(tables.nodes, of_b.root).volume);
    test(&relation, &first, &second).then_some(relation)
}
