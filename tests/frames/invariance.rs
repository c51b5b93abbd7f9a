//! Things on which an answer must not depend: numbering, order, names of the axes, units, the
//! machine and its choices.

mod choices;
mod numbering;
mod space;
mod volumes;

use nearmiss::contacts::{Contact, Kind, Status};
use nearmiss::mesh::{Body, Mesh, Positions, Topology};
use nearmiss::query::QueryKind;
use nearmiss::research::{BoundingVolume, QueryExt};
use nearmiss::{Contacts, Query};
use nearmiss_lab::scene::{self, Rng};
use std::collections::BTreeMap;
use support::asked::of;
use support::{ask, engine};

/// The answer of the engine.
fn found(bodies: &[Body], motion: QueryKind) -> Contacts {
    ask(engine(), bodies.to_vec(), of(motion))
}

/// Pairs of features that may meet, by kind, and triangle pairs of a discrete query, between plain boxes: those are known
/// by the features and by the leaves alone. Which pairs of features are candidates is also a matter of who owns them, and so of order.
fn boxed(bodies: &[Body], motion: QueryKind) -> ([u64; 2], u64) {
    counted(&ask(engine(), bodies.to_vec(), of(motion).with_volume(BoundingVolume::Aabb)))
}

fn counted(contacts: &Contacts) -> ([u64; 2], u64) {
    let pairs = if contacts.stats.candidates_vf_ee == [0, 0] { contacts.stats.candidates } else { 0 };
    (contacts.stats.survivors_vf_ee, pairs)
}

/// Scenes with discrete contacts, adjacent triangles among them.
fn still_scenes() -> Vec<Body> {
    let all = [scene::grid(3), scene::soup(250, 2, false), scene::draped(400)];
    all.into_iter().map(|body| body.expect("a scene")).collect()
}

/// Scenes in motion.
fn moving_scenes() -> Vec<Body> {
    [scene::soup(250, 2, true), scene::draped(1_500), scene::balls(6, 1, 3)]
        .into_iter()
        .map(|body| body.expect("a scene"))
        .collect()
}

/// A permutation of the numbers below n.
fn permutation(n: usize, seed: u64) -> Vec<u32> {
    let mut rng = Rng::new(seed);
    let mut numbers: Vec<u32> = (0..n as u32).collect();
    for i in (1..n).rev() {
        numbers.swap(i, (rng.bits() % (i as u64 + 1)) as usize);
    }
    numbers
}

/// The body with other faces and with every position changed.
fn changed(body: &Body, faces: Vec<[u32; 3]>, change: impl Fn(Vec<[f64; 3]>) -> Vec<[f64; 3]>) -> Body {
    let mesh = |positions: &Positions| {
        let points = change(positions.to_f64());
        let positions = match positions {
            Positions::F64(_) => Positions::F64(points),
            Positions::F32(_) => Positions::F32(points.into_iter().map(|p| p.map(|x| x as f32)).collect()),
        };
        Mesh::new(body.name(), positions, faces.clone()).expect("a mesh")
    };
    let t0 = mesh(body.positions_t0());
    match body.positions_t1() {
        None => Body::deformable(t0),
        Some(t1) => Body::moving(t0, mesh(t1)).expect("two frames"),
    }
}

/// The body with every point changed.
fn mapped(body: &Body, point: impl Fn([f64; 3]) -> [f64; 3]) -> Body {
    changed(body, body.faces().to_vec(), |points| points.into_iter().map(&point).collect())
}

/// A contact by what it is, not by its numbers: kind, and vertices of the original mesh. The two edges of a pair, and
/// the vertices of each, are in ascending order.
type Named = (Kind, Vec<u32>, Vec<u32>);
/// The bits of a contact's times, `toi` and `toi_upper`.
type Times = [u64; 2];

/// The contacts of one body as named features with their times. `vertex` gives each vertex its original
/// number.
fn named(body: &Body, contacts: &[Contact], vertex: impl Fn(u32) -> u32) -> BTreeMap<Named, Times> {
    let edges = Topology::new(body.faces(), body.vertex_count()).edges;
    let sorted = |of: &[u32]| {
        let mut all: Vec<u32> = of.iter().map(|v| vertex(*v)).collect();
        all.sort_unstable();
        all
    };
    let mut all = BTreeMap::new();
    for c in contacts {
        let name = match c.kind {
            Kind::Ev | Kind::Vv => unreachable!("all bodies are of faces"),
            Kind::Vf => (Kind::Vf, sorted(&[c.feature_a]), sorted(&body.faces()[c.feature_b as usize])),
            Kind::Ee => {
                let mut ends = [c.feature_a, c.feature_b].map(|e| sorted(&edges[e as usize]));
                ends.sort();
                let [a, b] = ends;
                (Kind::Ee, a, b)
            }
        };
        assert_eq!(all.insert(name, [c.toi, c.toi_upper].map(f64::to_bits)), None, "a contact twice: {c:?}");
    }
    all
}

/// Asserts the same contacts, and times of which both can be true: where features are numbered or turned otherwise the solver
/// rounds and scales otherwise, but the first time of contact lies in both intervals. So they share a point.
fn assert_close(one: &BTreeMap<Named, Times>, other: &BTreeMap<Named, Times>, what: &str) {
    assert!(one.keys().eq(other.keys()), "{what}: other contacts, {} and {}", one.len(), other.len());
    for ((name, a), b) in one.iter().zip(other.values()) {
        let ([a, a_hi], [b, b_hi]) = (a.map(f64::from_bits), b.map(f64::from_bits));
        assert!(a <= b_hi && b <= a_hi, "{what}: {name:?} in [{a}, {a_hi}] and [{b}, {b_hi}]");
    }
}

#[test]
fn the_comparison_can_fail() {
    let body = scene::soup(60, 5, true).expect("a scene");
    let contacts = found(std::slice::from_ref(&body), QueryKind::Continuous);
    let truth = named(&body, contacts.contacts(), |v| v);
    let less = contacts.contacts()[1..].to_vec();
    assert_ne!(named(&body, &less, |v| v), truth);
    let mut late = contacts.contacts().to_vec();
    (late[0].toi, late[0].toi_upper) = (late[0].toi_upper + 1e-6, late[0].toi_upper + 2e-6);
    let late = named(&body, &late, |v| v);
    assert!(std::panic::catch_unwind(|| assert_close(&late, &truth, "late")).is_err());
    assert!(std::panic::catch_unwind(|| assert_close(&named(&body, &less, |v| v), &truth, "less")).is_err());
    assert_close(&truth, &truth, "equal");
}
