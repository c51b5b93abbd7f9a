//! The choices of certified solvers.

use super::Solver;
use crate::error::Error;
use nearmiss_kernels::prim::inclusion::Params;

/// A solver of features in motion that misses none and is never late: how finely it tells times, and how long it looks.
///
/// ```
/// use nearmiss::Continuous;
/// use nearmiss::research::{Certified, CertifiedPrecision, WithSolver};
///
/// // In f64 alone; what comes within a thousandth is in contact.
/// let certified = Certified { separation: 1e-3, ..Certified::by(CertifiedPrecision::F64) };
/// let query = Continuous::by(certified);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Certified {
    /// What it computes in.
    pub precision: CertifiedPrecision,
    /// How near to contact may count as one, a length; every time is early by what it takes to move that far, or less. 0 asks
    /// for all that the precision gives; one for all pairs. `None`: of each pair the smaller
    /// default of its two bodies,
    /// [`Certified::TOLERANCE`] of a body's mean edge.
    pub tolerance: Option<f64>,
    /// The most boxes that are looked at for a pair before it is left undecided; `None` for
    /// [`Certified::MAX_ITERATIONS`]. Refused in f32 alone without a separation, where no boxes are tested.
    pub max_iterations: Option<u32>,
    /// Features that come this near are in contact, a length; times are then of coming so near. 0 for touching.
    pub min_separation: f64,
}

/// What a certified solver computes in. None misses; they differ in what they leave undecided, and in cost.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum CertifiedPrecision {
    /// In f32 and, where that is not enough, in f64 and beyond.
    #[default]
    Mixed,
    /// In f32 alone: leaves more undecided.
    F32,
    /// In f64 alone: costs more.
    F64,
}

impl CertifiedPrecision {
    /// Every precision, the default first.
    pub const ALL: [CertifiedPrecision; 3] =
        [CertifiedPrecision::Mixed, CertifiedPrecision::F32, CertifiedPrecision::F64];
}

impl Certified {
    /// The tolerance when none is named, in mean edges; rounded down to a power of two, so that it does not hang on the
    /// order in which edges are summed. Smaller costs more; larger takes more near misses for contacts.
    pub const TOLERANCE: f64 = 1e-4;
    /// The budget when none is named: ten times what the hardest pairs of public scenes take.
    pub const MAX_ITERATIONS: u32 = Params::MAX_ITERATIONS;

    /// In that precision, all other choices at their defaults.
    pub const fn by(precision: CertifiedPrecision) -> Certified {
        Certified { precision, tolerance: None, max_iterations: None, min_separation: 0.0 }
    }

    /// Its name.
    pub const fn name(&self) -> Solver {
        match self.precision {
            CertifiedPrecision::Mixed => Solver::Certified,
            CertifiedPrecision::F32 => Solver::CertifiedF32,
            CertifiedPrecision::F64 => Solver::CertifiedF64,
        }
    }

    /// Whether the lengths are lengths, and there is a budget.
    pub(super) fn check(&self) -> Result<(), Error> {
        let is_length = |x: f64| (0.0..f64::INFINITY).contains(&x);
        let (what, advice) = if !is_length(self.min_separation) {
            ("a separation that is no length", "give a length from 0")
        } else if self.tolerance.is_some_and(|t| !is_length(t)) || self.max_iterations == Some(0) {
            (
                "a tolerance that is no length, or a budget of no boxes",
                "give a tolerance from 0, and at least 1 box",
            )
        } else if self.max_iterations.is_some() && !self.tests_boxes() {
            (
                "a budget of boxes for certified-f32 without a separation, which tests no boxes",
                "leave it out, or choose certified or certified-f64",
            )
        } else {
            return Ok(());
        };
        Err(Error::InvalidArgument { what: what.into(), advice: advice.into() })
    }

    /// Whether a pair may be searched by boxes, so that a budget means something.
    fn tests_boxes(&self) -> bool {
        self.precision != CertifiedPrecision::F32 || self.is_apart()
    }

    /// Whether a separation above 0 is asked for.
    #[doc(hidden)]
    pub fn is_apart(&self) -> bool {
        self.min_separation > 0.0
    }

    /// Within what distance of each other two features may be listed: the separation and the tolerance. The volumes bring it
    /// all of these, whatever their shape.
    pub(crate) fn listed_within(&self) -> f64 {
        let p = self.params();
        // Above 0 also where nothing was asked for: what precision cannot tell has its own part of the growth.
        (p.min_separation + p.tolerance).max(f64::MIN_POSITIVE)
    }

    /// What the test is asked; `tolerance` must have been chosen.
    #[doc(hidden)]
    pub fn params(&self) -> Params {
        let budget = self.max_iterations.unwrap_or(Certified::MAX_ITERATIONS);
        // Adding zero turns -0.0 into 0.0.
        let separation = self.min_separation + 0.0;
        Params {
            max_iterations: budget,
            min_separation: separation,
            ..Params::new(self.tolerance.unwrap_or(0.0))
        }
    }
}
