//! Runs the catalogue's cases on a machine, by the kernels of a frame.

use super::question::{Expect, Fault, Question};
use super::report::Report;
use crate::case::{Case, Features};
use crate::pairs::{Options, Outcome, Stored, ask};
use nearmiss::contacts::Status;
use nearmiss::device::Device;
use nearmiss::error::Error;
use nearmiss::query::Continuous;
use nearmiss::research::{Certified, CertifiedPrecision, WithSolver};
use nearmiss_kernels::prim::inclusion::Verdict;

/// The solvers that must get every answer right.
pub(super) const SOLVERS: [CertifiedPrecision; 3] = CertifiedPrecision::ALL;

/// The options of the runs: with the filters of a frame and without, from positions in f64 and, if
/// f32 holds them, in f32.
const ALL_OPTIONS: [Options; 3] = [
    Options { filters: false, stored: Stored::F64, repeats: 0 },
    Options { filters: true, stored: Stored::F64, repeats: 0 },
    Options { filters: true, stored: Stored::F32, repeats: 0 },
];

/// Converts an answer into the kernels' verdict, for a step that ends at `end`.
pub(super) fn verdict(met: Option<Outcome>, end: f64) -> Verdict {
    match met {
        None => Verdict::separated(end, 0),
        Some(m) if m.status == Status::Undecided => {
            Verdict::undecided(m.toi, m.toi_upper, m.boxes, m.exhausted)
        }
        Some(m) => Verdict::contact(m.toi, m.toi_upper, m.boxes, m.exhausted),
    }
}

/// Returns whether a query of a whole step also answers the case: a first contact before an end is
/// also first without it.
fn is_public(q: &Question) -> bool {
    q.end == 1.0 || matches!(q.expect, Expect::Meets(_) | Expect::Sure(_))
}

/// Returns answers to cases, each with its own tolerance and separation; `None` if the case has no
/// such run.
pub(super) fn answers(
    device: &Device,
    questions: &[Question],
    solver: CertifiedPrecision,
    how: Options,
) -> Result<Vec<Option<Verdict>>, Error> {
    let mut all = vec![None; questions.len()];
    let is_run = |q: &Question| is_public(q) && (how.stored == Stored::F64 || q.case.fits_f32());
    let mut left: Vec<usize> = (0..questions.len()).filter(|i| is_run(&questions[*i])).collect();
    while let Some(first) = left.first() {
        let Question { tolerance, separation, .. } = questions[*first];
        let alike = |q: &Question| (q.tolerance, q.separation) == (tolerance, separation);
        let (now, later): (Vec<_>, Vec<_>) = left.into_iter().partition(|i| alike(&questions[*i]));
        let cases: Vec<Case> = now.iter().map(|i| questions[*i].case).collect();
        let certified =
            Certified { tolerance: Some(tolerance), min_separation: separation, ..Certified::by(solver) };
        let query = Continuous::by(certified).into();
        for (i, met) in now.into_iter().zip(ask(device, &cases, &query, how)?.verdicts) {
            all[i] = Some(verdict(met, 1.0));
        }
        left = later;
    }
    Ok(all)
}

/// Runs each case with every certified solver and all options, and judges the answers.
///
/// # Errors
/// Device errors.
pub fn ask_questions(device: &Device, questions: &[Question]) -> Result<Report, Error> {
    let mut report = Report::new("questions");
    for (solver, how) in SOLVERS.into_iter().flat_map(|solver| ALL_OPTIONS.map(|how| (solver, how))) {
        let all = answers(device, questions, solver, how)?;
        for (q, said) in questions.iter().zip(&all) {
            let Some(said) = said else { continue };
            report.undecided += u64::from(!said.is_contact() && !said.is_separated());
            let fault = q.judge(said, solver == CertifiedPrecision::F32);
            report.note(fault, || {
                format!("{} {}: got {said:?}, expected {:?}, by {solver:?}, {how:?}", q.id, q.what, q.expect)
            });
        }
    }
    Ok(report)
}

/// A change of a case, and which part of the answer must stay.
struct Turn {
    name: &'static str,
    /// `None` if it is not exact for these numbers.
    change: fn(&Question) -> Option<Question>,
    /// Whether every bit of the answer must stay; otherwise only the judge's verdict must.
    bits: bool,
}

const TURNS: [Turn; 12] = [
    Turn { name: "times 2^40", change: |q| scaled(q, 40), bits: true },
    Turn { name: "times 2^-40", change: |q| scaled(q, -40), bits: true },
    Turn { name: "times 2^-700", change: |q| scaled(q, -700), bits: true },
    Turn { name: "signs of zeros", change: |q| points(q, |x| if x == 0.0 { -0.0 } else { x }), bits: true },
    Turn { name: "all signs", change: |q| points(q, |x| -x), bits: true },
    Turn { name: "moved by 2^20", change: |q| points(q, |x| x + 1048576.0), bits: true },
    Turn { name: "x mirrored", change: |q| axes(q, |[x, y, z]| [-x, y, z]), bits: false },
    Turn { name: "axes turned", change: |q| axes(q, |[x, y, z]| [y, z, x]), bits: false },
    Turn { name: "x and y exchanged", change: |q| axes(q, |[x, y, z]| [y, x, z]), bits: false },
    Turn { name: "corners turned", change: |q| order(q, [0, 2, 3, 1], [1, 0, 2, 3]), bits: false },
    Turn { name: "corners exchanged", change: |q| order(q, [0, 1, 3, 2], [0, 1, 3, 2]), bits: false },
    Turn { name: "features exchanged", change: |q| order(q, [0, 3, 2, 1], [2, 3, 0, 1]), bits: false },
];

/// Changes every coordinate. It changes them back bit by bit, if the change has an inverse by the
/// sign of zero.
fn points(q: &Question, f: fn(f64) -> f64) -> Option<Question> {
    let all = |p: [[f64; 3]; 4]| p.map(|p| p.map(f));
    let case =
        Case { positions_t0: all(q.case.positions_t0), positions_t1: all(q.case.positions_t1), ..q.case };
    // Only differences matter: a shift must keep all of them.
    let exact = |a: &[[f64; 3]; 4], b: &[[f64; 3]; 4]| {
        a.as_flattened().iter().zip(b.as_flattened()).all(|(x, y)| {
            let shift = f(0.0);
            y - shift == *x || y - shift == -*x
        })
    };
    let kept =
        exact(&q.case.positions_t0, &case.positions_t0) && exact(&q.case.positions_t1, &case.positions_t1);
    kept.then_some(Question { case, ..*q })
}

/// Scales by a power of two, unless a number would leave the range.
fn scaled(q: &Question, power: i32) -> Option<Question> {
    let by = 2f64.powi(power);
    let all = |p: [[f64; 3]; 4]| p.map(|p| p.map(|x| x * by));
    let case =
        Case { positions_t0: all(q.case.positions_t0), positions_t1: all(q.case.positions_t1), ..q.case };
    let size = |x: f64| x == 0.0 || (2f64.powi(-900)..2f64.powi(479)).contains(&(x * by).abs());
    let all = q.case.positions_t0.as_flattened().iter().chain(q.case.positions_t1.as_flattened());
    let kept = all.chain([&q.tolerance, &q.separation]).all(|x| size(*x));
    let (tolerance, separation) = (q.tolerance * by, q.separation * by);
    kept.then_some(Question { case, tolerance, separation, ..*q })
}

fn axes(q: &Question, f: fn([f64; 3]) -> [f64; 3]) -> Option<Question> {
    let case =
        Case { positions_t0: q.case.positions_t0.map(f), positions_t1: q.case.positions_t1.map(f), ..q.case };
    Some(Question { case, ..*q })
}

/// Reorders the points, by the kind of features.
fn order(q: &Question, face: [usize; 4], edges: [usize; 4]) -> Option<Question> {
    let order = if q.case.features == Features::VertexFace { face } else { edges };
    let all = |p: [[f64; 3]; 4]| order.map(|i| p[i]);
    let case =
        Case { positions_t0: all(q.case.positions_t0), positions_t1: all(q.case.positions_t1), ..q.case };
    Some(Question { case, ..*q })
}

/// Runs each case again in other units, places, axes and orders. It also runs them backwards in
/// time: whether the features meet must not change.
///
/// # Errors
/// Device errors.
pub fn ask_turned_questions(device: &Device, questions: &[Question]) -> Result<Report, Error> {
    let mut report = Report::new("questions turned");
    for solver in SOLVERS {
        let plain = answers(device, questions, solver, Options::default())?;
        let narrow = solver == CertifiedPrecision::F32;
        for turn in &TURNS {
            let turned: Vec<Option<Question>> = questions.iter().map(turn.change).collect();
            let changed: Vec<Question> = turned.iter().flatten().copied().collect();
            let mut said = answers(device, &changed, solver, Options::default())?.into_iter();
            for ((q, was), turned) in questions.iter().zip(&plain).zip(&turned) {
                let (Some(turned), Some(was)) = (turned, was) else {
                    // It had no run before, or is not exact now: its answer, if any, is skipped.
                    if turned.is_some() {
                        said.next();
                    }
                    continue;
                };
                let Some(is) = said.next().flatten() else { continue };
                let fault = match turn.bits {
                    true => (is != *was).then_some(Fault::Unexpected),
                    // In another order, a certified answer may become uncertified.
                    false => match turned.expect {
                        Expect::Sure(t) => {
                            Question { expect: Expect::Meets(t), ..*turned }.judge(&is, narrow)
                        }
                        _ => turned.judge(&is, narrow),
                    },
                };
                report.note(fault, || {
                    format!("{} {}, {}: got {is:?}, expected {was:?}, by {solver:?}", q.id, q.what, turn.name)
                });
            }
        }
        let back = |q: &Question| {
            let [positions_t0, positions_t1] = [q.case.positions_t1, q.case.positions_t0];
            Question { case: Case { positions_t0, positions_t1, ..q.case }, ..*q }
        };
        // An end within the step would be a start when played backwards.
        let whole: Vec<Question> = questions.iter().filter(|q| q.end == 1.0).copied().collect();
        let backwards: Vec<Question> = whole.iter().map(back).collect();
        let said = answers(device, &backwards, solver, Options::default())?;
        for (q, is) in whole.iter().zip(said).filter_map(|(q, is)| Some((q, is?))) {
            let fault = match q.expect {
                Expect::Meets(_) | Expect::Sure(_) => is.is_separated().then_some(Fault::Missed),
                Expect::Apart | Expect::Near => is.is_contact().then_some(Fault::FalseCertificate),
            };
            report.note(fault, || format!("{} {}, backwards: got {is:?}, by {solver:?}", q.id, q.what));
        }
    }
    Ok(report)
}
