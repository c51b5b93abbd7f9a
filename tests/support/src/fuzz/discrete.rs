//! Two triangles: exact signs against linear programs over the rationals.

use super::bytes::{Bytes, largest};
use nearmiss_kernels::math::{Real, Vec3};
use nearmiss_kernels::prim::moller::moller;
use nearmiss_kernels::prim::tri_tri::meets_exactly;
use nearmiss_lab::oracle::{Triangle, triangles_meet};
use std::hint::black_box;

/// The triangles of the bytes, and whether f32 holds them.
pub fn decode(bytes: &[u8]) -> ([Triangle; 2], bool) {
    let mut b = Bytes::new(bytes);
    let mut points = Vec::new();
    for _ in 0..6 {
        let point = b.point_or(&points);
        points.push(point);
    }
    let limit = largest(b.is_single());
    let t = |from: usize| [0, 1, 2].map(|i| points[from + i].map(|x: f64| x.clamp(-limit, limit)));
    ([t(0), t(3)], b.is_single())
}

/// Tests the triangles, and judges the answer after `lie` has changed it.
pub fn ask(bytes: &[u8], lie: impl Fn(bool) -> bool) -> Result<(), String> {
    let (triangles, single) = decode(bytes);
    let mut answers = vec![("f64", answer::<f64>(&triangles))];
    if single {
        answers.push(("f32", answer::<f32>(&triangles)));
    }
    let truth = triangles_meet(&triangles[0], &triangles[1]);
    for (precision, found) in answers {
        let found = lie(found);
        if found != truth {
            return Err(format!("exact in {precision} returns {found}, the oracle {truth}: {triangles:?}"));
        }
    }
    Ok(())
}

/// The answer by exact signs; the float test need only return.
fn answer<R: Real>(triangles: &[Triangle; 2]) -> bool {
    let [p, q] = triangles.map(|t| t.map(|x| Vec3(x.map(R::of))));
    black_box(moller(&p, &q));
    meets_exactly(&p, &q)
}
