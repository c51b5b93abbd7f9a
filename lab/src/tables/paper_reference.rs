//! The thesis's own figures, milliseconds on its GPU (figures 6.12 and 6.13).

use super::way::Way;
use nearmiss::research::BoundingVolume;

/// The thesis's GPU.
pub const PAPER_GPU: &str = "GTX 285 (2008)";

/// One scene's row of figures 6.12 and 6.13.
pub struct Theirs {
    /// Our name of the scene.
    pub scene: &'static str,
    /// The thesis's name of it.
    pub model: &'static str,
    /// Triangles, as the thesis rounds them.
    pub triangles: usize,
    /// Construction: axis-aligned, oriented boxes.
    construct: [f64; 2],
    /// Refit: the same.
    refit: [f64; 2],
    /// A frame, without and with the front: discrete axis-aligned, discrete oriented, then the same
    /// continuous.
    frame: [[f64; 4]; 2],
}

const ROWS: [Theirs; 4] = [
    Theirs {
        scene: "flamenco",
        model: "Flamenco",
        triangles: 49_000,
        construct: [22.0, 27.0],
        refit: [1.73, 4.6],
        frame: [[35.0, 29.0, 40.0, 38.0], [27.0, 22.0, 37.0, 34.0]],
    },
    Theirs {
        scene: "princess",
        model: "Princess",
        triangles: 40_000,
        construct: [20.0, 24.0],
        refit: [1.4, 3.9],
        frame: [[22.0, 28.0, 27.0, 34.0], [17.0, 22.0, 26.0, 29.0]],
    },
    Theirs {
        scene: "cloth-ball",
        model: "Sphere/Cloth",
        triangles: 92_000,
        construct: [31.0, 39.0],
        refit: [2.5, 7.9],
        frame: [[33.0, 49.0, 47.0, 43.0], [28.0, 36.0, 42.0, 38.0]],
    },
    Theirs {
        scene: "n-body",
        model: "Balls",
        triangles: 146_000,
        construct: [56.0, 68.0],
        refit: [3.2, 11.5],
        frame: [[85.0, 75.0, 99.0, 81.0], [78.0, 70.0, 91.0, 74.0]],
    },
];

/// Returns the thesis's row of a scene, if it has one.
pub fn of(scene: &str) -> Option<&'static Theirs> {
    ROWS.iter().find(|row| row.scene == scene)
}

/// Returns the column of a volume, if the thesis has it.
fn column(volume: BoundingVolume) -> Option<usize> {
    match volume {
        BoundingVolume::Aabb => Some(0),
        BoundingVolume::Obb => Some(1),
        _ => None,
    }
}

impl Theirs {
    /// Returns the milliseconds of a construction in a volume.
    pub fn construct(&self, volume: BoundingVolume) -> Option<f64> {
        column(volume).map(|at| self.construct[at])
    }

    /// Returns the milliseconds of a refit.
    pub fn refit(&self, volume: BoundingVolume) -> Option<f64> {
        column(volume).map(|at| self.refit[at])
    }

    /// Returns the milliseconds of a frame.
    pub fn frame(&self, way: Way) -> Option<f64> {
        column(way.volume).map(|at| self.frame[usize::from(way.front)][2 * usize::from(way.moves) + at])
    }
}
