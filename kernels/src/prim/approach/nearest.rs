//! The point of the hull that is nearest to the origin at the start: where it is, and its plane.

use super::Motion;
use super::forms::{Form, Place, Ring, end, start};
use super::integers::Exact;
use super::numbers::Bounded;
use crate::prim::near::weights;

/// Signs of forms.
pub(super) trait Signs {
    /// A sign, if it is known.
    fn sign(&self, motion: &Motion<f64>, form: Form) -> Option<i32>;
    /// Whether the nearest point is searched for if it is not the suggested one.
    const SEARCHES: bool;
}

/// By bounds of errors alone.
pub(super) struct ByBounds;

impl Signs for ByBounds {
    #[inline(always)]
    fn sign(&self, motion: &Motion<f64>, form: Form) -> Option<i32> {
        motion.bounded(form).sign()
    }
    const SEARCHES: bool = false;
}

impl Signs for Exact<'_> {
    /// The exact sign, unless the coordinates span too many bits.
    #[inline(never)]
    fn sign(&self, motion: &Motion<f64>, form: Form) -> Option<i32> {
        motion.bounded(form).sign().or_else(|| Exact::sign(self, form))
    }
    const SEARCHES: bool = true;
}

/// Where the hull is nearest to the origin at the start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Nearest {
    Corner(u32),
    Side([u32; 2]),
    /// With the sign of the hull's height.
    Inside(i32),
}

impl Nearest {
    /// Whether the nearest point is a mixture with this corner.
    #[inline(always)]
    pub(super) fn has(self, k: u32) -> bool {
        match self {
            Nearest::Corner(a) => k == a,
            Nearest::Side([a, b]) => k == a || k == b,
            Nearest::Inside(_) => true,
        }
    }

    /// The sign of a form of heights, away from the origin: that of the hull's plane is on either side.
    #[inline(always)]
    pub(super) fn away(self, sign: i32) -> i32 {
        if let Nearest::Inside(of_hull) = self { of_hull * sign } else { sign }
    }

    /// The height above the plane.
    #[inline(always)]
    pub(super) fn above(self, to: Place) -> Form {
        match self {
            Nearest::Corner(a) => Form::Corner { a, to },
            Nearest::Side(side) => Form::Side { side, to },
            Nearest::Inside(_) => Form::Plane { to },
        }
    }

    /// `p . v`, or a positive multiple of it.
    #[inline(always)]
    pub(super) fn rate(self) -> Form {
        match self {
            Nearest::Corner(a) => Form::Corner { a, to: end(a) },
            Nearest::Side(side) => Form::SideRate { side },
            Nearest::Inside(_) => Form::PlaneRate,
        }
    }
}

/// The sides of a triangle, or of a parallelogram.
#[inline(always)]
fn side(at: u32, is_face: bool) -> [u32; 2] {
    match (at, is_face) {
        (0, _) => [0, 1],
        (1, _) => [0, 2],
        (2, true) => [1, 2],
        (2, false) => [1, 3],
        _ => [2, 3],
    }
}

impl Motion<'_, f64> {
    /// Where the hull is nearest to the origin, by the computed nearest point, if bounds prove that it
    /// is nowhere else. Then the features do not touch.
    #[inline(never)]
    pub(super) fn suggested(&self) -> Option<Nearest> {
        let is_face = self.pair.is_face;
        let nearest = suggestion(weights(self.differences(), is_face), is_face);
        let is_proven = match nearest {
            Nearest::Corner(_) => self.is_beyond(nearest),
            Nearest::Side(side) => {
                let along = |at| self.bounded(Form::Along { side, at }).sign();
                along(side[0]) == Some(-1) && along(side[1]) == Some(1) && self.is_beyond(nearest)
            }
            Nearest::Inside(_) => self.is_inside(),
        };
        match nearest {
            _ if !is_proven => None,
            Nearest::Inside(_) => self.bounded(Form::PlaneHeight).sign().map(Nearest::Inside),
            _ => Some(nearest),
        }
    }

    /// Whether all other corners are strictly beyond the plane through a corner or a side.
    #[inline(always)]
    fn is_beyond(&self, nearest: Nearest) -> bool {
        let is_above = |k| self.bounded(nearest.above(start(k))).sign() == Some(1);
        (0..self.corners()).all(|k| nearest.has(k) || is_above(k))
    }

    /// Whether the point of the hull's plane that is nearest to the origin is strictly inside.
    #[inline(always)]
    fn is_inside(&self) -> bool {
        let [s, t] = [1, 2].map(|k| self.bounded(Form::Weight { k }));
        let area = self.bounded(Form::PlaneSquare);
        let rest = area.minus(&s);
        let is_above = |x: Bounded| x.sign() == Some(1);
        // Both weights of a triangle add up to less than 1; each of a parallelogram's is less.
        let is_below = if self.pair.is_face {
            is_above(rest.minus(&t))
        } else {
            is_above(rest) && is_above(area.minus(&t))
        };
        is_above(s) && is_above(t) && is_below
    }

    /// Where the hull is nearest to the origin: at the first corner or side that is nearest, else
    /// inside.
    #[inline(always)]
    pub(super) fn nearest<S: Signs>(&self, signs: &S) -> Option<Nearest> {
        let corners = self.corners();
        let mut a = 0;
        while a < corners {
            if self.supports(signs, Nearest::Corner(a))? {
                return Some(Nearest::Corner(a));
            }
            a += 1;
        }
        let mut at = 0;
        while at < corners {
            let side = side(at, self.pair.is_face);
            let [a, b] = side;
            // Strictly: a side without length has no nearest point between its ends.
            let is_between = signs.sign(self, Form::Along { side, at: a })? < 0
                && signs.sign(self, Form::Along { side, at: b })? > 0;
            if is_between && self.supports(signs, Nearest::Side(side))? {
                return Some(Nearest::Side(side));
            }
            at += 1;
        }
        signs.sign(self, Form::PlaneHeight).map(Nearest::Inside)
    }

    /// Whether the whole hull is beyond the plane at the start.
    #[inline(always)]
    fn supports<S: Signs>(&self, signs: &S, nearest: Nearest) -> Option<bool> {
        let mut k = 0;
        while k < self.corners() {
            if !nearest.has(k) && self.height(signs, nearest, start(k))? < 0 {
                return Some(false);
            }
            k += 1;
        }
        Some(true)
    }

    /// The sign of the height of a control vector above the plane.
    #[inline(always)]
    pub(super) fn height<S: Signs>(&self, signs: &S, nearest: Nearest, to: Place) -> Option<i32> {
        let sign = signs.sign(self, nearest.above(to))?;
        Some(nearest.away(sign))
    }

    /// The sign of `p . v`.
    #[inline(always)]
    pub(super) fn rate<S: Signs>(&self, signs: &S, nearest: Nearest) -> Option<i32> {
        let sign = signs.sign(self, nearest.rate())?;
        Some(nearest.away(sign))
    }

    /// Whether the features touch at the start.
    #[inline(always)]
    pub(super) fn touches<S: Signs>(&self, signs: &S, nearest: Nearest) -> Option<bool> {
        match nearest {
            Nearest::Corner(a) => signs.sign(self, Form::CornerSquare { a }).map(|sign| sign == 0),
            Nearest::Side(side) => signs.sign(self, Form::SideHeight { side }).map(|sign| sign == 0),
            Nearest::Inside(of_hull) => Some(of_hull == 0),
        }
    }
}

/// The place of a point of a hull, by its weights of both sides from `x[0]`, as
/// [`crate::prim::near`] has them: those of a face are to `x[1]` and `x[2]`, those of edges to `x[2]` and `x[1]`. Ends are exact.
#[inline(always)]
fn suggestion([s, t]: [f64; 2], is_face: bool) -> Nearest {
    let (s_is_0, t_is_0) = (s == 0.0, t == 0.0);
    if is_face {
        match (s_is_0, t_is_0) {
            (true, true) => Nearest::Corner(0),
            (false, true) if s == 1.0 => Nearest::Corner(1),
            (true, false) if t == 1.0 => Nearest::Corner(2),
            (false, true) => Nearest::Side([0, 1]),
            (true, false) => Nearest::Side([0, 2]),
            _ if s == 1.0 - t => Nearest::Side([1, 2]),
            _ => Nearest::Inside(0),
        }
    } else {
        let (s_is_end, t_is_end) = (s_is_0 || s == 1.0, t_is_0 || t == 1.0);
        let [row, column] = [2 * !s_is_0 as u32, !t_is_0 as u32];
        match (s_is_end, t_is_end) {
            (true, true) => Nearest::Corner(row + column),
            (true, false) => Nearest::Side([row, row + 1]),
            (false, true) => Nearest::Side([column, column + 2]),
            _ => Nearest::Inside(0),
        }
    }
}
