//! Builds and sorts long lists on the host; an interrupt ends the work.

use bytemuck::Pod;
use nearmiss_emulator::Looks;
use rayon::prelude::*;
use std::cmp::Ordering;

/// Entries between two checks for an interrupt.
const CHUNK: usize = 1 << 18;

/// Most entries that one thread merges at a time.
const PIECE: usize = 1 << 14;

/// So few entries are mapped by one thread: others would take as long to wake.
const FEW: usize = 1 << 10;

/// Appends the mapped entries; fewer if an interrupt ends the work.
pub fn extend<T: Sync, U: Send>(to: &mut Vec<U>, from: &[T], map: impl Fn(&T) -> U + Sync, looks: &Looks) {
    to.reserve_exact(from.len());
    for chunk in from.chunks(CHUNK) {
        if looks.ends() {
            return;
        }
        if chunk.len() > FEW {
            to.par_extend(chunk.par_iter().map(&map));
        } else {
            to.extend(chunk.iter().map(&map));
        }
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
pub fn sort_runs<T: Send, K: Ord>(list: &mut [T], key: impl Fn(&T) -> K + Sync, looks: &Looks) {
    list.par_sort_by(compare(key, looks));
}

/// Merges sorted lists, whose keys are distinct, into `to`, which is as long as all of them. Returns
/// whether it is whole: not if an interrupt ends the work. Cost: a pass on all threads, and one more
/// for each doubling of the number of lists.
pub fn merge<T: Pod + Send + Sync, K: Ord>(
    lists: &[&[T]],
    key: &(impl Fn(&T) -> K + Sync),
    looks: &Looks,
    to: &mut [T],
) -> bool {
    match *lists {
        [] => merge_two(&[], &[], key, looks, to),
        [list] => merge_two(list, &[], key, looks, to),
        [one, other] => merge_two(one, other, key, looks, to),
        _ => {
            let halves = lists.split_at(lists.len() / 2);
            let whole = |half: &[&[T]]| {
                let mut whole = vec![T::zeroed(); half.iter().map(|list| list.len()).sum()];
                merge(half, key, looks, &mut whole).then_some(whole)
            };
            let halves = whole(halves.0).zip(whole(halves.1));
            halves.is_some_and(|(one, other)| merge_two(&one, &other, key, looks, to))
        }
    }
}

/// Merges two lists: see [`merge`].
fn merge_two<T: Pod + Send + Sync, K: Ord>(
    one: &[T],
    other: &[T],
    key: &(impl Fn(&T) -> K + Sync),
    looks: &Looks,
    to: &mut [T],
) -> bool {
    assert_eq!(to.len(), one.len() + other.len(), "room for both lists");
    if looks.ends() {
        return false;
    }
    if to.len() > PIECE {
        let (longer, shorter) = if one.len() < other.len() { (other, one) } else { (one, other) };
        let (low, high) = longer.split_at(longer.len() / 2);
        let first = key(&high[0]);
        let (less, more) = shorter.split_at(shorter.partition_point(|entry| key(entry) < first));
        let (front, back) = to.split_at_mut(low.len() + less.len());
        let (is_front, is_back) = rayon::join(
            || merge_two(low, less, key, looks, front),
            || merge_two(high, more, key, looks, back),
        );
        return is_front && is_back;
    }
    let (mut one, mut other) = (one, other);
    for place in to {
        let takes_other = match (one.first(), other.first()) {
            (Some(first), Some(second)) => key(second) < key(first),
            (first, _) => first.is_none(),
        };
        let from = if takes_other { &mut other } else { &mut one };
        *place = from[0];
        *from = &from[1..];
    }
    true
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
            for is_of_runs in [false, true] {
                let interrupt = Interrupt::new();
                interrupt.trigger_at(at);
                let looks = Looks::new(Some(&interrupt));
                let mut list = numbers.clone();
                if is_of_runs {
                    sort_runs(&mut list, |&n| n, &looks);
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

    /// Returns sorted lists of the numbers below `entries`; `of` gives the list of each.
    fn divided(lists: usize, entries: usize, of: impl Fn(usize) -> usize) -> Vec<Vec<usize>> {
        let mut divided = vec![Vec::new(); lists];
        (0..entries).for_each(|n| divided[of(n)].push(n));
        divided
    }

    fn merged(divided: &[Vec<usize>], looks: &Looks) -> Option<Vec<usize>> {
        let lists: Vec<&[usize]> = divided.iter().map(Vec::as_slice).collect();
        let mut to = vec![0; lists.iter().map(|list| list.len()).sum()];
        merge(&lists, &|&n| n, looks, &mut to).then_some(to)
    }

    #[test]
    fn lists_become_one_however_they_are_divided() {
        for entries in [0, 1, 2, PIECE, PIECE + 1, 3 * PIECE + 5, 10 * PIECE] {
            for lists in [1, 2, 3, 5, 8] {
                let divisions: [&dyn Fn(usize) -> usize; 5] = [
                    &|n| n.wrapping_mul(2_654_435_761) / 64 % lists,
                    &|_| lists - 1,
                    &|n| usize::from(n > 7) % lists,
                    &|n| n * lists / entries,
                    &|n| lists - 1 - n * lists / entries,
                ];
                for of in divisions {
                    let whole = merged(&divided(lists, entries, of), &Looks::new(None));
                    assert!(whole.expect("no interrupt").into_iter().eq(0..entries), "{entries} in {lists}");
                }
            }
        }
        assert_eq!(merged(&[], &Looks::new(None)), Some(Vec::new()));
    }

    #[test]
    fn a_merge_that_is_interrupted_gives_nothing() {
        let lists = divided(3, 20 * PIECE, |n| n % 3);
        let mut whole = 0;
        for at in (1..200).chain([u64::MAX]) {
            let interrupt = Interrupt::new();
            interrupt.trigger_at(at);
            let looks = Looks::new(Some(&interrupt));
            let merged = merged(&lists, &looks);
            assert_eq!(merged.is_none(), looks.ended());
            whole += usize::from(merged.is_some());
        }
        assert!((1..150).contains(&whole), "{whole} of 200 ended whole");
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
