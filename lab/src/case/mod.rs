//! One case of the narrow phase: whether two features meet during the step, and when first.

pub mod file;

/// Kind of a pair of features.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Features {
    /// A vertex and a face: its point first, then the face's three corners.
    VertexFace,
    /// Two edges: the ends of the first, then those of the second.
    EdgeEdge,
}

/// Two features that move on straight lines from `positions_t0` to `positions_t1`, in [`Features`]'
/// order of points. Features are closed: touching counts. A face may be a segment or a point, and
/// an edge may be a point.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Case {
    /// Kind of the pair.
    pub features: Features,
    /// Positions of the four points at t = 0; finite.
    pub positions_t0: [[f64; 3]; 4],
    /// Positions of the four points at t = 1; finite.
    pub positions_t1: [[f64; 3]; 4],
}

impl Case {
    /// Returns whether f32 holds every coordinate.
    pub fn fits_f32(&self) -> bool {
        let mut all = self.positions_t0.iter().chain(&self.positions_t1).flatten();
        all.all(|&x| f64::from(x as f32) == x)
    }
}
