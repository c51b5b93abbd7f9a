//! The begin of an answer: an earliest query leaves out pairs by their begin, so no answer may
//! begin sooner.

use nearmiss_kernels::bv::{Linear, Volume};
use nearmiss_kernels::bvh::horizon::Horizon;
use nearmiss_kernels::math::Vec3;
use nearmiss_kernels::prim::cubic::Moving;
use nearmiss_kernels::prim::inclusion::Params;
use nearmiss_kernels::prim::isolate::{Edges, Face, Pair, Rungs, ee_certified, vf_certified};
use nearmiss_kernels::prim::sweep::meeting;
use rand::rngs::SmallRng;
use rand::{Rng, SeedableRng};

/// Possible begin of a pair: the begin of its window with the margin, and without.
fn begins<const N: usize>(pair: &Pair<f32, N>) -> Option<[f32; 2]> {
    let window = pair.window()?;
    Some([pair.with_margin(window).0, window.0])
}

/// A point of a small box at the start, and how it moves until the end; `flat` of the first feature lies in a plane.
fn point(r: &mut SmallRng, (height, way): (f32, f32), flat: bool) -> Moving<f32> {
    let mut at = |spread: f32| r.random_range(-spread..spread);
    let z = if flat { 0.0 } else { at(0.2) };
    let t0 = Vec3([at(1.0), at(1.0), height + z]);
    let t1 = t0 + Vec3([at(0.1), at(0.1), way]);
    Moving { t0, t1 }
}

/// Two triangles, of which the second falls on the first; three of four pairs are flat, each in a plane.
fn falling(seed: u64) -> impl Iterator<Item = [[Moving<f32>; 3]; 2]> {
    let mut r = SmallRng::seed_from_u64(seed);
    (0..6000).map(move |i| {
        let (height, way) = (r.random_range(0.0..1.0f32), -r.random_range(0.5..2.0f32));
        [(0.0, 0.0), (height, way)].map(|to| [0; 3].map(|_| point(&mut r, to, i % 4 > 0)))
    })
}

#[test]
fn no_answer_begins_before_its_window_with_the_margin() {
    let p = Params::new(1e-4);
    let (mut met, mut in_the_margin) = (0, 0);
    for [a, [v, w, _]] in falling(23) {
        let (edge, other) = ([a[0], a[1]], [v, w]);
        for rungs in [Rungs::All, Rungs::Single, Rungs::Double] {
            let told = [
                (vf_certified(v, a, rungs, &p), begins(&Face::new(v, a, &p))),
                (ee_certified(edge, other, rungs, &p), begins(&Edges::new(edge, other, &p))),
            ];
            for (verdict, begin) in told {
                if verdict.is_separated() {
                    continue;
                }
                let [with_margin, without] = begin.expect("what meets has a window").map(f64::from);
                assert!(verdict.toi >= with_margin, "{verdict:?} before {with_margin}: {a:?} {other:?}");
                met += 1;
                in_the_margin += (verdict.toi < without) as u32;
            }
        }
    }
    println!("{met} answers, {in_the_margin} of them begin in the margin");
    // So a pair may not be left out by its window alone.
    assert!(met > 1000 && in_the_margin > 100, "{met} {in_the_margin}");
}

/// With its own time known a pair stays: its triangles, and what is around them, meet before the horizon. Were the horizon at that time
/// itself, some would be left out.
#[test]
fn a_pair_is_never_behind_the_horizon_of_its_own_time() {
    let p = Params::new(1e-4);
    let (mut met, mut lost) = (0, [0; 2]);
    for [below, above] in falling(24) {
        let [a, b, _] = below;
        let told = [
            (vf_certified(above[0], below, Rungs::All, &p), 1 << 0),
            (ee_certified([a, b], [above[0], above[1]], Rungs::All, &p), 1 << 6),
        ];
        let volume = |c: [Moving<f32>; 3]| Linear::moving(c.map(|c| c.t0), c.map(|c| c.t1));
        for (verdict, test) in told {
            if verdict.is_separated() {
                continue;
            }
            met += 1;
            let horizon = Horizon::behind(verdict.toi);
            let meet = |time: f32| meeting(&above, &below, 0.0, time) & test != 0;
            assert!(meet(horizon.time()), "{verdict:?}: {above:?} {below:?}");
            let [x, y] = [volume(above), volume(below)].map(|volume| horizon.cut::<true, _>(volume));
            assert!(x.overlaps(&y), "{verdict:?}: {above:?} {below:?}");
            let exactly = (verdict.toi as f32).max(f32::MIN_POSITIVE);
            lost[0] += !meet(exactly) as u32;
            lost[1] += !volume(above).until(exactly).overlaps(&volume(below).until(exactly)) as u32;
        }
    }
    println!("{met} answers; behind a horizon without a margin: {lost:?}");
    assert!(met > 1000 && lost.iter().all(|&lost| lost > 100), "{met} {lost:?}");
}

#[test]
fn nothing_known_is_no_horizon() {
    for known in [f64::NAN, f64::from_bits(u64::MAX), 1.0, 0.9999, f64::INFINITY] {
        assert_eq!(Horizon::behind(known).time(), 1.0, "{known}");
    }
    assert!(Horizon::behind(0.0).time() > 0.0 && Horizon::behind(0.0).time() < 1e-3);
}
