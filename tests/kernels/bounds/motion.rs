//! Bodies in motion in each other's frames: `bvh::motion`. Points that meet on their true paths are
//! never outside of what the other sees, and the slack is not much larger than it must be.

use super::hunt::{Found, Hunt};
use nearmiss_kernels::abi::{
    InstanceFrame, InstanceMotion, MeshRecord, MovingRelation, PoseRecord, Relation, TileBox, TurnRecord,
};
use nearmiss_kernels::bv::Aabb;
use nearmiss_kernels::bvh::relation::Related;
use nearmiss_kernels::bvh::tile_box::TilesApart;
use nearmiss_kernels::exec::RowMap;
use nearmiss_kernels::math::turn::{Turn, after, exp};
use nearmiss_kernels::math::{Vec3, rigid};
use nearmiss_kernels::stage::fit::bodies::frame;
use nearmiss_kernels::stage::fit::moving_bodies::motion;
use rand::Rng;
use rand::rngs::SmallRng;

/// The numbers of a body: quaternion, turn, travel, pivot, a point of it.
const OF_A_BODY: usize = 16;

/// A body of a mesh in a step, and a point of it.
struct Moves {
    mesh: MeshRecord,
    poses: [PoseRecord; 2],
    turn: Option<TurnRecord>,
    point: Vec3<f64>,
}

fn part(x: &[f64], at: usize) -> [f64; 3] {
    [x[at], x[at + 1], x[at + 2]]
}

impl Moves {
    /// `None` if the numbers are of no pose. A body that does not turn goes straight.
    fn new(x: &[f64], turns: bool) -> Option<Moves> {
        let q = [x[0], x[1], x[2], x[3]];
        let length = rigid::length(&q);
        if !(length > 1e-2) || x.iter().any(|x| !(x.abs() <= 4.0)) {
            return None;
        }
        let (phi, travel, pivot, point) = (part(x, 4), part(x, 7), part(x, 10), Vec3(part(x, 13)));
        let phi_length = phi.iter().map(|x| x * x).sum::<f64>().sqrt();
        if phi_length > if turns { std::f64::consts::TAU } else { 3.0 } {
            return None;
        }
        let start = PoseRecord { rotation: q.map(|x| x / length), ..PoseRecord::default() };
        let rotation = after(exp(Vec3(phi)), start.rotation);
        let length = rigid::length(&rotation);
        let end = PoseRecord { rotation: rotation.map(|x| x / length), ..PoseRecord::default() };
        let place = |pose: &PoseRecord, v| rigid::moved(&rigid::rows(pose.rotation), &pose.translation, v);
        let to = place(&start, Vec3(pivot)) + Vec3(travel) - place(&end, Vec3(pivot));
        let poses = [start, PoseRecord { translation: to.0, ..end }];
        let path = poses.map(|pose| place(&pose, Vec3(pivot)).0);
        let turn = TurnRecord { rotation: start.rotation, turn: phi, pivot, path, ..TurnRecord::default() };
        let radius = point.dot(point).sqrt();
        let mesh = MeshRecord { radius, ..MeshRecord::default() };
        Some(Moves { mesh, poses, turn: (turns && phi_length > 0.0).then_some(turn), point })
    }

    fn frames(&self) -> [InstanceFrame; 2] {
        [frame(&self.poses[0], &self.mesh), frame(&self.poses[1], &self.mesh)]
    }

    fn motion(&self) -> InstanceMotion {
        motion(&self.mesh, &self.poses, &self.frames(), self.turn.as_ref())
    }

    /// The true place of the point.
    fn at(&self, t: f64) -> Vec3<f64> {
        let mix = |a: Vec3<f64>, b: Vec3<f64>| a * (1.0 - t) + b * t;
        match &self.turn {
            Some(turn) => {
                let arm = rigid::moved(&rigid::rows(turn.rotation), &[0.0; 3], self.point - Vec3(turn.pivot));
                mix(Vec3(turn.path[0]), Vec3(turn.path[1])) + Turn::new(Vec3(turn.turn)).rotated(t, arm)
            }
            None => {
                let [a, b] = self.frames().map(|f| rigid::moved(&f.rows, &f.translation, self.point));
                mix(a, b)
            }
        }
    }

    fn shift(&mut self, by: Vec3<f64>) {
        for pose in &mut self.poses {
            pose.translation = (Vec3(pose.translation) + by).0;
        }
        for place in self.turn.iter_mut().flat_map(|turn| &mut turn.path) {
            *place = (Vec3(*place) + by).0;
        }
    }
}

/// A tile that has this corner alone, with a box along these axes.
fn tile(point: [f32; 3], axes: &[f64]) -> TileBox {
    let axis = |at| part(axes, at).map(|x| x as f32);
    TileBox::around(&[point], [axis(0), axis(3)])
}

/// Two bodies whose points are `gap` apart at a time: the slack, and how much of it the second's point
/// needs in the frame of the first. Boxes hold it, and neither planes of triangles with these corners nor
/// oriented boxes part them.
fn needed(x: &[f64], [a_turns, b_turns]: [bool; 2], gap: f64) -> Option<(MovingRelation, f64)> {
    let a = Moves::new(&x[..OF_A_BODY], a_turns)?;
    let mut b = Moves::new(&x[OF_A_BODY..2 * OF_A_BODY], b_turns)?;
    let t = x[2 * OF_A_BODY].abs();
    if !(t <= 1.0) {
        return None;
    }
    let way = Vec3(part(x, 2 * OF_A_BODY + 1));
    let way = way * (gap / way.dot(way).sqrt().max(1e-9));
    b.shift(a.at(t) + way - b.at(t));
    let ([a0, a1], [b0, b1]) = (a.frames(), b.frames());
    let frames = [[&a0, &b0], [&a1, &b1]];
    let relation = MovingRelation::of([0, 1], frames, [&a.mesh, &b.mesh], [&a.motion(), &b.motion()], gap);
    let single = |v: Vec3<f64>| [v.0.map(|x| x as f32); 3];
    let own = single(a.point)[0];
    let (seen, around) = relation.seen(&single(b.point));
    let mut most = f64::NEG_INFINITY;
    for k in 0..3 {
        let [start, end] = [seen[0][0][k], seen[1][0][k]].map(f64::from);
        let at = f64::from(own[k]);
        most = most.max(at - start.max(end)).max(start.min(end) - at);
    }
    let holds = Aabb::of(single(a.point).map(Vec3)).overlaps(&around);
    let corners = |v: Vec3<f64>| {
        let [x, y, z] = v.0.map(|x| x as f32);
        [[x, y, z], [y, z, x], [-0.5 * z, 0.5 * x, 0.5 * y]]
    };
    let row = MovingRelation::row(corners(a.point), relation.seen(&corners(b.point)).0);
    assert!(holds && !MovingRelation::are_apart(row, relation.slack()), "{x:?}: {relation:?}");
    let tiles = tiles(x, [a.point, b.point]);
    assert_eq!(TilesApart { relation }.at_once(tiles), 0, "{x:?}: {relation:?}");
    Some((relation, most))
}

/// The tiles of the two points.
fn tiles(x: &[f64], [a, b]: [Vec3<f64>; 2]) -> [TileBox; 2] {
    let single = |v: Vec3<f64>| v.0.map(|x| x as f32);
    [tile(single(a), &x[4..]), tile(single(b), &x[OF_A_BODY + 4..])]
}

/// The largest part of the slack that is needed, of motions with turns of that size.
fn hunted(seed: u64, turns: [bool; 2], turn: f64, gap: f64) -> Found {
    let start = |r: &mut SmallRng| {
        let mut x: Vec<f64> = (0..2 * OF_A_BODY + 4).map(|_| r.random_range(-1.0..1.0)).collect();
        for at in [4, OF_A_BODY + 4] {
            x[at..at + 3].iter_mut().for_each(|x| *x *= turn);
        }
        x
    };
    Hunt { starts: 12, ..Hunt::new(seed) }.most::<f64>(start, |x| match needed(x, turns, gap) {
        Some((relation, most)) => most / f64::from(relation.slack()),
        None => f64::NAN,
    })
}

#[test]
fn points_that_meet_are_seen() {
    for (k, turns) in [[true, true], [true, false], [false, true], [false, false]].into_iter().enumerate() {
        for (j, turn) in [1e-3, 0.3, 1.8].into_iter().enumerate() {
            let found = hunted(900 + 10 * k as u64 + j as u64, turns, turn, 0.0);
            println!("motion, {turns:?} by {turn}: {:.3} of the slack", found.ratio);
            // Every point was seen. A third of the slack would be too little.
            assert!((0.34..=1.0).contains(&found.ratio), "{turns:?} {turn}: {found:?}");
        }
    }
}

#[test]
fn points_within_a_distance_are_seen() {
    for (k, turns) in [[true, true], [false, false]].into_iter().enumerate() {
        let found = hunted(950 + k as u64, turns, 0.01, 0.5);
        println!("motion, 0.5 apart: {:.3} of the slack", found.ratio);
        assert!((0.5..=1.0).contains(&found.ratio), "{turns:?}: {found:?}");
    }
}

/// Slacks that lack a term part points that meet.
#[test]
fn a_slack_without_a_term_is_noticed() {
    use rand::SeedableRng;
    let mut r = SmallRng::seed_from_u64(960);
    let mut lost = [0; 2];
    for _ in 0..4_000 {
        let x: Vec<f64> = (0..2 * OF_A_BODY + 4).map(|_| r.random_range(-1.0..1.0)).collect();
        for (lost, turns) in lost.iter_mut().zip([[true, true], [false, false]]) {
            let Some((relation, most)) = needed(&x, turns, 0.0) else { continue };
            let [a, b] = [&x[..OF_A_BODY], &x[OF_A_BODY..]].map(|x| Moves::new(x, false));
            let (Some(a), Some(b)) = (a, b) else { continue };
            // That of bodies at rest.
            let still = Relation::of([0, 1], [&a.frames()[0], &b.frames()[0]], [&a.mesh, &b.mesh]).slack;
            assert!(still < relation.slack());
            *lost += u32::from(most > f64::from(still));
        }
    }
    assert!(lost[0] > 500 && lost[1] > 500, "{lost:?}");
}

/// Oriented boxes that are apart at one end only, and slacks that lack the terms of a step.
#[test]
fn oriented_boxes_of_less_than_a_step_are_noticed() {
    use rand::SeedableRng;
    let mut r = SmallRng::seed_from_u64(970);
    let (mut at_start, mut at_end, mut without) = (0, 0, 0);
    for _ in 0..4_000 {
        let x: Vec<f64> = (0..2 * OF_A_BODY + 4).map(|_| r.random_range(-1.0..1.0)).collect();
        let Some((relation, _)) = needed(&x, [true, true], 0.0) else { continue };
        let [a, b] = [&x[..OF_A_BODY], &x[OF_A_BODY..]].map(|x| Moves::new(x, true));
        let (Some(a), Some(b)) = (a, b) else { continue };
        let tiles = tiles(&x, [a.point, b.point]);
        let at = |relation: Relation| TilesApart { relation: Relation { slack: 1e-4, ..relation } };
        at_start += at(relation.start).at_once(tiles);
        at_end += at(relation.end).at_once(tiles);
        let mut less = relation;
        (less.start.slack, less.end.slack) = (1e-4, 1e-4);
        without += TilesApart { relation: less }.at_once(tiles);
    }
    assert!(at_start > 500 && at_end > 500 && without > 100, "{at_start} {at_end} {without}");
}

/// In a step without turns, and at rest, the slack is that of both ends.
#[test]
fn the_slack_of_bodies_that_do_not_turn_is_that_of_both_ends() {
    let x: Vec<f64> = (0..2 * OF_A_BODY + 4)
        .map(|k| match k % OF_A_BODY {
            4..7 => 0.0,
            k => 0.1 * (k % 7) as f64 + 0.05,
        })
        .collect();
    let (relation, _) = needed(&x, [true, true], 0.0).expect("motions");
    let a = Moves::new(&x[..OF_A_BODY], true).expect("a motion");
    let reach = 4.0 * a.mesh.radius + 8.0;
    let most = nearmiss_kernels::math::tolerance::RELATIVE_SLACK * reach * 1.01;
    assert!(f64::from(relation.slack()) < most, "{relation:?}");
}
