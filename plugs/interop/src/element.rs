//! Types of the elements of arrays.

use nearmiss::Error;
use nearmiss::scene::Number;

mod sealed {
    pub trait Sealed {}
}

/// Type of the elements of an array of positions.
///
/// - `f32`, `f64`: the coordinates x, y, z of the first vertex, then of the next.
/// - `[f32; 3]`, `[f64; 3]`: one vertex each.
/// - `[f32; 4]`, `[f64; 4]`: one vertex each; the fourth number is ignored.
pub trait Element: sealed::Sealed + Copy + 'static {
    /// Precision of the numbers.
    const NUMBER: Number;
    /// Numbers of an element.
    const NUMBERS: usize;
}

macro_rules! elements {
    ($($element:ty: $number:ident, $numbers:literal;)*) => {$(
        impl sealed::Sealed for $element {}
        impl Element for $element {
            const NUMBER: Number = Number::$number;
            const NUMBERS: usize = $numbers;
        }
    )*};
}

elements! {
    f32: F32, 1;
    f64: F64, 1;
    [f32; 3]: F32, 3;
    [f64; 3]: F64, 3;
    [f32; 4]: F32, 4;
    [f64; 4]: F64, 4;
}

/// Rows of three numbers in an array.
pub(crate) struct Shape {
    /// Number of rows.
    pub rows: usize,
    /// Bytes from one row to the next.
    pub stride: usize,
}

/// The shape of an array of `len` elements.
///
/// # Errors
/// [`Error::InvalidArgument`] for single numbers that are not three for each vertex.
pub(crate) fn shape<T: Element>(len: usize) -> Result<Shape, Error> {
    let elements = if T::NUMBERS == 1 { 3 } else { 1 };
    if !len.is_multiple_of(elements) {
        return Err(Error::InvalidArgument {
            what: format!("an array of positions must have three numbers for each vertex, got {len} numbers"),
            advice: "pass x, y and z of every vertex".into(),
        });
    }
    Ok(Shape { rows: len / elements, stride: elements * size_of::<T>() })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows and stride; the error as text.
    fn shaped<T: Element>(len: usize) -> Result<(usize, usize), String> {
        shape::<T>(len).map(|shape| (shape.rows, shape.stride)).map_err(|error| error.to_string())
    }

    #[test]
    fn rows_follow_from_the_type() {
        for vertices in [0, 1, 7, 1 << 20] {
            assert_eq!(shaped::<f32>(3 * vertices), Ok((vertices, 12)));
            assert_eq!(shaped::<f64>(3 * vertices), Ok((vertices, 24)));
            assert_eq!(shaped::<[f32; 3]>(vertices), Ok((vertices, 12)));
            assert_eq!(shaped::<[f64; 3]>(vertices), Ok((vertices, 24)));
            assert_eq!(shaped::<[f32; 4]>(vertices), Ok((vertices, 16)));
            assert_eq!(shaped::<[f64; 4]>(vertices), Ok((vertices, 32)));
        }
    }

    #[test]
    fn numbers_that_make_no_vertex_are_refused() {
        for len in [1, 2, 4, 3_000_001, usize::MAX - 1] {
            let error = shaped::<f32>(len).expect_err("no multiple of three");
            assert!(error.contains(&format!("got {len} numbers; pass x, y and z")), "{error}");
            assert_eq!(shaped::<f64>(len), Err(error));
        }
    }
}
