//! The near query: pairs of features compared with exact fractions, whole frames with all pairs
//! tested one by one.

mod frame;
mod hunt;
mod known;
mod oracle;
mod planted;
mod refused;
mod thick;
