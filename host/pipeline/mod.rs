//! The pipeline: the stages of a frame, from bodies to contacts.

pub mod below_precision;
mod broad;
pub(crate) mod collect;
pub mod counts;
mod demand;
pub mod enclose;
mod excluded;
mod extras;
mod hubs;
mod instances;
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
pub use layout::{FeatureTopology, Layout};
pub use placing::{Moved, Seen, Whereabouts};
pub use tolerance::{Tolerances, of_pair};
pub(crate) use typed::not_prepared;
pub use typed::{Found, Hits, Listed, Pipeline};

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

/// Parameters of a scene's pipeline.
pub struct SceneParts {
    /// The place of every body.
    pub layout: Arc<Layout>,
    /// Whether any position needs f64.
    pub holds_f64: bool,
    /// Whether a query reads the end of the step.
    pub has_ends: bool,
    /// Whether a query reads vertices in the scene. Others read bodies as instances.
    pub has_vertices: bool,
    /// Whether queries read bodies as instances if they can.
    pub has_instances: bool,
}

/// Parameters of a query of the scene.
pub struct QueryParts {
    /// The place of every body, as this query uses it.
    pub layout: Arc<Layout>,
    /// The query, with the largest tolerance of its pairs.
    pub query: Query,
    /// Tolerances of bodies by their first vertices. Empty if all pairs have the same tolerance, or
    /// the query has none.
    pub tolerances: Vec<BodyTolerance>,
    /// Its share of the work.
    pub share: Share,
    /// Whether it reads bodies as instances: a whole discrete query of rigid and fixed bodies.
    pub is_of_instances: bool,
}

#[cfg(test)]
impl QueryParts {
    /// Returns a query with all of its work.
    fn whole(layout: Arc<Layout>, query: Query) -> QueryParts {
        QueryParts { layout, query, tolerances: Vec::new(), share: Share::WHOLE, is_of_instances: false }
    }
}

/// Returns the pipeline of a scene.
///
/// # Errors
/// Device errors.
pub fn pipeline(device: Device, bodies: &[Body], parts: &SceneParts) -> Result<Box<dyn Pipeline>, Error> {
    Ok(if parts.holds_f64 {
        Box::new(TypedPipeline::<f64>::new(device, bodies, parts)?)
    } else {
        Box::new(TypedPipeline::<f32>::new(device, bodies, parts)?)
    })
}
