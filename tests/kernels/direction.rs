//! A direction that parts two triangles: none is found for triangles that meet, however numbers round.

use nearmiss_kernels::math::{Real, Vec3};
use nearmiss_kernels::prim::cubic::Moving;
use nearmiss_kernels::prim::direction::{parted, parted_allowing};
use nearmiss_kernels::prim::sweep::{Corners, more};
use rand::rngs::SmallRng;
use rand::{Rng, SeedableRng};

/// Pairs of a family.
const PAIRS: usize = 20_000;

/// A vector of whole numbers: exact in every precision here.
type Whole = [i64; 3];

fn plus(a: Whole, b: Whole) -> Whole {
    [0, 1, 2].map(|k| a[k] + b[k])
}
fn times(a: Whole, by: i64) -> Whole {
    a.map(|x| x * by)
}
fn cross(a: Whole, b: Whole) -> Whole {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
fn any(rng: &mut SmallRng, most: i64) -> Whole {
    [0; 3].map(|_| rng.random_range(-most..=most))
}

/// A corner, as it is at both ends of the step.
type Path = [Whole; 2];

fn corners<R: Real>(paths: [Path; 3], offset: Whole) -> Corners<R> {
    let at = |x: Whole| Vec3(plus(x, offset).map(|x| R::of(x as f64)));
    paths.map(|[t0, t1]| Moving { t0: at(t0), t1: at(t1) })
}

/// A triangle that touches another one's plane from above, with one corner in the other triangle in the middle of the step.
fn resting(rng: &mut SmallRng) -> [[Path; 3]; 2] {
    let (u, v) = (any(rng, 60), any(rng, 60));
    let up = cross(u, v);
    let mut within = |most: i64| {
        let mut some = || rng.random_range(-most..=most);
        plus(times(u, some()), times(v, some()))
    };
    let q = [0; 3].map(|_| times(within(60), 4));
    let touched = [0, 1, 2].map(|k| (q[0][k] + q[1][k] + 2 * q[2][k]) / 4);
    let way = within(100);
    let mut above = || {
        let at = within(200);
        [plus(at, up), plus(at, times(up, 2))]
    };
    let p = [[plus(touched, times(way, -1)), plus(touched, way)], above(), above()];
    [p, q.map(|x| [x, x])]
}

/// Triangles in motion whose first edges, or a corner and the other one, meet in the middle of the step.
fn meeting(rng: &mut SmallRng, by_edges: bool) -> [[Path; 3]; 2] {
    let mut path = || [times(any(rng, 100), 8), times(any(rng, 100), 8)];
    let (mut p, q) = ([0; 3].map(|_| path()), [0; 3].map(|_| path()));
    // Four times what meets there; the last position is chosen so that it does.
    let weights = if by_edges { [1, 1, 0] } else { [1, 1, 2] };
    let of = |k: usize| (0..3).map(|i| weights[i] * (q[i][0][k] + q[i][1][k])).sum::<i64>();
    p[0][1] = [0, 1, 2].map(|k| {
        if by_edges { of(k) - p[0][0][k] - p[1][0][k] - p[1][1][k] } else { of(k) / 4 - p[0][0][k] }
    });
    [p, q]
}

/// How many of the pairs would be parted without an allowance for roundings; with it none may.
fn lost<R: Real>(seed: u64, pairs: impl Fn(&mut SmallRng, usize) -> [[Path; 3]; 2]) -> usize {
    let mut rng = SmallRng::seed_from_u64(seed);
    let mut lost = 0;
    for i in 0..PAIRS {
        let [p, q] = pairs(&mut rng, i);
        let offset = if i % 2 == 0 { [0; 3] } else { any(&mut rng, 1 << 20) };
        for turn in 0..3 {
            let [mut p, mut q] = [p, q];
            p.rotate_left(turn);
            q.rotate_left(i % 3);
            let (p, q) = (corners::<R>(p, offset), corners::<R>(q, offset));
            for (p, q) in [(p, q), (q, p)] {
                assert!(!parted(&p, &q, 0.0, false), "{p:?} {q:?}");
                lost += parted_allowing(&p, &q, 0.0, false, 0.0) as usize;
            }
        }
    }
    lost
}

#[test]
fn triangles_that_touch_are_not_parted() {
    for (name, lost) in
        [("f32", lost::<f32>(1, |rng, _| resting(rng))), ("f64", lost::<f64>(2, |rng, _| resting(rng)))]
    {
        println!("{name}: without its allowance {lost} of {} would be parted", 6 * PAIRS);
        assert!(lost > PAIRS / 100, "{name}: the pairs ask nothing of the allowance");
    }
}

#[test]
fn triangles_that_meet_are_not_parted() {
    lost::<f32>(3, |rng, i| meeting(rng, i % 2 == 0));
    lost::<f64>(4, |rng, i| meeting(rng, i % 2 == 0));
}

/// Within the gap, by a shift of known length; and parted where the gap is smaller.
#[test]
fn features_within_the_gap_are_not_parted() {
    let (mut rng, mut apart) = (SmallRng::seed_from_u64(5), 0);
    for i in 0..PAIRS {
        let [p, q] = meeting(&mut rng, i % 2 == 0);
        let shift = times([[3, 0, 4], [0, -3, 4], [-4, 3, 0]][i % 3], 1 + i as i64 % 97);
        let p = corners::<f32>(p.map(|path| path.map(|x| plus(x, shift))), [0; 3]);
        let q = corners::<f32>(q, [0; 3]);
        let distance = 5.0 * (1 + i % 97) as f64;
        assert!(!parted(&p, &q, more(distance), false), "{p:?} {q:?} {distance}");
        apart += parted(&p, &q, 0.0, false) as usize;
    }
    println!("{apart} of {PAIRS} would be parted without the gap");
    assert!(apart > PAIRS / 1000);
}

/// Triangles that are apart by a hundred-thousandth of their size are parted, at any place.
#[test]
fn triangles_a_little_apart_are_parted() {
    let flat = |z: f32, o: f32| -> Corners<f32> {
        [[0.0, 0.0], [1.0, 0.25], [0.25, 1.0]]
            .map(|[x, y]| Vec3([x + o, y + o, z]))
            .map(|at| Moving { t0: at, t1: at + Vec3([0.5, 0.0, 0.0]) })
    };
    for o in [0.0, 1.0, 1000.0] {
        assert!(parted(&flat(1e-5, o), &flat(0.0, o), 0.0, false), "{o}");
        assert!(parted(&flat(0.0, o), &flat(1e-5, o), 0.0, false), "{o}");
        assert!(!parted(&flat(1e-5, o), &flat(0.0, o), 2e-5, false), "{o}: the gap");
        assert!(parted(&flat(0.25, o), &flat(0.0, o), more(0.2499), false), "{o}");
        // Apart at both ends, but on different sides.
        let mut through = flat(0.25, o);
        through.iter_mut().for_each(|corner| corner.t1.0[2] = -0.25);
        assert!(!parted(&through, &flat(0.0, o), 0.0, false), "{o}");
    }
}

/// Neighbours in a plane around one corner: only with the rule for a common corner, and not if they fold over each other.
#[test]
fn triangles_around_a_common_corner_are_parted() {
    let fan = |a: [f32; 2], b: [f32; 2]| -> Corners<f32> {
        [[0.0, 0.0], a, b].map(|[x, y]| Vec3([x, y, 7.0])).map(|at| Moving { t0: at, t1: at })
    };
    let (p, q) = (fan([1.0, 0.5], [1.0, -0.5]), fan([-1.0, 0.5], [-1.0, -0.5]));
    assert!(parted(&p, &q, 0.0, true) && parted(&q, &p, 0.0, true));
    assert!(!parted(&p, &q, 0.0, false));
    let folded = fan([0.5, 0.5], [-1.0, -0.5]);
    assert!(!parted(&p, &folded, 0.0, true) && !parted(&folded, &p, 0.0, true));
    // A common edge, too: its other corner is in both.
    let edge = fan([1.0, 0.5], [0.0, 1.0]);
    assert!(!parted(&p, &edge, 0.0, true) && !parted(&edge, &p, 0.0, true));
}

/// A common corner, and edges or a corner and a face beyond it that meet.
#[test]
fn features_that_meet_beyond_a_common_corner_are_not_parted() {
    let mut rng = SmallRng::seed_from_u64(6);
    let mut around = 0;
    for i in 0..PAIRS {
        // Both edges that meet are opposite to the common corner, or one of them is.
        let [[a, b, _], [c, d, _]] = meeting(&mut rng, true);
        let corner = [times(any(&mut rng, 100), 8), times(any(&mut rng, 100), 8)];
        for [p, q] in [[[corner, a, b], [corner, c, d]], [[corner, a, b], [corner, d, c]]] {
            let (p, q) = (corners::<f32>(p, [0; 3]), corners::<f32>(q, [0; 3]));
            assert!(!parted(&p, &q, 0.0, true), "{i}: {p:?} {q:?}");
        }
        let apart = [[corner, a, b], [corner, c.map(|x| times(x, -3)), d.map(|x| times(x, -3))]];
        let [p, q] = apart.map(|t| corners::<f32>(t, [0; 3]));
        around += parted(&p, &q, 0.0, true) as usize;
    }
    println!("of {PAIRS} others around a corner {around} are parted");
    assert!(around > PAIRS / 1000);
}

/// Positions of f32 in doubles have the same result, also if their sizes differ by more than the digits of a double.
#[test]
fn doubles_that_are_singles_change_nothing() {
    let (mut rng, mut found) = (SmallRng::seed_from_u64(8), 0);
    for i in 0..PAIRS {
        let mut at = || {
            let size = if i % 2 == 0 { 0 } else { rng.random_range(-40..=20) };
            Vec3([0; 3].map(|_| rng.random_range(-1.0f32..=1.0) * (size as f32).exp2()))
        };
        let mut path = || Moving { t0: at(), t1: at() };
        let (p, q): (Corners<f32>, Corners<f32>) = ([0; 3].map(|_| path()), [0; 3].map(|_| path()));
        let wide = |t: Corners<f32>| t.map(|x| Moving { t0: x.t0.wide(), t1: x.t1.wide() });
        for has_common in [false, true] {
            let is_parted = parted(&p, &q, 0.0, has_common);
            assert_eq!(is_parted, parted(&wide(p), &wide(q), 0.0, has_common), "{p:?} {q:?}");
            found += is_parted as usize;
        }
    }
    println!("{found} of {} are parted", 2 * PAIRS);
    assert!(found > PAIRS / 100);
}

/// Two normals that are equally near to the difference of the centroids: no order is preferred.
#[test]
fn order_changes_nothing_for_equal_triangles() {
    let (mut rng, mut found) = (SmallRng::seed_from_u64(9), 0);
    for i in 0..PAIRS {
        let mut path = || [any(&mut rng, 50), any(&mut rng, 50)];
        let (p, by) = ([0; 3].map(|_| path()), path());
        // A copy, shifted alike at both ends, or turned over.
        let mut q = p.map(|x| x.map(|x| plus(x, by[0])));
        if i % 2 == 1 {
            q.swap(1, 2);
        }
        let (p, q) = (corners::<f32>(p, [0; 3]), corners::<f32>(q, [0; 3]));
        let is_parted = parted(&p, &q, 0.0, false);
        assert_eq!(is_parted, parted(&q, &p, 0.0, false), "{p:?} {q:?}");
        found += is_parted as usize;
    }
    println!("{found} of {PAIRS} are parted");
    assert!(found > PAIRS / 100);
}

/// The triangles may come in either order, and anywhere.
#[test]
fn order_and_place_change_nothing() {
    let (mut rng, mut found) = (SmallRng::seed_from_u64(7), 0);
    for _ in 0..PAIRS {
        let mut path = || [any(&mut rng, 50), any(&mut rng, 50)];
        let (p, q) = ([0; 3].map(|_| path()), [0; 3].map(|_| path()));
        // Even, so that the middle of two corners is exact wherever they are.
        let offset = times(any(&mut rng, 1 << 20), 2);
        let at = |offset| (corners::<f32>(p, offset), corners::<f32>(q, offset));
        let (p, q) = at([0; 3]);
        let (far_p, far_q) = at(offset);
        let is_parted = parted(&p, &q, 0.0, false);
        assert_eq!(is_parted, parted(&q, &p, 0.0, false), "{p:?} {q:?}");
        assert_eq!(is_parted, parted(&far_p, &far_q, 0.0, false), "{p:?} {q:?} {offset:?}");
        found += is_parted as usize;
    }
    println!("{found} of {PAIRS} are parted");
    assert!(found > PAIRS / 100);
}
