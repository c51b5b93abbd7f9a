//! Vertex positions in the precision of the input.

/// Positions of a mesh, one point per vertex, in the unit of the input. Doubles are never rounded
/// to floats.
#[derive(Debug, Clone, PartialEq)]
pub enum Positions {
    /// Single precision.
    F32(Vec<[f32; 3]>),
    /// Double precision.
    F64(Vec<[f64; 3]>),
}

#[cfg(feature = "nalgebra")]
impl From<Vec<nalgebra::Point3<f32>>> for Positions {
    fn from(points: Vec<nalgebra::Point3<f32>>) -> Self {
        Positions::F32(points.into_iter().map(Into::into).collect())
    }
}

#[cfg(feature = "nalgebra")]
impl From<Vec<nalgebra::Point3<f64>>> for Positions {
    fn from(points: Vec<nalgebra::Point3<f64>>) -> Self {
        Positions::F64(points.into_iter().map(Into::into).collect())
    }
}

impl Positions {
    /// Number of points.
    pub fn len(&self) -> usize {
        match self {
            Positions::F32(points) => points.len(),
            Positions::F64(points) => points.len(),
        }
    }

    /// Whether there are no points.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Whether the points are stored in double precision.
    pub fn is_f64(&self) -> bool {
        matches!(self, Positions::F64(_))
    }

    /// Point `i` in double precision, exactly; `None` past the end.
    pub fn get_f64(&self, i: usize) -> Option<[f64; 3]> {
        match self {
            Positions::F32(points) => points.get(i).map(|p| p.map(f64::from)),
            Positions::F64(points) => points.get(i).copied(),
        }
    }

    /// All points in double precision. Exact: every float is a double. Copies.
    pub fn to_f64(&self) -> Vec<[f64; 3]> {
        match self {
            Positions::F32(points) => points.iter().map(|p| p.map(f64::from)).collect(),
            Positions::F64(points) => points.clone(),
        }
    }

    /// The same points in double precision, without a copy if they already are.
    pub(crate) fn promoted(self) -> Positions {
        match self {
            Positions::F32(_) => Positions::F64(self.to_f64()),
            Positions::F64(_) => self,
        }
    }
}
