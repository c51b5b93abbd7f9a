//! Converts contacts of features to triangle pairs with their first times.

use super::{Contact, Kind, TrianglePair};
use crate::mesh::Topology;
use crate::scene::Body;
use std::collections::HashMap;

/// Two triangles without a common vertex whose features meet during the step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TriangleContact {
    /// The triangles and their bodies; within one body the smaller index first.
    pub pair: TrianglePair,
    /// First time at which a feature of one meets a feature of the other, in [0, 1].
    pub toi: f64,
}

/// Triangles of each vertex and of each edge.
struct Incidence<'a> {
    faces: &'a [[u32; 3]],
    of_vertex: Vec<Vec<u32>>,
    of_edge: Vec<Vec<u32>>,
}

impl<'a> Incidence<'a> {
    fn new(body: &'a Body) -> Self {
        let faces = body.elements();
        let topology = Topology::of(body);
        let mut of_vertex = vec![Vec::new(); body.vertex_count()];
        let mut of_edge = vec![Vec::new(); topology.edges.len()];
        for (triangle, (face, edges)) in faces.iter().zip(&topology.face_edges).enumerate() {
            let triangle = triangle as u32;
            for (k, &vertex) in face.iter().enumerate() {
                if !face[..k].contains(&vertex) {
                    of_vertex[vertex as usize].push(triangle);
                }
            }
            for (k, &edge) in edges.iter().enumerate() {
                // An edge of no length has no number.
                if let Some(list) = of_edge.get_mut(edge as usize)
                    && !edges[..k].contains(&edge)
                {
                    list.push(triangle);
                }
            }
        }
        Incidence { faces, of_vertex, of_edge }
    }
}

/// Returns the triangle pairs of `contacts`, ascending. `bodies` are those of the scene, by number.
/// Pairs that share a vertex are left out, as in a discrete query. Cost: for each contact, the
/// product of the numbers of both features' triangles.
pub fn triangle_contacts(contacts: &[Contact], bodies: &[Body]) -> Vec<TriangleContact> {
    let incidences: Vec<Incidence> = bodies.iter().map(Incidence::new).collect();
    let mut earliest: HashMap<TrianglePair, f64> = HashMap::new();
    for contact in contacts {
        let (a, b) = (contact.feature_a as usize, contact.feature_b as usize);
        let [first, second] = contact.bodies.map(|body| incidences.get(body.index()));
        let (Some(first), Some(second)) = (first, second) else { continue };
        let within = contact.bodies[0] == contact.bodies[1];
        let (of_a, of_b) = match contact.kind {
            Kind::Vf => (first.of_vertex[a].clone(), vec![contact.feature_b]),
            Kind::Ee => (first.of_edge[a].clone(), second.of_edge[b].clone()),
            Kind::Ev => (first.of_edge[a].clone(), second.of_vertex[b].clone()),
            Kind::Vv => (first.of_vertex[a].clone(), second.of_vertex[b].clone()),
        };
        for &p in &of_a {
            for &q in &of_b {
                let (p_face, q_face) = (first.faces[p as usize], second.faces[q as usize]);
                if within && p_face.iter().any(|v| q_face.contains(v)) {
                    continue;
                }
                let mut ends = [(contact.bodies[0], p), (contact.bodies[1], q)];
                ends.sort_unstable();
                let pair = TrianglePair { bodies: ends.map(|end| end.0), triangles: ends.map(|end| end.1) };
                let toi = earliest.entry(pair).or_insert(contact.toi);
                *toi = toi.min(contact.toi);
            }
        }
    }
    let mut all: Vec<_> = earliest.into_iter().map(|(pair, toi)| TriangleContact { pair, toi }).collect();
    all.sort_unstable_by_key(|contact| contact.pair.key());
    all
}
