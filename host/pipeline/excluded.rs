//! Tables of the pairs of features that a scene excludes, as kernels read them.

use super::layout::Offsets;
use crate::error::Error;
use crate::memory;
use crate::scene::{Body, Scene};
use nearmiss_emulator::Looks;
use nearmiss_kernels::abi::{PartnerBits, RestPoint, RestReach, partner_key};
use nearmiss_kernels::math::Vec3;
use rayon::prelude::*;
use std::ops::Range;

/// Vertices between two polls of an interrupt.
const PIECE: u32 = 1 << 12;
/// Most words of the table of partners: 32 bits number them.
const MOST: u64 = u32::MAX as u64;

/// The tables. A table that excludes nothing is empty.
#[derive(Clone, Default)]
pub struct Excluded {
    /// Pairs of vertices: see `ExclusionTables::partners`.
    pub partners: Vec<u32>,
    /// The bits of the partners of each vertex.
    pub bits: Vec<PartnerBits>,
    /// All vertices in rest shapes.
    pub rest: Vec<RestPoint>,
    /// The reach of each vertex there.
    pub reaches: Vec<RestReach>,
    /// A bit for each triangle: whether it takes no part.
    pub faces: Vec<u32>,
}

impl Excluded {
    /// Returns the tables of a scene whose bodies start there. Cost: a search by edges from each
    /// vertex of a body with a ring; linear in the others.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`], also if 32 bits cannot number the partners; [`Error::Interrupted`].
    pub fn new(scene: &Scene, starts: &[Offsets], looks: &Looks) -> Result<Excluded, Error> {
        if scene.excluded.is_empty() {
            return Ok(Excluded::default());
        }
        let (partners, bits) = partners(scene, starts, looks)?;
        let (rest, reaches) = rest(scene, starts)?;
        Ok(Excluded { partners, bits, rest, reaches, faces: faces(scene, starts) })
    }

    /// Returns whether a triangle takes no part.
    pub fn has_face(&self, face: usize) -> bool {
        self.faces.get(face / 32).is_some_and(|word| word >> (face % 32) & 1 != 0)
    }

    /// Returns whether it excludes nothing.
    pub fn is_empty(&self) -> bool {
        self.partners.is_empty() && self.rest.is_empty() && self.faces.is_empty()
    }
}

fn faces(scene: &Scene, starts: &[Offsets]) -> Vec<u32> {
    let mut bits = Vec::new();
    for (id, own) in &scene.excluded.bodies {
        if !own.faces.is_empty() {
            let all = starts.last().map_or(0, |end| end.triangle as usize);
            bits.resize(all.div_ceil(32), 0);
        }
        for &face in &own.faces {
            let at = starts[id.index()].triangle + face;
            bits[at as usize / 32] |= 1 << (at % 32);
        }
    }
    bits
}

fn rest(scene: &Scene, starts: &[Offsets]) -> Result<(Vec<RestPoint>, Vec<RestReach>), Error> {
    let excluded = scene.excluded.bodies.iter();
    let shapes = excluded.filter_map(|(id, own)| own.rest.as_ref().map(|rest| (id, rest)));
    let mut shapes = shapes.filter(|(_, rest)| rest.within > 0.0).peekable();
    if shapes.peek().is_none() {
        return Ok(Default::default());
    }
    let vertices = starts.last().map_or(0, |end| end.vertex as usize);
    let each = size_of::<RestPoint>() + size_of::<RestReach>();
    memory::require("shapes at rest", (vertices * each) as u64)?;
    let mut all = vec![RestPoint { at: Vec3([0.0; 3]), within: 0.0 }; vertices];
    let mut reaches = vec![RestReach::NONE; vertices];
    for (id, shape) in shapes {
        let (first, positions) = (starts[id.index()].vertex as usize, shape.positions.to_f64());
        for (point, &at) in all[first..].iter_mut().zip(&positions) {
            *point = RestPoint { at: Vec3(at), within: shape.within };
        }
        let own = reaches_of(&positions, scene.bodies()[id.index()].elements(), shape.within);
        reaches[first..][..own.len()].copy_from_slice(&own);
    }
    Ok((all, reaches))
}

/// Returns the reach of each vertex of a rest shape: all features of a vertex are of its triangles.
fn reaches_of(positions: &[[f64; 3]], elements: &[[u32; 3]], within: f64) -> Vec<RestReach> {
    let around: Vec<RestReach> = positions.iter().map(|&at| RestReach::around(at)).collect();
    let mut extents: Vec<f64> = around.iter().zip(positions).map(|(own, &at)| own.extent(at)).collect();
    for element in elements.iter().map(|element| element.map(|vertex| vertex as usize)) {
        for vertex in element {
            let reached = element.map(|other| around[vertex].extent(positions[other]));
            extents[vertex] = reached.into_iter().fold(extents[vertex], f64::max);
        }
    }
    around.into_iter().zip(extents).map(|(own, extent)| own.reaching(extent, within)).collect()
}

fn partners(scene: &Scene, starts: &[Offsets], looks: &Looks) -> Result<(Vec<u32>, Vec<PartnerBits>), Error> {
    let rings = |id| scene.excluded.bodies.get(&id).and_then(|own| own.ring);
    if scene.excluded.pairs.is_empty() && !scene.ids().any(|id| rings(id).is_some()) {
        return Ok(Default::default());
    }
    let mut table = Table::new(starts.last().map_or(0, |end| end.vertex as u64), listed(scene, starts))?;
    for (body, range) in starts.windows(2).enumerate() {
        let vertices = range[0].vertex..range[1].vertex;
        let ring = scene.id(body).and_then(rings);
        let edges = ring.map(|ring| (Edges::of(&scene.bodies()[body]), ring - 1));
        for piece in pieces(vertices.clone()) {
            if looks.ends() {
                return Err(Error::Interrupted);
            }
            let around: Vec<Vec<u32>> = match &edges {
                None => vec![Vec::new(); piece.len()],
                Some((edges, depth)) => {
                    let search = || Search { reached: vec![NEVER; edges.vertices()], found: Vec::new() };
                    let own = piece.clone().into_par_iter().map(|vertex| vertex - vertices.start);
                    own.map_init(search, |search, vertex| search.around(edges, vertex, *depth)).collect()
                }
            };
            for (vertex, around) in piece.zip(around) {
                table.add(vertex, around.into_iter().map(|other| other + vertices.start))?;
            }
        }
    }
    Ok((table.words, table.bits))
}

/// All listed pairs of vertices in the numbers of the layout, each in both orders, ascending.
fn listed(scene: &Scene, starts: &[Offsets]) -> Vec<[u32; 2]> {
    let mut all = Vec::new();
    for ([a, b], pairs) in &scene.excluded.pairs {
        let [a, b] = [a, b].map(|id| starts[id.index()].vertex);
        all.extend(pairs.iter().flat_map(|&[p, q]| [[a + p, b + q], [b + q, a + p]]));
    }
    all.sort_unstable();
    all
}

fn pieces(range: Range<u32>) -> impl Iterator<Item = Range<u32>> {
    let end = range.end;
    range.step_by(PIECE as usize).map(move |first| first..end.min(first.saturating_add(PIECE)))
}

/// The table of partners, as far as it is made.
struct Table {
    words: Vec<u32>,
    /// The bits of each vertex.
    bits: Vec<PartnerBits>,
    /// Words for which there is memory.
    room: u64,
    /// Listed pairs of vertices that come later, and the place of the first.
    listed: Vec<[u32; 2]>,
    next: usize,
}

impl Table {
    fn new(vertices: u64, listed: Vec<[u32; 2]>) -> Result<Table, Error> {
        let mut table = Table { words: Vec::new(), bits: Vec::new(), room: 0, listed, next: 0 };
        table.reserve(vertices + 1)?;
        let bits = size_of::<PartnerBits>() as u64 * vertices;
        memory::require("pairs of vertices that are excluded", bits)?;
        table.bits.reserve_exact(vertices as usize);
        // The first range begins behind those of all vertices; each ends where the next begins.
        table.words.resize(vertices as usize + 1, vertices as u32 + 1);
        Ok(table)
    }

    fn reserve(&mut self, words: u64) -> Result<(), Error> {
        if words > MOST {
            let what = "pairs of vertices that are excluded".into();
            return Err(Error::OutOfMemory { what, asked: 4 * words, given: 4 * MOST });
        }
        if words > self.room {
            self.room = words.next_power_of_two();
            memory::require("pairs of vertices that are excluded", 4 * self.room)?;
        }
        Ok(())
    }

    /// Adds the keys of the partners of the next vertex, and its bits: partners around it, and those
    /// of the list.
    fn add(&mut self, vertex: u32, around: impl Iterator<Item = u32>) -> Result<(), Error> {
        let first = self.words.len();
        self.words.extend(around.map(partner_key));
        while let Some(&[_, other]) = self.listed.get(self.next).filter(|[own, _]| *own == vertex) {
            self.words.push(partner_key(other));
            self.next += 1;
        }
        self.reserve(self.words.len() as u64)?;
        let keys = &mut self.words[first..];
        keys.sort_unstable();
        self.bits.push(keys.iter().fold(PartnerBits::default(), |bits, &key| bits.with(key)));
        self.words[vertex as usize + 1] = self.words.len() as u32;
        Ok(())
    }
}

/// Vertices at the other ends of the edges of each vertex.
struct Edges {
    starts: Vec<u32>,
    ends: Vec<u32>,
}

impl Edges {
    fn of(body: &Body) -> Edges {
        let mut starts = vec![0u32; body.vertex_count() + 1];
        let pairs = || {
            let faces = body.elements().iter();
            faces.flat_map(|&[x, y, z]| [[x, y], [y, x], [y, z], [z, y], [z, x], [x, z]])
        };
        pairs().for_each(|[from, _]| starts[from as usize] += 1);
        let mut sum = 0;
        for start in &mut starts {
            sum += *start;
            // The end of the range, from which the filling counts down to its start.
            *start = sum;
        }
        let mut ends = vec![0; sum as usize];
        for [from, to] in pairs() {
            starts[from as usize] -= 1;
            ends[starts[from as usize] as usize] = to;
        }
        Edges { starts, ends }
    }

    fn vertices(&self) -> usize {
        self.starts.len() - 1
    }

    fn of_vertex(&self, vertex: u32) -> &[u32] {
        &self.ends[self.starts[vertex as usize] as usize..self.starts[vertex as usize + 1] as usize]
    }
}

/// Mark of a vertex that no search has reached.
const NEVER: u32 = u32::MAX;

/// A search by edges.
struct Search {
    /// The vertex whose search last reached each vertex.
    reached: Vec<u32>,
    found: Vec<u32>,
}

impl Search {
    /// Returns the vertices with at most `depth` edges between, itself among them.
    fn around(&mut self, edges: &Edges, vertex: u32, depth: u32) -> Vec<u32> {
        self.found.clear();
        self.found.push(vertex);
        self.reached[vertex as usize] = vertex;
        let mut begin = 0;
        for _ in 0..depth {
            let end = self.found.len();
            if begin == end {
                break;
            }
            for at in begin..end {
                for &other in edges.of_vertex(self.found[at]) {
                    if std::mem::replace(&mut self.reached[other as usize], vertex) != vertex {
                        self.found.push(other);
                    }
                }
            }
            begin = end;
        }
        self.found.clone()
    }
}

#[cfg(test)]
mod tests;
