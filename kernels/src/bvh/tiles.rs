//! Tiles and the nodes above them: their layout, their invariants, and a checker that names the
//! broken one.

use super::Violation;
use crate::abi::{LEAF, NONE, Node, NodeFilter};
use crate::bv::{Contain, Volume};
use crate::math::Vec3;

/// Triangles of a tile: as many as a warp has lanes.
pub const TILE: u32 = 32;
/// Nodes below a node.
pub const FAN: u32 = 16;
/// Levels at most: 2^32 triangles have 2^27 tiles, and the top level at most [`MOST_TOPS`] nodes.
pub const MOST_LEVELS: u32 = 6;
/// Most nodes of the top level, unless there are two levels. A warp tests all of them, 32 at once
/// (measured, `benches/NOTES.md`).
pub const MOST_TOPS: u32 = 1024;
const FAN_BITS: u32 = FAN.trailing_zeros();
const _: () = assert!(FAN.is_power_of_two() && MOST_TOPS << (FAN_BITS * (MOST_LEVELS - 1)) >= 1 << 27);

/// Tiles below a node of a level.
pub const fn below(level: u32) -> u32 {
    1 << (FAN_BITS * level)
}

/// Layout of tiles and of the nodes above them: level by level, tiles first. Within a level moving
/// tiles come first, then fixed ones. The two have separate nodes on every level.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Levels {
    /// How many levels there are: at least 2, the tiles one of them.
    pub count: u32,
    /// Nodes of the top level above moving tiles, and above fixed ones.
    pub tops: [u32; 2],
}

/// Nodes of a level above one of the two parts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Part {
    /// The first.
    pub first: u32,
    /// How many have something below them.
    pub count: u32,
}

impl Levels {
    /// The levels for so many moving and so many fixed triangles.
    pub fn of(triangles: [u32; 2]) -> Levels {
        let mut count = 2;
        loop {
            let tops = triangles.map(|n| n.div_ceil(TILE).div_ceil(below(count - 1)));
            if count == MOST_LEVELS || tops[0] + tops[1] <= MOST_TOPS {
                return Levels { count, tops };
            }
            count += 1;
        }
    }

    /// How many bits lower the number of a tile's node of the top level is than the tile's.
    pub fn shift(&self) -> u32 {
        FAN_BITS * (self.count - 1)
    }

    /// The first node of a level; of as many as there are levels, how many nodes there are.
    pub fn first(&self, level: u32) -> u32 {
        (0..level).map(|level| self.width(level, 2)).sum()
    }

    /// Nodes of a level above the first so many parts.
    fn width(&self, level: u32, parts: usize) -> u32 {
        self.tops[..parts].iter().sum::<u32>() * below(self.count - 1 - level)
    }

    /// The nodes of a level above a part of so many triangles.
    pub fn part(&self, level: u32, part: usize, triangles: u32) -> Part {
        let count = triangles.div_ceil(TILE).div_ceil(below(level));
        Part { first: self.first(level) + self.width(level, part), count }
    }

    /// Places for leaves.
    pub fn leaves(&self) -> u32 {
        self.width(0, 2) * TILE
    }
}

/// Tiles on the host, to be checked.
#[derive(Clone, Copy)]
pub struct Tiles<'a, V> {
    /// The layout.
    pub levels: Levels,
    /// Moving triangles, and fixed ones.
    pub triangles: [u32; 2],
    /// Places for triangles, tile by tile.
    pub leaves: &'a [Node<V>],
    /// The nodes.
    pub nodes: &'a [Node<V>],
    /// The filter of the triangles below each node; empty without filters.
    pub filters: &'a [NodeFilter],
}

/// Checks tiles. Each triangle has one place, in its part. Volumes of triangles are those of
/// `leaf`; every other is the merge of those below it. Filters likewise, with `whose` for a
/// triangle's. `place` returns the part of a triangle and its number there. `seen` has a false flag
/// for each triangle. Cost: linear.
///
/// # Errors
/// The first violation, from the first leaf on; nodes and leaves are counted in memory order.
pub fn check<V: Volume>(
    tiles: &Tiles<V>,
    place: impl Fn(u32) -> Option<(usize, usize)>,
    leaf: impl Fn(u32) -> V,
    whose: impl Fn(u32) -> NodeFilter,
    seen: [&mut [bool]; 2],
) -> Result<(), Violation> {
    let Tiles { levels, triangles, leaves, nodes, filters } = *tiles;
    let all = levels.first(levels.count) as usize;
    let sound = levels == Levels::of(triangles)
        && leaves.len() == levels.leaves() as usize
        && nodes.len() == all
        && (filters.is_empty() || filters.len() == all);
    if !sound {
        return Err(Violation::Levels);
    }
    for (at, seen) in seen.into_iter().enumerate() {
        let first = levels.part(0, at, triangles[at]).first * TILE;
        for i in 0..levels.part(1, at, triangles[at]).count * FAN * TILE {
            let node = &leaves[(first + i) as usize];
            let (exists, last) = (i < triangles[at], first + triangles[at] - 1);
            // Behind the last one it is there again, as nothing.
            let triangle = leaves[(first + i).min(last) as usize].triangle();
            let known = if exists {
                let own = place(triangle).filter(|&(part, _)| part == at);
                own.and_then(|(_, k)| seen.get_mut(k)).is_some_and(|seen| !core::mem::replace(seen, true))
            } else {
                node.link == NONE
            };
            if !known || !node.is_leaf() || node.last != first + i {
                return Err(Violation::Leaf { leaf: first + i });
            }
            if node.volume != leaf(triangle) {
                return Err(Violation::Fit { node: first + i });
            }
        }
        if let Some(missing) = seen.iter().position(|seen| !seen) {
            return Err(Violation::Leaf { leaf: first + missing as u32 });
        }
    }
    (0..levels.count).try_for_each(|level| {
        check_level(tiles, level, 0, &whose)?;
        check_level(tiles, level, 1, &whose)
    })
}

/// Checks that the volume of every triangle, and of every node above it, holds its three corners. A
/// corner moves from the first to the second of its `ends`. Exact, by arithmetic that no builder
/// has. Cost: linear, levels times.
///
/// # Errors
/// The first violation, from the first leaf and its own volume on.
pub fn check_held<V: Contain>(
    tiles: &Tiles<V>,
    ends: impl Fn(u32) -> [[Vec3<f64>; 2]; 3],
) -> Result<(), Violation> {
    let Tiles { levels, triangles, leaves, nodes, .. } = *tiles;
    for (at, &count) in triangles.iter().enumerate() {
        for i in 0..count {
            let leaf = levels.part(0, at, count).first * TILE + i;
            let own = &leaves[leaf as usize];
            let ends = ends(own.triangle());
            let above = (0..levels.count).map(|level| {
                let node = levels.part(level, at, count).first + i / (TILE * below(level));
                &nodes[node as usize].volume
            });
            let outside = |volume: &V| ends.iter().any(|&[t0, t1]| !volume.holds(t0, t1));
            if let Some(level) = core::iter::once(&own.volume).chain(above).position(outside) {
                return Err(Violation::Outside { leaf, level: level as u32 });
            }
        }
    }
    Ok(())
}

/// Checks the nodes of a level above a part.
fn check_level<V: Volume>(
    tiles: &Tiles<V>,
    level: u32,
    at: usize,
    whose: &impl Fn(u32) -> NodeFilter,
) -> Result<(), Violation> {
    let Tiles { levels, triangles, leaves, nodes, filters } = *tiles;
    let own = levels.part(level, at, triangles[at]);
    for i in 0..own.count {
        let node = own.first + i;
        let last = (node - levels.first(level) + 1) * below(level) - 1;
        let mut volumes = [V::zeroed(); TILE as usize];
        let (link, each, filter) = if level == 0 {
            let first = node * TILE;
            let leaf = |k: u32| &leaves[(first + k) as usize];
            (0..TILE).for_each(|k| volumes[k as usize] = leaf(k).volume);
            let all = (0..TILE).map(leaf).filter(|leaf| leaf.link != NONE).map(|leaf| whose(leaf.triangle()));
            (LEAF | node, TILE, all.reduce(NodeFilter::above))
        } else {
            let below = levels.part(level - 1, at, triangles[at]);
            let first = below.first + i * FAN;
            // Above tiles those behind the last one are there, too.
            let end = if level == 1 { first + FAN } else { (first + FAN).min(below.first + below.count) };
            (0..FAN).for_each(|k| volumes[k as usize] = nodes[(first + k).min(end - 1) as usize].volume);
            let exist = first..(first + FAN).min(below.first + below.count);
            (first, FAN, exist.filter_map(|k| filters.get(k as usize).copied()).reduce(NodeFilter::above))
        };
        let mut width = each as usize / 2;
        while width > 0 {
            (0..width).for_each(|k| volumes[k] = volumes[k].merge(&volumes[k + width]));
            width /= 2;
        }
        if nodes[node as usize] != (Node { volume: volumes[0], link, last }) {
            return Err(Violation::Merge { node });
        }
        if filters.get(node as usize).is_some_and(|&own| Some(own) != filter) {
            return Err(Violation::Filter { node });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_level_more_begins_where_the_top_would_be_too_wide() {
        let of = |moving, fixed| Levels::of([moving, fixed]);
        assert_eq!(of(1, 0), Levels { count: 2, tops: [1, 0] });
        assert_eq!(of(512, 1), Levels { count: 2, tops: [1, 1] });
        let most = MOST_TOPS * FAN * TILE;
        assert_eq!(of(most, 0), Levels { count: 2, tops: [1024, 0] });
        assert_eq!(of(most, 1), Levels { count: 3, tops: [64, 1] });
        assert_eq!(of(10_000_000, 0), Levels { count: 4, tops: [77, 0] });
        // The most triangles that can be counted have as many levels as there may be at most.
        let all = of(u32::MAX / 2, 0);
        assert!(all.count <= MOST_LEVELS && all.tops[0] <= MOST_TOPS, "{all:?}");
    }

    #[test]
    fn levels_lie_one_behind_the_other_and_parts_in_them() {
        let triangles = [600_000, 40_000];
        let levels = Levels::of(triangles);
        assert_eq!(levels, Levels { count: 3, tops: [74, 5] });
        let first = [0, 1, 2, 3].map(|level| levels.first(level));
        assert_eq!(first, [0, 79 * 256, 79 * 256 + 79 * 16, 79 * 256 + 79 * 16 + 79]);
        assert_eq!(levels.part(0, 0, triangles[0]), Part { first: 0, count: 18_750 });
        assert_eq!(levels.part(0, 1, triangles[1]), Part { first: 74 * 256, count: 1_250 });
        assert_eq!(levels.part(1, 1, triangles[1]), Part { first: first[1] + 74 * 16, count: 79 });
        assert_eq!(levels.part(2, 1, triangles[1]), Part { first: first[2] + 74, count: 5 });
        assert_eq!((levels.shift(), levels.leaves()), (8, 79 * 256 * TILE));
    }
}
