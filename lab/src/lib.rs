//! Evaluation of nearmiss: exact answers in rational numbers, hard built contacts, and generated
//! scenes. It measures the cost of each faster choice, and compares the thesis's tables with ours.
//! It belongs to this project, not to the library: nothing here is stable.

pub mod accuracy;
pub mod case;
pub mod figures;
mod one_query;
pub mod oracle;
pub mod pairs;
pub mod robustness;
pub mod scene;
pub mod tables;
pub mod turns;

pub use case::{Case, Features};
pub use one_query::{OneQuery, OneQueryOnSeveral};
