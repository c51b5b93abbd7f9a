//! Triangles, corners, vertices and bodies in another order.

use super::*;

/// Discrete pairs in the original numbers of triangles: triangle i of the new mesh is `of[i]` of the old.
fn renumbered(contacts: &Contacts, of: &[u32]) -> Vec<[u32; 2]> {
    let mut pairs: Vec<_> = contacts
        .triangles()
        .into_iter()
        .map(|[a, b]| {
            let (a, b) = (of[a as usize], of[b as usize]);
            [a.min(b), a.max(b)]
        })
        .collect();
    pairs.sort_unstable();
    pairs
}

#[test]
fn triangles_in_another_order() {
    for body in still_scenes() {
        let truth = found(std::slice::from_ref(&body), QueryKind::Discrete);
        assert!(!truth.is_empty(), "{}", body.name());
        for seed in 0..3 {
            let of = permutation(body.face_count(), seed);
            let other =
                changed(&body, of.iter().map(|i| body.faces()[*i as usize]).collect(), |points| points);
            let again = found(&[other], QueryKind::Discrete);
            assert_eq!(renumbered(&again, &of), truth.triangles(), "{}, {seed}", body.name());
        }
    }
    for body in moving_scenes() {
        let contacts = found(std::slice::from_ref(&body), QueryKind::Continuous);
        assert!(!contacts.is_empty(), "{}", body.name());
        let of = permutation(body.face_count(), 9);
        let other = changed(&body, of.iter().map(|i| body.faces()[*i as usize]).collect(), |points| points);
        let again = found(std::slice::from_ref(&other), QueryKind::Continuous);
        // Faces keep their corners and edges their numbers: even the bits of the times are the same.
        assert_eq!(
            named(&other, again.contacts(), |v| v),
            named(&body, contacts.contacts(), |v| v),
            "{}",
            body.name()
        );
        // The pairs that the solver gets are others: features have other owners, and directions part
        // pairs of owners.
    }
}

#[test]
fn corners_in_another_order() {
    const CORNERS: [[usize; 3]; 6] = [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [2, 1, 0], [1, 0, 2]];
    for body in still_scenes() {
        let truth = found(std::slice::from_ref(&body), QueryKind::Discrete);
        // Each triangle in its own order, and six times round.
        for turn in 0..6 {
            let corners = |(i, face): (usize, &[u32; 3])| CORNERS[(i + turn) % 6].map(|k| face[k]);
            let other =
                changed(&body, body.faces().iter().enumerate().map(corners).collect(), |points| points);
            assert_eq!(
                found(&[other], QueryKind::Discrete).pairs(),
                truth.triangles(),
                "{}, {turn}",
                body.name()
            );
        }
    }
    for body in moving_scenes() {
        let contacts = found(std::slice::from_ref(&body), QueryKind::Continuous);
        for corners in CORNERS {
            let faces = body.faces().iter().map(|face| corners.map(|k| face[k])).collect();
            let other = changed(&body, faces, |points| points);
            let again = found(std::slice::from_ref(&other), QueryKind::Continuous);
            // The parameters of a face begin at another corner: times may differ in the last bits.
            let (one, two) =
                (named(&other, again.contacts(), |v| v), named(&body, contacts.contacts(), |v| v));
            assert_close(&one, &two, body.name());
        }
    }
}

#[test]
fn vertices_in_another_order() {
    let shuffled = |body: &Body, of: &[u32]| {
        // Vertex i of the new mesh is `of[i]` of the old.
        let mut to = vec![0; of.len()];
        of.iter().zip(0..).for_each(|(old, new)| to[*old as usize] = new);
        let faces = body.faces().iter().map(|face| face.map(|v| to[v as usize])).collect();
        changed(body, faces, |points| of.iter().map(|i| points[*i as usize]).collect())
    };
    for body in still_scenes() {
        let other = shuffled(&body, &permutation(body.vertex_count(), 4));
        let truth = found(std::slice::from_ref(&body), QueryKind::Discrete);
        assert_eq!(found(&[other], QueryKind::Discrete).pairs(), truth.triangles(), "{}", body.name());
    }
    for body in moving_scenes() {
        let contacts = found(std::slice::from_ref(&body), QueryKind::Continuous);
        let of = permutation(body.vertex_count(), 5);
        let other = shuffled(&body, &of);
        let again = found(std::slice::from_ref(&other), QueryKind::Continuous);
        let one = named(&other, again.contacts(), |v| of[v as usize]);
        assert_close(&one, &named(&body, contacts.contacts(), |v| v), body.name());
    }
}

#[test]
fn bodies_exchanged() {
    let scenes = still_scenes();
    for (one, two) in [(&scenes[0], &scenes[1]), (&scenes[1], &scenes[2]), (&scenes[2], &scenes[0])] {
        let there = found(&[one.clone(), two.clone()], QueryKind::Discrete);
        let back = found(&[two.clone(), one.clone()], QueryKind::Discrete);
        let mut turned: Vec<_> = back.triangles().iter().map(|[a, b]| [*b, *a]).collect();
        turned.sort_unstable();
        assert_eq!(turned, there.triangles());
        assert!(!turned.is_empty());
    }
    let mut scenes = moving_scenes();
    scenes.push(scene::soup(200, 6, true).expect("a scene"));
    for (one, two) in [(&scenes[0], &scenes[3]), (&scenes[1], &scenes[2])] {
        let there = found(&[one.clone(), two.clone()], QueryKind::Continuous);
        let back = found(&[two.clone(), one.clone()], QueryKind::Continuous);
        // A vertex/face pair is the same query to the solver: same bits. For two edges the first
        // one changes.
        let of = |contacts: &Contacts, kind, turned| -> BTreeMap<[u32; 2], Times> {
            let is = |c: &&Contact| c.kind == kind && (c.bodies[0] > c.bodies[1]) == turned;
            let all = contacts.contacts().iter().filter(is);
            all.map(|c| ([c.feature_a, c.feature_b], [c.toi, c.toi_upper].map(f64::to_bits))).collect()
        };
        assert_eq!(of(&back, Kind::Vf, true), of(&there, Kind::Vf, false));
        assert_eq!(of(&back, Kind::Vf, false), of(&there, Kind::Vf, true));
        let exchanged = |all: BTreeMap<[u32; 2], Times>| -> BTreeMap<[u32; 2], Times> {
            all.into_iter().map(|([a, b], times)| ([b, a], times)).collect()
        };
        let edges = |of: BTreeMap<[u32; 2], Times>| -> BTreeMap<Named, Times> {
            of.into_iter().map(|([a, b], times)| ((Kind::Ee, vec![a], vec![b]), times)).collect()
        };
        let of_edges = of(&there, Kind::Ee, false);
        assert!(of(&there, Kind::Vf, false).len() > 3 && of_edges.len() > 3);
        assert_close(&edges(exchanged(of(&back, Kind::Ee, false))), &edges(of_edges), "edges");
    }
}
