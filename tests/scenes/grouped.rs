//! Rows by features of a body, and least numbers of vertices: against the rows' geometry, one by one.

use nearmiss::contacts::{GroupBy, Grouped, Kind};
use nearmiss::scene::BodyId;
use nearmiss::{Answer, Body, Continuous, Detector, Discrete, Near, Scene};
use nearmiss_lab::scene::{soup, threads};
use std::collections::BTreeMap;
use support::engine;

fn detector(bodies: Vec<Body>) -> Detector {
    Detector::new(engine(), Scene::from(bodies)).expect("a detector")
}

fn scenes() -> Vec<Vec<Body>> {
    let moving = |n, seed| soup(n, seed, true).expect("a soup");
    let filter = nearmiss::scene::CollisionFilter::without_self_collision();
    let between = |n, seed| moving(n, seed).with_filter(filter);
    let loose = threads(60, 8).expect("threads");
    vec![
        vec![moving(60, 7)],
        vec![between(40, 3), between(30, 4)],
        vec![moving(20, 5), between(20, 6)],
        vec![loose],
    ]
}

/// A feature of a row.
type Feature = (GroupBy, BodyId, u32);

/// All features of each row, from its own fields and its geometry.
macro_rules! features {
    ($detector:expr, $found:expr) => {{
        let geometry = $detector.geometry($found).expect("geometry");
        let rows = $found.iter().zip(&geometry);
        rows.map(|(row, at)| {
            let mut all: Vec<Feature> =
                (0..4).map(|k| (GroupBy::Corner, at.owner[k], at.vertices[k])).collect();
            let [a, b] = row.bodies;
            match row.kind {
                Kind::Vf => {
                    all.extend([(GroupBy::Vertex, a, row.feature_a), (GroupBy::Face, b, row.feature_b)])
                }
                Kind::Ee => {
                    all.extend([(GroupBy::Edge, a, row.feature_a), (GroupBy::Edge, b, row.feature_b)])
                }
                Kind::Ev => {
                    all.extend([(GroupBy::Edge, a, row.feature_a), (GroupBy::Vertex, b, row.feature_b)])
                }
                Kind::Vv => {
                    all.extend([(GroupBy::Vertex, a, row.feature_a), (GroupBy::Vertex, b, row.feature_b)])
                }
            }
            all
        })
        .collect::<Vec<Vec<Feature>>>()
    }};
}

/// The first group that is not as the rows say.
fn fault(by: GroupBy, body: BodyId, found: &Grouped, features: &[Vec<Feature>]) -> Option<String> {
    let mut wanted: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for (row, features) in features.iter().enumerate() {
        let mut own: Vec<u32> =
            features.iter().filter(|(of, id, _)| (*of, *id) == (by, body)).map(|f| f.2).collect();
        own.sort_unstable();
        own.dedup();
        own.into_iter().for_each(|feature| wanted.entry(feature).or_default().push(row as u32));
    }
    let bad = (0..found.len()).find(|&i| found.of(i) != wanted.remove(&(i as u32)).unwrap_or_default());
    bad.map(|i| format!("{by:?} {i}")).or_else(|| wanted.keys().next().map(|i| format!("no {by:?} {i}")))
}

#[test]
fn groups_are_those_of_the_rows() {
    let mut rows = 0;
    for bodies in scenes() {
        let mut detector = detector(bodies.clone());
        let contacts = detector.query(&Continuous::default()).expect("an answer");
        let near = detector.query(&Near::within(0.2)).expect("an answer");
        let of_contacts = features!(detector, &contacts);
        let of_near = features!(detector, &near);
        rows += contacts.len() + near.len();
        for (number, body) in detector.scene().ids().collect::<Vec<_>>().into_iter().enumerate() {
            for by in GroupBy::ALL {
                let found = detector.grouped(&contacts, body, by).expect("groups");
                assert_eq!(fault(by, body, &found, &of_contacts), None);
                let found = detector.grouped(&near, body, by).expect("groups");
                assert_eq!(fault(by, body, &found, &of_near), None);
                if by == GroupBy::Face {
                    assert_eq!(found.len(), bodies[number].element_count());
                }
            }
            let least = detector.least_by_vertex(&contacts, body).expect("times");
            let times: Vec<f64> = contacts.iter().map(|row| row.toi).collect();
            assert_eq!(least, brute(&of_contacts, &times, body, least.len()));
            let least = detector.least_by_vertex(&near, body).expect("distances");
            let distances: Vec<f64> = near.iter().map(|row| row.squared_distance.sqrt()).collect();
            assert_eq!(least, brute(&of_near, &distances, body, bodies[number].vertex_count()));
        }
    }
    assert!(rows > 1000, "{rows}");
}

/// The least number of each vertex over all rows.
fn brute(features: &[Vec<Feature>], numbers: &[f64], body: BodyId, vertices: usize) -> Vec<f64> {
    let of = |vertex: usize| {
        let feature = (GroupBy::Corner, body, vertex as u32);
        let own = features.iter().zip(numbers).filter(|(all, _)| all.contains(&feature));
        own.map(|(_, &number)| number).fold(f64::INFINITY, f64::min)
    };
    (0..vertices).map(of).collect()
}

#[test]
fn the_judge_names_a_wrong_group() {
    let mut detector = detector(scenes().remove(0));
    let body = detector.scene().ids().next().expect("a body");
    let near = detector.query(&Near::within(0.2)).expect("an answer");
    let features = features!(detector, &near);
    let mut found = detector.grouped(&near, body, GroupBy::Edge).expect("groups");
    let (place, edge) = (found.rows.len() / 2, |place: usize, starts: &[u32]| {
        starts.iter().rposition(|&start| start as usize <= place).expect("an edge")
    });
    found.rows[place] ^= 1;
    let named = fault(GroupBy::Edge, body, &found, &features);
    assert_eq!(named, Some(format!("Edge {}", edge(place, &found.starts))));
}

/// Triangle pairs by face and by corner; what they do not have is refused, and so is what is of another
/// scene.
#[test]
fn triangles_have_faces_and_corners() {
    for bodies in scenes() {
        let mut detector = detector(bodies.clone());
        let pairs = detector.query(&Discrete::default()).expect("an answer");
        for (number, body) in detector.scene().ids().collect::<Vec<_>>().into_iter().enumerate() {
            let by_face = detector.grouped(&pairs, body, GroupBy::Face).expect("groups");
            let by_corner = detector.grouped(&pairs, body, GroupBy::Corner).expect("groups");
            for (row, pair) in pairs.iter().enumerate() {
                for side in (0..2).filter(|&side| pair.bodies[side] == body) {
                    let face = pair.triangles[side] as usize;
                    assert!(by_face.of(face).contains(&(row as u32)));
                    let corners = bodies[number].elements()[face];
                    assert!(corners.iter().all(|&v| by_corner.of(v as usize).contains(&(row as u32))));
                }
            }
            let sides = pairs.iter().flat_map(|pair| pair.bodies).filter(|&of| of == body).count();
            assert_eq!(by_face.rows.len(), sides);
            for by in [GroupBy::Vertex, GroupBy::Edge] {
                let refused = detector.grouped(&pairs, body, by).expect_err("refused").to_string();
                assert!(refused.contains("cannot be grouped by"), "{refused}");
            }
            assert!(detector.least_by_vertex(&pairs, body).is_err());
        }
    }
}

#[test]
fn rows_of_another_scene_are_refused() {
    let mut large = detector(scenes().remove(0));
    let found: Answer<_> = large.query(&Near::within(0.2)).expect("an answer");
    let body = large.scene().ids().next().expect("a body");
    let mut small = detector(vec![soup(2, 3, true).expect("a soup")]);
    for by in GroupBy::ALL {
        assert!(small.grouped(&found, body, by).is_err());
    }
    assert!(small.least_by_vertex(&found, body).is_err());
    let mut two = detector(scenes().remove(1));
    let second = two.scene().ids().nth(1).expect("a body");
    let refused = large.grouped(&found, second, GroupBy::Vertex).expect_err("refused").to_string();
    assert!(refused.contains("there is no body 1 in the scene"), "{refused}");
    assert!(two.query(&Near::within(0.1)).is_ok());
}
