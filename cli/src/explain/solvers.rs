//! The solvers, run on one pair by the functions that the kernels call.

use super::judge::Said;
use super::subject::{Moving, Still};
use nearmiss_kernels::math::{Real, Vec3};
use nearmiss_kernels::prim::adjacent::{Shared, meets_beyond_shared};
use nearmiss_kernels::prim::cubic::{Moving as Point, ee_toi, vf_toi};
use nearmiss_kernels::prim::inclusion::{Params, Verdict};
use nearmiss_kernels::prim::isolate::{Rungs, ee_certified, vf_certified};
use nearmiss_kernels::prim::moller::moller;
use nearmiss_kernels::prim::signs::Certain;
use nearmiss_lab::case::{Case, Features};

/// A solver's answer.
pub struct Answer {
    pub solver: &'static str,
    pub said: Said,
    /// Boxes looked at, by solvers that do.
    pub boxes: Option<u32>,
}

/// Every continuous solver.
pub fn ask_moving(asked: &Moving) -> Vec<Answer> {
    if asked.single {
        ask_in::<f32>(&asked.case, &asked.params)
    } else {
        ask_in::<f64>(&asked.case, &asked.params)
    }
}

/// The four points in the precision that the solvers are given.
fn points<R: Real>(case: &Case) -> [Point<R>; 4] {
    let at = |p: [f64; 3]| Vec3(p.map(R::of));
    [0, 1, 2, 3].map(|i| Point { t0: at(case.positions_t0[i]), t1: at(case.positions_t1[i]) })
}

fn ask_in<R: Real>(case: &Case, params: &Params) -> Vec<Answer> {
    let p = points::<R>(case);
    let proven =
        |solver, verdict: Verdict| Answer { solver, said: verdict.into(), boxes: Some(verdict.boxes) };
    let guess = |solver, toi: Option<f64>| Answer { solver, said: Said::of(toi), boxes: None };
    let with = |rungs| certified(case.features, p, rungs, params);
    vec![
        proven("certified", with(Rungs::All)),
        proven("certified-f32", with(Rungs::Single)),
        proven("certified-f64", with(Rungs::Double)),
        guess("cubic-f64", cubic::<R, f64>(case.features, p)),
        guess("cubic-f32", cubic::<R, f32>(case.features, p)),
    ]
}

fn certified<R: Real>(features: Features, p: [Point<R>; 4], rungs: Rungs, params: &Params) -> Verdict {
    match features {
        Features::VertexFace => vf_certified(p[0], [p[1], p[2], p[3]], rungs, params),
        Features::EdgeEdge => ee_certified([p[0], p[1]], [p[2], p[3]], rungs, params),
    }
}

fn cubic<R: Real, S: Real>(features: Features, p: [Point<R>; 4]) -> Option<f64> {
    let toi = match features {
        Features::VertexFace => vf_toi::<R, S>(p[0], [p[1], p[2], p[3]]),
        Features::EdgeEdge => ee_toi::<R, S>([p[0], p[1]], [p[2], p[3]]),
    };
    toi.map(S::wide)
}

/// Every discrete solver: whether the triangles meet.
pub fn ask_still(asked: &Still) -> Vec<(&'static str, bool)> {
    if asked.single { still_in::<f32>(asked) } else { still_in::<f64>(asked) }
}

fn still_in<R: Real>(asked: &Still) -> Vec<(&'static str, bool)> {
    let [p, q] = asked.triangles.map(|t| t.map(|x| Vec3(x.map(R::of))));
    // `Certain` always answers; were it not to, a frame would keep the pair.
    let mut all = vec![("exact", meets_beyond_shared::<R, Certain>(&p, &q, asked.shared) != Some(false))];
    if asked.shared == Shared::Nothing {
        all.push(("moller", moller(&p, &q)));
    }
    all
}
