//! Where a narrow phase leaves a frame's answer in the device's memory.

use crate::contacts::Entries;
use crate::pipeline::list::{GrowableOutput, List};
use crate::pipeline::order::{Order, Ordered};
use nearmiss_kernels::abi::{Counter, Span};

/// Where a frame's answer lies in the device's memory.
pub struct AnswerLists {
    /// What the entries are.
    pub entries: Entries,
    /// One list in order, or one of each kind: where it begins, and its room.
    pub lists: Vec<(u64, usize)>,
    /// Whether it is the one in order.
    pub is_ordered: bool,
    /// Which counters count each kind.
    pub counters: Vec<Counter>,
    /// Where the earliest time is, of such a query.
    pub earliest: Option<u64>,
    /// Which counter counts the triangle pairs that share a point at the start; none if the start
    /// is not checked.
    pub crossing: Option<Counter>,
    /// End points of every edge.
    pub edges: Span<[u32; 2]>,
}

impl AnswerLists {
    /// Of lists of each kind, or of the one that they were ordered into.
    pub fn of<T: Ordered>(entries: Entries, lists: &[&List<T>], order: Option<&Order<T>>) -> AnswerLists {
        let place = |list: &List<T>| (list.entries().addr(), list.capacity());
        let order = order.filter(|order| order.fits());
        AnswerLists {
            entries,
            is_ordered: order.is_some(),
            lists: match order {
                Some(order) => vec![place(&order.list)],
                None => lists.iter().map(|list| place(list)).collect(),
            },
            counters: lists.iter().map(|list| list.counter()).collect(),
            earliest: None,
            crossing: None,
            edges: Span::EMPTY,
        }
    }
}
