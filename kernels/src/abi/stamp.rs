//! The stamp: which sources a PTX came from. The card's module exports it, the host compares it with its own.

/// Sixteen hexadecimal digits of the hash of the kernels' sources, as a number; 0 where the build gave none.
pub const SOURCES: u64 = match option_env!("NEARMISS_STAMP") {
    Some(text) => parse(text.as_bytes()),
    None => 0,
};

/// Hexadecimal text as a number.
const fn parse(text: &[u8]) -> u64 {
    let mut value = 0;
    let mut i = 0;
    while i < text.len() {
        let digit = match text[i] {
            d @ b'0'..=b'9' => d - b'0',
            d @ b'a'..=b'f' => d - b'a' + 10,
            _ => panic!("the stamp is hexadecimal"),
        };
        value = value << 4 | digit as u64;
        i += 1;
    }
    value
}
