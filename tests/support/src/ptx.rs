//! The committed PTX as text.

use std::io::Read;

/// The text of `kernels/nearmiss.ptx.zst`.
pub fn committed() -> String {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../kernels/nearmiss.ptx.zst");
    let compressed = std::fs::read(path).expect("kernels/nearmiss.ptx.zst is committed");
    let mut text = String::new();
    ruzstd::decoding::StreamingDecoder::new(compressed.as_slice())
        .expect("a frame of zstd")
        .read_to_string(&mut text)
        .expect("a text");
    text
}
