//! Whole frames, by every query: against brute force, exact lists and laws.

mod animation;
mod caveats;
mod contacts;
mod distance;
mod earliest;
mod exact;
mod finite;
mod frame;
mod fuzz_pairs;
mod hard;
mod invariance;
mod laws;
mod listed;
mod near;
mod robustness;
mod separation;
mod triangles;
