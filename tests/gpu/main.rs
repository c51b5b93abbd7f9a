//! The GPU: the committed PTX as text, which needs none, and a simulator beside it, which does.

mod foreign;
mod ptx;
