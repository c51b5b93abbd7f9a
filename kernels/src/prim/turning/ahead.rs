//! A look ahead of features that are near and undecided: is there a certain contact soon?
//!
//! Such a contact bounds the first one from above. It proves nothing about other times.

use super::certificate::Contact;
use super::motion::Motion;
use super::place::Place;

/// How far it looks: the first step times `2^15`.
const PROBES: u32 = 16;
/// Steps of a parabola towards an extremum.
const STEPS: u32 = 6;
/// A number that rises in two steps after this many probes will not fall soon.
const RISING: u32 = 6;

/// A wanted place, and how far others are from it.
trait Goal<const N: usize> {
    /// A number that falls towards the goal.
    fn far(&self, place: &Place<N>) -> f64;
    /// Whether the place is one.
    fn is_reached(&self, place: &Place<N>) -> bool;
}

/// The other side of the common plane.
struct OtherSide(f64);

impl<const N: usize> Goal<N> for OtherSide {
    #[inline(always)]
    fn far(&self, place: &Place<N>) -> f64 {
        self.0 * place.volume
    }
    #[inline(always)]
    fn is_reached(&self, place: &Place<N>) -> bool {
        self.0 * place.side() < 0.0
    }
}

/// Within a separation.
struct Within<'a, const N: usize>(&'a Motion<N>, f64);

impl<const N: usize> Goal<N> for Within<'_, N> {
    #[inline(always)]
    fn far(&self, place: &Place<N>) -> f64 {
        place.distance
    }
    #[inline(always)]
    fn is_reached(&self, place: &Place<N>) -> bool {
        self.0.is_within(place, self.1)
    }
}

impl<const N: usize> Motion<N> {
    /// A certain contact after `from`, at which the features are near; `step` is a short time.
    #[inline(never)]
    pub fn contact_ahead(&self, from: &Place<N>, step: f64, end: f64, limits: [f64; 2]) -> Option<Contact> {
        let [tolerance, separation] = limits;
        if separation > 0.0 {
            let place = self.ahead(from, step, end, &Within(self, separation))?;
            return Some(Contact { from: place.t, to: place.t });
        }
        if from.side() == 0.0 {
            return None;
        }
        let place = self.ahead(from, step, end, &OtherSide(from.side()))?;
        self.contact(from, &place, tolerance, &mut -1.0)
    }

    /// The first place found that reaches the goal: by probes, each twice as far, until the number
    /// has been lower between two others; then by parabolas.
    #[inline(always)]
    fn ahead(&self, from: &Place<N>, step: f64, end: f64, goal: &impl Goal<N>) -> Option<Place<N>> {
        // Times and numbers of the last three places.
        let first = (from.t, goal.far(from));
        let mut last = [first; 3];
        let mut step = step;
        for k in 0..PROBES {
            let t = if from.t + step < end { from.t + step } else { end };
            if !(t > last[2].0) {
                break;
            }
            let place = self.at(t);
            if goal.is_reached(&place) {
                return Some(place);
            }
            last = [last[1], last[2], (t, goal.far(&place))];
            let [a, b, c] = last.map(|x| x.1);
            if k > 0 && b <= a && b <= c {
                break;
            }
            if k > RISING && c > b && b > a {
                return None;
            }
            step *= 2.0;
        }
        for _ in 0..STEPS {
            let [a, b, c] = last;
            let (xa, xc, ya, yc) = (a.0 - b.0, c.0 - b.0, a.1 - b.1, c.1 - b.1);
            let t = b.0 + (xc * xc * ya - xa * xa * yc) / (2.0 * (xc * ya - xa * yc));
            if !(t > a.0 && t < c.0 && t != b.0) {
                return None;
            }
            let place = self.at(t);
            if goal.is_reached(&place) {
                return Some(place);
            }
            let next = (t, goal.far(&place));
            last = match (next.1 < b.1, t < b.0) {
                (true, true) => [a, next, b],
                (true, false) => [b, next, c],
                (false, true) => [next, b, c],
                (false, false) => [a, b, next],
            };
        }
        None
    }
}
