//! Order: contacts become rows in canonical order on the device, if that is faster than the host:
//! on a GPU.

#[cfg(test)]
mod tests;

use super::counts::Counts;
use super::layout::{Layout, Offsets};
use super::list::{GrowableOutput, List};
use crate::device::{Buffer, Device, Kept};
use crate::error::Error;
use crate::pipeline::{launch, purpose};
use nearmiss_kernels::abi::{
    Bins, Counter, Counters, Element, Hit, Named, NearHit, OrderArgs, Output, Pair, Span, counter,
};
use nearmiss_kernels::entry::{self, Entry};
use nearmiss_kernels::stage::order::starts::{EACH, MOST_TILES};
use nearmiss_kernels::stage::order::{RUN_BITS, WAYS_BITS};

/// A kind of contact that the device can order.
pub trait Ordered: Named {
    /// The kernel that counts each bin.
    type Count: Entry<Args = OrderArgs<Self>>;
    /// The kernel that puts a key of each into its bin.
    type Place: Entry<Args = OrderArgs<Self>>;
    /// The kernel that merges runs of keys.
    type Merge: Entry<Args = OrderArgs<Self>>;
    /// The kernel that writes rows to their places.
    type Rank: Entry<Args = OrderArgs<Self>>;
}

impl Ordered for Pair {
    type Count = entry::order_count_pair;
    type Place = entry::order_place_pair;
    type Merge = entry::order_merge_pair;
    type Rank = entry::order_rank_pair;
}

impl Ordered for Hit {
    type Count = entry::order_count_hit;
    type Place = entry::order_place_hit;
    type Merge = entry::order_merge_hit;
    type Rank = entry::order_rank_hit;
}

impl Ordered for NearHit {
    type Count = entry::order_count_near;
    type Place = entry::order_place_near;
    type Merge = entry::order_merge_near;
    type Rank = entry::order_rank_near;
}

/// The rows in order, and the memory of the sort: 4 B a bin, 12 B a contact, and 8 B more a contact
/// if a bin is long.
pub struct Order<T: Ordered> {
    /// All rows, in order.
    pub rows: List<T::Row>,
    /// All contacts in the same order, for the caller's kernels; none unless prepared for them.
    contacts: Option<Buffer<T>>,
    /// Counts of the bins, then their starts in the same place.
    counts: Buffer<u64>,
    sums: Buffer<u32>,
    slots: Buffer<u32>,
    keys: [Buffer<u64>; 2],
    /// First features of each body; none for one body.
    bodies: Buffer<u32>,
    /// The meaning of each triangle; empty if all are faces.
    elements: Buffer<Element>,
    /// Number of vertices, or of triangles; and of edges.
    first_features: [u32; 2],
    /// Words of a tile of bins.
    words: u32,
    levels: Levels,
    /// Whether the counts were cleared ahead of the next run.
    is_clear: bool,
}

/// How many merges long bins take.
struct Levels(u32);

impl Levels {
    /// Returns the most contacts of a bin that so many merges, and the ranks, put into order.
    fn room(levels: u32) -> u64 {
        1 << (RUN_BITS + WAYS_BITS * levels)
    }

    /// Returns the keys of a run, and how many runs become one, by a merge or by the ranks: both as
    /// logarithms.
    fn runs(level: u32) -> (u32, u32) {
        if level == 0 { (0, RUN_BITS) } else { (RUN_BITS + WAYS_BITS * (level - 1), WAYS_BITS) }
    }
}

impl GrowableOutput for Levels {
    fn counter(&self) -> Counter {
        counter::LONGEST_BIN
    }
    fn room(&self) -> u64 {
        Levels::room(self.0)
    }
    fn grow(&mut self, _: &Device, counters: &Counts) -> Result<bool, Error> {
        let before = self.0;
        while self.has_overflowed(counters) {
            self.0 += 1;
        }
        Ok(self.0 > before)
    }
}

/// The ordering of any kind of contacts; it has no lists before it has begun.
pub trait Ordering {
    /// Makes the device order contacts, with room for `capacity` at first.
    ///
    /// # Errors
    /// Device errors.
    fn begin(&mut self, device: &Device, layout: &Layout, capacity: usize) -> Result<(), Error>;
    /// Returns the lists of the ordering.
    fn lists(&mut self) -> Vec<&mut dyn GrowableOutput>;
    /// Allocates memory for contacts in order, for submissions.
    ///
    /// # Errors
    /// Device errors.
    fn prepare(&mut self, device: &Device) -> Result<(), Error>;
    /// Clears the counts ahead of the next run, which then need not. Each frame begins with it, as a
    /// branch that ends before the run.
    ///
    /// # Errors
    /// Device errors.
    fn clear_ahead(&mut self) -> Result<(), Error>;
}

impl<T: Ordered> Ordering for Option<Order<T>> {
    fn begin(&mut self, device: &Device, layout: &Layout, capacity: usize) -> Result<(), Error> {
        *self = Some(Order::new(device, layout, capacity)?);
        Ok(())
    }

    fn lists(&mut self) -> Vec<&mut dyn GrowableOutput> {
        self.as_mut().map_or(Vec::new(), |order| vec![&mut order.rows, &mut order.levels])
    }

    fn prepare(&mut self, device: &Device) -> Result<(), Error> {
        self.as_mut().map_or(Ok(()), |order| order.prepare(device))
    }

    fn clear_ahead(&mut self) -> Result<(), Error> {
        self.as_mut().map_or(Ok(()), Order::clear)
    }
}

/// Contacts to order, and how.
pub struct Unordered<'a, T> {
    /// Triangle pairs, or vertices and faces.
    pub first: &'a List<T>,
    /// Edges, if there are any.
    pub second: Option<&'a List<T>>,
    /// Status of a contact that is no undecided one.
    pub decided: u8,
    /// Whether the caller's kernels read contacts in order.
    pub is_submitted: bool,
}

impl<T: Ordered> Order<T> {
    /// Allocates memory for `capacity` contacts at first.
    ///
    /// # Errors
    /// Device errors.
    pub fn new(device: &Device, layout: &Layout, capacity: usize) -> Result<Self, Error> {
        let ends = layout.starts.last().copied().unwrap_or_default();
        let elements: &[Element] = if T::OF_FEATURES { &layout.features.elements } else { &[] };
        let first_features = if T::OF_FEATURES { [ends.vertex, ends.edge] } else { [ends.triangle, 0] };
        // Vertices and faces, edges; then edges and points, pairs of points.
        let kinds = if elements.is_empty() { 1 } else { 2 };
        let all = kinds * first_features.iter().map(|&count| u64::from(count)).sum::<u64>();
        let order = device.of(purpose::ORDER);
        let most = u64::from(u32::MAX) / 2;
        if all > most {
            let bytes = |bins: u64| 4 * bins;
            let what = "bins of contacts".into();
            return Err(Error::OutOfMemory { what, asked: bytes(all), given: bytes(most) });
        }
        // One place more than there are bins: the end of the last.
        let words = all as u32 / 2 + 1;
        let round = EACH * device.lanes::<entry::order_starts>();
        let of_a_tile = words.div_ceil(round).div_ceil(MOST_TILES) * round;
        let table: Vec<u32> = layout.starts.iter().flat_map(Offsets::starts).collect();
        Ok(Order {
            rows: List::new(device, "contacts in order", counter::ORDERED, capacity)?,
            contacts: None,
            counts: order.buffer(words as usize)?,
            sums: order.buffer(words.div_ceil(of_a_tile) as usize)?,
            slots: order.buffer(0)?,
            keys: [order.buffer(0)?, order.buffer(0)?],
            bodies: order.upload(if layout.starts.len() > 2 { &table } else { &[] })?,
            elements: order.upload(elements)?,
            first_features,
            words: of_a_tile,
            levels: Levels(0),
            is_clear: false,
        })
    }

    fn prepare(&mut self, device: &Device) -> Result<(), Error> {
        let capacity = self.rows.capacity();
        // Their kinds would be in one list. The caller gets one of triangles and one of edges.
        if !self.elements.is_empty() {
            return Ok(());
        }
        if self.contacts.as_ref().is_none_or(|contacts| contacts.len() != capacity) {
            self.contacts = Some(device.of(purpose::ORDER).buffer(capacity)?);
        }
        Ok(())
    }

    /// Returns the contacts in order, in device memory; none unless prepared.
    pub fn contacts(&self) -> Option<Span<T>> {
        self.contacts.as_ref().map(Buffer::span)
    }

    /// Returns the rows, in order.
    ///
    /// # Errors
    /// Device errors.
    pub fn keep(&self, counters: &Counts) -> Result<Kept, Error> {
        self.rows.keep(counters)
    }

    /// Takes memory for as many contacts as there are rows.
    fn reserve(&mut self, device: &Device) -> Result<(), Error> {
        let (order, capacity) = (device.of(purpose::ORDER), self.rows.capacity());
        let merged = if self.levels.0 > 0 { capacity } else { 0 };
        if self.slots.len() != capacity {
            self.slots = order.buffer(0)?;
            self.slots = order.buffer(capacity)?;
        }
        for (keys, len) in self.keys.iter_mut().zip([capacity, merged]) {
            if keys.len() != len {
                *keys = order.buffer(0)?;
                *keys = order.buffer(len)?;
            }
        }
        Ok(())
    }

    fn clear(&mut self) -> Result<(), Error> {
        self.counts.clear()?;
        self.is_clear = true;
        Ok(())
    }

    /// Orders one list or two. Entries beyond the capacity are counted and left out.
    ///
    /// # Errors
    /// Device errors.
    pub fn run(&mut self, device: &Device, given: &Unordered<T>, counters: Counters) -> Result<(), Error> {
        self.reserve(device)?;
        // The last run left starts in the place of the counts.
        if !std::mem::take(&mut self.is_clear) {
            self.counts.clear()?;
        }
        let contacts = self.contacts().filter(|_| given.is_submitted);
        let args = OrderArgs {
            first: given.first.output(counters),
            second: given.second.map_or(Output::EMPTY, |list| list.output(counters)),
            rows: self.rows.output(counters),
            contacts: contacts.map_or(Output::EMPTY, |span| counters.output(span, counter::ORDERED)),
            bins: Bins {
                counts: self.counts.span(),
                sums: self.sums.span(),
                counters,
                words: self.words,
                pad: 0,
            },
            slots: self.slots.span(),
            keys: self.keys[0].span(),
            merged: self.keys[1].span(),
            bodies: self.bodies.span(),
            elements: self.elements.span(),
            vertices: self.first_features[0],
            edges: self.first_features[1],
            run: 0,
            ways: 0,
            decided: given.decided.into(),
            pad: 0,
        };
        let (capacity, tiles) = (self.rows.capacity(), self.sums.len() as u32);
        launch::striding::<T::Count>(device, capacity, &args)?;
        launch::blocks::<entry::order_sums>(device, tiles, &args.bins)?;
        launch::blocks::<entry::order_starts>(device, tiles, &args.bins)?;
        launch::striding::<T::Place>(device, capacity, &args)?;
        let level = |level: u32| {
            let [keys, merged] = [level % 2, (level + 1) % 2].map(|at| self.keys[at as usize].span());
            let (run, ways) = Levels::runs(level);
            OrderArgs { keys, merged, run, ways, ..args }
        };
        for at in 0..self.levels.0 {
            launch::striding::<T::Merge>(device, capacity, &level(at))?;
        }
        launch::striding::<T::Rank>(device, capacity, &level(self.levels.0))
    }
}
