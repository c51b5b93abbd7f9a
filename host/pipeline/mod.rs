//! From bodies to contacts: the way of a frame.

pub mod below_precision;
mod broad;
pub mod counts;
mod demand;
pub mod enclose;
mod hubs;
mod launch;
mod layout;
pub mod list;
pub mod narrow;
mod order;
mod placing;
pub mod precision;
pub(crate) mod purpose;
mod sorter;
mod timing;
mod tolerance;
mod typed;

pub use broad::Share;
pub use layout::{Layout, Offsets};
pub use placing::{Moved, Seen, Whereabouts};
pub use timing::{Stage, Stages};
pub use tolerance::{Tolerances, mean_side, of_edges, of_pair};
pub use typed::{Found, Hits, Listed, Pipeline, Submits};

use crate::device::Device;
use crate::error::Error;
use crate::mesh::Body;
use crate::query::Query;
use std::sync::Arc;
use typed::TypedPipeline;

/// The pipeline of a query, or of a share of its work; `f64s` tells whether any position needs f64.
///
/// # Errors
/// Those of the device.
pub fn pipeline(
    device: Device,
    bodies: &[Body],
    layout: Arc<Layout>,
    query: Query,
    (f64s, share): (bool, Share),
) -> Result<Box<dyn Pipeline>, Error> {
    Ok(if f64s {
        Box::new(TypedPipeline::<f64>::new(device, bodies, layout, (query, share))?)
    } else {
        Box::new(TypedPipeline::<f32>::new(device, bodies, layout, (query, share))?)
    })
}
