//! The interface between host and GPU: spans of device memory, records, argument blocks.
//!
//! The law for records: `repr(C)`, plain old data, no padding; sizes are asserted at compile time.

#[macro_use]
mod args;
mod answer;
mod bodies;
pub mod counter;
pub mod earliest;
mod excluded;
mod flags;
mod growth;
mod instances;
mod motions;
mod narrow;
mod order;
mod output;
mod poses;
mod queues;
mod record;
pub mod rows;
mod scene;
mod span;
pub mod stamp;
mod status;
mod tile;
mod turns;

pub use answer::*;
pub use args::*;
pub use bodies::*;
pub use counter::{Counter, Counters, MESH_LEVELS, ROUNDS};
pub use excluded::*;
pub use flags::*;
pub use growth::Growth;
pub use instances::*;
pub use motions::*;
pub use narrow::*;
pub use order::*;
pub use output::Output;
pub use poses::*;
pub use queues::*;
pub use record::*;
pub use scene::*;
pub use span::Span;
pub use status::*;
pub use tile::*;
pub use turns::*;
