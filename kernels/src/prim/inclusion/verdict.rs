//! Parameters and answers of certified tests.

use bytemuck::{Pod, Zeroable};

/// Parameters of a certified test.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Params {
    /// Allowance for contact, a length. Only the work and the number of reported pairs depend on
    /// it; 0 is the limit of the precision.
    pub tolerance: f64,
    /// Features this near are in contact, a length; 0 for touching. With a separation a tolerance
    /// below a millionth of it mostly ends as exhausted: the first contact of round shapes is
    /// tangent to them.
    pub min_separation: f64,
    /// The end of the step, in (0, 1].
    pub end: f64,
    /// The most boxes that are looked at.
    pub max_iterations: u32,
    /// Zero.
    pub pad: u32,
}

impl Params {
    /// Touching, within the whole step, with the usual limit of iterations.
    pub fn new(tolerance: f64) -> Self {
        Params { tolerance, min_separation: 0.0, end: 1.0, max_iterations: Self::MAX_ITERATIONS, pad: 0 }
    }

    /// Default number of boxes after which a pair is left undecided: ten times the number for the
    /// hardest public scenes.
    pub const MAX_ITERATIONS: u32 = 4096;
}

/// An answer in words of fixed size, as kernels write it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Verdict {
    /// No contact before; in [0, 1], never -0.0 or NaN.
    pub toi: f64,
    /// The first contact is not after; the end of the step, if there need be none.
    pub toi_upper: f64,
    /// 0 separated, 1 contact, 2 undecided; plus 4 if the iterations or the stack ended.
    pub state: u32,
    /// Boxes looked at.
    pub boxes: u32,
}

/// An answer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Answer {
    /// No contact, certainly.
    Separated,
    /// A contact, certainly; the first in `[toi, toi_upper]`.
    Contact {
        /// Not before.
        toi: f64,
        /// Not after.
        toi_upper: f64,
    },
    /// Near contact, or in it; no contact before `toi`, certainly.
    Undecided {
        /// Not before.
        toi: f64,
        /// The end of the step.
        toi_upper: f64,
    },
}

const SEPARATED: u32 = 0;
const CONTACT: u32 = 1;
const UNDECIDED: u32 = 2;
const EXHAUSTED: u32 = 4;

impl Verdict {
    /// No contact until `end`.
    #[inline]
    pub fn separated(end: f64, boxes: u32) -> Self {
        Verdict { toi: end, toi_upper: end, state: SEPARATED, boxes }
    }

    /// A contact at the start.
    pub const TOUCHING: Verdict = Verdict::contact(0.0, 0.0, 0, false);

    /// A contact, the first in `[toi, toi_upper]`.
    #[inline]
    pub const fn contact(toi: f64, toi_upper: f64, boxes: u32, exhausted: bool) -> Self {
        Verdict { toi, toi_upper, state: CONTACT | if exhausted { EXHAUSTED } else { 0 }, boxes }
    }

    /// No contact before `toi`.
    #[inline]
    pub fn undecided(toi: f64, end: f64, boxes: u32, exhausted: bool) -> Self {
        Verdict { toi, toi_upper: end, state: UNDECIDED | if exhausted { EXHAUSTED } else { 0 }, boxes }
    }

    /// The same with no time before `begin`, before which there is no contact.
    #[inline]
    pub fn not_before(self, begin: f64) -> Self {
        // For separated features the time is the end of the step, and later.
        let toi = if begin > self.toi { begin } else { self.toi };
        Verdict { toi, ..self }
    }

    /// The answer.
    #[inline]
    pub fn answer(&self) -> Answer {
        let Verdict { toi, toi_upper, state, .. } = *self;
        match state & !EXHAUSTED {
            SEPARATED => Answer::Separated,
            CONTACT => Answer::Contact { toi, toi_upper },
            _ => Answer::Undecided { toi, toi_upper },
        }
    }

    /// No contact, certainly.
    #[inline]
    pub fn is_separated(&self) -> bool {
        self.state == SEPARATED
    }

    /// A contact, certainly.
    #[inline]
    pub fn is_contact(&self) -> bool {
        self.state & CONTACT != 0
    }

    /// The iterations or the stack ended: `toi` may be far too early.
    #[inline]
    pub fn exhausted(&self) -> bool {
        self.state & EXHAUSTED != 0
    }

    /// Whether the verdict is final: separated, or a contact whose time is within the tolerance.
    /// `time_tolerance` is the time in which the features move by the tolerance.
    #[inline]
    pub(super) fn is_settled(&self, time_tolerance: f64) -> bool {
        let known =
            self.is_contact() && !self.exhausted() && self.toi_upper - self.toi <= 2.0 * time_tolerance;
        self.is_separated() || known
    }
}
