//! Pairs that share corners, against the oracle's definition.

use super::{corners, on_grid, random};
use nearmiss_kernels::math::Real;
use nearmiss_kernels::prim::adjacent::{Shared, meets_beyond_shared};
use nearmiss_kernels::prim::tri_tri::{Certain, Exact, Filter};
use nearmiss_lab::oracle::{Triangle, triangles_meet, triangles_meet_beyond};
use rand::Rng;

fn check<R: Real>(p: &Triangle, q: &Triangle, shared: Shared, truth: bool) {
    let (a, b) = (corners::<R>(p), corners::<R>(q));
    let what = format!("{p:?} {q:?} {shared:?}");
    assert_eq!(meets_beyond_shared::<R, Exact>(&a, &b, shared), Some(truth), "{what}");
    assert_eq!(meets_beyond_shared::<R, Certain>(&a, &b, shared), Some(truth), "{what}");
    assert!(meets_beyond_shared::<R, Filter>(&a, &b, shared).is_none_or(|x| x == truth), "{what}");
    let swapped = match shared {
        Shared::Corner(i, j) => Shared::Corner(j, i),
        Shared::Edge(i, j) => Shared::Edge(j, i),
        s => s,
    };
    assert_eq!(meets_beyond_shared::<R, Exact>(&b, &a, swapped), Some(truth), "{what}");
}

/// Vertices on a small grid, triangles by random indices: every way to share, every way to collapse.
#[test]
fn all_ways_to_share() {
    let mut r = random(11);
    let mut tally = [[0; 2]; 4];
    for i in 0..2500 {
        let vertices: Vec<[f64; 3]> = (0..2).flat_map(|_| on_grid(&mut r, 2 + i % 3)).collect();
        let mut pick = || loop {
            let t: [u32; 3] = std::array::from_fn(|_| r.random_range(0..5));
            if t[0] != t[1] && t[1] != t[2] && t[2] != t[0] {
                return t;
            }
        };
        let (ip, iq) = (pick(), pick());
        let (p, q) = (ip.map(|k| vertices[k as usize]), iq.map(|k| vertices[k as usize]));
        let common: Vec<_> = ip.iter().filter(|k| iq.contains(k)).map(|k| vertices[*k as usize]).collect();
        let shared = Shared::by_index(ip, iq);
        let truth = match common.len() {
            0 => triangles_meet(&p, &q),
            3 => true,
            _ => triangles_meet_beyond(&p, &q, &common),
        };
        tally[common.len()][truth as usize] += 1;
        check::<f32>(&p, &q, shared, truth);
        check::<f64>(&p, &q, shared, truth);
    }
    println!("by number of shared corners, [apart, meet]: {tally:?}");
    assert!(tally[1].iter().chain(&tally[2]).all(|n| *n > 50));
}

/// Neighbours folded flat onto each other meet; unfolded ones do not.
#[test]
fn folded_neighbours() {
    let p = [[0., 0., 0.], [1., 0., 0.], [0.3, 1., 0.]];
    for (apex, truth) in [([0.6, 0.9, 0.], true), ([0.6, -0.9, 0.], false), ([0.6, 0.9, 1e-30], false)] {
        check::<f64>(&p, &[p[1], p[0], apex], Shared::Edge(2, 2), truth);
    }
    assert_eq!(Shared::by_index([7, 3, 9], [9, 7, 4]), Shared::Edge(1, 2));
    assert_eq!(Shared::by_index([7, 3, 9], [1, 2, 3]), Shared::Corner(1, 2));
    assert_eq!(Shared::by_index([7, 3, 9], [9, 7, 3]), Shared::All);
    assert_eq!(Shared::by_index([7, 3, 9], [0, 1, 2]), Shared::Nothing);
}
