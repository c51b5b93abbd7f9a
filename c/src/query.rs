//! What is asked.

use crate::body::flag;
use crate::error::refused;
use crate::rows::text;
use nearmiss::query::{
    Bv, Continuous, ContinuousSolver, Discrete, Earliest, Named, QueryKind, Search, Solver, TriangleTest,
};
use nearmiss::{Error, Query};
use std::ffi::c_char;
use std::ptr::null;

/// What is asked of a scene.
#[allow(non_camel_case_types, reason = "as C sees them")]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum NearmissQueryKind {
    /// Which triangle pairs share a point now? Answers `nearmiss_answer_triangle_pairs`.
    NEARMISS_DISCRETE = 0,
    /// Which vertex/face and edge/edge pairs meet within the step, and when first? Answers `nearmiss_answer_contacts`.
    NEARMISS_CONTINUOUS = 1,
    /// When does the first of them meet? Answers `nearmiss_answer_earliest`, and
    /// `nearmiss_answer_is_free`.
    NEARMISS_EARLIEST = 2,
    /// Which vertex/face and edge/edge pairs are within a distance now, and where? Answers `nearmiss_answer_near_pairs`.
    NEARMISS_NEAR = 3,
    /// How far apart are the two bodies that are nearest now, and where? Answers `nearmiss_answer_nearest`.
    NEARMISS_DISTANCE = 4,
}

/// A query and its choices. Begin with `nearmiss_query()`. Names are those of the command line; NULL is the default. A choice that the
/// query does not have is refused.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct NearmissQuery {
    /// A `NearmissQueryKind`.
    pub kind: u32,
    /// Discrete, exact: whether triangles that share a vertex are told too, where they meet beyond it: 0 or 1.
    pub adjacent: u32,
    /// Continuous, earliest; certified: the most boxes that are looked at for a pair before it is left undecided; 0 for the default.
    pub budget: u32,
    /// Continuous, earliest: whether the start of the step is taken to be free of crossing
    /// triangles, and not checked: 0 or 1.
    pub assume_free: u32,
    /// Near: how far apart two features may be to be listed, a length above 0.
    pub distance: f64,
    /// Certified: how near to contact may count as one, a length; times are early by what it takes to move that far, or less. -1 for
    /// 1e-4 of the mean edge.
    pub tolerance: f64,
    /// Certified: features that come this near are in contact, a length; 0 for touching.
    pub separation: f64,
    /// The test: "exact", "moller" (discrete); "certified", "certified-f64", "certified-f32", "cubic-f64", "cubic-f32" (continuous,
    /// earliest); "bounded". "moller" and the cubics can miss contacts, the others cannot.
    pub solver: *const c_char,
    /// The volume: "aabb", "linear", "obb", "obb-child". This and what follows never changes an answer.
    pub bv: *const c_char,
    /// "tree" or "tiles".
    pub broad: *const c_char,
    /// Of tiles: "hilbert", "runs", "median".
    pub order: *const c_char,
    /// Of trees: "levels", "treelets", "bottom-up".
    pub refit: *const c_char,
    /// When tiles or trees are made anew: "never", or "auto", the default.
    pub rebuild: *const c_char,
}

/// A query of that kind with all choices at their defaults; of what is near the distance is still to be said.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_query(kind: u32) -> NearmissQuery {
    NearmissQuery {
        kind,
        adjacent: 0,
        budget: 0,
        assume_free: 0,
        distance: 0.0,
        tolerance: -1.0,
        separation: 0.0,
        solver: null(),
        bv: null(),
        broad: null(),
        order: null(),
        refit: null(),
        rebuild: null(),
    }
}

/// The choice of that name, if there is one.
///
/// # Safety
/// A pointer that is not NULL points to a text.
unsafe fn named<T: Named>(name: *const c_char, what: &str) -> Result<Option<T>, Error> {
    // SAFETY: the caller's promise.
    let Some(name) = (unsafe { text(name) }) else { return Ok(None) };
    let known = || T::ALL.iter().map(|choice| choice.name()).collect::<Vec<_>>().join(", ");
    T::of(&name)
        .map(Some)
        .ok_or_else(|| refused(format!("the {what} {name}"), format!("choose one of: {}", known())))
}

impl NearmissQuery {
    fn kind(&self) -> Result<QueryKind, Error> {
        Ok(match self.kind {
            0 => QueryKind::Discrete,
            1 => QueryKind::Continuous,
            2 => QueryKind::Earliest,
            3 => QueryKind::Near,
            4 => QueryKind::Distance,
            other => {
                let advice = "choose a NearmissQueryKind, such as NEARMISS_DISCRETE";
                return Err(refused(format!("a query of kind {other}"), advice));
            }
        })
    }

    /// The library's query.
    ///
    /// # Safety
    /// Its names are texts or NULL.
    pub(crate) unsafe fn query(&self) -> Result<Query, Error> {
        let kind = self.kind()?;
        // SAFETY: the caller's promise, of all names.
        let (solver, search) = unsafe {
            let search = Search {
                broad: named(self.broad, "broad phase")?,
                bv: named::<Bv>(self.bv, "volume")?,
                refit: named(self.refit, "refit")?,
                traversal: None,
                order: named(self.order, "order")?,
                rebuild: named(self.rebuild, "rebuild")?,
            };
            (named::<Solver>(self.solver, "solver")?, search)
        };
        let solver = solver.unwrap_or(Solver::default_for(kind));
        if !solver.answers(kind) {
            let own: Vec<_> = kind.solvers().into_iter().map(Solver::name).collect();
            let what = format!("a {kind} query by the solver {solver}");
            return Err(refused(what, format!("choose one of: {}", own.join(", "))));
        }
        let adjacent = flag(self.adjacent, "adjacent")?;
        let assume_free = flag(self.assume_free, "assume_free")?;
        let idle = [
            ("adjacent", adjacent && solver != Solver::Exact),
            ("assume_free", assume_free && kind.is_at_rest()),
            ("distance", self.distance != 0.0 && kind != QueryKind::Near),
            ("tolerance", self.tolerance != -1.0 && !solver.is_certified()),
            ("separation", self.separation != 0.0 && !solver.is_certified()),
            ("budget", self.budget != 0 && !solver.is_certified()),
        ];
        if let Some((name, _)) = idle.iter().find(|(_, is_idle)| *is_idle) {
            let advice = "leave it as `nearmiss_query` gave it: it would do nothing";
            return Err(refused(format!("{name} of a {kind} query by the solver {solver}"), advice));
        }
        let in_motion = || ContinuousSolver::named(solver).unwrap_or_default();
        let mut query = match kind {
            QueryKind::Continuous => Continuous::by(in_motion()).assuming_free(assume_free).into(),
            QueryKind::Earliest => Earliest::by(in_motion()).assuming_free(assume_free).into(),
            QueryKind::Near => Query::near(self.distance),
            QueryKind::Distance => Query::distance(),
            _ if solver == Solver::Moller => Discrete::by(TriangleTest::Moller).into(),
            _ => Query::from(Discrete::by(TriangleTest::Exact { adjacent })),
        };
        if let Some(certified) = query.certified_mut() {
            certified.tolerance = (self.tolerance != -1.0).then_some(self.tolerance);
            certified.max_iterations = (self.budget > 0).then_some(self.budget);
            certified.min_separation = self.separation;
        }
        Ok(query.with_search(search))
    }
}
