//! The Python module `nearmiss._native`. `lib/nearmiss/__init__.py` makes its names those of `nearmiss`; `lib/nearmiss/_native.pyi`
//! has their types and docstrings.
//!
//! A class is a file, and wraps the library's type of that name. Arrays of the host are numpy's. Arrays of a GPU come and go by DLPack
//! or `__cuda_array_interface__`; nothing here links to the libraries that made them. The interpreter runs on during a call.

mod answer;
mod asked;
mod body_rows;
mod borrowed;
mod columns;
mod detector;
mod device;
mod dlpack;
mod errors;
mod exclusions;
mod filter;
mod frame;
mod geometry;
mod grouped;
mod host;
mod inline;
mod key;
mod matrix;
mod on_device;
mod opened;
mod pairs;
mod pose;
mod pose_step;
mod poses;
mod query;
mod questions;
mod research;
mod rows;
mod scene;
mod several;
mod submissions;
mod thickness;
mod turns;
mod watch;
mod worker;

/// The compiled half of `nearmiss`.
#[pyo3::pymodule]
mod _native {
    use pyo3::prelude::*;

    #[pymodule_export]
    use super::answer::Answer;
    #[pymodule_export]
    use super::body_rows::{NearestBodies, TouchingBodies};
    #[pymodule_export]
    use super::borrowed::is_on_gpu;
    #[pymodule_export]
    use super::detector::Detector;
    #[pymodule_export]
    use super::device::Device;
    #[pymodule_export]
    use super::geometry::Geometry;
    #[pymodule_export]
    use super::host::read_mesh;
    #[pymodule_export]
    use super::on_device::{DeviceAnswer, DeviceArray};
    #[pymodule_export]
    use super::pairs::{Curves, PairGeometry};
    #[pymodule_export]
    use super::pose::Pose;
    #[pymodule_export]
    use super::pose_step::PoseStep;
    #[pymodule_export]
    use super::query::{BodyDistances, BodyPairs, Continuous, Discrete, Distance, Earliest, Near, Query};
    #[pymodule_export]
    use super::research::configure;
    #[pymodule_export]
    use super::rows::{Contacts, FirstContact, NearPairs, NearestTriangles, TrianglePairs};
    #[pymodule_export]
    use super::scene::{Body, Scene};
    #[pymodule_export]
    use super::several::MultiDetector;

    #[pymodule_init]
    fn version(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
