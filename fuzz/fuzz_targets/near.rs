//! A handful of triangles at rest: what is within a distance against the oracle's answer for every pair.
#![no_main]

use libfuzzer_sys::fuzz_target;
use support::fuzz::{near, planted, scene};

fuzz_target!(|bytes: &[u8]| {
    if let Err(what) = near::ask(bytes, |answer| {
        if planted() {
            scene::forget(answer)
        }
    }) {
        panic!("{what}");
    }
});
