//! A body far away changes nothing in an answer about others.

use super::*;
use nearmiss::query::QueryKind;
use support::cases;

/// Boxes whose faces lie in common planes, some a little apart: f32 rounds what doubles do not.
fn boxes(scale: f32, offset: f32, end: bool) -> Vec<[f32; 3]> {
    let third = 1.0f32 / 3.0;
    let mut points = Vec::new();
    for n in 0..4u32 {
        let at = [third * n as f32, 0.1 * (n % 2) as f32, 1.000_001 * (n / 2) as f32];
        for k in 0..8 {
            let corner = [0, 1, 2].map(|axis| at[axis] + (k >> axis & 1) as f32 * third);
            let push = if end { 0.3 * (n % 2) as f32 - 0.1 } else { 0.0 };
            points.push([corner[0] - push, corner[1], corner[2] - 0.5 * push].map(|x| x * scale + offset));
        }
    }
    points
}

/// Bodies in single precision: soups, and boxes; at both ends of a step.
fn bodies(seed: u64, (scale, offset): (f32, f32)) -> Scene {
    let mut scene = Scene::new();
    let at = |positions: &Positions| match positions {
        Positions::F32(points) => {
            Positions::F32(points.iter().map(|p| p.map(|x| x * scale + offset)).collect())
        }
        Positions::F64(_) => panic!("a soup is in single precision"),
    };
    let mesh = |positions, faces| Mesh::new("one", positions, faces).expect("a mesh");
    for k in 0..3 {
        let soup = scene::soup(40, 10 * seed + k, true).expect("a soup");
        let [t0, t1] = soup.ends().map(at);
        let faces = soup.faces().to_vec();
        let body = Body::moving(mesh(t0, faces.clone()), mesh(t1, faces)).expect("two frames");
        scene.add(body.with_filter(CollisionFilter::with_self_collision()));
    }
    let faces: Vec<[u32; 3]> =
        (0..4).flat_map(|n| box_faces().into_iter().map(move |f| f.map(|v| v + 8 * n))).collect();
    let [t0, t1] = [false, true].map(|end| mesh(Positions::F32(boxes(scale, offset, end)), faces.clone()));
    scene.add(Body::fixed(t0.clone()));
    scene.add(Body::moving(t0, t1).expect("two frames").with_filter(CollisionFilter::with_self_collision()));
    scene
}

/// A triangle in doubles, where nothing else is.
fn far() -> Mesh {
    let points = vec![[1e30, 0.1, 0.3], [1.000_000_001e30, 0.7, 0.1], [1e30, 1e20 / 3.0, 0.9]];
    Mesh::new("far", Positions::F64(points), vec![[0, 1, 2]]).expect("a mesh")
}

/// A triangle in doubles, a million sizes away, with sides as the others have: an earliest query
/// reports pairs too large for its tolerance, of any body.
fn beside((size, offset): (f32, f32)) -> Mesh {
    let [size, offset] = [size, offset].map(f64::from);
    let point = |x: f64, y: f64| [offset + 1e6 * size, offset + x / 3.0 * size, offset + y / 7.0 * size];
    let points = vec![point(0.1, 0.0), point(0.7, 0.1), point(0.2, 0.9)];
    Mesh::new("beside", Positions::F64(points), vec![[0, 1, 2]]).expect("a mesh")
}

/// Queries whose rows differ once there is one of some other bodies.
fn different(scene: &Scene, queries: &[Query], others: impl Fn(&Query) -> Vec<Body>) -> Vec<String> {
    let ask = |scene: Scene, query: Query| {
        rows(&OneQuery::new(engine(), scene, query).expect("a detector").detect().expect("an answer"))
    };
    let differs = |query: &&Query| {
        let alone = ask(scene.clone(), **query);
        others(query).into_iter().any(|other| {
            let mut with = scene.clone();
            with.add(other);
            ask(with, **query) != alone
        })
    };
    queries.iter().filter(differs).map(|query| format!("{query:?}")).collect()
}

#[test]
fn a_body_far_away_changes_no_row() {
    let places =
        [(1.0, 0.0), (1.0, 100.0), (1e-3, 4.0), (1e12, 0.0), (1e-12, 0.0), (1e-30, 0.0), (3.0, -7e4)];
    for (seed, place) in (0usize..).zip(places) {
        let scene = bodies(seed as u64, place);
        let size = f64::from(place.0);
        // Each place has one tolerance, and the tolerances take turns.
        for tolerance in [1e-4, 1e-7, 1e-13].into_iter().cycle().skip(seed % 3).take(cases(1, 3)) {
            let others = |query: &Query| {
                let mut others = vec![match seed / 2 % 3 {
                    0 => Body::fixed(far()),
                    1 => Body::deformable(far()),
                    _ => Body::rigid(far()),
                }];
                others.retain(|_| query.kind() != QueryKind::Earliest);
                let near = [Body::deformable(beside(place)), Body::rigid(beside(place))];
                others.extend(near.into_iter().cycle().skip(seed % 2).take(cases(1, 2)));
                others
            };
            let told = different(&scene, &queries(tolerance * size, 0.02 * size), others);
            assert!(told.is_empty(), "{place:?}, {tolerance}: {told:#?}");
        }
    }
}

/// A near query whose distance is that of two faces but for a half ulp, one way and the other.
#[test]
fn a_distance_next_to_that_of_two_faces_lists_the_same() {
    let scene = bodies(3, (1.0, 0.0));
    let gap = f64::from(1.000_001f32 * 1.0f32) - f64::from(1.0f32 / 3.0);
    for distance in
        [gap, gap.next_up(), gap.next_down(), gap * (1.0 - 1e-15), gap * (1.0 + 1e-15), gap - 1e-14]
    {
        let told = different(&scene, &[Query::near(distance)], |_| vec![Body::fixed(far())]);
        assert!(told.is_empty(), "{distance}");
    }
}

/// A body that is moved by an ulp instead is noticed.
#[test]
fn a_changed_row_is_noticed() {
    let scene = bodies(1, (1.0, 0.0));
    let told = different(&scene, &queries(1e-4, 0.02), |_| vec![Body::deformable(unit_box())]);
    for kind in [QueryKind::Discrete, QueryKind::Continuous, QueryKind::Near] {
        let name = format!("{kind:?}");
        assert!(told.iter().any(|query| query.starts_with(&name)), "{name}: {told:?}");
    }
}
