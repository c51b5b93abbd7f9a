//! From bodies to contacts: the way of a frame.

pub mod below_precision;
pub mod enclose;
mod forest;
mod launch;
mod layout;
pub mod list;
pub mod narrow;
mod order;
mod placing;
pub mod precision;
mod prefix;
pub(crate) mod purpose;
mod sorter;
mod timing;
mod tolerance;
mod tree;
mod treelets;
mod typed;
pub mod volumes;
mod walk;

pub use layout::{Layout, Offsets};
pub use placing::Moved;
pub use timing::{Stage, Stages};
pub use tolerance::{mean_side, of_edges};
pub use typed::{Found, Hits, Pipeline};

use crate::device::Device;
use crate::error::Error;
use crate::mesh::Body;
use crate::query::{Bv, Query};
use nearmiss_kernels::bv::{Aabb, Axes, Linear, Obb};
use std::sync::Arc;
use typed::TypedPipeline;
use volumes::Kernels;

/// The pipeline of a query; `f64s` tells whether any position needs f64.
///
/// # Errors
/// Those of the device.
pub fn pipeline(
    device: Device,
    bodies: &[Body],
    layout: Arc<Layout>,
    query: Query,
    f64s: bool,
) -> Result<Box<dyn Pipeline>, Error> {
    match query.bv() {
        Bv::Aabb => typed::<Aabb>(device, bodies, layout, (query, Axes::PCA), f64s),
        Bv::Linear => typed::<Linear>(device, bodies, layout, (query, Axes::PCA), f64s),
        Bv::Obb => typed::<Obb>(device, bodies, layout, (query, Axes::PCA), f64s),
        Bv::ObbChild => typed::<Obb>(device, bodies, layout, (query, Axes::CHILD), f64s),
    }
}

/// The pipeline of a volume.
fn typed<V: Kernels>(
    device: Device,
    bodies: &[Body],
    layout: Arc<Layout>,
    (query, axes): (Query, Axes),
    f64s: bool,
) -> Result<Box<dyn Pipeline>, Error> {
    Ok(if f64s {
        Box::new(TypedPipeline::<f64, V>::new(device, bodies, layout, (query, axes))?)
    } else {
        Box::new(TypedPipeline::<f32, V>::new(device, bodies, layout, (query, axes))?)
    })
}
