//! Lanes of a block, by the work of a kernel.

/// Lanes of kernels whose work is the same for every lane.
pub const WIDE: u32 = 256;
/// Lanes of kernels with long or uneven work: small blocks, so that few lanes wait for a long one
/// (measured: `benches/NOTES.md`).
pub const NARROW: u32 = 64;
/// Lanes of the rung in f64: few pairs, spread over all warps that run at once.
pub const SPREAD: u32 = 32;
/// Lanes of rejection, of the rungs of a separation and of distances: work is uneven, and two lists
/// are appended to.
pub const RUNG: u32 = 128;
/// Lanes of the one block that evens the queues, as in the paper.
pub const BALANCE: u32 = 512;
