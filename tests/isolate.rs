//! The certified solver of a frame, pair by pair: the ladder of `prim::isolate`. Known answers, what each rung alone
//! decides, motions built in integers against the rational oracle, and faults that are planted.

#[path = "isolate/begin.rs"]
mod begin;
#[path = "isolate/built.rs"]
mod built;
#[path = "isolate/known.rs"]
mod known;
#[path = "isolate/planted.rs"]
mod planted;
#[path = "isolate/rung.rs"]
mod rung;
#[path = "isolate/turning.rs"]
mod turning;
