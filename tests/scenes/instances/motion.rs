//! Queries of features: in a step, turning and straight, with and without a separation, the first
//! contact, and near at rest. Everything reported is that of placed vertices, frame after frame.

use super::alike::{FAR, WORLDS, World, scene, scene_of};
use super::*;
use nearmiss::device::emulator::{Emulator, Mode};
use nearmiss::research::{BroadPhase, DetectorExt};
use nearmiss::scene::{BodyKind, PoseStep};
use nearmiss::{Continuous, Earliest};
use support::ORDERS;

/// Kinds of steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ways {
    /// Vertices go straight.
    Straight,
    /// Bodies turn, by little.
    Turning,
    /// All kinds: about pivots, by up to a full turn, straight, without a turn, at rest.
    Any,
}

/// A step for each rigid body, through places like those of [`super::alike`].
pub fn steps(
    rng: &mut SmallRng,
    scene: &Scene,
    (size, place, range): World,
    ways: Ways,
) -> Vec<(BodyId, Motion<'static>)> {
    let rigid = scene.ids().filter(|&id| scene.get(id).is_some_and(|body| body.kind() == BodyKind::Rigid));
    let mut any = |by: f64| [(); 3].map(|()| rng.random_range(-by..by));
    let step = |id| {
        let [at, by, turn, pivot] = [any(range * size), any(0.4 * size), any(0.3), any(size)];
        let kind = any(3.0)[0].abs() as u32;
        let start = Pose {
            rotation: rotation(&mut SmallRng::seed_from_u64(at[0].to_bits())),
            translation: [0, 1, 2].map(|k| place[k] + at[k]),
        };
        let slightly = PoseStep::turning(start, turn, by).about(pivot);
        let end = slightly.end();
        let far = turn.map(|x| 20.0 * x / 1.8);
        let step = match (ways, kind) {
            (Ways::Straight, _) | (Ways::Any, 0) => PoseStep::new(start, end).straight(),
            (Ways::Turning, _) => slightly,
            (Ways::Any, 1) => PoseStep::turning(start, far, by).about(pivot),
            (Ways::Any, _) => PoseStep::new(start, Pose { rotation: start.rotation, ..end }),
        };
        (id, Motion::PoseStep(step))
    };
    rigid.map(step).collect()
}

/// Queries of a scene of that size.
pub fn queries(size: f64) -> Vec<Query> {
    vec![
        Query::continuous(),
        Query::earliest(),
        Continuous::default().with_min_separation(0.05 * size).into(),
        Earliest::default().with_min_separation(0.02 * size).with_tolerance(0.001 * size).into(),
        Continuous::default().with_tolerance(0.1 * size).into(),
        Query::near(0.1 * size),
        Query::near(1e-6 * size),
    ]
}

/// Whether a query reads instances, and places no other vertices.
fn reads(detector: &mut Detector, query: &Query) -> bool {
    let plan = detector.plan(query).expect("a plan");
    let mut kernels = plan.frame.iter().flat_map(|stage| &stage.kernels).map(|kernel| kernel.kernel);
    let is_placed = plan.buffer("positions of all vertices").is_some();
    kernels.any(|kernel| kernel == "traverse_vertices") && !is_placed
}

/// Compares all that both report of a query at their current positions; the number of rows.
pub fn same(both: &mut Both, query: Query) -> Result<usize, String> {
    let found = both.own.query(&query).map_err(|error| error.to_string())?;
    let by_tiles = query.with_broad_phase(BroadPhase::Tiles);
    let expected = both.judge.query(&by_tiles).map_err(|error| error.to_string())?;
    let numbers = |of: &nearmiss::Contacts| (of.len(), of.hash(), of.starts_crossing, of.undecided);
    if numbers(&found) != numbers(&expected) || found.rows != expected.rows {
        let (found, expected) = (numbers(&found), numbers(&expected));
        return Err(format!("{query:?}: {found:?}, the judge has {expected:?}"));
    }
    let notes = [&found, &expected].map(|answer| format!("{:?}", answer.caveats()));
    if notes[0] != notes[1] {
        return Err(format!("{query:?}: {notes:?}"));
    }
    Ok(found.len())
}

pub fn moved(both: &mut Both, motions: &[(BodyId, Motion)]) {
    both.own.update(motions).expect("moved");
    both.judge.update(motions).expect("moved");
}

#[test]
fn steps_are_those_of_placed_vertices() {
    let mut rng = SmallRng::seed_from_u64(21);
    for (size, place, _) in WORLDS {
        let kinds = [(Ways::Straight, 24), (Ways::Turning, 9), (Ways::Any, 7)];
        let mut rows = 0;
        for (ways, count) in kinds {
            let world = (size, place, 3.0);
            let scene = scene_of(12, &mut rng, world, count, ways == Ways::Straight);
            let mut both = Both::new(&engine(), &scene);
            for frame in 0..2 {
                let all = steps(&mut rng, &scene, world, ways);
                // The second time few are named, the others rest at the end of their steps.
                let named = if frame == 0 { &all[..] } else { &all[2..5] };
                moved(&mut both, named);
                let all_of_them = queries(world.0);
                for query in all_of_them.into_iter().take(if frame == 0 { 7 } else { 2 }) {
                    let own = same(&mut both, query);
                    rows += own.unwrap_or_else(|error| panic!("{world:?} {ways:?} {frame}: {error}"));
                    assert!(reads(&mut both.own, &query), "{query:?}");
                }
            }
        }
        assert!(rows > 100, "{size} {place:?}: {rows}");
    }
}

#[test]
fn far_away_they_are_too() {
    let mut rng = SmallRng::seed_from_u64(28);
    for world in FAR {
        let mut rows = 0;
        for ways in [Ways::Straight, Ways::Any] {
            let scene = scene_of(8, &mut rng, world, 4, false);
            let mut both = Both::new(&engine(), &scene);
            moved(&mut both, &steps(&mut rng, &scene, world, ways));
            for query in [Query::continuous(), Query::near(0.1 * world.0)] {
                rows += same(&mut both, query).unwrap_or_else(|error| panic!("{world:?}: {error}"));
            }
        }
        assert!(rows > 0, "{world:?}");
    }
}

#[test]
fn queries_in_between_change_nothing() {
    let mut rng = SmallRng::seed_from_u64(22);
    let world = WORLDS[0];
    let scene = scene_of(8, &mut rng, world, 8, false);
    let mut both = Both::new(&engine(), &scene);
    for frame in 0..3 {
        let all = steps(&mut rng, &scene, world, Ways::Any);
        moved(&mut both, &all[frame..]);
        same(&mut both, Query::discrete()).expect("the same");
        same(&mut both, Query::continuous()).expect("the same");
        let [found, expected] =
            [&mut both.own, &mut both.judge].map(|detector| detector.query(&Query::distance()));
        assert_eq!(found.expect("an answer").hash(), expected.expect("an answer").hash(), "{frame}");
        for query in [Query::near(0.1), Query::earliest(), Query::continuous()] {
            same(&mut both, query).unwrap_or_else(|error| panic!("{frame}: {error}"));
        }
    }
    moved(&mut both, &[]);
    same(&mut both, Query::continuous()).expect("the same at rest");
}

#[test]
fn geometry_is_that_of_placed_vertices() {
    let mut rng = SmallRng::seed_from_u64(23);
    for ways in [Ways::Straight, Ways::Any] {
        let scene = scene(&mut rng, WORLDS[1], 12, false);
        let mut both = Both::new(&engine(), &scene);
        moved(&mut both, &steps(&mut rng, &scene, WORLDS[1], ways));
        for query in [Query::continuous(), Query::near(0.1)] {
            let found = both.own.query(&query).expect("an answer");
            let expected = both.judge.query(&query.with_broad_phase(BroadPhase::Tiles)).expect("an answer");
            assert!(found.len() > 5, "{}", found.len());
            let own = both.own.geometry(&found).expect("geometry");
            assert_eq!(own, both.judge.geometry(&expected).expect("geometry"), "{query:?}");
        }
    }
}

#[test]
fn any_schedule_finds_them() {
    let world = (1.0, [0.0; 3], 0.7);
    for order in ORDERS {
        let mut rng = SmallRng::seed_from_u64(24);
        let scene = scene(&mut rng, world, 5, false);
        let emulator = Emulator::new(Mode::Sanitizer(order), None).expect("threads");
        let mut both = Both::new(&Device::emulator(emulator), &scene);
        moved(&mut both, &steps(&mut rng, &scene, world, Ways::Turning));
        for query in [Query::continuous(), Query::earliest(), Query::near(0.1)] {
            let rows = same(&mut both, query).unwrap_or_else(|error| panic!("{order:?}: {error}"));
            assert!(rows > 0, "{order:?} {query:?}");
        }
    }
}

#[test]
fn boxes_hold_the_step() {
    let mut rng = SmallRng::seed_from_u64(25);
    for world in &WORLDS[..2] {
        let scene = scene(&mut rng, *world, 12, false);
        let mut detector = Detector::new(engine(), scene.clone()).expect("a detector");
        detector.update(&steps(&mut rng, &scene, *world, Ways::Any)).expect("moved");
        for query in [Query::continuous(), Query::near(0.1)] {
            detector.query(&query).expect("an answer");
            detector.check_volumes(&query).expect("boxes hold what is in them");
            assert!(detector.fingerprints(&query).expect("hashes").len() > 3);
        }
    }
}

/// A solver whose open pairs may be far apart, and one with a limit of work, have placed vertices.
#[test]
fn solvers_that_leave_far_pairs_open_have_placed_vertices() {
    use nearmiss::research::{Certified, CertifiedPrecision, WithSolver};
    let mut rng = SmallRng::seed_from_u64(26);
    let scene = scene(&mut rng, WORLDS[0], 12, false);
    let mut both = Both::new(&engine(), &scene);
    moved(&mut both, &steps(&mut rng, &scene, WORLDS[0], Ways::Straight));
    let limited = Continuous::default().with_max_iterations(3);
    for query in [Continuous::by(Certified::by(CertifiedPrecision::F32)), limited] {
        same(&mut both, query.into()).expect("the same");
        assert!(!reads(&mut both.own, &query.into()));
    }
}

/// Another motion is a difference.
#[test]
fn a_step_that_differs_is_noticed() {
    let mut rng = SmallRng::seed_from_u64(27);
    let scene = scene(&mut rng, WORLDS[0], 24, false);
    let mut both = Both::new(&engine(), &scene);
    let all = steps(&mut rng, &scene, WORLDS[0], Ways::Turning);
    both.own.update(&all).expect("moved");
    let straight: Vec<_> = all
        .iter()
        .map(|&(id, motion)| match motion {
            Motion::PoseStep(step) => (id, Motion::PoseStep(step.straight())),
            _ => panic!("a step"),
        })
        .collect();
    both.judge.update(&straight).expect("moved");
    let error = same(&mut both, Query::continuous()).expect_err("another step");
    assert!(error.contains("the judge has"), "{error}");
}
