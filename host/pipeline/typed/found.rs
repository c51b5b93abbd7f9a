//! The end of a frame: what the kernels found comes to the host.

use super::TypedPipeline;
use crate::device::View;
use crate::error::Error;
use crate::pipeline::below_precision::BelowPrecision;
use crate::pipeline::list::List;
use crate::pipeline::narrow::Narrow;
use crate::pipeline::order::{Order, Ordered};
use crate::pipeline::precision::Precision;
use crate::pipeline::volumes::Kernels;
use nearmiss_kernels::abi::{Hit, Pair, counter};

/// What the kernels found, still in the numbering of the memory that all bodies share, and where it is possible in that
/// memory.
pub struct Found<'a> {
    /// Triangle pairs, discrete.
    pub pairs: Option<View<'a, Pair>>,
    /// Contacts in motion.
    pub hits: Option<Hits<'a>>,
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
}

impl Found<'_> {
    /// Bytes of the answer.
    pub fn bytes(&self) -> u64 {
        let pairs = self.pairs.as_ref().map_or(0, |pairs| size_of_val(&**pairs));
        let hits = self.hits.as_ref().map_or(0, |hits| hits.each().iter().map(|list| list.len()).sum());
        (pairs + hits * size_of::<crate::Contact>()) as u64
    }
}

/// Contacts in motion, vertex/face and edge/edge.
pub enum Hits<'a> {
    /// A list of each.
    Lists([View<'a, Hit>; 2]),
    /// One list, those of vertices first, and how many they are.
    One(View<'a, Hit>, usize),
}

impl Hits<'_> {
    /// Both.
    pub fn each(&self) -> [&[Hit]; 2] {
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
        match &self.narrow {
            Narrow::Discrete { ordered: Some(order), .. } => all.push(order.list.ahead(&self.last)),
            Narrow::Discrete { contacts, .. } => all.push(contacts.ahead(&self.last)),
            Narrow::Continuous(c) => {
                match &c.ordered {
                    Some(order) => all.push(order.list.ahead(&self.last)),
                    None => all.extend([c.vf_hits.ahead(&self.last), c.ee_hits.ahead(&self.last)]),
                }
                all.extend(c.earliest.as_ref().map(|earliest| earliest.ahead(1)));
            }
        }
        self.device.read_ahead(&all)
    }

    pub(super) fn gather(&self, counters: Vec<u64>, reruns: u64) -> Result<Found<'_>, Error> {
        let mut found = Found {
            pairs: None,
            hits: None,
            ordered: false,
            earliest: None,
            counters,
            reruns,
            front_dropped: self.walk.front_dropped(),
            below_precision: None,
        };
        match &self.narrow {
            Narrow::Discrete { contacts, ordered, .. } => {
                let ordered = in_order(ordered.as_deref(), &found.counters, &[contacts])?;
                found.ordered = ordered.is_some();
                found.pairs = Some(ordered.map_or_else(|| contacts.view(&found.counters), Ok)?);
            }
            Narrow::Continuous(c) => {
                found.below_precision = c.below_precision;
                let ordered = in_order(c.ordered.as_ref(), &found.counters, &[&c.vf_hits, &c.ee_hits])?;
                found.ordered = ordered.is_some();
                found.hits = Some(match ordered {
                    Some(all) => Hits::One(all, c.vf_hits.demand(&found.counters) as usize),
                    None => Hits::Lists([c.vf_hits.view(&found.counters)?, c.ee_hits.view(&found.counters)?]),
                });
                if let Some(earliest) = &c.earliest {
                    let bits = earliest.read(1)?[0];
                    found.earliest = (bits != u64::MAX).then(|| f64::from_bits(bits));
                }
            }
        }
        Ok(found)
    }
}
