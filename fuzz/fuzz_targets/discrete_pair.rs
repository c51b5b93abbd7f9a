//! Two triangles: exact signs say what the oracle says, and the float test comes back.
#![no_main]

use libfuzzer_sys::fuzz_target;
use support::fuzz::{discrete, planted};

fuzz_target!(|bytes: &[u8]| {
    if let Err(what) = discrete::ask(bytes, |meets| meets ^ planted()) {
        panic!("{what}");
    }
});
