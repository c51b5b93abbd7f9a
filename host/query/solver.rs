//! Names of the tests of a pair, for reports and command lines. A query holds one, with its
//! choices.

use super::{QueryKind, named};

named! {
    /// Name of a test of a pair of triangles or features, as in reports and on the command line.
    pub enum Solver {
        /// Discrete: exact signs, by a float filter and then by integers. Never wrong. The default.
        Exact = "exact",
        /// Discrete: the paper's float test. Can miss contacts, and can report false ones.
        Moller = "moller",
        /// Continuous: isolated roots, in f32, then in f64 and beyond if that is not enough. Misses
        /// no contact, and no time is late.
        Certified = "certified",
        /// Continuous: as certified, in f32 alone. Leaves more pairs undecided.
        CertifiedF32 = "certified-f32",
        /// Continuous: as certified, in f64 alone. Costs more.
        CertifiedF64 = "certified-f64",
        /// Continuous: the paper's cubic in f64. Can miss degenerate motion.
        CubicF64 = "cubic-f64",
        /// Continuous: the paper's cubic in f32. Can miss contacts, and times can be late.
        CubicF32 = "cubic-f32",
        /// Near, distance: distances in f64, each within a proven bound. Misses no pair. Exact
        /// signs decide whether a distance is 0.
        Bounded = "bounded",
    }
}

#[allow(clippy::derivable_impls, reason = "`named!` makes the enum, and takes no attribute of a variant")]
impl Default for Solver {
    fn default() -> Self {
        Solver::Exact
    }
}

impl Solver {
    /// Returns the default solver of a kind of query.
    pub fn default_for(kind: QueryKind) -> Solver {
        kind.solvers()[0]
    }
    /// Returns whether the solver answers a kind of query.
    pub fn answers(self, kind: QueryKind) -> bool {
        kind.solvers().contains(&self)
    }
    /// Returns whether its answers are proven: no contact is missed, and no time is late.
    pub fn is_certain(self) -> bool {
        matches!(self, Solver::Exact | Solver::Bounded) || self.is_certified()
    }
    /// Returns whether it has a tolerance and a limit of iterations.
    pub fn is_certified(self) -> bool {
        matches!(self, Solver::Certified | Solver::CertifiedF32 | Solver::CertifiedF64)
    }
    /// Returns its guarantee, in a line for the user.
    pub fn promise(self) -> &'static str {
        match self {
            Solver::Exact => "exact: no contact is missed, none is invented",
            Solver::Moller => {
                "moller: a float test that can miss contacts and report false ones; `exact` cannot"
            }
            Solver::Certified => {
                "certified: no contact is missed, and no time is late; pairs within the tolerance may be undecided"
            }
            Solver::CertifiedF32 => {
                "certified-f32: no contact is missed, and no time is late; pairs that f32 cannot decide are undecided"
            }
            Solver::CertifiedF64 => "certified-f64: as certified, in f64 throughout",
            Solver::Bounded => {
                "bounded: no pair within the distance, or nearer than the reported one, is missed; errors of \
                 distances have a proven bound"
            }
            Solver::CubicF32 => {
                "cubic-f32: a float solver that can miss contacts and report them late; docs/internals/accuracy.md has figures"
            }
            Solver::CubicF64 => {
                "cubic-f64: can miss contacts of degenerate motion (coplanar, parallel, slivers); docs/internals/accuracy.md has \
                 figures"
            }
        }
    }
}
