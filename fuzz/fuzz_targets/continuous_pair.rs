//! Two features that move: certified answers miss nothing, are never late and certify nothing that is not; others say times.
#![no_main]

use libfuzzer_sys::fuzz_target;
use nearmiss_kernels::prim::inclusion::Verdict;
use support::fuzz::{continuous, planted};

fuzz_target!(|bytes: &[u8]| {
    if let Err(what) = continuous::ask(bytes, |verdict| {
        if planted() && !verdict.is_separated() { Verdict::separated(1.0, 0) } else { verdict }
    }) {
        panic!("{what}");
    }
});
