//! The stamp: which sources a PTX came from. The GPU's module exports it, the host compares it with
//! its own.

/// Sixteen hexadecimal digits of the hash of the kernels' sources, as a number; 0 if the build gave
/// none.
pub const SOURCES: u64 = match option_env!("NEARMISS_STAMP") {
    Some(hexadecimal) => match u64::from_str_radix(hexadecimal, 16) {
        Ok(stamp) => stamp,
        Err(_) => panic!("NEARMISS_STAMP is sixteen hexadecimal digits"),
    },
    None => 0,
};
