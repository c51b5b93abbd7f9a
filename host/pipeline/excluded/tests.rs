//! Tables against searches over all pairs of vertices.

use super::*;
use crate::pipeline::layout::Layout;
use crate::query::Query;
use crate::samples;
use crate::scene::{Exclusions, RestShape};

/// Returns a scene of two sheets, and its tables: a ring of the first, some pairs of both.
fn tables(ring: u32, pairs: &[[u32; 2]]) -> (Scene, Excluded) {
    let bodies = vec![samples::sheet(6), samples::sheet(5)];
    let layout = Layout::new(&bodies, Query::near(0.1).kind());
    let mut scene = Scene::new();
    let ids: Vec<_> = bodies.into_iter().map(|body| scene.add(body)).collect();
    let rest =
        RestShape { within: 0.3, positions: scene.bodies()[1].frames().swap_remove(0).positions().clone() };
    let own = |ring, rest| Exclusions { ring, rest, faces: Vec::new() };
    scene.exclude(ids[0], own(Some(ring), None)).expect("a ring");
    scene.exclude(ids[1], own(None, Some(rest))).expect("a shape at rest");
    scene.exclude_pairs([ids[0], ids[1]], pairs).expect("pairs");
    let made = Excluded::new(&scene, &layout.starts, &Looks::new(None)).expect("tables");
    (scene, made)
}

/// Returns the first vertex whose keys do not ascend, or whose bits are not those of its keys.
fn fault(tables: &Excluded) -> Option<usize> {
    (0..tables.bits.len()).find(|&vertex| {
        let [first, end] = [vertex, vertex + 1].map(|word| tables.partners[word] as usize);
        let keys = &tables.partners[first..end];
        let bits = keys.iter().fold(PartnerBits::default(), |bits, &key| bits.with(key));
        !keys.is_sorted() || bits != tables.bits[vertex]
    })
}

#[test]
fn a_vertex_has_a_bit_for_each_partner() {
    let pairs = [[3, 4], [3, 9], [40, 0]];
    for ring in 1..4 {
        let (scene, mut made) = tables(ring, &pairs);
        assert_eq!(fault(&made), None);
        let counts = [0, 1].map(|body| scene.bodies()[body].vertex_count());
        assert_eq!(made.bits.len(), counts[0] + counts[1]);
        // Both bodies have their pairs, and only the first a ring: each vertex with itself at least.
        for [own, other] in pairs.map(|[p, q]| [p, q + counts[0] as u32]) {
            assert!(made.bits[own as usize].has(partner_key(other)));
            assert!(made.bits[other as usize].has(partner_key(own)));
        }
        for vertex in 0..counts[0] as u32 {
            assert!(made.bits[vertex as usize].has(partner_key(vertex)));
        }
        assert_eq!(made.bits[counts[0] + 1], PartnerBits::default());
        // A bit that is lost.
        made.bits[7] = PartnerBits::default();
        assert_eq!(fault(&made), Some(7));
    }
}

#[test]
fn a_reach_has_all_features_of_a_vertex() {
    let (scene, made) = tables(2, &[]);
    let (body, first) = (&scene.bodies()[1], scene.bodies()[0].vertex_count());
    assert!(made.reaches[..first].iter().all(|&reach| reach == RestReach::NONE));
    let positions = body.frames().swap_remove(0).positions().to_f64();
    let wanted = |vertex: u32| {
        let own = RestReach::around(positions[vertex as usize]);
        let elements = body.elements().iter().filter(|element| element.contains(&vertex));
        let extent = elements.flatten().map(|&other| own.extent(positions[other as usize]));
        own.reaching(extent.fold(0.0, f64::max), 0.3)
    };
    for vertex in 0..body.vertex_count() as u32 {
        assert_eq!(made.reaches[first + vertex as usize], wanted(vertex));
    }
}
