//! When an answer begins: who asks for the earliest time alone leaves out pairs by when they begin, so no answer may begin sooner.

use nearmiss_kernels::math::Vec3;
use nearmiss_kernels::prim::cubic::Moving;
use nearmiss_kernels::prim::inclusion::Params;
use nearmiss_kernels::prim::isolate::{Edges, Face, Pair, Rungs, ee_certified, vf_certified};
use rand::rngs::SmallRng;
use rand::{Rng, SeedableRng};

/// Where a pair may begin: the begin of its window with the margin, and without.
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

#[test]
fn no_answer_begins_before_its_window_with_the_margin() {
    let mut r = SmallRng::seed_from_u64(23);
    let p = Params::new(1e-4);
    let (mut met, mut in_the_margin) = (0, 0);
    for i in 0..6000 {
        let flat = i % 4 > 0;
        let height = r.random_range(0.0..1.0f32);
        let a = [0; 3].map(|_| point(&mut r, (0.0, 0.0), flat));
        let way = -r.random_range(0.5..2.0f32);
        let b = [0; 2].map(|_| point(&mut r, (height, way), flat));
        for rungs in [Rungs::All, Rungs::Single, Rungs::Double] {
            let told = [
                (vf_certified(b[0], a, rungs, &p), begins(&Face::new(b[0], a, &p))),
                (ee_certified([a[0], a[1]], b, rungs, &p), begins(&Edges::new([a[0], a[1]], b, &p))),
            ];
            for (verdict, begin) in told {
                if verdict.is_separated() {
                    continue;
                }
                let [with_margin, without] = begin.expect("what meets has a window").map(f64::from);
                assert!(verdict.toi >= with_margin, "{verdict:?} before {with_margin}: {a:?} {b:?}");
                met += 1;
                in_the_margin += (verdict.toi < without) as u32;
            }
        }
    }
    println!("{met} answers, {in_the_margin} of them begin in the margin");
    // So a pair may not be left out by its window alone.
    assert!(met > 1000 && in_the_margin > 100, "{met} {in_the_margin}");
}
