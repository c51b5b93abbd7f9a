//! Which pairs of nodes are asked at all: collision filters of bodies, as far up the tree as all below a node share one.

use crate::abi::{BodyRecord, EVERY, FilterArgs, MIXED, NodeFilter, SELF_CONTACT};
use crate::exec::Lane;

impl FilterArgs {
    /// The filter of a node; that of a body tested against itself where the scene has no filters.
    #[inline(always)]
    pub fn of<L: Lane>(&self, l: &L, node: u32) -> NodeFilter {
        if self.nodes.is_empty() {
            NodeFilter { who: SELF_CONTACT, last: 0 }
        } else {
            l.read(self.nodes, node)
        }
    }

    /// Whether something below one node may be asked about something below the other. Two bodies must be of one environment,
    /// or one of every, and each in a group that the other meets; a body meets itself where it says so, whatever its groups.
    /// What it refuses for two nodes it refuses for all below them: environments are ranges of leaves, of which those below a
    /// node are some.
    #[inline(always)]
    pub fn allows<L: Lane>(&self, l: &L, p: NodeFilter, q: NodeFilter) -> bool {
        if self.nodes.is_empty() {
            return true;
        }
        let mixed = (p.who | q.who) & MIXED != 0;
        if !mixed & (p.who == q.who) {
            return p.meets_itself();
        }
        let shared = (p.first() <= q.last) & (q.first() <= p.last);
        let together = shared | (p.last == EVERY) | (q.last == EVERY);
        if !together | mixed | self.bodies.is_empty() {
            return together;
        }
        let [p, q] = [p, q].map(|filter| l.read(self.bodies, filter.who & NodeFilter::NUMBER));
        (p.group & q.mask != 0) & (q.group & p.mask != 0)
    }
}

impl NodeFilter {
    /// The first environment.
    #[inline(always)]
    fn first(self) -> u32 {
        if self.who & MIXED != 0 { self.who & NodeFilter::NUMBER } else { self.last }
    }

    /// Whether it is one body's that is tested against itself.
    #[inline(always)]
    pub fn meets_itself(self) -> bool {
        self.who & SELF_CONTACT != 0
    }

    /// Of a leaf of a body.
    #[inline]
    pub fn leaf(body: u32, record: &BodyRecord) -> NodeFilter {
        let own = if record.self_contact != 0 { SELF_CONTACT } else { 0 };
        NodeFilter { who: body | own, last: record.environment }
    }

    /// Of a node above both.
    #[inline]
    pub fn above(self, other: NodeFilter) -> NodeFilter {
        if self == other && self.who & MIXED == 0 {
            return self;
        }
        let (p, q) = (self.first(), other.first());
        let last = if self.last > other.last { self.last } else { other.last };
        NodeFilter { who: MIXED | if p < q { p } else { q }, last }
    }
}

/// Which of `count` things that lie one behind the other, at least one, has `i`: the last that begins at or before it. The
/// first begins at 0.
#[inline]
pub fn holder(count: u64, i: u32, begin: impl Fn(u32) -> u32) -> u32 {
    let (mut low, mut high) = (0, count as u32);
    while high - low > 1 {
        let middle = low + (high - low) / 2;
        if begin(middle) <= i { low = middle } else { high = middle }
    }
    low
}
