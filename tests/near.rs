//! The near query: pairs of features beside exact fractions, whole frames beside all pairs asked one by one.

#[path = "near/frame.rs"]
mod frame;
#[path = "near/hunt.rs"]
mod hunt;
#[path = "near/judge.rs"]
mod judge;
#[path = "near/known.rs"]
mod known;
#[path = "near/oracle.rs"]
mod oracle;
#[path = "near/planted.rs"]
mod planted;
#[path = "near/refused.rs"]
mod refused;
mod support;
