//! Collect: lists of the device become an answer, in canonical order and with the indices of each
//! body.

mod features;

use super::counts::Counts;
use super::{Found, Hits, Layout, Listed, Stages};
use crate::contacts::{
    Caveat, Closest, Contact, Contacts, Front, Kind, NearPair, NearestTriangles, Queues, Rows, Stats, Status,
    TrianglePair, edge_weights, sort,
};
use crate::error::Error;
use crate::memory;
use crate::query::Query;
use features::{Features, edge_edge, vertex_face};
use nearmiss_emulator::Looks;
use nearmiss_kernels::abi::{Hit, NearHit, NearestHit, Pair, counter};
use nearmiss_kernels::prim::inclusion::Verdict;
use nearmiss_kernels::prim::near::corner_weights;

/// Returns the answer of a frame, with its statistics.
///
/// # Errors
/// [`Error::OutOfMemory`]; [`Error::Interrupted`] if an interrupt ends it.
pub fn collect(
    (found, stages): (Found, Stages),
    query: &Query,
    layout: &Layout,
    looks: &Looks,
) -> Result<Contacts, Error> {
    memory::require("the contacts", found.bytes())?;
    let count = |which| found.counters[which];
    let vf_ee = [count(counter::VF), count(counter::EE)];
    let of_triangles = matches!(found.listed, Listed::Pairs(_) | Listed::Nearest(_));
    let starts_crossing = found.is_start_checked.then(|| count(counter::STARTS_CROSSING));
    let mut contacts = Contacts::new(rows(&found, layout, looks), *query, starts_crossing);
    contacts.undecided = match found.listed {
        Listed::Earliest { undecided, .. } => undecided.into(),
        Listed::Pairs(_) | Listed::Hits { .. } | Listed::Near(_) | Listed::Nearest(_) => {
            count(counter::UNDECIDED)
        }
    };
    contacts.caveats = caveats(&found);
    contacts.stats = Stats {
        stages,
        triangle_pairs: count(counter::PAIRS),
        candidates: if of_triangles { count(counter::PAIRS) } else { vf_ee[0] + vf_ee[1] },
        candidates_vf_ee: vf_ee,
        survivors_vf_ee: [count(counter::VF_SURVIVORS), count(counter::EE_SURVIVORS)],
        escalated_vf_ee: [count(counter::VF_ESCALATED), count(counter::EE_ESCALATED)],
        open_vf_ee: [count(counter::VF_OPEN), count(counter::EE_OPEN)],
        sliced_vf_ee: [count(counter::VF_HARD), count(counter::EE_HARD)],
        uncertain: count(counter::UNCERTAIN),
        uncertain_wide: count(counter::UNCERTAIN_WIDE),
        steps: count(counter::STEPS),
        spilled: counter::SPILLED.map(count).iter().sum(),
        reruns: found.reruns,
        slices: 1,
        queues: queues(&found.counters),
        front: front(&found.counters),
    };
    if looks.ended() { Err(Error::Interrupted) } else { Ok(contacts) }
}

/// Returns the rows of the answer; a part of them if an interrupt ends it.
fn rows(found: &Found, layout: &Layout, looks: &Looks) -> Rows {
    match &found.listed {
        Listed::Earliest { toi, .. } => Rows::Earliest(*toi),
        Listed::Near(hits) => Rows::Near(near_pairs(hits, found.ordered, layout, looks)),
        Listed::Nearest(nearest) => Rows::Distance(nearest.first().map(|hit| nearest_triangles(hit, layout))),
        Listed::Pairs(listed) => {
            let pair = |p: &Pair| {
                let [(a, p), (b, q)] = [p.a, p.b].map(|t| layout.locate(t, |at| at.triangle));
                TrianglePair { bodies: [a, b], triangles: [p, q] }
            };
            let mut pairs = Vec::new();
            sort::extend(&mut pairs, listed, pair, looks);
            if !found.ordered {
                sort::sort(&mut pairs, TrianglePair::key, looks);
            }
            Rows::Pairs(pairs)
        }
        Listed::Hits { hits, certified } => {
            let contact = |(kind, bodies, [a, b]): Features, verdict: &Verdict| {
                let status = Status::of(*certified, verdict);
                Contact {
                    kind,
                    bodies,
                    feature_a: a,
                    feature_b: b,
                    toi: verdict.toi,
                    toi_upper: verdict.toi_upper,
                    status,
                }
            };
            let [of_vf, of_ee] = hits.each();
            let vf = |hit: &Hit| contact(vertex_face(layout, [hit.a, hit.b]), &hit.verdict);
            let ee = |hit: &Hit| contact(edge_edge(layout, [hit.a, hit.b]), &hit.verdict);
            let mut contacts = Vec::with_capacity(of_vf.len() + of_ee.len());
            sort::extend(&mut contacts, of_vf, vf, looks);
            sort::extend(&mut contacts, of_ee, ee, looks);
            if !found.ordered {
                sort::sort(&mut contacts, Contact::key, looks);
            }
            Rows::Contacts(contacts)
        }
    }
}

/// Returns the kernels' hits in canonical order, with the indices of each body; an empty list if an
/// interrupt ends it.
fn near_pairs(hits: &Hits<NearHit>, ordered: bool, layout: &Layout, looks: &Looks) -> Vec<NearPair> {
    let [of_vf, of_ee] = hits.each();
    let vf = |hit: &NearHit| near_pair(vertex_face(layout, [hit.a, hit.b]), hit);
    let ee = |hit: &NearHit| near_pair(edge_edge(layout, [hit.a, hit.b]), hit);
    let mut pairs = Vec::with_capacity(of_vf.len() + of_ee.len());
    sort::extend(&mut pairs, of_vf, vf, looks);
    sort::extend(&mut pairs, of_ee, ee, looks);
    if !ordered {
        sort::sort(&mut pairs, NearPair::key, looks);
    }
    pairs
}

/// Returns two features within a distance.
fn near_pair((kind, bodies, [a, b]): Features, hit: &NearHit) -> NearPair {
    let weights = if kind == Kind::Ee {
        edge_weights(hit.at)
    } else {
        let [x, y, z] = corner_weights(hit.at);
        [1.0, x, y, z]
    };
    let closest = Closest::of(kind, weights);
    NearPair { kind, bodies, feature_a: a, feature_b: b, squared_distance: hit.squared, weights, closest }
}

/// Returns the nearest triangles, with the indices of each body.
fn nearest_triangles(hit: &NearestHit, layout: &Layout) -> NearestTriangles {
    let [(a, p), (b, q)] = [hit.a, hit.b].map(|triangle| layout.locate(triangle, |at| at.triangle));
    let NearestHit { distance, at, points, .. } = *hit;
    NearestTriangles { bodies: [a, b], triangles: [p, q], distance, weights: at.map(corner_weights), points }
}

/// Returns all caveats of a frame, from the kernels' counters.
fn caveats(found: &Found) -> Vec<Caveat> {
    let mut all = Vec::new();
    let count = |which| found.counters[which];
    let unsure = count(counter::UNDECIDED) - count(counter::ENDED_UNDECIDED);
    let (ended, below_precision) = (count(counter::ENDED), count(counter::BELOW_PRECISION));
    let mut put = |count: u64, reason: Caveat| all.extend((count > 0).then_some(reason));
    match found.listed {
        Listed::Near(_) => put(unsure, Caveat::DistanceBelowPrecision { pairs: unsure }),
        Listed::Earliest { undecided, .. } => put(undecided as u64, Caveat::EarliestUndecided),
        Listed::Pairs(_) | Listed::Hits { .. } | Listed::Nearest(_) => {
            put(unsure, Caveat::Undecided { pairs: unsure });
        }
    }
    put(ended, Caveat::Iterations { pairs: ended });
    put(below_precision, Caveat::ToleranceBelowPrecision { pairs: Some(below_precision) });
    let unlisted = matches!(found.listed, Listed::Earliest { below_precision: true, .. });
    put(unlisted as u64, Caveat::ToleranceBelowPrecision { pairs: None });
    put(found.front_dropped as u64, Caveat::FrontDropped);
    all
}

/// Returns the statistics of the front.
fn front(counters: &Counts) -> Front {
    let of = |which| counters[which];
    Front { pairs: of(counter::ENDS), tests: of(counter::FRONT_TESTS), pruned: of(counter::PRUNED) }
}

/// Returns the statistics of the work queues.
fn queues(counters: &Counts) -> Queues {
    let of = |which| counters[which];
    Queues {
        rounds: of(counter::QUEUE_ROUNDS),
        idle_exits: of(counter::IDLE_EXITS),
        spills: of(counter::QUEUE_SPILLS),
        moves: of(counter::MOVES),
        stolen: of(counter::STOLEN),
        longest: of(counter::QUEUED),
    }
}
