//! The pipeline: one file a stage, in the order in which data flows.
//!
//! The **default path** finds candidates by tiles, on every machine and for every query except
//! distance:
//!
//! ```text
//! place → construct (order, tile_filters) → fit/tiles → refit/tiles
//!       → traverse/tiles → traverse/tile_triangles → narrow → order → status
//! ```
//!
//! Trees are the path of the paper, and the only one for distances: `construct/tree`, `fit/leaves`,
//! a refit by levels or by treelets, and a walk ([`traverse`] lists them).
//!
//! | stage | reads | writes |
//! | --- | --- | --- |
//! | [`place`] | poses, uploaded positions, the caller's memory | positions of moved bodies |
//! | [`turns`](mod@turns) | poses at both ends | bodies that turn in the step |
//! | [`starts`] | positions at both ends | positions at t = 0, for queries at rest |
//! | [`construct`] | positions at t = 0, faces | the order of tiles, or a tree without volumes |
//! | [`fit`] | positions at t = 0 and t = 1, faces | volumes of triangles and tiles |
//! | [`refit`] | volumes of a level | volumes of the level above |
//! | [`traverse`] | volumes | candidates: triangle pairs |
//! | [`balance`] | the work queues of the paper's walk | the same units, evenly cut |
//! | [`narrow`] | candidates, positions | contacts |
//! | [`order`] | contacts | rows of the answer, in canonical order, on a GPU |
//! | [`answer`] | contacts | geometry of rows, rows by feature: in submissions, on request |
//! | [`status`] | counts, capacities of lists | whether the answer is complete |
//!
//! No stage calls another. They exchange data in memory, through [`crate::abi`]. [`traverse`] and
//! [`narrow`] share one rule for earliest queries: [`crate::bvh::horizon`].
//!
//! Every kernel file opens with a card. `Before` and `After` are its conditions. `Paper` cites its
//! source. *The thesis* is C. Lauterbach, "Interactive Ray Tracing of Massive and Deformable
//! Models", 2010: chapter 5 or section 6.2. *The paper* is the same system in short: Lauterbach, Mo
//! and Manocha, "gProximity: Hierarchical GPU-based Operations for Collision and Distance Queries",
//! 2010.

pub mod answer;
pub mod balance;
pub mod construct;
pub mod fit;
pub mod narrow;
pub mod order;
pub mod place;
pub mod refit;
pub mod starts;
pub mod status;
pub mod traverse;
pub mod turns;
