//! Precision, tolerance and limits of certified solvers.

use super::Solver;
use crate::error::Error;
use nearmiss_kernels::prim::inclusion::Params;

/// A certified solver of features in motion, with its precision, tolerance and limit of work.
///
/// It misses no contact, and no time is late.
///
/// ```
/// use nearmiss::Continuous;
/// use nearmiss::research::{Certified, CertifiedPrecision, WithSolver};
///
/// // In f64 alone; features within a thousandth are in contact.
/// let certified = Certified { min_separation: 1e-3, ..Certified::by(CertifiedPrecision::F64) };
/// let query = Continuous::by(certified);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Certified {
    /// Precision of the computation.
    pub precision: CertifiedPrecision,
    /// Tolerance of all pairs: a length from 0, in scene units. Features this near may count as in
    /// contact. Every time is early by at most the time that it takes to move this far. 0 uses the
    /// full precision. `None`: each pair has the smaller default of its two bodies, which is
    /// [`Certified::TOLERANCE`] times a body's mean edge.
    pub tolerance: Option<f64>,
    /// Most boxes that are tested for a pair before it is left undecided; `None` for
    /// [`Certified::MAX_ITERATIONS`]. Refused in f32 alone without a minimum separation: then no
    /// boxes are tested.
    pub max_iterations: Option<u32>,
    /// Minimum separation: a length from 0, in scene units. Features this near are in contact, and
    /// a time is when they first are. 0 for touching.
    pub min_separation: f64,
    /// Whether features within the separation at the start are in contact only from when they come
    /// nearer than there.
    pub approaching: bool,
}

/// Precision of a certified solver. None misses a contact. They differ in cost, and in the number
/// of undecided pairs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum CertifiedPrecision {
    /// In f32, then in f64 and beyond if f32 is not enough.
    #[default]
    Mixed,
    /// In f32 alone: leaves more pairs undecided.
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
    /// Default tolerance, in mean edges. The product is rounded down to a power of two, so that it
    /// does not depend on the order of summation. A smaller tolerance costs more; a larger one
    /// takes more near misses for contacts.
    pub const TOLERANCE: f64 = 1e-4;
    /// Default of `max_iterations`: ten times the demand of the hardest pairs of public scenes.
    pub const MAX_ITERATIONS: u32 = Params::MAX_ITERATIONS;

    /// Returns the solver of a precision, with all other choices at their defaults.
    pub const fn by(precision: CertifiedPrecision) -> Certified {
        Certified {
            precision,
            tolerance: None,
            max_iterations: None,
            min_separation: 0.0,
            approaching: false,
        }
    }

    /// Returns its name.
    pub const fn name(&self) -> Solver {
        match self.precision {
            CertifiedPrecision::Mixed => Solver::Certified,
            CertifiedPrecision::F32 => Solver::CertifiedF32,
            CertifiedPrecision::F64 => Solver::CertifiedF64,
        }
    }

    /// Checks that lengths are finite and at least 0, and that the limit has an effect.
    pub(super) fn check(&self) -> Result<(), Error> {
        let is_length = |x: f64| (0.0..f64::INFINITY).contains(&x);
        let no_length = |name: &str, value: f64| Error::InvalidArgument {
            what: format!("{name} must be finite and at least 0, got {value}"),
            advice: "give a length in the unit of the scene".into(),
        };
        if !is_length(self.min_separation) {
            return Err(no_length("minimum separation", self.min_separation));
        }
        if let Some(tolerance) = self.tolerance.filter(|&tolerance| !is_length(tolerance)) {
            return Err(no_length("tolerance", tolerance));
        }
        match self.max_iterations {
            Some(0) => Err(Error::InvalidArgument {
                what: "the limit of iterations must be at least 1, got 0".into(),
                advice: "give a larger limit".into(),
            }),
            Some(limit) if !self.tests_boxes() => Err(Error::InvalidArgument {
                what: format!(
                    "the limit of iterations has no effect, got {limit}: certified-f32 without a \
                     minimum separation tests no boxes"
                ),
                advice: "leave the limit out, or use certified or certified-f64".into(),
            }),
            _ => Ok(()),
        }
    }

    /// Returns whether a pair may be searched by boxes, so that a limit of them has an effect.
    fn tests_boxes(&self) -> bool {
        self.precision != CertifiedPrecision::F32 || self.is_apart()
    }

    /// Returns whether the minimum separation is above 0.
    #[doc(hidden)]
    pub fn is_apart(&self) -> bool {
        self.min_separation > 0.0
    }

    /// Returns the largest distance of features that may be listed: minimum separation plus
    /// tolerance. Volumes of such features overlap, for every kind of volume.
    pub(crate) fn listed_within(&self) -> f64 {
        let p = self.params();
        // Above 0 even if both are 0. The growth of volumes has a part of its own for rounding.
        (p.min_separation + p.tolerance).max(f64::MIN_POSITIVE)
    }

    /// Returns the parameters of the test. A `tolerance` of `None` counts as 0: choose it before.
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
