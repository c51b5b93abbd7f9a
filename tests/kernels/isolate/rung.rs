//! The rung that decides a pair, by the ladder's own parts, put together again.

use nearmiss_kernels::math::{Real, Vec3};
use nearmiss_kernels::prim::cubic::Moving;
use nearmiss_kernels::prim::inclusion::{self, Params, Verdict};
use nearmiss_kernels::prim::isolate::ladder::{
    SLICES, Slice, ee_touch, is_flat, isolated, isolated_last, near, searched, sliced, vf_touch,
};
use nearmiss_kernels::prim::isolate::{Edges, Face, Pair, Rungs, ee_certified, vf_certified};
use nearmiss_lab::{Case, Features};

/// The deciding rung.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Rung {
    /// The moving boxes never meet.
    Boxes,
    /// The cubic keeps its sign over the step.
    Signs,
    /// It keeps its sign while the boxes meet.
    Window,
    /// A point in common at the start.
    Together,
    /// Isolation in f32.
    Single,
    /// A direction that parts features which stay in one plane, within the resolution of f32.
    Parted,
    /// Isolation in f64.
    Double,
    /// A closer look of it that finds only that they are near.
    Close,
    /// Touching at the start.
    Touch,
    /// Nearness of flat motion.
    Flat,
    /// Slices.
    Slices,
    /// Nearness of what slices leave.
    Near,
    /// The search by boxes.
    Search,
}

impl Rung {
    pub const ALL: [Rung; 13] = [
        Rung::Boxes,
        Rung::Signs,
        Rung::Window,
        Rung::Together,
        Rung::Single,
        Rung::Parted,
        Rung::Double,
        Rung::Close,
        Rung::Touch,
        Rung::Flat,
        Rung::Slices,
        Rung::Near,
        Rung::Search,
    ];
}

/// The four points.
pub fn points<R: Real>(case: &Case) -> [Moving<R>; 4] {
    let at = |p: [f64; 3]| Vec3(p.map(R::of));
    [0, 1, 2, 3].map(|i| Moving { t0: at(case.positions_t0[i]), t1: at(case.positions_t1[i]) })
}

/// The ladder's verdict.
pub fn certified<R: Real>(case: &Case, rungs: Rungs, p: &Params) -> Verdict {
    let [a, b, c, d] = points::<R>(case);
    match case.features {
        Features::VertexFace => vf_certified(a, [b, c, d], rungs, p),
        Features::EdgeEdge => ee_certified([a, b], [c, d], rungs, p),
    }
}

/// The rung that decides with all of them, and its verdict.
pub fn deciding<R: Real>(case: &Case, p: &Params) -> (Rung, Verdict) {
    let [a, b, c, d] = points::<R>(case);
    match case.features {
        Features::VertexFace => {
            let f = [b, c, d];
            let search = |known| searched(inclusion::Face::<f64>::new(a, f, p), known, p);
            climb(&Face::new(a, f, p), &Face::new(a, f, p), vf_touch(a, f), search, p)
        }
        Features::EdgeEdge => {
            let (x, y) = ([a, b], [c, d]);
            let search = |known| searched(inclusion::Edges::<f64>::new(x, y, p), known, p);
            climb(&Edges::new(x, y, p), &Edges::new(x, y, p), ee_touch(x, y), search, p)
        }
    }
}

fn climb<const N: usize>(
    single: &Pair<f32, N>,
    double: &Pair<f64, N>,
    touch: bool,
    search: impl Fn(Verdict) -> Verdict,
    p: &Params,
) -> (Rung, Verdict) {
    let apart = Verdict::separated(p.end, 0);
    let Some((begin, end)) = single.window() else { return (Rung::Boxes, apart) };
    let g = single.cubic();
    if single.finite && g.rootless_throughout() {
        return (Rung::Signs, apart);
    }
    if single.finite && g.rootless(begin, end) {
        return (Rung::Window, apart);
    }
    if single.together {
        return (Rung::Together, Verdict::TOUCHING);
    }
    if let Some(verdict) = isolated(single, p, false) {
        let (begin, end) = single.with_margin((begin, end));
        let flat = g.is_flat(&g.part(begin, end));
        return (if flat { Rung::Parted } else { Rung::Single }, verdict);
    }
    let Some(window) = double.window() else { return (Rung::Double, apart) };
    match isolated_last(double, p) {
        Ok(verdict) => {
            let near = !verdict.is_separated() && !verdict.is_contact();
            return (if near { Rung::Close } else { Rung::Double }, verdict);
        }
        // The kernels leave out the exact test then.
        Err(apart) => assert!(!(apart && touch), "isolation parts features that touch at the start"),
    }
    if window.0 <= 0.0 && touch {
        return (Rung::Touch, Verdict::TOUCHING);
    }
    if is_flat(double, window) {
        return (Rung::Flat, near(double, window, 1.0, p));
    }
    match (0..SLICES).map(|i| sliced(double, window, i, p)).find(|slice| *slice != Slice::Apart) {
        None | Some(Slice::Apart) => (Rung::Slices, apart),
        Some(Slice::Meets(verdict)) => (Rung::Slices, verdict),
        Some(Slice::Near(from)) => (Rung::Slices, Verdict::undecided(from, p.end, 0, false)),
        Some(Slice::Open(from)) => {
            let verdict = near(double, (from, window.1), 1.0, p);
            if verdict.is_separated() { (Rung::Near, verdict) } else { (Rung::Search, search(verdict)) }
        }
    }
}
