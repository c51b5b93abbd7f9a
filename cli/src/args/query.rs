//! From options to a query: options that a kind of question, or its solver, does not have are refused.

use super::DetectArgs;
use crate::report::Format;
use nearmiss::error::Error;
use nearmiss::query::{
    Certified, Continuous, ContinuousSolver, Discrete, Distance, Earliest, Near, Query, QueryKind, Rebuild,
    Search, Solver, TriangleTest,
};
use nearmiss::scene::CollisionFilter;

impl DetectArgs {
    /// Which bodies a mesh of the command line may meet.
    pub fn filter(&self) -> CollisionFilter {
        if self.no_self_contact {
            CollisionFilter::without_self_collision()
        } else {
            CollisionFilter::default()
        }
    }

    /// The query for bodies that move, or do not.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] for options that do not go together, and for numbers that mean nothing.
    pub fn query(&self, moving: bool) -> Result<Query, Error> {
        let (kind, near) = self.kind(moving);
        let solver = self.solver.unwrap_or(Solver::default_for(kind));
        if !solver.answers(kind) {
            let known: Vec<_> = kind.solvers().iter().map(|solver| solver.name()).collect();
            return Err(Error::InvalidArgument {
                what: format!("the solver {solver:?} does not answer a {kind:?} query"),
                advice: format!("choose one of: {}", known.join(", ")),
            });
        }
        if self.assume_free && kind.is_at_rest() {
            return Err(Error::InvalidArgument {
                what: format!("--assume-free would do nothing: a {kind} query has no step"),
                advice: "leave it out, or ask with --continuous or --earliest".into(),
            });
        }
        let limits = self.tolerance.is_some() || self.boxes.is_some() || self.separation.is_some();
        if limits && !solver.is_certified() {
            return Err(Error::InvalidArgument {
                what: format!("the solver {solver:?} takes no tolerance, no budget and no separation"),
                advice: "give these to a certified solver".into(),
            });
        }
        let traversal = self.traversal.map(|walk| walk.choice(self));
        let search = Search {
            broad: self.broad,
            bv: self.bv,
            refit: self.refit,
            traversal,
            order: self.order,
            // Every so many frames, and at no other.
            rebuild: self.rebuild.or(self.rebuild_every.map(|_| Rebuild::Manual)),
        };
        let query: Query = match (near, ContinuousSolver::named(solver)) {
            _ if self.distance => Distance { search }.into(),
            (Some(distance), _) => Near { distance, search }.into(),
            (None, Some(solver)) => {
                let (solver, assume_free) = (self.limited(solver), self.assume_free);
                if kind == QueryKind::Earliest {
                    Earliest { solver, search, assume_free }.into()
                } else {
                    Continuous { solver, search, assume_free }.into()
                }
            }
            (None, None) if solver == Solver::Moller => {
                Discrete { test: TriangleTest::Moller, search }.into()
            }
            (None, None) => Discrete { test: TriangleTest::Exact { adjacent: self.adjacent }, search }.into(),
        };
        query.check()?;
        self.places(kind)?;
        if self.adjacent && solver != Solver::Exact {
            return Err(Error::InvalidArgument {
                what: "adjacent triangles are decided by exact signs only".into(),
                advice: "ask for adjacent triangles in a discrete query with the solver exact".into(),
            });
        }
        Ok(query)
    }

    /// Whether `--out` is a `.vtp`, which says where contacts are without being told to.
    pub fn writes_vtp(&self) -> bool {
        self.out.as_ref().is_some_and(|out| Format::of(out).is_ok_and(|of| of == Format::Vtp))
    }

    /// Refuses files of places of what has none.
    fn places(&self, kind: QueryKind) -> Result<(), Error> {
        let vtp = self.writes_vtp();
        let refused = |what: &str, advice: &str| {
            Err(Error::InvalidArgument { what: what.into(), advice: advice.into() })
        };
        match kind {
            QueryKind::Discrete | QueryKind::Earliest if vtp || self.geometry => refused(
                "a discrete query tells triangles, and an earliest one a time: neither has points",
                "ask with --continuous or --near, or colour the mesh by --out-mesh",
            ),
            _ if vtp && self.geometry => {
                refused("--geometry would do nothing: a .vtp has it always", "leave it out")
            }
            _ if vtp && self.file_faces => refused(
                "--file-faces would do nothing: a .vtp tells triangles",
                "leave it out, or write .csv",
            ),
            _ => Ok(()),
        }
    }

    /// The kind of query, and the distance of a near one.
    fn kind(&self, moving: bool) -> (QueryKind, Option<f64>) {
        let kind = match (self.discrete, self.continuous, self.earliest) {
            _ if self.near.is_some() => QueryKind::Near,
            _ if self.distance => QueryKind::Distance,
            (_, _, true) => QueryKind::Earliest,
            (_, true, _) => QueryKind::Continuous,
            (true, _, _) => QueryKind::Discrete,
            _ if moving => QueryKind::Continuous,
            _ => QueryKind::Discrete,
        };
        (kind, self.near)
    }

    /// The solver, with the limits that were given.
    fn limited(&self, solver: ContinuousSolver) -> ContinuousSolver {
        match solver {
            ContinuousSolver::Certified(Certified { precision, .. }) => Certified {
                precision,
                tolerance: self.tolerance,
                max_iterations: self.boxes,
                min_separation: self.separation.unwrap_or(0.0),
            }
            .into(),
            other => other,
        }
    }
}
