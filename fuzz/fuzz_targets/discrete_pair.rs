//! Two triangles: exact signs say what the oracle says, and the float test comes back.
#![no_main]

#[path = "../shared/mod.rs"]
#[allow(dead_code, reason = "each target uses a part")]
mod shared;

use libfuzzer_sys::fuzz_target;
use shared::{discrete, planted};

fuzz_target!(|bytes: &[u8]| {
    if let Err(what) = discrete::ask(bytes, |meets| meets ^ planted()) {
        panic!("{what}");
    }
});
