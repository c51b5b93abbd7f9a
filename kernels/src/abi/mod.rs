//! What crosses the border between host and card: spans of device memory, records, argument blocks.
//!
//! The law for records: `repr(C)`, plain old data, no padding; sizes are asserted at compile time.

mod args;
mod record;
mod span;
pub mod stamp;

pub use args::*;
pub use record::*;
pub use span::Span;
