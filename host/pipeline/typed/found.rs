//! The end of a frame: what the kernels found comes to the host.

use super::TypedPipeline;
use crate::device::{Ahead, View};
use crate::error::Error;
use crate::pipeline::below_precision::BelowPrecision;
use crate::pipeline::list::List;
use crate::pipeline::narrow::Narrow;
use crate::pipeline::order::{Order, Ordered};
use crate::pipeline::placing::Seen;
use crate::pipeline::precision::Precision;
use crate::pipeline::volumes::Kernels;
use bytemuck::Pod;
use nearmiss_kernels::abi::{Hit, NearHit, Pair, counter};

/// What the kernels found, still in the numbering of the memory that all bodies share, and where it is possible in that
/// memory.
pub struct Found<'a> {
    /// Triangle pairs, discrete.
    pub pairs: Option<View<'a, Pair>>,
    /// Contacts in motion.
    pub hits: Option<Hits<'a>>,
    /// Features at rest within the distance.
    pub near: Option<Hits<'a, NearHit>>,
    /// Whether pairs or hits are in canonical order already.
    pub ordered: bool,
    /// The smallest toi, if that was asked for and there is one.
    pub earliest: Option<f64>,
    /// The frame's counters, see [`counter`].
    pub counters: Vec<u64>,
    /// How often a list was too short and part of the frame ran again.
    pub reruns: u64,
    /// Whether the walk's front did not pay.
    pub front_dropped: bool,
    /// Whether pairs may be too large for the tolerance in the solver's precision: those that are listed, as counted.
    pub below_precision: Option<BelowPrecision>,
    /// What was seen of positions in memory of the caller; `None` where there are none.
    pub seen: Option<Seen>,
}

impl Found<'_> {
    /// Bytes of the answer.
    pub fn bytes(&self) -> u64 {
        let pairs = self.pairs.as_ref().map_or(0, |pairs| size_of_val(&**pairs));
        let hits = self.hits.as_ref().map_or(0, Hits::count) * size_of::<crate::Contact>();
        let near = self.near.as_ref().map_or(0, Hits::count) * size_of::<crate::contacts::NearPair>();
        (pairs + hits + near) as u64
    }
}

/// Pairs of features, vertex/face and edge/edge: contacts in motion, or such within a distance.
pub enum Hits<'a, T: Pod = Hit> {
    /// A list of each.
    Lists([View<'a, T>; 2]),
    /// One list, those of vertices first, and how many they are.
    One(View<'a, T>, usize),
}

impl<'a, T: Ordered> Hits<'a, T> {
    /// Those of two lists, in order if the device has put them so; and whether it has.
    fn of(
        lists: [&'a List<T>; 2],
        order: Option<&'a Order<T>>,
        counters: &[u64],
    ) -> Result<(Self, bool), Error> {
        Ok(match in_order(order, counters, &lists)? {
            Some(all) => (Hits::One(all, lists[0].demand(counters) as usize), true),
            None => (Hits::Lists([lists[0].view(counters)?, lists[1].view(counters)?]), false),
        })
    }

    /// What is to be read ahead of them, by the counters of the last frame.
    fn ahead(lists: [&'a List<T>; 2], order: Option<&'a Order<T>>, last: &[u64]) -> Vec<Ahead<'a>> {
        match order {
            Some(order) => vec![order.list.ahead(last)],
            None => lists.map(|list| list.ahead(last)).into(),
        }
    }
}

impl<T: Pod> Hits<'_, T> {
    /// How many they are.
    fn count(&self) -> usize {
        self.each().iter().map(|list| list.len()).sum()
    }

    /// Both.
    pub fn each(&self) -> [&[T]; 2] {
        match self {
            Hits::Lists([vf, ee]) => [vf, ee],
            Hits::One(all, vf) => {
                let (vf, ee) = all.split_at(*vf);
                [vf, ee]
            }
        }
    }
}

/// The contacts of the lists in canonical order, if the device has put them so.
fn in_order<'a, T: Ordered>(
    order: Option<&'a Order<T>>,
    counters: &[u64],
    lists: &[&List<T>],
) -> Result<Option<View<'a, T>>, Error> {
    order.map_or(Ok(None), |order| order.view(counters, lists))
}

impl<R: Precision, V: Kernels> TypedPipeline<R, V> {
    /// Brings over with one wait what the end of a frame reads: counters, and as many contacts as the last frame had.
    pub(super) fn read_ahead(&self) -> Result<(), Error> {
        let mut all = vec![self.counters.ahead(counter::COUNT as usize)];
        all.extend(self.vertices.ahead());
        match &self.narrow {
            Narrow::Discrete { ordered: Some(order), .. } => all.push(order.list.ahead(&self.last)),
            Narrow::Discrete { contacts, .. } => all.push(contacts.ahead(&self.last)),
            Narrow::Near(near) => {
                all.extend(Hits::ahead([&near.vf_hits, &near.ee_hits], near.ordered.as_ref(), &self.last));
            }
            Narrow::Continuous(c) => {
                all.extend(Hits::ahead([&c.vf_hits, &c.ee_hits], c.ordered.as_ref(), &self.last));
                all.extend(c.earliest.as_ref().map(|earliest| earliest.ahead(1)));
            }
        }
        self.device.read_ahead(&all)
    }

    pub(super) fn gather(&self, counters: Vec<u64>, reruns: u64) -> Result<Found<'_>, Error> {
        let mut found = Found {
            pairs: None,
            hits: None,
            near: None,
            ordered: false,
            earliest: None,
            counters,
            reruns,
            front_dropped: self.walk.front_dropped(),
            below_precision: None,
            seen: self.vertices.seen()?,
        };
        match &self.narrow {
            Narrow::Discrete { contacts, ordered, .. } => {
                let ordered = in_order(ordered.as_deref(), &found.counters, &[contacts])?;
                found.ordered = ordered.is_some();
                found.pairs = Some(ordered.map_or_else(|| contacts.view(&found.counters), Ok)?);
            }
            Narrow::Near(near) => {
                let lists = [&near.vf_hits, &near.ee_hits];
                let (hits, ordered) = Hits::of(lists, near.ordered.as_ref(), &found.counters)?;
                (found.near, found.ordered) = (Some(hits), ordered);
            }
            Narrow::Continuous(c) => {
                found.below_precision = c.below_precision;
                let lists = [&c.vf_hits, &c.ee_hits];
                let (hits, ordered) = Hits::of(lists, c.ordered.as_ref(), &found.counters)?;
                (found.hits, found.ordered) = (Some(hits), ordered);
                if let Some(earliest) = &c.earliest {
                    let bits = earliest.read(1)?[0];
                    found.earliest = (bits != u64::MAX).then(|| f64::from_bits(bits));
                }
            }
        }
        Ok(found)
    }
}
