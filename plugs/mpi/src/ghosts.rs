//! Triangles that a rank sends to another, which tests them against its own.
//!
//! One rank of two tests all pairs of triangles between both: the tester. The other sends it the
//! chunks that meet one of the tester's. So a pair is tested once, and nothing crosses twice.

use crate::bytes::{Reader, Writer};
use crate::chunks::Chunk;
use crate::numbers::{self, Features};
use crate::piece::Piece;
use crate::place::Place;
use nearmiss::scene::BodyKind;

/// Whether rank `own` tests the pairs between it and `other`. Each rank tests those of about half
/// of the others.
pub(crate) fn tests(own: usize, other: usize) -> bool {
    (own < other) == (own + other).is_multiple_of(2)
}

/// Triangles of one body that another rank owns.
#[derive(Debug)]
pub(crate) struct Ghosts {
    pub body: usize,
    /// Numbers of the triangles in the whole body.
    pub faces: Vec<u32>,
    /// Their corners, as places in `vertices`.
    pub corners: Vec<[u32; 3]>,
    /// Numbers of the vertices in the whole body, ascending.
    pub vertices: Vec<u32>,
    /// Numbers of each triangle's edges.
    pub edges: Vec<[u32; 3]>,
    /// Features that each triangle owns: see [`Features::owned`].
    pub owned: Vec<u8>,
    pub place: Place,
}

/// Message to another rank: chunks, and what of them was sent.
#[derive(Default)]
pub(crate) struct Outbox {
    /// Chunks of the last message.
    chunks: Vec<u32>,
    /// Body and local vertices of each part of it.
    parts: Vec<(usize, Vec<u32>)>,
}

impl Outbox {
    /// Returns the message with these chunks, ascending. If they are those of the last message, it
    /// has places alone.
    pub fn message(
        &mut self,
        chunks: Vec<u32>,
        all: &[Chunk],
        (pieces, features): (&[Piece], &[Features]),
    ) -> Vec<u8> {
        if chunks.is_empty() && self.chunks.is_empty() {
            return Vec::new();
        }
        let mut message = Writer::default();
        let is_new = chunks != self.chunks;
        message.put(&[u8::from(is_new)]);
        if is_new {
            self.parts.clear();
            for run in chunks.chunk_by(|&a, &b| all[a as usize].body == all[b as usize].body) {
                let body = all[run[0] as usize].body;
                let mut faces: Vec<u32> =
                    run.iter().flat_map(|&chunk| all[chunk as usize].faces.iter().copied()).collect();
                faces.sort_unstable();
                let vertices = write(body, &faces, (&pieces[body], &features[body]), &mut message);
                self.parts.push((body, vertices));
            }
            self.chunks = chunks;
            message.put::<[u32; 2]>(&[]);
        }
        for (body, vertices) in &self.parts {
            let body = &pieces[*body].body;
            Place::of(body, vertices).write(body.kind(), is_new, &mut message);
        }
        message.0
    }
}

/// Writes triangles of a piece; returns their vertices.
fn write(
    body: usize,
    faces: &[u32],
    (piece, features): (&Piece, &Features),
    message: &mut Writer,
) -> Vec<u32> {
    let corners = || faces.iter().map(|&face| piece.body.faces()[face as usize]);
    let vertices = numbers::ascending(corners().flatten());
    let place = |v: u32| numbers::place(&vertices, v);
    message.put(&[[body as u32, faces.len() as u32]]);
    message.put(&faces.iter().map(|&face| piece.faces[face as usize]).collect::<Vec<u32>>());
    message.put(&corners().map(|corners| corners.map(place)).collect::<Vec<_>>());
    message.put(&vertices.iter().map(|&v| piece.vertices[v as usize]).collect::<Vec<u32>>());
    message.put(&faces.iter().map(|&face| features.edges[face as usize]).collect::<Vec<_>>());
    message.put(&faces.iter().map(|&face| features.owned[face as usize]).collect::<Vec<u8>>());
    vertices
}

/// Reads a message of another rank into the triangles known of it. Returns whether their set
/// changed.
pub(crate) fn receive(message: &[u8], known: &mut Vec<Ghosts>) -> bool {
    let mut reader = Reader(message);
    let is_new = reader.take::<u8>().first().is_some_and(|&flag| flag == 1);
    if is_new {
        known.clear();
        while let Some(&[body, _]) = reader.take::<[u32; 2]>().first() {
            known.push(Ghosts {
                body: body as usize,
                faces: reader.take(),
                corners: reader.take(),
                vertices: reader.take(),
                edges: reader.take(),
                owned: reader.take(),
                place: Place { ends: Vec::new(), step: None },
            });
        }
    }
    known.iter_mut().for_each(|ghosts| ghosts.place.read(&mut reader));
    is_new
}

/// Whether bodies may meet: see [`nearmiss::scene::CollisionFilter`].
pub(crate) fn may_meet(pieces: &[Piece], left_out: &[[usize; 2]], a: usize, b: usize) -> bool {
    let [x, y] = [a, b].map(|body| &pieces[body].body);
    if a == b {
        return x.self_collides();
    }
    (x.kind() != BodyKind::Fixed || y.kind() != BodyKind::Fixed)
        && x.filter().allows(y.filter())
        && left_out.binary_search(&[a.min(b), a.max(b)]).is_err()
}

#[cfg(test)]
mod tests {
    use super::tests as tests_pairs;

    #[test]
    fn one_of_two_ranks_tests_and_each_tests_about_half() {
        for count in 1..20usize {
            for own in 0..count {
                let others = || (0..count).filter(|&other| other != own);
                for other in others() {
                    assert_ne!(tests_pairs(own, other), tests_pairs(other, own));
                }
                let tested = others().filter(|&other| tests_pairs(own, other)).count();
                assert!(tested.abs_diff((count - 1) / 2) <= 1, "{own} of {count}: {tested}");
            }
        }
    }
}
