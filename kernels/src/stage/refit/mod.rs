//! # Refit: leaf volumes → all volumes
//! Paper    section 6.2.4, "Parallel hierarchy refitting"; table 6.12, right half.
//! Ways     [`levels`] is the paper's: a launch a level. [`treelets`] is one launch, whose barriers are those of blocks.
//!          [`bottom_up`] has no barrier: of two siblings, who comes second goes on. All merge left with right, so all
//!          give the same bits. [`tiles`] is of what has no tree.

pub mod bottom_up;
pub mod levels;
pub mod tiles;
pub mod treelets;
