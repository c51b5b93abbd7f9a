//! With a separation f64 begins at the time that f32 has proven: against f64 alone, which begins at
//! the start.

use nearmiss_kernels::math::Vec3;
use nearmiss_kernels::prim::cubic::Moving;
use nearmiss_kernels::prim::inclusion::{Params, Verdict};
use nearmiss_kernels::prim::isolate::separation::{in_double, in_single};
use nearmiss_kernels::prim::isolate::{Edges, Face, Rungs, ee_certified, vf_certified};
use rand::rngs::SmallRng;
use rand::{Rng, SeedableRng};

/// A pair that f32 leaves, by f64: from which time, alone, and from that time.
struct Left {
    from: f64,
    alone: Verdict,
    said: Verdict,
}

/// The fault of a pair, if it has one. The first time of a contact is in the intervals of both.
fn fault(Left { from, alone, said }: &Left) -> Option<&'static str> {
    if alone.is_contact() && *from > alone.toi_upper {
        return Some("f64 begins behind a contact");
    }
    if !said.is_separated() && said.toi < *from {
        return Some("a time that is parted is listed");
    }
    if alone.is_contact() && said.is_separated() || said.is_contact() && alone.is_separated() {
        return Some("one of two certain answers is wrong");
    }
    let disjoint = said.toi > alone.toi_upper || alone.toi > said.toi_upper;
    (alone.is_contact() && said.is_contact() && disjoint).then_some("no time is in both intervals")
}

/// Points that move past or towards each other, in f32 or with more digits.
fn points(r: &mut SmallRng, single: bool) -> [Moving<f64>; 4] {
    let mut point = |height: f64, way: f64| {
        let mut at = |spread: f64| r.random_range(-spread..spread);
        let t0 = [at(1.0), at(1.0), height + at(0.2)];
        let t1 = [t0[0] + at(0.3), t0[1] + at(0.3), t0[2] + way + at(0.1)];
        let round = |p: [f64; 3]| Vec3(p.map(|x| if single { f64::from(x as f32) } else { x }));
        Moving { t0: round(t0), t1: round(t1) }
    };
    let (height, way) = (0.7, -0.9);
    [point(height, way), point(0.0, 0.0), point(0.0, 0.0), point(0.0, 0.0)]
}

/// Pairs of both kinds that f32 leaves, with what f64 says if `late` is added to the proven time.
/// The ladder of one pair must say what the two rungs say.
fn left(seed: u64, p: &Params, late: f64) -> Vec<Left> {
    let mut r = SmallRng::seed_from_u64(seed);
    let mut all = Vec::new();
    for i in 0..6000 {
        let [v, a, b, c] = points(&mut r, i % 2 == 0);
        let (face, edges) = ([a, b, c], ([v, a], [b, c]));
        let of_face = Face::<f64>::new(v, face, p);
        let of_edges = Edges::<f64>::new(edges.0, edges.1, p);
        let (one, two) = (
            in_single(&Face::<f32>::new(v, face, p), p),
            in_single(&Edges::<f32>::new(edges.0, edges.1, p), p),
        );
        if late == 0.0 {
            let rungs = one.unwrap_or_else(|from| in_double(of_face, from, p));
            assert_eq!(vf_certified(v, face, Rungs::All, p), rungs);
            let rungs = two.unwrap_or_else(|from| in_double(of_edges, from, p));
            assert_eq!(ee_certified(edges.0, edges.1, Rungs::All, p), rungs);
        }
        let mut put = |from: Result<Verdict, f64>, ask: &dyn Fn(f64) -> Verdict| {
            if let Err(from) = from {
                let from = from + late;
                all.push(Left { from, alone: ask(0.0), said: ask(from) });
            }
        };
        put(one, &|from| in_double(of_face, from, p));
        put(two, &|from| in_double(of_edges, from, p));
    }
    all
}

/// Tolerances that f32 resolves for many pairs, few and none.
fn params() -> impl Iterator<Item = Params> {
    [1e-5, 1e-6, 1e-8].into_iter().flat_map(|tolerance| {
        [1e-3, 0.05].map(|min_separation| Params { min_separation, ..Params::new(tolerance) })
    })
}

#[test]
fn f64_begins_where_f32_ends_and_finds_the_same() {
    let (mut some, mut begun, mut met) = (0, 0, 0);
    for (seed, p) in params().enumerate() {
        for pair in left(seed as u64, &p, 0.0) {
            assert_eq!(fault(&pair), None, "{p:?}: from {}, {:?}, {:?}", pair.from, pair.alone, pair.said);
            some += 1;
            begun += usize::from(pair.from > 0.0);
            met += usize::from(pair.said.is_contact());
        }
    }
    println!("{some} pairs are left, {begun} of them later than the start, {met} in contact");
    assert!(begun * 2 > some && met > 1000, "{some}, {begun}, {met}");
}

/// Were the proven time late, by less than a thousandth of the step, most contacts would be named.
#[test]
fn a_time_that_is_late_would_be_named() {
    let (mut named, mut met) = (0, 0);
    for (seed, p) in params().enumerate() {
        for pair in left(seed as u64, &p, 1.0 / 1024.0) {
            named += usize::from(fault(&pair).is_some());
            met += usize::from(pair.alone.is_contact());
        }
    }
    println!("{named} faults named, of {met} contacts");
    assert!(named * 2 > met && met > 1000, "{named} of {met}");
}

/// A number that is no time of the step proves nothing: f64 begins at the start.
#[test]
fn what_is_no_time_proves_nothing() {
    let p = Params { min_separation: 1e-3, ..Params::new(1e-6) };
    let [v, a, b, c] = points(&mut SmallRng::seed_from_u64(1), true);
    let ask = |from| in_double(Face::<f64>::new(v, [a, b, c], &p), from, &p);
    for from in [f64::NAN, -1.0, 1.5, f64::INFINITY] {
        assert_eq!(ask(from), ask(0.0), "{from}");
    }
}
