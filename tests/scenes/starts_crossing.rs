//! The triangle pairs that share a point at the start of a step: as many as a discrete query lists
//! there, on every way.

use nearmiss::contacts::{Contacts, Note, Rows};
use nearmiss::device::emulator::{Emulator, Mode};
use nearmiss::mesh::Positions;
use nearmiss::query::{Continuous, Discrete, Earliest, QueryKind};
use nearmiss::research::{Certified, QueryExt, TriangleTest, WithSolver};
use nearmiss::scene::{BodyId, BodyKind, CollisionFilter, Motion, Pose, Scene};
use nearmiss::{Body, Device, Mesh, Query};
use nearmiss_lab::scene;
use nearmiss_lab::{OneQuery, OneQueryOnSeveral};
use rand::rngs::SmallRng;
use rand::{Rng, SeedableRng};
use support::{ORDERS, engine, sanitizer, ways};

fn threads(count: usize) -> Device {
    Device::emulator(Emulator::new(Mode::Engine, Some(count)).expect("threads"))
}

/// A crumpled sheet of `n` by `n` squares, so that neighbours share vertices and others cross; its
/// end is another sheet.
fn crumpled(n: u32, rng: &mut SmallRng) -> [Mesh; 2] {
    let faces: Vec<[u32; 3]> = (0..n * n)
        .flat_map(|i| {
            let corner = i / n * (n + 1) + i % n;
            [[corner, corner + 1, corner + n + 1], [corner + 1, corner + n + 2, corner + n + 1]]
        })
        .collect();
    [0.3, 0.5].map(|jitter| {
        let corner = |i: u32| {
            let [x, y] = [i % (n + 1), i / (n + 1)].map(|k| f64::from(k) / f64::from(n));
            [x, y, 0.5].map(|x| (x + rng.random_range(-jitter..jitter)) as f32)
        };
        let points = (0..(n + 1) * (n + 1)).map(corner).collect();
        Mesh::new("a sheet", Positions::F32(points), faces.clone()).expect("a mesh")
    })
}

/// The same in doubles, off the floats.
fn doubled(mesh: &Mesh) -> Mesh {
    let points = (0..mesh.positions().len()).filter_map(|i| mesh.positions().get_f64(i));
    let points = points.map(|p| p.map(|x| x + 1e-11 * x)).collect();
    Mesh::new("in doubles", Positions::F64(points), mesh.faces().to_vec()).expect("a mesh")
}

/// Bodies of every kind, of environments and groups.
fn random_scene(seed: u64) -> Scene {
    let mut rng = SmallRng::seed_from_u64(seed);
    let mut scene = Scene::new();
    for i in 0..6 {
        let mut ends = if rng.random_bool(0.5) {
            crumpled(rng.random_range(1..5), &mut rng)
        } else {
            let body = scene::soup(rng.random_range(1..40), 100 * seed + i, true).expect("a soup");
            let [t0, t1] = body.frames().try_into().expect("two frames");
            [t0, t1]
        };
        if seed % 3 == 1 {
            ends = ends.each_ref().map(doubled);
        }
        let [t0, t1] = ends;
        let body = match rng.random_range(0..4) {
            0 => Body::fixed(t0),
            1 => {
                let end = Pose { rotation: [0.1, 0.0, 0.0, 0.99f64.sqrt()], translation: [0.1, 0.0, 0.2] };
                Body::rigid(t0).at(Motion::PoseStep([Pose::default(), end].into())).expect("poses")
            }
            _ => Body::moving(t0, t1).expect("two frames"),
        };
        let is_plain = seed.is_multiple_of(2);
        let self_collision = (body.kind() != BodyKind::Fixed).then(|| rng.random_bool(0.5));
        scene.add(body.with_filter(CollisionFilter {
            environment: [Some(0), Some(0), Some(1), None][rng.random_range(0..4)],
            group: if is_plain { u32::MAX } else { rng.random_range(0..4) },
            mask: if is_plain { u32::MAX } else { rng.random_range(0..4) },
            self_collision,
        }));
    }
    scene
}

/// Every query in motion, with a tolerance that does not depend on the bodies; with and without a
/// separation.
fn queries() -> impl Iterator<Item = Query> {
    let apart = Certified { tolerance: Some(1e-4), min_separation: 0.02, ..Certified::default() };
    let every = Query::every().filter(|query| !query.kind().is_at_rest());
    every
        .map(|query| support::asked::with_tolerance(query, 1e-4))
        .chain([Continuous::by(apart).into(), Earliest::by(apart).into()])
}

fn found(device: Device, scene: &Scene, query: Query) -> Contacts {
    OneQuery::new(device, scene.clone(), query).expect("a detector").detect().expect("an answer")
}

/// How many pairs a discrete query lists.
fn listed(scene: &Scene, query: Query) -> u64 {
    found(engine(), scene, query).pairs().len() as u64
}

/// How an answer's count differs from what a discrete query lists.
fn differs(found: &Contacts, listed: u64) -> Option<String> {
    let count = found.starts_crossing;
    (count != Some(listed)).then(|| format!("{count:?} pairs cross at the start, {listed} are listed there"))
}

#[test]
fn as_many_as_a_discrete_query_lists() {
    let (mut all, mut free) = (0, 0);
    for seed in 0..24 {
        let scene = random_scene(seed);
        let listed = listed(&scene, Query::discrete());
        for query in queries() {
            for device in [threads(1), threads(2)] {
                let found = found(device, &scene, query);
                assert_eq!(differs(&found, listed), None, "seed {seed}, {query:?}");
                assert_eq!(found.is_free(), listed == 0 && found.is_empty(), "seed {seed}, {query:?}");
            }
        }
        all += listed;
        free += u64::from(listed == 0);
    }
    assert!(all > 1_000 && free < 12, "{all} pairs in all, {free} scenes without one");
}

#[test]
fn on_every_way_and_in_every_order() {
    for seed in [2, 3, 4] {
        let scene = random_scene(seed);
        let listed = listed(&scene, Query::discrete());
        assert!(listed > 0, "seed {seed}");
        for query in [Query::continuous(), Query::earliest()] {
            for query in ways(query) {
                assert_eq!(differs(&found(engine(), &scene, query), listed), None, "seed {seed}, {query:?}");
            }
            for order in ORDERS {
                assert_eq!(
                    differs(&found(sanitizer(order), &scene, query), listed),
                    None,
                    "seed {seed}, {query:?}"
                );
            }
        }
    }
}

/// The end of the step, pairs with a common vertex, and other filters: each is another number, and
/// is noticed.
#[test]
fn another_count_is_noticed() {
    let [t0, t1] = crumpled(6, &mut SmallRng::seed_from_u64(5));
    let step = |a: &Mesh, b: &Mesh| Scene::from(Body::moving(a.clone(), b.clone()).expect("two frames"));
    let scene = step(&t0, &t1);
    let right = listed(&scene, Query::discrete());
    let of = |scene: &Scene| found(engine(), scene, Query::continuous());
    assert_eq!(differs(&of(&scene), right), None);
    let text = differs(&of(&step(&t1, &t0)), right).expect("the other end");
    assert!(text.contains(&format!("{right} are listed")), "{text}");
    let adjacent = listed(&scene, Discrete::by(TriangleTest::Exact { adjacent: true }).into());
    assert!(adjacent > right && differs(&of(&scene), adjacent).is_some());
    let mut two = Scene::new();
    for mesh in [&t0, &t1] {
        two.add(Body::deformable(mesh.clone()).with_filter(CollisionFilter::default()));
    }
    let mut apart = Scene::new();
    for (world, mesh) in [&t0, &t1].into_iter().enumerate() {
        apart.add(Body::deformable(mesh.clone()).with_filter(CollisionFilter::in_environment(world as u32)));
    }
    assert!(differs(&of(&apart), listed(&two, Query::discrete())).is_some());
}

/// A detector that is kept: each frame's count is that of its own start.
#[test]
fn frame_after_frame() {
    let rng = &mut SmallRng::seed_from_u64(9);
    let sheets: Vec<Mesh> = (0..4).flat_map(|_| crumpled(8, rng)).collect();
    for query in [Query::continuous(), Query::earliest()] {
        let scene = Scene::from(Body::deformable(sheets[0].clone()));
        let id: BodyId = scene.ids().next().expect("a body");
        let [mut moving, mut still] = [query, Query::discrete()]
            .map(|q| OneQuery::new(engine(), scene.clone(), q).expect("a detector"));
        for ends in sheets.windows(2) {
            let [t0, t1] = [ends[0].positions(), ends[1].positions()];
            let found = moving.frame(&[(id, Motion::step(t0, t1))]).expect("an answer");
            let listed = still.frame(&[(id, Motion::positions(t0))]).expect("an answer").len() as u64;
            assert!(listed > 10);
            assert_eq!(differs(&found, listed), None, "{query:?}");
        }
    }
}

/// So many tiles that an earliest query has a sample, whose bound cuts the volumes; several
/// devices; slices.
#[test]
fn behind_a_sample_on_several_devices_and_in_slices() {
    let scene = Scene::from(scene::soup(70_000, 7, true).expect("a soup"));
    let listed = listed(&scene, Query::discrete());
    assert!(listed > 1_000, "{listed}");
    let device = engine();
    let whole = found(device.clone(), &scene, Query::earliest());
    assert_eq!(differs(&whole, listed), None);
    let mut several =
        OneQueryOnSeveral::new(vec![engine(), engine(), engine()], scene.clone(), Query::earliest())
            .expect("detectors");
    assert_eq!(differs(&several.detect().expect("an answer"), listed), None);
    let sliced = found(engine().with_memory_limit(device.bytes().1 * 3 / 4), &scene, Query::earliest());
    assert!(sliced.stats.slices > 1, "{} slices", sliced.stats.slices);
    assert_eq!(differs(&sliced, listed), None);
}

/// Triangles in one oblique plane that floats cannot see: more pairs than the lists between the
/// filters have room for.
#[test]
fn lists_of_undecided_pairs_grow() {
    const N: u32 = 110;
    let triangles = support::triangles::in_one_plane(N);
    let mut detector =
        OneQuery::new(engine(), support::loose(&triangles), Query::continuous()).expect("a detector");
    let first = detector.detect().expect("an answer");
    assert!(
        first.stats.reruns > 0 && first.stats.uncertain > 4_096,
        "{} reruns, {} uncertain",
        first.stats.reruns,
        first.stats.uncertain
    );
    for found in [first, detector.detect().expect("an answer")] {
        assert_eq!(differs(&found, u64::from(N * (N - 1) / 2)), None);
    }
}

/// With `assume_free` there is no kernel, no memory and no launch of it, and the answer is the
/// same.
#[test]
fn what_is_assumed_costs_nothing() {
    let singles = Scene::from(scene::soup(200, 3, true).expect("a soup"));
    let rng = &mut SmallRng::seed_from_u64(1);
    let [t0, t1] = crumpled(10, rng).each_ref().map(doubled);
    let doubles = Scene::from(Body::moving(t0, t1).expect("two frames"));
    let pairs: [fn(bool) -> Query; 2] = [
        |free| Continuous::default().assuming_free(free).into(),
        |free| Earliest::default().assuming_free(free).into(),
    ];
    for (scene, launches) in [(singles, 3), (doubles, 2)] {
        for query in pairs {
            let [checked, assumed] = [false, true].map(|free| {
                let device = engine();
                let mut detector =
                    OneQuery::new(device.clone(), scene.clone(), query(free)).expect("a detector");
                let plan = detector.plan().expect("a plan");
                let before = device.launches();
                let found = detector.detect().expect("an answer");
                (plan, found, device.launches() - before, device.bytes().0)
            });
            assert_eq!((checked.1.rows, checked.1.starts_crossing.is_some()), (assumed.1.rows.clone(), true));
            assert_eq!((assumed.1.starts_crossing, assumed.1.is_free()), (None, false));
            let names = |plan: &nearmiss::plan::Plan| -> Vec<String> {
                let kernels = plan.frame.iter().flat_map(|stage| stage.kernels.iter().map(|one| one.kernel));
                let buffers = plan.buffers.iter().map(|buffer| buffer.what);
                kernels.chain(buffers).filter(|name| name.contains("start")).map(str::to_owned).collect()
            };
            // As many kernels, and a list between one and the next.
            assert_eq!(names(&checked.0).len(), 2 * launches - 1, "{:?}", names(&checked.0));
            assert_eq!(names(&assumed.0), [""; 0]);
            assert_eq!(checked.2 - assumed.2, launches as u64);
            let held: u64 = checked
                .0
                .buffers
                .iter()
                .filter(|b| b.what.contains("at the start"))
                .map(|b| b.held.bytes)
                .sum();
            assert_eq!(checked.3 - assumed.3, held);
            assert!(assumed.0.left_out.iter().any(|left| left.what == "check of the start"));
        }
    }
}

/// Bodies that cross and rest: no time of contact, and no freedom.
#[test]
fn what_crosses_is_never_free() {
    let floor = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]];
    let through = [[1.0, 1.0, -1.0], [1.0, 1.0, 1.0], [9.0, 9.0, 1.0]];
    let above = through.map(|[x, y, z]| [x, y, z + 5.0]);
    for (other, crossing) in [(through, 1), (above, 0)] {
        let scene = Scene::from(support::loose(&[floor, other]));
        for query in queries() {
            let found = found(engine(), &scene, query);
            assert_eq!(
                (found.len(), found.starts_crossing, found.is_free()),
                (0, Some(crossing), crossing == 0)
            );
            let notes = Note::of(scene.bodies(), &query, &found);
            assert!(notes.contains(&Note::OneFrame));
            assert_eq!(notes.contains(&Note::StartsCrossing { pairs: 1 }), crossing == 1, "{notes:?}");
        }
        let still = |query| found(engine(), &scene, query);
        assert_eq!(still(Query::discrete()).is_free(), crossing == 0);
        assert!(!still(Query::near(0.1)).is_free());
        let mut two = Scene::new();
        for one in [floor, other] {
            two.add(support::loose(&[one]));
        }
        assert_eq!(found(engine(), &two, Query::distance()).is_free(), crossing == 0);
    }
    // Nothing can meet: it is known without a frame.
    let alone = Scene::from(vec![Body::fixed(crumpled(3, &mut SmallRng::seed_from_u64(2))[0].clone())]);
    let found = found(engine(), &alone, Query::earliest());
    assert_eq!(
        (found.rows.clone(), found.starts_crossing, found.is_free()),
        (Rows::Earliest(None), Some(0), true)
    );
    assert_eq!(Contacts::none(Query::discrete()).starts_crossing, None);
    assert_eq!(QueryKind::ALL.iter().filter(|kind| !kind.is_at_rest()).count(), 2);
}
