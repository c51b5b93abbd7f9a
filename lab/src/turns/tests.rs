//! The hunt in small, and that planted faults show.

use super::families::{Case, FAMILIES, case};
use super::hunt::{Fault, Row, fault, hunt, params, side, verdict};
use super::triangles::Triangles;
use crate::oracle::turning::Judge;
use nearmiss_kernels::prim::inclusion::{Answer, Params, Verdict};
use nearmiss_kernels::prim::turning::apart::Needed;
use nearmiss_kernels::prim::turning::rates::Rate;
use nearmiss_kernels::prim::turning::{Contact, Motion, chords};
use xxhash_rust::xxh3::xxh3_64;

/// Times that the judge may look at, of one pair.
const MOST: u32 = 2_000;

/// The code that has the verdict.
#[derive(Clone, Copy, Debug, PartialEq)]
enum By {
    /// The common case, then the walk.
    Both,
    /// The walk alone.
    Walk,
}

/// The verdict of a motion that was changed.
fn changed(by: By, case: &Case, vertex: fn(&mut Motion<3>), edge: fn(&mut Motion<4>)) -> Verdict {
    fn solved<const N: usize>(by: By, motion: &Motion<N>, p: &Params) -> Verdict {
        if by == By::Walk { motion.walk(p) } else { motion.verdict(p) }
    }
    let ([a, b], p) = (case.pair.sides.map(|s| side(&s)), params(case));
    if case.pair.is_face {
        let mut motion = Motion::<3>::new(&a, &b);
        vertex(&mut motion);
        solved(by, &motion, &p)
    } else {
        let mut motion = Motion::of_edges(&a, &b);
        edge(&mut motion);
        solved(by, &motion, &p)
    }
}

/// The verdict of the walk.
fn walked(case: &Case) -> Verdict {
    changed(By::Walk, case, |_| {}, |_| {})
}

/// The verdict of the common case, if it has one by these slices.
fn common(case: &Case, slices: u32) -> Option<Verdict> {
    let ([a, b], p) = (case.pair.sides.map(|s| side(&s)), params(case));
    let p = Params { max_iterations: slices, ..p };
    if case.pair.is_face { Motion::<3>::new(&a, &b).common(&p) } else { Motion::of_edges(&a, &b).common(&p) }
}

fn of(name: &str) -> usize {
    FAMILIES.iter().position(|family| *family == name).expect("a family")
}

fn faults(row: &Row) -> u64 {
    row.missed + row.late + row.falsely_certain + row.far_undecided
}

#[test]
fn no_verdict_is_wrong() {
    none_is_wrong(verdict);
}

#[test]
fn no_verdict_of_the_walk_alone_is_wrong() {
    none_is_wrong(walked);
}

fn none_is_wrong(solve: fn(&Case) -> Verdict) {
    let (mut contacts, mut separated, mut unjudged) = (0, 0, 0);
    for family in 0..FAMILIES.len() {
        let row = hunt(1, family, 30, MOST, solve);
        assert_eq!(faults(&row), 0, "{row:?}");
        assert_eq!(row.exhausted, 0, "{row:?}");
        // With a gap, inside and not in one plane, nearly all is decided.
        assert!(row.open <= 4, "{row:?}");
        contacts += row.contacts;
        separated += row.separated;
        unjudged += row.unjudged;
    }
    // The hunt has both, and the judge decides nearly all.
    assert!(contacts > 300 && separated > 80 && unjudged < 120, "{contacts}, {separated}, {unjudged}");
}

#[test]
fn both_orders_of_edges_have_the_same_bits() {
    for i in 0..100 {
        let mut c = case(2, i as usize % FAMILIES.len(), 2 * i + 1);
        let first = verdict(&c);
        c.pair.sides.reverse();
        assert_eq!(first, verdict(&c), "{i}");
    }
}

#[test]
fn bounds_of_a_fiftieth_are_noticed() {
    fn weak(rate: &mut Rate) {
        for part in [&mut rate.by_difference, &mut rate.own, &mut rate.by_distance] {
            *part /= 50.0;
        }
    }
    fn weaken<const N: usize>(motion: &mut Motion<N>) {
        weak(&mut motion.rates.second);
        weak(&mut motion.rates.third);
    }
    for by in [By::Both, By::Walk] {
        let row = hunt(1, of("generic"), 40, MOST, |c| changed(by, c, weaken, weaken));
        assert!(row.missed > 5, "{by:?}: {row:?}");
    }
}

/// Places that count as exact: the judge finds a fault among features that are very near.
#[test]
fn places_without_an_error_are_noticed() {
    fn exact<const N: usize>(motion: &mut Motion<N>) {
        motion.error = f64::MIN_POSITIVE;
    }
    let names = ["tangent", "coin", "sliding edges", "at the start"];
    // The first of these hunts that finds one ends the search.
    for by in [By::Both, By::Walk] {
        let hunts = [50, 250].into_iter().flat_map(|count| names.map(|name| (count, name)));
        let mut rows =
            hunts.map(|(count, name)| hunt(4, of(name), count, MOST, |c| changed(by, c, exact, exact)));
        assert!(rows.any(|row| faults(&row) > 0), "{by:?}: no fault is found");
    }
    let sound = names.map(|name| hunt(4, of(name), 50, MOST, verdict));
    assert_eq!(sound.iter().map(faults).sum::<u64>(), 0, "{sound:?}");
}

/// A certificate of control vectors that count as standing still is sometimes none. The pairs move
/// along their plane fast and through it slowly, over a border: the root is not well known.
#[test]
fn a_certificate_without_its_radius_is_noticed() {
    fn found<const N: usize>(by: By, c: &Case, part: f64) -> Option<Contact> {
        let [a, b] = c.pair.sides.map(|s| side(&s));
        let motion = Motion::<N>::new(&a, &b);
        let (from, to) = (motion.at((c.t - 1e-6).max(0.0)), motion.at((c.t + 1e-6).min(1.0)));
        if by == By::Both {
            return motion.only(&from, &to, &params(c), |moved| part * moved).map(|(found, _)| found);
        }
        motion.contact_by(&from, &to, c.tolerance * motion.scale, &mut -1.0, |moved| part * moved)
    }
    let family = of("slow on borders");
    let wrong = |by: By, part: f64| {
        let is_wrong = |i: &u64| {
            let c = case(5, family, *i);
            let found = if c.pair.is_face { found::<3>(by, &c, part) } else { found::<4>(by, &c, part) };
            found.is_some_and(|found| {
                let known = Judge::new(&c.pair, 0.0).first_contact(1.0, MOST);
                known.is_apart() || known.not_before > found.to
            })
        };
        (0..600).filter(is_wrong).count()
    };
    for by in [By::Both, By::Walk] {
        assert_eq!(wrong(by, 1.0), 0, "{by:?}");
        let fewest = wrong(by, 0.0);
        assert!(fewest >= 5, "{by:?}: {fewest}");
    }
}

/// A time that is one slice too late, and other wrong verdicts.
#[test]
fn wrong_verdicts_are_noticed() {
    let (mut late, mut missed, mut false_ones, mut far) = (0, 0, 0, 0);
    for i in 0..40 {
        let c = case(6, usize::from(i % 4 == 0), i);
        let known = Judge::new(&c.pair, 0.0).first_contact(1.0, MOST);
        let v = verdict(&c);
        assert_eq!(fault(&v, &known, &c), None);
        let Answer::Contact { toi, toi_upper } = v.answer() else { continue };
        let step = (toi_upper - toi).max(1e-10);
        let later = |state: fn(f64) -> Verdict| fault(&state(toi_upper + step), &known, &c);
        late += usize::from(later(|t| Verdict::contact(t, 1.0, 1, false)) == Some(Fault::Late));
        late += usize::from(later(|t| Verdict::undecided(t, 1.0, 1, false)) == Some(Fault::Late));
        missed += usize::from(fault(&Verdict::separated(1.0, 1), &known, &c) == Some(Fault::Missed));
        let before = Verdict::contact(0.0, toi - step, 1, false);
        false_ones += usize::from(fault(&before, &known, &c) == Some(Fault::FalselyCertain));
        let start = Verdict::undecided(0.0, 1.0, 1, false);
        far += usize::from(fault(&start, &known, &c) == Some(Fault::FarUndecided));
    }
    assert!(late > 60 && missed > 30 && false_ones > 30 && far > 30, "{late} {missed} {false_ones} {far}");
}

/// A filter: whether it leaves out the features of two triangles, within a gap.
type Filter<'a> = &'a dyn Fn(&Triangles, f64) -> bool;

/// For each filter, the pairs that it leaves out though they meet, and those that it leaves out of
/// all that certainly stay apart.
fn left_out<const N: usize>(names: &[&str], count: u64, filters: [Filter; N]) -> [(usize, usize, usize); N] {
    let mut all = [(0, 0, 0); N];
    for name in names {
        for i in 0..count {
            let c = case(7, of(name), i);
            let known = Judge::new(&c.pair, c.separation).first_contact(1.0, MOST);
            let way = i as usize / 2 % Triangles::WAYS;
            for (filter, (missed, parted, apart)) in filters.iter().zip(&mut all) {
                let is_left_out = filter(&Triangles::new(&c, way), c.separation);
                *missed += usize::from(is_left_out && known.is_contact());
                *apart += usize::from(known.is_apart());
                *parted += usize::from(is_left_out && known.is_apart());
            }
        }
    }
    all
}

#[test]
fn no_filter_leaves_out_features_that_meet() {
    let filters: [Filter; 3] = [
        &|pair, gap| pair.are_apart(gap, &Needed::ALL),
        &|pair, gap| pair.are_apart_by_chords(gap, &chords::Needed::ALL),
        &|pair, gap| pair.are_parted(gap, 1.0),
    ];
    let mut out = [0; 3];
    for name in FAMILIES {
        let of_family = left_out(&[name], 40, filters);
        println!("{name}: missed, left out, of all that are apart {of_family:?}");
        for (out, (missed, parted, _)) in out.iter_mut().zip(of_family) {
            assert_eq!(missed, 0, "{name}: {of_family:?}");
            *out += parted;
        }
    }
    // All families are near, and most turn far: chords show little of those.
    assert!(out[0] > 10, "{out:?}");
}

/// Half of the distance from the chord, and nine tenths of a gap.
#[test]
fn a_filter_that_needs_less_is_noticed() {
    let tangent = ["large radius", "tangent", "coin", "deformable tangent", "same pivot"];
    let half = Needed { deviation: 0.5, ..Needed::ALL };
    let none = Needed { deviation: 0.0, ..Needed::ALL };
    let filters: [Filter; 2] =
        [&|pair, gap| pair.are_apart(gap, &half), &|pair, gap| pair.are_apart(gap, &none)];
    let [(by_half, ..), (by_none, ..)] = left_out(&tangent, 120, filters);
    assert!(by_half >= 2 && by_none >= 25, "{by_half}, {by_none}");
    let gap = ["separation", "separation tangent", "separation deformable"];
    let less = Needed { gap: 0.9, ..Needed::ALL };
    let [(missed, ..)] = left_out(&gap, 120, [&|pair, gap| pair.are_apart(gap, &less)]);
    assert!(missed >= 5, "{missed}");
}

/// Chords without a part of the swells, or without any.
#[test]
fn chords_without_swells_are_noticed() {
    let of = |swell| chords::Needed { swell, ..chords::Needed::ALL };
    let filters: [Filter; 4] = [
        &|pair, gap| pair.are_apart_by_chords(gap, &of(0.5)),
        &|pair, gap| pair.are_apart_by_chords(gap, &of(0.0)),
        &|pair, gap| pair.are_parted(gap, 0.5),
        &|pair, gap| pair.are_parted(gap, 0.0),
    ];
    let missed = left_out(&FAMILIES, 120, filters).map(|(missed, ..)| missed);
    println!("{missed:?}");
    assert!(missed.iter().all(|&missed| missed > 0), "{missed:?}");
}

/// Fewer slices give fewer verdicts, the same ones. Even of hostile families a part is common.
#[test]
fn more_slices_keep_verdicts() {
    let (mut by_one, mut by_all) = (0, 0);
    for family in 0..FAMILIES.len() {
        for seed in 0..100 {
            let c = case(12, family, seed);
            let [one, six, most] = [1, 6, Params::MAX_ITERATIONS].map(|slices| common(&c, slices));
            assert!(one.is_none() || one == most, "{family} {seed}: {one:?}, {most:?}");
            assert!(six.is_none() || six == most, "{family} {seed}: {six:?}, {most:?}");
            assert_eq!(most.unwrap_or_else(|| walked(&c)), verdict(&c));
            assert_eq!(common(&c, 0).filter(|v| v.toi > 0.0), None);
            by_one += usize::from(one.is_some());
            by_all += usize::from(most.is_some());
        }
    }
    assert!(by_one > 200 && by_all > 900, "{by_one}, {by_all}");
}

/// Verdicts keep their bits, however walks are taken in turns. The second number is that of commit
/// 55f34054, whose walk was one loop without turns; the first has the common case before it.
#[test]
fn verdicts_keep_their_bits() {
    assert_eq!(hash(verdict), "190a4b8c591f3d58");
    assert_eq!(hash(walked), "9a48103c7b5faada");
}

/// A hash of verdicts of all families.
fn hash(solve: impl Fn(&Case) -> Verdict) -> String {
    let mut bytes = Vec::new();
    for family in 0..FAMILIES.len() {
        for seed in 0..200 {
            let v = solve(&case(11, family, seed));
            let words = [v.toi.to_bits(), v.toi_upper.to_bits(), (v.state as u64) << 32 | v.boxes as u64];
            bytes.extend(words.iter().flat_map(|word| word.to_le_bytes()));
        }
    }
    format!("{:016x}", xxh3_64(&bytes))
}
