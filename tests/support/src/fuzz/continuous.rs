//! Two features that move: every solver against the exact time.

use super::bytes::{Bytes, largest};
use nearmiss_kernels::math::{Real, Vec3};
use nearmiss_kernels::prim::cubic::{Moving, ee_apart, ee_toi, vf_apart, vf_toi};
use nearmiss_kernels::prim::inclusion::{self, Grid, Params, Verdict};
use nearmiss_kernels::prim::isolate::{Rungs, ee_certified, vf_certified};
use nearmiss_lab::oracle::{Toi, first_contact};
use nearmiss_lab::{Case, Features};

/// The input of a test: the motion, the parameters of a certified solver, and whether f32 holds all
/// positions.
pub fn decode(bytes: &[u8]) -> (Case, Params, bool) {
    let mut b = Bytes::new(bytes);
    let shape = b.byte();
    let features = if shape & 1 == 0 { Features::VertexFace } else { Features::EdgeEdge };
    let limit = largest(b.is_single());
    let mut points: Vec<[f64; 3]> = Vec::new();
    for i in 0..8 {
        let point = match shape >> 1 & 7 {
            // Some points are at rest; some motions are in a plane.
            1 if i > 4 => points[i - 4],
            2 => {
                let [x, y, _] = b.point_or(&points);
                [x, y, 1.0]
            }
            _ => b.point_or(&points),
        };
        points.push(point.map(|x| x.clamp(-limit, limit)));
    }
    let tolerance = [1e-6, 0.0, 1e-3, 1e-9][usize::from(shape >> 4 & 3)];
    let max_iterations = [Params::MAX_ITERATIONS, 64][usize::from(shape >> 6 & 1)];
    let at = |from: usize| [0, 1, 2, 3].map(|i| points[from + i]);
    let case = Case { features, positions_t0: at(0), positions_t1: at(4) };
    (case, Params { max_iterations, ..Params::new(tolerance) }, b.is_single())
}

/// Runs the solvers, and judges the certified answers after `lie` has changed them.
pub fn ask(bytes: &[u8], lie: impl Fn(Verdict) -> Verdict) -> Result<(), String> {
    let (case, params, single) = decode(bytes);
    let truth = first_contact(&case);
    let mut answers = answers::<f64>(&case, &params, truth.as_ref())?;
    if single {
        answers.extend(self::answers::<f32>(&case, &params, truth.as_ref())?);
    }
    for (solver, verdict) in answers {
        if let Some(fault) = fault(&lie(verdict), truth.as_ref()) {
            let truth = truth.map(|toi| toi.bracket());
            return Err(format!("{solver}: {fault}: {verdict:?}, exactly {truth:?}: {case:?}, {params:?}"));
        }
    }
    Ok(())
}

/// The fault of a verdict that should be certain, if it has one.
pub fn fault(verdict: &Verdict, truth: Option<&Toi>) -> Option<&'static str> {
    let Verdict { toi, toi_upper, .. } = *verdict;
    if !(0.0 <= toi && toi <= toi_upper && toi_upper <= 1.0) {
        return Some("times out of range");
    }
    match truth {
        None => verdict.is_contact().then_some("a false certificate"),
        Some(_) if verdict.is_separated() => Some("missed"),
        Some(truth) if truth.cmp_f64(toi).is_lt() => Some("late"),
        Some(truth) => (verdict.is_contact() && truth.cmp_f64(toi_upper).is_gt())
            .then_some("a false certificate: the contact is after toi_upper"),
    }
}

/// Every certified answer to positions in `R`. The other solvers' answers need only be times.
fn answers<R: Real>(
    case: &Case,
    params: &Params,
    truth: Option<&Toi>,
) -> Result<Vec<(String, Verdict)>, String> {
    let at = |p: [f64; 3]| Vec3(p.map(R::of));
    let p = [0, 1, 2, 3].map(|i| Moving { t0: at(case.positions_t0[i]), t1: at(case.positions_t1[i]) });
    let (f, ea, eb) = ([p[1], p[2], p[3]], [p[0], p[1]], [p[2], p[3]]);
    let (estimates, apart) = match case.features {
        Features::VertexFace => {
            let estimates = [vf_toi::<R, f64>(p[0], f), vf_toi::<R, f32>(p[0], f).map(f64::from)];
            (estimates, vf_apart::<R, f32>(p[0], f) || vf_apart::<R, f64>(p[0], f))
        }
        Features::EdgeEdge => {
            let estimates = [ee_toi::<R, f64>(ea, eb), ee_toi::<R, f32>(ea, eb).map(f64::from)];
            (estimates, ee_apart::<R, f32>(ea, eb) || ee_apart::<R, f64>(ea, eb))
        }
    };
    if let Some(toi) = estimates.iter().flatten().find(|toi| !(0.0..=1.0).contains(*toi)) {
        return Err(format!("the cubic returns {toi}, which is not in [0, 1]: {case:?}"));
    }
    if apart && truth.is_some() {
        return Err(format!("rejected by signs: {case:?}"));
    }
    let ladder = |rungs| certified(case.features, p, rungs, params);
    let all = [
        ("all rungs", ladder(Rungs::All)),
        ("f32", ladder(Rungs::Single)),
        ("f64", ladder(Rungs::Double)),
        ("the search in f32", searched::<R, f32>(case.features, p, params)),
        ("the search in f64", searched::<R, f64>(case.features, p, params)),
    ];
    Ok(all.map(|(name, verdict)| (format!("{name}, of {} bytes", size_of::<R>()), verdict)).into())
}

/// The verdict by the rungs of a frame's solver.
fn certified<R: Real>(features: Features, p: [Moving<R>; 4], rungs: Rungs, params: &Params) -> Verdict {
    match features {
        Features::VertexFace => vf_certified(p[0], [p[1], p[2], p[3]], rungs, params),
        Features::EdgeEdge => ee_certified([p[0], p[1]], [p[2], p[3]], rungs, params),
    }
}

/// The verdict by boxes alone: the last rung, for all pairs.
fn searched<R: Real, S: Grid>(features: Features, p: [Moving<R>; 4], params: &Params) -> Verdict {
    match features {
        Features::VertexFace => inclusion::vf_certified::<R, S>(p[0], [p[1], p[2], p[3]], params),
        Features::EdgeEdge => inclusion::ee_certified::<R, S>([p[0], p[1]], [p[2], p[3]], params),
    }
}
