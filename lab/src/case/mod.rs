//! One question of the narrow phase by itself: do these two features meet during the step, and when first?

pub mod file;

/// Which features.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Features {
    /// A vertex and a face: its point first, then the face's three corners.
    VertexFace,
    /// Two edges: the ends of the one, then those of the other.
    EdgeEdge,
}

/// Two features that move on straight lines from `positions_t0` to `positions_t1`, in [`Features`]' order of points.
/// Closed: touching counts. Features without extent (a face that is a segment, an edge that is a point) are what they are.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Case {
    /// Which features.
    pub features: Features,
    /// Where the four points are at t = 0; finite.
    pub positions_t0: [[f64; 3]; 4],
    /// Where they are at t = 1; finite.
    pub positions_t1: [[f64; 3]; 4],
}

impl Case {
    /// Whether f32 holds every coordinate.
    pub fn fits_f32(&self) -> bool {
        let mut all = self.positions_t0.iter().chain(&self.positions_t1).flatten();
        all.all(|&x| f64::from(x as f32) == x)
    }
}
