//! A mesh in its own frame: tiles of 32 triangles, and nodes above them. Built once, on the host.

use crate::mesh::Positions;
use nearmiss_kernels::abi::{MeshLeaf, MeshNode, MeshRecord, MeshTriangle, NONE, Point};
use nearmiss_kernels::bv::FrameBox;
use nearmiss_kernels::bvh::relation::corners_box;
use nearmiss_kernels::bvh::tiles::TILE;
use nearmiss_kernels::math::Vec3;

/// Triangles of a tile, and most nodes below a node.
const FAN: usize = TILE as usize;
/// At least the root of 3: a radius from the largest coordinate. Squares of large ones overflow.
const ROOT_3: f64 = 1.7321;

/// A mesh, with indices of its own.
pub struct MeshTiles {
    pub record: MeshRecord,
    /// Tiles, in order.
    pub tiles: Vec<MeshNode>,
    /// Nodes above tiles; the last is the root.
    pub above: Vec<MeshNode>,
    /// Whether the nodes below each of `above` are tiles.
    pub is_above_tiles: Vec<bool>,
    /// A triangle a place of a tile, and its box.
    pub triangles: Vec<MeshTriangle>,
    pub leaves: Vec<MeshLeaf>,
    /// The boxes by columns of a tile.
    pub columns: Vec<u32>,
    pub vertices: Vec<Point<f64>>,
    /// Levels of nodes above tiles.
    pub levels: u32,
}

/// Triangles below a node of a level; of level 0 a tile's.
fn capacity(level: u32) -> usize {
    FAN.saturating_pow(level + 1)
}

impl MeshTiles {
    /// Builds the tiles of a mesh with at least one triangle. Every vertex of a triangle is finite.
    pub fn new(faces: &[[u32; 3]], positions: &Positions) -> MeshTiles {
        let point = |v: u32| positions.get_f64(v as usize).unwrap_or_default();
        let (mut lo, mut hi) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for p in faces.iter().flatten().map(|&v| point(v)) {
            for k in 0..3 {
                (lo[k], hi[k]) = (lo[k].min(p[k]), hi[k].max(p[k]));
            }
        }
        let centre = [0, 1, 2].map(|k| 0.5 * lo[k] + 0.5 * hi[k]);
        let about = |p: [f64; 3]| [0, 1, 2].map(|k| p[k] - centre[k]);
        let (lo, hi) = (about(lo), about(hi));
        let largest = lo.iter().chain(&hi).fold(0.0_f64, |most, x| most.max(x.abs()));
        let corners = |face: &[u32; 3]| face.map(|v| about(point(v)));
        let mut builder = Builder {
            middles: faces.iter().map(|face| middle(corners(face))).collect(),
            boxed: |triangle: u32| {
                corners_box(&corners(&faces[triangle as usize]).map(|p| p.map(|x| x as f32)))
            },
            tiles: Vec::new(),
            above: Vec::new(),
            is_above_tiles: Vec::new(),
            order: Vec::new(),
        };
        let mut all: Vec<u32> = (0..faces.len() as u32).collect();
        let levels = (0..).find(|&level| all.len() <= capacity(level)).unwrap_or(0);
        let root = builder.node(&mut all, levels);
        if levels > 0 {
            builder.above.push(root);
            builder.is_above_tiles.push(levels == 1);
        }
        let Builder { tiles, above, is_above_tiles, order, .. } = builder;
        // A place without a triangle has the last number of all.
        let triangle = |&number: &u32| {
            faces.get(number as usize).map_or(MeshTriangle::default(), |face| {
                let corners = corners(face).map(|p| p.map(|x| x as f32));
                MeshTriangle { corners, vertices: *face }
            })
        };
        let triangles: Vec<MeshTriangle> = order.iter().map(triangle).collect();
        let leaf = |(number, triangle): (&u32, &MeshTriangle)| MeshLeaf {
            volume: corners_box(&triangle.corners),
            number: *number,
            pad: 0,
        };
        let leaves: Vec<MeshLeaf> = order.iter().zip(&triangles).map(leaf).collect();
        MeshTiles {
            columns: columns(&leaves),
            record: MeshRecord { centre, radius: ROOT_3 * largest, lo, hi, ..MeshRecord::default() },
            leaves,
            triangles,
            vertices: (0..positions.len() as u32).map(|v| Vec3(point(v)).into()).collect(),
            tiles,
            above,
            is_above_tiles,
            levels,
        }
    }
}

/// The boxes of all tiles, each by columns.
fn columns(leaves: &[MeshLeaf]) -> Vec<u32> {
    let column = |tile, k: usize| <[MeshLeaf]>::iter(tile).map(move |leaf| leaf.columns()[k]);
    let of_tile = |tile| (0..MeshLeaf::COLUMNS as usize).flat_map(move |k| column(tile, k));
    leaves.chunks(FAN).flat_map(of_tile).collect()
}

/// The middle of a triangle's box.
fn middle(corners: [[f64; 3]; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| {
        let of = |pick: fn(f64, f64) -> f64| corners.iter().map(|p| p[k]).reduce(pick).unwrap_or(0.0);
        0.5 * of(f64::min) + 0.5 * of(f64::max)
    })
}

struct Builder<F> {
    middles: Vec<[f64; 3]>,
    /// The box of a triangle, as its corners are stored.
    boxed: F,
    tiles: Vec<MeshNode>,
    above: Vec<MeshNode>,
    is_above_tiles: Vec<bool>,
    /// Triangles, by their places; [`NONE`] for none.
    order: Vec<u32>,
}

impl<F: Fn(u32) -> FrameBox> Builder<F> {
    /// Builds the node of a level over some triangles, and everything below it. A tile takes the
    /// next place.
    fn node(&mut self, triangles: &mut [u32], level: u32) -> MeshNode {
        if level == 0 {
            triangles.sort_unstable();
            let volume = triangles.iter().map(|&triangle| (self.boxed)(triangle)).reduce(FrameBox::merge);
            self.order.extend_from_slice(triangles);
            self.order.resize((self.tiles.len() + 1) * FAN, NONE);
            let first = triangles.first().copied().unwrap_or(0);
            let tile = MeshNode { volume: volume.unwrap_or(FrameBox::EMPTY), first, count: 0 };
            self.tiles.push(tile);
            return tile;
        }
        let mut parts = Vec::new();
        self.cut(triangles, capacity(level - 1), &mut parts);
        let count = parts.len();
        // Nodes below are neighbours: their places are taken before those below them.
        let first = if level == 1 { self.tiles.len() } else { self.above.len() };
        if level > 1 {
            self.above.resize(first + count, MeshNode::default());
            self.is_above_tiles.resize(first + count, level == 2);
        }
        let mut volume = FrameBox::EMPTY;
        for (i, part) in parts.into_iter().enumerate() {
            let below = self.node(part, level - 1);
            volume = volume.merge(below.volume);
            if level > 1 {
                self.above[first + i] = below;
            }
        }
        MeshNode { volume, first: first as u32, count: count as u32 }
    }

    /// Cuts triangles into parts of at most `most`: by halves, at multiples of it, across the longest
    /// axis.
    fn cut<'a>(&self, triangles: &'a mut [u32], most: usize, parts: &mut Vec<&'a mut [u32]>) {
        if triangles.len() <= most {
            parts.push(triangles);
            return;
        }
        let extent = |axis: &usize| {
            let along = || triangles.iter().map(|&triangle| self.middles[triangle as usize][*axis]);
            along().fold(f64::NEG_INFINITY, f64::max) - along().fold(f64::INFINITY, f64::min)
        };
        let axis = [0, 1, 2].into_iter().max_by(|a, b| extent(a).total_cmp(&extent(b))).unwrap_or(0);
        let at = triangles.len().div_ceil(most).div_ceil(2) * most;
        let key = |triangle: &u32| self.middles[*triangle as usize][axis];
        triangles.select_nth_unstable_by(at, |a, b| key(a).total_cmp(&key(b)).then(a.cmp(b)));
        let (left, right) = triangles.split_at_mut(at);
        self.cut(left, most, parts);
        self.cut(right, most, parts);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::soup;

    /// The place of a number of a box among the columns.
    fn in_column(place: usize, k: usize) -> usize {
        (place / FAN * MeshLeaf::COLUMNS as usize + k) * FAN + place % FAN
    }

    /// Checks a mesh's tiles: each triangle in one place, each box around everything below it.
    fn check(faces: &[[u32; 3]], tiles: &MeshTiles) -> Result<(), String> {
        let mut seen = vec![0; faces.len()];
        for (place, &MeshLeaf { volume, number, .. }) in tiles.leaves.iter().enumerate() {
            let triangle = tiles.triangles[place];
            if number == NONE {
                if !f32::from_bits(tiles.columns[in_column(place, 0)]).is_nan() {
                    return Err(format!("place {place} has a box and no triangle"));
                }
                continue;
            }
            seen[number as usize] += 1;
            let holds = |outer: &FrameBox, inner: &FrameBox| outer.merge(*inner) == *outer;
            let column = |k: usize| f32::from_bits(tiles.columns[in_column(place, k)]);
            let in_columns = FrameBox { lo: [0, 1, 2].map(column), hi: [3, 4, 5].map(column) };
            if triangle.vertices != faces[number as usize]
                || volume != corners_box(&triangle.corners)
                || volume != in_columns
                || !holds(&tiles.tiles[place / FAN].volume, &volume)
                || tiles.tiles[place / FAN].first > number
            {
                return Err(format!("place {place} is outside"));
            }
        }
        for (at, node) in tiles.above.iter().enumerate() {
            let below = if tiles.is_above_tiles[at] { &tiles.tiles } else { &tiles.above };
            let range = node.first as usize..(node.first + node.count) as usize;
            let merged = below[range].iter().fold(FrameBox::EMPTY, |all, node| all.merge(node.volume));
            if merged != node.volume || node.count as usize > FAN {
                return Err(format!("node {at} does not hold what is below it"));
            }
        }
        if seen.iter().all(|&count| count == 1) { Ok(()) } else { Err("a triangle is missing".into()) }
    }

    #[test]
    fn every_triangle_is_below_every_node_above_it() {
        for (count, levels) in [(1, 0), (32, 0), (33, 1), (1_024, 1), (1_848, 2), (40_000, 3)] {
            let body = soup(count, 3, false);
            let tiles = MeshTiles::new(body.elements(), body.positions_t0());
            assert_eq!(check(body.elements(), &tiles), Ok(()), "{count} triangles");
            assert_eq!(tiles.levels, levels, "{count} triangles");
            let radius = tiles.record.radius;
            let far = |t: &MeshTriangle| {
                t.corners.iter().all(|p| {
                    let [x, y, z] = p.map(f64::from);
                    (x * x + y * y + z * z).sqrt() <= radius
                })
            };
            assert!(tiles.triangles.iter().all(far));
        }
    }

    #[test]
    fn a_wrong_tile_is_noticed() {
        let body = soup(1_848, 4, false);
        let faults: [fn(&mut MeshTiles); 7] = [
            |tiles| tiles.tiles[7].first += 1,
            |tiles| tiles.tiles[7].volume.hi[1] = tiles.tiles[7].volume.lo[1],
            |tiles| tiles.leaves[3].number = tiles.leaves[90].number,
            |tiles| tiles.above[1].count -= 1,
            |tiles| tiles.triangles[40].corners[2][0] += 10.0,
            |tiles| tiles.columns[5 * FAN] = 0,
            |tiles| {
                let place = tiles.leaves.iter().position(|leaf| leaf.number == NONE).expect("one is empty");
                tiles.columns[in_column(place, 0)] = 0;
            },
        ];
        for (i, fault) in faults.into_iter().enumerate() {
            let mut tiles = MeshTiles::new(body.elements(), body.positions_t0());
            fault(&mut tiles);
            assert!(check(body.elements(), &tiles).is_err(), "fault {i}");
        }
    }
}
