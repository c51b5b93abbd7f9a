//! From bodies to contacts: the way of a frame.

pub mod below_precision;
pub mod counts;
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
pub use placing::{Moved, Seen, Whereabouts};
pub use timing::{Stage, Stages};
pub use tolerance::{mean_side, of_edges};
pub use typed::{Found, Hits, Listed, Pipeline, Submits};

use crate::device::Device;
use crate::error::Error;
use crate::mesh::Body;
use crate::query::{Query, WithVolume};
use nearmiss_kernels::bv::Axes;
use nearmiss_kernels::entry::Kernels;
use std::sync::Arc;
use typed::TypedPipeline;

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
    let bv = query.bv();
    bv.with(New { device, bodies, layout, query, f64s })
}

/// What a pipeline is made of.
struct New<'a> {
    device: Device,
    bodies: &'a [Body],
    layout: Arc<Layout>,
    query: Query,
    f64s: bool,
}

impl WithVolume for New<'_> {
    type Out = Result<Box<dyn Pipeline>, Error>;

    fn with<V: Kernels>(self, axes: Axes) -> Self::Out {
        let New { device, bodies, layout, query, f64s } = self;
        Ok(if f64s {
            Box::new(TypedPipeline::<f64, V>::new(device, bodies, layout, (query, axes))?)
        } else {
            Box::new(TypedPipeline::<f32, V>::new(device, bodies, layout, (query, axes))?)
        })
    }
}
