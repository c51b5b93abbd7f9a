//! A scene that is divided among devices: the answer of one, to the bit, however it is divided.

mod submitted;

use nearmiss::mesh::{Body, Positions};
use nearmiss::query::{Query, QueryKind};
use nearmiss::research::{BoundingVolume, BroadPhase, QueryExt};
use nearmiss::scene::{BodyId, CollisionFilter, DeviceMotion, DeviceRows, Motion, Number, Scene};
use nearmiss::{Contacts, Detector, Device, MultiDetector};
use nearmiss_lab::scene::{self, Bodies};
use nearmiss_lab::{OneQuery, OneQueryOnSeveral};
use support::{ORDERS, asked, cases, engine, sanitizer};

fn devices(count: usize) -> Vec<Device> {
    (0..count).map(|_| engine()).collect()
}

fn queries() -> Vec<Query> {
    let kinds = [QueryKind::Discrete, QueryKind::Continuous, QueryKind::Earliest];
    kinds.map(asked::of).into_iter().chain([Query::near(0.01)]).collect()
}

/// The same answer, of the same candidates. The work of an earliest query depends on earlier finds.
fn is_the_same(one: &Contacts, several: &Contacts, what: &str) {
    assert_eq!(one.rows, several.rows, "{what}");
    assert_eq!(one.hash(), several.hash(), "{what}");
    assert_eq!(one.starts_crossing, several.starts_crossing, "{what}");
    if !matches!(one.rows, nearmiss::Rows::Earliest(_)) {
        assert_eq!(one.stats.triangle_pairs, several.stats.triangle_pairs, "{what}");
        assert_eq!(one.stats.candidates_vf_ee, several.stats.candidates_vf_ee, "{what}");
        assert_eq!(one.undecided, several.undecided, "{what}");
        assert_eq!(one.caveats(), several.caveats(), "{what}");
    }
}

#[test]
fn a_mesh_has_the_same_answer_on_any_number_of_devices() {
    for body in [scene::draped(2_000), scene::soup(500, 3, true)].map(|body| body.expect("a scene")) {
        for (at, query) in queries().into_iter().enumerate() {
            for (turn, volume) in (at..).zip(BoundingVolume::ALL) {
                let query = query.with_volume(volume);
                // Several devices take tiles, for any volume.
                let tiles = query.with_broad_phase(BroadPhase::Tiles);
                let mut one = OneQuery::new(engine(), body.clone(), tiles).expect("a detector");
                let want = one.detect().expect("an answer");
                assert!(!want.is_empty(), "{query:?}");
                // The numbers of devices take turns.
                for count in [2, 3, 40].into_iter().cycle().skip(turn % 3).take(cases(1, 3)) {
                    let mut several =
                        OneQueryOnSeveral::new(devices(count), body.clone(), query).expect("detectors");
                    assert_eq!(Some(several.tolerance()), one.tolerance().or(Some(several.tolerance())));
                    // As it was divided at first, and by what was measured.
                    for frame in 0..3 {
                        let found = several.detect().expect("an answer");
                        is_the_same(&want, &found, &format!("{query:?}, {count} devices, frame {frame}"));
                    }
                }
            }
        }
    }
}

#[test]
fn bodies_that_move_are_divided_anew_and_found_alike() {
    let scene = Bodies::pile(40, 20, 10).expect("a pile");
    for query in queries() {
        // One device alone would have instances, whose candidates are fewer.
        let tiles = query.with_broad_phase(BroadPhase::Tiles);
        let mut one = OneQuery::new(engine(), scene.scene.clone(), tiles).expect("a detector");
        let machines = vec![engine(), sanitizer(ORDERS[2]), engine()];
        let clones = vec![machines[0].clone(); 2];
        let mut several = OneQueryOnSeveral::new(machines, scene.scene.clone(), query).expect("detectors");
        let mut tiles = Vec::new();
        for step in 0..4 {
            let moves = scene.step(step);
            let inputs: Vec<_> = moves.iter().map(|(id, to)| (*id, to.input())).collect();
            let (want, found) = (one.frame(&inputs), several.frame(&inputs));
            let (want, found) = (want.expect("an answer"), found.expect("an answer"));
            is_the_same(&want, &found, &format!("{query:?}, step {step}"));
            if step == 2 {
                one.rebuild().expect("tiles");
                several.rebuild().expect("tiles");
            }
            tiles.push(several.shares().iter().map(|share| share.tiles).collect::<Vec<_>>());
            assert!((tiles[step as usize].iter().sum::<f64>() - 1.0).abs() < 1e-9);
            assert!(several.shares().iter().all(|share| share.ms > 0.0));
        }
        // One of the three counts every access, and is slower by far: that is uneven.
        assert!(tiles[1..].iter().any(|later| *later != tiles[0]), "{query:?}: {tiles:?}");
        let geometry = |want: nearmiss::contacts::Geometry| format!("{want:?}");
        let (want, found) = (one.detect().expect("again"), several.in_turn().detect().expect("again"));
        is_the_same(&want, &found, "in turn");
        let mut clones = OneQueryOnSeveral::new(clones, scene.scene.clone(), query).expect("detectors");
        for step in 0..4 {
            let moves = scene.step(step);
            let inputs: Vec<_> = moves.iter().map(|(id, to)| (*id, to.input())).collect();
            let found = clones.frame(&inputs).expect("an answer");
            if step == 3 {
                is_the_same(&want, &found, "clones of one device");
            }
        }
        if matches!(query, Query::Continuous(_) | Query::Near(_) | Query::Discrete(_)) {
            assert_eq!(
                geometry(one.geometry(&want).expect("points")),
                geometry(one.geometry(&found).expect("points"))
            );
        }
    }
}

#[test]
fn rows_by_feature_are_those_of_one_device() {
    use nearmiss::contacts::GroupBy;
    let soup = scene::soup(200, 3, false).expect("a soup");
    let mut one = Detector::new(engine(), soup.clone()).expect("a detector");
    let mut several = MultiDetector::new(vec![engine(), engine()], soup).expect("detectors");
    let id = one.scene().ids().next().expect("a body");
    let near = nearmiss::Near::within(0.1);
    let [a, b] = [one.query(&near), several.query(&near)].map(|answer| answer.expect("an answer"));
    assert!(a.len() > 10 && a.rows == b.rows);
    for by in GroupBy::ALL {
        let found = several.grouped(&b, id, by).expect("groups");
        assert!(found == one.grouped(&a, id, by).expect("groups") && !found.is_empty(), "{by:?}");
    }
    let least = several.least_by_vertex(&b, id).expect("distances");
    assert_eq!(least, one.least_by_vertex(&a, id).expect("distances"));
    let pairs = several.query(&nearmiss::Discrete::default()).expect("pairs");
    assert!(several.least_by_vertex(&pairs, id).is_err());
}

#[test]
fn bodies_come_and_go_on_every_device() {
    let ball = |seed| {
        scene::soup(200, seed, true).expect("a soup").with_filter(CollisionFilter::with_self_collision())
    };
    let mut scene = Scene::new();
    scene.add(ball(1));
    let query = asked::of(QueryKind::Continuous);
    let mut one = OneQuery::new(engine(), scene.clone(), query).expect("a detector");
    let mut several = OneQueryOnSeveral::new(devices(2), scene, query).expect("detectors");
    let same = |one: &mut OneQuery, several: &mut OneQueryOnSeveral, what: &str| {
        is_the_same(&one.detect().expect("an answer"), &several.detect().expect("an answer"), what);
        assert_eq!(one.scene().ids().collect::<Vec<_>>(), several.scene().ids().collect::<Vec<_>>());
    };
    same(&mut one, &mut several, "one body");
    let added: [BodyId; 2] = [one.add(ball(2)).expect("room"), several.add(&ball(2)).expect("room")];
    assert_eq!(added[0], added[1]);
    same(&mut one, &mut several, "two");
    one.replace(added[0], ball(3)).expect("there");
    several.replace(added[0], &ball(3)).expect("there");
    same(&mut one, &mut several, "another");
    assert_eq!(
        one.remove(added[0]).expect("there").face_count(),
        several.remove(added[0]).expect("there").face_count()
    );
    same(&mut one, &mut several, "one again");
    assert!(several.remove(added[0]).is_err());
    same(&mut one, &mut several, "after a refusal");
}

#[test]
fn what_cannot_be_divided_is_refused() {
    let two = [scene::soup(50, 1, false), scene::soup(50, 2, false)].map(|body| body.expect("a soup"));
    let two = support::between(two.to_vec());
    let refused = |count: usize, bodies: Vec<Body>, query: Query| {
        let error = OneQueryOnSeveral::new(devices(count), bodies, query).map(drop).expect_err("refused");
        assert_eq!(error.exit_code(), 2, "{error}");
        error.to_string()
    };
    let text = refused(0, two.to_vec(), Query::discrete());
    assert!(text.contains("no device"), "{text}");
    let text = refused(2, two.to_vec(), Query::distance());
    assert!(text.contains("a distance on several devices"), "{text}");
    let text = refused(2, two.to_vec(), Query::discrete().with_broad_phase(BroadPhase::Tree));
    assert!(text.contains("use the broad phase `tiles`"), "{text}");
    // One device does all that a detector does.
    for query in [Query::distance(), Query::discrete().with_broad_phase(BroadPhase::Tree)] {
        let mut one = OneQueryOnSeveral::new(devices(1), two.to_vec(), query).expect("a detector");
        let want = support::ask(engine(), two.to_vec(), query);
        assert_eq!(one.detect().expect("an answer").hash(), want.hash());
    }
    // A fault of the input is that of one detector, and nothing has moved.
    let mut several = OneQueryOnSeveral::new(devices(2), two.to_vec(), Query::discrete()).expect("detectors");
    let before = several.detect().expect("an answer").hash();
    let id = several.scene().ids().next().expect("a body");
    let short = nearmiss::mesh::Positions::F32(vec![[0.0; 3]]);
    assert!(several.frame(&[(id, Motion::positions(&short))]).is_err());
    assert_eq!(several.detect().expect("an answer").hash(), before);
}

/// Tiles beyond a share: none of the whole, none of the last share, and of the others those at the cut.
#[test]
fn tiles_at_the_cut_are_counted() {
    let cells = 64;
    let body = scene::grid(cells).expect("a grid");
    let beyond = |count: usize| {
        let mut several =
            OneQueryOnSeveral::new(devices(count), body.clone(), Query::discrete()).expect("detectors");
        several.detect().expect("an answer");
        several.met_beyond().expect("read")
    };
    assert_eq!(beyond(1), [0]);
    let [two, four] = [2, 4].map(beyond);
    assert!(two[0] > 0 && two[1] == 0 && four[3] == 0, "{two:?} {four:?}");
    let tiles = body.face_count() as u64 / 32;
    assert!(four.iter().sum::<u64>() < tiles / 2 && two[0] < tiles / 4, "{two:?} {four:?} of {tiles}");
}

/// Positions of both ends in memory that a device reads.
fn lent(ends: [&Positions; 2]) -> Motion<'static> {
    let rows = |end: &Positions| {
        let (address, number) = match end {
            Positions::F32(points) => (points.as_ptr() as u64, Number::F32),
            Positions::F64(points) => (points.as_ptr() as u64, Number::F64),
        };
        // SAFETY: a CPU reads it, and the tests keep it.
        unsafe { DeviceRows::new(address, end.len(), 3 * number.bytes(), number) }.expect("rows")
    };
    Motion::OnDevice(DeviceMotion::Step(ends.map(rows)))
}

#[test]
fn positions_in_memory_of_a_device_are_read_by_all() {
    let body = scene::soup(400, 5, true).expect("a soup").with_filter(CollisionFilter::with_self_collision());
    let mut one = nearmiss::Detector::new(engine(), body.clone()).expect("a detector");
    let mut several = nearmiss::MultiDetector::new(devices(3), body.clone()).expect("detectors");
    let id = several.scene().ids().next().expect("a body");
    let [t0, t1] = body.ends();
    for shift in [0.0, 0.02] {
        let moved: Vec<[f64; 3]> = t1.to_f64().iter().map(|&[x, y, z]| [x + shift, y, z]).collect();
        let mut moved = Positions::F64(moved);
        one.update(&[(id, Motion::step(&t0.to_f64(), &moved))]).expect("moved");
        several.update(&[(id, lent([t0, &moved]))]).expect("moved");
        // It was read.
        moved = Positions::F64(vec![[f64::NAN; 3]; moved.len()]);
        for query in queries() {
            let (want, found) =
                (one.query(&query).expect("an answer"), several.query(&query).expect("an answer"));
            is_the_same(&want, &found, &format!("{query:?}, {shift}"));
            assert!(!want.is_empty());
        }
        several.download_positions().expect("there");
        let at = several.scene().get(id).expect("a body").ends()[1].to_f64();
        assert_eq!(at, one.scene().get(id).expect("a body").ends()[1].to_f64());
        let before = several.query(&Query::near(0.01)).expect("an answer").hash();
        let refused = several.update(&[(id, lent([t0, &moved]))]).expect_err("no numbers");
        assert!(matches!(refused, nearmiss::Error::Input { .. }), "{refused}");
        assert_eq!(several.query(&Query::near(0.01)).expect("an answer").hash(), before, "nothing has moved");
    }
}
