//! Orders of contacts on every schedule, against a sort of the host.

use super::*;
use crate::device::emulator::{Emulator, Mode, Order as Blocks};
use crate::pipeline::counts::FrameCounters;
use crate::pipeline::layout::{FeatureTopology, Offsets};
use crate::samples::words;
use nearmiss_kernels::abi::rows::code;
use nearmiss_kernels::abi::{Feature, Located};
use nearmiss_kernels::prim::inclusion::Verdict;
use nearmiss_kernels::stage::order::RUN;
use std::collections::BTreeSet;
use std::fmt::Debug;

/// Vertices, triangles and edges of each of the bodies, except that the second has no edge.
const OF_A_BODY: u32 = 500;
/// All bodies.
const BODIES: u32 = 3;

fn machine(mode: Mode, lanes: u32) -> Device {
    Device::emulator(Emulator::new(mode, None).expect("threads").with_lanes(lanes))
}

fn machines() -> Vec<Device> {
    let engines = [1, 7, 33, 256].map(|lanes| machine(Mode::Engine, lanes));
    let orders = [Blocks::Reverse, Blocks::Shuffled(3)];
    engines.into_iter().chain(orders.map(|order| machine(Mode::Sanitizer(order), 32))).collect()
}

/// Returns the layout of bodies with `count` vertices and triangles each.
fn layout(count: u32) -> Layout {
    let edges = [0, count, count, 2 * count];
    let at = |body: u32| Offsets { vertex: body * count, triangle: body * count, edge: edges[body as usize] };
    Layout { starts: (0..=BODIES).map(at).collect(), ..Layout::default() }
}

/// Returns the layout, with triangles that stand for edges and points. Edge and vertex numbers ascend,
/// as triangles do.
fn with_elements(layout: &Layout) -> Layout {
    let end = *layout.starts.last().expect("an end");
    let element = |triangle: u32| {
        let kinds = [code::VERTEX_FACE, code::EDGE_VERTEX, code::VERTEX_VERTEX];
        let kind = kinds[triangle as usize % 3];
        let number = if kind == code::EDGE_VERTEX { triangle * end.edge / end.triangle } else { triangle };
        Element { kind: kind.into(), number }
    };
    let features =
        FeatureTopology { elements: (0..end.triangle).map(element).collect(), ..FeatureTopology::default() };
    Layout { features: features.into(), ..layout.clone() }
}

/// Returns distinct names below `end`, unordered.
fn names(seed: u64, count: usize, end: [u32; 2]) -> Vec<[u32; 2]> {
    let (mut rng, mut seen, mut all) = (words(seed), BTreeSet::new(), Vec::new());
    while all.len() < count {
        let name = end.map(|end| (rng.next().expect("endless") % u64::from(end)) as u32);
        all.extend(seen.insert(name).then_some(name));
    }
    all
}

/// Returns contacts with names of either list. The time of each is its place here, and every third
/// one is undecided.
fn hits(seed: u64, count: usize) -> Vec<Hit> {
    let end = if seed % 2 == 1 { BODIES } else { BODIES - 1 } * OF_A_BODY;
    let named = names(seed, count, [end; 2]).into_iter().enumerate();
    let hit = |(at, [a, b]): (usize, [u32; 2])| {
        let time = at as f64;
        let verdict = if at % 3 == 0 {
            Verdict::undecided(time, time + 0.5, 1, false)
        } else {
            Verdict::contact(time, time + 0.25, 1, false)
        };
        Hit { a, b, verdict }
    };
    named.map(hit).collect()
}

/// The rows, if there was room; their count; and the contacts in the same order.
type Outcome<T> = (Option<Vec<<T as Named>::Row>>, u64, Option<Vec<T>>);

/// Orders two lists on a device, with room for `capacity` contacts, and as many levels as it takes.
fn ordered<T: Ordered>(device: &Device, layout: &Layout, lists: [&[T]; 2], capacity: usize) -> Outcome<T> {
    let mut order = Order::<T>::new(device, layout, capacity).expect("memory");
    order.prepare(device).expect("memory");
    let mut counts = Counts::default();
    let lists = [(counter::VF_HITS, lists[0]), (counter::EE_HITS, lists[1])].map(|(at, entries)| {
        let mut list = List::new(device, "contacts", at, entries.len()).expect("memory");
        list.put(entries, &mut counts).expect("written");
        list
    });
    let mut counters = FrameCounters::new(device).expect("memory");
    // Twice: a frame's data must not reach the next one.
    let mut frames = 0;
    while frames < 2 {
        (counts[counter::ORDERED], counts[counter::LONGEST_BIN]) = (0, 0);
        counters.write(&counts).expect("written");
        let (first, second) = (&lists[0], Some(&lists[1]));
        let given = Unordered { first, second, decided: 1, is_submitted: frames == 1 };
        if frames == 1 {
            order.clear().expect("cleared ahead");
        }
        order.run(device, &given, counters.counters()).expect("no rule is broken");
        counts = counters.read().expect("read");
        frames += u32::from(!order.levels.grow(device, &counts).expect("levels"));
    }
    let demand = order.rows.demand(&counts);
    let kept = (demand as usize <= capacity).then(|| order.keep(&counts).expect("kept"));
    // Rows of elements alone are ordered.
    let contacts = order.contacts.as_ref().map(|all| all.read(capacity.min(demand as usize)).expect("read"));
    let rows = kept.map(|kept| bytemuck::cast_slice(kept.bytes()).to_vec());
    assert_eq!(contacts.is_none(), T::OF_FEATURES && !layout.features.elements.is_empty());
    (rows, demand, contacts)
}

/// The kind of a row, and both features.
type Key = (u8, [u32; 2]);

/// Returns the expected order: by kind, then by both features.
fn wanted<T: Ordered>(layout: &Layout, lists: [&[T]; 2]) -> (Vec<T::Row>, Vec<T>) {
    let name = |is_second: bool, contact: &T| {
        let [x, y] = contact.name();
        let element = |y: u32| layout.features.elements.get(y as usize).filter(|_| T::OF_FEATURES);
        match (is_second, element(y).map(|element| (element.kind as u8, element.number))) {
            (true, _) => (code::EDGE_EDGE, [x, y]),
            (false, None) => (code::VERTEX_FACE, [x, y]),
            (false, Some((code::EDGE_VERTEX, edge))) => (code::EDGE_VERTEX, [edge, x]),
            (false, Some((code::VERTEX_VERTEX, point))) => {
                (code::VERTEX_VERTEX, [x.min(point), x.max(point)])
            }
            (false, Some((kind, number))) => (kind, [x, number]),
        }
    };
    let mut all: Vec<(Key, T)> = [false, true]
        .into_iter()
        .zip(lists)
        .flat_map(|(at, list)| list.iter().map(move |&contact| (name(at, &contact), contact)))
        .collect();
    all.sort_by_key(|(name, _)| *name);
    let row = |&(name, contact): &(Key, T)| {
        let (kind, [x, y]) = name;
        let of = match kind {
            _ if !T::OF_FEATURES => [Feature::TRIANGLE; 2],
            code::VERTEX_FACE => [Feature::VERTEX, Feature::TRIANGLE],
            code::EDGE_EDGE => [Feature::EDGE; 2],
            code::EDGE_VERTEX => [Feature::EDGE, Feature::VERTEX],
            _ => [Feature::VERTEX; 2],
        };
        let locate = |index: u32, of: Feature| layout.locate(index, |at| at.start(of));
        let [(a, p), (b, q)] = [locate(x, of[0]), locate(y, of[1])];
        contact.row(&Located { bodies: [a.0, b.0], features: [p, q], kind, decided: 1 })
    };
    (all.iter().map(row).collect(), all.iter().map(|(_, contact)| *contact).collect())
}

/// Checks the order of two lists on a device.
fn check<T>(device: &Device, layout: &Layout, lists: [&[T]; 2], capacity: usize)
where
    T: Ordered + PartialEq,
    T::Row: PartialEq + Debug,
{
    let (rows, demand, contacts) = ordered(device, layout, lists, capacity);
    let (wanted, sorted) = wanted(layout, lists);
    let counts = lists.map(<[T]>::len);
    assert_eq!(demand, wanted.len() as u64, "{}, {counts:?}", device.name());
    assert!(rows.expect("room") == wanted, "{}, {counts:?}", device.name());
    assert!(contacts.is_none_or(|contacts| contacts == sorted), "{}, {counts:?}", device.name());
}

#[test]
fn contacts_of_every_kind_come_in_canonical_order() {
    let layout = layout(OF_A_BODY);
    for device in machines() {
        for (vf, ee) in [(0, 0), (1, 0), (0, 1), (300, 0), (700, 900), (3, 2_500)] {
            let (vf, ee) = (hits(5, vf), hits(6, ee));
            for capacity in [4_096, vf.len() + ee.len()] {
                check(&device, &layout, [&vf, &ee], capacity);
            }
        }
        let pairs: Vec<Pair> = hits(7, 400).iter().map(|hit| Pair { a: hit.a, b: hit.b }).collect();
        check(&device, &layout, [&pairs, &[]], 500);
        let near = |hit: &Hit| {
            let corner = |part: f64| [0.0, 0.25, 1.0][part as usize % 3];
            let at = [corner(hit.verdict.toi), corner(hit.verdict.toi / 3.0)];
            NearHit { a: hit.a, b: hit.b, squared: hit.verdict.toi, at }
        };
        let [vf, ee] = [7, 8].map(|seed| hits(seed, 300).iter().map(near).collect::<Vec<_>>());
        check(&device, &layout, [&vf, &ee], 600);
        // A third of the triangles are edges of no face, a third points.
        let of_elements = with_elements(&layout);
        check(&device, &of_elements, [&hits(5, 900), &hits(6, 300)], 1_200);
        check(&device, &of_elements, [&vf, &ee], 600);
        check(&device, &of_elements, [&pairs, &[]], 500);
        // Features of one body are not located.
        let one = Layout { starts: layout.starts[..2].to_vec(), ..Layout::default() };
        let own: Vec<Hit> = hits(9, 900).into_iter().filter(|hit| hit.a.max(hit.b) < OF_A_BODY).collect();
        assert!(own.len() > 50);
        check(&device, &one, [&own, &own], 2 * own.len());
    }
}

/// The judge of the test above rejects two swapped rows, and another body.
#[test]
fn another_order_is_noticed() {
    let (layout, all) = (layout(OF_A_BODY), hits(9, 100));
    let (right, _) = wanted(&layout, [&all, &[]]);
    let mut wrong = right.clone();
    wrong.swap(40, 41);
    assert!(wrong != right);
    let mut wrong = right.clone();
    wrong[40].bodies[0] += 1;
    assert!(wrong != right);
}

#[test]
fn more_contacts_than_room_are_counted() {
    let layout = layout(OF_A_BODY);
    for device in machines() {
        let all = hits(8, 300);
        for (lists, capacity) in [([&all[..100], &all[100..]], 299), ([&all[..], &[]], 0)] {
            let (rows, demand, _) = ordered(&device, &layout, lists, capacity);
            assert_eq!((rows, demand), (None, 300));
        }
    }
}

/// One feature with 20,000 contacts, and one with as many as a run; fewer under the sanitizer.
#[test]
fn a_feature_with_many_contacts_takes_merges() {
    let layout = layout(10_000);
    let bins = |long: usize| {
        let rows = names(3, long, [1, 30_000]).into_iter().map(|[_, b]| Pair { a: 7, b });
        let short = names(4, RUN as usize, [1, 30_000]).into_iter().map(|[_, b]| Pair { a: 6, b });
        rows.chain(short).chain([Pair { a: 8, b: 3 }]).collect::<Vec<_>>()
    };
    for lanes in [7, 256] {
        let device = machine(Mode::Engine, lanes);
        for long in [RUN as usize, RUN as usize + 1, 4_096, 4_097, 20_000] {
            let pairs = bins(long);
            check(&device, &layout, [&pairs, &[]], pairs.len());
        }
    }
    for order in [Blocks::Forward, Blocks::Reverse, Blocks::Shuffled(5)] {
        let pairs = bins(700);
        check(&machine(Mode::Sanitizer(order), 32), &layout, [&pairs, &[]], 1_000);
    }
}

/// With too few merges the order is another one. The longest bin is counted, so the step runs again.
#[test]
fn a_bin_beyond_the_merges_is_counted() {
    let (device, layout) = (machine(Mode::Engine, 32), layout(OF_A_BODY));
    let pairs: Vec<Pair> = (0..400).rev().map(|b| Pair { a: 7, b }).collect();
    let (mut order, mut counts) =
        (Order::<Pair>::new(&device, &layout, 400).expect("memory"), Counts::default());
    let mut list = List::new(&device, "contacts", counter::CONTACTS, 400).expect("memory");
    list.put(&pairs, &mut counts).expect("written");
    let mut counters = FrameCounters::new(&device).expect("memory");
    counters.write(&counts).expect("written");
    let given = Unordered { first: &list, second: None, decided: 0, is_submitted: false };
    order.run(&device, &given, counters.counters()).expect("no rule is broken");
    let counts = counters.read().expect("read");
    let found = order.keep(&counts).expect("kept");
    let (wanted, _) = wanted(&layout, [&pairs, &[]]);
    assert!(bytemuck::cast_slice::<u8, <Pair as Named>::Row>(found.bytes()) != wanted);
    assert!(order.levels.has_overflowed(&counts) && counts[counter::LONGEST_BIN] == 400);
    assert!(order.levels.grow(&device, &counts).expect("levels") && order.levels.room() == 4_096);
    assert!(!order.levels.grow(&device, &counts).expect("levels"));
}

/// A bin takes 4 bytes, and there is one place more. Triangles that stand for elements double the
/// bins.
#[test]
fn a_bin_takes_four_bytes() {
    let device = machine(Mode::Engine, 32);
    for count in [0, 1, 500, 20_001] {
        let layout = layout(count);
        let ends = *layout.starts.last().expect("an end");
        let bytes = |order: &Order<Hit>| size_of::<u64>() * order.counts.len();
        let order = Order::<Hit>::new(&device, &layout, 8).expect("memory");
        let bins = (ends.vertex + ends.edge) as usize;
        assert!((4 * (bins + 1)..=4 * (bins + 2)).contains(&bytes(&order)));
        assert!(order.sums.len() <= MOST_TILES as usize);
        let order = Order::<Hit>::new(&device, &with_elements(&layout), 8).expect("memory");
        let bins = if ends.triangle == 0 { 0 } else { 2 * bins };
        assert!((4 * (bins + 1)..=4 * (bins + 2)).contains(&bytes(&order)));
    }
}

/// Bins that an earlier run left would send keys elsewhere: the sanitizer notices it. A run clears
/// them, unless they were cleared ahead.
#[test]
fn bins_that_are_not_clear_are_noticed() {
    let (device, layout) = (machine(Mode::Sanitizer(Blocks::Forward), 32), layout(OF_A_BODY));
    let (mut order, mut counts) =
        (Order::<Pair>::new(&device, &layout, 8).expect("memory"), Counts::default());
    let mut list = List::new(&device, "contacts", counter::CONTACTS, 8).expect("memory");
    let mut counters = FrameCounters::new(&device).expect("memory");
    let mut run = |order: &mut Order<Pair>, a: u32| {
        list.put(&[Pair { a, b: 2 }; 1], &mut counts).expect("written");
        counters.write(&counts).expect("written");
        let given = Unordered { first: &list, second: None, decided: 0, is_submitted: false };
        order.run(&device, &given, counters.counters())
    };
    run(&mut order, 1).expect("no rule is broken");
    // Starts of that run are taken for counts.
    order.is_clear = true;
    assert!(run(&mut order, 900).is_err());
    assert!(!order.is_clear);
    run(&mut order, 900).expect("cleared first");
    order.clear().expect("cleared ahead");
    run(&mut order, 1).expect("no rule is broken");
    let dirty = vec![100 << 32 | 100; order.counts.len()];
    order.counts.write(&dirty).expect("written");
    run(&mut order, 1).expect("cleared first");
    order.counts.write(&dirty).expect("written");
    order.is_clear = true;
    assert!(run(&mut order, 1).is_err());
}
