//! Hubs: vertices with so many faces that pairs of these would be most of the work. See
//! `nearmiss_kernels::bvh::filter`.

use nearmiss_kernels::bvh::tiles::TILE;

/// Least number of faces of a hub: those of a tile. Fewer faces fill no tile, and no subtree worth
/// a cut.
pub const FACES: u32 = TILE;

/// Returns each face's hub, as its vertex plus one; 0 without a hub. Among several hubs the one
/// with most faces wins, then the first. So faces round a hub name it, even if a few of them touch
/// another. The list is empty if there is no hub. Cost: linear.
pub fn of(faces: &[[u32; 3]], vertices: usize) -> Vec<u32> {
    let mut valences = vec![0u32; vertices];
    for &v in faces.iter().flatten() {
        valences[v as usize] += 1;
    }
    if valences.iter().all(|&valence| valence < FACES) {
        return Vec::new();
    }
    let hub = |face: &[u32; 3]| {
        let valence = |v: u32| valences[v as usize];
        let hubs = face.iter().filter(|&&v| valence(v) >= FACES);
        hubs.max_by_key(|&&v| (valence(v), std::cmp::Reverse(v))).map_or(0, |&v| v + 1)
    };
    faces.iter().map(hub).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns faces round `hub`, with a rim of vertices from `first` on.
    fn fan(hub: u32, first: u32, faces: u32) -> impl Iterator<Item = [u32; 3]> {
        (0..faces).map(move |k| [first + k, hub, first + (k + 1) % faces])
    }

    #[test]
    fn a_hub_has_as_many_faces_as_a_tile() {
        let few: Vec<_> = fan(0, 1, FACES - 1).collect();
        assert!(of(&few, FACES as usize).is_empty());
        let many: Vec<_> = fan(7, 8, FACES).chain([[8, 9, 5]]).collect();
        let hubs = of(&many, 8 + FACES as usize);
        assert_eq!(hubs[..FACES as usize], [8; FACES as usize], "vertex 7, and one");
        assert_eq!(hubs[FACES as usize..], [0], "a face of the rim");
    }

    #[test]
    fn a_face_names_the_larger_of_two_hubs() {
        // A bicone of 40 faces a side, and a fan of 50 with both apexes: one its hub, one its first
        // rim vertex.
        let rim = 3;
        let faces: Vec<_> = fan(0, rim, 40).chain(fan(1, rim, 40)).chain([[0, 1, 2]]).collect();
        let hubs = of(&faces, 43);
        assert!(hubs[..40].iter().all(|&hub| hub == 1) && hubs[40..80].iter().all(|&hub| hub == 2));
        assert_eq!(hubs[80], 1, "41 faces each: the first");
        let faces: Vec<_> = faces.into_iter().chain([[1, 2, 3]]).collect();
        assert_eq!(of(&faces, 43)[80], 2, "42 faces against 41");
    }
}
