//! Contexts, streams and arrays of [cudarc] and cust for [nearmiss], without `unsafe`.
//!
//! [nearmiss]: https://docs.rs/nearmiss
//! [cudarc]: https://docs.rs/cudarc
//!
//! | feature | library | device | array |
//! | --- | --- | --- | --- |
//! | `cudarc` | cudarc 0.19 | `cudarc::device(&stream)` | `CudaSlice`, `CudaView` |
//! | `cust` | cust 0.3 | `cust::device(context, &stream)` | `DeviceBuffer` |
//!
//! - A `device` uses the library's context and stream, and keeps both. Its work runs on that stream,
//!   after all earlier work there.
//! - [`update`] moves bodies to positions in arrays. It borrows the arrays, and returns when they
//!   have been read.
//! - [`Submissions`] owns a detector and arrays. It submits frames, for which the host does not
//!   wait. Kernels write into the arrays in between.
//!
//! Arrays have elements of an [`Element`] type. Lengths, GPUs and contexts are checked; a wrong one
//! is one [`Error`].
//!
//! No safe call frees an array while nearmiss may read it, also if a value is leaked by
//! [`std::mem::forget`].
#![cfg_attr(
    feature = "cudarc",
    doc = r#"
This program moves a cloth on the GPU:

```no_run
use cudarc::driver::CudaContext;
use nearmiss::{Body, Detector, Discrete, Mesh, mesh::Positions};
use nearmiss_interop::{Input, cudarc::device, update};

let stream = CudaContext::new(0)?.new_stream()?;
let corners = vec![[0.0f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
let mut array = stream.clone_htod(&corners)?;              // your kernels write it
let cloth = Body::deformable(Mesh::new("cloth", Positions::F32(corners), vec![[0, 1, 2]])?);
let mut detector = Detector::new(device(&stream)?, cloth)?;
let cloth = detector.scene().ids().next().expect("a body");
update(&mut detector, &[(cloth, Input::positions(&array))])?;
println!("{} pairs cross", detector.query(&Discrete::default())?.len());
# Ok::<(), Box<dyn std::error::Error>>(())
```

An array that was freed cannot be passed:

```compile_fail,E0382
# use cudarc::driver::CudaSlice;
# use nearmiss::{Detector, Error, scene::BodyId};
# use nearmiss_interop::{Input, update};
fn freed(detector: &mut Detector, cloth: BodyId, array: CudaSlice<f32>) -> Result<(), Error> {
    drop(array);
    update(detector, &[(cloth, Input::positions(&array))])
}
```

An array cannot be freed while an input borrows it:

```compile_fail,E0505
# use cudarc::driver::CudaSlice;
# use nearmiss::{Detector, Error, scene::BodyId};
# use nearmiss_interop::{Input, update};
fn freed(detector: &mut Detector, cloth: BodyId, array: CudaSlice<f32>) -> Result<(), Error> {
    let inputs = [(cloth, Input::positions(&array))];
    drop(array);
    update(detector, &inputs)
}
```

Without the second line both compile:

```
# use cudarc::driver::CudaSlice;
# use nearmiss::{Detector, Error, scene::BodyId};
# use nearmiss_interop::{Input, update};
fn alive(detector: &mut Detector, cloth: BodyId, array: CudaSlice<f32>) -> Result<(), Error> {
    let inputs = [(cloth, Input::positions(&array))];
    update(detector, &inputs)
}
```

Integers are no positions:

```compile_fail,E0277
# use cudarc::driver::CudaSlice;
# use nearmiss::{Detector, Error, scene::BodyId};
# use nearmiss_interop::{Input, update};
fn integers(detector: &mut Detector, cloth: BodyId, array: CudaSlice<i32>) -> Result<(), Error> {
    update(detector, &[(cloth, Input::positions(&array))])
}
```
"#
)]

mod array;
#[cfg(feature = "cudarc")]
pub mod cudarc;
#[cfg(feature = "cust")]
pub mod cust;
mod element;
mod input;
mod submissions;
#[cfg(test)]
mod tests;

pub use array::{DeviceArray, OwnedArray};
pub use element::Element;
pub use input::{Input, Place, update};
pub use nearmiss::Error;
pub use submissions::{Places, Submissions};
