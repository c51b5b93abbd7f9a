//! The checker of [`Topology`]: its definition, implemented with maps and without the
//! construction's tricks.

use super::topology::{NO_EDGE, Topology};
use std::collections::{HashMap, HashSet};

/// The first violation of a [`Topology`]'s definition.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Violation {
    /// The number of `face_edges` or `owners` is not that of the faces.
    #[error("{faces} faces, but {face_edges} face_edges and {owners} owners")]
    Lengths {
        /// Number of faces.
        faces: usize,
        /// Number of triples of edge ids.
        face_edges: usize,
        /// Number of owner words.
        owners: usize,
    },
    /// An edge whose larger vertex is not first.
    #[error("edge {edge} does not name its larger vertex first")]
    SmallerFirst {
        /// Edge id.
        edge: usize,
    },
    /// An edge that is not above the one before it.
    #[error("edge {edge} is not above the one before it")]
    Order {
        /// Edge id.
        edge: usize,
    },
    /// An edge id of a face that is not that of the edge between its corners.
    #[error("face {face} edge {k} has the id {found}, not {expected}")]
    FaceEdge {
        /// Face.
        face: usize,
        /// Edge of the face.
        k: usize,
        /// The id found.
        found: u32,
        /// The id of the edge between the corners, or [`NO_EDGE`] if `edges` lacks it or the
        /// corners are equal.
        expected: u32,
    },
    /// An unlisted edge between corners of a face.
    #[error("face {face} edge {k} is missing from the edges")]
    Missing {
        /// Face.
        face: usize,
        /// Edge of the face.
        k: usize,
    },
    /// An edge that belongs to no face.
    #[error("edge {edge} belongs to no face")]
    Stray {
        /// Edge id.
        edge: usize,
    },
    /// A face with wrong owner bits: one too many or one too few.
    #[error("face {face} has the owner bits {found:#b}, not {expected:#b}")]
    Owner {
        /// Face.
        face: usize,
        /// The bits found.
        found: u32,
        /// The bits by definition.
        expected: u32,
    },
}

/// Checks every statement of [`Topology`]'s definition against `faces`. Slow (hash maps); for tests
/// and self-tests.
///
/// # Errors
/// The first [`Violation`].
pub fn check(topology: &Topology, faces: &[[u32; 3]]) -> Result<(), Violation> {
    let Topology { edges, face_edges, owners } = topology;
    if face_edges.len() != faces.len() || owners.len() != faces.len() {
        let (face_edges, owners) = (face_edges.len(), owners.len());
        return Err(Violation::Lengths { faces: faces.len(), face_edges, owners });
    }
    for (edge, pair) in edges.iter().enumerate() {
        if pair[0] <= pair[1] {
            return Err(Violation::SmallerFirst { edge });
        }
        if edge > 0 && edges[edge - 1] >= *pair {
            return Err(Violation::Order { edge });
        }
    }
    let ids: HashMap<[u32; 2], u32> = edges.iter().copied().zip(0..).collect();
    let expected_owners = owners_of(faces);
    let mut used = HashSet::new();
    for (face, corners) in faces.iter().enumerate() {
        for k in 0..3 {
            let (a, b) = (corners[k], corners[(k + 1) % 3]);
            let expected = if a == b {
                NO_EDGE
            } else {
                *ids.get(&[a.max(b), a.min(b)]).ok_or(Violation::Missing { face, k })?
            };
            let found = face_edges[face][k];
            if found != expected {
                return Err(Violation::FaceEdge { face, k, found, expected });
            }
            used.insert(expected);
        }
        let (found, expected) = (owners[face], expected_owners[face]);
        if found != expected {
            return Err(Violation::Owner { face, found, expected });
        }
    }
    match (0..edges.len()).find(|&edge| !used.contains(&(edge as u32))) {
        Some(edge) => Err(Violation::Stray { edge }),
        None => Ok(()),
    }
}

/// Owner bits by definition: who takes features is found for one face at a time, by their names.
fn owners_of(faces: &[[u32; 3]]) -> Vec<u32> {
    // Features of a face that it may own, each with its bit: a vertex twice, or an edge by its ends.
    let vertices = |face: &[u32; 3]| [0, 1, 2].map(|k| ([face[k]; 2], 1 << k));
    let edges = |face: &[u32; 3]| {
        [0, 1, 2].map(|k| {
            let (a, b) = (face[k], face[(k + 1) % 3]);
            ([a.min(b), a.max(b)], 8 << k)
        })
    };
    let mut owners = vec![0; faces.len()];
    let mut taken = HashSet::new();
    for (is_edge, only_owners) in [(true, false), (false, true), (false, false)] {
        for number in [3, 2, 1] {
            for (face, owner) in faces.iter().zip(&mut owners) {
                let mut free: Vec<([u32; 2], u32)> = Vec::new();
                for (name, bit) in if is_edge { edges(face) } else { vertices(face) } {
                    let is_edge_of_a_point = is_edge && name[0] == name[1];
                    let is_new = !free.iter().any(|other| other.0 == name);
                    if !is_edge_of_a_point && is_new && !taken.contains(&(is_edge, name)) {
                        free.push((name, bit));
                    }
                }
                if free.len() == number && (*owner != 0 || !only_owners) {
                    for (name, bit) in free {
                        taken.insert((is_edge, name));
                        *owner |= bit;
                    }
                }
            }
        }
    }
    owners
}
