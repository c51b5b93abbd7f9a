//! The GPU: the committed PTX as text, which needs none, and a simulator, which does.

mod foreign;
mod ptx;
