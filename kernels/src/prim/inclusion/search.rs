//! The search: boxes of parameters, the nearest first, cut along their own directions, until all is decided.

use super::bound::Image;
use super::cell::{Cell, Grid};
use super::direction::{Cuts, Directions, unit};
use super::local::Local;
use super::verdict::{Params, Verdict};
use crate::math::Vec3;
use crate::math::tolerance::INCLUSION_SHRUNK;
use core::mem::MaybeUninit;

/// What is known so far. Times after the step mean none.
struct Known<S> {
    /// The earliest start of an accepted box.
    accepted: S,
    /// The earliest start of a box that was skipped since it starts within the tolerance of something known.
    skipped: S,
    /// There is a contact, not later.
    certain: S,
}

/// What a look at a box gives.
enum Look<S> {
    /// No contact in it.
    Nothing,
    /// As small as can be told; where it starts.
    Small(S),
    /// No contact but in a part, much smaller.
    Part(Cell<S>),
    /// Two halves, the nearer first.
    Halves(Cell<S>, Cell<S>),
}

/// Searches the whole motion. The stack needs [`super::STACK`] places at most; with fewer the answer may be early.
#[inline]
pub fn solve<S: Grid, const N: usize>(
    m: &Local<S, N>,
    p: &Params,
    stack: &mut [MaybeUninit<Cell<S>>],
) -> Verdict {
    if m.still_together() {
        return Verdict::contact(0.0, 0.0, 0, false);
    }
    if !m.finite {
        return Verdict::unresolved(0.0, p.end, 0, true);
    }
    let never = S::of(2.0);
    let mut known = Known { accepted: never, skipped: never, certain: never };
    let (mut boxes, mut depth, mut exhausted) = (0, 0, false);
    let mut cell = Cell::whole(m.end);
    loop {
        let start = cell.low[0];
        let bound = known.accepted.min(known.certain);
        let mut next = None;
        if bound < never && start + m.pause >= bound {
            if !(start > known.certain) {
                known.skipped = known.skipped.min(start);
            }
        } else if boxes >= p.budget {
            exhausted = true;
            known.accepted = known.accepted.min(start);
        } else {
            boxes += 1;
            match m.look(&cell, &mut known) {
                Look::Nothing => {}
                Look::Small(start) => known.accepted = known.accepted.min(start),
                Look::Part(part) => next = Some(part),
                Look::Halves(near, far) => {
                    if let Some(place) = stack.get_mut(depth) {
                        place.write(far);
                        depth += 1;
                    } else {
                        exhausted = true;
                        known.accepted = known.accepted.min(far.low[0]);
                    }
                    next = Some(near);
                }
            }
        }
        cell = match next {
            Some(cell) => cell,
            None if depth == 0 => break,
            None => {
                depth -= 1;
                // SAFETY: places below `depth` were written when it passed them.
                unsafe { stack[depth].assume_init() }
            }
        };
    }
    let first = known.accepted.min(known.skipped);
    if !(first < never) {
        return Verdict::separated(p.end, boxes);
    }
    let first = first.wide();
    let toi = if first < p.end { first } else { p.end };
    if known.certain < never {
        Verdict::contact(toi, known.certain.wide(), boxes, exhausted)
    } else {
        Verdict::unresolved(toi, p.end, boxes, exhausted)
    }
}

impl<S: Grid, const N: usize> Local<S, N> {
    /// Looks at a box: at its image, its shadows along several directions, and what of it they leave.
    #[inline(always)]
    fn look(&self, cell: &Cell<S>, known: &mut Known<S>) -> Look<S> {
        let image = self.image(cell);
        let Image { f, low, high, error } = &image;
        let width = *high - *low;
        if (0..3).any(|k| {
            let more = error[k] + self.separation;
            low[k] > more || high[k] < -more
        }) {
            return Look::Nothing;
        }
        self.within_separation(cell, &image, known);
        // How the image changes with each parameter, summed over four edges.
        let mut c = [Vec3([S::ZERO; 3]); 3];
        for k in 0..3 {
            for i in (0..8).filter(|i| i >> k & 1 == 0) {
                c[k] = c[k] + (f[i | 1 << k] - f[i]);
            }
        }
        let mut cuts = Cuts { low: [S::ZERO; 3], high: [S::ZERO; 3], signs: 0 };
        let directions = Directions::of(c);
        let reach = low.map(S::abs).max(high.map(S::abs));
        let slack = Vec3([0, 1, 2].map(|k| error[k] + S::INCLUSION_SHADOW * reach[k]));
        for i in 0..directions.count(self.separation > S::ZERO) {
            let Some(d) = unit(directions.get(i, || sum(f))) else { continue };
            let more = d.map(S::abs).dot(slack) * S::INCLUSION_UP + S::INCLUSION_UNDERFLOW + self.apart(d);
            if !cuts.shadow(&f.map(|x| d.dot(x)), more, i) {
                return Look::Nothing;
            }
        }
        if cuts.signs == 7 && self.holds(cell) && directions.independent() {
            known.certain = known.certain.min(cell.high[0]);
        }
        let Some(part) = cell.without(cuts.low, cuts.high) else { return Look::Nothing };
        let Some(part) = (if N == 3 { part.in_face() } else { Some(part) }) else { return Look::Nothing };
        let small = (0..3).all(|k| width[k] <= self.tolerance)
            || (0..3).all(|k| low[k] >= -error[k] && high[k] <= error[k]);
        if small {
            return Look::Small(part.low[0]);
        }
        let shrunk = S::of(INCLUSION_SHRUNK);
        if (0..3).any(|k| part.high[k] - part.low[k] < shrunk * (cell.high[k] - cell.low[k])) {
            return Look::Part(part);
        }
        // The parameter along which the image is longest, of those that are wider than a step.
        let (mut along, mut most) = (3, S::ZERO);
        for k in 0..3 {
            let mut longest = S::ZERO;
            for i in (0..8).filter(|i| i >> k & 1 == 0) {
                let edge = (f[i | 1 << k] - f[i]).map(S::abs);
                longest = longest.max(edge[0]).max(edge[1]).max(edge[2]);
            }
            // Of a flat image the roots are a curve: earlier times first, or both halves are followed to their ends.
            if k == 0 && directions.flat() && longest > self.tolerance {
                longest = S::of(64.0);
            }
            if part.high[k] - part.low[k] > S::STEP && (along == 3 || longest > most) {
                (along, most) = (k, longest);
            }
        }
        if along == 3 {
            return Look::Small(part.low[0]);
        }
        let [a, b] = part.halves(along);
        // The earlier half; else that on the side of the face nearer to the origin.
        let towards = if along == 1 { c[1] } else { c[2] };
        if along > 0 && towards.dot(sum(f)) < S::ZERO { Look::Halves(b, a) } else { Look::Halves(a, b) }
    }

    /// Whether all of a box belongs to the features and to the step.
    #[inline]
    fn holds(&self, cell: &Cell<S>) -> bool {
        (N != 3 || cell.high[1] <= S::ONE - cell.high[2]) && !(self.beyond && cell.high[0] >= self.end)
    }

    /// Notes a corner that is certainly within the separation.
    #[inline]
    fn within_separation(&self, cell: &Cell<S>, image: &Image<S>, known: &mut Known<S>) {
        if !(self.separation > S::ZERO) {
            return;
        }
        // The separation was rounded up; this is below the one that was asked for.
        // The square may lose to underflow what is far below the bound's margin, as the largest reach is about one.
        let less = self.separation * (S::ONE - S::of(16.0) * S::U) - S::INCLUSION_UNDERFLOW;
        let error = image.error[0] + image.error[1] + image.error[2];
        for (i, x) in image.f.iter().enumerate() {
            let at = |k: usize| if i >> k & 1 == 0 { cell.low[k] } else { cell.high[k] };
            let inside = N != 3 || at(1) <= S::ONE - at(2);
            let held = !(self.beyond && at(0) >= self.end);
            if inside && held && (x.dot(*x).sqrt() + error) * S::INCLUSION_UP <= less {
                known.certain = known.certain.min(at(0));
            }
        }
    }
}

#[inline]
fn sum<S: Grid>(f: &[Vec3<S>; 8]) -> Vec3<S> {
    ((f[0] + f[1]) + (f[2] + f[3])) + ((f[4] + f[5]) + (f[6] + f[7]))
}
