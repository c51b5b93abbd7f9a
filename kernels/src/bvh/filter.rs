//! Collision filters of bodies on nodes: the pairs of nodes that are allowed. A node has the filter
//! of the bodies below it, as far as they share one.
//!
//! Triangles that share a vertex are no candidates, unless a query keeps adjacent pairs. A vertex
//! of many faces is a *hub*. Each of its triangles names at most one hub among its corners. Two
//! nodes whose triangles all name the same hub have no pair. So `n` faces round one hub cost `n`
//! tests, not `n²`. A query that keeps adjacent pairs has no hubs.

use crate::abi::{BodyRecord, EVERY, FilterArgs, MIXED, NodeFilter, SELF_CONTACT, Span};
use crate::exec::Lane;

impl FilterArgs {
    /// No filters.
    pub const NONE: FilterArgs =
        FilterArgs { nodes: Span::EMPTY, bodies: Span::EMPTY, left_out: Span::EMPTY };

    /// The filter of a node; that of a body tested against itself if the scene has no filters.
    #[inline(always)]
    pub fn of<L: Lane>(&self, lane: &L, node: u32) -> NodeFilter {
        if self.nodes.is_empty() {
            NodeFilter { who: SELF_CONTACT, ..NodeFilter::default() }
        } else {
            lane.read(self.nodes, node)
        }
    }

    /// Whether triangles below one node may meet triangles below the other. Two bodies must share
    /// an environment, or one is in every environment. Each must be in a group that the other
    /// meets. A body meets itself by its own flag, for any groups. Pairs of bodies that are left out
    /// are not looked up: see [`FilterArgs::leaves_out`]. A refusal for two nodes holds for all below
    /// them: environments are ranges of leaves, and a hub of a node is one of all below it.
    #[inline(always)]
    pub fn allows<L: Lane>(&self, lane: &L, p: NodeFilter, q: NodeFilter) -> bool {
        if self.nodes.is_empty() {
            return true;
        }
        // A vertex is of one body, so nothing else can be below these two nodes.
        if (p.hub == q.hub) & (p.hub != 0) {
            return false;
        }
        let mixed = (p.who | q.who) & MIXED != 0;
        if !mixed & (p.who == q.who) {
            return p.who & SELF_CONTACT != 0;
        }
        let shared = (p.first() <= q.last) & (q.first() <= p.last);
        let together = shared | (p.last == EVERY) | (q.last == EVERY);
        if !together | mixed | self.bodies.is_empty() {
            return together;
        }
        let [p, q] = [p, q].map(|filter| lane.read(self.bodies, filter.who & NodeFilter::NUMBER));
        (p.group & q.mask != 0) & (q.group & p.mask != 0)
    }

    /// Whether two nodes are of one body each, and these are a pair that is left out. Walks that do
    /// not look it up list candidates of such a pair, and [`crate::stage::traverse::left_out`] drops
    /// them.
    #[inline(always)]
    pub fn leaves_out<L: Lane>(&self, lane: &L, p: NodeFilter, q: NodeFilter) -> bool {
        !self.left_out.is_empty()
            && (p.who | q.who) & MIXED == 0
            && listed(lane, self.left_out, [p, q].map(|filter| filter.who & NodeFilter::NUMBER))
    }
}

impl NodeFilter {
    /// The first environment.
    #[inline(always)]
    fn first(self) -> u32 {
        if self.who & MIXED != 0 { self.who & NodeFilter::NUMBER } else { self.last }
    }

    /// Whether two triangles below it may meet: of several bodies, or of one that is tested against
    /// itself, without a common hub.
    #[inline(always)]
    pub fn self_collides(self) -> bool {
        (self.hub == 0) & (self.who & (MIXED | SELF_CONTACT) != 0)
    }

    /// The filter of a leaf of a body with this hub, see [`NodeFilter::hub`].
    #[inline]
    pub fn leaf(body: u32, record: &BodyRecord, hub: u32) -> NodeFilter {
        let own = if record.self_collision != 0 { SELF_CONTACT } else { 0 };
        NodeFilter { who: body | own, last: record.environment, hub, pad: 0 }
    }

    /// The filter of a node above both.
    #[inline]
    pub fn above(self, other: NodeFilter) -> NodeFilter {
        let hub = if self.hub == other.hub { self.hub } else { 0 };
        if self.who == other.who && self.who & MIXED == 0 {
            return NodeFilter { hub, ..self };
        }
        let (p, q) = (self.first(), other.first());
        let last = if self.last > other.last { self.last } else { other.last };
        NodeFilter { who: MIXED | if p < q { p } else { q }, last, hub, pad: 0 }
    }
}

/// [`is_left_out`] of a list on the device. Out of line, so that scenes without a list have no more
/// instructions in their loops.
#[inline(never)]
fn listed<L: Lane>(lane: &L, list: Span<u32>, [p, q]: [u32; 2]) -> bool {
    is_left_out(p, q, |i| lane.read(list, i))
}

/// Whether the list of pairs that are left out has two bodies: see [`FilterArgs::left_out`]. No body
/// is left out with itself. `word` returns a word of the list. Cost: a binary search in the pairs of
/// the smaller number.
#[inline(always)]
pub fn is_left_out(p: u32, q: u32, word: impl Fn(u32) -> u32) -> bool {
    let (body, other) = if p < q { (p, q) } else { (q, p) };
    has(other, [word(body), word(body + 1)], word)
}

/// Whether the words from the first place to before the second, which ascend, have a number.
#[inline(always)]
pub fn has(number: u32, [mut low, mut high]: [u32; 2], word: impl Fn(u32) -> u32) -> bool {
    while low < high {
        let middle = low + (high - low) / 2;
        let listed = word(middle);
        if listed == number {
            return true;
        }
        if listed < number { low = middle + 1 } else { high = middle }
    }
    false
}

/// The number of the group that has item `i`, of `count` ≥ 1 contiguous groups: the last that
/// begins at or before `i`. The first begins at 0.
#[inline]
pub fn holder(count: u64, i: u32, begin: impl Fn(u32) -> u32) -> u32 {
    let (mut low, mut high) = (0, count as u32);
    while high - low > 1 {
        let middle = low + (high - low) / 2;
        if begin(middle) <= i { low = middle } else { high = middle }
    }
    low
}
