//! The near query: pairs of features beside exact fractions, whole frames beside all pairs asked one by one.

mod frame;
mod hunt;
mod known;
mod oracle;
mod planted;
mod refused;
