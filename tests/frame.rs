//! Whole frames against brute force and known answers: the pipeline loses nothing, invents nothing, and does no work
//! that nobody asked for.

#[path = "frame/certified.rs"]
mod certified;
#[path = "frame/continuous.rs"]
mod continuous;
#[path = "frame/discrete.rs"]
mod discrete;
mod support;
#[path = "frame/work.rs"]
mod work;
