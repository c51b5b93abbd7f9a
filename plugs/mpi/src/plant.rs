//! Faults that tests plant.

/// A fault of a rank.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// A chunk that another rank needs is not sent.
    ChunkNotSent,
    /// Boxes are not grown by the distance of the query.
    BoxesNotGrown,
    /// Rows are kept that other ranks keep too.
    RowsKeptTwice,
    /// The rank panics in its part of a query.
    Panic,
}
