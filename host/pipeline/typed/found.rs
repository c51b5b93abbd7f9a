//! The end of a frame: the kernels' results come to the host.

use super::query::QueryMemory;
use super::scene::SceneMemory;
use crate::device::{Ahead, Kept, View};
use crate::error::Error;
use crate::pipeline::counts::Counts;
use crate::pipeline::list::List;
use crate::pipeline::order::{Order, Ordered};
use crate::pipeline::placing::{DeviceArrays, Seen};
use crate::pipeline::precision::Precision;
#[cfg(doc)]
use nearmiss_kernels::abi::Named;
use nearmiss_kernels::abi::{Hit, NearHit, NearestHit, Pair};

/// The kernels' results, still with the indices of the layout and, if possible, in device memory.
pub enum Listed<'a> {
    /// Triangle pairs, discrete.
    Pairs(Hits<'a, Pair>),
    /// Contacts in motion.
    Hits {
        /// The contacts.
        hits: Hits<'a>,
        /// Whether a certified solver found them.
        certified: bool,
    },
    /// The first contact in motion.
    Earliest {
        /// The smallest toi, if there is one.
        toi: Option<f64>,
        /// Whether that time is of an undecided pair and of no contact.
        undecided: bool,
        /// Whether pairs may be too large for the tolerance in the solver's precision.
        below_precision: bool,
    },
    /// Features within the distance, at one time.
    Near(Hits<'a, NearHit>),
    /// The nearest triangles: one pair, or none if no pair is tested.
    Nearest(View<'a, NearestHit>),
    /// Pairs of bodies that share a point, in no order; `first` of them are wanted, if not all.
    BodyPairs {
        /// The pairs.
        pairs: View<'a, Pair>,
        /// How many.
        first: Option<u32>,
    },
    /// The nearest triangles of each pair of bodies, in no order.
    BodyDistances(View<'a, NearestHit>),
}

/// The results of a frame.
pub struct Found<'a> {
    /// The kernels' results.
    pub listed: Listed<'a>,
    /// The frame's counters.
    pub counters: Counts,
    /// Candidate triangle pairs of bodies that are not left out.
    pub pairs: u64,
    /// How often a list was too short and part of the frame reran.
    pub reruns: u64,
    /// Whether the walk's front did not pay.
    pub front_dropped: bool,
    /// Whether the triangle pairs that share a point at the start of the step were counted.
    pub is_start_checked: bool,
    /// Checks of positions in the caller's memory; `None` if there are none.
    pub seen: Option<Seen>,
}

impl Found<'_> {
    /// Returns the bytes that the rows of the answer still take: none if the device has written
    /// them.
    pub fn bytes(&self) -> u64 {
        let bytes = match &self.listed {
            Listed::Pairs(pairs) => pairs.unwritten() * size_of::<crate::contacts::TrianglePair>(),
            Listed::Hits { hits, .. } => hits.unwritten() * size_of::<crate::Contact>(),
            Listed::Earliest { .. } | Listed::Nearest(_) => 0,
            Listed::BodyPairs { pairs, .. } => pairs.len() * size_of::<crate::contacts::BodyPair>(),
            Listed::BodyDistances(all) => all.len() * size_of::<crate::contacts::NearestTriangles>(),
            Listed::Near(hits) => hits.unwritten() * size_of::<crate::contacts::NearPair>(),
        };
        bytes as u64
    }
}

/// Contacts: pairs of triangles, or pairs of features in motion or within a distance.
pub enum Hits<'a, T: Ordered = Hit> {
    /// As the kernels of the narrow phase left them: one list of each kind.
    Lists(Vec<View<'a, T>>),
    /// Rows in canonical order, as [`Named::Row`].
    Rows(Kept),
}

impl<'a, T: Ordered> Hits<'a, T> {
    /// Returns the hits of these lists, or their rows if the device has ordered them.
    ///
    /// # Errors
    /// Device errors.
    pub fn of(lists: &[&'a List<T>], order: Option<&'a Order<T>>, counters: &Counts) -> Result<Self, Error> {
        Ok(match order {
            Some(order) => Hits::Rows(order.keep(counters)?),
            None => Hits::Lists(lists.iter().map(|list| list.view(counters)).collect::<Result<_, _>>()?),
        })
    }

    /// Returns the memory to read ahead, by the counters of the last frame.
    pub fn ahead(lists: &[&'a List<T>], order: Option<&'a Order<T>>, last: &Counts) -> Vec<Ahead<'a>> {
        match order {
            Some(order) => vec![order.rows.ahead_to_keep(last)],
            None => lists.iter().map(|list| list.ahead(last)).collect(),
        }
    }

    /// Returns the number of hits that are not rows yet.
    fn unwritten(&self) -> usize {
        match self {
            Hits::Lists(lists) => lists.iter().map(|list| list.len()).sum(),
            Hits::Rows(_) => 0,
        }
    }
}

impl<R: Precision> QueryMemory<R> {
    /// Downloads the data that the end of a frame reads, with one wait: counters, and as many
    /// contacts as the last frame had.
    pub(super) fn read_ahead(&self, scene: &SceneMemory<R>) -> Result<(), Error> {
        let mut all = vec![self.counters.ahead()];
        all.extend(scene.arrays().filter_map(DeviceArrays::ahead));
        all.extend(self.narrow.ahead(&self.last));
        scene.device.read_ahead(&all)
    }

    pub(super) fn gather<'a>(
        &'a self,
        scene: &SceneMemory<R>,
        counters: Counts,
        reruns: u64,
    ) -> Result<Found<'a>, Error> {
        let listed = self.narrow.gather(&counters)?;
        let (front_dropped, seen) = (scene.broads[self.broad].phase.front_dropped(), scene.seen()?);
        let is_start_checked = self.narrow.checks_start();
        let pairs = scene.candidates(self).demand(&counters);
        Ok(Found { listed, counters, pairs, reruns, front_dropped, is_start_checked, seen })
    }
}
