//! Collect: lists of the device become an answer, in canonical order and with the indices of each
//! body.

mod features;

use super::counts::Counts;
use super::{Found, Hits, Layout, Listed, Stages};
use crate::contacts::{
    BodyPair, Caveat, Closest, Contact, Contacts, Front, Kind, NearPair, NearestTriangles, Queues, Row,
    RowList, Rows, Stats, Status, TrianglePair, sort,
};
use crate::error::Error;
use crate::memory;
use crate::pipeline::order::Ordered;
use crate::query::Query;
use crate::scene::BodyId;
use features::{Features, features};
use nearmiss_emulator::Looks;
use nearmiss_kernels::abi::{Hit, NearHit, NearestHit, Pair, counter, nearest_of, weights_of};
use nearmiss_kernels::prim::inclusion::Verdict;
use nearmiss_kernels::prim::near::corner_weights;
use std::sync::Arc;

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
    let turning = [count(counter::VF_TURNING), count(counter::EE_TURNING)];
    let all = of_features(&found.counters, layout);
    let vf_ee = [all[0] + turning[0], all[1] + turning[1]];
    let of_triangles = !query.kind().is_of_features();
    let starts_crossing = found.is_start_checked.then(|| count(counter::STARTS_CROSSING));
    let undecided = if let Listed::Earliest { undecided, .. } = found.listed {
        undecided.into()
    } else {
        count(counter::UNDECIDED)
    };
    let caveats = caveats(&found);
    let stats = Stats {
        stages,
        triangle_pairs: found.pairs,
        candidates: if of_triangles { found.pairs } else { vf_ee[0] + vf_ee[1] },
        candidates_vf_ee: vf_ee,
        turning_vf_ee: turning,
        survivors_vf_ee: [count(counter::VF_SURVIVORS), count(counter::EE_SURVIVORS)],
        escalated_vf_ee: [
            count(counter::VF_ESCALATED) + count(counter::VF_THIN_ESCALATED),
            count(counter::EE_ESCALATED) + count(counter::EE_THIN_ESCALATED),
        ],
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
    let mut contacts = Contacts::new(rows(found, layout, looks), *query, starts_crossing);
    (contacts.undecided, contacts.caveats, contacts.stats) = (undecided, caveats, stats);
    if looks.ended() { Err(Error::Interrupted) } else { Ok(contacts) }
}

/// Returns how many vertex/face and edge/edge candidates there were: in a step of features with a
/// thickness and without, of both sorts, each once.
fn of_features(counters: &Counts, layout: &Layout) -> [u64; 2] {
    let is_divided = counters[counter::THIN_PAIRS] + counters[counter::THICK_PAIRS] > 0;
    let sorts = if is_divided && layout.is_ragged {
        [[counter::VF_SOME_THICK, counter::VF_ALL_THIN], [counter::EE_SOME_THICK, counter::EE_ALL_THIN]]
    } else {
        [[counter::VF, counter::VF_THIN], [counter::EE, counter::EE_THIN]]
    };
    sorts.map(|sorts| sorts.into_iter().map(|sort| counters[sort]).sum())
}

/// Returns the rows of the answer; a part of them if an interrupt ends it.
fn rows(found: Found, layout: &Layout, looks: &Looks) -> Rows {
    match found.listed {
        Listed::Earliest { toi, .. } => Rows::Earliest(toi),
        Listed::Nearest(nearest) => Rows::Distance(nearest.first().map(|hit| nearest_triangles(hit, layout))),
        Listed::BodyPairs { pairs, first } => {
            let pair = |p: &Pair| BodyPair { bodies: [BodyId(p.a), BodyId(p.b)] };
            let mut pairs: Vec<BodyPair> = pairs.iter().map(pair).collect();
            sort::sort(&mut pairs, |pair| *pair, looks);
            pairs.truncate(first.map_or(usize::MAX, |first| first as usize));
            Rows::BodyPairs(pairs.into())
        }
        Listed::BodyDistances(nearest) => {
            // Rows are long: what is sorted are their keys.
            let bodies = |triangle: u32| layout.locate(triangle, |at| at.triangle).0;
            let keys = nearest.iter().enumerate().map(|(i, hit)| ([hit.a, hit.b].map(bodies), i as u32));
            let mut keys: Vec<_> = keys.collect();
            sort::sort(&mut keys, |(bodies, _)| *bodies, looks);
            let mut rows = Vec::with_capacity(keys.len());
            sort::extend(&mut rows, &keys, |&(_, i)| nearest_triangles(&nearest[i as usize], layout), looks);
            Rows::BodyDistances(rows.into())
        }
        Listed::Pairs(Hits::Lists(lists)) if lists.iter().map(|list| list.len()).sum::<usize>() <= FEW => {
            Rows::Pairs(few(lists.iter().flat_map(|list| list.iter()), layout).into())
        }
        Listed::Pairs(hits) => {
            let pair = |p: &Pair, _| {
                let [(a, p), (b, q)] = [p.a, p.b].map(|t| layout.locate(t, |at| at.triangle));
                TrianglePair { bodies: [a, b], triangles: [p, q] }
            };
            Rows::Pairs(each(hits, pair, TrianglePair::key, looks))
        }
        Listed::Hits { hits, certified } => {
            let contact = |hit: &Hit, kind| {
                let (kind, bodies, [feature_a, feature_b]) = features(layout, kind, [hit.a, hit.b]);
                let (Verdict { toi, toi_upper, .. }, status) =
                    (hit.verdict, Status::of(certified, &hit.verdict));
                Contact { bodies, feature_a, feature_b, toi, toi_upper, kind, status }
            };
            Rows::Contacts(each(hits, contact, Contact::key, looks))
        }
        Listed::Near(hits) => {
            let near = |hit: &NearHit, kind| near_pair(features(layout, kind, [hit.a, hit.b]), hit);
            Rows::Near(each(hits, near, NearPair::key, looks))
        }
    }
}

/// So many triangle pairs are put in order by one thread: others would take as long to wake.
const FEW: usize = 1 << 13;

/// Returns a few triangle pairs as rows, in canonical order.
fn few<'a>(pairs: impl Iterator<Item = &'a Pair>, layout: &Layout) -> Vec<TrianglePair> {
    // Triangles are numbered body by body, so the order of their numbers is that of rows.
    let mut keys: Vec<u64> = pairs.map(|pair| (pair.a as u64) << 32 | pair.b as u64).collect();
    keys.sort_unstable();
    let mut near = [0; 2];
    let mut row = |key: u64| {
        let mut of = |k: usize, t: u64| layout.locate_near(&mut near[k], t as u32, |at| at.triangle);
        let ((a, p), (b, q)) = (of(0, key >> 32), of(1, key));
        TrianglePair { bodies: [a, b], triangles: [p, q] }
    };
    keys.into_iter().map(&mut row).collect()
}

/// Returns rows in canonical order. Those of the device are that; contacts of lists become rows,
/// and are sorted.
fn each<T: Ordered + Sync, U: Row<Written = T::Row> + Send, K: Ord>(
    hits: Hits<T>,
    row: impl Fn(&T, Kind) -> U + Sync,
    key: impl Fn(&U) -> K + Sync,
    looks: &Looks,
) -> RowList<U> {
    let lists = match hits {
        // SAFETY: the rows are those that `order_rank` has put into memory that began as zeros.
        // `Kept` is aligned, and its bytes are never written.
        Hits::Rows(kept) => return unsafe { RowList::written(Arc::new(kept)) },
        Hits::Lists(lists) => lists,
    };
    let mut rows = Vec::with_capacity(lists.iter().map(|list| list.len()).sum());
    for (list, kind) in lists.iter().zip([Kind::Vf, Kind::Ee]) {
        sort::extend(&mut rows, list, |hit| row(hit, kind), looks);
    }
    sort::sort(&mut rows, key, looks);
    rows.into()
}

/// Returns two features within a distance.
fn near_pair((kind, bodies, [a, b]): Features, hit: &NearHit) -> NearPair {
    let at = nearest_of(kind as u8, hit.at);
    let closest = Closest::of(kind, weights_of(kind as u8, at));
    NearPair { bodies, feature_a: a, feature_b: b, squared_distance: hit.squared, at, kind, closest }
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
        Listed::Pairs(_)
        | Listed::Hits { .. }
        | Listed::Nearest(_)
        | Listed::BodyPairs { .. }
        | Listed::BodyDistances(_) => put(unsure, Caveat::Undecided { pairs: unsure }),
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::soup;
    use crate::scene::Body;

    #[test]
    fn few_pairs_are_rows_in_canonical_order() {
        let mesh = |count| Body::fixed(soup(count, 1, false).frames().swap_remove(0));
        let bodies = [mesh(3), Body::none(), mesh(40), mesh(1), mesh(200)];
        let layout = Layout::new(&bodies, Query::discrete().kind());
        let pair = |i: u32| {
            let (a, b) = (i * 37 % 244, i * 101 % 244);
            (a != b).then(|| Pair { a: a.min(b), b: a.max(b) })
        };
        let pairs: Vec<Pair> = (0..2_000).filter_map(pair).collect();
        let row = |pair: &Pair| {
            let [(a, p), (b, q)] = [pair.a, pair.b].map(|t| layout.locate(t, |at| at.triangle));
            TrianglePair { bodies: [a, b], triangles: [p, q] }
        };
        let mut rows: Vec<TrianglePair> = pairs.iter().map(row).collect();
        rows.sort_unstable_by_key(TrianglePair::key);
        assert_eq!(few(pairs.iter(), &layout), rows);
        assert!(rows.iter().any(|row| row.bodies == [BodyId(0), BodyId(4)]));
    }
}
