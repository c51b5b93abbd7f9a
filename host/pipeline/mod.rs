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
pub(crate) mod wear;

pub use broad::Share;
pub use layout::{FeatureTopology, Layout, Offsets};
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
use nearmiss_kernels::abi::BodyTolerance;
use std::sync::Arc;
use typed::TypedPipeline;

/// A scene that a pipeline is made for.
pub struct SceneParts {
    /// Where every body lies.
    pub layout: Arc<Layout>,
    /// Whether any position needs f64.
    pub holds_f64: bool,
    /// Whether a query reads the end of the step.
    pub has_ends: bool,
}

/// A query of such a scene.
pub struct QueryParts {
    /// Where every body lies, as this query sees it.
    pub layout: Arc<Layout>,
    /// The query, with the largest tolerance of its pairs.
    pub query: Query,
    /// Tolerances of bodies by their first vertices; empty if all pairs have the same, and for queries without one.
    pub tolerances: Vec<BodyTolerance>,
    /// Its part of the work.
    pub share: Share,
}

#[cfg(test)]
impl QueryParts {
    /// All of a query's work.
    fn whole(layout: Arc<Layout>, query: Query) -> QueryParts {
        QueryParts { layout, query, tolerances: Vec::new(), share: Share::WHOLE }
    }
}

/// The pipeline of a scene.
///
/// # Errors
/// Those of the device.
pub fn pipeline(device: Device, bodies: &[Body], parts: &SceneParts) -> Result<Box<dyn Pipeline>, Error> {
    Ok(if parts.holds_f64 {
        Box::new(TypedPipeline::<f64>::new(device, bodies, parts)?)
    } else {
        Box::new(TypedPipeline::<f32>::new(device, bodies, parts)?)
    })
}
