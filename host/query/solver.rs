//! The names of the tests of a pair, for reports and command lines; a query holds one with the choices it has.

use super::{QueryKind, named};

named! {
    /// The name of a test of a pair of triangles or features: what reports tell, and a command line takes.
    pub enum Solver {
        /// Discrete: exact signs by filter, then integers. Never wrong. The default.
        Exact = "exact",
        /// Discrete: the paper's float test. Can miss, can err.
        Moller = "moller",
        /// Continuous: isolated roots, in f32 and, where that is not enough, in f64 and beyond. Never misses, is never late.
        Certified = "certified",
        /// The same in f32 alone: leaves more uncertain.
        CertifiedF32 = "certified-f32",
        /// The same in f64 alone: costs more.
        CertifiedF64 = "certified-f64",
        /// Continuous: the paper's cubic in f64. Can miss degenerate motion.
        CubicF64 = "cubic-f64",
        /// Continuous: the paper's cubic in f32. Can miss, can be late.
        CubicF32 = "cubic-f32",
        /// Near, distance: distances in f64, each within a proven bound. Never misses; 0 is decided by exact signs.
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
    /// The solver of a kind of query when none is named.
    pub fn default_for(kind: QueryKind) -> Solver {
        kind.solvers()[0]
    }
    /// Whether the solver answers that kind of question.
    pub fn answers(self, kind: QueryKind) -> bool {
        kind.solvers().contains(&self)
    }
    /// Whether its answers are proven: no contact is missed or late.
    pub fn is_certain(self) -> bool {
        matches!(self, Solver::Exact | Solver::Bounded) || self.is_certified()
    }
    /// Whether it is one of those that take a tolerance and a budget.
    pub fn is_certified(self) -> bool {
        matches!(self, Solver::Certified | Solver::CertifiedF32 | Solver::CertifiedF64)
    }
    /// The promise, in a sentence for the user.
    pub fn promise(self) -> &'static str {
        match self {
            Solver::Exact => "exact: no contact is missed, none is invented",
            Solver::Moller => {
                "moller: a float test that can miss contacts and invent some; use exact for certainty"
            }
            Solver::Certified => {
                "certified: no contact is missed, none is late; what is nearer than the tolerance may be listed as uncertain"
            }
            Solver::CertifiedF32 => {
                "certified-f32: no contact is missed, none is late; what f32 cannot tell is listed as uncertain"
            }
            Solver::CertifiedF64 => "certified-f64: as certified, in f64 throughout",
            Solver::Bounded => {
                "bounded: no pair within the distance, or nearer than the one that is told, is missed; distances err by \
                 less than a proven bound"
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
