//! Numbers of edges in whole bodies, and owners of vertices and edges: exchanged once.
//!
//! Every vertex has a home, the rank that counts the edges whose larger end it is. Homes follow each
//! other as vertices do. So edges are numbered by (larger vertex, smaller vertex), as on one machine.
//! The owner of a vertex or an edge is the triangle of the smallest number that has it.

use crate::bytes::{Reader, Writer};
use crate::error::{RankError, refused};
use crate::piece::Piece;
use crate::ranks::{Purpose, Ranks};
use nearmiss::Error;
use nearmiss::mesh::{NO_EDGE, Topology};

/// Features of the triangles of a piece.
pub(crate) struct Features {
    /// Numbers of each triangle's edges in the whole body.
    pub edges: Vec<[u32; 3]>,
    /// Bit `k` if the triangle owns the vertex of its corner `k`; bit `3 + k` for its edge `k`.
    pub owned: Vec<u8>,
}

/// Requests of a rank to a home.
#[derive(Clone, Default)]
struct Requests {
    /// Body and triangle.
    faces: Vec<[u32; 2]>,
    /// Body, vertex and its first triangle.
    vertices: Vec<[u32; 3]>,
    /// Body, larger and smaller end, and the first triangle.
    edges: Vec<[u32; 4]>,
}

impl Requests {
    fn message(&self) -> Vec<u8> {
        let mut message = Writer::default();
        message.put(&self.faces);
        message.put(&self.vertices);
        message.put(&self.edges);
        message.0
    }

    fn read(message: &[u8]) -> Requests {
        let mut reader = Reader(message);
        Requests { faces: reader.take(), vertices: reader.take(), edges: reader.take() }
    }
}

/// Returns the numbers in ascending order, each once.
pub(crate) fn ascending(numbers: impl Iterator<Item = u32>) -> Vec<u32> {
    let mut all: Vec<u32> = numbers.collect();
    all.sort_unstable();
    all.dedup();
    all
}

/// Returns the place of a number among ascending ones.
pub(crate) fn place(ascending: &[u32], number: u32) -> u32 {
    ascending.partition_point(|&own| own < number) as u32
}

/// First and last triangle of this rank for each local vertex or edge.
fn firsts(lists: &[[u32; 3]], count: usize) -> Vec<u32> {
    let mut first = vec![u32::MAX; count];
    for (face, list) in lists.iter().enumerate().rev() {
        for &at in list.iter().filter(|&&at| at != NO_EDGE) {
            first[at as usize] = face as u32;
        }
    }
    first
}

/// Returns the features of every piece.
///
/// # Errors
/// If a triangle is owned by no rank, or by two.
pub(crate) fn features(ranks: &Ranks, pieces: &[Piece]) -> Result<Vec<Features>, RankError> {
    let count = ranks.count();
    let home = |number: u32, end: u32| (u64::from(number) * count as u64 / u64::from(end.max(1))) as usize;
    let topologies: Vec<Topology> =
        pieces.iter().map(|piece| Topology::new(piece.body.faces(), piece.vertices.len())).collect();
    let mut requests = vec![Requests::default(); count];
    // The home of each vertex and edge, in the order of the requests.
    let mut homes = [Vec::new(), Vec::new()];
    for (body, (piece, topology)) in pieces.iter().zip(&topologies).enumerate() {
        let [vertices, faces] = piece.whole;
        let body = body as u32;
        for &face in &piece.faces {
            requests[home(face, faces)].faces.push([body, face]);
        }
        let first = firsts(piece.body.faces(), piece.vertices.len());
        for (&vertex, &first) in piece.vertices.iter().zip(&first).filter(|(_, first)| **first != u32::MAX) {
            let at = home(vertex, vertices);
            requests[at].vertices.push([body, vertex, piece.faces[first as usize]]);
            homes[0].push(at);
        }
        let first = firsts(&topology.face_edges, topology.edges.len());
        for (&edge, &first) in topology.edges.iter().zip(&first) {
            let [larger, smaller] = edge.map(|v| piece.vertices[v as usize]);
            let at = home(larger, vertices);
            requests[at].edges.push([body, larger, smaller, piece.faces[first as usize]]);
            homes[1].push(at);
        }
    }
    let messages: Vec<Vec<u8>> = requests.iter().map(Requests::message).collect();
    let requests_of: Vec<Requests> =
        ranks.exchange(&messages, Purpose::Setup)?.iter().map(|message| Requests::read(message)).collect();
    ranks.run(|| each_once(ranks, pieces, &requests_of))?;
    let replies = replies(ranks, pieces.len(), &requests_of);
    let replies = ranks.exchange(&replies, Purpose::Setup)?;
    let mut replies: Vec<_> = replies
        .iter()
        .map(|message| {
            let mut reader = Reader(message);
            (reader.take::<u32>().into_iter(), reader.take::<[u32; 2]>().into_iter())
        })
        .collect();
    let [mut of_vertices, mut of_edges] = homes.map(Vec::into_iter);
    let each = |(piece, topology): (&Piece, &Topology)| {
        let used = firsts(piece.body.faces(), piece.vertices.len());
        let vertices: Vec<u32> = used
            .iter()
            .map(|&first| match first {
                u32::MAX => None,
                _ => of_vertices.next().and_then(|home| replies[home].0.next()),
            })
            .map(|owner| owner.unwrap_or(u32::MAX))
            .collect();
        let edges: Vec<[u32; 2]> = topology
            .edges
            .iter()
            .map(|_| of_edges.next().and_then(|home| replies[home].1.next()).unwrap_or([NO_EDGE; 2]))
            .collect();
        owned(piece, topology, &vertices, &edges)
    };
    Ok(pieces.iter().zip(&topologies).map(each).collect())
}

fn owned(piece: &Piece, topology: &Topology, vertices: &[u32], edges: &[[u32; 2]]) -> Features {
    let mut features = Features { edges: Vec::new(), owned: Vec::new() };
    for ((corners, own), &face) in piece.body.faces().iter().zip(&topology.face_edges).zip(&piece.faces) {
        let mut bits = 0u8;
        for k in 0..3 {
            let is_first = |list: &[u32; 3]| !list[..k].contains(&list[k]);
            bits |= u8::from(is_first(corners) && vertices[corners[k] as usize] == face) << k;
            let is_owner = own[k] != NO_EDGE && is_first(own) && edges[own[k] as usize][1] == face;
            bits |= u8::from(is_owner) << (3 + k);
        }
        features.owned.push(bits);
        features.edges.push(own.map(|edge| if edge == NO_EDGE { NO_EDGE } else { edges[edge as usize][0] }));
    }
    features
}

/// Checks that every triangle whose home is here is owned by one rank.
fn each_once(ranks: &Ranks, pieces: &[Piece], requests_of: &[Requests]) -> Result<(), Error> {
    let mut all: Vec<([u32; 2], usize)> = Vec::new();
    for (rank, requests) in requests_of.iter().enumerate() {
        all.extend(requests.faces.iter().map(|&face| (face, rank)));
    }
    all.sort_unstable();
    let name = |body: u32| pieces[body as usize].body.name();
    if let Some(pair) = all.windows(2).find(|pair| pair[0].0 == pair[1].0) {
        let ([body, face], [a, b]) = (pair[0].0, [pair[0].1, pair[1].1]);
        let what = format!("triangle {face} of {} is owned by ranks {a} and {b}", name(body));
        return Err(refused(what, "give each triangle to one rank"));
    }
    let (rank, count) = (ranks.rank() as u64, ranks.count() as u64);
    let mut all = all.into_iter().map(|(face, _)| face).peekable();
    for (body, piece) in (0..).zip(pieces) {
        let end = u64::from(piece.whole[1]);
        let first = |rank: u64| (rank * end).div_ceil(count) as u32;
        for face in first(rank)..first(rank + 1) {
            if all.next_if_eq(&[body, face]).is_none() {
                let what = format!("triangle {face} of {} is owned by no rank", name(body));
                return Err(refused(what, "give each triangle to one rank"));
            }
        }
    }
    Ok(())
}

/// Returns for each rank the owners of its vertices, and the numbers and owners of its edges.
fn replies(ranks: &Ranks, bodies: usize, requests_of: &[Requests]) -> Vec<Vec<u8>> {
    let mut vertices: Vec<([u32; 3], [u32; 2])> = Vec::new();
    let mut edges: Vec<([u32; 4], [u32; 2])> = Vec::new();
    for (rank, requests) in (0..).zip(requests_of) {
        vertices.extend((0..).zip(&requests.vertices).map(|(at, &request)| (request, [rank, at])));
        edges.extend((0..).zip(&requests.edges).map(|(at, &request)| (request, [rank, at])));
    }
    vertices.sort_unstable();
    edges.sort_unstable();
    let mut owners: Vec<Vec<u32>> =
        requests_of.iter().map(|requests| vec![0; requests.vertices.len()]).collect();
    let mut numbers: Vec<Vec<[u32; 2]>> =
        requests_of.iter().map(|requests| vec![[0; 2]; requests.edges.len()]).collect();
    for run in vertices.chunk_by(|(a, _), (b, _)| a[..2] == b[..2]) {
        run.iter().for_each(|(_, [rank, at])| owners[*rank as usize][*at as usize] = run[0].0[2]);
    }
    let mut counts = vec![0u32; bodies];
    for run in edges.chunk_by(|(a, _), (b, _)| a[..3] == b[..3]) {
        let [body, .., owner] = run[0].0;
        let number = counts[body as usize];
        counts[body as usize] += 1;
        run.iter().for_each(|(_, [rank, at])| numbers[*rank as usize][*at as usize] = [number, owner]);
    }
    // Edges of homes before this one come before its own.
    let all = ranks.gathered(&counts, Purpose::Setup);
    let mut before = vec![0u32; bodies];
    for counts in all.chunks(bodies.max(1)).take(ranks.rank()) {
        before.iter_mut().zip(counts).for_each(|(sum, count)| *sum += count);
    }
    let of_rank = |((requests, owners), mut numbers): ((&Requests, Vec<u32>), Vec<[u32; 2]>)| {
        numbers
            .iter_mut()
            .zip(&requests.edges)
            .for_each(|(own, [body, ..])| own[0] += before[*body as usize]);
        let mut message = Writer::default();
        message.put(&owners);
        message.put(&numbers);
        message.0
    };
    requests_of.iter().zip(owners).zip(numbers).map(of_rank).collect()
}
