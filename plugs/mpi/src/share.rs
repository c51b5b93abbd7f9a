//! Division of a scene that every rank knows: which triangles each rank owns.

use crate::chunks::{along_curve, codes};
use crate::detector::check_scene;
use crate::piece::Piece;
use nearmiss::scene::Scene;
use nearmiss::{Body, Error};

/// How a scene is divided among ranks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Division {
    /// Each body is on one rank: the largest first, each to the rank with the fewest triangles.
    Bodies,
    /// Bodies follow a curve through their centres, and triangles of a body a curve through theirs.
    /// Each rank has a stretch of equally many triangles; it cuts a body at each end.
    #[default]
    Stretches,
}

/// Returns the pieces of a rank: of every body, also those of which it owns nothing.
///
/// # Errors
/// As of [`Piece::of`], and for a scene that excludes features or from which bodies were removed.
pub fn pieces(scene: &Scene, division: Division, rank: usize, ranks: usize) -> Result<Vec<Piece>, Error> {
    check_scene(scene)?;
    let bodies = scene.bodies();
    let owned = match division {
        Division::Bodies => by_bodies(bodies, rank, ranks),
        Division::Stretches => by_stretches(bodies, rank, ranks),
    };
    bodies.iter().zip(owned).map(|(body, faces)| Piece::of(body, &faces)).collect()
}

/// Pairs of bodies that a scene leaves out, as [`RankDetector::new`](crate::RankDetector::new) takes
/// them.
pub fn left_out(scene: &Scene) -> Vec<[usize; 2]> {
    scene.left_out().iter().map(|pair| pair.map(|id| id.index())).collect()
}

fn by_bodies(bodies: &[Body], rank: usize, ranks: usize) -> Vec<Vec<u32>> {
    let mut order: Vec<usize> = (0..bodies.len()).collect();
    order.sort_by_key(|&body| std::cmp::Reverse(bodies[body].face_count()));
    let mut loads = vec![0usize; ranks];
    let mut owned = vec![Vec::new(); bodies.len()];
    for body in order {
        let least = (0..ranks).min_by_key(|&rank| loads[rank]).unwrap_or(0);
        loads[least] += bodies[body].face_count();
        if least == rank {
            owned[body] = (0..bodies[body].face_count() as u32).collect();
        }
    }
    owned
}

fn by_stretches(bodies: &[Body], rank: usize, ranks: usize) -> Vec<Vec<u32>> {
    let centre = |body: &Body| {
        let points = (0..body.vertex_count()).filter_map(|v| body.positions_t0().get_f64(v));
        let points = points.filter(|p| p.iter().all(|x| x.is_finite())).map(|p| body.poses()[0].apply(p));
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for p in points {
            low = [0, 1, 2].map(|k| low[k].min(p[k]));
            high = [0, 1, 2].map(|k| high[k].max(p[k]));
        }
        [0, 1, 2].map(|k| low[k] / 2.0 + high[k] / 2.0)
    };
    let codes = codes(&bodies.iter().map(centre).collect::<Vec<_>>());
    let mut order: Vec<usize> = (0..bodies.len()).collect();
    order.sort_by_key(|&body| codes[body]);
    let all: usize = bodies.iter().map(Body::face_count).sum();
    let [first, end] = [rank, rank + 1].map(|rank| rank * all / ranks);
    let mut owned = vec![Vec::new(); bodies.len()];
    let mut before = 0;
    for body in order {
        let count = bodies[body].face_count();
        let own = first.clamp(before, before + count) - before..end.clamp(before, before + count) - before;
        owned[body] = match own.len() == count {
            true => (0..count as u32).collect(),
            false if own.is_empty() => Vec::new(),
            false => along_curve(&bodies[body])[own].to_vec(),
        };
        before += count;
    }
    owned
}

#[cfg(test)]
mod tests {
    use super::*;
    use nearmiss::Mesh;
    use nearmiss::mesh::Positions;

    #[test]
    fn every_triangle_is_on_one_rank() {
        let body = |faces: u32| {
            let points = (0..faces + 2).map(|i| [i as f32, (i * i % 7) as f32, 0.0]).collect();
            let faces = (0..faces).map(|i| [i, i + 1, i + 2]).collect();
            Body::deformable(Mesh::new("strip", Positions::F32(points), faces).expect("a mesh"))
        };
        let scene = Scene::from([0, 1, 7, 100, 2, 33].map(body).to_vec());
        for division in [Division::Bodies, Division::Stretches] {
            for ranks in 1..8 {
                let mut found = vec![Vec::new(); 6];
                let mut loads = Vec::new();
                for rank in 0..ranks {
                    let own = pieces(&scene, division, rank, ranks).expect("pieces");
                    loads.push(own.iter().map(|piece| piece.faces().len()).sum::<usize>());
                    found.iter_mut().zip(&own).for_each(|(all, own)| all.extend_from_slice(own.faces()));
                }
                for (found, body) in found.iter_mut().zip(scene.bodies()) {
                    found.sort_unstable();
                    assert_eq!(
                        *found,
                        (0..body.face_count() as u32).collect::<Vec<_>>(),
                        "{division:?} {ranks}"
                    );
                }
                let even = loads.iter().max().zip(loads.iter().min()).is_some_and(|(a, b)| a - b <= 1);
                assert!(division == Division::Bodies || even, "{loads:?}");
            }
        }
    }
}
