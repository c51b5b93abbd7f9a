//! A handful of triangles at rest: how far apart two bodies are against the oracle's answer for every pair.
#![no_main]

#[path = "../shared/mod.rs"]
#[allow(dead_code, reason = "each target uses a part")]
mod shared;

use libfuzzer_sys::fuzz_target;
use shared::{distance, planted, scene};

fuzz_target!(|bytes: &[u8]| {
    if let Err(what) = distance::ask(bytes, |answer| {
        if planted() {
            scene::forget(answer)
        }
    }) {
        panic!("{what}");
    }
});
