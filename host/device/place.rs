//! Parts of a device, for launches that run at the same time.
//!
//! Some kernels fill all registers with the blocks that run at once, and each block runs until the end.
//! A launch at the same time then comes before or behind them. So the first kind leaves a place on each
//! processor, and the others have few blocks.

/// The part of a device that the blocks of a launch may take. Answers do not depend on it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Place {
    /// All of it.
    #[default]
    Whole,
    /// All of it except for a place of one block on each processor. All of it if a processor has few
    /// blocks at once.
    Rest,
    /// That place.
    Spare,
}

/// Fewest blocks of a processor of which one is spared.
const MANY: u32 = 3;
/// Lanes in a place: with 255 registers they fit where a block of 128 lanes and 128 registers does.
const LANES: u32 = 64;

impl Place {
    /// How many blocks of so many lanes a processor has, if `at_once` run there at once.
    #[cfg_attr(not(feature = "cuda"), allow(dead_code, reason = "a CPU runs blocks in sequence"))]
    pub fn of_processor(self, at_once: u32, lanes: u32) -> u32 {
        match self {
            Place::Rest if at_once >= MANY => at_once - 1,
            Place::Whole | Place::Rest => at_once,
            Place::Spare => at_once.min((LANES / lanes).max(1)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Place::{Rest, Spare, Whole};

    #[test]
    fn a_place_is_spared_of_many_blocks_and_holds_a_block_or_two_warps() {
        let of = |place: super::Place| {
            [(4, 128), (3, 128), (2, 128), (9, 32), (1, 32)]
                .map(|(at_once, lanes)| place.of_processor(at_once, lanes))
        };
        assert_eq!(of(Whole), [4, 3, 2, 9, 1]);
        assert_eq!(of(Rest), [3, 2, 2, 8, 1]);
        assert_eq!(of(Spare), [1, 1, 1, 2, 1]);
    }
}
