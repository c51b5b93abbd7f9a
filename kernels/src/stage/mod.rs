//! The pipeline: one file a stage, in the order in which data flows.
//!
//! | stage | reads | writes |
//! | --- | --- | --- |
//! | [`place`] | poses, uploaded positions, memory of the caller | positions of the bodies that were moved |
//! | [`starts`] | positions at both ends | positions at t = 0 alone, for queries at rest |
//! | [`construct`] | positions at t = 0, faces | the level-ordered tree, without volumes |
//! | [`fit`] | positions at t = 0 and t = 1, faces | volumes of the leaves |
//! | [`refit`] | volumes of the leaves | all volumes, a barrier between levels |
//! | [`traverse`] | the tree | candidates: triangle pairs |
//! | [`balance`] | the traversal's queues of work | the same units, as many in each |
//! | [`narrow`] | candidates, positions | contacts |
//! | [`order`] | contacts | the same in canonical order, on a GPU |
//! | [`status`] | counts, and the lists' room | whether the answer is whole, for who does not ask the host |
//!
//! No stage calls another; they meet in memory, through [`crate::abi`]. What [`traverse`] and [`narrow`] both leave out of a query for the
//! earliest time is told by [`crate::bvh::horizon`].

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
