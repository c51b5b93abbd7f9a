//! The judge: compares the rows of all ranks with those of one machine.

use nearmiss::contacts::{Contacts, Rows};
use nearmiss_mpi::RankAnswer;
use std::collections::BTreeMap;

/// Returns the first difference of an answer of all ranks from that of one machine.
pub fn difference(found: &RankAnswer, wanted: &Contacts) -> Option<String> {
    let rows = match (&found.rows, &wanted.rows) {
        (Rows::Earliest(found), Rows::Earliest(wanted))
            if found.map(f64::to_bits) != wanted.map(f64::to_bits) =>
        {
            Some(format!("earliest {found:?} instead of {wanted:?}"))
        }
        (found, wanted) => of_rows(&lines(found), &lines(wanted)),
    };
    let numbers = || {
        let own = (found.starts_crossing, found.is_free(), found.count as usize);
        let one = (wanted.starts_crossing, wanted.is_free(), wanted.rows.len());
        (own != one).then(|| format!("start, free and rows are {own:?} instead of {one:?}"))
    };
    let undecided = || {
        let moves = matches!(wanted.rows, Rows::Contacts(_) | Rows::Earliest(_));
        let (own, one) = (found.undecided, wanted.undecided);
        (moves && own != one).then(|| format!("{own} undecided rows instead of {one}"))
    };
    let hash = || {
        let (own, one) = (found.hash(), wanted.hash());
        (own != one).then(|| format!("hash {own:016x} instead of {one:016x}"))
    };
    rows.or_else(numbers).or_else(undecided).or_else(hash)
}

/// Rows to the bit: a debug text of a number is that of no other, except of zeros and NaN, which the
/// hash compares.
fn lines(rows: &Rows) -> Vec<String> {
    match rows {
        Rows::Pairs(rows) => rows.iter().map(|row| format!("{row:?}")).collect(),
        Rows::Contacts(rows) => rows.iter().map(|row| format!("{row:?}")).collect(),
        Rows::Near(rows) => rows.iter().map(|row| format!("{row:?}")).collect(),
        _ => Vec::new(),
    }
}

fn of_rows(found: &[String], wanted: &[String]) -> Option<String> {
    let mut counts: BTreeMap<&str, i64> = BTreeMap::new();
    found.iter().for_each(|row| *counts.entry(row).or_default() += 1);
    if let Some((row, _)) = counts.iter().find(|(_, count)| **count > 1) {
        return Some(format!("{row} is there twice"));
    }
    wanted.iter().for_each(|row| *counts.entry(row).or_default() -= 1);
    match counts.iter().find(|(_, count)| **count != 0) {
        Some((row, -1)) => Some(format!("{row} is missing")),
        Some((row, _)) => Some(format!("{row} is no row of one machine")),
        None => None,
    }
}
