//! A handful of triangles at rest: how far apart two bodies are against the oracle's answer for every pair.
#![no_main]

use libfuzzer_sys::fuzz_target;
use support::fuzz::{distance, planted, scene};

fuzz_target!(|bytes: &[u8]| {
    if let Err(what) = distance::ask(bytes, |answer| {
        if planted() {
            scene::forget(answer)
        }
    }) {
        panic!("{what}");
    }
});
