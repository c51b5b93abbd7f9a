//! The certified solver of a frame, pair by pair: the ladder of `prim::isolate`. Known answers, what each rung alone
//! decides, motions built in integers against the rational oracle, and faults that are planted.

mod begin;
mod built;
mod known;
mod nearest;
mod planted;
mod proven;
mod rung;
mod turning;
