//! The search: boxes of parameters, the nearest first, cut along their own directions, until all is
//! decided.

use super::bound::Image;
use super::cell::{Cell, Grid};
use super::direction::{Cuts, DECOUPLING, Directions, longest, shift, unit};
use super::local::Local;
use super::verdict::{Params, Verdict};
use crate::math::Vec3;
use crate::math::tolerance::INCLUSION_SHRUNK;
use core::mem::MaybeUninit;

/// Known times; [`Grid::NEVER`] for none.
#[derive(Clone, Copy, Debug)]
struct Known<S> {
    /// The earliest start of an accepted box.
    accepted: S,
    /// The earliest start of a box that was skipped since it starts within the tolerance of
    /// something known.
    skipped: S,
    /// There is a contact, not later.
    certain: S,
}

/// The result of a test of a box.
enum CellResult<S> {
    /// No contact in it.
    Nothing,
    /// As small as the precision resolves; its start.
    Small(S),
    /// No contact but in a part, much smaller.
    Part(Cell<S>),
    /// Two halves, the nearer first.
    Halves(Cell<S>, Cell<S>),
}

/// A search in progress: parameters, known times, and the next box. One box a step, so that a GPU's
/// lanes can take new pairs when they finish theirs.
pub struct Search<'a, S, const N: usize> {
    m: Local<S, N>,
    known: Known<S>,
    cell: Cell<S>,
    /// Boxes that wait.
    stack: &'a mut [MaybeUninit<Cell<S>>],
    depth: usize,
    boxes: u32,
    exhausted: bool,
}

impl<'a, S: Grid, const N: usize> Search<'a, S, N> {
    /// Starts a search, or returns at once the result of the filters, or of input that is not
    /// finite. The stack needs at most [`super::STACK`] places. With fewer the answer may be early.
    ///
    /// # Errors
    /// The verdict, if no search is needed, and whether it is final.
    #[inline]
    pub fn begin(
        m: Local<S, N>,
        p: &Params,
        stack: &'a mut [MaybeUninit<Cell<S>>],
    ) -> Result<Self, (Verdict, bool)> {
        if m.apart_by_axes() || m.apart_by_planes() {
            return Err((Verdict::separated(p.end, 0), true));
        }
        Self::unfiltered(m, p, stack)
    }

    /// Starts without the filters, at a time before which there is no contact.
    ///
    /// # Errors
    /// The verdict, if no search is needed, and whether it is final.
    #[inline]
    pub fn from(
        m: Local<S, N>,
        p: &Params,
        stack: &'a mut [MaybeUninit<Cell<S>>],
        begin: f64,
    ) -> Result<Self, (Verdict, bool)> {
        let mut search = Self::unfiltered(m, p, stack)?;
        search.cell.low.0[0] = S::down(S::of(begin));
        Ok(search)
    }

    /// Starts without the filters.
    ///
    /// # Errors
    /// The verdict, if no search is needed, and whether it is final.
    #[inline]
    pub fn unfiltered(
        m: Local<S, N>,
        p: &Params,
        stack: &'a mut [MaybeUninit<Cell<S>>],
    ) -> Result<Self, (Verdict, bool)> {
        if m.still_together() {
            return Err((Verdict::TOUCHING, true));
        }
        if !m.finite || p.max_iterations == 0 {
            return Err((Verdict::undecided(0.0, p.end, 0, true), false));
        }
        let known = Known { accepted: S::NEVER, skipped: S::NEVER, certain: S::NEVER };
        Ok(Search { m, known, cell: Cell::whole(m.end), stack, depth: 0, boxes: 0, exhausted: false })
    }

    /// Tests one box. When no box is left: the verdict, and whether it is final.
    #[inline]
    pub fn step(&mut self, p: &Params) -> Option<(Verdict, bool)> {
        self.boxes += 1;
        let next = match self.m.look(&self.cell, &mut self.known) {
            CellResult::Nothing => None,
            CellResult::Small(start) => {
                self.accept(start);
                None
            }
            CellResult::Part(part) => Some(part),
            CellResult::Halves(near, far) => {
                if let Some(place) = self.stack.get_mut(self.depth) {
                    place.write(far);
                    self.depth += 1;
                } else {
                    self.exhausted = true;
                    self.accept(far.low[0]);
                }
                Some(near)
            }
        };
        self.go_on(next, p)
    }

    /// Takes up the next box that is worth a look, of those that wait if there is no `next`.
    #[inline]
    fn go_on(&mut self, mut next: Option<Cell<S>>, p: &Params) -> Option<(Verdict, bool)> {
        loop {
            if next.is_none() && self.depth > 0 {
                self.depth -= 1;
                // SAFETY: `depth` is this search's own, and places below it were written when it
                // passed them.
                next = Some(unsafe { self.stack[self.depth].assume_init() });
            }
            let Some(cell) = next else {
                let verdict = self.verdict(p);
                let settled = verdict.is_settled(self.m.time_tolerance.wide()) && !self.m.below_precision;
                return Some((verdict, settled || verdict.is_separated()));
            };
            let start = cell.low[0];
            let bound = self.known.accepted.min(self.known.certain);
            if bound < S::NEVER && start + self.m.time_tolerance >= bound {
                if !(start > self.known.certain) {
                    self.known.skipped = self.known.skipped.min(start);
                }
            } else if self.boxes >= p.max_iterations {
                self.exhausted = true;
                self.accept(start);
            } else {
                self.cell = cell;
                return None;
            }
            next = None;
        }
    }

    /// There may be a contact in a box that starts there.
    #[inline]
    fn accept(&mut self, start: S) {
        self.known.accepted = self.known.accepted.min(start);
    }

    /// The verdict when no box is left.
    #[inline]
    fn verdict(&self, p: &Params) -> Verdict {
        let (known, boxes, exhausted) = (&self.known, self.boxes, self.exhausted);
        let first = known.accepted.min(known.skipped);
        if !(first < S::NEVER) {
            return Verdict::separated(p.end, boxes);
        }
        let first = first.wide();
        let toi = if first < p.end { first } else { p.end };
        if known.certain < S::NEVER {
            Verdict::contact(toi, known.certain.wide(), boxes, exhausted)
        } else {
            Verdict::undecided(toi, p.end, boxes, exhausted)
        }
    }
}

impl<S: Grid, const N: usize> Local<S, N> {
    /// Tests a box: its image, its projections along several directions, and the rest that they
    /// leave. About 1,200 operations. A function of its own, so that the search's state does not
    /// take registers from it on the GPU.
    #[inline(never)]
    fn look(&self, cell: &Cell<S>, known: &mut Known<S>) -> CellResult<S> {
        let image = self.image(cell);
        let Image { f, low, high, error } = &image;
        if (0..3).any(|k| {
            let more = error[k] + self.separation;
            low[k] > more || high[k] < -more
        }) {
            return CellResult::Nothing;
        }
        // Not kept for later: registers are dear.
        let mut small = (0..3).all(|k| high[k] - low[k] <= self.tolerance)
            || (0..3).all(|k| low[k] >= -error[k] && high[k] <= error[k]);
        if self.separation > S::ZERO {
            self.within_separation(cell, &image, known);
            let near = self.separation + self.tolerance;
            small = small || farthest(f) <= near * near;
        }
        let mut cuts = Cuts::none();
        let directions = Directions::of(f);
        let slack = image.slack();
        for i in 0..directions.count(self.separation > S::ZERO) {
            // Those that decouple the parameters have cut it much: the others will cut the rest
            // better.
            if i == DECOUPLING && cuts.deep() {
                break;
            }
            let Some(d) = unit(directions.get(i, || sum(f))) else { continue };
            let (products, error) = image.projection(d, slack);
            if !cuts.projection(&products, error, self.apart(d), i) {
                return CellResult::Nothing;
            }
        }
        let all_of_face = N != 3 || cell.high[1] <= S::ONE - cell.high[2];
        if cuts.signs == 7 && all_of_face && self.within_step(cell.high[0]) && directions.independent() {
            known.certain = known.certain.min(cell.high[0]);
        }
        let [low, high] = cuts.parts();
        let Some(part) = cell.without(low, high) else { return CellResult::Nothing };
        let Some(part) = (if N == 3 { part.in_face() } else { Some(part) }) else {
            return CellResult::Nothing;
        };
        if small {
            return CellResult::Small(part.low[0]);
        }
        let shrunk = S::of(INCLUSION_SHRUNK);
        if (0..3).any(|k| part.high[k] - part.low[k] < shrunk * (cell.high[k] - cell.low[k])) {
            return CellResult::Part(part);
        }
        // The parameter along which the image is longest, of those that are wider than a step.
        let mut along = (3, S::ZERO);
        let mut consider = |k: usize, extent: S| {
            if part.high[k] - part.low[k] > S::STEP && (along.0 == 3 || extent > along.1) {
                along = (k, extent);
            }
        };
        // The roots of a flat image are a curve: earlier times first, or both halves are followed
        // to their ends.
        let lasting = self.extent(f, 0);
        consider(0, if directions.flat() && lasting > self.tolerance { S::of(64.0) } else { lasting });
        consider(1, self.extent(f, 1));
        consider(2, self.extent(f, 2));
        let along = along.0;
        if along == 3 {
            return CellResult::Small(part.low[0]);
        }
        let [a, b] = part.halves(along);
        // The earlier half; else that on the side of the face nearer to the origin.
        if along > 0 && directions.change(along).dot(sum(f)) < S::ZERO {
            CellResult::Halves(b, a)
        } else {
            CellResult::Halves(a, b)
        }
    }

    /// The effect of a parameter on the decision. That is the change of the image. With a
    /// separation it is the change of the distance from the origin: first order along the
    /// direction, second order across it.
    #[inline(always)]
    fn extent(&self, f: &[Vec3<S>; 8], k: usize) -> S {
        let most = longest(f, k);
        if !(self.separation > S::ZERO) {
            return most;
        }
        let centre = sum(f);
        let along = shift(f, k, centre) / centre.dot(centre).sqrt();
        most.min(along + most * most / self.separation)
    }

    /// Whether a time of the grid is within the step. The end of the step may have been rounded up
    /// to the grid.
    #[inline(always)]
    fn within_step(&self, t: S) -> bool {
        !(self.beyond && t >= self.end)
    }

    /// Notes the corner at the start of the box, or at the end of its time, if it is certainly
    /// within the separation. Both belong to the features: a face's box is never wholly beyond
    /// `u + v = 1`.
    #[inline(always)]
    fn within_separation(&self, cell: &Cell<S>, image: &Image<S>, known: &mut Known<S>) {
        // The separation was rounded up; this is below the requested one. The square may underflow
        // far below the margin of the error, as the largest reach is about one.
        let less = self.separation * (S::ONE - S::of(16.0) * S::U) - S::INCLUSION_UNDERFLOW;
        let error = image.error[0] + image.error[1] + image.error[2];
        let held = |x: Vec3<S>| (x.dot(x).sqrt() + error) * S::INCLUSION_UP <= less;
        if held(image.f[0]) && self.within_step(cell.low[0]) {
            known.certain = known.certain.min(cell.low[0]);
        } else if held(image.f[1]) && self.within_step(cell.high[0]) {
            known.certain = known.certain.min(cell.high[0]);
        }
    }
}

#[inline]
fn sum<S: Grid>(f: &[Vec3<S>; 8]) -> Vec3<S> {
    ((f[0] + f[1]) + (f[2] + f[3])) + ((f[4] + f[5]) + (f[6] + f[7]))
}

/// The largest square of a corner's distance from the origin.
#[inline(always)]
fn farthest<S: Grid>(f: &[Vec3<S>; 8]) -> S {
    let [a, b, c, d, e, g, h, i] = f.map(|x| x.dot(x));
    (a.max(b).max(c.max(d))).max(e.max(g).max(h.max(i)))
}
