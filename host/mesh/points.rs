//! Borrowed positions.

use super::Positions;
use crate::error::Error;
use bytemuck::NoUninit;

/// Positions owned by the caller, one point per vertex; making them copies nothing.
///
/// ```
/// use nearmiss::mesh::Points;
///
/// let rows: Points = (&[[0.0f32, 1.0, 2.0]]).into();
/// let flat = Points::flat(&[0.0f32, 1.0, 2.0])?;
/// assert_eq!((rows.len(), flat.len()), (1, 1));
/// # Ok::<(), nearmiss::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Points<'a> {
    /// Single precision.
    F32(&'a [[f32; 3]]),
    /// Double precision.
    F64(&'a [[f64; 3]]),
}

impl<'a> Points<'a> {
    /// Points of consecutive numbers: x, y, z, x, y, z, …
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] if the number of numbers is not a multiple of three.
    pub fn flat<T: Coordinate>(numbers: &'a [T]) -> Result<Points<'a>, Error> {
        let (points, rest) = numbers.as_chunks();
        if rest.is_empty() {
            return Ok(T::points(points));
        }
        Err(Error::InvalidArgument {
            what: format!("positions must have three numbers a point, got {} numbers", numbers.len()),
            advice: "pass x, y and z of each point".into(),
        })
    }

    /// Points of another library's type, such as glam's `Vec3` and `DVec3`: three numbers without
    /// padding, and known to bytemuck.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] for a type of another size or alignment.
    pub fn of<T: Coordinate, P: NoUninit>(points: &'a [P]) -> Result<Points<'a>, Error> {
        if size_of::<P>() != 3 * size_of::<T>() {
            return Err(no_points::<P>());
        }
        bytemuck::try_cast_slice(points).map(T::points).map_err(|_| no_points::<P>())
    }

    /// Number of points.
    pub fn len(&self) -> usize {
        match self {
            Points::F32(points) => points.len(),
            Points::F64(points) => points.len(),
        }
    }

    /// Whether there are no points.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Copies the points into positions of the caller, in doubles or as they are. Allocates only if
    /// the memory there is too small.
    pub(crate) fn copy_to(self, to: &mut Positions, as_f64: bool) {
        match (self, &mut *to) {
            (Points::F32(from), Positions::F32(points)) if !as_f64 => from.clone_into(points),
            (Points::F64(from), Positions::F64(points)) => from.clone_into(points),
            (Points::F32(from), _) if !as_f64 => *to = Positions::F32(from.to_vec()),
            (Points::F64(from), _) => *to = Positions::F64(from.to_vec()),
            (Points::F32(from), _) => *to = Positions::F64(from.iter().map(|p| p.map(f64::from)).collect()),
        }
    }
}

/// A coordinate of a position: `f32` or `f64`.
pub trait Coordinate: bytemuck::Pod + sealed::Sealed {
    /// Points of such numbers.
    #[doc(hidden)]
    fn points(points: &[[Self; 3]]) -> Points<'_>;
}

mod sealed {
    pub trait Sealed {}
    impl Sealed for f32 {}
    impl Sealed for f64 {}
}

impl Coordinate for f32 {
    fn points(points: &[[f32; 3]]) -> Points<'_> {
        Points::F32(points)
    }
}

impl Coordinate for f64 {
    fn points(points: &[[f64; 3]]) -> Points<'_> {
        Points::F64(points)
    }
}

impl<'a, T: Coordinate> From<&'a [[T; 3]]> for Points<'a> {
    fn from(points: &'a [[T; 3]]) -> Points<'a> {
        T::points(points)
    }
}

#[cfg(feature = "nalgebra")]
impl<'a, T: Coordinate + nalgebra::Scalar> From<&'a [nalgebra::Point3<T>]> for Points<'a> {
    fn from(points: &'a [nalgebra::Point3<T>]) -> Points<'a> {
        // Three numbers without padding, which `Pod` of nalgebra proves.
        T::points(bytemuck::cast_slice(points))
    }
}

impl<'a, T: Coordinate> From<&'a Vec<[T; 3]>> for Points<'a> {
    fn from(points: &'a Vec<[T; 3]>) -> Points<'a> {
        T::points(points)
    }
}

impl<'a, T: Coordinate, const N: usize> From<&'a [[T; 3]; N]> for Points<'a> {
    fn from(points: &'a [[T; 3]; N]) -> Points<'a> {
        T::points(points)
    }
}

impl<'a> From<&'a Positions> for Points<'a> {
    fn from(positions: &'a Positions) -> Points<'a> {
        match positions {
            Positions::F32(points) => Points::F32(points),
            Positions::F64(points) => Points::F64(points),
        }
    }
}

fn no_points<P>() -> Error {
    Error::InvalidArgument {
        what: format!("a point must be three f32 or f64 without padding, got {}", std::any::type_name::<P>()),
        advice: "pass [f32; 3], [f64; 3] or a type of the same layout".into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_are_borrowed_from_rows_flat_numbers_and_other_types() {
        let rows = [[0.0f32, 1.0, 2.0], [3.0, 4.0, 5.0]];
        let wanted = Points::F32(&rows);
        assert_eq!(Points::from(&rows), wanted);
        assert_eq!(Points::from(&rows.to_vec()), wanted);
        assert_eq!(Points::from(&rows[..]), wanted);
        assert_eq!(Points::from(&Positions::F32(rows.to_vec())), wanted);
        assert_eq!(Points::flat(rows.as_flattened()).expect("six numbers"), wanted);
        assert_eq!(Points::of::<f32, _>(&rows).expect("three floats"), wanted);
        assert_eq!(Points::from(&[[0.0f64; 3]; 2]).len(), 2);
    }

    #[test]
    fn numbers_that_are_no_points_are_refused() {
        let error = Points::flat(&[0.0f64; 4]).expect_err("refused").to_string();
        assert!(error.contains("4 numbers"), "{error}");
        let error = Points::of::<f32, [f64; 3]>(&[[0.0; 3]]).expect_err("refused").to_string();
        assert!(error.contains("[f64; 3]"), "{error}");
    }

    #[test]
    fn memory_of_positions_is_used_again() {
        let mut positions = Positions::F32(vec![[1.0; 3]; 4]);
        let Positions::F32(points) = &positions else { panic!("singles") };
        let before = points.as_ptr();
        Points::from(&[[2.0f32; 3]; 4]).copy_to(&mut positions, false);
        let Positions::F32(points) = &positions else { panic!("singles") };
        assert_eq!((points.as_ptr(), points[3]), (before, [2.0; 3]));
        Points::from(&[[2.0f32; 3]; 4]).copy_to(&mut positions, true);
        assert_eq!(positions, Positions::F64(vec![[2.0; 3]; 4]));
    }
}
