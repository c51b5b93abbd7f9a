//! The distance query: pairs of triangles beside exact fractions, whole scenes beside all pairs asked one by one.

mod frame;
mod hunt;
mod known;
mod planted;
