//! Features in motion: all contacts of a step, or the first.

use super::{Certified, CertifiedPrecision, ListedRows, Question, Search, Solver};
use crate::contacts::Contact;
use crate::error::Error;

/// Which vertex/face and edge/edge pairs meet at some t in [0, 1], and when first?
///
/// ```
/// use nearmiss::query::{Certified, Continuous, Query};
///
/// let certified = Certified { tolerance: Some(1e-6), ..Certified::default() };
/// let query: Query = Continuous::by(certified).into();
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Continuous {
    /// The test of a pair.
    pub solver: ContinuousSolver,
    /// How candidates are found.
    pub search: Search,
    /// Whether the start of the step is taken to be free of crossing triangles. By default the
    /// pairs that share a point at t = 0 are counted:
    /// [`Answer::starts_crossing`](crate::Answer::starts_crossing).
    pub assume_free: bool,
}

/// When does the first of them meet?
///
/// ```
/// use nearmiss::query::{ContinuousSolver, Earliest, Precision, Query};
///
/// // A guess, by the seed's cubic.
/// let query: Query = Earliest::by(ContinuousSolver::Cubic(Precision::F64)).into();
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Earliest {
    /// The test of a pair.
    pub solver: ContinuousSolver,
    /// How candidates are found.
    pub search: Search,
    /// Whether the start of the step is taken to be free of crossing triangles, as in
    /// [`Continuous`].
    pub assume_free: bool,
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

    /// The solver of that name, all other choices at their defaults; none where it is another kind's.
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
            pub fn by(solver: impl Into<ContinuousSolver>) -> $kind {
                $kind { solver: solver.into(), ..$kind::default() }
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
