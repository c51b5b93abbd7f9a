//! Sources of the signs of determinants: one decision logic, several sources.

use super::exact::{orient2d_exact, orient3d_exact};
use super::orient::{Plane, orient2d_filter};
use crate::math::{Real, Vec3};

/// A source of signs. Each sign is right or `None`; so a decision made of them is right or
/// uncertain.
pub trait Signs<R: Real> {
    /// The sign of det[a-d, b-d, c-d].
    fn orient3d(a: Vec3<R>, b: Vec3<R>, c: Vec3<R>, d: Vec3<R>) -> Option<i32>;
    /// The sign of the orientation of three points with coordinate `axis` dropped. Coordinates are
    /// (1, 2), (2, 0) or (0, 1).
    fn orient2d(a: Vec3<R>, b: Vec3<R>, c: Vec3<R>, axis: usize) -> Option<i32>;
    /// `orient3d(t[0], t[1], t[2], p)` for three points: some sources do them cheaper together.
    #[inline]
    fn sides(t: &[Vec3<R>; 3], p: &[Vec3<R>; 3]) -> [Option<i32>; 3] {
        p.map(|d| Self::orient3d(t[0], t[1], t[2], d))
    }
}

/// Floats of the input's precision with a proven bound; `None` if they do not decide. See
/// [`super::orient`].
pub struct Filter;
/// f64 with a proven bound, from f32 input: it nearly always decides the pairs that the f32 filter
/// leaves.
pub struct Wide;
/// Integers, never `None`. See [`super::exact`].
pub struct Exact;
/// [`Filter`], then [`Exact`] for the very signs that it leaves: never `None`, and the best for a
/// CPU.
pub struct Certain;

impl<R: Real> Signs<R> for Filter {
    #[inline]
    fn orient3d(a: Vec3<R>, b: Vec3<R>, c: Vec3<R>, d: Vec3<R>) -> Option<i32> {
        Plane::through(a, b, c).side(d)
    }
    #[inline]
    fn orient2d(a: Vec3<R>, b: Vec3<R>, c: Vec3<R>, axis: usize) -> Option<i32> {
        orient2d_filter(a, b, c, axis)
    }
    #[inline]
    fn sides(t: &[Vec3<R>; 3], p: &[Vec3<R>; 3]) -> [Option<i32>; 3] {
        let plane = Plane::through(t[0], t[1], t[2]);
        [plane.side(p[0]), plane.side(p[1]), plane.side(p[2])]
    }
}

impl<R: Real> Signs<R> for Wide {
    #[inline]
    fn orient3d(a: Vec3<R>, b: Vec3<R>, c: Vec3<R>, d: Vec3<R>) -> Option<i32> {
        Filter::orient3d(a.wide(), b.wide(), c.wide(), d.wide())
    }
    #[inline]
    fn orient2d(a: Vec3<R>, b: Vec3<R>, c: Vec3<R>, axis: usize) -> Option<i32> {
        Filter::orient2d(a.wide(), b.wide(), c.wide(), axis)
    }
    #[inline]
    fn sides(t: &[Vec3<R>; 3], p: &[Vec3<R>; 3]) -> [Option<i32>; 3] {
        Filter::sides(&t.map(Vec3::wide), &p.map(Vec3::wide))
    }
}

impl<R: Real> Signs<R> for Exact {
    fn orient3d(a: Vec3<R>, b: Vec3<R>, c: Vec3<R>, d: Vec3<R>) -> Option<i32> {
        Some(orient3d_exact(a, b, c, d))
    }
    fn orient2d(a: Vec3<R>, b: Vec3<R>, c: Vec3<R>, axis: usize) -> Option<i32> {
        Some(orient2d_exact(a, b, c, axis))
    }
}

// Out of line: the decision around it has dozens of signs, and these are the rare ones.
impl<R: Real> Signs<R> for Certain {
    #[inline(never)]
    fn orient3d(a: Vec3<R>, b: Vec3<R>, c: Vec3<R>, d: Vec3<R>) -> Option<i32> {
        Wide::orient3d(a, b, c, d).or_else(|| Exact::orient3d(a, b, c, d))
    }
    #[inline(never)]
    fn orient2d(a: Vec3<R>, b: Vec3<R>, c: Vec3<R>, axis: usize) -> Option<i32> {
        Wide::orient2d(a, b, c, axis).or_else(|| Exact::orient2d(a, b, c, axis))
    }
    #[inline(never)]
    fn sides(t: &[Vec3<R>; 3], p: &[Vec3<R>; 3]) -> [Option<i32>; 3] {
        let s = Wide::sides(t, p);
        core::array::from_fn(|i| s[i].or_else(|| Exact::orient3d(t[0], t[1], t[2], p[i])))
    }
}
