//! Positions, back from the device.

use crate::detector::NearmissDetector;
use crate::error::{NearmissCode, NearmissError, refused};
use nearmiss::scene::BodyKind;
use std::mem::MaybeUninit;

/// Positions of a body at the start and at the end of the step, as three doubles a vertex. `start`
/// and `end` have room for `vertex_count` vertices, as many as the body has. Either may be NULL.
/// Both ends are equal for a body at rest. Vertices of a rigid body are in its poses. Cost: if a
/// body was moved from memory of the device, a copy of all vertices, and a wait.
///
/// # Safety
/// A pointer that is not NULL has room for three doubles a vertex.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nearmiss_detector_download_positions(
    detector: Option<&mut NearmissDetector>,
    body: u32,
    start: *mut f64,
    end: *mut f64,
    vertex_count: usize,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    NearmissDetector::work(detector, error, |own| {
        let there = own.downloaded(body)?;
        if there.vertex_count() != vertex_count {
            let what = format!("vertex_count of body {body} is wrong, got {vertex_count}");
            return Err(refused(what, format!("pass {}, and arrays with that room", there.vertex_count())));
        }
        let is_rigid = there.kind() == BodyKind::Rigid;
        for ((to, positions), pose) in [start, end].into_iter().zip(there.ends()).zip(there.poses()) {
            if to.is_null() {
                continue;
            }
            if !to.is_aligned() {
                let what = format!("array for body {body} is not aligned to {} bytes", align_of::<f64>());
                return Err(refused(what, "pass a pointer to doubles"));
            }
            for vertex in 0..vertex_count {
                let point = positions.get_f64(vertex).unwrap_or([f64::NAN; 3]);
                let point = if is_rigid { pose.apply(point) } else { point };
                // SAFETY: the caller's promise; aligned, and an array has the alignment of its elements.
                unsafe { to.cast::<[f64; 3]>().add(vertex).write(point) };
            }
        }
        Ok(())
    })
}
