//! The law, by other means: distances by edges between all vertices, distances at rest in rational
//! numbers, and features of faces that take part.

use super::*;
use nearmiss::contacts::{Contact, Kind, NearPair, TrianglePair};
use nearmiss::mesh::Topology;
use nearmiss_lab::Features;
use nearmiss_lab::oracle::near::{distance_squared, triangles_squared};

/// No number of edges is between them.
const NONE: u32 = u32::MAX;

/// A body as the law sees it.
struct Own {
    faces: Vec<[u32; 3]>,
    edges: Vec<[u32; 2]>,
    /// Number of edges between any two vertices.
    between: Vec<Vec<u32>>,
    own: Exclusions,
}

impl Own {
    fn of(body: &Body, own: Exclusions) -> Own {
        let count = body.vertex_count();
        let edges = Topology::new(body.faces(), count).edges;
        // Floyd and Warshall.
        let mut between = vec![vec![NONE; count]; count];
        for (v, row) in between.iter_mut().enumerate() {
            row[v] = 0;
        }
        for &[p, q] in &edges {
            between[p as usize][q as usize] = 1;
            between[q as usize][p as usize] = 1;
        }
        for by in 0..count {
            for from in 0..count {
                for to in 0..count {
                    let way = between[from][by].saturating_add(between[by][to]);
                    between[from][to] = between[from][to].min(way);
                }
            }
        }
        Own { faces: body.faces().to_vec(), edges, between, own }
    }

    fn is_dead(&self, face: u32) -> bool {
        self.own.faces.contains(&face)
    }

    /// Whether each face with all of these vertices takes no part.
    fn takes_part(&self, vertices: &[u32]) -> bool {
        let has = |face: &[u32; 3]| vertices.iter().all(|v| face.contains(v));
        (0..).zip(&self.faces).any(|(face, corners)| has(corners) && !self.is_dead(face))
    }
}

/// A feature: its body, its vertices, and its number if it is a face.
struct Feature {
    body: BodyId,
    vertices: Vec<u32>,
    face: Option<u32>,
}

/// All exclusions of a scene.
pub struct Law {
    bodies: Vec<Option<Own>>,
    pairs: Vec<[(BodyId, u32); 2]>,
}

impl Law {
    pub fn of(scene: &Scene) -> Law {
        let own = |(at, body): (usize, &Body)| {
            let id = scene.id(at)?;
            Some(Own::of(body, scene.exclusions(id).cloned().unwrap_or_default()))
        };
        let ids: Vec<BodyId> = scene.ids().collect();
        let mut pairs = Vec::new();
        for &a in &ids {
            for &b in &ids {
                pairs.extend(scene.excluded_pairs([a, b]).into_iter().map(|[p, q]| [(a, p), (b, q)]));
            }
        }
        Law { bodies: scene.bodies().iter().enumerate().map(own).collect(), pairs }
    }

    fn own(&self, id: BodyId) -> &Own {
        self.bodies[id.index()].as_ref().expect("a body")
    }

    fn vertex(&self, body: BodyId, vertex: u32) -> Feature {
        Feature { body, vertices: vec![vertex], face: None }
    }

    fn edge(&self, body: BodyId, edge: u32) -> Feature {
        Feature { body, vertices: self.own(body).edges[edge as usize].to_vec(), face: None }
    }

    fn face(&self, body: BodyId, face: u32) -> Feature {
        Feature { body, vertices: self.own(body).faces[face as usize].to_vec(), face: Some(face) }
    }

    fn features(&self, kind: Kind, [a, b]: [BodyId; 2], first: u32, second: u32) -> [Feature; 2] {
        match kind {
            Kind::Vf => [self.vertex(a, first), self.face(b, second)],
            Kind::Ee => [self.edge(a, first), self.edge(b, second)],
            Kind::Ev => [self.edge(a, first), self.vertex(b, second)],
            Kind::Vv => [self.vertex(a, first), self.vertex(b, second)],
        }
    }

    fn excludes(&self, [one, other]: [Feature; 2]) -> bool {
        for feature in [&one, &other] {
            let own = self.own(feature.body);
            if feature.face.is_some_and(|face| own.is_dead(face)) || !own.takes_part(&feature.vertices) {
                return true;
            }
        }
        let mut pairs = one.vertices.iter().flat_map(|&p| other.vertices.iter().map(move |&q| [p, q]));
        let is_listed = |[p, q]: [u32; 2]| {
            let ([p, q], own) = ([(one.body, p), (other.body, q)], &self.pairs);
            own.contains(&[p, q]) || own.contains(&[q, p])
        };
        if pairs.clone().any(is_listed) {
            return true;
        }
        if one.body != other.body {
            return false;
        }
        let own = self.own(one.body);
        if let Some(ring) = own.own.ring
            && pairs.any(|[p, q]| own.between[p as usize][q as usize] < ring)
        {
            return true;
        }
        let Some(RestShape { within, positions }) = &own.own.rest else { return false };
        let at = |v: &u32| positions.get_f64(*v as usize).expect("a vertex");
        let (p, q): (Vec<_>, Vec<_>) =
            (one.vertices.iter().map(at).collect(), other.vertices.iter().map(at).collect());
        let apart = match (&p[..], &q[..]) {
            (&[p], &[x, y, z]) => distance_squared(Features::VertexFace, [p, x, y, z]),
            (&[p, q], &[x, y]) => distance_squared(Features::EdgeEdge, [p, q, x, y]),
            (&[a, b, c], &[x, y, z]) => triangles_squared(&[a, b, c], &[x, y, z]),
            _ => panic!("no such pair"),
        };
        apart.is_within(*within) && *within > 0.0
    }

    pub fn excludes_pair(&self, pair: &TrianglePair) -> bool {
        let [a, b] = pair.bodies;
        self.excludes([self.face(a, pair.triangles[0]), self.face(b, pair.triangles[1])])
    }

    fn excludes_contact(&self, contact: &Contact) -> bool {
        self.excludes(self.features(contact.kind, contact.bodies, contact.feature_a, contact.feature_b))
    }

    fn excludes_near(&self, pair: &NearPair) -> bool {
        self.excludes(self.features(pair.kind, pair.bodies, pair.feature_a, pair.feature_b))
    }
}

/// The rows that are left of an answer without exclusions.
pub type Rows = (Vec<TrianglePair>, Vec<Contact>, Vec<NearPair>);

/// The rows of an answer, less those that the law excludes.
pub fn less(whole: &Contacts, law: &Law) -> Rows {
    let pairs = whole.pairs().iter().filter(|pair| !law.excludes_pair(pair)).copied().collect();
    let contacts =
        whole.contacts().iter().filter(|contact| !law.excludes_contact(contact)).copied().collect();
    let near = whole.near().iter().filter(|pair| !law.excludes_near(pair)).copied().collect();
    (pairs, contacts, near)
}

/// The first row that an answer has too many, or lacks.
pub fn differ(found: &Contacts, (pairs, contacts, near): &Rows) -> Option<String> {
    fn first<T: PartialEq + std::fmt::Debug>(found: &[T], truth: &[T]) -> Option<String> {
        let both = |i: usize| (found.get(i), truth.get(i));
        let all = 0..found.len().max(truth.len());
        all.map(both).find(|(found, truth)| found != truth).map(|both| format!("{both:?}"))
    }
    first(found.pairs(), pairs)
        .or_else(|| first(found.contacts(), contacts))
        .or_else(|| first(found.near(), near))
}
