//! An answer about two bodies depends on nothing else: adding, removing or having had another body,
//! of any size, precision or environment, changes no row.

use super::*;
use nearmiss::Rows;

/// The part of an answer that concerns the queried bodies.
#[derive(Clone, Debug, PartialEq)]
enum OwnRows {
    Pairs(Vec<TrianglePair>),
    Contacts(Vec<Contact>),
    Near(Vec<NearPair>),
}

/// The rows of bodies below `own`; of a query that answers with one number, `None`: other bodies
/// may have the least.
fn rows(contacts: &Contacts, own: usize) -> Option<OwnRows> {
    let is_own = |bodies: &[BodyId; 2]| bodies.iter().all(|body| body.index() < own);
    Some(match &contacts.rows {
        Rows::Pairs(all) => OwnRows::Pairs(all.iter().filter(|row| is_own(&row.bodies)).copied().collect()),
        Rows::Contacts(all) => {
            OwnRows::Contacts(all.iter().filter(|row| is_own(&row.bodies)).copied().collect())
        }
        Rows::Near(all) => OwnRows::Near(all.iter().filter(|row| is_own(&row.bodies)).copied().collect()),
        Rows::Earliest(_) | Rows::Distance(_) | Rows::BodyPairs(_) | Rows::BodyDistances(_) => return None,
    })
}

/// The one number of an answer that is one.
fn least(contacts: &Contacts) -> Option<f64> {
    match &contacts.rows {
        Rows::Earliest(toi) => *toi,
        Rows::Distance(nearest) => nearest.as_ref().map(|nearest| nearest.distance),
        _ => panic!("an answer of rows"),
    }
}

/// A body of any kind, around a place, of a size and a precision.
fn body(rng: &mut SmallRng, (size, at, is_f64): (f64, f64, bool)) -> Body {
    let mesh = mesh(rng, size, at, is_f64);
    match rng.random_range(0..5) {
        0 => Body::fixed(mesh),
        1 => Body::rigid(mesh).at(Motion::PoseStep([pose(rng), pose(rng)].into())).expect("poses"),
        2 => Body::deformable(mesh),
        _ => {
            let end = moved(rng, mesh.positions(), 0.5 * size);
            let end = Mesh::new("end", end, mesh.faces().to_vec()).expect("a mesh");
            Body::moving(mesh, end).expect("two frames")
        }
    }
}

/// A random filter; a fixed body has no contact with itself.
fn meets(rng: &mut SmallRng, body: Body) -> Body {
    let self_collision = (body.kind() != BodyKind::Fixed).then(|| rng.random_bool(0.5));
    let environment = [Some(0), Some(0), Some(1), None][rng.random_range(0..4)];
    let [group, mask] =
        [(); 2].map(|()| if rng.random_bool(0.7) { u32::MAX } else { rng.random_range(1..4) });
    body.with_filter(CollisionFilter { environment, group, mask, self_collision })
}

/// Two or three queried bodies.
fn own(rng: &mut SmallRng) -> Vec<Body> {
    (0..rng.random_range(2..4))
        .map(|_| {
            let is_f64 = rng.random_bool(0.2);
            let size = [0.3, 0.5, 1.0][rng.random_range(0..3)];
            let body = body(rng, (size, 0.0, is_f64));
            meets(rng, body)
        })
        .collect()
}

/// Up to three others: large, tiny, far, in doubles, in other environments.
fn others(rng: &mut SmallRng) -> Vec<Body> {
    (0..rng.random_range(1..4))
        .map(|_| {
            let size = [1e-4, 0.5, 2.0, 1e3, 1e6][rng.random_range(0..5)];
            let at = [0.0, 0.0, 1e3, 1e7, 1e30][rng.random_range(0..5)];
            let is_f64 = rng.random_bool(0.5);
            let body = body(rng, (size, at, is_f64));
            meets(rng, body)
        })
        .collect()
}

/// A scene of bodies with their filters.
fn scene(bodies: &[Body]) -> Scene {
    let mut scene = Scene::new();
    bodies.iter().for_each(|body| _ = scene.add(body.clone()));
    scene
}

fn ask(bodies: &[Body], query: Query) -> Contacts {
    support::ask_scene(engine(), scene(bodies), query)
}

/// An answer that is one number, and whether it says that edges are too long for the tolerance.
#[derive(Clone, Debug, PartialEq)]
struct Least {
    number: Option<f64>,
    is_below_precision: bool,
}

impl Least {
    fn of(contacts: &Contacts) -> Least {
        let is_below = |reason: &Caveat| matches!(reason, Caveat::ToleranceBelowPrecision { .. });
        Least { number: least(contacts), is_below_precision: contacts.caveats().iter().any(is_below) }
    }
}

/// The least number over bodies two by two, and whether any two have edges too long.
fn least_two_by_two(bodies: &[Body], query: Query) -> Least {
    let mut all = Vec::new();
    for i in 0..bodies.len() {
        // A body with itself alone.
        all.push(Least::of(&ask(&bodies[i..i + 1], query)));
        for j in i + 1..bodies.len() {
            // Contacts of a body with itself were tested above.
            let alone = [i, j].map(|k| {
                let is_fixed = bodies[k].kind() == BodyKind::Fixed;
                let self_collision = (!is_fixed).then_some(false);
                bodies[k].clone().with_filter(CollisionFilter { self_collision, ..*bodies[k].filter() })
            });
            all.push(Least::of(&ask(&alone, query)));
        }
    }
    Least {
        number: all.iter().filter_map(|of| of.number).min_by(f64::total_cmp),
        is_below_precision: all.iter().any(|of| of.is_below_precision),
    }
}

/// The difference if other bodies are there, were added to a detector, or were there and are gone.
fn differs(own: &[Body], others: &[Body], query: Query) -> Option<String> {
    let all: Vec<Body> = own.iter().chain(others).cloned().collect();
    let alone = ask(own, query);
    let together = ask(&all, query);
    let Some(wanted) = rows(&alone, own.len()) else {
        let both = [(Least::of(&alone), own), (Least::of(&together), &all[..])];
        return both
            .into_iter()
            .find_map(|(found, bodies)| other_least(&found, &least_two_by_two(bodies, query)));
    };
    let mut detector = OneQuery::new(engine(), scene(own), query).expect("a detector");
    let added: Vec<BodyId> = others.iter().map(|body| detector.add(body.clone()).expect("room")).collect();
    let with_added = detector.detect().expect("an answer");
    for id in added {
        detector.remove(id).expect("a body");
    }
    let without = detector.detect().expect("an answer");
    let found = [("together", together), ("added", with_added), ("removed", without)];
    found.into_iter().find_map(|(when, contacts)| difference(when, &rows(&contacts, own.len())?, &wanted))
}

/// The difference from the least of bodies two by two.
fn other_least(found: &Least, wanted: &Least) -> Option<String> {
    (found != wanted).then(|| format!("{found:?}, two by two {wanted:?}"))
}

/// The first row that is not as it was alone.
fn difference(when: &str, found: &OwnRows, wanted: &OwnRows) -> Option<String> {
    fn first<T: PartialEq + std::fmt::Debug>(found: &[T], wanted: &[T]) -> String {
        let at = (0..).find(|&i| found.get(i) != wanted.get(i)).unwrap_or_default();
        format!("row {at} is {:?}, alone {:?}", found.get(at), wanted.get(at))
    }
    if found == wanted {
        return None;
    }
    let what = match (found, wanted) {
        (OwnRows::Pairs(found), OwnRows::Pairs(wanted)) => first(found, wanted),
        (OwnRows::Contacts(found), OwnRows::Contacts(wanted)) => first(found, wanted),
        (OwnRows::Near(found), OwnRows::Near(wanted)) => first(found, wanted),
        _ => format!("{found:?}, alone {wanted:?}"),
    };
    Some(format!("{when}: {what}"))
}

#[test]
fn other_bodies_change_no_row() {
    // Every scene has a part of the queries, and every query a part of the scenes.
    let (mut rows_found, part) = (0, support::cases(7, 1));
    for seed in 0..24 {
        let mut rng = SmallRng::seed_from_u64(seed);
        let (own, others) = (own(&mut rng), others(&mut rng));
        for query in queries().into_iter().skip(seed as usize % part).step_by(part) {
            let difference = differs(&own, &others, query);
            assert_eq!(difference, None, "seed {seed}, {query:?}");
        }
        rows_found += ask(&own, Query::continuous()).len();
    }
    assert!(rows_found > 400, "{rows_found}");
}

/// A body adds the caveat of long edges only if it may meet another, and is near it.
#[test]
fn a_body_that_meets_none_adds_no_caveat() {
    let mut told = [0; 2];
    for seed in 0..20 {
        let mut rng = SmallRng::seed_from_u64(seed);
        let own = Body::deformable(mesh(&mut rng, 0.5, 0.0, false));
        let huge = Body::deformable(mesh(&mut rng, 1e5, 0.0, true))
            .with_filter(CollisionFilter::without_self_collision());
        let far = huge.positions_t0().to_f64().into_iter().map(|p| [p[0] + 1e7, p[1], p[2]]).collect();
        let far = Mesh::new("far", Positions::F64(far), huge.faces().to_vec()).expect("a mesh");
        let far = Body::deformable(far).with_filter(CollisionFilter::without_self_collision());
        let elsewhere = CollisionFilter { environment: Some(7), ..CollisionFilter::without_self_collision() };
        let excluded = CollisionFilter { mask: 0, ..CollisionFilter::without_self_collision() };
        for query in queries().into_iter().filter(|query| query.kind() == QueryKind::Earliest) {
            let below = |bodies: &[Body]| Least::of(&ask(bodies, query)).is_below_precision;
            let alone = below(std::slice::from_ref(&own));
            for other in
                [far.clone(), huge.clone().with_filter(elsewhere), huge.clone().with_filter(excluded)]
            {
                assert_eq!(below(&[own.clone(), other]), alone, "seed {seed}, {query:?}");
            }
            told[usize::from(below(&[own.clone(), huge.clone()]))] += 1;
        }
    }
    assert!(told.iter().all(|times| *times > 0), "{told:?}");
}

/// The comparison names a row that is changed in its last bit, one that is missing, and another
/// least number.
#[test]
fn a_changed_row_is_named() {
    let mut rng = SmallRng::seed_from_u64(1);
    let own = own(&mut rng);
    let contacts = ask(&own, Query::continuous());
    let Some(OwnRows::Contacts(rows)) = rows(&contacts, own.len()) else { panic!("contacts") };
    assert!(rows.len() > 3);
    let wanted = OwnRows::Contacts(rows.clone());
    assert_eq!(difference("", &wanted, &wanted), None);
    let mut late = rows.clone();
    late[2].toi = late[2].toi.next_up();
    let named = difference("", &OwnRows::Contacts(late), &wanted).expect("a difference");
    assert!(named.contains("row 2"), "{named}");
    let alone = Least { number: Some(0.5), is_below_precision: false };
    assert_eq!(other_least(&alone, &alone.clone()), None);
    for planted in [
        Least { number: Some(0.5f64.next_up()), ..alone.clone() },
        Least { number: None, ..alone.clone() },
        Least { is_below_precision: true, ..alone.clone() },
    ] {
        assert!(other_least(&planted, &alone).is_some(), "{planted:?}");
    }
    let fewer = OwnRows::Contacts(rows[..rows.len() - 1].to_vec());
    assert!(difference("", &fewer, &wanted).is_some_and(|named| named.contains("None")));
}
