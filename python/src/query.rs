//! What is asked. How candidates are found never changes an answer.

use crate::errors::{choice, named, one_of, optional, raised};
use nearmiss::query::{
    self, Broad, Bv, Certified, ContinuousSolver, Named, Order, Rebuild, Search, Solver, TriangleTest,
};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple, PyType};

/// A question, with all its choices: one of Discrete, Continuous, Earliest, Near and Distance.
#[pyclass(module = "nearmiss", frozen, subclass)]
pub struct Query {
    pub query: nearmiss::Query,
}

#[pymethods]
impl Query {
    fn __eq__(&self, other: PyRef<'_, Query>) -> bool {
        self.query == other.query
    }

    fn __hash__(query: &Bound<'_, Self>) -> PyResult<isize> {
        query.repr()?.hash()
    }

    fn __repr__(query: &Bound<'_, Self>) -> PyResult<String> {
        let choices = query.get().choices(query.py())?;
        let told = choices.iter().map(|(name, value)| Ok(format!("{name}={}", value.repr()?)));
        Ok(format!("{}({})", query.get_type().name()?, told.collect::<PyResult<Vec<_>>>()?.join(", ")))
    }

    /// For copy and pickle: its class, and its choices.
    fn __reduce__<'py>(query: &Bound<'py, Self>) -> PyResult<Remade<'py>> {
        remade(query.get_type(), PyTuple::empty(query.py()), query.get().choices(query.py())?)
    }
}

impl Query {
    /// What differs from the defaults, by the names of the arguments.
    fn choices<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let choices = PyDict::new(py);
        let (mut usual, mut certified) = ("exact", None);
        match &self.query {
            nearmiss::Query::Discrete(discrete)
                if discrete.test == TriangleTest::Exact { adjacent: true } =>
            {
                choices.set_item("adjacent", true)?;
            }
            nearmiss::Query::Near(near) => {
                choices.set_item("distance", near.distance)?;
                usual = self.query.solver().name();
            }
            nearmiss::Query::Distance(_) => usual = self.query.solver().name(),
            nearmiss::Query::Continuous(moving) => {
                (usual, certified) = ("certified", moving.solver.certified())
            }
            nearmiss::Query::Earliest(moving) => {
                (usual, certified) = ("certified", moving.solver.certified())
            }
            _ => {}
        }
        if !self.query.kind().is_at_rest() && !self.query.checks_start() {
            choices.set_item("assume_free", true)?;
        }
        if let Some(certified) = certified {
            set(&choices, "tolerance", certified.tolerance)?;
            set(&choices, "separation", Some(certified.min_separation).filter(|&length| length != 0.0))?;
            set(&choices, "budget", certified.max_iterations)?;
        }
        set(&choices, "solver", Some(self.query.solver().name()).filter(|&name| name != usual))?;
        let search = self.query.search();
        set(&choices, "broad", search.broad.map(|broad| broad.name()))?;
        set(&choices, "order", search.order.map(|order| order.name()))?;
        set(&choices, "bv", search.bv.map(|bv| bv.name()))?;
        set(&choices, "rebuild", search.rebuild.map(|rebuild| rebuild.name()))?;
        Ok(choices)
    }
}

fn set<'py>(choices: &Bound<'py, PyDict>, name: &str, value: Option<impl IntoPyObject<'py>>) -> PyResult<()> {
    value.map_or(Ok(()), |value| choices.set_item(name, value))
}

/// What Python's pickle makes something of again: a function, and what it is given.
pub type Remade<'py> = (Bound<'py, PyAny>, (Bound<'py, PyType>, Bound<'py, PyTuple>, Bound<'py, PyDict>));

/// An object of that class, made of these arguments and named ones.
pub fn remade<'py>(
    class: Bound<'py, PyType>,
    positional: Bound<'py, PyTuple>,
    named: Bound<'py, PyDict>,
) -> PyResult<Remade<'py>> {
    let make = class.py().import("copyreg")?.getattr("__newobj_ex__")?;
    Ok((make, (class, positional, named)))
}

/// The choices of how candidates are found, by their names.
type Names<'a> = [Option<&'a str>; 4];

impl Query {
    fn checked(query: impl Into<nearmiss::Query>, names: Names<'_>) -> PyResult<PyClassInitializer<Query>> {
        let [broad, order, bv, rebuild] = names;
        let search = Search {
            broad: broad.map(|name| named::<Broad>("a broad phase", name)).transpose()?,
            order: order.map(|name| named::<Order>("an order", name)).transpose()?,
            bv: bv.map(|name| named::<Bv>("a volume", name)).transpose()?,
            rebuild: rebuild.map(|name| named::<Rebuild>("a rebuilding", name)).transpose()?,
            ..Search::default()
        };
        let query = query.into().with_search(search);
        query.check().map_err(raised)?;
        Ok(PyClassInitializer::from(Query { query }))
    }
}

/// Which triangles share a point now, by exact signs. The answer has bodies and indices.
///
/// adjacent: whether triangles that share a vertex are asked, too: do they share more than that?
/// solver:   "exact", or "moller": a float test that can miss and invent.
/// broad, order, bv, rebuild: how candidates are found, by the command line's names; they never
/// change the answer. rebuild: "auto", the default, or "never".
#[pyclass(module = "nearmiss", frozen, extends = Query)]
pub struct Discrete;

#[pymethods]
impl Discrete {
    #[new]
    #[pyo3(signature = (*, adjacent = false, solver = "exact", broad = None, order = None, bv = None, rebuild = None))]
    fn new(
        adjacent: bool,
        solver: &str,
        broad: Option<&str>,
        order: Option<&str>,
        bv: Option<&str>,
        rebuild: Option<&str>,
    ) -> PyResult<PyClassInitializer<Discrete>> {
        let test = match solver {
            "exact" => TriangleTest::Exact { adjacent },
            "moller" if !adjacent => TriangleTest::Moller,
            "moller" => return Err(choice("adjacent triangles by moller", "choose exact for them")),
            other => {
                return Err(choice(
                    format!("a discrete query by {other}"),
                    one_of(TriangleTest::ALL.map(|test| test.name().name())),
                ));
            }
        };
        let query = Query::checked(query::Discrete::by(test), [broad, order, bv, rebuild])?;
        Ok(query.add_subclass(Discrete))
    }
}

/// The test of features in motion, and its choices.
fn in_motion(
    solver: &str,
    (tolerance, separation, budget): (Option<f64>, f64, Option<u32>),
) -> PyResult<ContinuousSolver> {
    for (name, length) in [("tolerance", tolerance), ("separation", Some(separation))] {
        if let Some(length) = length.filter(|length| !(0.0..f64::INFINITY).contains(length)) {
            return Err(choice(
                format!("{name} = {length}"),
                "give a length from 0, in the unit of the vertices",
            ));
        }
    }
    let by = Solver::of(solver).and_then(ContinuousSolver::named);
    match by {
        Some(ContinuousSolver::Certified(certified)) => {
            // Adding zero turns -0.0 into 0.0.
            let (tolerance, separation) = (tolerance.map(|length| length + 0.0), separation + 0.0);
            Ok(Certified { tolerance, min_separation: separation, max_iterations: budget, ..certified }
                .into())
        }
        Some(other) if tolerance.is_none() && separation == 0.0 && budget.is_none() => Ok(other),
        Some(_) => Err(choice(
            format!("a tolerance, separation or budget for {solver}"),
            "give them to a certified solver",
        )),
        None => Err(choice(
            format!("a query in motion by {solver}"),
            one_of(ContinuousSolver::ALL.map(|solver| solver.name().name())),
        )),
    }
}

fn budget_of(given: &Bound<'_, PyAny>) -> PyResult<Option<u32>> {
    Ok(optional(given, "budget", [1, u32::MAX.into()])?.map(|budget| budget as u32))
}

macro_rules! in_motion {
    ($(#[$doc:meta])* $kind:ident) => {
        $(#[$doc])*
        ///
        /// tolerance:  how well a time is told, as a length moved; default: of two bodies the
        /// smaller 1e-4 of the mean edge. separation: what comes nearer than this is in contact, in
        /// the unit of the vertices; 0 for touching. budget:     how many boxes, from 1, a pair may
        /// cost before it is listed as undecided; not of "certified-f32" without a
        ///             separation, which tests no boxes.
        /// assume_free: leaves out the count of triangle pairs that share a point at the start:
        /// `Contacts.starts_crossing` is None then. solver:     "certified" (none is missed, none
        /// late), "certified-f32", "certified-f64", or "cubic-f64" and "cubic-f32", which
        ///             can miss.
        /// broad, order, bv, rebuild: how candidates are found, by the command line's names; they
        /// never change the answer. rebuild: "auto", the default, or "never".
        #[pyclass(module = "nearmiss", frozen, extends = Query)]
        pub struct $kind;

        #[pymethods]
        impl $kind {
            #[new]
            #[pyo3(signature = (
                *, tolerance = None, separation = 0.0, budget = None, assume_free = false, solver = "certified",
                broad = None, order = None, bv = None, rebuild = None,
            ))]
            #[allow(clippy::too_many_arguments, reason = "they are named")]
            fn new(
                tolerance: Option<f64>,
                separation: f64,
                #[pyo3(from_py_with = budget_of)] budget: Option<u32>,
                assume_free: bool,
                solver: &str,
                broad: Option<&str>,
                order: Option<&str>,
                bv: Option<&str>,
                rebuild: Option<&str>,
            ) -> PyResult<PyClassInitializer<$kind>> {
                let solver = in_motion(solver, (tolerance, separation, budget))?;
                let query = query::$kind::by(solver).assuming_free(assume_free);
                Ok(Query::checked(query, [broad, order, bv, rebuild])?.add_subclass($kind))
            }
        }
    };
}

in_motion! {
    /// What meets while vertices move in straight lines, and when first: kind, indices, toi, toi_upper, status.
    Continuous
}
in_motion! {
    /// When the first of all meets: how far a step may go. The answer's `earliest`, in [0, 1], is never late; None: nothing meets.
    /// Triangles that cross at the start need not meet again: `Contacts.is_free` says whether the
    /// step is free.
    Earliest
}

/// Which vertices and faces, and which edges, are within a distance of each other now, and where they are nearest.
///
/// distance: a length above 0, in the unit of the vertices. None within it is missed.
/// broad, order, bv, rebuild: how candidates are found, by the command line's names; they never
/// change the answer. rebuild: "auto", the default, or "never".
#[pyclass(module = "nearmiss", frozen, extends = Query)]
pub struct Near;

#[pymethods]
impl Near {
    #[new]
    #[pyo3(signature = (distance, *, broad = None, order = None, bv = None, rebuild = None))]
    fn new(
        distance: f64,
        broad: Option<&str>,
        order: Option<&str>,
        bv: Option<&str>,
        rebuild: Option<&str>,
    ) -> PyResult<PyClassInitializer<Near>> {
        let query = Query::checked(query::Near::within(distance), [broad, order, bv, rebuild])?;
        Ok(query.add_subclass(Near))
    }
}

/// How far apart the nearest two bodies are now, and where: 0 if and only if they share a point.
#[pyclass(module = "nearmiss", frozen, extends = Query)]
pub struct Distance;

#[pymethods]
impl Distance {
    #[new]
    fn new() -> PyResult<PyClassInitializer<Distance>> {
        Ok(Query::checked(query::Distance::default(), [None; 4])?.add_subclass(Distance))
    }
}
