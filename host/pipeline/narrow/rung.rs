//! A rung of the certified solver: the rungs of a query, and the launch of each.

use crate::device::{Device, Place};
use crate::error::Error;
use crate::pipeline::launch;
use crate::pipeline::precision::Precision;
use crate::query::{Certified, CertifiedPrecision};
use nearmiss_kernels::abi::{RungArgs, Span, ThickRungArgs};
use nearmiss_kernels::entry::Entry;

/// A rung: one launch over the pairs that the one before left.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rung {
    /// Isolation of roots in f32.
    Isolate32,
    /// Isolation of roots in f64; touching at the start, and flat motion.
    Isolate64,
    /// Touching at the start, and flat motion. If there is no f64, all that f32 leaves, by directions
    /// and nearness too.
    Settle,
    /// The time window in slices.
    Slice,
    /// Separation, in f32.
    Separate32,
    /// Separation, in f64.
    Separate64,
    /// Separation by the largest radius of each pair, in f32: only parts pairs.
    Part,
    /// Separation of features whose radii differ, in f64.
    SeparateThick,
    /// Before all others: features that may be near at the start, if they must come nearer.
    Approach,
    /// Whether they do, by bounds of errors.
    ApproachSigns,
    /// Whether they do, in integers.
    ApproachExact,
    /// When they do, by advancement. The solver does not need it.
    ApproachAdvance,
}

/// Returns the rungs of a solver.
pub fn rungs(certified: &Certified) -> &'static [Rung] {
    match (certified.precision, certified.is_apart()) {
        (CertifiedPrecision::F64, true) => &[Rung::Separate64],
        (CertifiedPrecision::Mixed | CertifiedPrecision::F32, true) => &[Rung::Separate32, Rung::Separate64],
        (CertifiedPrecision::F32, false) => &[Rung::Isolate32, Rung::Settle],
        (CertifiedPrecision::F64, false) => &[Rung::Isolate64, Rung::Slice],
        (CertifiedPrecision::Mixed, false) => &[Rung::Isolate32, Rung::Isolate64, Rung::Slice],
    }
}

impl Rung {
    /// Returns which of the lists of [`Names::left`](super::left::Names::left) the undecided pairs of a rung of the
    /// solver go to.
    pub fn left(self) -> usize {
        matches!(self, Rung::Isolate64 | Rung::Settle | Rung::Slice | Rung::Separate64 | Rung::SeparateThick)
            as usize
    }

    /// Returns whether its blocks fill the device and each runs until the end: others then need a place.
    pub fn fills(self) -> bool {
        matches!(self, Rung::Separate32 | Rung::Part)
    }

    /// Launches it over up to `capacity` pairs.
    ///
    /// # Errors
    /// Device errors.
    pub fn start<R: Precision>(
        self,
        device: &Device,
        (capacity, place): (usize, Place),
        (args, radii): (&RungArgs<R>, Span<f64>),
    ) -> Result<(), Error> {
        let thick = || ThickRungArgs { rung: *args, radii };
        let at = (capacity, place);
        match self {
            Rung::Isolate32 => launch::striding::<R::Isolate32>(device, capacity, args),
            // All warps that run at once share the pairs; there are few.
            Rung::Isolate64 => spread::<R::Isolate64>(device, at, args),
            Rung::Settle => launch::striding::<R::Settle>(device, capacity, args),
            // A block per pair; there are few.
            Rung::Slice => spread::<R::Slice>(device, at, args),
            Rung::Separate32 => launch::at_once_in::<R::Separate32>(device, place, capacity, args),
            Rung::Separate64 => launch::at_once_in::<R::Separate64>(device, place, capacity, args),
            Rung::Approach => launch::striding::<R::Approach>(device, capacity, &thick()),
            // All warps that run at once share the pairs; there are few.
            Rung::ApproachSigns => spread::<R::ApproachSigns>(device, at, &thick()),
            Rung::ApproachExact => spread::<R::ApproachExact>(device, at, &thick()),
            Rung::ApproachAdvance => spread::<R::ApproachAdvance>(device, at, &thick()),
            Rung::Part => launch::at_once_in::<R::Part>(device, place, capacity, &thick()),
            Rung::SeparateThick => launch::at_once_in::<R::SeparateThick>(device, place, capacity, &thick()),
        }
    }
}

/// Launches as many blocks as run at once in a place, for few pairs that are spread over them.
fn spread<E: Entry>(device: &Device, (capacity, place): (usize, Place), args: &E::Args) -> Result<(), Error> {
    launch::at_once_in::<E>(device, place, capacity.saturating_mul(E::LANES as usize), args)
}
