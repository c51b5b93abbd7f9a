//! Features in motion: all contacts of a step, or the first.

use super::{Certified, CertifiedPrecision, ListedRows, Question, Search, Solver};
use crate::contacts::Contact;
use crate::error::Error;

/// Contacts of a step: vertex/face and edge/edge pairs that meet at some t in [0, 1], with their
/// first times.
///
/// No contact is missed, and no time is late.
///
/// ```
/// use nearmiss::Continuous;
///
/// // Features within a thousandth are in contact. Times are early by at most the time that it
/// // takes to move by a millionth.
/// let query = Continuous::default().with_min_separation(1e-3).with_tolerance(1e-6);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Continuous {
    /// Test of a pair.
    pub(crate) solver: ContinuousSolver,
    /// How candidates are found.
    pub(crate) search: Search,
    /// Whether the start of the step is assumed to be free of crossing triangles. By default the
    /// pairs that share a point at t = 0 are counted:
    /// [`Answer::starts_crossing`](crate::Answer::starts_crossing).
    pub(crate) assume_free: bool,
    /// The time in \[0, 1\] behind which contacts need not be listed; `None` for the whole step.
    pub(crate) until: Option<f64>,
}

/// Time of the first contact of a step, which is how far the step may go. Never late.
///
/// ```
/// use nearmiss::Earliest;
///
/// // The first time at which two features are a thousandth apart.
/// let query = Earliest::default().with_min_separation(1e-3);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Earliest {
    /// Test of a pair.
    pub(crate) solver: ContinuousSolver,
    /// How candidates are found.
    pub(crate) search: Search,
    /// Whether the start of the step is assumed to be free of crossing triangles, as in
    /// [`Continuous`].
    pub(crate) assume_free: bool,
}

/// Test of a pair of features in motion.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum ContinuousSolver {
    /// Isolated roots: misses no contact, and no time is late.
    Certified(Certified),
    /// The paper's cubic. Can miss degenerate motion; in f32 it can be late, too.
    Cubic(Precision),
}

/// Precision of a solver that can miss contacts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Precision {
    /// In f32.
    F32,
    /// In f64.
    F64,
}

impl Default for ContinuousSolver {
    fn default() -> Self {
        ContinuousSolver::Certified(Certified::default())
    }
}

impl From<Certified> for ContinuousSolver {
    fn from(certified: Certified) -> Self {
        ContinuousSolver::Certified(certified)
    }
}

impl ContinuousSolver {
    /// Every solver, all other choices at their defaults; the default first.
    pub const ALL: [ContinuousSolver; 5] = [
        ContinuousSolver::Certified(Certified::by(CertifiedPrecision::Mixed)),
        ContinuousSolver::Certified(Certified::by(CertifiedPrecision::F32)),
        ContinuousSolver::Certified(Certified::by(CertifiedPrecision::F64)),
        ContinuousSolver::Cubic(Precision::F64),
        ContinuousSolver::Cubic(Precision::F32),
    ];

    /// Returns its name.
    pub const fn name(&self) -> Solver {
        match self {
            ContinuousSolver::Certified(certified) => certified.name(),
            ContinuousSolver::Cubic(Precision::F64) => Solver::CubicF64,
            ContinuousSolver::Cubic(Precision::F32) => Solver::CubicF32,
        }
    }

    /// Returns the solver of a name, with all other choices at their defaults. `None` if the solver
    /// is for another kind of query.
    pub fn named(name: Solver) -> Option<ContinuousSolver> {
        ContinuousSolver::ALL.into_iter().find(|solver| solver.name() == name)
    }

    /// Returns the choices of a certified solver.
    pub const fn certified(&self) -> Option<&Certified> {
        match self {
            ContinuousSolver::Certified(certified) => Some(certified),
            ContinuousSolver::Cubic(_) => None,
        }
    }

    /// Returns the choices of a certified solver, or the default ones.
    fn or_certified(&self) -> Certified {
        self.certified().copied().unwrap_or_default()
    }

    fn certified_mut(&mut self) -> Option<&mut Certified> {
        match self {
            ContinuousSolver::Certified(certified) => Some(certified),
            ContinuousSolver::Cubic(_) => None,
        }
    }
}

/// Builders and properties of both kinds of queries in motion.
macro_rules! in_motion {
    ($kind:ident, $rows:ident) => {
        impl $kind {
            /// Returns a query by a solver, with all other choices at their defaults.
            pub(crate) fn by(solver: impl Into<ContinuousSolver>) -> $kind {
                $kind { solver: solver.into(), ..$kind::default() }
            }

            /// Sets the tolerance: a length from 0, in scene units.
            ///
            /// Features this near may be reported as undecided. Every time is early by at most the
            /// time that it takes to move this far. 0 uses the full precision. By default each pair
            /// has the smaller tolerance of its two bodies: 1e-4 of a body's mean edge. A query
            /// that can miss contacts becomes a certified one.
            #[must_use]
            pub fn with_tolerance(self, tolerance: f64) -> $kind {
                self.certainly(Certified { tolerance: Some(tolerance), ..self.solver.or_certified() })
            }

            /// Sets the minimum separation: a length from 0, in scene units. Features this near are
            /// in contact, and a time is when they first are. A query that can miss contacts
            /// becomes a certified one.
            #[must_use]
            pub fn with_min_separation(self, min_separation: f64) -> $kind {
                self.certainly(Certified { min_separation, ..self.solver.or_certified() })
            }

            /// Sets whether features within the minimum separation at the start may stay so.
            ///
            /// They are in contact from the first time on at which they are nearer than at the
            /// start, so a body at rest can leave. Features that touch at the start may part to
            /// either side: use a minimum separation to keep a side. All other features are in
            /// contact as ever. A query that can miss contacts becomes a certified one.
            ///
            /// A detector refuses it in a step in which a rigid body may turn.
            #[must_use]
            pub fn with_approaching(self, approaching: bool) -> $kind {
                self.certainly(Certified { approaching, ..self.solver.or_certified() })
            }

            /// Sets the most iterations of the solver for a pair, from 1. A pair that needs more is
            /// reported as undecided. A query that can miss contacts becomes a certified one.
            #[must_use]
            pub fn with_max_iterations(self, max_iterations: u32) -> $kind {
                self.certainly(Certified {
                    max_iterations: Some(max_iterations),
                    ..self.solver.or_certified()
                })
            }

            fn certainly(self, certified: Certified) -> $kind {
                $kind { solver: ContinuousSolver::Certified(certified), ..self }
            }

            /// Sets whether the start of the step is assumed to be free of crossing triangles.
            #[must_use]
            pub const fn assuming_free(self, assume_free: bool) -> $kind {
                $kind { assume_free, ..self }
            }
        }

        impl Question for $kind {
            fn is_at_rest() -> bool {
                false
            }
            fn rows(&self) -> Option<ListedRows> {
                $rows(&self.solver)
            }
            fn every() -> Vec<$kind> {
                ContinuousSolver::ALL.map($kind::by).into()
            }
            fn search(&self) -> &Search {
                &self.search
            }
            fn search_mut(&mut self) -> &mut Search {
                &mut self.search
            }
            fn solver(&self) -> Solver {
                self.solver.name()
            }
            fn checks_start(&self) -> bool {
                !self.assume_free
            }
            fn certified(&self) -> Option<&Certified> {
                self.solver.certified()
            }
            fn certified_mut(&mut self) -> Option<&mut Certified> {
                self.solver.certified_mut()
            }
            fn listed_within(&self) -> f64 {
                self.solver.certified().map_or(0.0, Certified::listed_within)
            }
            fn check(&self) -> Result<(), Error> {
                self.solver.certified().map_or(Ok(()), Certified::check)
            }
        }
    };
}

impl Earliest {
    /// Returns the continuous query with the same options, which does not check the start again.
    pub(crate) fn contacts(&self) -> Continuous {
        Continuous { solver: self.solver, search: self.search, assume_free: true, until: None }
    }

    /// Returns the one that lists at least the contacts that begin by a time.
    pub(crate) fn contacts_until(&self, toi: f64) -> Continuous {
        Continuous { until: Some(toi), ..self.contacts() }
    }
}

in_motion!(Continuous, contact_rows);
in_motion!(Earliest, no_rows);

fn contact_rows(solver: &ContinuousSolver) -> Option<ListedRows> {
    let apart = solver.certified().filter(|certified| certified.is_apart());
    let advice = match apart {
        Some(_) => "use a smaller minimum separation or tolerance",
        None => "use a shorter step or a smaller scene, or query the earliest contact alone",
    };
    let within = apart.map(|certified| certified.min_separation);
    Some(ListedRows { bytes: size_of::<Contact>(), within, advice })
}

fn no_rows(_: &ContinuousSolver) -> Option<ListedRows> {
    None
}
