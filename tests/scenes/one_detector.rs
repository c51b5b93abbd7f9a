//! One detector answers several queries: with one memory, one upload, and answers that depend on positions alone.

use nearmiss::contacts::Contacts;
use nearmiss::device::Device;
use nearmiss::mesh::Positions;
use nearmiss::query::Continuous;
use nearmiss::research::{Certified, DetectorExt, QueryExt, WithSolver};
use nearmiss::scene::{BodyId, CollisionFilter, DeviceMotion, DeviceRows, Motion, Number, Pose, Scene};
use nearmiss::{Body, Detector, Discrete, Earliest, Near, Query};
use nearmiss_lab::scene;
use rand::rngs::SmallRng;
use rand::{Rng, SeedableRng};
use support::engine;

/// Queries of every kind; the numbers of some differ.
fn queries() -> Vec<Query> {
    let apart = Certified { min_separation: 0.02, tolerance: Some(1e-3), ..Certified::default() };
    vec![
        Near::within(0.02).into(),
        Earliest::default().into(),
        Discrete::default().into(),
        Query::continuous(),
        Near::within(0.11).into(),
        Continuous::by(apart).into(),
        Query::distance(),
        Query::discrete().with_broad_phase(nearmiss::research::BroadPhase::Tree),
    ]
}

/// Bodies of every kind around one place.
struct Bodies {
    scene: Scene,
    cloth: BodyId,
    ball: BodyId,
}

impl Bodies {
    fn new(seed: u64) -> Bodies {
        let soup = |seed, triangles| scene::soup(triangles, seed, false).expect("a scene");
        let mesh = |seed, triangles| soup(seed, triangles).frames().swap_remove(0);
        let mut scene = Scene::new();
        let cloth = scene.add(soup(seed, 60).with_filter(CollisionFilter::with_self_collision()));
        let ball = scene.add(Body::rigid(mesh(seed + 1, 40)));
        scene.add(Body::fixed(mesh(seed + 2, 50)));
        Bodies { scene, cloth, ball }
    }
}

/// Positions of bodies in a step.
struct Step {
    cloth: [Positions; 2],
    ball: [Pose; 2],
}

impl Step {
    fn random(rng: &mut SmallRng, bodies: &Bodies) -> Step {
        let start = bodies.scene.get(bodies.cloth).expect("a body").positions_t0().to_f64();
        let mut moved = |by: f32| {
            let shift = [0, 1, 2].map(|_| rng.random_range(-by..by));
            let at = |p: &[f64; 3]| [0, 1, 2].map(|k| p[k] as f32 + shift[k]);
            Positions::F32(start.iter().map(at).collect())
        };
        let cloth = [moved(0.2), moved(0.3)];
        let mut pose = || Pose::at([0, 1, 2].map(|_| rng.random_range(-0.2..0.2)));
        Step { cloth, ball: [pose(), pose()] }
    }

    fn motions(&self, bodies: &Bodies) -> [(BodyId, Motion<'_>); 2] {
        let [start, end] = &self.cloth;
        [(bodies.cloth, Motion::step(start, end)), (bodies.ball, Motion::PoseStep(self.ball.into()))]
    }
}

/// The answer of a detector with this query alone.
fn alone(bodies: &Bodies, step: &Step, query: &Query) -> Contacts {
    let mut detector = Detector::new(engine(), bodies.scene.clone()).expect("a detector");
    detector.step(&step.motions(bodies), query).expect("an answer")
}

/// How two answers differ.
fn difference(found: &Contacts, wanted: &Contacts) -> Option<String> {
    let of = |answer: &Contacts| {
        (answer.rows.clone(), answer.starts_crossing, answer.caveats().to_vec(), answer.is_free())
    };
    (of(found) != of(wanted))
        .then(|| format!("{:?}: {} rows, alone {}", found.query, found.rows.len(), wanted.rows.len()))
}

/// The first query of a life whose answer differs from that of a detector with it alone. `spoil`
/// plants a fault.
fn life(seed: u64, spoil: impl Fn(&mut Contacts)) -> (usize, Option<String>) {
    let mut rng = SmallRng::seed_from_u64(seed);
    let bodies = Bodies::new(10 * seed);
    let mut detector = Detector::new(engine(), bodies.scene.clone()).expect("a detector");
    let all = queries();
    let mut found = 0;
    for _ in 0..4 {
        let step = Step::random(&mut rng, &bodies);
        detector.update(&step.motions(&bodies)).expect("moved");
        for _ in 0..5 {
            let query = all[rng.random_range(0..all.len())];
            if rng.random_bool(0.1) {
                detector.rebuild().expect("built");
            }
            let mut answer = detector.query(&query).expect("an answer");
            spoil(&mut answer);
            found += answer.rows.len();
            detector.check_volumes(&query).expect("sound volumes");
            if let Some(what) = difference(&answer, &alone(&bodies, &step, &query)) {
                return (found, Some(what));
            }
        }
    }
    (found, None)
}

#[test]
fn an_answer_does_not_depend_on_what_was_asked_before() {
    let mut found = 0;
    for seed in 0..12 {
        let (rows, fault) = life(seed, |_| ());
        assert_eq!(fault, None, "seed {seed}");
        found += rows;
    }
    assert!(found > 5_000, "{found}");
}

#[test]
fn an_answer_that_is_not_its_own_is_named() {
    let forget = |answer: &mut Contacts| {
        if let nearmiss::Rows::Near(pairs) = &mut answer.rows {
            pairs.to_mut().pop();
        }
    };
    let fault = (0..4).find_map(|seed| life(seed, forget).1).expect("a difference");
    assert!(fault.contains("Near"), "{fault}");
}

/// A cloth that folds, a step at a time.
fn cloth() -> Body {
    scene::scene("cloth-ball", 3_000, 3).expect("a scene")
}

/// The three queries of every step of a barrier method.
const STEP: usize = 3;

fn ask_three(detector: &mut Detector) -> [usize; STEP] {
    let near = detector.query(&Near::within(1e-3)).expect("an answer").len();
    let first = detector.query(&Earliest::default()).expect("an answer").iter().len();
    [near, first, detector.query(&Discrete::default()).expect("an answer").len()]
}

#[test]
fn three_queries_take_at_most_1_3_times_the_memory_of_one() {
    let (body, device) = (cloth(), engine());
    let one = engine();
    let mut alone = Detector::new(one.clone(), body.clone()).expect("a detector");
    alone.query(&Earliest::default()).expect("an answer");
    let mut detector = Detector::new(device.clone(), body).expect("a detector");
    ask_three(&mut detector);
    let ratio = device.bytes().0 as f64 / one.bytes().0 as f64;
    assert!(ratio > 1.0 && ratio <= 1.3, "{ratio}");
}

/// Bytes of positions that a call copies to the device.
fn uploaded(detector: &mut Detector, device: &Device, call: impl FnOnce(&mut Detector)) -> u64 {
    let before = device.uploaded();
    call(detector);
    device.uploaded() - before
}

#[test]
fn positions_are_uploaded_once_a_step_whatever_is_asked() {
    let (body, device) = (cloth(), engine());
    let [start, end] = body.ends().map(Clone::clone);
    let mut detector = Detector::new(device.clone(), body).expect("a detector");
    let id = detector.scene().ids().next().expect("a body");
    ask_three(&mut detector);
    let moves = |detector: &mut Detector| {
        detector.update(&[(id, Motion::step(&start, &end))]).expect("moved");
    };
    let bytes = uploaded(&mut detector, &device, moves);
    assert_eq!(bytes, 32 * start.len() as u64, "both ends of every vertex");
    let asks = |detector: &mut Detector| {
        ask_three(detector);
    };
    // Lists grow at first.
    asks(&mut detector);
    assert_eq!(uploaded(&mut detector, &device, asks), 0);
}

#[test]
fn numbers_of_a_query_change_from_frame_to_frame_and_build_nothing() {
    let bodies = Bodies::new(3);
    let device = engine();
    let mut detector = Detector::new(device.clone(), bodies.scene.clone()).expect("a detector");
    let certified = |separation: f64, tolerance: f64| {
        let numbers =
            Certified { min_separation: separation, tolerance: Some(tolerance), ..Certified::default() };
        Query::from(Continuous::by(numbers))
    };
    let largest = [Query::near(0.2), certified(0.1, 1e-2)];
    // Twice: the first query in motion takes memory again, with both ends of the step.
    for query in largest.iter().chain(&largest) {
        detector.query(query).expect("an answer");
    }
    let (builds, taken) = (detector.builds(), device.allocations());
    for k in 1..8 {
        let part = f64::from(k) / 8.0;
        for query in [Query::near(0.2 * part), certified(0.1 * part, 1e-2 * part)] {
            let found = detector.query(&query).expect("an answer");
            let mut own = Detector::new(engine(), bodies.scene.clone()).expect("a detector");
            let wanted = own.query(&query).expect("an answer");
            assert_eq!(difference(&found, &wanted), None);
        }
    }
    assert_eq!((detector.builds(), device.allocations()), (builds, taken));
}

#[test]
fn one_submission_holds_several_queries() {
    let (body, device) = (cloth(), engine());
    let points = |positions: &Positions| match positions {
        Positions::F32(points) => points.clone(),
        Positions::F64(_) => panic!("a scene in singles"),
    };
    let [start, end] = body.ends().map(points);
    let mut memory = [device.upload(&start).expect("memory"), device.upload(&end).expect("memory")];
    let rows = [0, 1].map(|k: usize| {
        let (address, count) = (memory[k].span().addr(), memory[k].len());
        // SAFETY: the buffers outlive the detector, and are written between submissions alone.
        unsafe { DeviceRows::new(address, count, 12, Number::F32) }.expect("rows")
    });
    let mut detector = Detector::new(device, body.clone()).expect("a detector");
    let id = detector.scene().ids().next().expect("a body");
    let queries = [Query::near(1e-3), Query::earliest(), Query::discrete()];
    detector.prepare(&[(id, DeviceMotion::Step(rows))], &queries).expect("prepared");
    assert!(detector.is_prepared() && queries.iter().all(|query| detector.on_device(query).is_some()));
    assert!(detector.on_device(&Query::continuous()).is_none());
    for step in 0..3 {
        let shifted = |points: &[[f32; 3]]| -> Vec<[f32; 3]> {
            points.iter().map(|p| [p[0], p[1] * (1.0 - 0.001 * step as f32), p[2]]).collect()
        };
        let ends = [shifted(&start), shifted(&end)];
        memory.iter_mut().zip(&ends).for_each(|(to, from)| to.write(from).expect("written"));
        detector.submit().expect("submitted");
        for query in &queries {
            let found = detector.collect(query).expect("an answer");
            let [start, end] = ends.clone().map(Positions::F32);
            let mut own = Detector::new(engine(), body.clone()).expect("a detector");
            let wanted = own.step(&[(id, Motion::step(&start, &end))], query).expect("an answer");
            assert_eq!(found.rows, wanted.rows, "{query:?}, step {step}");
        }
    }
}

#[test]
fn a_submission_without_a_query_or_with_two_of_one_shape_is_refused() {
    let mut detector = Detector::new(engine(), cloth()).expect("a detector");
    let mut refused = |queries: &[Query]| detector.prepare(&[], queries).expect_err("refused").to_string();
    assert!(refused(&[]).contains("at least one query"));
    let two = refused(&[Query::near(1e-3), Query::earliest(), Query::near(2e-3)]);
    assert!(two.contains("two near queries"), "{two}");
}

/// Numbers that were not prepared are answered, never with rows of others.
#[test]
fn a_submission_has_the_numbers_that_it_was_prepared_with() {
    // At rest: a body that no motion names stays where its step ended.
    let body = Body::deformable(cloth().frames().swap_remove(0));
    let [small, large] = [Query::near(1e-3), Query::near(4e-3)];
    let alone = |query: &Query| {
        Detector::new(engine(), body.clone()).expect("a detector").query(query).expect("an answer")
    };
    let mut detector = Detector::new(engine(), body.clone()).expect("a detector");
    let before = detector.query(&large).expect("an answer");
    detector.prepare(&[], &[small]).expect("prepared");
    assert!(detector.on_device(&small).is_some() && detector.on_device(&large).is_none());
    detector.submit().expect("submitted");
    assert_eq!(detector.collect(&small).expect("an answer").rows, alone(&small).rows);
    // Geometry of an answer with other numbers ends the preparation, and the next submission is refused.
    detector.geometry(&before).expect("places");
    assert!(!detector.is_prepared() && detector.submit().is_err());
    detector.prepare(&[], &[small]).expect("prepared");
    detector.submit().expect("submitted");
    let found = detector.collect(&large).expect("an answer");
    assert_eq!(found.rows, alone(&large).rows);
    assert_ne!(found.rows, alone(&small).rows);
}

/// Without a submission, and after an interrupted call, a collection answers as a query does.
#[test]
fn a_collection_without_a_submission_misses_nothing() {
    let body = Body::deformable(cloth().frames().swap_remove(0));
    let query = Query::near(1e-3);
    let wanted = Detector::new(engine(), body.clone()).expect("a detector").query(&query).expect("an answer");
    assert!(!wanted.rows.is_empty());
    let mut detector = Detector::new(engine(), body).expect("a detector");
    assert!(detector.submit().expect_err("refused").to_string().contains("not prepared"));
    assert_eq!(detector.collect(&query).expect("an answer").rows, wanted.rows);
    detector.prepare(&[], &[query]).expect("prepared");
    detector.submit().expect("submitted");
    detector.interrupter().trigger();
    detector.query(&Query::near(2e-3)).expect_err("interrupted");
    assert_eq!(detector.collect(&query).expect("an answer").rows, wanted.rows);
    assert!(!detector.is_prepared() && detector.submit().is_err());
}

/// A distance query sees nothing of a body alone. Memory that is taken again after it is that of the
/// other queries: in motion for the first time, in doubles, after an interrupted call, prepared.
#[test]
fn a_distance_query_hides_nothing_from_later_ones() {
    let (near, moving) = (Query::near(1e-3), Query::continuous());
    let ends = cloth().frames();
    let body = || Body::deformable(ends[0].clone());
    let fresh = || Detector::new(engine(), body()).expect("a detector");
    let [t0, t1] = [0, 1].map(|end| ends[end].positions().clone());
    let id = fresh().scene().ids().next().expect("a body");
    let step = [(id, Motion::step(&t0, &t1))];
    let wanted = fresh().step(&step, &moving).expect("an answer");
    let wanted_near = fresh().query(&near).expect("an answer");
    assert!(!wanted.is_empty() && !wanted_near.is_empty());
    let blind = || {
        let mut detector = fresh();
        detector.query(&near).expect("an answer");
        assert!(detector.query(&Query::distance()).expect("an answer").is_empty());
        detector
    };
    let mut detector = blind();
    let found = detector.step(&step, &moving).expect("an answer");
    assert_eq!((&found.rows, found.is_free()), (&wanted.rows, wanted.is_free()));
    let mut detector = blind();
    let wide = t0.to_f64();
    let found = detector.step(&[(id, Motion::positions(&wide))], &near).expect("an answer");
    assert_eq!(found.rows, wanted_near.rows, "in doubles");
    let mut detector = blind();
    detector.interrupter().trigger();
    detector.query(&near).expect_err("interrupted");
    assert_eq!(detector.query(&near).expect("an answer").rows, wanted_near.rows, "interrupted");
    let mut detector = blind();
    detector.prepare(&[], &[near]).expect("prepared");
    detector.query(&Query::distance()).expect("an answer");
    detector.interrupter().trigger();
    detector.query(&near).expect_err("interrupted");
    assert!(!detector.is_prepared() && detector.submit().is_err());
    assert_eq!(detector.collect(&near).expect("an answer").rows, wanted_near.rows, "collected");
}
