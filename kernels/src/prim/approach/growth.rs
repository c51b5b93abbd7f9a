//! The time until which the distance of two features is not below that at the start, `d`.
//!
//! Let `y` be a point of the hull at the start, `y = p + z`, and `v` its velocity. `p . z >= 0`, so
//! `|y|^2 >= d^2 + |z|^2`. Velocities differ by at most `k |z|` from that at `p`, where `k` bounds the
//! change of the hull's shape: `(|a| |b'| + |b| |a'|) / |a cross b|` for its sides `a` and `b` with
//! their velocities. With `V` the largest velocity of a corner,
//!
//! `|y + t v|^2 >= |y|^2 + 2 t y . v >= d^2 + 2 t p . v + |z|^2 - 2 t |z| (V + k d)
//!             >= d^2 + 2 t p . v - t^2 (V + k d)^2`.
//!
//! That is at least `d^2` until `2 p . v / (V + k d)^2`, and largest at half of that.

use super::forms::{Form, end, start};
use super::numbers::Bounded;
use super::{Bounds, Motion, Nearest};
use crate::math::tolerance::{Tolerance, U64};
use crate::math::{Real, Vec3};
use crate::prim::isolate::pair::most;

impl Motion<'_, f64> {
    /// The time until which all control vectors are beyond the plane at the start. Not after it.
    #[inline(always)]
    pub(super) fn beyond_until(&self, nearest: Nearest) -> f64 {
        let (mut until, mut k) = (1.0, 0);
        while k < self.corners() {
            let (first, last) = (self.bounded(nearest.above(start(k))), self.bounded(nearest.above(end(k))));
            if last.least() < 0.0 {
                let least = Real::max(first.least(), 0.0);
                until = Real::min(until, least / (least - last.least()) * f64::INCLUSION_DOWN);
            }
            k += 1;
        }
        // All of the hull is in its own plane.
        if matches!(nearest, Nearest::Inside(_)) { 0.0 } else { until }
    }

    /// The time at which the bound of the distance is largest: see the module. Not after it.
    #[inline(always)]
    pub(super) fn grows_until(&self, nearest: Nearest, distance: Bounds) -> f64 {
        let rate = self.bounded(nearest.rate());
        let area = self.bounded(Form::PlaneSquare);
        // p . v, of the form's multiple of it.
        let rate = match nearest {
            Nearest::Corner(_) => rate.least(),
            Nearest::Side(side) => {
                let square = self.bounded(Form::SideSquare { side }).most();
                rate.least() / (square * square)
            }
            Nearest::Inside(of_hull) => {
                let rate = if of_hull < 0 { Bounded { value: -rate.value, ..rate } } else { rate };
                let area = area.most();
                distance.least * rate.least() / (area * Real::sqrt(area))
            }
        };
        let speed = self.speed() + self.strain(area.least()) * distance.most;
        let time = rate / (speed * speed) * (f64::INCLUSION_DOWN * f64::INCLUSION_DOWN);
        if time > 0.0 { Real::min(time, 1.0) } else { 0.0 }
    }

    /// The largest velocity of a control vector; not below it.
    #[inline(always)]
    fn speed(&self) -> f64 {
        self.pair.w.iter().map(|[start, end]| self.longest(*end - *start)).fold(0.0, Real::max)
    }

    /// The length of a difference of differences; not below it.
    #[inline(always)]
    fn longest(&self, v: Vec3<f64>) -> f64 {
        let [a, b] = self.pair.edges;
        let reach = [a[0], a[1], b[0], b[1]].into_iter().map(most).fold(self.pair.reach, Real::max);
        (Real::sqrt(v.dot(v)) + 8.0 * U64 * reach + f64::ISOLATE_UNDERFLOW) * f64::INCLUSION_UP
    }

    /// By how much velocities of points of the hull differ, over their distance; not below it.
    #[inline(always)]
    fn strain(&self, area: f64) -> f64 {
        let [a, b] = self.pair.edges;
        let length = |e: [Vec3<f64>; 2]| self.longest(e[0]);
        let change = |e: [Vec3<f64>; 2]| self.longest(e[1] - e[0]);
        let along = |e: [Vec3<f64>; 2]| change(e) / (Real::sqrt(e[0].dot(e[0])) * f64::INCLUSION_DOWN);
        // A side may have no length, and a face may be a segment.
        let are_points = if self.pair.is_face {
            [self.are_one(1, 2), self.are_one(1, 3)]
        } else {
            [self.are_one(0, 1), self.are_one(2, 3)]
        };
        match are_points {
            [true, true] => return 0.0,
            [true, false] => return along(b),
            [false, true] => return along(a),
            [false, false] if self.pair.is_face && self.are_one(2, 3) => return along(a),
            [false, false] => {}
        }
        let over = if area > 0.0 { 1.0 / Real::sqrt(area) } else { f64::INFINITY };
        (length(a) * change(b) + length(b) * change(a)) * over * (f64::INCLUSION_UP * f64::INCLUSION_UP)
    }
}
