//! The catalogue of extremes as scenes of many bodies: each twice, in two worlds that do not meet, and once more with a fixed
//! body of every world far away. Each world answers as the bodies do alone.

use super::*;
use nearmiss_lab::robustness;

/// The bodies of one catalogue scene, in an environment.
fn world(bodies: &[Body], environment: u32) -> impl Iterator<Item = Body> {
    let alone = bodies.len() == 1;
    bodies.iter().map(move |body| {
        let filter =
            CollisionFilter { self_collision: Some(alone), ..CollisionFilter::in_environment(environment) };
        body.clone().with_filter(filter)
    })
}

/// Triangle pairs; contacts, each with its bodies.
type Found = (Vec<[u32; 2]>, Vec<(Contact, [usize; 2])>);

/// The contacts of one world, in the numbers of its own bodies: from `first` on.
fn of_world(found: &Contacts, first: usize, count: usize) -> Found {
    let inside =
        |bodies: [BodyId; 2]| bodies.iter().all(|body| (first..first + count).contains(&body.index()));
    let pairs = found.pairs().iter().filter(|pair| inside(pair.bodies)).map(|pair| pair.triangles);
    let contacts = found.contacts().iter().filter(|contact| inside(contact.bodies));
    let own = |contact: &Contact| {
        let bodies = contact.bodies.map(|body| body.index() - first);
        (Contact { bodies: Default::default(), ..*contact }, bodies)
    };
    (pairs.collect(), contacts.map(own).collect())
}

#[test]
fn extremes_are_answered_alike_in_two_worlds() {
    let (mut asked, mut met) = (0, 0);
    for extreme in robustness::scenes() {
        let (bodies, query) = (extreme.bodies().expect("bodies"), extreme.query());
        let mut alone = OneQuery::new(engine(), bodies.clone(), query).expect("a detector");
        let truth = alone.detect().expect("an answer");
        let mut scene = Scene::new();
        world(&bodies, 7).chain(world(&bodies, 3)).for_each(|body| _ = scene.add(body));
        let corner = |x: f32, y: f32| [-3e18 + x * 1e16, 1e15 * y, 2e18];
        let far = Positions::F32(vec![corner(0.0, 0.0), corner(1.0, 0.0), corner(0.0, 1.0)]);
        let far = Mesh::new("far", far, vec![[0, 1, 2]]).expect("a mesh");
        scene.add(
            Body::fixed(far).with_filter(CollisionFilter { environment: None, ..CollisionFilter::default() }),
        );
        let mut detector = OneQuery::new(engine(), scene, query).expect("a detector");
        let found = detector.detect().expect("an answer");
        detector.check_volumes().expect("sound trees");
        let wanted = of_world(&truth, 0, bodies.len());
        for first in [0, bodies.len()] {
            assert_eq!(of_world(&found, first, bodies.len()), wanted, "{}: {}", extreme.id, extreme.what);
        }
        assert_eq!(found.earliest_toi(), truth.earliest_toi(), "{}: {}", extreme.id, extreme.what);
        if query.kind() != QueryKind::Earliest {
            assert_eq!(found.len(), 2 * truth.len(), "{}: {}, between worlds", extreme.id, extreme.what);
        }
        asked += 1;
        met += truth.len();
    }
    assert!(asked > 50 && met > 100, "{asked} asked, {met} met");
}
