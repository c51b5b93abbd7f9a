//! The cost of each faster choice in misses, lateness and false alarms: the results of `nearmiss
//! lab trade`.
//!
//! Every solver is tested at every tolerance. Single cases have answers of the exact oracle: a
//! built-in generator of hard contacts, and query files. Whole scenes are judged by the finest
//! certified answers or by a list. Answers do not depend on the machine; times do.

mod all;
mod funnel;
mod gap;
mod headline;
mod input;
mod judge;
mod picture;
mod queries;
mod refit;
mod row;
mod scene;
mod sweeps;
pub mod triangles;
mod truth;

pub use all::Trade;
pub use funnel::funnel;
pub use input::{Choice, Input, built_in, query_files};
pub use refit::refit;
pub use scene::Scene;
pub use sweeps::{Extent, degeneracies, offsets, scales};
pub use triangles::triangles;
pub use truth::{List, list};

pub use queries::{Queries, queries};
