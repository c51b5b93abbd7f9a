//! Oriented boxes of the tiles of meshes, about as small as can be. Fitted once, on the host.

use nearmiss_kernels::abi::{MeshLeaf, MeshTriangle, NONE, TileBox};
use nearmiss_kernels::bv::Obb;
use nearmiss_kernels::bvh::tiles::TILE;
use nearmiss_kernels::math::Vec3;
use rayon::prelude::*;

type Vector = Vec3<f64>;

/// The tangent of half of the first turn, and of the last one: 28 and 0.9 degrees. A cost; no answer
/// depends on it.
const FIRST_TURN: f64 = 0.25;
const LAST_TURN: f64 = 1.0 / 128.0;
/// Most turns that are tried at one angle.
const MOST_TURNS: u32 = 24;

/// Fits a box to each tile: of its triangles' corners, as they are stored. Tiles that are `refitted`
/// have one around everything.
pub fn fit(triangles: &[MeshTriangle], leaves: &[MeshLeaf], refitted: &[u32]) -> Vec<TileBox> {
    let tiles = triangles.par_chunks(TILE as usize).zip(leaves.par_chunks(TILE as usize));
    let mut all: Vec<TileBox> = tiles.map(|(triangles, leaves)| of_tile(triangles, leaves)).collect();
    refitted.iter().for_each(|&tile| all[tile as usize] = TileBox::EVERYTHING);
    all
}

fn of_tile(triangles: &[MeshTriangle], leaves: &[MeshLeaf]) -> TileBox {
    let filled = triangles.iter().zip(leaves).filter(|(_, leaf)| leaf.number != NONE);
    let mut points: Vec<[f32; 3]> = filled.flat_map(|(triangle, _)| triangle.corners).collect();
    // Most corners are those of several triangles.
    points.sort_unstable_by_key(|p| p.map(f32::to_bits));
    points.dedup_by_key(|p| p.map(f32::to_bits));
    let corners: Vec<Vec3<f32>> = points.iter().map(|&p| Vec3(p)).collect();
    if corners.is_empty() {
        return TileBox::EVERYTHING;
    }
    let axes = Obb::of(&corners[..]).axes().map(Vec3::wide);
    let [x, y, _] = smallest(&points, axes).map(|a| a.narrow().0);
    TileBox::around(&points, [x, y])
}

/// Half of the surface of a box with these extents.
fn surface([x, y, z]: [f64; 3]) -> f64 {
    x * y + y * z + z * x
}

/// The extent of points along an axis.
fn extent(points: &[[f32; 3]], axis: Vector) -> f64 {
    let (mut lo, mut hi) = (f64::INFINITY, f64::NEG_INFINITY);
    for &p in points {
        let at = axis.dot(Vec3(p).wide());
        (lo, hi) = (lo.min(at), hi.max(at));
    }
    hi - lo
}

/// Turns axes as long as the box around the points has less surface for it: about each axis, by
/// angles that shrink.
fn smallest(points: &[[f32; 3]], mut axes: [Vector; 3]) -> [Vector; 3] {
    let mut extents = axes.map(|axis| extent(points, axis));
    let mut tangent = FIRST_TURN;
    while tangent >= LAST_TURN {
        let (mut about, mut idle, mut tried) = (0, 0, 0);
        while idle < 3 && tried < MOST_TURNS {
            let (i, j) = ((about + 1) % 3, (about + 2) % 3);
            let turned = [tangent, -tangent].map(|t| turned(points, [axes[i], axes[j]], t));
            let with = |[p, q]: [f64; 2]| {
                let mut all = extents;
                (all[i], all[j]) = (p, q);
                surface(all)
            };
            let better = if with(turned[1].1) < with(turned[0].1) { turned[1] } else { turned[0] };
            if with(better.1) < surface(extents) {
                ([axes[i], axes[j]], [extents[i], extents[j]]) = better;
                idle = 0;
            } else {
                idle += 1;
            }
            (about, tried) = ((about + 1) % 3, tried + 1);
        }
        tangent *= 0.5;
    }
    axes
}

/// Two axes turned in their plane, by the tangent of half of the angle, and the extents along them.
fn turned(points: &[[f32; 3]], [x, y]: [Vector; 2], tangent: f64) -> ([Vector; 2], [f64; 2]) {
    let by = 1.0 / (1.0 + tangent * tangent);
    let (cos, sin) = ((1.0 - tangent * tangent) * by, 2.0 * tangent * by);
    let axes = [x * cos + y * sin, y * cos - x * sin];
    (axes, axes.map(|axis| extent(points, axis)))
}

#[cfg(test)]
mod tests {
    use super::super::mesh::MeshTiles;
    use super::*;
    use crate::samples::soup;

    /// Checks that each box holds the corners of its tile's triangles.
    fn check(tiles: &MeshTiles, boxes: &[TileBox]) -> Result<(), String> {
        for (place, triangle) in tiles.triangles.iter().enumerate() {
            let (tile, is_filled) = (place / TILE as usize, tiles.leaves[place].number != NONE);
            if is_filled && !triangle.corners.iter().all(|&p| boxes[tile].holds(p)) {
                return Err(format!("the box of tile {tile} does not hold place {place}"));
            }
        }
        Ok(())
    }

    #[test]
    fn every_box_holds_its_triangles_and_one_that_does_not_is_named() {
        for count in [1, 31, 1_848] {
            let body = soup(count, 5, false);
            let tiles = MeshTiles::new(body.elements(), body.positions_t0());
            let boxes = fit(&tiles.triangles, &tiles.leaves, &[]);
            assert_eq!(boxes.len(), tiles.tiles.len());
            assert_eq!(check(&tiles, &boxes), Ok(()), "{count} triangles");
            let faults: [fn(&mut TileBox); 4] = [
                |own| own.half = own.half.map(|half| 0.9999 * half),
                |own| own.centre[0] += 1e-3 * own.half.into_iter().fold(0.0, f32::max),
                |own| own.axes = own.axes.map(|axis| axis.map(|x| 1.01 * x)),
                |own| own.half = [0.0; 3],
            ];
            for (i, fault) in faults.into_iter().enumerate() {
                let mut boxes = boxes.clone();
                let last = boxes.len() - 1;
                fault(&mut boxes[last]);
                let error = check(&tiles, &boxes).expect_err("a box that is too small");
                assert!(error.contains(&format!("tile {last} ")), "fault {i}: {error}");
            }
        }
    }

    #[test]
    fn boxes_of_refitted_tiles_are_around_everything() {
        let body = soup(100, 6, false);
        let tiles = MeshTiles::new(body.elements(), body.positions_t0());
        let boxes = fit(&tiles.triangles, &tiles.leaves, &[0, 2]);
        let is_everything = |own: &TileBox| *own == TileBox::EVERYTHING;
        assert_eq!(boxes.iter().map(is_everything).collect::<Vec<_>>(), [true, false, true, false]);
    }

    #[test]
    fn a_turned_plate_has_a_flat_box() {
        let across = |x: f32, y: f32| [x + y, x - y, 0.5 * x];
        let corner = |k: usize| across((k % 6) as f32, (k / 6 % 5) as f32);
        let of =
            |k: usize| MeshTriangle { corners: [corner(k), corner(k + 7), corner(k + 11)], vertices: [0; 3] };
        let triangles: Vec<MeshTriangle> = (0..32).map(of).collect();
        let leaf = |number: u32| MeshLeaf { number, ..MeshLeaf::default() };
        let leaves: Vec<MeshLeaf> = (0..32).map(leaf).collect();
        let half = fit(&triangles, &leaves, &[])[0].half;
        assert!(half.iter().any(|&h| h < 1e-3), "{half:?}");
    }
}
