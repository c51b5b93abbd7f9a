//! What each faster choice costs, in misses, lateness and false alarms: what `nearmiss trade` measures, prints, writes and
//! draws.
//!
//! Every solver is asked at every tolerance: questions whose answers the exact oracle knows (a built-in generator of hard
//! contacts, query files), and whole scenes, judged by the finest certified answers or by a list. Answers do not depend on
//! the machine; times do.

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
