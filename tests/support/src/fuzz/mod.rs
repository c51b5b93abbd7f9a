//! What the fuzz targets ask, and the judges of what is answered: shared with tests/frames/fuzz_pairs.rs, which runs on stable.
//!
//! Each question is a function from bytes to `Ok`, or to what is wrong with the answer. A `lie` changes an answer before it
//! is judged: to show that the judge notices.

pub mod bytes;
pub mod continuous;
pub mod discrete;
pub mod distance;
pub mod lent;
pub mod near;
pub mod scene;

/// Whether a fault is to be planted: a run that finds nothing then is a run that could not.
pub fn planted() -> bool {
    static PLANTED: std::sync::OnceLock<bool> = std::sync::OnceLock::new();
    *PLANTED.get_or_init(|| std::env::var_os("NEARMISS_PLANT_A_FAULT").is_some())
}
