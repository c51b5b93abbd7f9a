//! Edges of a mesh, and the face that owns each vertex and edge.

use super::loose::ordered;
use crate::scene::Body;
use nearmiss_emulator::Looks;

/// Edge id of two equal corners, which form no edge.
pub const NO_EDGE: u32 = u32::MAX;

/// The edges of a mesh, and the one face that owns each vertex and edge.
///
/// By ownership a pass over pairs of faces tests each feature pair exactly once: a face tests only
/// its own features. Few faces own much, since a pair of faces that own nothing takes no test:
///
/// 1. Each face in sequence whose three edges have no owner yet owns them. Then each whose last two
///    do, then one.
/// 2. In the same way vertices go to faces that own an edge, then to others.
///
/// A face owns a vertex at its first corner that has it, and an edge likewise. A vertex that no face
/// uses has no owner.
///
/// Edge `k` of a face joins its corners `k` and `k + 1` (mod 3). If a face repeats an index, the
/// two equal corners form no edge: the id is [`NO_EDGE`], without an owner. Their point is still
/// tested as a vertex, and as an end of other edges.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Topology {
    /// Rows `[larger vertex, smaller vertex]`, ascending by larger, then smaller vertex; each edge
    /// once.
    pub edges: Vec<[u32; 2]>,
    /// Ids of each face's edges (0, 1), (1, 2), (2, 0), or [`NO_EDGE`].
    pub face_edges: Vec<[u32; 3]>,
    /// Owner bits of each face: bit `k` (0 to 2) for the vertex of corner `k`; bit `3 + k` for its
    /// edge `k`.
    pub owners: Vec<u32>,
}

impl Topology {
    /// Finds edges and owners. Cost: O(faces + vertices) for meshes of bounded valence, by a
    /// counting sort by the larger vertex, then a sort of each vertex's few edges. Temporary
    /// memory: 12 bytes per corner and 4 per vertex.
    ///
    /// # Panics
    /// If a face names a vertex of `vertex_count` or above, or there are 2^30 faces or more.
    /// [`super::Mesh::new`] refuses both.
    pub fn new(faces: &[[u32; 3]], vertex_count: usize) -> Topology {
        // Without a handle no poll ends the work.
        Topology::within(faces, vertex_count, &Looks::new(None)).unwrap_or_default()
    }

    /// Finds edges and owners, for work that may end early: `None` if it did.
    pub(crate) fn within(faces: &[[u32; 3]], vertex_count: usize, looks: &Looks) -> Option<Topology> {
        let mut topology = Topology::of_edges(faces, vertex_count, looks)?;
        let counts = [vertex_count as u32, topology.edges.len() as u32];
        topology.owners = owners(faces, &topology.face_edges, counts, looks)?;
        Some(topology)
    }

    /// The edges, without owners.
    fn of_edges(faces: &[[u32; 3]], vertex_count: usize, looks: &Looks) -> Option<Topology> {
        assert!(faces.len() <= super::MAX_FACES, "faces come from a Mesh, which limits their number");
        let (starts, mut corners) = by_larger_vertex(faces, vertex_count, looks)?;
        let mut topology = Topology {
            edges: Vec::with_capacity(corners.len() / 2 + 2),
            face_edges: vec![[NO_EDGE; 3]; faces.len()],
            owners: Vec::new(),
        };
        for (larger, ends) in starts.windows(2).enumerate() {
            if larger % PIECE == 0 && looks.ends() {
                return None;
            }
            let bucket = &mut corners[ends[0] as usize..ends[1] as usize];
            bucket.sort_unstable();
            let mut last = None;
            for &packed in bucket.iter() {
                let (smaller, corner) = ((packed >> 32) as u32, packed as u32);
                let (face, k) = (corner as usize / 3, corner as usize % 3);
                if last != Some(smaller) {
                    last = Some(smaller);
                    topology.edges.push([larger as u32, smaller]);
                }
                topology.face_edges[face][k] = topology.edges.len() as u32 - 1;
            }
        }
        Some(topology)
    }

    /// Edges and owners of all [elements](Body::elements) of a body, by the numbers that it gives
    /// edges.
    pub fn of(body: &Body) -> Topology {
        Topology::of_body(body, &Looks::new(None)).unwrap_or_default()
    }

    /// As [`Topology::of`], for work that may end early: `None` if it did.
    pub(crate) fn of_body(body: &Body, looks: &Looks) -> Option<Topology> {
        let elements = body.elements();
        let mut topology = Topology::of_edges(elements, body.vertex_count(), looks)?;
        topology.number(body.edges());
        let counts = [body.vertex_count() as u32, topology.edges.len() as u32];
        topology.owners = owners(elements, &topology.face_edges, counts, looks)?;
        Some(topology)
    }

    /// Numbers edges as a list does; those that it lacks come behind it in their order.
    fn number(&mut self, given: &[[u32; 2]]) {
        if given.is_empty() {
            return;
        }
        let given: Vec<[u32; 2]> = given.iter().map(|&edge| ordered(edge)).collect();
        let mut numbers = vec![NO_EDGE; self.edges.len()];
        for (number, edge) in given.iter().enumerate() {
            // An edge of one vertex, which a weld can leave, is no edge.
            if let Ok(at) = self.edges.binary_search(edge)
                && numbers[at] == NO_EDGE
            {
                numbers[at] = number as u32;
            }
        }
        let mut edges = given;
        for (number, &edge) in numbers.iter_mut().zip(&self.edges) {
            if *number == NO_EDGE {
                *number = edges.len() as u32;
                edges.push(edge);
            }
        }
        let named = |edge: &mut u32| {
            if *edge != NO_EDGE {
                *edge = numbers[*edge as usize];
            }
        };
        self.face_edges.iter_mut().flatten().for_each(named);
        self.edges = edges;
    }
}

/// The owner bits of each face, from its vertices and edges and how many of these there are. A face
/// of three times [`NO_EDGE`] in both lists owns nothing. `None` if the work ended early.
pub(crate) fn owners(
    faces: &[[u32; 3]],
    face_edges: &[[u32; 3]],
    [vertices, edges]: [u32; 2],
    looks: &Looks,
) -> Option<Vec<u32>> {
    let mut owners = vec![0; faces.len()];
    own(&mut owners, (face_edges, 3), edges as usize, &[|_| true], looks)?;
    own(&mut owners, (faces, 0), vertices as usize, &[|owned| owned != 0, |_| true], looks)?;
    Some(owners)
}

/// Faces or vertices between two polls of an interrupt: less than a millisecond.
const PIECE: usize = 1 << 14;

/// Pieces of `faces`, each with the number of its first face, until the work ends early.
fn pieces<'a>(
    faces: &'a [[u32; 3]],
    looks: &'a Looks,
) -> impl Iterator<Item = Option<(usize, &'a [[u32; 3]])>> {
    let pieces = faces.chunks(PIECE).enumerate();
    pieces.map(|(at, piece)| (!looks.ends()).then_some((at * PIECE, piece)))
}

/// A range (`starts[v]..starts[v + 1]`) of edges for each vertex `v`: those with larger end `v`,
/// packed as smaller end and corner, `3 face + k`.
fn by_larger_vertex(faces: &[[u32; 3]], vertex_count: usize, looks: &Looks) -> Option<(Vec<u32>, Vec<u64>)> {
    let ends = |face: &[u32; 3], k: usize| {
        let (a, b) = (face[k], face[(k + 1) % 3]);
        (a != b).then_some((a.max(b), a.min(b)))
    };
    let mut starts = vec![0u32; vertex_count + 1];
    for piece in pieces(faces, looks) {
        for face in piece?.1 {
            for (larger, _) in (0..3).filter_map(|k| ends(face, k)) {
                starts[larger as usize] += 1;
            }
        }
    }
    let mut sum = 0;
    for start in &mut starts {
        sum += *start;
        *start = sum; // the end of the range, from which the filling counts down to its start
    }
    let mut corners = vec![0u64; sum as usize];
    for piece in pieces(faces, looks) {
        let (first, piece) = piece?;
        for (face, index) in piece.iter().zip(first as u64..) {
            for k in 0..3 {
                let Some((larger, smaller)) = ends(face, k) else { continue };
                let slot = &mut starts[larger as usize];
                *slot -= 1;
                corners[*slot as usize] = u64::from(smaller) << 32 | (3 * index + k as u64);
            }
        }
    }
    Some((starts, corners))
}

/// Gives each of `count` vertices or edges of faces an owner, and sets its bit from `shift` on. In
/// each of `stages`, faces that may own get three at once, then two, then one.
fn own(
    owners: &mut [u32],
    (faces, shift): (&[[u32; 3]], u32),
    count: usize,
    stages: &[fn(u32) -> bool],
    looks: &Looks,
) -> Option<()> {
    let mut is_owned = vec![false; count];
    for (may_own, number) in stages.iter().flat_map(|may_own| [3, 2, 1].map(|number| (may_own, number))) {
        for piece in pieces(faces, looks) {
            let (first, piece) = piece?;
            for (face, owner) in piece.iter().zip(&mut owners[first..]) {
                if !may_own(*owner) {
                    continue;
                }
                let mut bits = 0;
                for (k, &at) in face.iter().enumerate() {
                    let is_first = at != NO_EDGE && !face[..k].contains(&at);
                    bits |= u32::from(is_first && !is_owned[at as usize]) << k;
                }
                if bits.count_ones() == number {
                    (0..3).filter(|k| bits >> k & 1 == 1).for_each(|k| is_owned[face[k] as usize] = true);
                    *owner |= bits << shift;
                }
            }
        }
    }
    Some(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use nearmiss_emulator::Interrupt;

    /// Every poll can end the work, every piece of faces or vertices polls, and ended work can be
    /// repeated.
    #[test]
    fn a_look_ends_it_within_a_piece() {
        let pieces = 5;
        let vertices = pieces * PIECE;
        let faces: Vec<[u32; 3]> = (0..vertices as u32 - 2).map(|v| [v, v + 1, v + 2]).collect();
        let wanted = Topology::new(&faces, vertices);
        let interrupt = Interrupt::new();
        let made = || Topology::within(&faces, vertices, &Looks::new(Some(&interrupt)));
        interrupt.trigger_at(u64::MAX);
        assert!(made().is_some_and(|made| made == wanted));
        // Two passes for the ranges, one for the edges, nine for the owners.
        let looks = u64::MAX - interrupt.looks_left();
        assert_eq!(looks, 12 * pieces as u64);
        for look in 1..=looks {
            interrupt.trigger_at(look);
            assert!(made().is_none(), "look {look}");
            interrupt.clear();
        }
        assert!(made().is_some_and(|made| made == wanted));
    }
}
