//! The ends of the descent: with the flag for a front, a complete cut, for any queues.

use super::*;
use nearmiss::research::pipeline::counts::FrameCounters;
use nearmiss_kernels::abi::{
    FilterArgs, LEAF, Link, Node, Pair, PairArgs, QueueArgs, QueueFlags, ROOT, Span, StealArgs, StealFlags,
    TraverseFlags,
};
use nearmiss_kernels::abi::{counter, pool};
use nearmiss_kernels::bv::{Aabb, Volume};
use nearmiss_kernels::entry::{traverse_queue, traverse_steal};
use nearmiss_kernels::queue::bvtt;
use std::collections::HashSet;

/// A tree in level order over `leaves` boxes in a row, each of that length and one apart; the parent of each node.
fn tree(leaves: u32, length: f32) -> (Vec<Node<Aabb>>, Vec<u32>) {
    let mut nodes = vec![Node::<Aabb>::default(); 2 * leaves as usize];
    let mut parents = vec![u32::MAX; 2 * leaves as usize];
    let (mut level, mut free) = (vec![(ROOT, 0, leaves)], 2);
    while !level.is_empty() {
        let mut next = Vec::new();
        for (node, from, to) in level {
            let link = if to - from == 1 { LEAF | from } else { free };
            let lo = [from as f32, 0.0, 0.0];
            let volume = Aabb { lo, hi: [lo[0] + length, 1.0, 1.0] };
            nodes[node as usize] = Link { link, last: to - 1 }.with(volume);
            if to - from > 1 {
                // Uneven, so that leaves lie on many levels.
                let split = from + 1 + (to - from - 2) * (from % 3) / 2;
                next.extend([(free, from, split), (free + 1, split, to)]);
                parents[free as usize] = node;
                parents[free as usize + 1] = node;
                free += 2;
            }
        }
        level = next;
    }
    for at in (1..nodes.len()).rev() {
        if nodes[at].is_leaf() {
            continue;
        }
        let link = nodes[at].link as usize;
        let (left, right) = (nodes[link].volume, nodes[link + 1].volume);
        nodes[at].volume = Volume::merge(&left, &right);
    }
    (nodes, parents)
}

/// The state after a traversal: ends, candidates, units left over, work.
struct Left {
    ends: Vec<Pair>,
    pairs: Vec<Pair>,
    units: Vec<Pair>,
}

/// Launches `rounds` rounds of three queues over one list, or a launch of three blocks that steal.
fn run(device: &Device, nodes: &[Node<Aabb>], rounds: Option<u32>) -> Left {
    let room = 1 << 14;
    let nodes = device.upload(nodes).expect("memory");
    let (pairs, ends) =
        (device.buffer::<Pair>(room).expect("memory"), device.buffer::<Pair>(room).expect("memory"));
    let words = |n: u32| {
        let mut words = device.buffer::<u64>(n as usize).expect("memory");
        words.clear().expect("zero");
        words
    };
    let mut counts = FrameCounters::new(device).expect("memory");
    counts.clear().expect("zero");
    let counters = counts.counters();
    let to = PairArgs {
        nodes: nodes.span(),
        filters: FilterArgs::NONE,
        faces: Span::EMPTY,
        pairs: counters.output(pairs.span(), counter::PAIRS),
        ends: counters.output(ends.span(), counter::ENDS),
        counters,
        flags: TraverseFlags::FRONT | TraverseFlags::KEEP_ADJACENT,
        local: 9,
    };
    let lists = [0, 1].map(|_| device.buffer::<Pair>(room).expect("memory"));
    let units = match rounds {
        Some(rounds) => {
            let (counts, idle) = (words(rounds + 1), words(rounds));
            for round in 0..rounds {
                let args = QueueArgs {
                    to,
                    units: lists[round as usize % 2].span(),
                    counts: counts.span(),
                    left: lists[(round as usize + 1) % 2].span(),
                    left_counts: counts.span(),
                    idle: idle.span(),
                    round,
                    segment: 0,
                    take: 2,
                    idle_limit: 0,
                    patience: 0,
                    full: u32::MAX,
                    flags: QueueFlags::START.when(round == 0),
                    pad: 0,
                };
                // SAFETY: buffers of this device that are read below; the tree is sound.
                unsafe { device.launch::<traverse_queue<Aabb>>(3, &args) }.expect("a round");
            }
            let left = counts.read(rounds as usize + 1).expect("counts")[rounds as usize];
            lists[rounds as usize % 2].read(left as usize).expect("units")
        }
        None => {
            let (mut places, control) = (words(100), words(1));
            // Remains of another launch count as nothing.
            let stale = [0, 1, pool::CHUNK as u64, pool::GONE].map(|state| 6 << pool::LAUNCH | state);
            places.write(&stale.repeat(25)).expect("words");
            let chunks = device.buffer::<Pair>(100 * pool::CHUNK as usize).expect("memory");
            let args = StealArgs {
                to,
                units: lists[0].span(),
                pool: places.span(),
                chunks: chunks.span(),
                control: control.span(),
                launch: 7 << pool::LAUNCH,
                segment: room as u32 / 3,
                tries: 5,
                flags: StealFlags::EAGER,
                pad: 0,
            };
            // SAFETY: as above.
            unsafe { device.launch::<traverse_steal<Aabb>>(3, &args) }.expect("a launch");
            Vec::new()
        }
    };
    let count = counts.read().expect("counters");
    let read =
        |list: &nearmiss::device::Buffer<Pair>, which| list.read(count[which] as usize).expect("entries");
    Left { ends: read(&ends, counter::ENDS), pairs: read(&pairs, counter::PAIRS), units }
}

/// Checks that each pair of leaves has exactly one of the cut's pairs above it, and that ends are what they should be.
fn cut(left: &Left, (nodes, above): &(Vec<Node<Aabb>>, Vec<u32>)) -> Result<(), String> {
    let cut: HashSet<(u32, u32)> = left.ends.iter().chain(&left.units).map(|pair| (pair.a, pair.b)).collect();
    if cut.len() != left.ends.len() + left.units.len() {
        return Err("a pair twice".into());
    }
    let node = |at: u32| &nodes[at as usize];
    let overlap = |pair: &Pair| node(pair.a).volume.overlaps(&node(pair.b).volume);
    let leaves: Vec<u32> = (1..nodes.len() as u32).filter(|&i| node(i).is_leaf()).collect();
    let mut meeting = HashSet::new();
    for &p in &leaves {
        for &q in &leaves {
            // A pair is descended to in the order of the leaves.
            if node(p).last >= node(q).last {
                continue;
            }
            let mut pair = Pair { a: p, b: q };
            let mut met = cut.contains(&(p, q)) as u32;
            while pair != (Pair { a: ROOT, b: ROOT }) {
                pair = bvtt::parent(pair, above[pair.a as usize], above[pair.b as usize]);
                met += cut.contains(&(pair.a, pair.b)) as u32;
            }
            if met != 1 {
                return Err(format!("the leaves {p} and {q} have {met} pairs above them"));
            }
            if overlap(&Pair { a: p, b: q }) {
                meeting.insert((node(p).triangle(), node(q).triangle()));
            }
        }
    }
    let is_leaf = |pair: &Pair| node(pair.a).is_leaf() && node(pair.b).is_leaf();
    if let Some(pair) = left.ends.iter().find(|pair| overlap(pair) && !is_leaf(pair)) {
        return Err(format!("{pair:?} is no end"));
    }
    let found: HashSet<(u32, u32)> = left.pairs.iter().map(|pair| (pair.a, pair.b)).collect();
    if found.len() != left.pairs.len()
        || (left.units.is_empty() && found != meeting)
        || !found.is_subset(&meeting)
    {
        return Err(format!("{} candidates, not {}", left.pairs.len(), meeting.len()));
    }
    Ok(())
}

#[test]
fn ends_are_a_complete_cut() {
    for (leaves, length) in [(1, 1.0), (2, 1.0), (23, 5.0), (30, 2.5), (40, 0.5), (25, 30.0)] {
        let one = tree(leaves, length);
        for device in [engine()].into_iter().chain(ORDERS.map(sanitizer)) {
            for rounds in [Some(1), Some(2), Some(4), Some(400), None] {
                let left = run(&device, &one.0, rounds);
                assert_eq!(cut(&left, &one), Ok(()), "{leaves}, {rounds:?}");
                assert!(left.units.is_empty() || rounds.is_some_and(|rounds| rounds < 400));
            }
        }
    }
}

#[test]
fn a_cut_with_a_hole_is_noticed() {
    let one = tree(30, 2.5);
    let whole = run(&engine(), &one.0, None);
    assert_eq!(cut(&whole, &one), Ok(()));
    let with =
        |ends: Vec<Pair>, pairs: &[Pair]| cut(&Left { ends, pairs: pairs.to_vec(), units: Vec::new() }, &one);
    assert!(with(whole.ends[1..].to_vec(), &whole.pairs).is_err_and(|e| e.contains("0 pairs above")));
    let twice = [&whole.ends[..], &whole.ends[..1]].concat();
    assert!(with(twice, &whole.pairs).is_err_and(|e| e.contains("twice")));
    let end = whole.ends.iter().find(|end| end.a != end.b).expect("an end");
    let above = bvtt::parent(*end, one.1[end.a as usize], one.1[end.b as usize]);
    let also = [&whole.ends[..], &[above]].concat();
    assert!(with(also, &whole.pairs).is_err_and(|e| e.contains("2 pairs above")));
    assert!(with(whole.ends.clone(), &whole.pairs[1..]).is_err_and(|e| e.contains("candidates")));
}
