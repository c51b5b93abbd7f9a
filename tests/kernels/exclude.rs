//! Bits never deny a partner, places of a bit have all its keys, and reaches never part features that
//! are near at rest.

use nearmiss_kernels::abi::{PartnerBits, RestReach, partner_key};
use nearmiss_kernels::math::Vec3;
use nearmiss_kernels::prim::near::distance;
use nearmiss_kernels::prim::nearest::Nearest;
use nearmiss_kernels::stage::narrow::exclude::is_listed;
use rand::rngs::SmallRng;
use rand::{Rng, SeedableRng};
use std::cell::Cell;

/// The bits of partners, and their keys, ascending.
fn table(partners: &[u32]) -> (PartnerBits, Vec<u32>) {
    let mut keys: Vec<u32> = partners.iter().map(|&vertex| partner_key(vertex)).collect();
    keys.sort_unstable();
    (keys.iter().fold(PartnerBits::default(), |bits, &key| bits.with(key)), keys)
}

/// Vertices around one of a sheet of that width, with up to `ring` edges between.
fn around(vertex: u32, width: u32, ring: i64) -> Vec<u32> {
    let steps = (-ring..=ring).flat_map(|x| (-ring..=ring).map(move |y| [x, y]));
    // A diagonal of each square is an edge.
    let near = steps.filter(|[x, y]| (x - y).abs() <= ring);
    near.map(|[x, y]| (vertex as i64 + x + y * width as i64) as u32).collect()
}

/// Lists of partners of every sort, and how many words a lookup may read.
fn lists(r: &mut SmallRng) -> Vec<Vec<u32>> {
    let mut all = vec![vec![], vec![0], vec![u32::MAX], vec![7, 7, 7]];
    for count in [1, 2, 19, 20, 64, 128, 300, 3000] {
        all.push((0..count).map(|_| r.random::<u32>()).collect());
        all.push((0..count).map(|_| r.random_range(0..400_u32)).collect());
        let first = r.random::<u32>() / 2;
        all.push((first..).take(count).collect());
    }
    for width in [3, 92, 128, 215, 1000, 4096, 65_536] {
        for ring in 1..6 {
            all.push(around(1_000_000 + r.random_range(0..1_000_000_u32), width, ring));
        }
    }
    all
}

/// The first vertex whose lookup is not that of the list, and how many keys the lookups read.
fn fault(bits: PartnerBits, keys: &[u32], r: &mut SmallRng) -> (Option<u32>, u32) {
    let read = Cell::new(0);
    // A table of another vertex is before it.
    let range = [5, 5 + keys.len() as u32];
    let word = |at: u32| {
        assert!((range[0]..range[1]).contains(&at), "outside the list");
        read.set(read.get() + 1);
        keys[at as usize - 5]
    };
    let near = keys.iter().flat_map(|&key| [key, key.wrapping_add(1), key ^ 1 << 24]).collect::<Vec<_>>();
    let others = (0..200).map(|_| r.random::<u32>()).collect::<Vec<_>>();
    let asked = near.into_iter().chain(others);
    let mut wrong = asked.filter(|&key| {
        let found = bits.has(key) && is_listed(bits, range, key, word);
        found != keys.contains(&key)
    });
    (wrong.next(), read.get())
}

#[test]
fn a_lookup_finds_the_partners_and_no_others() {
    let mut r = SmallRng::seed_from_u64(11);
    for _ in 0..20 {
        for partners in lists(&mut r) {
            let (bits, keys) = table(&partners);
            assert_eq!(fault(bits, &keys, &mut r).0, None, "{partners:?}");
            assert!(bits.count() as usize <= keys.len());
        }
    }
}

#[test]
fn a_missing_bit_or_another_order_is_noticed() {
    let mut r = SmallRng::seed_from_u64(12);
    let mut unordered = [0; 2];
    for partners in lists(&mut r).into_iter().filter(|partners| !partners.is_empty()) {
        let (_, keys) = table(&partners);
        let lost = keys[r.random_range(0..keys.len())];
        let others = keys.iter().filter(|&&key| key >> 25 != lost >> 25);
        let bits = others.fold(PartnerBits::default(), |bits, &key| bits.with(key));
        // Windows are longer with a bit too few, and may end behind the list.
        let wrong = keys.iter().find(|&&key| !bits.has(key));
        assert_eq!(wrong.map(|key| key >> 25), Some(lost >> 25), "{partners:?}");
        let (bits, mut keys) = table(&partners);
        if keys.first() != keys.last() && keys.len() < 128 {
            keys.reverse();
            unordered[0] += 1;
            unordered[1] += u32::from(fault(bits, &keys, &mut r).0.is_some());
        }
    }
    assert!(unordered[0] > 20 && unordered[1] * 10 > unordered[0] * 9, "{unordered:?}");
}

/// A key can be undone, so no two vertices have one.
#[test]
fn keys_are_of_one_vertex_each() {
    let mut r = SmallRng::seed_from_u64(13);
    // Inverses modulo 2^32.
    let inverse = |odd: u32| (0..5).fold(odd, |x, _| x.wrapping_mul(2u32.wrapping_sub(odd.wrapping_mul(x))));
    for vertex in (0..100_000).map(|_| r.random::<u32>()).chain([0, 1, u32::MAX]) {
        let x = partner_key(vertex).wrapping_mul(inverse(0x846c_a68b));
        let x = (x ^ x >> 15 ^ x >> 30).wrapping_mul(inverse(0x7feb_352d));
        assert_eq!(x ^ x >> 16, vertex);
    }
}

/// Vertices that are no partners mostly have a clear bit: 86 in 100 with the 19 partners of a ring of
/// 2. A set bit takes few words.
#[test]
fn a_clear_bit_decides_most_vertices_of_a_sheet() {
    let mut r = SmallRng::seed_from_u64(14);
    for width in [92, 128, 215, 1000, 1024] {
        let (mut passed, mut asked, mut words) = (0, 0, 0);
        for _ in 0..2000 {
            let vertex = 1_000_000 + r.random_range(0..1_000_000_u32);
            let partners = around(vertex, width, 2);
            let (bits, keys) = table(&partners);
            assert_eq!(keys.len(), 19);
            // Those of another fold, and those just beyond the ring.
            let far = r.random_range(0..2_000_000_u32);
            for other in around(far, width, 1).into_iter().chain(around(vertex, width, 4)) {
                let key = partner_key(other);
                if keys.contains(&key) {
                    continue;
                }
                asked += 1;
                if bits.has(key) {
                    passed += 1;
                    let read = Cell::new(0);
                    let word = |at: u32| {
                        read.set(read.get() + 1);
                        keys[at as usize]
                    };
                    assert!(!is_listed(bits, [0, 19], key, word));
                    words += read.get();
                }
            }
        }
        let rate = f64::from(passed) / f64::from(asked);
        assert!((0.12..0.15).contains(&rate), "{width}: {rate}");
        let each = f64::from(words) / f64::from(passed);
        assert!(each < 2.6, "{width}: {each} words");
    }
}

/// The reach of the first of these vertices, as the host computes it.
fn reach(places: &[Vec3<f64>], within: f64) -> RestReach {
    let own = RestReach::around(places[0].0);
    let extent = places.iter().fold(0.0, |most: f64, at| most.max(own.extent(at.0)));
    own.reaching(extent, within)
}

/// Whether features in reach that are parted are nearer than `within` at rest. Two triangles.
fn is_wrong([own, other]: [RestReach; 2], [p, q]: &[[Vec3<f64>; 3]; 2], within: f64) -> bool {
    own.is_apart(&other)
        && (distance::<f64, true>([p[0], q[0], q[1], q[2]]).0 < within
            || distance::<f64, false>([p[0], p[1], q[0], q[1]]).0 < within
            || Nearest::meeting(p, q).distance < within)
}

/// Two triangles whose reaches almost touch, and the distance.
fn at_border(r: &mut SmallRng) -> ([[Vec3<f64>; 3]; 2], f64) {
    let scale = [1.0, 1e-3, 1e6, 1e-42, 1e30][r.random_range(0..5_usize)];
    let size = [1.0, 1e-3, 0.0][r.random_range(0..3_usize)];
    let offset = [0.0, 1.0, 1000.0][r.random_range(0..3_usize)];
    let mut point = |by: f64| Vec3(std::array::from_fn(|_| r.random_range(-1.0..1.0) * by));
    let middle = point(offset);
    let [p, q] = [(); 2].map(|()| [(); 3].map(|()| (middle + point(size)) * scale));
    let within = [0.0, 1e-3, 0.5, 2.0][r.random_range(0..4_usize)] * scale + f64::MIN_POSITIVE;
    let axis = r.random_range(0..3_usize);
    let low = q.iter().fold(f64::MAX, |low, at| low.min(at[axis]));
    let high = p.iter().fold(f64::MIN, |high, at| high.max(at[axis]));
    let off = [0.0, 1e-15, 1e-7, 1e-5, 0.5][r.random_range(0..5_usize)] * r.random_range(-1.0..1.0);
    let mut by = [0.0; 3];
    by[axis] = high - low + within * (1.0 + off) + (high.abs() + low.abs()) * 1e-2 * off;
    ([p, q.map(|at| at + Vec3(by))], within)
}

#[test]
fn reaches_part_no_features_that_are_near_at_rest() {
    let mut r = SmallRng::seed_from_u64(15);
    let (mut apart, mut short) = ([0; 2], [0; 2]);
    for _ in 0..100_000 {
        let (pair, within) = at_border(&mut r);
        let own = [&pair[0], &pair[1]].map(|places| reach(places, within));
        assert!(!is_wrong(own, &pair, within), "{pair:?} {within:e}");
        apart[usize::from(own[0].is_apart(&own[1]))] += 1;
        // Faults: boxes of the first vertices alone, and boxes of half of the distance.
        let lone = [&pair[0], &pair[1]].map(|places| reach(&places[..1], within));
        let narrow = [&pair[0], &pair[1]].map(|places| reach(places, 0.5 * within));
        short[0] += u32::from(is_wrong(lone, &pair, within));
        short[1] += u32::from(is_wrong(narrow, &pair, within));
    }
    let all = [apart, short].concat();
    assert!(all.iter().all(|&count| count > 1000), "{all:?}");
}

#[test]
fn reaches_beyond_f32_decide_nothing_and_none_is_apart() {
    let at = |x: f64| RestReach::around([x, 0.0, 0.0]).reaching(1.0, 1.0);
    assert!(!at(1e300).is_apart(&at(0.0)) && !at(1e300).is_apart(&at(-1e300)));
    assert!(at(3.1).is_apart(&at(0.0)) && !at(2.9).is_apart(&at(0.0)));
    assert!(RestReach::NONE.is_apart(&at(0.0)) && RestReach::NONE.is_apart(&RestReach::NONE));
    assert!(!RestReach::around([0.0; 3]).reaching(1e300, 1.0).is_apart(&at(1e30)));
}
