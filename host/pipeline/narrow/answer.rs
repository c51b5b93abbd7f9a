//! The place of a narrow phase's answer in device memory.

use crate::contacts::Entries;
use crate::pipeline::list::{GrowableOutput, List};
use crate::pipeline::order::{Order, Ordered};
use nearmiss_kernels::abi::{Counter, Span};

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
