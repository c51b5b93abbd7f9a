//! Division of work among devices.

use crate::pipeline::Share;

/// Least cost of a tile, relative to the mean, so that no tile is free.
const LEAST: f64 = 0.01;

/// Cuts tiles of these costs into parts of about the same cost. Returns the cuts, one more than
/// parts, ascending, from none to all.
pub fn cuts(costs: &[f64], parts: usize) -> Vec<u64> {
    let tiles = costs.len() as u64;
    let sum: f64 = costs.iter().sum();
    let least = LEAST * sum / tiles.max(1) as f64;
    let total = sum + least * tiles as f64;
    let (mut cuts, mut tile, mut before) = (vec![0], 0u64, 0.0);
    for part in 1..parts {
        let wanted = total * part as f64 / parts as f64;
        while tile < tiles && before + 0.5 * (costs[tile as usize] + least) < wanted {
            before += costs[tile as usize] + least;
            tile += 1;
        }
        // The least part that begins with that tile.
        cuts.push((tile * Share::ALL).div_ceil(tiles.max(1)).min(Share::ALL));
    }
    cuts.push(Share::ALL);
    cuts
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tiles(cuts: &[u64], count: u32) -> Vec<std::ops::Range<u32>> {
        cuts.windows(2).map(|ends| Share { from: ends[0], to: ends[1] }.of(count)).collect()
    }

    #[test]
    fn work_is_cut_where_it_is_even() {
        assert_eq!(tiles(&cuts(&[1.0; 12], 3), 12), [0..4, 4..8, 8..12]);
        assert_eq!(tiles(&cuts(&[9.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0], 2), 10), [0..1, 1..10]);
        // More devices than tiles, tiles without cost, and no tiles.
        assert_eq!(tiles(&cuts(&[1.0], 3), 1).iter().map(|share| share.len()).sum::<usize>(), 1);
        assert_eq!(tiles(&cuts(&[0.0; 4], 2), 4), [0..0, 0..4]);
        assert_eq!(tiles(&cuts(&[], 2), 0), [0..0, 0..0]);
    }

    #[test]
    fn shares_leave_no_tile_out_and_have_none_twice() {
        for count in [1u32, 2, 31, 1000, 312_500, u32::MAX / 32] {
            for parts in [1, 2, 3, 7, 64] {
                let part = |k: u64| k * Share::ALL / parts;
                let mut end = 0;
                for k in 0..parts {
                    let own = Share { from: part(k), to: part(k + 1) }.of(count);
                    assert_eq!(own.start, end, "{count} tiles, {parts} parts");
                    end = own.end;
                }
                assert_eq!(end, count);
            }
        }
    }

    #[test]
    fn a_cut_begins_with_the_tile_that_it_names() {
        let costs: Vec<f64> = (0..313_007).map(|tile| f64::from(tile % 7)).collect();
        for parts in [2, 3, 8] {
            let own = tiles(&cuts(&costs, parts), costs.len() as u32);
            assert_eq!(own.iter().map(|share| share.len()).sum::<usize>(), costs.len());
            let sums = own.iter().map(|own| costs[own.start as usize..own.end as usize].iter().sum::<f64>());
            let whole: f64 = costs.iter().sum();
            assert!(sums.into_iter().all(|sum| (sum * parts as f64 / whole - 1.0).abs() < 0.001));
        }
    }
}
