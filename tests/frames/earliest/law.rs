//! The law by which pairs are skipped: no verdict begins before its pair's window less the margin.

use super::*;
use nearmiss_kernels::math::Vec3;
use nearmiss_kernels::prim::cubic::Moving;
use nearmiss_kernels::prim::inclusion::{Params, Verdict};
use nearmiss_kernels::prim::isolate::{Edges, Face, Rungs, ee_certified, vf_certified};

/// A pair of features: when its boxes, with their margin, first share a point, and its verdict.
struct Asked {
    not_before: f64,
    begin: f64,
    verdict: Verdict,
}

/// The pairs of features of two triangles, in f32 or f64, by the rungs of a solver.
fn pairs(two: &[Moved], rungs: Rungs, p: &Params) -> Vec<Asked> {
    let corner =
        |triangle: &Moved, k: usize| Moving::<f64> { t0: Vec3(triangle[0][k]), t1: Vec3(triangle[1][k]) };
    let mut all = Vec::new();
    let mut put = |window: Option<(f64, f64)>, not_before: f64, verdict: Verdict| {
        if let Some((begin, _)) = window {
            all.push(Asked { not_before, begin, verdict });
        } else {
            assert!(verdict.is_separated(), "{verdict:?} without a window");
        }
    };
    for (x, y) in [(&two[0], &two[1]), (&two[1], &two[0])] {
        for k in 0..3 {
            let (v, f) = (corner(x, k), [0, 1, 2].map(|k| corner(y, k)));
            let pair = Face::<f64>::new(v, f, p);
            let verdict = vf_certified(v, f, rungs, p);
            put(pair.window(), pair.window().map_or(0.0, |window| pair.not_before(window)), verdict);
        }
    }
    for (i, j) in (0..9).map(|k| (k / 3, k % 3)) {
        let edge = |t: &Moved, k: usize| [corner(t, k), corner(t, (k + 1) % 3)];
        let (a, b) = (edge(&two[0], i), edge(&two[1], j));
        let pair = Edges::<f64>::new(a, b, p);
        let verdict = ee_certified(a, b, rungs, p);
        put(pair.window(), pair.window().map_or(0.0, |window| pair.not_before(window)), verdict);
    }
    all
}

/// The law of a pair: whether its verdict begins before it may. A verdict of f32 keeps to the begin
/// and the margin of f32: 2^-12, and 2^-18 for what both begins err by.
fn breaks_the_law(pair: &Asked, rungs: Rungs) -> bool {
    let margin = if rungs == Rungs::Double { 0.0 } else { 1.0 / 4096.0 + 1.0 / 262_144.0 };
    !pair.verdict.is_separated() && pair.verdict.toi < pair.not_before - margin
}

/// The least time by a rule that skips pairs: those that begin, as the rule has it, no sooner than
/// what is known.
fn by_rule<'a>(pairs: impl Iterator<Item = &'a Asked>, begin: impl Fn(&Asked) -> f64) -> First {
    let mut known = u64::MAX;
    for pair in pairs {
        if earliest::key(begin(pair), false) < known && !pair.verdict.is_separated() {
            known = known.min(earliest::key(pair.verdict.toi, !pair.verdict.is_contact()));
        }
    }
    earliest::of_key(known)
}

/// Pairs of a few hundred scenes keep the law; a verdict that begins a little sooner breaks it, and
/// a rule that skips by another begin is named by the comparison of two orders.
#[test]
fn verdicts_keep_the_law_and_rules_that_skip_more_are_named() {
    let mut rng = Rng::new(5);
    let (mut kept, mut named, mut without_margin) = (0, 0, 0);
    for scene in 0..600u64 {
        let all = triangles(scene % 6, 4, &mut rng);
        let p = Params::new(TOLERANCES[(rng.bits() % 6) as usize]);
        for rungs in [Rungs::All, Rungs::Single, Rungs::Double] {
            let mut asked: Vec<Asked> = all.chunks(2).flat_map(|two| pairs(two, rungs, &p)).collect();
            assert!(asked.iter().all(|pair| !breaks_the_law(pair, rungs)), "scene {scene}, {rungs:?}");
            let wanted = by_rule(asked.iter(), |_| 0.0);
            for way in 0..2 {
                let law = |pair: &Asked| pair.not_before.min(pair.verdict.toi);
                let skipped = by_rule(
                    asked.iter(),
                    if rungs == Rungs::Double { |p: &Asked| p.not_before } else { law },
                );
                assert_eq!(fault(&format!("way {way}"), wanted, skipped), None, "scene {scene}, {rungs:?}");
                let less = by_rule(asked.iter(), |pair| pair.begin + 1.0 / 4096.0);
                without_margin += usize::from(fault("", wanted, less).is_some());
                asked.reverse();
            }
            kept += asked.iter().filter(|pair| !pair.verdict.is_separated()).count();
            // A former fault: a look around a time near the begin is not kept within the window.
            for pair in asked.iter_mut().filter(|pair| !pair.verdict.is_separated() && pair.not_before > 0.0)
            {
                pair.verdict.toi = pair.not_before - 1.0 / 2048.0;
                named += usize::from(breaks_the_law(pair, rungs));
            }
        }
    }
    println!("{kept} verdicts keep the law, {named} faults named, {without_margin} orders told apart");
    assert!(kept > 1_000 && named > 100 && without_margin > 10, "{kept}, {named}, {without_margin}");
}
