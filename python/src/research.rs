//! Choices of the laboratory: how candidates are found, and solvers to compare with.

use crate::errors::{choice, named, one_of};
use crate::query::{Query, as_python, checked, set};
use nearmiss::query::{Named, Rebuild};
use nearmiss::research::{
    BoundingVolume, BroadPhase, Certified, ContinuousSolver, KindExt, QueryExt, Search, Solver, TriangleTest,
    WithSolver,
};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Return the same query with other choices of the laboratory.
///
/// No choice except `solver` changes an answer. None keeps the choice of `query`.
///
/// - `query`: any query.
/// - `solver`: test of a pair. Discrete: "exact", or "moller", which can miss and invent contacts.
///   Continuous and Earliest: "certified", "certified-f32", "certified-f64", or "cubic-f64" and
///   "cubic-f32", which can miss contacts and take neither a tolerance nor a minimum separation.
/// - `broad_phase`: "tiles" or "tree".
/// - `bounding_volume`: volume of a triangle, "aabb" or "linear"; "obb" of trees.
/// - `rebuild`: "auto" rebuilds tiles and trees when their boxes have become loose; "manual" does
///   so by Detector.rebuild alone.
///
/// Raises InvalidArgumentError for choices that do not exist or exclude each other.
#[pyfunction]
#[pyo3(signature = (query, *, solver = None, broad_phase = None, bounding_volume = None, rebuild = None))]
pub fn configure<'py>(
    query: &Bound<'py, Query>,
    solver: Option<&str>,
    broad_phase: Option<&str>,
    bounding_volume: Option<&str>,
    rebuild: Option<&str>,
) -> PyResult<Bound<'py, PyAny>> {
    let own = query.get().query;
    let own = solver.map_or(Ok(own), |name| by_solver(own, name))?;
    let before = own.search();
    let search = Search {
        broad_phase: chosen::<BroadPhase>("broad_phase", broad_phase)?.or(before.broad_phase),
        volume: chosen::<BoundingVolume>("bounding_volume", bounding_volume)?.or(before.volume),
        rebuild: rebuild.map(rebuild_of).transpose()?.or(before.rebuild),
        ..before
    };
    as_python(query.py(), checked(own.with_search(search))?)
}

fn chosen<T: Named>(argument: &str, name: Option<&str>) -> PyResult<Option<T>> {
    name.map(|name| named::<T>(argument, name)).transpose()
}

/// Names of `rebuild`.
const REBUILDS: [(&str, Rebuild); 2] = [("auto", Rebuild::Auto), ("manual", Rebuild::Manual)];

fn rebuild_of(name: &str) -> PyResult<Rebuild> {
    let found = REBUILDS.iter().find(|(own, _)| *own == name);
    found.map(|&(_, rebuild)| rebuild).ok_or_else(|| {
        choice(format!("rebuild has no choice {name:?}"), one_of(REBUILDS.iter().map(|(own, _)| *own)))
    })
}

/// The query with that solver; a certified one keeps the accuracy.
fn by_solver(mut query: nearmiss::Query, name: &str) -> PyResult<nearmiss::Query> {
    let solvers = query.kind().solvers();
    let Some(solver) = Solver::of(name).filter(|solver| solvers.contains(solver)) else {
        return Err(choice(
            format!("a {} query has no solver {name:?}", query.kind()),
            one_of(solvers.iter().map(|solver| solver.name())),
        ));
    };
    let moving = ContinuousSolver::named(solver);
    match (&mut query, moving) {
        (nearmiss::Query::Discrete(discrete), _) => {
            if solver == Solver::Moller && discrete.is_only_crossing() {
                let what = "solver \"moller\" cannot tell triangles that cross from those that touch";
                return Err(choice(what, "use \"exact\""));
            }
            let test = match (solver, discrete.chosen()) {
                (Solver::Moller, TriangleTest::Exact { adjacent: true }) => {
                    return Err(choice("solver \"moller\" cannot test adjacent triangles", "use \"exact\""));
                }
                (Solver::Moller, _) => TriangleTest::Moller,
                (_, TriangleTest::Exact { adjacent }) => TriangleTest::Exact { adjacent },
                _ => TriangleTest::default(),
            };
            *discrete = discrete.with_solver(test);
        }
        (nearmiss::Query::Continuous(continuous), Some(by)) => {
            *continuous = continuous.with_solver(keeping(continuous.chosen(), by, name)?);
        }
        (nearmiss::Query::Earliest(earliest), Some(by)) => {
            *earliest = earliest.with_solver(keeping(earliest.chosen(), by, name)?);
        }
        _ => {}
    }
    Ok(query)
}

/// A solver with the accuracy of the one before.
fn keeping(before: ContinuousSolver, by: ContinuousSolver, name: &str) -> PyResult<ContinuousSolver> {
    match (before.certified(), by) {
        (Some(&own), ContinuousSolver::Certified(certified)) => {
            Ok(Certified { precision: certified.precision, ..own }.into())
        }
        (Some(own), _) if *own != Certified::by(own.precision) => Err(choice(
            format!("solver {name:?} takes no tolerance, min_separation or max_iterations"),
            "leave them out, or use a certified solver",
        )),
        _ => Ok(by),
    }
}

/// The query with all choices of the laboratory at their defaults.
pub fn without(query: nearmiss::Query) -> nearmiss::Query {
    let mut query = query.with_search(Search::default());
    match &mut query {
        nearmiss::Query::Discrete(discrete) if discrete.chosen() == TriangleTest::Moller => {
            *discrete = discrete.with_solver(TriangleTest::default());
        }
        nearmiss::Query::Continuous(own) => *own = own.with_solver(usual(own.chosen())),
        nearmiss::Query::Earliest(own) => *own = own.with_solver(usual(own.chosen())),
        _ => {}
    }
    query
}

fn usual(solver: ContinuousSolver) -> ContinuousSolver {
    let usual = Certified::default();
    solver.certified().map_or(usual, |own| Certified { precision: usual.precision, ..*own }).into()
}

/// The choices that differ from the defaults, by the names of the arguments.
pub fn choices<'py>(py: Python<'py>, query: &nearmiss::Query) -> PyResult<Bound<'py, PyDict>> {
    let choices = PyDict::new(py);
    let usual = Solver::default_for(query.kind());
    set(&choices, "solver", Some(query.solver()).filter(|&own| own != usual).map(|own| own.name()))?;
    let search = query.search();
    set(&choices, "broad_phase", search.broad_phase.map(|broad| broad.name()))?;
    set(&choices, "bounding_volume", search.volume.map(|volume| volume.name()))?;
    let rebuild = search.rebuild.and_then(|rebuild| REBUILDS.iter().find(|(_, own)| *own == rebuild));
    set(&choices, "rebuild", rebuild.map(|(name, _)| *name))?;
    Ok(choices)
}
