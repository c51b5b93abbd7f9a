//! What judges nearmiss: exact answers in rational numbers, contacts built to be hard, scenes that are made here, what each
//! faster choice costs, and the thesis's tables beside ours. A part of this project, not of the library: nothing here is
//! promised to stay.

pub mod accuracy;
pub mod case;
pub mod figures;
mod one_query;
pub mod oracle;
pub mod pairs;
pub mod robustness;
pub mod scene;
pub mod tables;

pub use case::{Case, Features};
pub use one_query::{OneQuery, OneQueryOnSeveral};
