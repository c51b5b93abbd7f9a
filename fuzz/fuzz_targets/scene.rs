//! A handful of triangles, whole: what detect lists against the oracle's answer for every pair.
#![no_main]

#[path = "../shared/mod.rs"]
#[allow(dead_code, reason = "each target uses a part")]
mod shared;

use libfuzzer_sys::fuzz_target;
use shared::{planted, scene};

fuzz_target!(|bytes: &[u8]| {
    if let Err(what) = scene::ask(bytes, |answer| {
        if planted() {
            scene::forget(answer)
        }
    }) {
        panic!("{what}");
    }
});
