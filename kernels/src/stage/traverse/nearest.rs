//! # Nearest: the tree → a bound of the least distance, and candidates for it
//! Paper    the thesis, section 6.2: separation distance prunes by the least found so far. Nearest
//!          first is after
//!          Larsen, Gottschalk, Lin and Manocha, "Fast proximity queries with swept sphere
//!          volumes", 1999: one walk of one core.
//! Launch   `sample`: a lane a sample, evenly spaced in leaf order, few and then more. Then
//!          `within`: a lane a leaf.
//! Reads    nodes, two siblings at once, with their filters. `sample` also faces and positions of
//!          the leaves that it reaches.
//! Writes   `sample`: the least distance of its pairs and of the round before. `within`: candidate
//!          pairs, the smaller index first,
//!          each once, in no order.
//! Before   all volumes are fitted and refitted. The words of the distances = 0.
//! After    pairs = {(a, b) : a < b, gap(volumes) ≤ bound, filters allow}.
//!          bound ≥ the least sampled distance, by the rounding of distances: see
//!          [`crate::prim::nearest::bound`].
//!          So every pair whose computed distance can be the least is a candidate.
//! Room     `pairs` may be too short: the counter goes on, the host grows it and runs again.
//! Departs  the bound of a launch comes from the launch before. So no answer, list or count depends
//!          on the order of lanes.
//! Cost     `sample`: one or two descents, and one or two pairs of triangles of 4,000 operations in
//!          f64.
//!          Most of many samples take one step. `within`: as `traverse_leaves` with volumes that
//!          are apart.

use super::per_leaf::{Wanted, of_leaves};
use crate::abi::{
    GRAFTED_ROOT, MOVING_ROOT, NONE, NearestArgs, Node, ROOT, Span, TraverseArgs, TraverseFlags, counter,
};
use crate::bv::Volume;
use crate::exec::{Block, Lane, Slot};
use crate::math::{Real, Vec3};
use crate::prim::nearest::{Nearest, bound};
use crate::queue::Stack;

/// Those not farther apart than a length.
#[derive(Clone, Copy)]
struct Within(f32);

impl Wanted for Within {
    #[inline(always)]
    fn wants<V: Volume>(self, own: &V, other: &V) -> bool {
        own.apart(other) <= self.0
    }
}

/// At least the largest coordinate of the scene. The root above a moving and a static tree has no
/// volume; its children have.
fn largest<V: Volume, B: Block>(block: &B, nodes: Span<Node<V>>, flags: TraverseFlags) -> f32 {
    let of = |node: u32| block.load(nodes, node).volume.reach();
    if flags.has(TraverseFlags::GRAFTED) { of(GRAFTED_ROOT).greater(of(MOVING_ROOT)) } else { of(ROOT) }
}

/// Candidates: one walk a leaf.
pub fn within<V: Volume, B: Block>(block: &mut B, args: &TraverseArgs<V>) {
    let best = args.counters.shortest(block, counter::SAMPLED_AGAIN);
    let bound = bound(best, largest(block, args.nodes, args.flags));
    // All lanes compute the same bound. The meeting point reconverges them after its branches.
    block.phase(|lane| lane.meet());
    of_leaves(block, args, Within(bound));
}

/// The start of a sample's walk.
#[derive(Clone, Copy)]
struct Search {
    /// The node of the sample's leaf.
    leaf: u32,
    /// The first siblings to test; [`NONE`] if there are none.
    root: u32,
    /// The least distance known.
    best: f64,
    /// At least the largest coordinate of the scene.
    largest: f32,
}

/// The corners of a triangle.
#[inline(always)]
fn corners<R: Real, V: Volume, L: Lane>(lane: &L, args: &NearestArgs<R, V>, triangle: u32) -> [Vec3<R>; 3] {
    lane.read(args.faces, triangle).map(|vertex| lane.read(args.positions, vertex).at)
}

/// One round of samples. Each searches its nearest triangle, unless that is certainly farther than
/// the known distance.
pub fn sample<R: Real, V: Volume, B: Block>(block: &mut B, args: &NearestArgs<R, V>) {
    let before = args.counters.shortest(block, args.from);
    let largest = largest(block, args.nodes, args.flags);
    let root = block.load(args.nodes, ROOT);
    // A leaf alone has no sibling.
    let root = if root.is_leaf() { NONE } else { root.link };
    let mut words = block.words();
    let mut lens = block.slot(0u32);
    let mut steps = block.slot(0u32);
    let leaves = args.leaf_nodes.len();
    let mut base = block.block() * block.lanes();
    let stride = block.blocks() * block.lanes();
    // As in `within`.
    block.phase(|lane| lane.meet());
    while base < args.samples {
        block.phase(|lane| {
            let i = base + lane.lane();
            if i < args.samples {
                // SAFETY: the lane's own words and length; a walk pushes one sibling a level and
                // leaves none.
                let stack = unsafe { Stack::new(words.of(lane), lens.of(lane)) };
                let leaf = lane.read(args.leaf_nodes, (i as u64 * leaves / args.samples as u64) as u32);
                let best =
                    search(lane, args, Search { leaf, root, best: before, largest }, stack, steps.of(lane));
                // One lane reports the distance known before for all.
                if best < before || i == 0 {
                    args.counters.shorten(lane, args.to, best);
                }
            }
            lane.meet();
        });
        base += stride;
    }
    block.phase(|lane| lane.meet());
    let sum = block.scan(&mut steps);
    args.counters.add_once(block, counter::STEPS, sum as u64);
}

/// The least distance from the leaf's triangle to the triangles that its walk measures, if less
/// than `best`; else `best`. The number of measurements is limited. The nearer of two siblings
/// comes first.
#[inline]
fn search<R: Real, V: Volume, L: Lane>(
    lane: &L,
    args: &NearestArgs<R, V>,
    from: Search,
    mut stack: Stack,
    steps: &mut u32,
) -> f64 {
    let Search { leaf, root, mut best, largest } = from;
    let node = lane.read(args.nodes, leaf);
    let filter = args.filters.of(lane, leaf);
    let own = corners(lane, args, node.triangle());
    let mut most = bound(best, largest);
    let mut next = root;
    let (mut measures, last) = (args.measures, *steps + args.steps);
    while next != NONE && measures > 0 && *steps < last {
        *steps += 1;
        let siblings = [lane.read(args.nodes, next), lane.read(args.nodes, next + 1)];
        let allowed = |k: u32| {
            let other = args.filters.of(lane, next + k);
            args.filters.allows(lane, filter, other) && !args.filters.leaves_out(lane, filter, other)
        };
        let allowed = [allowed(0), allowed(1)];
        let gaps = siblings.map(|sibling| node.volume.apart(&sibling.volume));
        let mut inner = [false; 2];
        let mut k = 0;
        while k < 2 {
            let wanted = allowed[k] && gaps[k] <= most;
            if wanted && siblings[k].is_leaf() {
                measures = measures.saturating_sub(1);
                // In the order in which the pair will be measured again: the other order may round
                // to less.
                let (triangle, other) = (siblings[k].triangle(), corners(lane, args, siblings[k].triangle()));
                let (p, q) = if node.triangle() < triangle { (own, other) } else { (other, own) };
                let found = Nearest::of(&p, &q).distance;
                if found < best {
                    best = found;
                    most = bound(best, largest);
                }
            }
            inner[k] = wanted && !siblings[k].is_leaf();
            k += 1;
        }
        let [left, right] = [siblings[0].link, siblings[1].link];
        next = match inner {
            [true, true] => {
                let (near, far) = if gaps[1] < gaps[0] { (right, left) } else { (left, right) };
                stack.push(far);
                near
            }
            [true, false] => left,
            [false, true] => right,
            [false, false] => stack.pop().unwrap_or(NONE),
        };
    }
    // The rest of the stack is dropped: the next walk uses it.
    stack.clear();
    best
}
