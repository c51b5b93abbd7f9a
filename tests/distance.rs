//! The distance query: pairs of triangles beside exact fractions, whole scenes beside all pairs asked one by one.

#[path = "distance/frame.rs"]
mod frame;
#[path = "distance/hunt.rs"]
mod hunt;
#[path = "distance/judge.rs"]
mod judge;
#[path = "distance/known.rs"]
mod known;
#[path = "distance/planted.rs"]
mod planted;
mod support;
