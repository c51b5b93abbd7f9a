//! Arrays in the host's memory.

use crate::errors::{choice, raised, warn};
use crate::watch::left_behind;
use nearmiss::mesh::{MAX_FACES, MAX_VERTICES, Positions, Problem};
use nearmiss::{Body, Error, memory};
use nearmiss_io::MeshFile;
use numpy::{
    Element, PyArray1, PyArray2, PyArrayDescrMethods, PyArrayMethods, PyReadonlyArray2, PyUntypedArray,
    PyUntypedArrayMethods,
};
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use std::path::PathBuf;

/// Read a PLY, OBJ, STL, OFF or glTF file, also with .gz appended.
///
/// - `path`: the file.
/// - `strict`: raise InputError for each part of the file that would be skipped or cut otherwise.
/// - `elements`: also return edges and points of no face.
///
/// Returns (vertices, faces): (n, 3) float32 or float64 as in the file, and (m, 3) uint32. Polygons
/// are cut into triangles. Lines and points of the file come behind them as faces [a, b, b] and
/// [p, p, p]. With `elements`, returns (vertices, faces, edges, points) for Body: edges are (k, 2)
/// uint32 and points (l,) uint32. A MeshWarning counts parts that are skipped, left out (faces of
/// one or two corners) or cut as a fan (faces that cross themselves).
///
/// Raises InputError for a file that is no mesh, with the line or element.
#[pyfunction]
#[pyo3(signature = (path, *, strict = false, elements = false))]
pub fn read_mesh<'py>(
    py: Python<'py>,
    path: PathBuf,
    strict: bool,
    elements: bool,
) -> PyResult<Bound<'py, PyTuple>> {
    let read = move || MeshFile::read(&path).and_then(|mesh| if strict { mesh.strict() } else { Ok(mesh) });
    let mesh = left_behind(py, read)?.map_err(raised)?;
    for note in mesh.notes() {
        warn(py, &note.to_string())?;
    }
    let mesh = mesh.into_mesh();
    if elements {
        let loose = (rows(py, mesh.edges()), PyArray1::from_slice(py, mesh.points()));
        return (points(py, mesh.positions()), rows(py, mesh.faces()), loose.0, loose.1).into_pyobject(py);
    }
    let body = Body::deformable(mesh);
    (points(py, body.positions_t0()), rows(py, body.elements())).into_pyobject(py)
}

/// Points in the precision that they have, copied.
pub fn points<'py>(py: Python<'py>, of: &Positions) -> Bound<'py, PyAny> {
    match of {
        Positions::F32(points) => rows(py, points).into_any(),
        Positions::F64(points) => rows(py, points).into_any(),
    }
}

/// Rows of numbers, copied.
pub fn rows<'py, T: Element + Copy + bytemuck::Pod, const N: usize>(
    py: Python<'py>,
    rows: &[[T; N]],
) -> Bound<'py, PyArray2<T>> {
    let flat = PyArray1::from_slice(py, rows.as_flattened());
    // So many numbers there are.
    #[allow(clippy::expect_used, reason = "rows times columns are all numbers")]
    flat.reshape([rows.len(), N]).expect("rows of equal length")
}

/// Refuses an array of numpy with masked numbers: they are none.
pub fn refuse_masked(object: &Bound<'_, PyAny>) -> PyResult<()> {
    let masked = object.py().import("numpy")?.getattr("ma")?;
    if object.is_instance(&masked.getattr("MaskedArray")?)?
        && masked.call_method1("is_masked", (object,))?.is_truthy()?
    {
        return Err(choice("array has masked numbers", "fill them, or give the rows without them"));
    }
    Ok(())
}

/// As an array of numpy whose numbers are aligned: itself if it is one, without a copy where its maker allows that.
pub fn asarray<'py>(object: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyUntypedArray>> {
    refuse_masked(object)?;
    let numpy = object.py().import("numpy")?;
    let made = numpy.call_method1("require", (object, object.py().None(), "A"))?;
    Ok(made.cast_into::<PyUntypedArray>()?)
}

/// Whether these are numbers in single or double precision, as the machine has them.
pub fn are_floats(array: &Bound<'_, PyUntypedArray>) -> bool {
    let dtype = array.dtype();
    dtype.kind() == b'f' && [4, 8].contains(&dtype.itemsize()) && [b'=', b'|'].contains(&dtype.byteorder())
}

/// Refuses what are no numbers that become floats or doubles.
pub fn are_numbers(array: &Bound<'_, PyUntypedArray>, what: &str) -> PyResult<()> {
    let dtype = array.dtype();
    match (dtype.kind(), dtype.itemsize()) {
        (b'f' | b'i' | b'u', ..=8) => Ok(()),
        _ => Err(choice(
            format!("{what} of type {}", dtype.str()?),
            "give numbers in single or double precision, or integers",
        )),
    }
}

/// Numbers in single or in double precision, as they are; other numbers become doubles.
fn floats<'py>(array: Bound<'py, PyUntypedArray>, what: &str) -> PyResult<Bound<'py, PyUntypedArray>> {
    if are_floats(&array) {
        return Ok(array);
    }
    require::<f64>(array.len(), what)?;
    Ok(array.call_method1("astype", ("=f8",))?.cast_into()?)
}

/// Refuses so many numbers where the machine has no memory for them, before it is taken.
fn require<T>(numbers: usize, what: &str) -> PyResult<()> {
    memory::require(what, numbers.saturating_mul(size_of::<T>()) as u64).map_err(raised)
}

/// How many rows of points there may be.
#[derive(Clone, Copy)]
pub enum Most<'a> {
    /// As many as a mesh may have.
    OfAnyMesh,
    /// As many as that body has.
    Of { body: &'a str, vertices: usize },
}

impl Most<'_> {
    /// Refuses more, before they are copied.
    fn check(self, rows: usize, what: &str) -> PyResult<()> {
        match self {
            Most::OfAnyMesh => few("vertices", rows, MAX_VERTICES, what),
            Most::Of { vertices, .. } if rows <= vertices => Ok(()),
            Most::Of { body, vertices } => {
                let problem = Problem::FrameVertices { first: body.into(), t0: vertices, t1: rows };
                Err(raised(Error::Input { file: body.into(), problem }))
            }
        }
    }
}

/// Refuses more of them than a mesh may have.
fn few(of: &'static str, rows: usize, most: usize, what: &str) -> PyResult<()> {
    if rows <= most {
        return Ok(());
    }
    let problem = Problem::TooMany { what: of, count: rows as u64, limit: most as u64 };
    Err(raised(Error::Input { file: what.into(), problem }))
}

/// Points, three numbers each, copied.
pub fn positions(object: &Bound<'_, PyAny>, what: &str, most: Most<'_>) -> PyResult<Positions> {
    let array = asarray(object)?;
    are_numbers(&array, what)?;
    most.check(of_three(&array, what)?, what)?;
    let array = floats(array, what)?;
    if let Ok(points) = array.cast::<PyArray2<f32>>() {
        return Ok(Positions::F32(triples(&points.readonly(), what)?));
    }
    Ok(Positions::F64(triples(&array.cast::<PyArray2<f64>>()?.readonly(), what)?))
}

/// Triangles of a mesh of so many vertices, three vertex indices each, copied.
pub fn faces(object: &Bound<'_, PyAny>, name: &str, vertices: usize) -> PyResult<Vec<[u32; 3]>> {
    let array = asarray(object)?;
    let (kind, shape) = (array.dtype().kind(), array.shape().to_vec());
    let empty = shape.contains(&0);
    if empty && (shape.len() == 1 || shape.get(1) == Some(&3)) {
        return Ok(Vec::new());
    }
    if !matches!(kind, b'i' | b'u') {
        return Err(choice(
            format!("faces of {name} of type {}", array.dtype().str()?),
            "give integers: three vertex indices a triangle",
        ));
    }
    let what = format!("faces of {name}");
    few("triangles", of_three(&array, &what)?, MAX_FACES, &what)?;
    if let Ok(faces) = array.cast::<PyArray2<u32>>() {
        return triples(&faces.readonly(), &what);
    }
    require::<i64>(array.len(), &what)?;
    let wide = array.call_method1("astype", ("=i8",))?;
    let wide = triples(&wide.cast::<PyArray2<i64>>()?.readonly(), &what)?;
    let mut faces = room(wide.len(), &what)?;
    for (face, corners) in wide.iter().enumerate() {
        let mut own = [0; 3];
        for (corner, (to, &from)) in own.iter_mut().zip(corners).enumerate() {
            *to = u32::try_from(from).map_err(|_| {
                let problem = Problem::IndexOutOfRange { face, corner, index: from, vertices };
                raised(Error::Input { file: name.into(), problem })
            })?;
        }
        faces.push(own);
    }
    Ok(faces)
}

/// Rows of `N` indices that choose something, copied; of one index a plain list.
pub fn indices<const N: usize>(object: &Bound<'_, PyAny>, what: &str) -> PyResult<Vec<[u32; N]>> {
    let wrong = |_, index| choice(format!("{what} have index {index}"), "indices are from 0 to 4294967295");
    indices_or(object, what, wrong)
}

/// Rows of `N` vertices of a mesh, copied; of one vertex a plain list.
pub fn vertices_of<const N: usize>(object: &Bound<'_, PyAny>, what: &str) -> PyResult<Vec<[u32; N]>> {
    indices_or(object, what, |row, index| {
        let problem = Problem::Scene {
            what: format!("row {row} has index {index}"),
            advice: "give indices from 0 to 4294967295".into(),
        };
        raised(Error::Input { file: what.into(), problem })
    })
}

/// Rows of indices; `wrong` makes an error of a row and an index that is none.
fn indices_or<const N: usize>(
    object: &Bound<'_, PyAny>,
    what: &str,
    wrong: impl Fn(usize, i64) -> PyErr,
) -> PyResult<Vec<[u32; N]>> {
    let array = asarray(object)?;
    let shape = array.shape().to_vec();
    let advice = if N == 1 { "give a list of indices" } else { "give pairs of indices: shape (n, 2)" };
    if shape.contains(&0) {
        return Ok(Vec::new());
    }
    if !matches!(array.dtype().kind(), b'i' | b'u') {
        return Err(choice(format!("{what} of type {}", array.dtype().str()?), advice));
    }
    if !(N == 1 && shape.len() == 1 || shape.len() == 2 && shape[1] == N) {
        return Err(choice(format!("{what} of shape {shape:?}"), advice));
    }
    let wide = array.call_method1("astype", ("=i8",))?.call_method1("reshape", (-1, N))?;
    let wide = wide.cast::<numpy::PyArray2<i64>>()?.readonly();
    let mut rows = Vec::with_capacity(shape[0]);
    for (at, row) in wide.as_array().rows().into_iter().enumerate() {
        let mut own = [0; N];
        for (to, &from) in own.iter_mut().zip(row) {
            *to = u32::try_from(from).map_err(|_| wrong(at, from))?;
        }
        rows.push(own);
    }
    Ok(rows)
}

/// Rows of `N` numbers in double precision, copied.
pub fn doubles<const N: usize>(object: &Bound<'_, PyAny>, what: &str) -> PyResult<Vec<[f64; N]>> {
    let array = asarray(object)?;
    are_numbers(&array, what)?;
    let shape = array.shape();
    if shape.len() != 2 || shape[1] != N {
        return Err(choice(
            format!("{what} of shape {shape:?}"),
            format!("give rows of {N}: shape (n, {N})"),
        ));
    }
    require::<[f64; N]>(2 * shape[0], what)?;
    let wide = array.call_method1("astype", ("=f8",))?.cast_into::<PyArray2<f64>>()?.readonly();
    let row = |row: numpy::ndarray::ArrayView1<'_, f64>| std::array::from_fn(|k| row[k]);
    Ok(wide.as_array().rows().into_iter().map(row).collect())
}

/// A row of numbers in double precision.
pub fn row<const N: usize>(object: &Bound<'_, PyAny>, what: &str) -> PyResult<[f64; N]> {
    let array = asarray(object)?;
    are_numbers(&array, what)?;
    let given = match array.shape() {
        [count] if *count == N => {
            return floats(array, what)?.call_method1("astype", ("=f8",))?.call_method0("tolist")?.extract();
        }
        [count] => format!("{what} of {count} numbers"),
        shape => format!("{what} of shape {shape:?}"),
    };
    Err(choice(given, format!("give {N} numbers in a row")))
}

/// How many rows of three there are; refuses what are none.
fn of_three(array: &Bound<'_, PyUntypedArray>, what: &str) -> PyResult<usize> {
    let advice = match array.shape() {
        [rows, 3] => return Ok(*rows),
        [_, _, 3] => "give rows of three: shape (n, 3); both ends of a step are a tuple of two such arrays",
        _ => "give rows of three: shape (n, 3)",
    };
    Err(choice(format!("{what} of shape {:?}", array.shape()), advice))
}

/// An empty list with room for so many rows, or a sentence where the machine has none.
fn room<T>(rows: usize, what: &str) -> PyResult<Vec<[T; 3]>> {
    require::<[T; 3]>(rows, what)?;
    let mut list = Vec::new();
    if list.try_reserve_exact(rows).is_err() {
        let (asked, given) = ((rows * size_of::<[T; 3]>()) as u64, memory::free().unwrap_or(0));
        return Err(raised(Error::OutOfMemory { what: what.into(), asked, given }));
    }
    Ok(list)
}

fn triples<T: Element + Copy>(array: &PyReadonlyArray2<'_, T>, what: &str) -> PyResult<Vec<[T; 3]>> {
    let array = array.as_array();
    let mut list = room(array.nrows(), what)?;
    list.extend(array.rows().into_iter().map(|row| [row[0], row[1], row[2]]));
    Ok(list)
}
