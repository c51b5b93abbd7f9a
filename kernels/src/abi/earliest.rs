//! The least time of a query for the earliest time alone, as kernels lower it: two words of device
//! memory, atomic minima. All bits of both are set while there is none.

/// The word that holds the bits of the time, an f64.
pub const TIME: u32 = 0;
/// The word that holds its [`key`].
pub const KEY: u32 = 1;
/// How many words there are.
pub const WORDS: u32 = 2;

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
