//! A handful of triangles, whole: what detect lists against the oracle's answer for every pair.
#![no_main]

use libfuzzer_sys::fuzz_target;
use support::fuzz::{planted, scene};

fuzz_target!(|bytes: &[u8]| {
    if let Err(what) = scene::ask(bytes, |answer| {
        if planted() {
            scene::forget(answer)
        }
    }) {
        panic!("{what}");
    }
});
