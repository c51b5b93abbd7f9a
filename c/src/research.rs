//! Choices for research: solvers of the paper, and how candidates are found.

use crate::error::refused;
use crate::rows::text;
use nearmiss::query::{Continuous, Discrete, Earliest, Named};
use nearmiss::research::{
    BoundingVolume, ContinuousSolver, KindExt, QueryExt, Search, Solver, TriangleTest, WithSolver,
};
use nearmiss::{Error, Query};
use std::ffi::c_char;
use std::ptr::null;

/// Choices for research. NULL is the default. Volumes, trees and tiles change no answer; a solver
/// can.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct NearmissResearch {
    /// Discrete: "exact", "moller". Continuous, earliest: "certified", "certified-f64",
    /// "certified-f32", "cubic-f64", "cubic-f32". "moller" and the cubics can miss collisions.
    pub solver: *const c_char,
    /// "aabb", "linear", "obb".
    pub bounding_volume: *const c_char,
    /// "tiles", "tree".
    pub broad_phase: *const c_char,
    /// Refit of trees: "levels", "treelets".
    pub refit: *const c_char,
}

impl Default for NearmissResearch {
    fn default() -> NearmissResearch {
        NearmissResearch { solver: null(), bounding_volume: null(), broad_phase: null(), refit: null() }
    }
}

/// The choice of a name, if there is a name.
///
/// # Safety
/// A pointer that is not NULL points to a text.
unsafe fn named<T: Named>(name: *const c_char, field: &str) -> Result<Option<T>, Error> {
    // SAFETY: the caller's promise.
    let Some(name) = (unsafe { text(name) }) else { return Ok(None) };
    let known = || T::ALL.iter().map(|choice| choice.name()).collect::<Vec<_>>().join(", ");
    T::of(&name).map(Some).ok_or_else(|| {
        refused(format!("{field} is unknown, got {name}"), format!("choose one of: {}", known()))
    })
}

impl NearmissResearch {
    /// The query with these choices.
    ///
    /// # Safety
    /// The names are texts or NULL.
    pub(crate) unsafe fn choose(&self, query: Query) -> Result<Query, Error> {
        // SAFETY: the caller's promise, of all names.
        let (solver, search) = unsafe {
            let search = Search {
                broad_phase: named(self.broad_phase, "broad_phase")?,
                volume: named::<BoundingVolume>(self.bounding_volume, "bounding_volume")?,
                refit: named(self.refit, "refit")?,
                ..Search::default()
            };
            (named::<Solver>(self.solver, "solver")?, search)
        };
        let query = solver.map_or(Ok(query), |solver| with_solver(query, solver))?;
        Ok(query.with_search(search))
    }
}

fn with_solver(query: Query, solver: Solver) -> Result<Query, Error> {
    let kind = query.kind();
    if !solver.answers(kind) {
        let own: Vec<_> = kind.solvers().into_iter().map(Solver::name).collect();
        let what = format!("solver {solver} does not answer {kind} queries");
        return Err(refused(what, format!("choose one of: {}", own.join(", "))));
    }
    let in_motion = ContinuousSolver::named(solver).unwrap_or_default();
    if let Query::Continuous(_) = query {
        return Ok(Continuous::by(in_motion).into());
    }
    if let Query::Earliest(_) = query {
        return Ok(Earliest::by(in_motion).into());
    }
    let by_moller = || Query::from(Discrete::by(TriangleTest::Moller));
    Ok(if solver == Solver::Moller { by_moller() } else { query })
}
