//! From options to a query. Options that a query or its solver does not have are refused.

use super::DetectArgs;
use crate::report::Format;
use nearmiss::Body;
use nearmiss::error::Error;
use nearmiss::query::{Continuous, Discrete, Earliest, Query, QueryKind, Rebuild};
use nearmiss::research::KindExt;
use nearmiss::research::QueryExt;
use nearmiss::research::WithSolver;
use nearmiss::research::{Certified, ContinuousSolver, Search, Solver, TriangleTest};
use nearmiss::scene::CollisionFilter;

fn refused<T>(what: impl Into<String>, advice: impl Into<String>) -> Result<T, Error> {
    Err(Error::InvalidArgument { what: what.into(), advice: advice.into() })
}

impl DetectArgs {
    /// A mesh of the command line, with its filter and thickness.
    pub fn body(&self, body: Body) -> Body {
        let body = body.with_thickness(self.query.thickness.unwrap_or(0.0));
        if self.query.no_self_collision {
            body.with_filter(CollisionFilter::without_self_collision())
        } else {
            body.with_filter(CollisionFilter::default())
        }
    }

    /// The query for bodies that move, or that rest.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] for options that exclude each other, and for numbers out of range.
    pub fn to_query(&self, moving: bool) -> Result<Query, Error> {
        let kind = self.kind(moving);
        let solver = self.research.solver.unwrap_or(Solver::default_for(kind));
        if !solver.answers(kind) {
            let known: Vec<_> = kind.solvers().iter().map(|solver| solver.name()).collect();
            let what = format!("--solver {solver} cannot be used with a {kind} query");
            return refused(what, format!("use one of: {}", known.join(", ")));
        }
        if self.query.assume_free && kind.is_at_rest() {
            let what = format!("--assume-free has no effect: a {kind} query has no step");
            return refused(what, "remove it, or add --continuous or --earliest");
        }
        if self.query.thickness.is_some() && !kind.is_of_features() {
            let what = format!("--thickness has no effect: a {kind} query ignores it");
            return refused(what, "remove it, or add --near L, --continuous or --earliest");
        }
        if let Some(option) = self.accuracy.given().filter(|_| !solver.is_certified()) {
            let what = format!("{option} cannot be used with --solver {solver}");
            return refused(what, "remove it, or use --continuous or --earliest with a certified solver");
        }
        let query = self.of_kind(kind, solver);
        query.check()?;
        self.places(self.shown(query).kind(), solver.is_certain())?;
        if self.query.adjacent && (solver != Solver::Exact || kind.is_of_bodies()) {
            let what = format!("--adjacent cannot be used with a {kind} query by {solver}");
            return refused(what, "use --discrete with the solver exact");
        }
        if self.query.only_crossing && (solver != Solver::Exact || kind.is_of_bodies()) {
            let what = format!("--only-crossing cannot be used with a {kind} query by {solver}");
            return refused(what, "use --discrete with the solver exact");
        }
        Ok(query)
    }

    /// The query whose rows are shown: with `--first-contacts` a continuous one.
    pub fn shown(&self, query: Query) -> Query {
        if self.query.first_contacts { Query::continuous() } else { query }
    }

    /// The query of a kind.
    fn of_kind(&self, kind: QueryKind, solver: Solver) -> Query {
        let assume_free = self.query.assume_free;
        let query: Query = match (self.query.near, ContinuousSolver::named(solver)) {
            _ if self.query.distance => Query::distance(),
            _ if self.query.body_pairs => Query::body_pairs(),
            (Some(distance), _) => Query::near(distance),
            _ if kind == QueryKind::BodyDistances => {
                Query::body_distances(self.query.body_distances.unwrap_or_default())
            }
            (None, Some(solver)) if kind == QueryKind::Earliest => {
                Earliest::by(self.limited(solver)).assuming_free(assume_free).into()
            }
            (None, Some(solver)) => Continuous::by(self.limited(solver)).assuming_free(assume_free).into(),
            (None, None) if solver == Solver::Moller => Discrete::by(TriangleTest::Moller).into(),
            (None, None) => Discrete::default()
                .with_adjacent(self.query.adjacent)
                .with_only_crossing(self.query.only_crossing)
                .into(),
        };
        query.with_search(self.search())
    }

    fn search(&self) -> Search {
        let research = &self.research;
        Search {
            broad_phase: research.broad_phase,
            volume: research.bounding_volume,
            refit: research.refit,
            traversal: research.walk(),
            // Every so many frames, and at no other.
            rebuild: research.rebuild.or(research.rebuild_every.map(|_| Rebuild::Manual)),
        }
    }

    /// Whether `--out` is a `.vtp`, which always has the places of contacts.
    pub fn writes_vtp(&self) -> bool {
        self.out.out.as_ref().is_some_and(|out| Format::of(out).is_ok_and(|of| of == Format::Vtp))
    }

    /// Refuses places of contacts for a query that has none.
    fn places(&self, kind: QueryKind, is_certain: bool) -> Result<(), Error> {
        let vtp = self.writes_vtp();
        match kind {
            QueryKind::BodyPairs if vtp || self.out.geometry => refused(
                format!("a .vtp and --geometry need points, and a {kind} query has none"),
                "use --discrete, or write .csv",
            ),
            QueryKind::Earliest if vtp || self.out.geometry || self.out.out_mesh.is_some() => refused(
                format!("a .vtp, --geometry and --out-mesh need contacts, and an {kind} query has none"),
                "add --first-contacts, or use --continuous or --near",
            ),
            QueryKind::Discrete if !is_certain && (vtp || self.out.geometry) => refused(
                "a .vtp and --geometry need common points, and pairs by the solver moller may have none",
                "remove --solver moller",
            ),
            _ if vtp && self.out.geometry => {
                refused("--geometry has no effect: a .vtp always has it", "remove it")
            }
            _ if vtp && self.out.file_faces => {
                refused("--file-faces has no effect: a .vtp names triangles", "remove it, or write .csv")
            }
            _ => Ok(()),
        }
    }

    /// The kind of query, of bodies that move or rest.
    pub fn kind(&self, moving: bool) -> QueryKind {
        let query = &self.query;
        match (query.discrete, query.continuous, query.earliest) {
            _ if query.near.is_some() => QueryKind::Near,
            _ if query.distance => QueryKind::Distance,
            _ if query.body_pairs => QueryKind::BodyPairs,
            _ if query.body_distances.is_some() => QueryKind::BodyDistances,
            (_, _, true) => QueryKind::Earliest,
            (_, true, _) => QueryKind::Continuous,
            (true, _, _) => QueryKind::Discrete,
            _ if moving => QueryKind::Continuous,
            _ => QueryKind::Discrete,
        }
    }

    /// The solver, with the limits that were given.
    fn limited(&self, solver: ContinuousSolver) -> ContinuousSolver {
        match solver {
            ContinuousSolver::Certified(Certified { precision, .. }) => Certified {
                precision,
                tolerance: self.accuracy.tolerance,
                max_iterations: self.accuracy.max_iterations,
                min_separation: self.accuracy.min_separation.unwrap_or(0.0),
                approaching: self.accuracy.approaching,
            }
            .into(),
            other => other,
        }
    }
}
