//! The least time of a query for the earliest time alone, as kernels lower it: words of device
//! memory, atomic minima. All bits of each are set while there is none.

/// The word that holds the bits of the time, an f64.
pub const TIME: u32 = 0;
/// The word that holds its [`key`].
pub const KEY: u32 = 1;
/// The word that is 0 once a rung that [marks] has found a time. A later rung reads it, which does
/// not mark: so whether it works does not depend on the order of its own blocks.
///
/// [marks]: super::RungFlags::MARKS
pub const MARK: u32 = 2;
/// How many words there are.
pub const WORDS: u32 = 3;

/// A time in [0, 1] and whether it is that of an undecided pair, in one number: less for the less
/// time, and of equal times for the contact. Twice the bits of a number up to 1 fit.
#[inline(always)]
pub const fn key(toi: f64, undecided: bool) -> u64 {
    toi.to_bits() << 1 | undecided as u64
}

/// The time of a key, and whether it is that of an undecided pair; `None` while there is none.
pub const fn of_key(key: u64) -> Option<(f64, bool)> {
    if key == u64::MAX { None } else { Some((f64::from_bits(key >> 1), key & 1 == 1)) }
}
