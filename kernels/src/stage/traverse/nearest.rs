//! # Nearest: the tree → a bound of the least distance, and candidates for it
//! Paper    section 6.2, whose separation distance prunes by the least found so far; nearest first after Larsen, Gottschalk, Lin and
//!          Manocha, "Fast proximity queries with swept sphere volumes", 1999. Theirs is one walk of one core.
//! Launch   `sample`: a lane a sample, leaves that lie evenly in leaf order, few and then more. Then `within`: a lane a leaf.
//! Reads    nodes, two siblings at once, with their filters; `sample` also faces and positions of the leaves that it comes to.
//! Writes   `sample`: the least distance of its pairs and of the round before. `within`: candidate pairs, the smaller index first,
//!          each once, in no order.
//! Before   all volumes are fitted and refitted. The words of the distances are zero.
//! After    every pair of leaves whose bodies are asked about, and whose distance as it will be computed can be the least, is written:
//!          their volumes are no farther apart than the least of the samples, see [`crate::prim::nearest::bound`].
//! Room     `pairs` may be too short: the counter goes on, the host grows it and runs again.
//! Departs  the bound of a launch is what the launch before left, so that no answer, list or count hangs on who comes first.
//! Cost     `sample`: a way down the tree or two, and one pair of triangles or two of 4,000 operations in f64; of most of many samples no
//!          more than a step. `within`: as `traverse_leaves` of boxes that are apart.

use super::{Wanted, of_leaves};
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

/// At least the largest coordinate of everything. The root of a grafted tree and another's has no volume, but its children have.
fn largest<V: Volume, B: Block>(b: &B, nodes: Span<Node<V>>, flags: TraverseFlags) -> f32 {
    let of = |node: u32| b.load(nodes, node).volume.reach();
    if flags.has(TraverseFlags::GRAFTED) { of(GRAFTED_ROOT).greater(of(MOVING_ROOT)) } else { of(ROOT) }
}

/// Candidates: one walk a leaf.
pub fn within<V: Volume, B: Block>(b: &mut B, a: &TraverseArgs<V>) {
    let best = a.counters.shortest(b, counter::SAMPLED_AGAIN);
    let bound = bound(best, largest(b, a.nodes, a.flags));
    // All lanes come to the same bound; that they are together again behind its branches is not left to the assembler.
    b.phase(|l| l.meet());
    of_leaves(b, a, Within(bound));
}

/// The corners of a triangle.
#[inline(always)]
fn corners<R: Real, V: Volume, L: Lane>(l: &L, a: &NearestArgs<R, V>, triangle: u32) -> [Vec3<R>; 3] {
    l.read(a.faces, triangle).map(|vertex| l.read(a.positions, vertex).at)
}

/// One round of samples: each looks for its nearest triangle, unless that is certainly farther than what is known.
pub fn sample<R: Real, V: Volume, B: Block>(b: &mut B, a: &NearestArgs<R, V>) {
    let before = a.counters.shortest(b, a.from);
    let largest = largest(b, a.nodes, a.flags);
    let root = b.load(a.nodes, ROOT);
    // A leaf alone has nothing beside it.
    let root = if root.is_leaf() { NONE } else { root.link };
    let mut words = b.words();
    let mut lens = b.slot(0u32);
    let mut steps = b.slot(0u32);
    let leaves = a.leaf_nodes.len();
    let mut base = b.block() * b.lanes();
    let stride = b.blocks() * b.lanes();
    while base < a.samples {
        b.phase(|l| {
            let i = base + l.lane();
            if i < a.samples {
                // SAFETY: the lane's own words and length; a walk pushes one sibling a level, and ends with none.
                let stack = unsafe { Stack::new(words.of(l), lens.of(l)) };
                let leaf = l.read(a.leaf_nodes, (i as u64 * leaves / a.samples as u64) as u32);
                let best = seek(l, a, (leaf, root), (before, largest), (stack, steps.of(l)));
                // What was known before one of them tells for all.
                if best < before || i == 0 {
                    a.counters.shorten(l, a.to, best);
                }
            }
            l.meet();
        });
        base += stride;
    }
    let sum = b.scan(&mut steps);
    a.counters.add_once(b, counter::STEPS, sum as u64);
}

/// How far the triangle at a leaf's node is from those that it comes to, as many as it may measure, if that is less than `best`; else `best`.
/// The nearer of two siblings first.
#[inline]
fn seek<R: Real, V: Volume, L: Lane>(
    l: &L,
    a: &NearestArgs<R, V>,
    (leaf, root): (u32, u32),
    (mut best, largest): (f64, f32),
    (mut stack, steps): (Stack, &mut u32),
) -> f64 {
    let node = l.read(a.nodes, leaf);
    let filter = a.filters.of(l, leaf);
    let own = corners(l, a, node.triangle());
    let mut most = bound(best, largest);
    let mut next = root;
    let (mut measures, last) = (a.measures, *steps + a.steps);
    while next != NONE && measures > 0 && *steps < last {
        *steps += 1;
        let siblings = [l.read(a.nodes, next), l.read(a.nodes, next + 1)];
        let asked = |k: u32| a.filters.allows(l, filter, a.filters.of(l, next + k));
        let asked = [asked(0), asked(1)];
        let gaps = siblings.map(|sibling| node.volume.apart(&sibling.volume));
        let mut inner = [false; 2];
        let mut k = 0;
        while k < 2 {
            let wanted = asked[k] && gaps[k] <= most;
            if wanted && siblings[k].is_leaf() {
                measures = measures.saturating_sub(1);
                // In the order in which the pair will be measured again: the other way round it may round to less.
                let (triangle, other) = (siblings[k].triangle(), corners(l, a, siblings[k].triangle()));
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
    // What waits is left: the stack is the next walk's.
    stack.clear();
    best
}
