//! Answers in the memory of the device.

use crate::detector::Detector;
use crate::dlpack::{CPU, CUDA, Dtype, FLOAT, INT, Place, Shape, UINT, capsule};
use crate::errors::{choice, raised};
use crate::host::rows;
use crate::several::MultiDetector;
use crate::watch::Watch;
use nearmiss::contacts::{self, Entries};
use nearmiss::{Device, Error};
use numpy::PyArray2;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyTuple};

/// The detector that has an answer.
pub enum Owner {
    One(Py<Detector>),
    Several(Py<MultiDetector>),
}

impl Owner {
    /// Does something with the answer that was on the device after so many calls, if it still is there.
    fn with_answer<T: Send>(
        &self,
        py: Python<'_>,
        asked: u64,
        with: impl FnOnce() -> T + Send,
    ) -> PyResult<T> {
        let done = match self {
            Owner::One(own) => own.get().look_at(py, |one| one.has_answer(asked).then(with)),
            Owner::Several(own) => own.get().look_at(py, |one| one.has_answer(asked).then(with)),
        };
        done?.ok_or_else(|| {
            choice(
                "the answer on the device is gone: another call has used the detector, or a list grew",
                "call on_device after prepare, and again whenever is_prepared was False",
            )
        })
    }

    /// Does something with the devices, in turn with all that share them.
    fn in_turn<T>(&self, py: Python<'_>, work: impl FnOnce() -> Result<T, Error> + Send) -> PyResult<T>
    where
        T: Send,
    {
        let watch = Watch::new(false);
        let done = py.detach(|| match self {
            Owner::One(own) => {
                let _turn = watch.lock(&own.get().device.get().turn)?;
                work()
            }
            Owner::Several(own) => {
                let _turns = own.get().turns(&watch)?;
                work()
            }
        });
        done.map_err(raised)
    }

    fn clone_ref(&self, py: Python<'_>) -> Owner {
        match self {
            Owner::One(own) => Owner::One(own.clone_ref(py)),
            Owner::Several(own) => Owner::Several(own.clone_ref(py)),
        }
    }

    fn into_any(self) -> Py<PyAny> {
        match self {
            Owner::One(own) => own.into_any(),
            Owner::Several(own) => own.into_any(),
        }
    }
}

/// Array in the memory of the device.
///
/// On a GPU, torch.from_dlpack and cupy.from_dlpack show this memory without a copy. Read it behind
/// `submit`, on the device's stream. On a CPU, numpy.from_dlpack takes a copy. The array ends with
/// the next call that changes the detector: then taking it raises InvalidArgumentError.
#[pyclass(module = "nearmiss", frozen)]
pub struct DeviceArray {
    shape: Shape,
    device: Device,
    /// The detector that owns the memory, and its count of answers when the array was made.
    owner: Owner,
    asked: u64,
}

impl DeviceArray {
    /// Number of bytes from the first number to the last.
    fn bytes(&self) -> usize {
        let Shape { dtype, shape, strides, .. } = &self.shape;
        let last: i64 = shape.iter().zip(strides).map(|(n, stride)| (n - 1) * stride).sum();
        if shape.contains(&0) { 0 } else { (last as usize + 1) * usize::from(dtype.bits / 8) }
    }

    /// A copy of an array of the host in Python's memory: the original may be freed while the copy is
    /// held.
    fn copied<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let (address, bytes) = (self.shape.address, self.bytes());
        let copy = move || {
            // An empty array may have no address.
            if bytes == 0 {
                return Vec::new();
            }
            // SAFETY: the answer is there, and it moves only under the lock, which is held.
            unsafe { std::slice::from_raw_parts(address as *const u8, bytes) }.to_vec()
        };
        let copy = self.owner.with_answer(py, self.asked, copy)?;
        Ok(PyBytes::new(py, &copy))
    }
}

#[pymethods]
impl DeviceArray {
    /// Capsule of DLPack: this memory on a GPU, a copy on a CPU.
    #[pyo3(signature = (*, stream = None, max_version = None, dl_device = None, copy = None))]
    fn __dlpack__<'py>(
        &self,
        py: Python<'py>,
        stream: Option<i64>,
        max_version: Option<Bound<'_, PyAny>>,
        dl_device: Option<(i32, i32)>,
        copy: Option<bool>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let _ = max_version;
        let here = self.__dlpack_device__();
        if copy == Some(true) || dl_device.is_some_and(|there| there != here) {
            return Err(pyo3::exceptions::PyBufferError::new_err(
                "a copy, or another device; take it without one and copy it",
            ));
        }
        let Some(ours) = self.device.stream() else {
            let copy = self.copied(py)?;
            let shape = Shape { address: copy.as_bytes().as_ptr() as u64, ..self.shape.clone() };
            return capsule(py, &shape, copy.into_any().unbind());
        };
        self.owner.with_answer(py, self.asked, || ())?;
        // -1: no order is needed.
        if stream != Some(ours.max(1) as i64) && stream != Some(-1) {
            let wait = || self.device.event()?.to(&self.device.event()?);
            self.owner.in_turn(py, wait)?;
        }
        capsule(py, &self.shape, self.owner.clone_ref(py).into_any())
    }

    /// Kind and number of the device, as DLPack counts them.
    fn __dlpack_device__(&self) -> (i32, i32) {
        (self.shape.place.kind, self.shape.place.ordinal)
    }

    /// Description for libraries without DLPack: version 3 of the protocol, on a GPU alone.
    #[getter]
    fn __cuda_array_interface__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let Some(stream) = self.device.stream() else {
            return Err(pyo3::exceptions::PyAttributeError::new_err("the array is on the CPU; use DLPack"));
        };
        self.owner.with_answer(py, self.asked, || ())?;
        let Dtype { code, bits, .. } = self.shape.dtype;
        let size = i64::from(bits / 8);
        let letter = match code {
            FLOAT => 'f',
            INT => 'i',
            _ => 'u',
        };
        let told = PyDict::new(py);
        told.set_item("version", 3)?;
        // A write changes this answer and no other. Torch refuses read-only arrays.
        told.set_item("data", (self.shape.address, false))?;
        told.set_item("shape", PyTuple::new(py, &self.shape.shape)?)?;
        told.set_item("strides", PyTuple::new(py, self.shape.strides.iter().map(|stride| stride * size))?)?;
        told.set_item("typestr", format!("<{letter}{size}"))?;
        told.set_item("stream", stream.max(1))?;
        Ok(told)
    }

    /// Dimensions of the array.
    #[getter]
    fn shape<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        PyTuple::new(py, &self.shape.shape)
    }

    fn __repr__(&self) -> String {
        format!("<nearmiss.DeviceArray of shape {:?}>", self.shape.shape)
    }
}

/// Answer of a submitted query in the memory of the device.
///
/// Vertices, triangles and edges are numbered through all bodies: see `starts`.
#[pyclass(module = "nearmiss", frozen)]
pub struct DeviceAnswer {
    pub answer: contacts::DeviceAnswer,
    pub device: Device,
    pub owner: Owner,
    pub asked: u64,
}

/// One column of an entry: its name, where it begins, its numbers and how many of them.
type Column = (&'static str, u64, Dtype, &'static [i64]);

const INDEX: Dtype = Dtype { code: INT, bits: 32, lanes: 1 };
const COUNT: Dtype = Dtype { code: INT, bits: 64, lanes: 1 };
const STATE: Dtype = Dtype { code: UINT, bits: 32, lanes: 1 };
const REAL: Dtype = Dtype { code: FLOAT, bits: 64, lanes: 1 };

/// Columns of bodies that share a point.
const BODY_PAIRS: &[Column] = &[("bodies", 0, INDEX, &[2])];
const TRIANGLE_PAIRS: &[Column] = &[("triangles", 0, INDEX, &[2])];

const CONTACTS: &[Column] = &[
    ("feature_a", 0, INDEX, &[]),
    ("feature_b", 4, INDEX, &[]),
    ("toi", 8, REAL, &[]),
    ("toi_upper", 16, REAL, &[]),
    ("state", 24, STATE, &[]),
];

const NEAR_PAIRS: &[Column] = &[
    ("feature_a", 0, INDEX, &[]),
    ("feature_b", 4, INDEX, &[]),
    ("squared_distances", 8, REAL, &[]),
    ("at", 16, REAL, &[2]),
];

const NEAREST_TRIANGLES: &[Column] = &[
    ("triangles", 0, INDEX, &[2]),
    ("distances", 8, REAL, &[]),
    ("at", 16, REAL, &[2, 2]),
    ("points", 48, REAL, &[2, 3]),
];

/// Columns of `nearmiss::contacts::on_device::RowGeometry`, of 128 bytes.
const GEOMETRY: &[Column] = &[
    ("distances", 0, REAL, &[]),
    ("normals", 8, REAL, &[3]),
    ("signed_weights", 32, REAL, &[4]),
    ("points", 64, REAL, &[2, 3]),
    ("vertices", 112, INDEX, &[4]),
];

/// Bytes of an entry, and its columns: of `nearmiss::contacts::{Pair, Hit, NearHit, NearestHit}`.
fn columns(entries: Entries) -> (u64, &'static [Column]) {
    match entries {
        Entries::TrianglePairs => (8, TRIANGLE_PAIRS),
        Entries::Contacts => (32, CONTACTS),
        Entries::NearPairs => (32, NEAR_PAIRS),
        Entries::BodyPairs => (8, BODY_PAIRS),
        _ => (96, NEAREST_TRIANGLES),
    }
}

impl DeviceAnswer {
    fn array(
        &self,
        py: Python<'_>,
        address: u64,
        dtype: Dtype,
        (shape, strides): (Vec<i64>, Vec<i64>),
    ) -> DeviceArray {
        let place = match self.device.ordinal() {
            Some(ordinal) => Place { kind: CUDA, ordinal: ordinal as i32 },
            None => Place { kind: CPU, ordinal: 0 },
        };
        let shape = Shape { address, place, dtype, shape, strides };
        DeviceArray { shape, device: self.device.clone(), owner: self.owner.clone_ref(py), asked: self.asked }
    }

    /// A list of numbers.
    fn packed(&self, py: Python<'_>, list: contacts::DeviceList, dtype: Dtype) -> DeviceArray {
        self.array(py, list.address, dtype, (vec![list.room as i64], vec![1]))
    }

    /// The columns of a list of entries of so many bytes.
    fn columns<'py>(
        &self,
        py: Python<'py>,
        list: &contacts::DeviceList,
        bytes: u64,
        columns: &[Column],
    ) -> PyResult<Bound<'py, PyDict>> {
        let named = PyDict::new(py);
        for &(name, begin, dtype, inner) in columns {
            let size = u64::from(dtype.bits / 8);
            let shape = [&[list.room as i64], inner].concat();
            let strides = [&[(bytes / size) as i64], &crate::dlpack::packed(inner)[..]].concat();
            named.set_item(name, self.array(py, list.address + begin, dtype, (shape, strides)))?;
        }
        Ok(named)
    }
}

#[pymethods]
impl DeviceAnswer {
    /// Kind of rows: "triangle pairs", "contacts", "near pairs", "nearest triangles" or "body pairs".
    #[getter]
    fn entries(&self) -> &'static str {
        match self.answer.entries {
            Entries::TrianglePairs => "triangle pairs",
            Entries::Contacts => "contacts",
            Entries::NearPairs => "near pairs",
            Entries::BodyPairs => "body pairs",
            _ => "nearest triangles",
        }
    }

    /// Lists of rows, each a dictionary of columns with room for more rows than there are.
    ///
    /// `status` counts the rows in use.
    ///
    /// - Triangle pairs: triangles (room, 2) int32.
    /// - Contacts: feature_a, feature_b (room,) int32, toi, toi_upper (room,) float64, state (room,)
    ///   uint32: 1 contact, 2 undecided, 4 added if the iterations ended. An Earliest query has those
    ///   at its time, in no order, if `prepare` was called with `first_contacts=True`; else none.
    /// - Near pairs: feature_a, feature_b, squared_distances (room,) float64, at (room, 2) float64:
    ///   the weights of the face's corners 1 and 2, or the place on each edge.
    /// - Nearest triangles: triangles, distances, at (room, 2, 2), points (room, 2, 3). One row, or a
    ///   row for each pair of bodies in no order.
    /// - Body pairs: bodies (room, 2) int32, in no order.
    #[getter]
    fn lists<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        let (bytes, columns) = columns(self.answer.entries);
        self.answer.lists.iter().map(|list| self.columns(py, list, bytes, columns)).collect()
    }

    /// Geometry of rows, if `prepare` was called with `geometry=True`; else None.
    ///
    /// A dictionary of columns, as of `Detector.geometry`: vertices (room, 4) int32 through all bodies,
    /// signed_weights (room, 4), points (room, 2, 3), normals (room, 3), distances (room,) float64.
    /// Rows are numbered through both lists. Unused rows are zeros, so they weigh nothing.
    #[getter]
    fn geometry<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyDict>>> {
        self.answer.geometry.map(|list| self.columns(py, &list, 128, GEOMETRY)).transpose()
    }

    /// (vertices,) float64: least time or distance of each vertex, infinite without a row.
    ///
    /// None unless `prepare` was called with `least_by_vertex=True`.
    #[getter]
    fn least_by_vertex(&self, py: Python<'_>) -> Option<DeviceArray> {
        self.answer.least_by_vertex.map(|list| self.packed(py, list, REAL))
    }

    /// Rows by feature, for each name in `grouped` of `prepare`: (starts, rows), int32.
    ///
    /// Rows of feature i are rows[starts[i]:starts[i + 1]], ascending; an unused place is -1. Rows are
    /// numbered through both lists, features through all bodies.
    #[getter]
    fn grouped<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let named = PyDict::new(py);
        for groups in &self.answer.grouped {
            let arrays = [groups.starts, groups.rows].map(|list| self.packed(py, list, INDEX));
            named.set_item(groups.by.name(), PyTuple::new(py, arrays)?)?;
        }
        Ok(named)
    }

    /// (5,) int64: counts of the submission, and whether its answer is whole.
    ///
    /// - 0: rows of the first list, or the vertex/face rows of an ordered one.
    /// - 1: rows of the second list, or the edge/edge rows of an ordered one.
    /// - 2: number of lists that were too short. Unless it is 0, rows are missing: use `collect`.
    /// - 3: 0, or the vertex with a coordinate that cannot be used.
    /// - 4: triangle pairs that cross at the start of the step; -1 if they are not counted.
    #[getter]
    fn status(&self, py: Python<'_>) -> DeviceArray {
        self.array(py, self.answer.status, COUNT, (vec![5], vec![1]))
    }

    /// (1,) float64: time of an Earliest query, NaN if nothing meets; None for other queries.
    #[getter]
    fn earliest(&self, py: Python<'_>) -> Option<DeviceArray> {
        self.answer.earliest.map(|address| self.array(py, address, REAL, (vec![1], vec![1])))
    }

    /// (edges, 2) int32: the vertices of each edge; no rows for Discrete and Distance.
    #[getter]
    fn edges(&self, py: Python<'_>) -> DeviceArray {
        let edges = self.answer.edges;
        self.array(py, edges.address, INDEX, (vec![edges.room as i64, 2], vec![2, 1]))
    }

    /// (bodies + 1, 3) uint32: first vertex, triangle and edge of each body, and their numbers at the end.
    #[getter]
    fn starts<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<u32>> {
        rows(py, &self.answer.starts)
    }

    /// Whether rows are in canonical order, vertex/face and edge/edge rows in one list.
    #[getter]
    fn is_ordered(&self) -> bool {
        self.answer.is_ordered
    }
}
