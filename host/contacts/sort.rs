//! Builds and sorts long lists on the host; an interrupt ends the work.

use nearmiss_emulator::Looks;
use rayon::prelude::*;
use std::cmp::Ordering;

/// Entries between two checks for an interrupt.
const CHUNK: usize = 1 << 18;

/// Appends the mapped entries; fewer if an interrupt ends the work.
pub fn extend<T: Sync, U: Send>(to: &mut Vec<U>, from: &[T], map: impl Fn(&T) -> U + Sync, looks: &Looks) {
    to.reserve_exact(from.len());
    for chunk in from.chunks(CHUNK) {
        if looks.ends() {
            return;
        }
        to.par_extend(chunk.par_iter().map(&map));
    }
}

/// Compares by a key. After an interrupt all entries are equal, so that a sort ends soon.
fn compare<T, K: Ord>(key: impl Fn(&T) -> K, looks: &Looks) -> impl Fn(&T, &T) -> Ordering {
    move |a, b| if looks.ends() { Ordering::Equal } else { key(a).cmp(&key(b)) }
}

/// Sorts entries with distinct keys; any order if an interrupt ends the work.
pub fn sort<T: Send, K: Ord>(list: &mut [T], key: impl Fn(&T) -> K + Sync, looks: &Looks) {
    list.par_sort_unstable_by(compare(key, looks));
}

/// Sorts a list of few sorted runs with distinct keys; any order if an interrupt ends the work.
pub fn merge<T: Send, K: Ord>(list: &mut [T], key: impl Fn(&T) -> K + Sync, looks: &Looks) {
    list.par_sort_by(compare(key, looks));
}

#[cfg(test)]
mod tests {
    use super::*;
    use nearmiss_emulator::Interrupt;

    #[test]
    fn a_sort_that_is_interrupted_ends_and_loses_nothing() {
        let numbers: Vec<u32> = (0..300_000u32).map(|i| i.wrapping_mul(2_654_435_761)).collect();
        let mut sorted = numbers.clone();
        sorted.sort_unstable();
        for at in [1, 2, 1_000, 100_000, u64::MAX] {
            for is_merged in [false, true] {
                let interrupt = Interrupt::new();
                interrupt.trigger_at(at);
                let looks = Looks::new(Some(&interrupt));
                let mut list = numbers.clone();
                if is_merged {
                    merge(&mut list, |&n| n, &looks);
                } else {
                    sort(&mut list, |&n| n, &looks);
                }
                assert_eq!(looks.ended(), at < u64::MAX);
                assert_eq!(list == sorted, !looks.ended());
                list.sort_unstable();
                assert_eq!(list, sorted, "the same entries");
            }
        }
    }

    #[test]
    fn a_list_that_is_interrupted_is_short() {
        let from: Vec<usize> = (0..3 * CHUNK).collect();
        for at in [1, 2, 4] {
            let interrupt = Interrupt::new();
            interrupt.trigger_at(at);
            let mut to = Vec::new();
            extend(&mut to, &from, |n| n + 1, &Looks::new(Some(&interrupt)));
            assert_eq!(to.len(), (at as usize - 1) * CHUNK);
            assert!(to.iter().zip(&from).all(|(to, from)| *to == from + 1));
        }
    }
}
