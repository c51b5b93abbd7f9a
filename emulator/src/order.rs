//! The order of blocks and lanes, on which no answer may depend.

/// An order of blocks in a launch, and of lanes in a phase.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    /// 0, 1, 2, …
    Forward,
    /// …, 2, 1, 0
    Reverse,
    /// A permutation by a number, another one for each launch and phase.
    Shuffled(u64),
}

impl Order {
    /// The numbers below `count` in this order; `turn` distinguishes launches and phases.
    pub fn sequence(self, count: u32, turn: u64) -> Vec<u32> {
        let mut numbers: Vec<u32> = (0..count).collect();
        match self {
            Order::Forward => {}
            Order::Reverse => numbers.reverse(),
            Order::Shuffled(seed) => {
                use rand::{SeedableRng, seq::SliceRandom};
                numbers.shuffle(&mut rand::rngs::SmallRng::seed_from_u64(seed ^ turn.rotate_left(32)));
            }
        }
        numbers
    }
}
