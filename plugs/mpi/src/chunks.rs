//! Chunks: up to 32 triangles of one body that are neighbours in space.

use crate::boxes::Bounds;
use nearmiss::Body;
use nearmiss::mesh::Positions;
use nearmiss::scene::{BodyKind, PosePath};

/// Triangles of a chunk, as of a tile.
pub(crate) const SIZE: usize = 32;

/// Triangles of a piece, by their numbers in it.
pub(crate) struct Chunk {
    pub body: usize,
    pub faces: Vec<u32>,
}

/// Returns the triangles of a body along a Morton curve through their centres at the start.
pub(crate) fn along_curve(body: &Body) -> Vec<u32> {
    let centres: Vec<[f64; 3]> = body
        .faces()
        .iter()
        .map(|corners| {
            let points = corners.map(|v| body.positions_t0().get_f64(v as usize).unwrap_or_default());
            // Thirds first: three large coordinates do not overflow.
            [0, 1, 2].map(|k| points.iter().map(|p| p[k] / 3.0).sum())
        })
        .collect();
    let codes = codes(&centres);
    let mut order: Vec<u32> = (0..centres.len() as u32).collect();
    order.sort_by_key(|&face| codes[face as usize]);
    order
}

/// Returns the places of points on a Morton curve through their box.
pub(crate) fn codes(points: &[[f64; 3]]) -> Vec<u64> {
    let least = [0, 1, 2].map(|k| points.iter().map(|p| p[k]).fold(f64::INFINITY, f64::min));
    let most = [0, 1, 2].map(|k| points.iter().map(|p| p[k]).fold(f64::NEG_INFINITY, f64::max));
    let side = (0..3).map(|k| most[k] - least[k]).fold(0.0, f64::max);
    let cells = f64::from((1 << 21) - 1);
    let code = |p: &[f64; 3]| {
        let cell = [0, 1, 2].map(|k| if side > 0.0 { ((p[k] - least[k]) / side * cells) as u64 } else { 0 });
        (0..21).fold(0, |code, bit| (0..3).fold(code, |code, k| code | (cell[k] >> bit & 1) << (3 * bit + k)))
    };
    points.iter().map(code).collect()
}

/// Returns the chunks of a piece.
pub(crate) fn of_piece(number: usize, body: &Body) -> impl Iterator<Item = Chunk> {
    let order = along_curve(body);
    let chunks: Vec<Vec<u32>> = order.chunks(SIZE).map(<[u32]>::to_vec).collect();
    chunks.into_iter().map(move |mut faces| {
        faces.sort_unstable();
        Chunk { body: number, faces }
    })
}

/// Returns the boxes of chunks in the whole step, grown by half of `reach` and the body's radius.
pub(crate) fn bounds<'a>(bodies: impl Fn(usize) -> &'a Body, chunks: &[Chunk], reach: f64) -> Vec<Bounds> {
    let each = |chunk: &Chunk| {
        let body = bodies(chunk.body);
        let ends = body.ends();
        let swing = Swing::of(body);
        let (mut low, mut high, mut bulge) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3], 0.0f64);
        for &vertex in chunk.faces.iter().flat_map(|&face| &body.faces()[face as usize]) {
            let point = |positions: &Positions| positions.get_f64(vertex as usize).unwrap_or_default();
            for p in match body.kind() {
                BodyKind::Rigid => body.poses().map(|pose| pose.apply(point(ends[0]))),
                _ => ends.map(point),
            } {
                low = [0, 1, 2].map(|k| low[k].min(p[k]));
                high = [0, 1, 2].map(|k| high[k].max(p[k]));
            }
            bulge = bulge.max(swing.as_ref().map_or(0.0, |swing| swing.bulge(point(ends[0]))));
        }
        Bounds::around([low, high], body.thickness().largest() + reach / 2.0 + bulge)
    };
    chunks.iter().map(each).collect()
}

/// The turn of a rigid body in a step.
struct Swing {
    pivot: [f64; 3],
    /// An eighth of the squared angle, or more; at most 2.
    factor: f64,
}

impl Swing {
    /// Returns the turn of a body; `None` if its vertices go straight.
    fn of(body: &Body) -> Option<Swing> {
        let step = (body.kind() == BodyKind::Rigid).then(|| body.pose_step())?;
        let PosePath::Turn { pivot, by } = step.path() else { return None };
        if !step.turns() {
            return None;
        }
        // The shorter arc is at most half a turn.
        let squared = by.map_or(std::f64::consts::PI.powi(2), |turn| turn.iter().map(|x| x * x).sum());
        Some(Swing { pivot, factor: (squared / 8.0).min(2.0) })
    }

    /// Returns the most by which a vertex leaves its chord.
    ///
    /// A vertex at `r` from the pivot turns by the angle `w`. Its second derivative is at most
    /// `r w^2`, so it is at most an eighth of that off the straight motion between the ends; and
    /// never more than `2 r`.
    fn bulge(&self, vertex: [f64; 3]) -> f64 {
        let [x, y, z] = [0, 1, 2].map(|k| (vertex[k] - self.pivot[k]).abs());
        // The sum is at least the length, and does not overflow.
        (x + y + z) * self.factor
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nearmiss::Mesh;
    use nearmiss::scene::{Pose, PoseStep};

    fn sheet(side: usize) -> Mesh {
        let at = |i: usize| [(i % side) as f32, (i / side) as f32, 0.0];
        let faces = (0..(side - 1) * (side - 1)).map(|i| {
            let v = (i / (side - 1) * side + i % (side - 1)) as u32;
            [v, v + 1, v + side as u32]
        });
        let points = (0..side * side).map(at).collect();
        Mesh::new("sheet", Positions::F32(points), faces.collect()).expect("a mesh")
    }

    #[test]
    fn every_triangle_is_in_one_chunk_and_neighbours_are_together() {
        let body = Body::deformable(sheet(33));
        let chunks: Vec<Chunk> = of_piece(0, &body).collect();
        let mut all: Vec<u32> = chunks.iter().flat_map(|chunk| chunk.faces.clone()).collect();
        all.sort_unstable();
        assert_eq!(all, (0..1024).collect::<Vec<u32>>());
        for Bounds([low, high]) in bounds(|_| &body, &chunks, 0.0) {
            assert!((high[0] - low[0]) * (high[1] - low[1]) < 64.0, "a chunk of 32 cells is compact");
        }
    }

    #[test]
    fn a_turning_body_stays_in_its_boxes() {
        let turn = |x: f64| [0.3 * x, -0.2 * x, x];
        for (angle, pivot) in [(0.1, [0.0; 3]), (1.5, [2.0, 1.0, 0.0]), (6.0, [-3.0, 0.0, 1.0])] {
            let length = turn(angle).iter().map(|x| x * x).sum::<f64>().sqrt();
            let by = turn(angle * angle / length);
            let step = PoseStep::turning(Pose::at([5.0, 0.0, 0.0]), by, [0.5, 0.0, 1.0]).about(pivot);
            let body = Body::rigid(sheet(9)).at(step).expect("a step");
            let chunks: Vec<Chunk> = of_piece(0, &body).collect();
            for (chunk, bounds) in chunks.iter().zip(bounds(|_| &body, &chunks, 0.0)) {
                for time in (0..=64).map(|k| f64::from(k) / 64.0) {
                    let pose = step.at(time).expect("it turns");
                    for &v in chunk.faces.iter().flat_map(|&face| &body.faces()[face as usize]) {
                        let p = pose.apply(body.positions_t0().get_f64(v as usize).expect("a vertex"));
                        assert!(bounds.meets(&Bounds::around([p, p], 0.0)), "{angle} {time} {p:?}");
                        let Bounds([low, high]) = bounds;
                        let inside = |k: usize| f64::from(low[k]) <= p[k] && p[k] <= f64::from(high[k]);
                        assert!((0..3).all(inside), "{angle} {time} {p:?}");
                    }
                }
            }
        }
    }
}
