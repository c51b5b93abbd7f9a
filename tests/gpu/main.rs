//! The GPU: the committed PTX as text and machine code, which need none, and a simulator, which does.

mod cubins;
mod foreign;
mod ptx;
