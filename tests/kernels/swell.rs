//! The swell of a triangle of a body that turns: its points leave their chords by no more, and nearly
//! by as much.

use nearmiss_kernels::abi::TurnRecord;
use nearmiss_kernels::bvh::turns::swell_of;
use nearmiss_kernels::math::Vec3;
use nearmiss_kernels::math::turn::{Turn, bulge};
use rand::rngs::SmallRng;
use rand::{Rng, SeedableRng};

fn vector(rng: &mut SmallRng, by: f64) -> Vec3<f64> {
    Vec3([(); 3].map(|()| rng.random_range(-by..by)))
}

/// The largest part of its swell by which a point of a random triangle leaves its chord, for turns
/// up to `most`, at `times` times. The bulge of the record is changed first.
fn largest(most: f64, times: u32, change: impl Fn(f64) -> f64) -> f64 {
    let mut rng = SmallRng::seed_from_u64(20);
    let mut largest = 0.0_f64;
    for _ in 0..400 {
        let axis = vector(&mut rng, 1.0);
        let turn = axis * (rng.random_range(0.0..most) / axis.dot(axis).sqrt());
        let path = [vector(&mut rng, 5.0), vector(&mut rng, 5.0)];
        let corners = [(); 3].map(|()| vector(&mut rng, 3.0));
        let angle = turn.dot(turn).sqrt();
        let record = TurnRecord {
            turn: turn.0,
            path: path.map(|at| at.0),
            bulge: change(bulge(angle)),
            ..TurnRecord::default()
        };
        let way = Turn::new(turn);
        let at = |r: Vec3<f64>, t: f64| path[0] * (1.0 - t) + path[1] * t + way.rotated(t, r);
        let ends = corners.map(|r| [at(r, 0.0), at(r, 1.0)]);
        let swell = f64::from(swell_of(&record, ends));
        // A corner, or a point between corners.
        let weights = [rng.random_range(0.0..1.0), rng.random_range(0.0..1.0)];
        let [u, v] = if weights[0] + weights[1] < 1.0 { weights } else { [1.0, 0.0] };
        let mean = |x: [Vec3<f64>; 3]| x[0] * (1.0 - u - v) + x[1] * u + x[2] * v;
        for k in 0..=times {
            let t = f64::from(k) / f64::from(times);
            for point in corners.into_iter().chain([mean(corners)]) {
                let chord = at(point, 0.0) * (1.0 - t) + at(point, 1.0) * t;
                let away = at(point, t) - chord;
                largest = largest.max(away.dot(away).sqrt() / swell);
            }
        }
    }
    largest
}

#[test]
fn no_point_leaves_its_chord_by_more_than_the_swell() {
    for most in [1e-6, 0.1, 1.0, 3.0, 6.25] {
        let largest = largest(most, 64, |bulge| bulge);
        assert!(largest <= 1.0, "{most}: {largest}");
    }
    // Nearly all of it is needed, for small turns and for those of half a turn and more.
    assert!(largest(0.5, 64, |bulge| bulge) > 0.98);
    assert!(largest(6.25, 64, |bulge| bulge) > 0.95);
}

/// A bulge that is a tenth too small is noticed.
#[test]
fn a_smaller_swell_is_noticed() {
    assert!(largest(0.5, 64, |bulge| 0.9 * bulge) > 1.0);
    assert!(largest(6.25, 64, |bulge| 0.9 * bulge) > 1.0);
}

/// Bodies that do not turn have the part of rounding alone, and so have those of scenes at rest.
#[test]
fn what_does_not_turn_has_next_to_none() {
    let corners = [[Vec3([1.0, 2.0, 3.0]), Vec3([4.0, -8.0, 0.0])]; 3];
    let swell = swell_of(&TurnRecord::default(), corners);
    assert!(swell > 8.0 * 2f32.powi(-37) * 0.999 && swell < 8.0 * 2f32.powi(-36), "{swell:e}");
    let fixed = TurnRecord { fixed: 1024.0, ..TurnRecord::default() };
    assert!(swell_of(&fixed, corners) > 100.0 * swell);
}
