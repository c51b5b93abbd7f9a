//! Whole frames against brute force and known answers: the pipeline loses nothing, invents nothing,
//! and does no unnecessary work.

mod certified;
mod continuous;
mod discrete;
mod work;
