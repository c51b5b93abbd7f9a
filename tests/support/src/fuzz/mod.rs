//! Inputs of the fuzz targets, and the judges of the answers: shared with
//! tests/frames/fuzz_pairs.rs, which runs on stable.
//!
//! Each target is a function from bytes to `Ok`, or to the fault of the answer. A `lie` changes an
//! answer before the judge: it shows that the judge finds the fault.

pub mod bytes;
pub mod continuous;
pub mod device_arrays;
pub mod discrete;
pub mod distance;
pub mod near;
pub mod scene;

/// Whether to plant a fault. A run that finds none then has a judge that finds none.
pub fn planted() -> bool {
    static PLANTED: std::sync::OnceLock<bool> = std::sync::OnceLock::new();
    *PLANTED.get_or_init(|| std::env::var_os("NEARMISS_PLANT_A_FAULT").is_some())
}
