//! Welding of vertices at one place, for meshes that have the vertices of a seam twice.

use super::difference::difference;
use super::{Loose, Mesh, Positions};
use crate::Error;
use crate::scene::Thickness;
use std::cmp::Ordering;

/// The representative of each vertex.
pub(crate) struct Vertices {
    /// For each vertex, the first used vertex at its place; itself if no face uses it.
    names: Vec<u32>,
    /// Number of used vertices with another representative.
    pub merged: usize,
}

impl Vertices {
    /// Vertices are merged if they are at one place in every frame; -0.0 and 0.0 are the same. Only
    /// used vertices are, which are finite. Cost: a sort of the vertices, 8 bytes each.
    pub fn of(frames: &[&Positions], used_by: impl Iterator<Item = u32>) -> Vertices {
        let count = frames.first().map_or(0, |frame| frame.len());
        let mut names: Vec<u32> = (0..count as u32).collect();
        let mut used = vec![false; count];
        used_by.for_each(|vertex| used[vertex as usize] = true);
        let mut order: Vec<u32> = names.iter().copied().filter(|&vertex| used[vertex as usize]).collect();
        let places = |a: u32, b: u32| {
            let each = frames.iter().map(|frame| place(frame, a as usize, b as usize));
            each.fold(Ordering::Equal, Ordering::then)
        };
        order.sort_unstable_by(|&a, &b| places(a, b).then(a.cmp(&b)));
        let mut merged = 0;
        for group in order.chunk_by(|&a, &b| places(a, b).is_eq()) {
            group.iter().for_each(|&vertex| names[vertex as usize] = group[0]);
            merged += group.len() - 1;
        }
        Vertices { names, merged }
    }

    /// Radii of the representatives: each has the largest of those that it represents.
    pub fn radii(&self, of: &Thickness) -> Thickness {
        let Thickness::Each(radii) = of else { return of.clone() };
        let mut largest = radii.clone();
        for (&radius, &name) in radii.iter().zip(&self.names) {
            if let Some(own) = largest.get_mut(name as usize) {
                *own = own.max(radius);
            }
        }
        Thickness::Each(largest)
    }
}

/// The order of two vertices' places. NaN does not occur here.
fn place(frame: &Positions, a: usize, b: usize) -> Ordering {
    match frame {
        Positions::F32(points) => points[a].partial_cmp(&points[b]),
        Positions::F64(points) => points[a].partial_cmp(&points[b]),
    }
    .unwrap_or(Ordering::Equal)
}

/// Renames the vertices of faces, edges and points.
pub(crate) fn rename(vertices: &Vertices, faces: &mut [[u32; 3]], loose: &mut Loose) {
    let name = |vertex: u32| vertices.names[vertex as usize];
    faces.iter_mut().flatten().for_each(|vertex| *vertex = name(*vertex));
    loose.rename(name);
}

impl Mesh {
    /// The mesh with vertices at one place merged (equal coordinates; -0.0 and 0.0 are the same),
    /// and the number merged. The first that a face uses represents them. Faces that meet in a seam
    /// share vertices and edges afterwards.
    ///
    /// Vertices and triangles keep their indices. Faces, edges and points name the representatives, and no face uses
    /// the merged vertices. A triangle that loses a corner stays, as a segment or a point. Cost: a
    /// sort.
    ///
    /// For frames of one mesh use [`Mesh::weld_frames`] or [`Body::weld`](super::Body::weld).
    pub fn weld(&self) -> (Mesh, usize) {
        let vertices = Vertices::of(&[&self.positions], self.used());
        let mut welded = self.clone();
        rename(&vertices, &mut welded.faces, &mut welded.loose);
        (welded, vertices.merged)
    }

    /// Frames of one mesh with vertices merged that coincide in every frame, and the number merged
    /// in each; see [`Mesh::weld`]. All get the triangles of the first.
    ///
    /// # Errors
    /// Errors of [`Body::moving`](super::Body::moving), for the first frame that differs from the
    /// first of all.
    pub fn weld_frames(frames: &[Mesh]) -> Result<(Vec<Mesh>, usize), Error> {
        let Some(first) = frames.first() else { return Ok((Vec::new(), 0)) };
        for frame in frames {
            if let Some(problem) = difference(first, frame) {
                return Err(Error::Input { file: frame.name.clone(), problem });
            }
        }
        let positions: Vec<&Positions> = frames.iter().map(Mesh::positions).collect();
        let vertices = Vertices::of(&positions, first.used());
        let (mut faces, mut loose) = (first.faces.clone(), first.loose.clone());
        rename(&vertices, &mut faces, &mut loose);
        let welded = frames.iter().map(|frame| Mesh {
            name: frame.name.clone(),
            positions: frame.positions.clone(),
            faces: faces.clone(),
            loose: loose.clone(),
        });
        Ok((welded.collect(), vertices.merged))
    }

    /// Number of used vertices at the place of an earlier one: those that [`Mesh::weld`] would
    /// merge. It is 0 for a mesh without seams. Cost: a sort of the vertices, 8 bytes each.
    pub fn coincident(&self) -> usize {
        Vertices::of(&[&self.positions], self.used()).merged
    }

    /// Vertices of faces, edges and points, some of them several times.
    fn used(&self) -> impl Iterator<Item = u32> + '_ {
        self.faces.iter().flatten().copied().chain(self.loose.vertices())
    }
}
