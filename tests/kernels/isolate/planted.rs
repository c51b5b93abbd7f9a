//! Premises of the certificates, against contacts whose times are known exactly. Each of them is
//! weakened, and the weak one is seen to be wrong.

use super::rung::{certified, deciding, points};
use nearmiss_kernels::math::tolerance::Tolerance;
use nearmiss_kernels::math::{Real, Vec3};
use nearmiss_kernels::prim::cubic::Moving;
use nearmiss_kernels::prim::inclusion::{Grid, Params, Verdict};
use nearmiss_kernels::prim::isolate::suspect::Around;
use nearmiss_kernels::prim::isolate::{Edges, Face, Pair, Rungs};
use nearmiss_lab::oracle::first_contact;
use nearmiss_lab::pairs::built::{Built, REACH_F32, built};
use nearmiss_lab::{Case, Features};
use rand::rngs::SmallRng;
use rand::{Rng, SeedableRng};
use support::fuzz::continuous::fault;

/// Contacts at a known time, of coordinates that f32 holds.
fn contacts(seed: u64, n: usize) -> impl Iterator<Item = (Built, f64)> {
    let fits = |built: &Built| built.case.fits_f32();
    built(seed, n, REACH_F32).into_iter().filter(fits).filter_map(|built| built.toi.map(|toi| (built, toi)))
}

/// A property of a pair of either kind.
trait Ask {
    type Outcome;
    fn ask<const N: usize>(self, pair: &Pair<f32, N>) -> Self::Outcome;
}

fn of<A: Ask>(built: &Built, ask: A) -> A::Outcome {
    stored::<f32, A>(&built.case, ask)
}

/// The same, of positions in R.
fn stored<R: Real, A: Ask>(case: &Case, ask: A) -> A::Outcome {
    let ([a, b, c, d], p) = (points::<R>(case), Params::new(0.0));
    match case.features {
        Features::VertexFace => ask.ask(&Face::new(a, [b, c, d], &p)),
        Features::EdgeEdge => ask.ask(&Edges::new([a, b], [c, d], &p)),
    }
}

/// By how much a time is outside of the window.
struct Outside(f64);
impl Ask for Outside {
    type Outcome = f64;
    fn ask<const N: usize>(self, pair: &Pair<f32, N>) -> f64 {
        let Some((from, to)) = pair.window() else { return f64::INFINITY };
        (f64::from(from) - self.0).max(self.0 - f64::from(to))
    }
}

/// Whether a direction is said to part the features from a time until another.
struct Parted(f32, f32);
impl Ask for Parted {
    type Outcome = bool;
    fn ask<const N: usize>(self, pair: &Pair<f32, N>) -> bool {
        pair.misses_throughout(self.0, self.1)
    }
}

/// A direction parts no time that holds a contact, however short it is; it does part times that are said to end before.
#[test]
fn no_direction_parts_what_meets() {
    let mut parted = 0;
    for (built, toi) in contacts(27, 60) {
        let (below, above) = (toi as f32 * (1.0 - f32::EPSILON), toi as f32 * (1.0 + f32::EPSILON));
        for (from, to) in [(0.0, 1.0), (0.0, above.min(1.0)), (below, above.min(1.0)), (below, 1.0)] {
            assert!(!of(&built, Parted(from, to)), "{} at {toi}: parted in [{from}, {to}]", built.name);
        }
        // The same question with the contact left out is answered otherwise: the first would see a certificate that is wrong.
        parted += u32::from(toi > 0.0 && of(&built, Parted(0.0, 0.5 * toi as f32)));
    }
    assert!(parted > 100, "only {parted} are parted before they meet");
}

/// The same of pairs that are so flat on an axis that f32 has no digits for it, or nearly none.
#[test]
fn no_direction_parts_what_meets_on_a_flat_axis() {
    let mut asked = 0;
    for (built, toi) in contacts(29, 20) {
        for (axis, power) in (0..3).flat_map(|axis| (90..160).step_by(5).map(move |power| (axis, power))) {
            let mut case = built.case;
            for p in case.positions_t0.iter_mut().chain(&mut case.positions_t1) {
                p[axis] *= 2f64.powi(-power);
            }
            let parted = stored::<f64, _>(&case, Parted(0.0, 1.0));
            assert!(!parted, "{} at {toi}, axis {axis} by 2^-{power}", built.name);
            asked += 1;
        }
    }
    assert!(asked > 10_000, "{asked}");
}

#[test]
fn contacts_are_inside_of_their_window() {
    for (built, toi) in contacts(21, 60) {
        let outside = of(&built, Outside(toi));
        assert!(outside <= 0.0, "{} at {toi}: outside by {outside}", built.name);
    }
}

/// A vertex that falls straight down on a flat face: their boxes share one moment, a quotient of integers. A window that was
/// not widened loses it as often as not.
#[test]
fn a_window_that_is_not_widened_loses_contacts() {
    let mut r = SmallRng::seed_from_u64(21);
    let (mut late, mut early) = (0, 0);
    for _ in 0..2_000 {
        let [above, below] = [0; 2].map(|_| f64::from(r.random_range(1..1 << 20)));
        let at = |z: f64| Vec3([1.0, 1.0, z].map(f32::of));
        let still = |x: f64, y: f64| Vec3([x, y, 0.0].map(f32::of));
        let corner = |x, y| Moving { t0: still(x, y), t1: still(x, y) };
        let v = Moving { t0: at(above), t1: at(-below) };
        let pair =
            Face::<f32>::new(v, [corner(0.0, 0.0), corner(4.0, 0.0), corner(0.0, 4.0)], &Params::new(0.0));
        let (from, to) = pair.window().map(|(from, to)| (f64::from(from), f64::from(to))).expect("a window");
        // The time is above / sum; products of 24 and 22 bits are exact.
        let sum = above + below;
        assert!(from * sum <= above && above <= to * sum, "{above} {below}: {from} {to}");
        let width = f64::from(f32::ISOLATE_WINDOW);
        late += u32::from((from + width) * sum > above);
        early += u32::from((to - width) * sum < above);
    }
    println!("2000 asked: {late} would begin too late, {early} end too early");
    assert!(late > 100 && early > 100);
}

/// The cubic at a time of contact, where it is zero: its largest computed value over its error.
struct AtContact(f64);
impl Ask for AtContact {
    type Outcome = f64;
    fn ask<const N: usize>(self, pair: &Pair<f32, N>) -> f64 {
        let (g, t) = (pair.cubic(), f32::of(self.0));
        let part = g.part(t, t);
        part.iter().fold(0.0, |most: f64, x| most.max(f64::from(x.abs() / g.error)))
    }
}

/// Times of contact are exact in f32. All coefficients of a moment are the value there.
#[test]
fn a_cubic_with_less_error_would_reject_contacts() {
    let mut most = 0f64;
    for (built, toi) in contacts(22, 120) {
        let ratio = of(&built, AtContact(toi));
        assert!(ratio <= 1.0, "{} at {toi}: {ratio} of its error", built.name);
        most = most.max(ratio);
    }
    println!("at most {most} of the error");
    assert!(most > 1.0 / 40.0, "an error of one rounding would be noticed: {most}");
}

/// Verdicts around a time, looking from a little off; and at that moment alone.
struct Looks {
    toi: f64,
    off: f64,
}
impl Ask for Looks {
    type Outcome = [Around; 2];
    fn ask<const N: usize>(self, pair: &Pair<f32, N>) -> [Around; 2] {
        let t = f32::of((self.toi + self.off).clamp(0.0, 1.0));
        let half = (f64::from(t) - self.toi).abs();
        // Rounded up.
        [pair.around(t, f32::of(half).next_up()), pair.around(t, 0.0)]
    }
}

/// No look around a time at which the features meet says that they miss. A look that takes no time into account does.
#[test]
fn a_look_that_ignores_its_time_misses_contacts() {
    let mut r = SmallRng::seed_from_u64(23);
    let (mut holds, mut misses) = (0, 0);
    for (built, toi) in contacts(23, 60) {
        for _ in 0..4 {
            let off = 2f64.powi(-r.random_range(2..22)) * if r.random() { 1.0 } else { -1.0 };
            let [around, alone] = of(&built, Looks { toi, off });
            assert_ne!(around, Around::Misses, "{} at {toi}, looked at {off} off", built.name);
            holds += u32::from(around == Around::Holds);
            misses += u32::from(alone == Around::Misses);
        }
    }
    println!("{holds} hold; {misses} would be missed");
    assert!(holds > 100 && misses > 100);
}

/// Whether the hull holds the origin at some look, if only the four points share a plane: that they do is for the sign of
/// the cubic to show.
struct Holds;
impl Ask for Holds {
    type Outcome = [bool; 2];
    fn ask<const N: usize>(self, pair: &Pair<f32, N>) -> [bool; 2] {
        let mut told = [false; 2];
        for i in 0..8 {
            let (from, to) = (i as f32 / 8.0, (i + 1) as f32 / 8.0);
            let holds = pair.around((from + to) * 0.5, 1.0 / 1024.0) == Around::Holds;
            told[0] |= holds;
            told[1] |= holds
                && pair
                    .cubic()
                    .changes_sign((from + to) * 0.5 - 1.0 / 1024.0, (from + to) * 0.5 + 1.0 / 1024.0);
        }
        told
    }
}

#[test]
fn a_certificate_without_a_change_of_sign_would_be_false() {
    let (mut alone, mut asked) = (0, 0);
    for built in built(24, 150, 64).into_iter().filter(|built| built.toi.is_none()) {
        let [holds, both] = of(&built, Holds);
        assert!(!both, "a contact of what is apart: {:?}", built.case);
        alone += u32::from(holds);
        asked += 1;
    }
    println!("{alone} of {asked} near misses are held");
    assert!(alone > 10);
}

/// A vertex that goes through a point of a face in motion, with all digits that f32 has.
fn passes(r: &mut SmallRng) -> Case {
    let mut float = || f64::from(r.random_range(-1f32..1.0));
    let mut point = || [float(), float(), float()];
    let mut points = [[point(), point(), point(), point()], [point(), point(), point(), point()]];
    let (t, u, v) = (r.random_range(0.1..0.9), r.random_range(0.1..0.4), r.random_range(0.1..0.4));
    let end = [0, 1, 2].map(|k| {
        let corner = |i: usize| points[0][i][k] * (1.0 - t) + points[1][i][k] * t;
        let through = corner(1) * (1.0 - u - v) + corner(2) * u + corner(3) * v;
        f64::from(((through - points[0][0][k] * (1.0 - t)) / t) as f32)
    });
    points[1][0] = end;
    let [positions_t0, positions_t1] = points;
    Case { features: Features::VertexFace, positions_t0, positions_t1 }
}

/// How far the time of a contact is from the middle of what f32 says of it, of what it may be: all of the time around a root
/// that signs need is needed, but for what proofs have to spare.
#[test]
fn a_shorter_time_around_a_root_would_be_false() {
    let (p, mut r) = (Params::new(0.0), SmallRng::seed_from_u64(28));
    let (mut most, mut asked) = (0f64, 0);
    for _ in 0..10_000 {
        let case = passes(&mut r);
        let said = certified::<f32>(&case, Rungs::Single, &p);
        if !said.is_contact() {
            continue;
        }
        let first = first_contact(&case).expect("a contact");
        let (low, high) = first.bracket();
        let (middle, half) = ((said.toi + said.toi_upper) * 0.5, (said.toi_upper - said.toi) * 0.5);
        let off = (low - middle).abs().max((high - middle).abs());
        assert!(off <= half, "{low}: {said:?} of {case:?}");
        most = most.max(off / half);
        asked += 1;
    }
    println!("at most {most} of the time, of {asked}");
    assert!(most > 0.1, "a tenth would be noticed: {most}");
}

/// The judge of these tests names every kind of lie.
#[test]
fn lies_are_named() {
    let p = Params::new(1e-6);
    type Lie = fn(Verdict) -> Verdict;
    let lies: [(Lie, &str); 5] = [
        (|_| Verdict::separated(1.0, 0), "missed"),
        (|v| Verdict { toi: v.toi_upper + 1e-4, toi_upper: 1.0, ..v }, "late"),
        (
            |v| Verdict { toi: 0.0, toi_upper: v.toi * 0.5, ..v },
            "a false certificate: the contact is after toi_upper",
        ),
        (|v| Verdict { toi: f64::NAN, ..v }, "times out of range"),
        (|v| Verdict { toi_upper: 0.0, ..v }, "times out of range"),
    ];
    let all: Vec<Built> = contacts(25, 5).filter(|(_, toi)| *toi == 0.5).map(|(built, _)| built).collect();
    for (lie, named) in lies {
        let named_so = all.iter().any(|built| {
            let truth = first_contact(&built.case);
            let said = certified::<f64>(&built.case, Rungs::All, &p);
            assert_eq!(fault(&said, truth.as_ref()), None);
            fault(&lie(said), truth.as_ref()) == Some(named)
        });
        assert!(named_so, "{named}");
    }
    let apart = built(26, 1, 8).into_iter().find(|built| built.toi.is_none()).expect("a near miss");
    let (_, said) = deciding::<f64>(&apart.case, &p);
    let lie = Verdict::contact(0.0, 1.0, 0, false);
    assert_eq!((fault(&said, None), fault(&lie, None)), (None, Some("a false certificate")));
}

/// The same in f64.
#[test]
fn in_doubles_contacts_are_in_their_windows_and_on_their_cubics() {
    fn ask<S: Grid, const N: usize>(pair: &Pair<S, N>, toi: f64) -> bool {
        let t = S::of(toi);
        let Some((from, to)) = pair.window() else { return false };
        let g = pair.cubic();
        from <= t
            && t <= to
            && g.part(t, t).iter().all(|x| x.abs() <= g.error)
            && pair.around(t, S::ZERO) != Around::Misses
    }
    for (built, toi) in built(27, 60, 1 << 30).into_iter().filter_map(|b| b.toi.map(|toi| (b, toi))) {
        let ([a, b, c, d], p) = (points::<f64>(&built.case), Params::new(0.0));
        let right = match built.case.features {
            Features::VertexFace => ask(&Face::<f64>::new(a, [b, c, d], &p), toi),
            Features::EdgeEdge => ask(&Edges::<f64>::new([a, b], [c, d], &p), toi),
        };
        assert!(right, "{} at {toi}", built.name);
    }
}
