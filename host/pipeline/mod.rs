//! From bodies to contacts: the way of a frame.

pub mod below_precision;
mod broad;
pub(crate) mod collect;
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
mod tolerance;
mod typed;

pub use broad::Share;
pub use layout::{Layout, Offsets};
pub use placing::{Moved, Seen, Whereabouts};
pub use tolerance::{Tolerances, of_pair};
pub use typed::{Found, Hits, Listed, Pipeline, Submits};

#[doc(hidden)]
pub use crate::scene::{mean_side, of_edges};
pub use crate::stages::{Stage, Stages};

use crate::device::Device;
use crate::error::Error;
use crate::query::Query;
use crate::scene::Body;
use std::sync::Arc;
use typed::TypedPipeline;

/// The scene, query and share that a pipeline is made for.
pub struct Pieces {
    /// Where every body lies.
    pub layout: Arc<Layout>,
    /// The question.
    pub query: Query,
    /// Its part of the work.
    pub share: Share,
    /// Whether any position needs f64.
    pub holds_f64: bool,
}

#[cfg(test)]
impl Pieces {
    /// All of a query's work, in single precision.
    fn whole(layout: Arc<Layout>, query: Query) -> Pieces {
        Pieces { layout, query, share: Share::WHOLE, holds_f64: false }
    }
}

/// The pipeline of a query, or of a share of its work.
///
/// # Errors
/// Those of the device.
pub fn pipeline(device: Device, bodies: &[Body], pieces: Pieces) -> Result<Box<dyn Pipeline>, Error> {
    Ok(if pieces.holds_f64 {
        Box::new(TypedPipeline::<f64>::new(device, bodies, pieces)?)
    } else {
        Box::new(TypedPipeline::<f32>::new(device, bodies, pieces)?)
    })
}
