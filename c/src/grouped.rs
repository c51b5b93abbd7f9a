//! Rows of an answer by features of a body, and curves in which surfaces cross.

use crate::answer::{NearmissAnswer, show};
use crate::detector::NearmissDetector;
use crate::error::{NearmissCode, NearmissError, given, refused};
use nearmiss::Error;
use nearmiss::contacts::{Curves, GroupBy, Grouped, crossing_curves};
use std::mem::MaybeUninit;

/// Features of a body by which rows are grouped.
#[allow(non_camel_case_types, reason = "as C sees them")]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum NearmissGroupBy {
    /// Vertices: of vertex/face and edge/vertex rows, and both of two points.
    NEARMISS_BY_VERTEX = 0,
    /// Edges: both of edge/edge rows, and those of edge/vertex rows.
    NEARMISS_BY_EDGE = 1,
    /// Triangles, then edges of none, then points: faces of vertex/face rows, and both of a
    /// triangle pair.
    NEARMISS_BY_FACE = 2,
    /// All vertices that take part in a row: four of a row of features, six of a triangle pair.
    NEARMISS_BY_CORNER = 3,
}

/// Rows by feature. The rows of feature i are `rows[starts[i]]` to `rows[starts[i + 1] - 1]`,
/// ascending.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct NearmissGrouped {
    /// Start of each feature's rows, and their end: one number more than features.
    pub starts: *const u32,
    /// Indices of rows in the answer.
    pub rows: *const u32,
    /// Number of features: of all vertices, edges or faces of the body.
    pub feature_count: usize,
    /// Number of entries of `rows`.
    pub row_count: usize,
}

/// Curves in which surfaces cross. Curve k has the points `points[starts[k]]` to
/// `points[starts[k + 1] - 1]`; a closed curve has its first point again at its end. Segments are
/// one less than points, so those of curve k begin at `rows[starts[k] - k]`.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct NearmissCurves {
    /// Points of all curves, curve by curve, in scene units.
    pub points: *const [f64; 3],
    /// First point of each curve, and the number of points: one number more than curves.
    pub starts: *const usize,
    /// Whether each curve is closed.
    pub is_closed: *const bool,
    /// Row of each segment.
    pub rows: *const u32,
    /// Group of each curve. Rows that share a triangle or an end are in one group.
    pub groups: *const u32,
    /// Group of each row of the answer: UINT32_MAX for rows that do not cross.
    pub row_groups: *const u32,
    /// Number of curves.
    pub curve_count: usize,
    /// Number of rows of the answer.
    pub row_count: usize,
}

/// Curves, with the groups of rows as C sees them.
#[derive(Default)]
pub(crate) struct ShownCurves {
    found: Curves,
    row_groups: Vec<u32>,
}

pub(crate) fn by_of(by: u32) -> Result<GroupBy, Error> {
    Ok(match by {
        0 => GroupBy::Vertex,
        1 => GroupBy::Edge,
        2 => GroupBy::Face,
        3 => GroupBy::Corner,
        other => {
            let what = format!("features by which rows are grouped are unknown, got {other}");
            return Err(refused(what, "choose a NearmissGroupBy, such as NEARMISS_BY_VERTEX"));
        }
    })
}

/// Groups the rows of an answer to a continuous, near or discrete query by features of a body. `by`
/// is a `NearmissGroupBy`; triangle pairs have faces and corners alone. The bodies must be those of
/// the query. The lists live until the next call of this function with the answer. Cost: linear, on
/// the host.
///
/// Fails with `NEARMISS_INVALID_ARGUMENT` for other answers, and if there is no such body.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_detector_grouped(
    detector: Option<&mut NearmissDetector>,
    answer: Option<&mut NearmissAnswer>,
    body: u32,
    by: u32,
    grouped: Option<&mut MaybeUninit<NearmissGrouped>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    NearmissDetector::work(detector, error, |own| {
        let (answer, to) = (given(answer, "answer")?, given(grouped, "grouped")?);
        let (id, by) = (own.body(body)?, by_of(by)?);
        // The lists that were shown before make room first.
        answer.grouped = Grouped::default();
        answer.grouped = own.detector.grouped(&answer.found, id, by)?;
        let Grouped { starts, rows } = &answer.grouped;
        to.write(NearmissGrouped {
            starts: starts.as_ptr(),
            rows: rows.as_ptr(),
            feature_count: answer.grouped.len(),
            row_count: rows.len(),
        });
        Ok(())
    })
}

/// The least time of contact, or the least distance, of each vertex of a body: over the rows of an
/// answer to a continuous or a near query in which it takes part, infinity without one. Times are
/// `toi`; distances are those of surfaces, without thickness. The list lives until the next call of
/// this function with the answer.
///
/// Vertices that stop at different times leave the straight lines that were tested: query the
/// shortened step again. Fails as `nearmiss_detector_grouped`.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_detector_least_by_vertex(
    detector: Option<&mut NearmissDetector>,
    answer: Option<&mut NearmissAnswer>,
    body: u32,
    items: Option<&mut MaybeUninit<*const f64>>,
    count: Option<&mut MaybeUninit<usize>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    NearmissDetector::work(detector, error, |own| {
        let (answer, id) = (given(answer, "answer")?, own.body(body)?);
        answer.least = Vec::new();
        answer.least = own.detector.least_by_vertex(&answer.found, id)?;
        show(&answer.least, items, count)
    })
}

/// The curves in which surfaces cross: the segments of the rows of an answer to a discrete query
/// that cross, chained by the vertices, edges and faces that hold their ends. The bodies must be
/// where they were at the query. The lists live until the next call of this function with the
/// answer. Cost: that of `nearmiss_detector_pair_geometry`.
///
/// A curve ends at a border of a mesh, at a seam of vertices with equal coordinates, where it runs
/// along an edge that is on a face, and where more than two surfaces meet. It runs along the product
/// of both normals, the first row's first triangle times its second.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_detector_curves(
    detector: Option<&mut NearmissDetector>,
    answer: Option<&mut NearmissAnswer>,
    curves: Option<&mut MaybeUninit<NearmissCurves>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    NearmissDetector::work(detector, error, |own| {
        let (answer, to) = (given(answer, "answer")?, given(curves, "curves")?);
        answer.curves = ShownCurves::default();
        answer.require_pairs()?;
        let geometry = own.detector.geometry(&answer.found)?;
        let found = crossing_curves(geometry.pairs(), own.detector.scene().bodies())?;
        let row_groups = found.row_groups.iter().map(|group| group.unwrap_or(u32::MAX)).collect();
        answer.curves = ShownCurves { found, row_groups };
        let ShownCurves { found, row_groups } = &answer.curves;
        to.write(NearmissCurves {
            points: found.points.as_ptr(),
            starts: found.starts.as_ptr(),
            is_closed: found.is_closed.as_ptr(),
            rows: found.rows.as_ptr(),
            groups: found.groups.as_ptr(),
            row_groups: row_groups.as_ptr(),
            curve_count: found.len(),
            row_count: row_groups.len(),
        });
        Ok(())
    })
}
