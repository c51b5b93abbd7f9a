//! PLY files: `header`, then the body through `source` in `read`; `write` is the way back.

mod header;
pub(crate) mod read;
mod source;
mod write;

pub use write::{encode_ply, encode_ply_coloured, write_ply};
