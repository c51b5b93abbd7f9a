//! # Answer, groups: rows → the rows of each feature
//! Paper    not in the paper.
//! Launch   `keys`: a lane a row that there is room for; then passes of the radix sort; `groups`: a
//!          lane a key or a feature. Grids of any size stride.
//! Reads    rows, faces or edges; sorted keys.
//! Writes   keys and counts of their lowest bytes; starts and rows.
//! Before   lists are complete, counts = 0; `groups`: keys ascend.
//! After    rows\[starts\[f\]\] to rows\[starts\[f + 1\] - 1\] = the rows of feature f, ascending, each
//!          once. The sort is stable, and keys are written in the order of rows.
//! Room     `width` keys for each row that there is room for.
//! Cost     `keys`: 32 B a row, 16 B indices, 8 B and an atomic a key. `groups`: 8 B in and 4 B out a
//!          key, a binary search a feature.

use super::{Count, corners};
use crate::abi::{AnswerGroupsArgs, AnswerKeysArgs, AnswerRows, Feature, Name, Named, by};
use crate::exec::{BINS, Block, Lane};
use crate::sort::tally;

/// Most keys of a row: the corners of two triangles.
const MOST: usize = 6;
/// No feature.
const NONE: u32 = u32::MAX;

/// A key of each feature of each row.
pub fn keys<T: Named, B: Block>(block: &mut B, args: &AnswerKeysArgs<T>) {
    let count = Count::of(block, &args.rows);
    let room = args.keys.len() as u32 / args.width;
    let stride = block.blocks() * block.lanes();
    block.phase(|lane| {
        let mut row = lane.global();
        while row < room {
            let mut features = [NONE; MOST];
            if row < count.all {
                let contact = count.get(lane, &args.rows, row);
                let name = count.name(lane, &args.rows, row, &contact);
                features = features_of(lane, &args.rows, &name, args.by);
            }
            let mut k = 0;
            while k < args.width {
                let feature = features[k as usize % MOST];
                let is_used = feature != NONE && is_first(&features, k as usize);
                let [feature, row_or_none] = if is_used { [feature, row] } else { [args.features, NONE] };
                let place = row * args.width + k;
                lane.write(args.keys, place, (feature as u64) << 32 | row_or_none as u64);
                tally(lane, &args.tiles, place, feature & (BINS - 1));
                k += 1;
            }
            row = row.saturating_add(stride);
        }
    });
}

/// Starts of features, and rows.
pub fn groups<B: Block>(block: &mut B, args: &AnswerGroupsArgs) {
    let (keys, starts) = (args.keys.len() as u32, args.starts.len() as u32);
    let stride = block.blocks() * block.lanes();
    block.phase(|lane| {
        let mut at = lane.global();
        while at < keys {
            lane.write(args.rows, at, lane.read(args.keys, at) as u32);
            at = at.saturating_add(stride);
        }
        let mut feature = lane.global();
        while feature < starts {
            let (mut low, mut high) = (0, keys);
            while low < high {
                let middle = low + (high - low) / 2;
                if ((lane.read(args.keys, middle) >> 32) as u32) < feature {
                    low = middle + 1;
                } else {
                    high = middle;
                }
            }
            lane.write(args.starts, feature, low);
            feature = feature.saturating_add(stride);
        }
    });
}

/// Whether a feature is not among those before it.
#[inline(always)]
fn is_first(features: &[u32; MOST], k: usize) -> bool {
    let (mut is_first, mut other) = (true, 0);
    while other < MOST {
        is_first &= other >= k || features[other] != features[k % MOST];
        other += 1;
    }
    is_first
}

/// The features of a row, see [`by`]; the rest is [`NONE`].
#[inline(always)]
fn features_of<T: Named, L: Lane>(lane: &L, rows: &AnswerRows<T>, name: &Name, by: u32) -> [u32; MOST] {
    let [p, q] = name.features;
    let wanted = match by {
        by::VERTEX => Feature::VERTEX,
        by::EDGE => Feature::EDGE,
        by::FACE => Feature::TRIANGLE,
        _ if T::OF_FEATURES => {
            let [w, x, y, z] = corners(lane, rows, name);
            return [w, x, y, z, NONE, NONE];
        }
        _ => {
            let ([u, v, w], [x, y, z]) = (lane.read(rows.faces, p), lane.read(rows.faces, q));
            return [u, v, w, x, y, z];
        }
    };
    let own = |k: usize, feature: u32| if name.of[k] == wanted { feature } else { NONE };
    // Rows with one such feature have one key.
    let [x, y] = [own(0, p), own(1, q)];
    let [x, y] = if x == NONE { [y, NONE] } else { [x, y] };
    [x, y, NONE, NONE, NONE, NONE]
}
