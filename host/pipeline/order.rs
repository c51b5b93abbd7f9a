//! Order: sorts contacts into canonical order on the device, if that is faster than the host: on a
//! GPU.

use super::counts::Counts;
use super::layout::Layout;
use super::list::{GrowableOutput, List};
use super::sorter::{counted, sort, words};
use crate::device::{Buffer, Device, View};
use crate::error::Error;
use crate::pipeline::{launch, purpose};
use bytemuck::Pod;
use nearmiss_kernels::abi::{Counters, Named, OrderArgs, Output, counter};
use nearmiss_kernels::entry::{self, Entry};
use nearmiss_kernels::stage::order::LIST_BITS;

/// A kind of contact that the device can order.
pub trait Ordered: Pod + Named {
    /// The kernel that writes their keys.
    type Keys: Entry<Args = OrderArgs<Self>>;
    /// The kernel that moves them to the places of their keys.
    type Gather: Entry<Args = OrderArgs<Self>>;
}

impl Ordered for nearmiss_kernels::abi::Pair {
    type Keys = entry::order_keys_pair;
    type Gather = entry::order_gather_pair;
}

impl Ordered for nearmiss_kernels::abi::Hit {
    type Keys = entry::order_keys_hit;
    type Gather = entry::order_gather_hit;
}

impl Ordered for nearmiss_kernels::abi::NearHit {
    type Keys = entry::order_keys_near;
    type Gather = entry::order_gather_near;
}

/// The ordered list, and the memory of the sort.
pub struct Order<T> {
    /// All contacts, in order.
    pub list: List<T>,
    items: [Buffer<u64>; 2],
    counts: Buffer<u64>,
    /// Bits of a feature's index.
    bits: u32,
}

/// The ordering of any kind of contacts; it has no list before it has begun.
pub trait Ordering {
    /// Makes the device order contacts, with room for `capacity` at first.
    ///
    /// # Errors
    /// Device errors.
    fn begin(&mut self, device: &Device, layout: &Layout, capacity: usize) -> Result<(), Error>;
    /// Returns the ordered list.
    fn list(&mut self) -> Option<&mut dyn GrowableOutput>;
}

impl<T: Ordered> Ordering for Option<Order<T>> {
    fn begin(&mut self, device: &Device, layout: &Layout, capacity: usize) -> Result<(), Error> {
        *self = Some(Order::new(device, layout, capacity)?);
        Ok(())
    }

    fn list(&mut self) -> Option<&mut dyn GrowableOutput> {
        self.as_mut().map(|order| &mut order.list as &mut dyn GrowableOutput)
    }
}

impl<T: Ordered> Order<T> {
    /// Allocates memory for `capacity` contacts at first.
    ///
    /// # Errors
    /// Device errors.
    pub fn new(device: &Device, layout: &Layout, capacity: usize) -> Result<Self, Error> {
        let ends = layout.starts.last().copied().unwrap_or_default();
        let most = ends.vertex.max(ends.triangle).max(ends.edge);
        Ok(Order {
            list: List::new(device, "contacts in order", counter::ORDERED, capacity)?,
            items: [device.buffer(0)?, device.buffer(0)?],
            counts: device.buffer(0)?,
            bits: bits(most.into()),
        })
    }

    /// Returns the bits of a contact's place in its list.
    fn number_bits(&self) -> u32 {
        bits(self.list.capacity() as u64)
    }

    /// Returns whether the indices of both features and the place fit one word. A place has at most
    /// 32 bits. Otherwise the lists stay as they are, and the host orders them.
    pub fn fits(&self) -> bool {
        LIST_BITS + 2 * self.bits + self.number_bits() <= 64
    }

    /// Returns the entries of the lists in order, if they were ordered.
    ///
    /// # Errors
    /// Device errors.
    pub fn view(&self, counters: &Counts, lists: &[&List<T>]) -> Result<Option<View<'_, T>>, Error> {
        let all: u64 = lists.iter().map(|list| list.demand(counters)).sum();
        (self.list.demand(counters) == all).then(|| self.list.view(counters)).transpose()
    }

    /// Orders one list or two. Entries beyond the capacity are counted and left out.
    ///
    /// # Errors
    /// Device errors.
    pub fn run(
        &mut self,
        device: &Device,
        first: &List<T>,
        second: Option<&List<T>>,
        counters: Counters,
    ) -> Result<(), Error> {
        // If the keys do not fit, no contact is counted as ordered.
        if !self.fits() {
            return Ok(());
        }
        let capacity = self.list.capacity();
        let bytes: Vec<u32> =
            (0..LIST_BITS + 2 * self.bits).step_by(8).map(|at| at + self.number_bits()).collect();
        let words = bytes.len() * words(device, capacity as u32);
        if self.items[0].len() != capacity || self.counts.len() != words {
            let keys = device.of(purpose::ORDER);
            self.items = [keys.buffer(capacity)?, keys.buffer(capacity)?];
            self.counts = keys.buffer(words)?;
        }
        self.counts.clear()?;
        let counts = self.counts.span();
        let out = self.list.output(counters);
        let args = |items: &Buffer<u64>| OrderArgs {
            first: first.output(counters),
            second: second.map_or(Output::EMPTY, |list| list.output(counters)),
            out,
            items: items.span(),
            tiles: counted(device, counts, capacity as u32, 0),
            bits: self.bits,
            number_bits: self.number_bits(),
        };
        let (keys, gather) = (args(&self.items[0]), args(&self.items[bytes.len() % 2]));
        launch::striding::<T::Keys>(device, capacity, &keys)?;
        let live = (capacity as u32, out.count());
        sort(device, self.items.each_ref(), live, counts, &bytes)?;
        launch::striding::<T::Gather>(device, capacity, &gather)
    }
}

/// Returns the bits of numbers below `end`; at least one.
fn bits(end: u64) -> u32 {
    end.max(2).next_power_of_two().trailing_zeros()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::emulator::{Emulator, Mode, Order as Blocks};
    use crate::pipeline::counts::FrameCounters;
    use crate::pipeline::layout::Offsets;
    use crate::samples::words;
    use nearmiss_kernels::abi::{Hit, Pair};
    use nearmiss_kernels::prim::inclusion::Verdict;
    use std::collections::BTreeSet;

    /// Vertices, triangles and edges of each of two bodies.
    const OF_A_BODY: u32 = 700;

    /// The ordered contacts, and their count.
    type Outcome<T> = (Option<Vec<T>>, u64);

    fn machines() -> Vec<Device> {
        let engine = |lanes| Emulator::new(Mode::Engine, None).expect("threads").with_lanes(lanes);
        let order = |order| Emulator::new(Mode::Sanitizer(order), None).expect("threads").with_lanes(32);
        let engines = [1, 7, 33, 256].map(engine).into_iter();
        engines.chain([Blocks::Reverse, Blocks::Shuffled(3)].map(order)).map(Device::emulator).collect()
    }

    /// Returns distinct contacts of two bodies, unordered; the time of each is its place here.
    fn hits(seed: u64, count: usize) -> Vec<Hit> {
        let (mut rng, mut seen, mut all) = (words(seed), BTreeSet::new(), Vec::new());
        while all.len() < count {
            let [a, b] = [0; 2].map(|_| (rng.next().expect("endless") % u64::from(2 * OF_A_BODY)) as u32);
            if seen.insert([a, b]) {
                let toi = all.len() as f64;
                all.push(Hit { a, b, verdict: Verdict { toi, ..Verdict::default() } });
            }
        }
        all
    }

    /// Orders two lists on a device, with room for `capacity` contacts.
    fn ordered<T: Ordered>(device: &Device, lists: [&[T]; 2], capacity: usize) -> Outcome<T> {
        let at = |n| Offsets { vertex: n, triangle: n, edge: n };
        let layout = Layout { starts: vec![at(0), at(OF_A_BODY), at(2 * OF_A_BODY)], ..Layout::default() };
        let mut order = Order::<T>::new(device, &layout, capacity).expect("memory");
        let mut counts = Counts::default();
        let lists = [(counter::VF_HITS, lists[0]), (counter::EE_HITS, lists[1])].map(|(at, entries)| {
            let mut list = List::new(device, "contacts", at, entries.len()).expect("memory");
            list.put(entries, &mut counts).expect("written");
            list
        });
        let mut counters = FrameCounters::new(device).expect("memory");
        // Twice: a frame's data must not reach the next one.
        for _ in 0..2 {
            counts[counter::ORDERED] = 0;
            counters.write(&counts).expect("written");
            order.run(device, &lists[0], Some(&lists[1]), counters.counters()).expect("no rule is broken");
            counts = counters.read().expect("read");
        }
        let demand = order.list.demand(&counts);
        let whole = demand as usize <= capacity;
        let all = whole.then(|| order.view(&counts, &[&lists[0], &lists[1]]).expect("read")).flatten();
        let all = all.map(|view| view.to_vec());
        (all, demand)
    }

    /// Returns the expected order: the first list, then the second, each by both features.
    fn wanted<T: Ordered>(lists: [&[T]; 2]) -> Vec<T> {
        let mut all: Vec<(usize, T)> =
            (0..2).flat_map(|i| lists[i].iter().map(move |&contact| (i, contact))).collect();
        all.sort_by_key(|(list, contact)| (*list, contact.name()));
        all.into_iter().map(|(_, contact)| contact).collect()
    }

    #[test]
    fn contacts_of_every_kind_come_in_canonical_order() {
        for device in machines() {
            for (vf, ee) in [(0, 0), (1, 0), (0, 1), (300, 0), (700, 900), (3, 2_500)] {
                let (vf, ee) = (hits(5, vf), hits(6, ee));
                for capacity in [4_096, vf.len() + ee.len()] {
                    let lists = [&vf[..], &ee[..]];
                    let (found, demand) = ordered(&device, lists, capacity);
                    assert_eq!(demand, (vf.len() + ee.len()) as u64);
                    assert!(found.expect("capacity") == wanted(lists), "{}: {lists:?}", device.name());
                }
            }
            let pairs: Vec<Pair> = hits(7, 400).iter().map(|hit| Pair { a: hit.a, b: hit.b }).collect();
            let (found, _) = ordered(&device, [&pairs, &[]], 500);
            assert_eq!(found, Some(wanted([&pairs, &[]])));
        }
    }

    /// The judge of the test above rejects two swapped contacts.
    #[test]
    fn another_order_is_noticed() {
        let all = hits(8, 100);
        let mut right = wanted([&all, &[]]);
        right.swap(40, 41);
        assert!(right != wanted([&all, &[]]));
    }

    #[test]
    fn more_contacts_than_room_are_counted() {
        for device in machines() {
            let all = hits(9, 300);
            assert_eq!(ordered(&device, [&all[..100], &all[100..]], 299), (None, 300));
            assert_eq!(ordered(&device, [&all[..], &[]], 0), (None, 300));
        }
    }

    /// Features of 2 x 31 bits leave no bits for places: the host orders.
    #[test]
    fn names_too_long_for_a_word_stay_unordered() {
        let device = machines().remove(0);
        let end = Offsets { vertex: 1 << 31, triangle: 5, edge: 9 };
        let layout = Layout { starts: vec![Offsets::default(), end], ..Layout::default() };
        let mut order = Order::<Pair>::new(&device, &layout, 16).expect("memory");
        let mut list = List::new(&device, "contacts", counter::CONTACTS, 1).expect("memory");
        let mut counts = Counts::default();
        list.put(&[Pair { a: 1, b: 2 }], &mut counts).expect("written");
        let counters = FrameCounters::new(&device).expect("memory");
        let launches = device.launches();
        order.run(&device, &list, None, counters.counters()).expect("nothing to do");
        assert_eq!(device.launches(), launches);
        assert!(order.view(&counts, &[&list]).expect("read").is_none());
    }
}
