//! PLY files. Reading: `header`, then the body through `source` in `read`. Writing: `write`.

mod header;
pub(crate) mod read;
mod source;
mod write;

pub use write::{encode_ply, encode_ply_coloured, write_ply};
