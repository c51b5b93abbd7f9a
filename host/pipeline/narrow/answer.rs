//! The place of a narrow phase's answer in device memory.

use crate::contacts::Entries;
use crate::pipeline::list::{GrowableOutput, List};
use crate::pipeline::order::{Order, Ordered};
use nearmiss_kernels::abi::{AnswerRows, Counter, Counters, Hit, NearHit, Output, Pair, Span};

/// The place of a frame's answer in device memory.
pub struct AnswerLists {
    /// The type of the entries.
    pub entries: Entries,
    /// One ordered list, or one of each kind: its address and its room.
    pub lists: Vec<(u64, usize)>,
    /// Whether the list is ordered.
    pub is_ordered: bool,
    /// The counters of each kind.
    pub counters: Vec<Counter>,
    /// The address of the earliest time, for an earliest query.
    pub earliest: Option<u64>,
    /// The counter of the triangle pairs that share a point at the start; none if the start is not
    /// checked.
    pub crossing: Option<Counter>,
    /// End points of every edge.
    pub edges: Span<[u32; 2]>,
}

impl AnswerLists {
    /// Returns the lists of each kind, or the one that they are ordered into for a submission.
    pub fn of<T: Ordered>(entries: Entries, lists: &[&List<T>], order: Option<&Order<T>>) -> AnswerLists {
        let place = |list: &List<T>| (list.entries().addr(), list.capacity());
        let order = order.and_then(Order::contacts);
        AnswerLists {
            entries,
            is_ordered: order.is_some(),
            lists: match order {
                Some(contacts) => vec![(contacts.addr(), contacts.len() as usize)],
                None => lists.iter().map(|list| place(list)).collect(),
            },
            counters: lists.iter().map(|list| list.counter()).collect(),
            earliest: None,
            crossing: None,
            edges: Span::EMPTY,
        }
    }
}

/// The rows of an answer, for kernels that follow; without the features that they name.
#[derive(Clone, Copy)]
pub enum RowSpans {
    /// Triangle pairs.
    Pairs(AnswerRows<Pair>),
    /// Contacts in motion.
    Contacts(AnswerRows<Hit>),
    /// Features within a distance.
    Near(AnswerRows<NearHit>),
}

/// Returns the rows of one list or two, or the list that they are ordered into for a submission.
pub fn rows_of<T: Ordered>(
    lists: &[&List<T>],
    order: Option<&Order<T>>,
    counters: Counters,
) -> AnswerRows<T> {
    let output = |at: usize| lists.get(at).map_or(Output::EMPTY, |list| list.output(counters));
    AnswerRows {
        first: output(0),
        second: output(1),
        ordered: order.and_then(Order::contacts).unwrap_or(Span::EMPTY),
        faces: Span::EMPTY,
        edges: Span::EMPTY,
        elements: Span::EMPTY,
    }
}

impl RowSpans {
    /// Returns whether rows name features.
    pub fn are_of_features(&self) -> bool {
        !matches!(self, RowSpans::Pairs(_))
    }

    /// Returns how many rows there is room for.
    pub fn room(&self) -> usize {
        fn room<T: Ordered>(rows: &AnswerRows<T>) -> usize {
            let listed = if rows.ordered.is_empty() {
                rows.first.room() + rows.second.room()
            } else {
                rows.ordered.len()
            };
            listed as usize
        }
        match self {
            RowSpans::Pairs(rows) => room(rows),
            RowSpans::Contacts(rows) => room(rows),
            RowSpans::Near(rows) => room(rows),
        }
    }
}
