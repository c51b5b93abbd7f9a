//! Figures 6.12 to 6.14 of the thesis, and further ones, measured here: the output of `nearmiss
//! lab tables`.
//!
//! An animation is measured cell by cell: one motion, one volume, with or without a front. The tree
//! is built at the first frame and refitted at all others, as in the thesis. A first pass over all
//! frames is the warm-up and is not measured.

mod agree;
mod all;
mod bodies;
mod build;
mod figures;
mod frames;
mod front;
mod measure;
mod paper_reference;
pub(crate) mod picture;
mod scale;
mod text;
mod way;

pub use agree::agree;
pub use all::{Figures, csv};
pub use bodies::bodies;
pub use build::build;
pub use figures::{Paper, figure_612, figure_613, figure_614};
pub use frames::{Frames, SCENES, frames, read};
pub use front::front;
pub use measure::measure;
pub use scale::{ScaleRow, scale};
pub use text::{Printed, digits, grouped, text};
pub use way::Way;
