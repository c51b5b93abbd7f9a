//! Boxes in single precision, rounded outward, and a tree over many.

use bytemuck::{Pod, Zeroable};

/// Growth of a box, as a fraction of its largest coordinate. It covers all roundings by which
/// features that are farther apart than the distance of a query may be listed:
///
/// - 64 half ulps of a pair's extent, which replace a smaller tolerance, and 256 half ulps of a near
///   query: below 2^-44 of the largest coordinate;
/// - 1.9e-12 of a pair's size if a body turns;
/// - bounding volumes of one machine in single precision, by which pairs whose iterations ended are
///   found: some 2^-22.
const ROUNDED: f64 = 1.0 / (1 << 18) as f64;

/// A box: lower and upper corner.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct Bounds(pub [[f32; 3]; 2]);

impl Bounds {
    /// No point.
    pub const NOTHING: Bounds = Bounds([[f32::INFINITY; 3], [f32::NEG_INFINITY; 3]]);

    /// The points of a box, and all within `reach` of them; more by rounding.
    pub fn around([low, high]: [[f64; 3]; 2], reach: f64) -> Bounds {
        let largest = low.iter().chain(&high).fold(0.0f64, |most, x| most.max(x.abs()));
        // The smallest numbers have no fraction to grow by.
        let grown = (reach + ROUNDED * largest) * (1.0 + ROUNDED) + f64::from(f32::MIN_POSITIVE);
        Bounds([low.map(|x| below(x - grown)), high.map(|x| -below(-(x + grown)))])
    }

    pub fn union(self, other: Bounds) -> Bounds {
        let Bounds([low, high]) = self;
        let Bounds([other_low, other_high]) = other;
        Bounds([[0, 1, 2].map(|k| low[k].min(other_low[k])), [0, 1, 2].map(|k| high[k].max(other_high[k]))])
    }

    pub fn meets(&self, other: &Bounds) -> bool {
        (0..3).all(|k| self.0[0][k] <= other.0[1][k] && other.0[0][k] <= self.0[1][k])
    }
}

/// The largest single that is at most a number.
fn below(x: f64) -> f32 {
    let near = x as f32;
    if f64::from(near) > x { near.next_down() } else { near }
}

/// A tree over boxes that are neighbours in their order: node `i` of a level holds boxes `2i` and
/// `2i + 1` of the level below.
pub(crate) struct Tree(Vec<Vec<Bounds>>);

impl Tree {
    pub fn new(leaves: Vec<Bounds>) -> Tree {
        let mut levels = vec![leaves];
        while let Some(last) = levels.last().filter(|last| last.len() > 1) {
            let above = last.chunks(2).map(|pair| pair.iter().copied().fold(Bounds::NOTHING, Bounds::union));
            let above = above.collect();
            levels.push(above);
        }
        Tree(levels)
    }

    /// Whether a box meets one of the leaves that `accepts`.
    pub fn has(&self, of: &Bounds, accepts: impl Fn(usize) -> bool) -> bool {
        let mut stack = vec![(self.0.len() - 1, 0)];
        while let Some((level, at)) = stack.pop() {
            if !self.0[level].get(at).is_some_and(|node| node.meets(of)) {
                continue;
            }
            if level > 0 {
                stack.extend([(level - 1, 2 * at), (level - 1, 2 * at + 1)]);
            } else if accepts(at) {
                return true;
            }
        }
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_box_holds_its_points_and_those_within_reach() {
        for x in [0.0, 1.0, -1.0 / 3.0, 1e-300, f64::MIN_POSITIVE, 1e30, -1e140, 16_777_217.0] {
            for reach in [0.0, 1e-9, 0.25, 1e20, 1e200] {
                let Bounds([low, high]) = Bounds::around([[x; 3]; 2], reach);
                assert!(f64::from(low[0]) < x - reach || low[0] == f32::NEG_INFINITY, "{x} {reach}");
                assert!(f64::from(high[0]) > x + reach || high[0] == f32::INFINITY, "{x} {reach}");
            }
        }
    }

    #[test]
    fn boxes_grow_by_their_reach_and_little_more() {
        let at = |x: f64| Bounds::around([[x, 0.0, 0.0], [x + 1.0, 1.0, 1.0]], 0.5);
        assert!(at(0.0).meets(&at(2.0)) && at(2.0).meets(&at(0.0)));
        assert!(!at(0.0).meets(&at(2.001)));
        assert!(!Bounds::NOTHING.meets(&at(0.0)) && !Bounds::NOTHING.meets(&Bounds::NOTHING));
    }

    #[test]
    fn a_tree_finds_what_a_search_of_all_finds() {
        let mut state = 1u64;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            f64::from((state >> 40) as u32) / f64::from(1 << 24)
        };
        for count in [0, 1, 2, 3, 7, 8, 100] {
            let mut boxes = || {
                let low = [next(), next(), next()];
                Bounds::around([low, low.map(|x| x + 0.05)], 0.0)
            };
            let leaves: Vec<Bounds> = (0..count).map(|_| boxes()).collect();
            let tree = Tree::new(leaves.clone());
            for _ in 0..50 {
                let of = boxes();
                let odd = |at: usize| at % 2 == 1;
                let wanted = leaves.iter().enumerate().any(|(at, leaf)| odd(at) && leaf.meets(&of));
                assert_eq!(tree.has(&of, odd), wanted, "{count}");
            }
        }
    }
}
