//! A scene's answer is that of its bodies two by two.

use super::*;
use support::{ORDERS, sanitizer, ways};

/// Whether a pair is tested, by the documentation.
fn asked(scene: &Scene, i: usize, j: usize) -> bool {
    let [a, b] = [i, j].map(|i| &scene.bodies()[i]);
    let [p, q] = [a, b].map(|body| body.filter());
    if a.kind() == BodyKind::Fixed && b.kind() == BodyKind::Fixed {
        return false;
    }
    if i == j {
        return a.self_collides();
    }
    let [i, j] = [i.min(j), i.max(j)];
    if scene.left_out().iter().any(|pair| pair.map(BodyId::index) == [i, j]) {
        return false;
    }
    let together = p.environment == q.environment || p.environment.is_none() || q.environment.is_none();
    together && p.group & q.mask != 0 && q.group & p.mask != 0
}

/// Triangle pairs, contacts and near pairs, of which a query has one kind.
pub type Truth = (Vec<TrianglePair>, Vec<Contact>, Vec<NearPair>);

/// The contacts of the bodies of a scene, tested two by two.
pub fn two_by_two(scene: &Scene, query: Query) -> Truth {
    let (mut pairs, mut contacts, mut near) = (Vec::new(), Vec::new(), Vec::new());
    let ids: Vec<BodyId> = scene.ids().collect();
    for &i in &ids {
        for &j in ids.iter().filter(|&&j| j >= i && asked(scene, i.index(), j.index())) {
            let bodies: Vec<Body> = [i, j].map(|id| alone(&scene.bodies()[id.index()])).to_vec();
            let bodies = if i == j { bodies[..1].to_vec() } else { bodies };
            let found = support::ask(engine(), bodies, query);
            let of = |bodies: [BodyId; 2]| bodies.map(|body| [i, j][body.index()]);
            pairs.extend(found.pairs().iter().map(|pair| TrianglePair { bodies: [i, j], ..*pair }));
            contacts.extend(found.contacts().iter().map(|c| Contact { bodies: of(c.bodies), ..*c }));
            near.extend(found.near().iter().map(|pair| NearPair { bodies: of(pair.bodies), ..*pair }));
        }
    }
    pairs.sort_unstable_by_key(|pair| (pair.bodies[0], pair.triangles[0], pair.bodies[1], pair.triangles[1]));
    contacts.sort_unstable_by_key(|c| (c.kind, c.bodies[0], c.feature_a, c.bodies[1], c.feature_b));
    near.sort_unstable_by_key(|c| (c.kind, c.bodies[0], c.feature_a, c.bodies[1], c.feature_b));
    (pairs, contacts, near)
}

/// Surplus or missing rows of a scene's answer.
pub fn differ(found: &Contacts, (pairs, contacts, near): &Truth) -> Option<String> {
    fn first<T: PartialEq + std::fmt::Debug>(found: &[T], truth: &[T]) -> Option<String> {
        let both = |i: usize| (found.get(i), truth.get(i));
        let all = 0..found.len().max(truth.len());
        all.map(both).find(|(found, truth)| found != truth).map(|both| format!("{both:?}"))
    }
    first(found.pairs(), pairs)
        .or_else(|| first(found.contacts(), contacts))
        .or_else(|| first(found.near(), near))
}

/// Seven bodies of every kind, of environments and groups, and one that was removed. Two of four
/// seeds leave out pairs.
pub fn mixed(seed: u64) -> Scene {
    let mut rng = SmallRng::seed_from_u64(seed);
    let mut scene = Scene::new();
    let mut gone = None;
    for i in 0..8u64 {
        let n = rng.random_range(1..40);
        let (mesh, ends) = soup(n, seed * 100 + i);
        let body = match rng.random_range(0..4) {
            0 => Body::fixed(mesh),
            1 => Body::rigid(mesh),
            _ => {
                let end = Mesh::new("end", ends[1].clone(), mesh.faces().to_vec()).expect("a mesh");
                Body::moving(mesh, end).expect("two frames")
            }
        };
        let filter = CollisionFilter {
            environment: [Some(0), Some(0), Some(1), None][rng.random_range(0..4)],
            group: if seed.is_multiple_of(2) { u32::MAX } else { rng.random_range(0..4) },
            mask: if seed.is_multiple_of(2) { u32::MAX } else { rng.random_range(0..4) },
            // It is refused for a fixed body.
            self_collision: Some(rng.random_bool(0.5)).filter(|own| !own || body.kind() != BodyKind::Fixed),
        };
        let id = scene.add(body.with_filter(filter));
        gone = gone.or((i == 3).then_some(id));
    }
    if seed % 4 >= 2 {
        scene.leave_out(&some_pairs(&mut rng, &scene, 0.4)).expect("bodies");
    }
    scene.remove(gone.expect("the fourth")).expect("a body");
    scene
}

/// A part of the pairs of bodies.
pub fn some_pairs(rng: &mut SmallRng, scene: &Scene, part: f64) -> Vec<[BodyId; 2]> {
    let ids: Vec<BodyId> = scene.ids().collect();
    let all = ids.iter().flat_map(|&a| ids.iter().filter(move |&&b| b < a).map(move |&b| [a, b]));
    all.filter(|_| rng.random_bool(part)).collect()
}

/// With a tolerance that is named.
pub fn query(motion: QueryKind) -> Query {
    support::asked::at(motion, 1e-4, 0.03)
}

/// Queries with a list as their answer.
pub const LISTS: [QueryKind; 3] = [QueryKind::Discrete, QueryKind::Continuous, QueryKind::Near];

#[test]
fn a_scene_answers_as_its_bodies_two_by_two() {
    let mut found = [0; 3];
    for seed in 0..40 {
        let scene = mixed(seed);
        for (k, motion) in LISTS.into_iter().enumerate() {
            let truth = two_by_two(&scene, query(motion));
            let mut detector = OneQuery::new(engine(), scene.clone(), query(motion)).expect("a detector");
            let contacts = detector.detect().expect("an answer");
            detector.check_volumes().expect("sound trees");
            assert_eq!(differ(&contacts, &truth), None, "seed {seed}, {motion:?}");
            found[k] += contacts.len();
        }
        let earliest = support::ask_scene(engine(), scene.clone(), query(QueryKind::Earliest)).earliest_toi();
        let continuous = support::ask_scene(engine(), scene, query(QueryKind::Continuous)).earliest_toi();
        assert_eq!(earliest, continuous, "seed {seed}");
    }
    assert!(found.iter().all(|&found| found > 1_000), "{found:?}");
}

#[test]
fn every_way_through_a_scene_gives_one_answer() {
    for seed in [3, 4, 6] {
        let scene = mixed(seed);
        assert_eq!(scene.left_out().is_empty(), seed == 4);
        for motion in LISTS {
            let truth = two_by_two(&scene, query(motion));
            for way in ways(query(motion)) {
                let found = support::ask_scene(engine(), scene.clone(), way);
                assert_eq!(differ(&found, &truth), None, "seed {seed}, {way:?}");
            }
            for order in ORDERS {
                let found = support::ask_scene(sanitizer(order), scene.clone(), query(motion));
                assert_eq!(differ(&found, &truth), None, "seed {seed}, {order:?}");
            }
        }
    }
}

/// The judge of the tests above names what is missing, and what is of other bodies.
#[test]
fn the_judge_notices_a_pair_too_few_and_another_body() {
    for motion in LISTS {
        let scene = mixed(4);
        let (mut pairs, mut contacts, mut near) = two_by_two(&scene, query(motion));
        let found = support::ask_scene(engine(), scene, query(motion));
        let whole = (pairs.clone(), contacts.clone(), near.clone());
        assert!(found.len() > 20 && differ(&found, &whole).is_none());
        pairs.pop();
        contacts.pop();
        near.pop();
        assert!(differ(&found, &(pairs, contacts, near)).is_some_and(|what| what.contains("None")));
        let (mut pairs, mut contacts, mut near) = whole;
        pairs.iter_mut().for_each(|pair| pair.bodies.swap(0, 1));
        contacts.iter_mut().for_each(|contact| contact.bodies.swap(0, 1));
        near.iter_mut().for_each(|pair| pair.bodies.swap(0, 1));
        assert!(differ(&found, &(pairs, contacts, near)).is_some_and(|what| what.contains("bodies")));
    }
}
