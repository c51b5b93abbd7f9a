//! The oracle of distances itself: known answers, and points that are tried one by one.

use nearmiss_lab::case::Features;
use nearmiss_lab::oracle::near::{Shape, all_within, distance_squared, squared_at};
use rand::rngs::SmallRng;
use rand::{Rng, SeedableRng};
use support::judges::near::Points;

const KINDS: [Features; 2] = [Features::VertexFace, Features::EdgeEdge];

#[test]
fn distances_are_known() {
    let [x, y, z, o] = [[4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [0.0, 0.0, 4.0], [0.0; 3]];
    // The plane x + y + z = 4 is 4 / sqrt 3 away, which no float is.
    let plane = distance_squared(Features::VertexFace, [o, x, y, z]);
    assert!((plane.to_f64() - 16.0 / 3.0).abs() < 1e-15);
    let length = (16.0f64 / 3.0).sqrt();
    let around = [length.next_down().next_down(), length.next_up().next_up()];
    assert_eq!(around.map(|length| plane.is_within(length)), [false, true]);
    let edges = |d| distance_squared(Features::EdgeEdge, [o, x, y, d]).to_f64();
    assert_eq!([[0.0, 4.0, 3.0], [2.0, -4.0, 0.0], [8.0, 4.0, 0.0]].map(edges), [16.0, 0.0, 16.0]);
    for kind in KINDS {
        assert_eq!(distance_squared(kind, [x; 4]).to_f64(), 0.0);
        let tiny = [[0.0; 3], [5e-324, 0.0, 0.0], [5e-324, 0.0, 0.0], [5e-324, 0.0, 0.0]];
        let near = distance_squared(kind, tiny);
        assert!(near.is_within(5e-324) && near.to_f64() == 0.0, "{kind:?}");
    }
    let far = [[1e300, 0.0, 0.0], [-1e300, 0.0, 0.0], [-1e300, 1.0, 0.0], [-1e300, 0.0, 1.0]];
    assert!(distance_squared(Features::VertexFace, far).is_within(2e300));
    assert!(!distance_squared(Features::VertexFace, far).is_within(1.9e300));
}

/// No point of the features is nearer, and some point of a fine net nearly is.
#[test]
fn no_point_that_is_tried_is_nearer() {
    let mut r = SmallRng::seed_from_u64(12);
    const NET: i32 = 16;
    for i in 0..24 {
        let kind = KINDS[i % 2];
        let points: Points = [(); 4].map(|()| [(); 3].map(|()| f64::from(r.random_range(-3..4))));
        let truth = distance_squared(kind, points);
        let mut least: Option<f64> = None;
        for s in 0..=NET {
            for t in 0..=NET {
                let [s, t] = [s, t].map(|n| f64::from(n) / f64::from(NET));
                let weights = if kind == Features::EdgeEdge { [s, t, 0.0] } else { [1.0 - s - t, s, t] };
                if weights[0] < 0.0 {
                    continue;
                }
                let there = squared_at(kind, points, weights);
                assert!(there >= truth, "{kind:?} {points:?} {weights:?}");
                least = Some(least.map_or(there.to_f64(), |least| least.min(there.to_f64())));
            }
        }
        // A net's nearest point is a half of its mesh away: of sides of up to 11 a third each.
        let off = least.expect("points").sqrt() - truth.to_f64().sqrt();
        assert!((0.0..0.75).contains(&(off + 1e-12)), "{kind:?} {points:?}: {off}");
    }
}

#[test]
fn a_root_is_judged_to_its_bound() {
    let two = distance_squared(Features::VertexFace, [[1.0, 1.0, 0.0], [0.0; 3], [0.0; 3], [0.0; 3]]);
    assert!(two.is_near(2.0, 1e-300) && two.is_near(2.0, 0.0));
    // The root of 2.000001 is 3.5e-7 above.
    assert!(two.is_near(2.000001, 3.6e-7) && !two.is_near(2.000001, 3.5e-7));
    assert!(two.is_near(1.999999, 3.6e-7) && !two.is_near(1.999999, 3.5e-7));
}

/// Two triangles over each other: each pair of features once, and none of one's own.
#[test]
fn a_list_has_every_pair_once() {
    let over = |z: f64| vec![[0.0, 0.0, z], [4.0, 0.0, z], [0.0, 4.0, z]];
    let one = Shape { points: [over(0.0), over(1.0)].concat(), faces: vec![[0, 1, 2], [3, 4, 5], [1, 1, 1]] };
    let all = all_within(&[one], 1.0);
    // Three vertices each way, and nine pairs of edges: all have a corner over a corner or a side over a side.
    let count = |kind: &str| all.keys().filter(|row| row.0 == kind).count();
    // The point at vertex 1 is a face of its own: vertex 4 is over it.
    assert_eq!((count("vf"), count("ee")), (7, 9));
    let two = [over(0.0), over(1.0)].map(|points| Shape { points, faces: vec![[0, 1, 2]] });
    let all = all_within(&two, 1.0);
    let count = |kind: &str| all.keys().filter(|row| row.0 == kind).count();
    let of_the_first = all.keys().filter(|row| row.0 == "vf" && row.1 == [0, 1]).count();
    assert_eq!((count("vf"), of_the_first, count("ee")), (6, 3, 9));
    assert!(all_within(&two, 0.999).is_empty());
}
