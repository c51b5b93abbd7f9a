//! Queries, as Python's classes.

use crate::errors::{choice, optional, raised};
use crate::research;
use nearmiss::query;
use nearmiss::research::{Certified, QueryExt, TriangleTest, WithSolver};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple, PyType};

/// Base class of all queries.
///
/// These are Discrete, Continuous, Earliest, Near, Distance, BodyPairs and BodyDistances.
/// A query is a value: it can be compared, hashed, copied and pickled. Each class of queries has an
/// answer class of its own. Queries with other numbers use the same memory of a detector.
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
        let (py, own) = (query.py(), query.get());
        let product = format!("{}({})", query.get_type().name()?, listed(&own.numbers(py)?)?);
        let choices = research::choices(py, &own.query)?;
        if choices.is_empty() {
            return Ok(product);
        }
        Ok(format!("configure({product}, {})", listed(&choices)?))
    }

    /// The class itself: `Query[NearPairs]` is for type checkers alone.
    #[classmethod]
    fn __class_getitem__<'py>(class: &Bound<'py, PyType>, answer: &Bound<'py, PyAny>) -> Bound<'py, PyType> {
        let _ = answer;
        class.clone()
    }

    /// For copy and pickle: the class with its numbers, and choices of the laboratory behind them.
    fn __reduce__<'py>(query: &Bound<'py, Self>) -> PyResult<Remade<'py>> {
        let (py, own) = (query.py(), query.get());
        let choices = research::choices(py, &own.query)?;
        if choices.is_empty() {
            return remade(query.get_type(), PyTuple::empty(py), own.numbers(py)?);
        }
        let configure = py.import("nearmiss.research")?.getattr("configure")?;
        let make = py.import("functools")?.getattr("partial")?.call((configure,), Some(&choices))?;
        Ok((make, PyTuple::new(py, [as_python(py, research::without(own.query))?])?))
    }
}

/// `name=value` of each, with commas between.
fn listed(named: &Bound<'_, PyDict>) -> PyResult<String> {
    let told = named.iter().map(|(name, value)| Ok(format!("{name}={}", value.repr()?)));
    Ok(told.collect::<PyResult<Vec<_>>>()?.join(", "))
}

impl Query {
    /// Numbers and filters that differ from the defaults, by the names of the arguments.
    fn numbers<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let numbers = PyDict::new(py);
        match &self.query {
            nearmiss::Query::Discrete(discrete) => {
                if discrete.chosen() == (TriangleTest::Exact { adjacent: true }) {
                    numbers.set_item("adjacent", true)?;
                }
                if discrete.is_only_crossing() {
                    numbers.set_item("only_crossing", true)?;
                }
            }
            nearmiss::Query::Near(near) => numbers.set_item("distance", near.distance)?,
            nearmiss::Query::BodyPairs(pairs) => set(&numbers, "first", pairs.first)?,
            nearmiss::Query::BodyDistances(near) => numbers.set_item("within", near.within)?,
            _ => {}
        }
        if let Some(certified) = self.query.certified() {
            let min_separation = Some(certified.min_separation).filter(|&length| length != 0.0);
            set(&numbers, "tolerance", certified.tolerance)?;
            set(&numbers, "min_separation", min_separation)?;
            set(&numbers, "max_iterations", certified.max_iterations)?;
            set(&numbers, "approaching", certified.approaching.then_some(true))?;
        }
        if !self.query.kind().is_at_rest() && !self.query.checks_start() {
            numbers.set_item("assume_free", true)?;
        }
        Ok(numbers)
    }
}

pub fn set<'py>(
    named: &Bound<'py, PyDict>,
    name: &str,
    value: Option<impl IntoPyObject<'py>>,
) -> PyResult<()> {
    value.map_or(Ok(()), |value| named.set_item(name, value))
}

/// A function and its arguments, from which Python's pickle makes an object.
pub type Remade<'py> = (Bound<'py, PyAny>, Bound<'py, PyTuple>);

/// An object of that class, made of these arguments and named ones.
pub fn remade<'py>(
    class: Bound<'py, PyType>,
    positional: Bound<'py, PyTuple>,
    named: Bound<'py, PyDict>,
) -> PyResult<Remade<'py>> {
    let py = class.py();
    let make = py.import("copyreg")?.getattr("__newobj_ex__")?;
    Ok((make, (class, positional, named).into_pyobject(py)?))
}

/// The query as an object of its class.
pub fn as_python(py: Python<'_>, query: nearmiss::Query) -> PyResult<Bound<'_, PyAny>> {
    use nearmiss::Query as Q;
    let base = PyClassInitializer::from(Query { query });
    Ok(match query {
        Q::Discrete(_) => Bound::new(py, base.add_subclass(Discrete))?.into_any(),
        Q::Continuous(_) => Bound::new(py, base.add_subclass(Continuous))?.into_any(),
        Q::Earliest(_) => Bound::new(py, base.add_subclass(Earliest))?.into_any(),
        Q::Near(_) => Bound::new(py, base.add_subclass(Near))?.into_any(),
        Q::Distance(_) => Bound::new(py, base.add_subclass(Distance))?.into_any(),
        Q::BodyPairs(_) => Bound::new(py, base.add_subclass(BodyPairs))?.into_any(),
        Q::BodyDistances(_) => Bound::new(py, base.add_subclass(BodyDistances))?.into_any(),
        _ => Bound::new(py, base)?.into_any(),
    })
}

/// The query, if its numbers mean something.
pub fn checked(query: impl Into<nearmiss::Query>) -> PyResult<nearmiss::Query> {
    let query = query.into();
    query.check().map_err(raised)?;
    Ok(query)
}

/// Accuracy of a query in motion, and whether it checks the start of the step.
pub struct Accuracy {
    pub tolerance: Option<f64>,
    pub min_separation: f64,
    pub max_iterations: Option<u32>,
    pub assume_free: bool,
    pub approaching: bool,
}

impl Accuracy {
    pub fn continuous(&self) -> PyResult<nearmiss::Query> {
        checked(query::Continuous::by(self.certified()?).assuming_free(self.assume_free))
    }

    pub fn earliest(&self) -> PyResult<nearmiss::Query> {
        checked(query::Earliest::by(self.certified()?).assuming_free(self.assume_free))
    }

    fn certified(&self) -> PyResult<Certified> {
        let lengths = [("tolerance", self.tolerance), ("min_separation", Some(self.min_separation))];
        for (name, length) in lengths {
            if let Some(length) = length.filter(|length| !(0.0..f64::INFINITY).contains(length)) {
                return Err(choice(
                    format!("{name} must be finite and at least 0, got {length}"),
                    "give a length in the unit of the vertices",
                ));
            }
        }
        // Adding zero turns -0.0 into 0.0.
        Ok(Certified {
            tolerance: self.tolerance.map(|length| length + 0.0),
            min_separation: self.min_separation + 0.0,
            max_iterations: self.max_iterations,
            approaching: self.approaching,
            ..Certified::default()
        })
    }
}

pub fn iterations_of(given: &Bound<'_, PyAny>) -> PyResult<Option<u32>> {
    Ok(optional(given, "max_iterations", [1, u32::MAX.into()])?.map(|most| most as u32))
}

pub fn discrete(adjacent: bool, only_crossing: bool) -> PyResult<nearmiss::Query> {
    checked(query::Discrete::default().with_adjacent(adjacent).with_only_crossing(only_crossing))
}

pub fn near(distance: f64) -> PyResult<nearmiss::Query> {
    checked(query::Near::within(distance))
}

pub fn first_of(given: &Bound<'_, PyAny>) -> PyResult<Option<u32>> {
    Ok(optional(given, "first", [1, u32::MAX.into()])?.map(|first| first as u32))
}

pub fn body_pairs(first: Option<u32>) -> PyResult<nearmiss::Query> {
    checked(first.map_or_else(query::BodyPairs::default, query::BodyPairs::first))
}

pub fn body_distances(within: f64) -> PyResult<nearmiss::Query> {
    // Adding zero turns -0.0 into 0.0.
    checked(query::BodyDistances::within(within + 0.0))
}

/// Query for triangles that share a point at t = 0, by exact signs. Answer: TrianglePairs.
///
/// - `adjacent`: also test triangles with a common vertex, for points beyond that vertex or edge.
/// - `only_crossing`: leave out triangles that touch without crossing: a wall that stands on a floor.
///   See PairKind.CROSSING.
#[pyclass(module = "nearmiss", frozen, extends = Query)]
pub struct Discrete;

#[pymethods]
impl Discrete {
    #[new]
    #[pyo3(signature = (*, adjacent = false, only_crossing = false))]
    fn new(adjacent: bool, only_crossing: bool) -> PyResult<PyClassInitializer<Discrete>> {
        let query = discrete(adjacent, only_crossing)?;
        Ok(PyClassInitializer::from(Query { query }).add_subclass(Discrete))
    }
}

macro_rules! in_motion {
    ($(#[$doc:meta])* $kind:ident by $of:ident) => {
        $(#[$doc])*
        ///
        /// - `tolerance`: accuracy of times, as a length, at least 0. Default: of two bodies the
        ///   smaller 1e-4 of the mean edge. A smaller one takes longer. None loses a contact.
        /// - `min_separation`: minimum separation, a length of at least 0. Features that come this
        ///   near count as contacts. Default 0: touching.
        /// - `max_iterations`: most iterations for a pair, at least 1. A pair that needs more is
        ///   reported as undecided. Default 4096.
        /// - `assume_free`: skip the count of triangle pairs that cross at the start of the step.
        /// - `approaching`: features within `min_separation` at the start are in contact from when
        ///   they come nearer than there, so they may rest, slide and part.
        #[pyclass(module = "nearmiss", frozen, extends = Query)]
        pub struct $kind;

        #[pymethods]
        impl $kind {
            #[new]
            #[pyo3(signature = (*, tolerance = None, min_separation = 0.0, max_iterations = None, assume_free = false, approaching = false))]
            fn new(
                tolerance: Option<f64>,
                min_separation: f64,
                #[pyo3(from_py_with = iterations_of)] max_iterations: Option<u32>,
                assume_free: bool,
                approaching: bool,
            ) -> PyResult<PyClassInitializer<$kind>> {
                let accuracy = Accuracy { tolerance, min_separation, max_iterations, assume_free, approaching };
                Ok(PyClassInitializer::from(Query { query: accuracy.$of()? }).add_subclass($kind))
            }
        }
    };
}

in_motion! {
    /// Query for all contacts of a step, with certified times. Answer: Contacts.
    ///
    /// From t = 0 to t = 1 vertices move in straight lines, and rigid bodies turn: see PoseStep.
    /// Features with a common vertex are left out.
    Continuous by continuous
}
in_motion! {
    /// Query for the first contact of a step: how long a step is safe. Answer: FirstContact.
    ///
    /// From t = 0 to t = 1 vertices move in straight lines, and rigid bodies turn: see PoseStep. No
    /// contact is before the returned time.
    Earliest by earliest
}

/// Query for features within a distance at t = 0. Answer: NearPairs.
///
/// - `distance`: a length above 0, in the unit of the vertices. No pair within it is missed. It may be
///   0 if a body has a thickness.
///
/// A pair is two features: see `Kind`. Features with a common vertex are left out.
#[pyclass(module = "nearmiss", frozen, extends = Query)]
pub struct Near;

#[pymethods]
impl Near {
    #[new]
    fn new(distance: f64) -> PyResult<PyClassInitializer<Near>> {
        Ok(PyClassInitializer::from(Query { query: near(distance)? }).add_subclass(Near))
    }
}

/// Query for the distance of the nearest two bodies at t = 0. Answer: NearestTriangles.
///
/// The distance is 0 if and only if two bodies share a point. A body has no distance from itself.
#[pyclass(module = "nearmiss", frozen, extends = Query)]
pub struct Distance;

#[pymethods]
impl Distance {
    #[new]
    fn new() -> PyResult<PyClassInitializer<Distance>> {
        Ok(PyClassInitializer::from(Query { query: nearmiss::Query::distance() }).add_subclass(Distance))
    }
}

/// Query for pairs of bodies that share a point at t = 0, by exact signs. Answer: TouchingBodies.
///
/// - `first`: list the first pairs alone, at least 1. With 1 the work ends early. Default: all.
///
/// Pairs within a body do not count, even if it has self-collision.
#[pyclass(module = "nearmiss", frozen, extends = Query)]
pub struct BodyPairs;

#[pymethods]
impl BodyPairs {
    #[new]
    #[pyo3(signature = (*, first = None))]
    fn new(#[pyo3(from_py_with = first_of)] first: Option<u32>) -> PyResult<PyClassInitializer<BodyPairs>> {
        Ok(PyClassInitializer::from(Query { query: body_pairs(first)? }).add_subclass(BodyPairs))
    }
}

/// Query for the least distance of each two bodies at t = 0. Answer: NearestBodies.
///
/// - `within`: largest distance of a row, a length of at least 0, in the unit of the vertices.
///
/// A distance is 0 if and only if the bodies share a point. A body has no distance from itself.
#[pyclass(module = "nearmiss", frozen, extends = Query)]
pub struct BodyDistances;

#[pymethods]
impl BodyDistances {
    #[new]
    fn new(within: f64) -> PyResult<PyClassInitializer<BodyDistances>> {
        Ok(PyClassInitializer::from(Query { query: body_distances(within)? }).add_subclass(BodyDistances))
    }
}

/// The queries of a list.
pub fn queries_of(given: &Bound<'_, PyAny>) -> PyResult<Vec<nearmiss::Query>> {
    let refused = || -> PyResult<PyErr> {
        let what = format!("queries must be a list of queries, got {}", given.get_type().name()?);
        Ok(choice(what, "use [query] for a single one"))
    };
    let Ok(list) = given.try_iter() else { return Err(refused()?) };
    let mut queries = Vec::new();
    for query in list {
        match query?.cast::<Query>() {
            Ok(query) => queries.push(query.get().query),
            Err(_) => return Err(refused()?),
        }
    }
    Ok(queries)
}
