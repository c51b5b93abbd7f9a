//! Stages of a frame and the choices of each: trees, tiles, queues, fronts, lists.

mod construct;
mod demand;
mod front;
mod order;
mod queue;
mod refit;
mod repeat;
mod room;
mod settle;
mod tiles;
