//! Whole frames: compared with all pairs tested one by one, in every way, on every machine, moved
//! and turned about.

use nearmiss::Query;
use nearmiss::contacts::{Kind, NearPair, Rows, Status};
use nearmiss::mesh::{Body, Mesh, Positions};
use nearmiss::query::Continuous;
use nearmiss::research::{BoundingVolume, Certified, CertifiedPrecision, QueryExt, WithSolver};
use nearmiss_lab::OneQuery;
use nearmiss_lab::scene;
use rand::rngs::SmallRng;
use rand::{Rng, SeedableRng};
use std::collections::BTreeSet;
use support::judges::near::Truth;
use support::{ORDERS, ask, engine, judged, loose, machines, mesh, sanitizer, still, ways};

/// A body of other positions.
fn placed(body: &Body, at: impl Fn([f64; 3]) -> [f64; 3], single: bool) -> Body {
    let points: Vec<_> = body.positions_t0().to_f64().into_iter().map(at).collect();
    let positions = if single {
        Positions::F32(points.iter().map(|p| p.map(|x| x as f32)).collect())
    } else {
        Positions::F64(points)
    };
    Body::deformable(Mesh::new(body.name(), positions, body.faces().to_vec()).expect("a mesh"))
}

/// In doubles that f32 does not hold.
pub(super) fn turned(body: &Body) -> Body {
    placed(body, |[x, y, z]| [0.6 * x - 0.8 * y, 0.8 * x + 0.6 * y, z + x / 3.0], false)
}

pub(super) fn soup(n: usize, seed: u64) -> Body {
    scene::soup(n, seed, false).expect("a scene")
}

/// Faces, rods and points among few vertices, of which many coincide and lie in a line.
fn degenerate(seed: u64) -> Body {
    let mut r = SmallRng::seed_from_u64(seed);
    let points: Vec<[f32; 3]> = (0..40).map(|_| [0; 3].map(|_| r.random_range(0..5) as f32 * 0.25)).collect();
    let faces: Vec<[u32; 3]> = (0..45).map(|_| [0; 3].map(|_| r.random_range(0..40))).collect();
    let rods = (0..6).map(|i| [i, 39 - i, 39 - i]);
    let dots = (10..16).map(|i| [i; 3]);
    still(&points, &faces.into_iter().chain(rods).chain(dots).collect::<Vec<_>>())
}

/// One body, a connected one, degenerate ones, two; in f32 and in f64.
fn scenes() -> Vec<(Vec<Body>, f64)> {
    vec![
        (vec![soup(50, 5)], 0.05),
        (vec![turned(&scene::draped(100).expect("a scene"))], 0.25),
        (vec![degenerate(1)], 0.25),
        (vec![degenerate(2), degenerate(3)], 0.125),
        (vec![soup(30, 6), turned(&soup(40, 9))], 0.125),
    ]
}

#[test]
fn all_that_is_within_the_distance_is_listed() {
    for (bodies, distance) in scenes() {
        // At the distance itself many pairs of small integers lie: all are within it.
        let truth = Truth::of(&bodies, distance);
        let found = ask(engine(), bodies.clone(), Query::near(distance));
        let what = format!("{}, {distance}", bodies[0].name());
        let beyond = truth.fault(found.near()).unwrap_or_else(|fault| panic!("{fault}: {what}"));
        println!("{what}: {} pairs, {beyond} beyond, {} undecided", found.len(), found.undecided);
        assert!(truth.within.len() > 50 && beyond as u64 <= found.undecided, "{what}");
        assert_eq!(found.len() - beyond, truth.within.len());
        assert!(found.stats.candidates >= found.len() as u64);
    }
}

/// Asserts the same rows for every way, and the same fingerprints on every machine.
pub(super) fn assert_same_everywhere(bodies: &[Body], query: Query) {
    let truth = ask(engine(), bodies.to_vec(), query);
    for way in ways(query) {
        assert_eq!(ask(engine(), bodies.to_vec(), way).rows, truth.rows, "{way:?}");
    }
    let print = |device| {
        let bodies = judged(bodies.to_vec());
        let mut detector = OneQuery::new(device, bodies, query).expect("a detector");
        let all = detector.detect().expect("an answer");
        detector.check_volumes().expect("sound trees");
        (all.hash(), detector.fingerprints().expect("prints"))
    };
    let on_engine = print(engine());
    assert_eq!(on_engine.0, truth.hash());
    for device in machines() {
        let name = device.name();
        assert_eq!(print(device), on_engine, "{name}");
    }
}

#[test]
fn every_way_and_every_machine_finds_the_same() {
    for (bodies, distance) in scenes() {
        assert_same_everywhere(&bodies, Query::near(distance));
    }
}

/// Pairs at the query's distance, up to a rounding or two of doubles: the same are listed by any
/// volume.
#[test]
fn what_rounding_cannot_tell_is_the_same_for_every_volume() {
    let mut r = SmallRng::seed_from_u64(77);
    let mut at = || -> f64 { r.random_range(-1.0..1.0) };
    let triangle = |base: [f64; 3], up: f64| {
        [[0.0, 0.0, 0.0], [0.7, 0.1, 0.0], [0.2, 0.9, 0.1]]
            .map(|p| [p[0] + base[0], p[1] + base[1], p[2] + base[2] + up])
    };
    let mut triangles = Vec::new();
    for i in 0..60 {
        let base = [10.0 * f64::from(i) + at(), at(), at()];
        triangles
            .extend([triangle(base, 0.0), triangle(base, 0.25 * (1.0 + f64::from(i - 30) * f64::EPSILON))]);
    }
    let points: Vec<[f64; 3]> = triangles.as_flattened().to_vec();
    let faces = (0..120).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let body = Body::deformable(Mesh::new("stacked", Positions::F64(points), faces).expect("a mesh"));
    let query = Query::near(0.25);
    let all = ask(engine(), vec![body.clone()], query);
    assert!(all.undecided > 60, "{} of {}", all.undecided, all.len());
    assert!(Truth::of(std::slice::from_ref(&body), 0.25).fault(all.near()).is_ok_and(|beyond| beyond > 20));
    for volume in BoundingVolume::ALL {
        assert_eq!(ask(engine(), vec![body.clone()], query.with_volume(volume)).rows, all.rows, "{volume:?}");
    }
}

/// Powers of two scale answers exactly; so do shifts that round nothing.
#[test]
fn scales_and_shifts_by_powers_change_nothing_else() {
    let body = degenerate(4);
    let of = |body: Body, distance: f64| ask(engine(), vec![body], Query::near(distance)).near().to_vec();
    let plain = of(body.clone(), 0.3);
    let scaled = |by: f64| -> Vec<NearPair> {
        let longer =
            |pair: &NearPair| NearPair { squared_distance: pair.squared_distance * by * by, ..*pair };
        plain.iter().map(longer).collect()
    };
    for (exponent, single) in [(-90, true), (50, true), (-498, false), (470, false)] {
        let by = 2f64.powi(exponent);
        let body = placed(&body, |p| p.map(|x| x * by), single);
        assert_eq!(of(body, 0.3 * by), scaled(by), "2^{exponent}");
    }
    for by in [1024.0, -65536.0] {
        let body = placed(&body, |[x, y, z]| [x + by, y - by, z + 2.0 * by], true);
        assert_eq!(of(body, 0.3), plain, "{by}");
    }
    // 1e±30 in f32 and 1e±150 in f64, which are no powers of two: nothing is missed.
    for (by, single) in [(1e-30, true), (1e17, true), (1e-150, false), (1e140, false), (1e30, false)] {
        let bodies = [placed(&body, |p| p.map(|x| x * by), single)];
        let found = of(bodies[0].clone(), 0.3 * by);
        assert_eq!(Truth::of(&bodies, 0.3 * by).fault(&found), Ok(0), "{by:e}");
        assert_eq!(found.len(), plain.len(), "{by:e}");
    }
}

/// Two bodies the other way round: the same pairs, with the other names.
#[test]
fn the_order_of_bodies_only_renames() {
    let (one, other) = (soup(30, 6), degenerate(9));
    let of = |bodies: [&Body; 2]| {
        ask(engine(), bodies.map(Body::clone).to_vec(), Query::near(0.1)).near().to_vec()
    };
    let rows = |pairs: Vec<NearPair>, exchanged: bool| -> BTreeSet<_> {
        let of_vertices = pairs.into_iter().filter(|p| p.kind == Kind::Vf);
        let row = |p: NearPair| {
            let of = p.bodies.map(|body| (body.index() == 1) != exchanged);
            (of, [p.feature_a, p.feature_b], p.squared_distance.to_bits())
        };
        of_vertices.map(row).collect()
    };
    let (mine, theirs) = (rows(of([&one, &other]), false), rows(of([&other, &one]), true));
    assert!(mine.len() > 20);
    assert_eq!(mine, theirs);
    let edges = |near: Vec<NearPair>| near.into_iter().filter(|p| p.kind == Kind::Ee).collect::<Vec<_>>();
    let (mine, theirs) = (edges(of([&one, &other])), edges(of([&other, &one])));
    assert_eq!(mine.len(), theirs.len());
    assert!(
        mine.iter().all(|p| theirs.iter().any(|q| (q.feature_a, q.feature_b) == (p.feature_b, p.feature_a)))
    );
}

/// The continuous query of two equal frames with that separation is another road to the same set, up to its tolerance.
#[test]
fn a_step_without_motion_comes_to_the_same() {
    for (bodies, distance) in scenes() {
        let tolerance = 1e-6;
        let asked = |precision| -> Query {
            let certified = Certified::by(precision);
            Continuous::by(Certified { tolerance: Some(tolerance), min_separation: distance, ..certified })
                .into()
        };
        let rows = |near: &[NearPair]| {
            near.iter().map(|p| (p.kind, p.feature_a, p.feature_b)).collect::<BTreeSet<_>>()
        };
        let near = ask(engine(), bodies.clone(), Query::near(distance));
        let farther = ask(engine(), bodies.clone(), Query::near(distance + 2.0 * tolerance));
        for solver in [CertifiedPrecision::Mixed, CertifiedPrecision::F64] {
            let step = ask(engine(), bodies.clone(), asked(solver));
            let all: BTreeSet<_> =
                step.contacts().iter().map(|c| (c.kind, c.feature_a, c.feature_b)).collect();
            let certain = step.contacts().iter().filter(|c| c.status == Status::Certified);
            assert!(rows(near.near()).is_subset(&all), "{solver:?}: missed by the step");
            assert!(all.is_subset(&rows(farther.near())), "{solver:?}: missed by near");
            assert!(
                certain.clone().all(|c| rows(near.near()).contains(&(c.kind, c.feature_a, c.feature_b))),
                "{solver:?}"
            );
            assert!(certain.count() * 10 > 9 * near.len() || near.undecided > 0, "{solver:?}");
        }
    }
}

/// Lists that are too short grow within the frame: nothing is dropped, and what is counted is counted once.
#[test]
fn lists_grow() {
    // 60 triangles in one place: all features of any two are within any distance.
    let triangles = vec![[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]; 60];
    for device in [engine(), sanitizer(ORDERS[1])] {
        let mut detector =
            OneQuery::new(device, vec![loose(&triangles)], Query::near(2.0)).expect("a detector");
        let all = detector.detect().expect("an answer");
        assert!(all.stats.reruns > 0);
        let pairs = 60 * 59;
        assert_eq!(
            [all.stats.candidates_vf_ee[0], all.stats.candidates_vf_ee[1]],
            [3 * pairs, 9 * pairs / 2]
        );
        assert_eq!((all.len() as u64, all.undecided), (3 * pairs + 9 * pairs / 2, 0));
        let again = detector.detect().expect("an answer");
        assert_eq!((again.hash(), again.stats.reruns, again.undecided), (all.hash(), 0, 0));
        for stage in nearmiss::Stage::ALL {
            detector.repeat_stage(stage, 2).expect("a stage");
        }
        assert_eq!(detector.detect().expect("an answer").hash(), all.hash());
    }
}

/// A moving body is tested at its positions at t = 0. A body without triangles has no pairs.
#[test]
fn only_the_start_is_looked_at() {
    let moving = scene::soup(60, 5, true).expect("a scene");
    let first = Body::deformable(moving.frames().remove(0));
    let of = |body: Body| ask(engine(), vec![body], Query::near(0.05));
    assert_eq!(of(moving).rows, of(first).rows);
    assert_eq!(of(still(&[], &[])).rows, Rows::Near(Vec::new().into()));
}

/// The hash hears of every part of a pair.
#[test]
fn a_hash_tells_answers_apart() {
    let all = ask(engine(), vec![soup(30, 5)], Query::near(0.05));
    let with = |plant: &dyn Fn(&mut NearPair)| {
        let mut other = all.clone();
        let Rows::Near(near) = &mut other.rows else { panic!("another answer") };
        plant(&mut near[3]);
        other.hash()
    };
    assert_eq!(with(&|_| ()), all.hash());
    let plants: [&dyn Fn(&mut NearPair); 6] = [
        &|pair| pair.feature_a ^= 1,
        &|pair| pair.feature_b ^= 1,
        &|pair| pair.kind = if pair.kind == Kind::Ee { Kind::Vf } else { Kind::Ee },
        &|pair| pair.squared_distance = pair.squared_distance.next_up(),
        &|pair| pair.at[0] = pair.at[0].next_up(),
        &|pair| {
            use nearmiss::contacts::Closest::{VertexEdge, VertexVertex};
            pair.closest = if pair.closest == VertexEdge { VertexVertex } else { VertexEdge };
        },
    ];
    for (i, plant) in plants.into_iter().enumerate() {
        assert_ne!(with(plant), all.hash(), "{i}");
    }
}

/// Real cloth: pairs within a twentieth of an edge, compared with the certified step without
/// motion.
#[test]
#[cfg_attr(not(public_data), ignore = "no public test data: set NEARMISS_DATA")]
fn real_cloth_agrees_with_the_step_without_motion() {
    let body = Body::deformable(mesh("cloth-ball/cloth_ball92.ply"));
    let distance = 0.01;
    let near = ask(engine(), vec![body.clone()], Query::near(distance));
    let separation = Certified { min_separation: distance, tolerance: Some(1e-7), ..Certified::default() };
    let step = ask(engine(), vec![body], Continuous::by(separation).into());
    let rows: BTreeSet<_> = near.near().iter().map(|p| (p.kind, p.feature_a, p.feature_b)).collect();
    let all: BTreeSet<_> = step.contacts().iter().map(|c| (c.kind, c.feature_a, c.feature_b)).collect();
    println!("{} near, {} by the step", rows.len(), all.len());
    assert!(rows.len() > 10_000 && rows.is_subset(&all));
    // Further rows of the step are nearer than the distance and its tolerance.
    let farther = near.len() + 20;
    assert!(all.len() <= farther, "{} of {farther}", all.len());
}
