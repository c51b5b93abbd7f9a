//! Features in motion: all contacts of a step, or the first.

use super::{Certified, CertifiedPrecision, ListedRows, Question, Search, Solver};
use crate::contacts::Contact;
use crate::error::Error;

/// Vertex/face and edge/edge pairs that meet at some t in [0, 1], and when first.
///
/// No contact is missed, and no time is late.
///
/// ```
/// use nearmiss::Continuous;
///
/// // Features within a thousandth are in contact; times are early by at most a millionth of a length.
/// let query = Continuous::default().with_min_separation(1e-3).with_tolerance(1e-6);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Continuous {
    /// The test of a pair.
    pub(crate) solver: ContinuousSolver,
    /// How candidates are found.
    pub(crate) search: Search,
    /// Whether the start of the step is taken to be free of crossing triangles. By default the
    /// pairs that share a point at t = 0 are counted:
    /// [`Answer::starts_crossing`](crate::Answer::starts_crossing).
    pub(crate) assume_free: bool,
}

/// The first contact of a step: how far the step may go. Never late.
///
/// ```
/// use nearmiss::Earliest;
///
/// // The first time at which two features are a thousandth apart.
/// let query = Earliest::default().with_min_separation(1e-3);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Earliest {
    /// The test of a pair.
    pub(crate) solver: ContinuousSolver,
    /// How candidates are found.
    pub(crate) search: Search,
    /// Whether the start of the step is taken to be free of crossing triangles, as in
    /// [`Continuous`].
    pub(crate) assume_free: bool,
}

/// The test of a pair of features in motion.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum ContinuousSolver {
    /// Isolated roots: never misses, is never late.
    Certified(Certified),
    /// The seed's cubic. Can miss degenerate motion; in f32 it can be late, too.
    Cubic(Precision),
}

/// What a solver without a promise computes in.
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

    /// Its name.
    pub const fn name(&self) -> Solver {
        match self {
            ContinuousSolver::Certified(certified) => certified.name(),
            ContinuousSolver::Cubic(Precision::F64) => Solver::CubicF64,
            ContinuousSolver::Cubic(Precision::F32) => Solver::CubicF32,
        }
    }

    /// The solver of that name, all other choices at their defaults; none where it is another
    /// kind's.
    pub fn named(name: Solver) -> Option<ContinuousSolver> {
        ContinuousSolver::ALL.into_iter().find(|solver| solver.name() == name)
    }

    /// The choices of a certified one.
    pub const fn certified(&self) -> Option<&Certified> {
        match self {
            ContinuousSolver::Certified(certified) => Some(certified),
            ContinuousSolver::Cubic(_) => None,
        }
    }

    /// The choices of a certified one, or the default ones.
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

/// What both kinds say of themselves.
macro_rules! in_motion {
    ($kind:ident, $rows:ident) => {
        impl $kind {
            /// By that solver, all other choices at their defaults.
            pub(crate) fn by(solver: impl Into<ContinuousSolver>) -> $kind {
                $kind { solver: solver.into(), ..$kind::default() }
            }

            /// The same, with a tolerance: a length from 0.
            ///
            /// Features this near may be reported as undecided, and every time is early by at most
            /// what it takes to move this far. 0 asks for all that the precision gives. By default
            /// of each pair the smaller of its two bodies' tolerances, 1e-4 of a body's mean edge.
            /// A query that misses contacts becomes a certain one.
            #[must_use]
            pub fn with_tolerance(self, tolerance: f64) -> $kind {
                self.certainly(Certified { tolerance: Some(tolerance), ..self.solver.or_certified() })
            }

            /// The same, with a minimum separation: a length from 0. Features that come this near
            /// are in contact, and times are those of coming so near. A query that misses contacts
            /// becomes a certain one.
            #[must_use]
            pub fn with_min_separation(self, min_separation: f64) -> $kind {
                self.certainly(Certified { min_separation, ..self.solver.or_certified() })
            }

            /// The same, with an upper bound of the solver's iterations for a pair, from 1; a pair
            /// that takes more is reported as undecided. A query that misses contacts becomes a
            /// certain one.
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

            /// The same, with a start that is taken to be free of crossing triangles, or not.
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

in_motion!(Continuous, of_contacts);
in_motion!(Earliest, of_a_time);

fn of_contacts(solver: &ContinuousSolver) -> Option<ListedRows> {
    let apart = solver.certified().filter(|certified| certified.is_apart());
    let advice = match apart {
        Some(_) => "use a smaller separation or tolerance",
        None => "use a shorter step or a smaller scene, or query the earliest contact alone",
    };
    let within = apart.map(|certified| certified.min_separation);
    Some(ListedRows { bytes: size_of::<Contact>(), within, advice })
}

fn of_a_time(_: &ContinuousSolver) -> Option<ListedRows> {
    None
}
