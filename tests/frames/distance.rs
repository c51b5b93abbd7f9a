//! The distance query: pairs of triangles compared with exact fractions, whole scenes with all
//! pairs tested one by one.

mod frame;
mod hunt;
mod known;
mod planted;
