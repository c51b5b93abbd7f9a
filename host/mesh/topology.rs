//! Edges, and which face owns which vertex and edge.

/// The edge id of a corner pair with equal ends, which is no edge.
pub const NO_EDGE: u32 = u32::MAX;

/// The edges of a mesh, and for each vertex and edge the one face that owns it.
///
/// Ownership lets a pass over pairs of faces see each pair of vertices and faces, or of edges, exactly once: a face
/// answers only for what it owns. The owner is the face of smallest index that has the vertex or edge, at its first
/// corner that has it. A vertex that no face uses has no owner.
///
/// Edge `k` of a face joins its corners `k` and `k + 1` (mod 3). Where a face repeats an index, the pair with equal
/// ends is no edge: it has the id [`NO_EDGE`] and is never owned; its point is tested as a vertex, and as an end of
/// other edges.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Topology {
    /// `[larger vertex, smaller vertex]`, ascending by larger, then smaller; each edge once.
    pub edges: Vec<[u32; 2]>,
    /// For each face the ids of its edges (0, 1), (1, 2), (2, 0), or [`NO_EDGE`].
    pub face_edges: Vec<[u32; 3]>,
    /// For each face: bit `k` (0 to 2), it owns the vertex of corner `k`; bit `3 + k`, it owns its edge `k`.
    pub owners: Vec<u32>,
}

impl Topology {
    /// Finds edges and owners. Cost: O(faces + vertices) for meshes of bounded valence (a counting sort by the larger
    /// vertex, then a sort of each vertex's few edges), 12 bytes a corner and 4 a vertex on the way.
    ///
    /// # Panics
    /// If a face names a vertex of `vertex_count` or above, or there are 2^30 faces or more, both of which
    /// [`super::Mesh::new`] refuses.
    pub fn new(faces: &[[u32; 3]], vertex_count: usize) -> Topology {
        assert!(faces.len() <= super::MAX_FACES, "faces come from a Mesh, which limits their number");
        let (starts, mut corners) = by_larger_vertex(faces, vertex_count);
        let mut topology = Topology {
            edges: Vec::with_capacity(corners.len() / 2 + 2),
            face_edges: vec![[NO_EDGE; 3]; faces.len()],
            owners: vertex_owners(faces, vertex_count),
        };
        for (larger, ends) in starts.windows(2).enumerate() {
            let bucket = &mut corners[ends[0] as usize..ends[1] as usize];
            bucket.sort_unstable();
            let mut last = None;
            for &packed in bucket.iter() {
                let (smaller, corner) = ((packed >> 32) as u32, packed as u32);
                let (face, k) = (corner as usize / 3, corner as usize % 3);
                if last != Some(smaller) {
                    // The first of its run: the smallest face, at its first corner.
                    last = Some(smaller);
                    topology.edges.push([larger as u32, smaller]);
                    topology.owners[face] |= 1 << (3 + k);
                }
                topology.face_edges[face][k] = topology.edges.len() as u32 - 1;
            }
        }
        topology
    }
}

/// For each vertex a range (`starts[v]..starts[v + 1]`) of the edges whose larger end it is, packed as smaller end
/// and corner, `3 face + k`.
fn by_larger_vertex(faces: &[[u32; 3]], vertex_count: usize) -> (Vec<u32>, Vec<u64>) {
    let ends = |face: &[u32; 3], k: usize| {
        let (a, b) = (face[k], face[(k + 1) % 3]);
        (a != b).then_some((a.max(b), a.min(b)))
    };
    let mut starts = vec![0u32; vertex_count + 1];
    for face in faces {
        for (larger, _) in (0..3).filter_map(|k| ends(face, k)) {
            starts[larger as usize] += 1;
        }
    }
    let mut sum = 0;
    for start in &mut starts {
        sum += *start;
        *start = sum; // the end of the range, from which the filling counts down to its start
    }
    let mut corners = vec![0u64; sum as usize];
    for (face, index) in faces.iter().zip(0u64..) {
        for k in 0..3 {
            let Some((larger, smaller)) = ends(face, k) else { continue };
            let slot = &mut starts[larger as usize];
            *slot -= 1;
            corners[*slot as usize] = u64::from(smaller) << 32 | (3 * index + k as u64);
        }
    }
    (starts, corners)
}

fn vertex_owners(faces: &[[u32; 3]], vertex_count: usize) -> Vec<u32> {
    let mut owned = vec![false; vertex_count];
    let mut bits = |face: &[u32; 3]| {
        let mut bits = 0;
        for (k, &vertex) in face.iter().enumerate() {
            let first = !std::mem::replace(&mut owned[vertex as usize], true);
            bits |= u32::from(first) << k;
        }
        bits
    };
    faces.iter().map(&mut bits).collect()
}
