//! Triangle pairs with their first time, derived from feature contacts.

use nearmiss::Query;
use nearmiss::contacts::triangle_contacts;
use nearmiss::mesh::{Body, Mesh, Positions};
use nearmiss_lab::scene;
use support::{ask, engine};

/// A square of two triangles at rest, and a triangle that falls through it corner first.
fn falling(gap: f32) -> Vec<[f32; 3]> {
    let square = [[0.0, 0.0, 0.0], [8.0, 0.0, 0.0], [8.0, 8.0, 0.0], [0.0, 8.0, 0.0]];
    let corner = [[5.0, 1.0, gap], [5.0, 1.0, gap + 4.0], [6.0, 1.5, gap + 4.0]];
    square.into_iter().chain(corner).collect()
}

/// Not late, and early by what the tolerance is worth: 1e-4 of a mean edge of about 6, at a speed of 2.
fn at_half(toi: f64) -> bool {
    (0.5 - 3e-4..=0.5).contains(&toi)
}

fn mesh(points: Vec<[f32; 3]>, faces: &[[u32; 3]]) -> Mesh {
    Mesh::new("falling", Positions::F32(points), faces.to_vec()).expect("a mesh")
}

#[test]
fn a_corner_that_falls_through_a_square_meets_one_triangle_of_it_first() {
    let faces = [[0, 1, 2], [0, 2, 3], [4, 5, 6]];
    let body = Body::moving(mesh(falling(1.0), &faces), mesh(falling(-1.0), &faces)).expect("frames");
    let found = ask(engine(), vec![body.clone()], Query::continuous());
    let pairs = triangle_contacts(found.contacts(), &[body]);
    let known: Vec<_> =
        pairs.iter().map(|p| (p.pair.triangles[0], p.pair.triangles[1], at_half(p.toi))).collect();
    assert_eq!(known, [(0, 2, true)]);
}

#[test]
fn between_two_bodies_indices_are_their_own() {
    let (square, corner) = (falling(1.0)[..4].to_vec(), |gap| falling(gap)[4..].to_vec());
    let square = Body::deformable(mesh(square, &[[0, 1, 2], [0, 2, 3]]));
    let corner =
        Body::moving(mesh(corner(1.0), &[[0, 1, 2]]), mesh(corner(-1.0), &[[0, 1, 2]])).expect("frames");
    for (bodies, pair) in [(vec![square.clone(), corner.clone()], (0, 0)), (vec![corner, square], (0, 0))] {
        let found = ask(engine(), bodies.clone(), Query::continuous());
        let pairs = triangle_contacts(found.contacts(), &bodies);
        assert_eq!(
            pairs.iter().map(|p| (<(u32, u32)>::from(p.pair.triangles), at_half(p.toi))).collect::<Vec<_>>(),
            [(pair, true)]
        );
    }
}

#[test]
fn every_contact_has_its_pairs_and_every_pair_its_first_contact() {
    let body = scene::scene("draped", 3000, 1).expect("a scene");
    let found = ask(engine(), vec![body.clone()], Query::continuous());
    let pairs = triangle_contacts(found.contacts(), std::slice::from_ref(&body));
    assert!(pairs.len() > 100 && pairs.is_sorted_by_key(|p| p.pair.triangles));
    let first = pairs.iter().map(|p| p.toi).min_by(f64::total_cmp);
    assert!(first >= found.earliest_toi(), "{first:?} {:?}", found.earliest_toi());
    // A pair's time is that of a contact, and none is earlier than the first.
    let times: std::collections::HashSet<u64> = found.contacts().iter().map(|c| c.toi.to_bits()).collect();
    assert!(pairs.iter().all(|p| times.contains(&p.toi.to_bits())));
    // Without the earliest contact of a pair the pair is later or gone: times are minima, not just any.
    let without: Vec<_> = found.contacts().iter().copied().filter(|c| Some(c.toi) != first).collect();
    let later = triangle_contacts(&without, &[body]);
    assert_ne!(later, pairs);
    assert!(triangle_contacts(&[], &[]).is_empty());
}
