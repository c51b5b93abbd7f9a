//! The meshes with their faults in colour.

use super::findings::{Findings, TOUCHING};
use super::pairs::Face;
use crate::paint::{self, GREY, ORANGE, Painted, RED};
use nearmiss::contacts::PairKind;
use nearmiss::error::Error;
use std::collections::HashMap;

const VIOLET: [u8; 3] = [150, 60, 200];
const BLUE: [u8; 3] = [40, 90, 220];
const BLACK: [u8; 3] = [20, 20, 20];
const YELLOW: [u8; 3] = [230, 200, 40];

/// All meshes as one; a face has the colour of its first fault.
///
/// # Errors
/// [`Error::Input`] for more vertices or triangles than a mesh may have.
pub fn painted(found: &Findings) -> Result<Painted, Error> {
    let mut colours: HashMap<Face, [u8; 3]> = HashMap::new();
    let mut paint = |face: Face, colour| {
        colours.entry(face).or_insert(colour);
    };
    let mut pairs = |kinds: &[PairKind], colour| {
        found.of(kinds).flat_map(|pair| pair.faces).for_each(|face| paint(face, colour));
    };
    pairs(&[PairKind::Crossing], RED);
    pairs(&[PairKind::Overlap], VIOLET);
    let all = || found.faults.iter().enumerate();
    let face = |mesh: usize, triangle: u32| Face { mesh, face: found.faces[mesh][triangle as usize] };
    for (mesh, own) in all() {
        own.duplicate.iter().flatten().for_each(|&at| paint(face(mesh, at), BLUE));
    }
    for (mesh, own) in all() {
        own.degenerate.iter().for_each(|&at| paint(face(mesh, at), BLACK));
    }
    found.of(&TOUCHING).flat_map(|pair| pair.faces).for_each(|face| paint(face, ORANGE));
    for (mesh, own) in all() {
        own.at_non_manifold.iter().for_each(|&at| paint(face(mesh, at), YELLOW));
    }
    let faces = found.faces.iter().enumerate();
    let faces = faces.flat_map(|(mesh, all)| all.iter().map(move |&face| Face { mesh, face }));
    let colours: Vec<[u8; 3]> = faces.map(|face| colours.get(&face).copied().unwrap_or(GREY)).collect();
    let counts = vec![0; colours.len()];
    Ok(Painted { mesh: paint::merged(&found.bodies, 0.0)?, colours, counts })
}
