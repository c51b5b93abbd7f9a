//! Polygons to triangles: the fan if it covers the face once, else ears.
//!
//! A face is projected along the axis of the largest component of its normal (Newell's, the vector
//! area). All signs are exact.
//! A cut is right by its parts: another triangle adds one to the cover of its points. If every
//! triangle turns as the face does, each point is covered as often as the face winds around it.
//! That is once, if the face does not cross itself.
//!
//! Every edge of a face is an edge of a triangle in any cut. So the fan of a face without area
//! covers it whole.
//! The fan of a face that crosses itself covers every point that the face winds around. The winding
//! number is the sum over the triangles of the fan: if it is not 0, a triangle covers the point.
//! The fan may cover more: triangles that turn differently may overlap.

mod cross;
mod ears;
mod flat;
mod plane;

use crate::note::{Notes, Treated};
use crate::polygons::Polygons;
use nearmiss::mesh::{Positions, Problem};
use nearmiss_kernels::math::Vec3;
use nearmiss_kernels::prim::exact::orient2d_exact;
use nearmiss_kernels::prim::orient::{orient2d_filter, plane_of};
use plane::View;

type Point = [f64; 2];

/// Maximum corners of a face that is cut by ears.
const MOST_CORNERS: usize = 1 << 17;

/// Cuts every face again whose fan is wrong, and keeps its corners. The number of triangles stays.
/// Every corner names a position. A face that crosses itself keeps its fan, and is noted by
/// [`Problem::FaceCrosses`] or [`Problem::FaceFolds`].
///
/// Cost: O(corners) for faces whose fan is right. Otherwise ears and crossings are searched among
/// corners and edges whose extents along a line overlap. That is O(n log n) for a face that winds
/// little, O(n^2) at worst.
/// Combs, spirals and stars of 100,000 corners took 8 to 33 s, of 10,000 a hundredth of that.
/// Beyond [`MOST_CORNERS`] a face is refused.
///
/// # Errors
/// [`Problem::FaceCorners`], for the first such face.
pub(super) fn cut(
    positions: &Positions,
    faces: &mut Vec<[u32; 3]>,
    polygons: &mut Polygons,
) -> Result<Notes, Problem> {
    let (mut corners, mut points, mut notes) = (Vec::new(), Vec::new(), Notes::default());
    if polygons.is_empty() {
        return Ok(notes);
    }
    faces.shrink_to_fit(); // room for what follows
    for face in 0..polygons.count(faces.len()) {
        let triangles = polygons.triangles(face, faces.len());
        if triangles.len() < 2 {
            continue;
        }
        polygons.corners(face, faces, &mut corners);
        points.clear();
        points.extend(corners.iter().map(|&v| positions.get_f64(v as usize).unwrap_or_default()));
        let names = |edge: [u32; 2]| edge.map(|corner| corners[corner as usize]);
        match polygon(&points) {
            Ok(None) => {}
            Ok(Some(ears)) => {
                polygons.keep(face, &corners);
                for (to, ear) in faces[triangles].iter_mut().zip(ears) {
                    *to = ear.map(|corner| corners[corner as usize]);
                }
            }
            Err(Fault::Crosses([e, f])) => notes.add(Treated::Fan, || {
                let edges = [names(e), names(f)];
                Problem::FaceCrosses { face, corners: corners.len(), edges }
            }),
            Err(Fault::Long) => {
                return Err(Problem::FaceCorners { face, corners: corners.len(), limit: MOST_CORNERS });
            }
            Err(Fault::Folds) => {
                notes.add(Treated::Fan, || Problem::FaceFolds { face, corners: corners.len() });
            }
        }
    }
    Ok(notes)
}

/// Fault of a polygon, in its corners.
enum Fault {
    Crosses([[u32; 2]; 2]),
    Folds,
    Long,
}

/// The triangles of a polygon in its corners; `None` if its fan is right, or as right as any cut.
fn polygon(points: &[[f64; 3]]) -> Result<Option<Vec<[u32; 3]>>, Fault> {
    let views = plane::views(points);
    // On a line, or there and back: it encloses nothing.
    if views.is_empty() || views.len() > 1 && flat::returns(points) {
        return Ok(None);
    }
    let short = points.len() <= MOST_CORNERS;
    for &View { axis, sign } in &views {
        let seen = see(points, axis);
        if is_fan(&seen, sign) {
            return Ok(None);
        }
        if let Some(ears) = short.then(|| ears::cut(&seen, sign)).flatten() {
            return Ok(Some(ears));
        }
    }
    if short { refuse(points, views[0].axis) } else { Err(Fault::Long) }
}

/// The fault of a flat face. A face that is not flat has no right cut, so its fan is as good as
/// any.
fn refuse(points: &[[f64; 3]], axis: usize) -> Result<Option<Vec<[u32; 3]>>, Fault> {
    if !flat::is_flat(points) {
        return Ok(None);
    }
    let all: Vec<u32> = (0..points.len() as u32).collect();
    Err(cross::crossing(&see(points, axis), &all).map_or(Fault::Folds, Fault::Crosses))
}

fn see(points: &[[f64; 3]], axis: usize) -> Vec<Point> {
    let (i, j) = plane_of(axis);
    points.iter().map(|p| [p[i], p[j]]).collect()
}

/// Whether the fan around the first corner covers the polygon once. From there, the other corners
/// must follow in the sense of the polygon, at most once around. True for convex polygons, and all
/// that are visible whole from the first corner.
fn is_fan(at: &[Point], sign: i32) -> bool {
    let from = at[0];
    let mut others = at.iter().copied().filter(|p| *p != from);
    let Some(first) = others.next() else { return true };
    let (mut last, mut past_half) = (first, false);
    for p in others {
        match sign * turn(from, last, p) {
            1 => {}
            0 if ahead(from, last, p) => {}
            _ => return false,
        }
        match sign * turn(from, first, p) {
            -1 => past_half = true,
            0 if !ahead(from, first, p) => {}
            _ if past_half => return false,
            _ => {}
        }
        last = p;
    }
    true
}

/// The sign of the turn from `a` by `b` to `c`, exactly; 1 is counter-clockwise.
fn turn(a: Point, b: Point, c: Point) -> i32 {
    let [a, b, c] = [a, b, c].map(|p| Vec3([p[0], p[1], 0.0]));
    orient2d_filter(a, b, c, 2).unwrap_or_else(|| orient2d_exact(a, b, c, 2))
}

/// Whether `a` and `b`, collinear with `from`, are on the same side of it.
fn ahead(from: Point, a: Point, b: Point) -> bool {
    (0..2).all(|k| a[k].partial_cmp(&from[k]) == b[k].partial_cmp(&from[k]))
}
