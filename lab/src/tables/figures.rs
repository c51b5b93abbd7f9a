//! The figures as rows: ours compared with theirs.

use super::build::Built;
use super::measure::Cell;
use super::paper_reference;
use nearmiss::research::{BoundingVolume, Solver};
use serde::Serialize;

/// Columns that all rows of a scene share.
#[derive(Clone, Debug)]
pub struct Paper {
    /// Our name of the scene.
    pub scene: String,
    /// The thesis's name of it; empty if the thesis lacks it.
    pub model: &'static str,
    /// Our number of triangles.
    pub triangles: usize,
    /// The thesis's number of triangles.
    pub their_triangles: Option<usize>,
    /// The machine.
    pub device: String,
    /// Size of the work queues, or `fastest`.
    pub profile: &'static str,
}

impl Paper {
    /// Returns the columns of a scene on a machine.
    pub fn new(scene: &str, triangles: usize, device: String, profile: &'static str) -> Paper {
        let theirs = paper_reference::of(scene);
        Paper {
            scene: scene.into(),
            model: theirs.map_or("", |row| row.model),
            triangles,
            their_triangles: theirs.map(|row| row.triangles),
            device,
            profile,
        }
    }

    /// Returns whether both have about as many triangles, within a tenth: only then does a ratio
    /// compare machines and programs.
    pub fn is_like(&self) -> bool {
        self.their_triangles.is_none_or(|theirs| 10 * self.triangles.abs_diff(theirs) <= theirs)
    }
}

/// A row of figure 6.12: construction or refit in one volume. Milliseconds.
#[derive(Clone, Debug, Serialize)]
pub struct Figure612 {
    pub scene: String,
    pub model: &'static str,
    pub triangles: usize,
    pub their_triangles: Option<usize>,
    pub device: String,
    pub profile: &'static str,
    /// `construct` or `refit`.
    pub stage: &'static str,
    pub bv: &'static str,
    /// Number of frames in the mean.
    pub frames: usize,
    pub ours_ms: f64,
    pub theirs_ms: Option<f64>,
    /// Ratio of ours to theirs.
    pub ratio: Option<f64>,
}

/// A row of figure 6.13: a whole frame run in one way. Milliseconds.
#[derive(Clone, Debug, Serialize)]
pub struct Figure613 {
    pub scene: String,
    pub model: &'static str,
    pub triangles: usize,
    pub their_triangles: Option<usize>,
    pub device: String,
    pub profile: &'static str,
    pub motion: &'static str,
    pub bv: &'static str,
    pub front: bool,
    pub solver: Solver,
    /// Number of frames, or steps, in the mean.
    pub frames: usize,
    pub ours_ms: f64,
    pub theirs_ms: Option<f64>,
    /// Ratio of ours to theirs.
    pub ratio: Option<f64>,
    pub contacts_a_frame: f64,
    pub node_tests_a_frame: f64,
    pub triangle_pairs_a_frame: f64,
    /// Hash of all frames' contacts, hexadecimal: the same for all rows of one scene and motion.
    pub hash: String,
    /// Frames whose contacts differ from those of the first row of the motion.
    pub differing: usize,
    /// Frames that reran because a list was too short: their times are too long.
    pub reruns: u64,
    pub bytes: u64,
}

/// A row of figure 6.14: the stages' shares of a frame's time, in percent of the four together.
#[derive(Clone, Debug, Serialize)]
pub struct Figure614 {
    pub scene: String,
    pub model: &'static str,
    pub triangles: usize,
    pub their_triangles: Option<usize>,
    pub device: String,
    pub profile: &'static str,
    pub motion: &'static str,
    pub bv: &'static str,
    pub front: bool,
    /// Fit and refit.
    pub refit: f64,
    pub traverse: f64,
    pub balance: f64,
    pub triangle_tests: f64,
    /// The four together, in milliseconds.
    pub ms: f64,
}

fn ratio(ours: f64, theirs: Option<f64>) -> Option<f64> {
    theirs.map(|theirs| ours / theirs)
}

/// Returns figure 6.12 of one scene. A refit covers all volumes, the leaves' too. A construction
/// builds a tree in boxes. For another volume it is that plus a refit in the other volume, as in
/// the thesis.
pub fn figure_612(paper: &Paper, frames: usize, built: &[Built]) -> Vec<Figure612> {
    let theirs = paper_reference::of(&paper.scene);
    let refit = |b: &Built| b.mean.fit + b.mean.refit;
    let plain = built.iter().find(|b| b.volume == BoundingVolume::Aabb).map(|b| b.mean.construct + refit(b));
    let mut rows = Vec::new();
    let mut row = |stage, volume: BoundingVolume, ours_ms, theirs_ms| {
        rows.push(Figure612 {
            scene: paper.scene.clone(),
            model: paper.model,
            triangles: paper.triangles,
            their_triangles: paper.their_triangles,
            device: paper.device.clone(),
            profile: paper.profile,
            stage,
            bv: volume.name(),
            frames,
            ours_ms,
            theirs_ms,
            ratio: ratio(ours_ms, theirs_ms),
        });
    };
    for b in built {
        let Some(plain) = plain else { continue };
        let whole = if b.volume == BoundingVolume::Aabb { plain } else { plain + refit(b) };
        row("construct", b.volume, whole, theirs.and_then(|t| t.construct(b.volume)));
    }
    for b in built {
        row("refit", b.volume, refit(b), theirs.and_then(|t| t.refit(b.volume)));
    }
    rows
}

/// Returns figure 6.13 of one scene; `differing` comes from [`super::agree`].
pub fn figure_613(paper: &Paper, cells: &[Cell], differing: &[usize]) -> Vec<Figure613> {
    let theirs = paper_reference::of(&paper.scene);
    let row = |(cell, &differing): (&Cell, &usize)| {
        let (ours_ms, theirs_ms) = (cell.mean.total, theirs.and_then(|t| t.frame(cell.way)));
        Figure613 {
            scene: paper.scene.clone(),
            model: paper.model,
            triangles: paper.triangles,
            their_triangles: paper.their_triangles,
            device: paper.device.clone(),
            profile: paper.profile,
            motion: cell.way.asked(),
            bv: cell.way.volume.name(),
            front: cell.way.front,
            solver: cell.solver,
            frames: cell.hashes.len(),
            ours_ms,
            theirs_ms,
            ratio: ratio(ours_ms, theirs_ms),
            contacts_a_frame: cell.a_frame(cell.contacts),
            node_tests_a_frame: cell.a_frame(cell.node_tests),
            triangle_pairs_a_frame: cell.a_frame(cell.triangle_pairs),
            hash: format!("{:016x}", cell.hash()),
            differing,
            reruns: cell.reruns,
            bytes: cell.bytes,
        }
    };
    cells.iter().zip(differing).map(row).collect()
}

/// Returns figure 6.14 of one scene.
pub fn figure_614(paper: &Paper, cells: &[Cell]) -> Vec<Figure614> {
    let row = |cell: &Cell| {
        let m = &cell.mean;
        let ms = m.fit + m.refit + m.traverse + m.balance + m.narrow;
        let share = |part: f64| if ms > 0.0 { 100.0 * part / ms } else { 0.0 };
        Figure614 {
            scene: paper.scene.clone(),
            model: paper.model,
            triangles: paper.triangles,
            their_triangles: paper.their_triangles,
            device: paper.device.clone(),
            profile: paper.profile,
            motion: cell.way.asked(),
            bv: cell.way.volume.name(),
            front: cell.way.front,
            refit: share(m.fit + m.refit),
            traverse: share(m.traverse),
            balance: share(m.balance),
            triangle_tests: share(m.narrow),
            ms,
        }
    };
    cells.iter().map(row).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use nearmiss::Stages;

    fn paper(scene: &str) -> Paper {
        Paper::new(scene, 49_000, "a machine".into(), "fastest")
    }

    #[test]
    fn a_construction_is_a_tree_in_boxes() {
        let mean = Stages { construct: 8.0, fit: 1.0, refit: 2.0, ..Stages::default() };
        let oriented = Stages { construct: 9.0, fit: 3.0, refit: 13.0, ..Stages::default() };
        let built = [
            Built { volume: BoundingVolume::Aabb, mean },
            Built { volume: BoundingVolume::Obb, mean: oriented },
        ];
        let rows = figure_612(&paper("flamenco"), 3, &built);
        let obb = rows.iter().find(|row| row.stage == "construct" && row.bv == "obb").expect("a row");
        assert_eq!((obb.ours_ms, obb.theirs_ms, obb.ratio), (27.0, Some(27.0), Some(1.0)));
        let of = |stage: &str| rows.iter().find(|row| row.stage == stage).expect("a row");
        assert_eq!((of("construct").ours_ms, of("construct").theirs_ms), (11.0, Some(22.0)));
        assert_eq!(of("construct").ratio, Some(0.5));
        assert_eq!((of("refit").ours_ms, of("refit").theirs_ms), (3.0, Some(1.73)));
    }

    #[test]
    fn another_size_is_not_like() {
        assert!(paper("flamenco").is_like() && Paper::new("soup", 9, String::new(), "fastest").is_like());
        assert!(!Paper::new("flamenco", 5_000, String::new(), "fastest").is_like());
    }

    #[test]
    fn a_scene_that_the_thesis_has_not_has_no_ratio() {
        let mean = Stages { construct: 8.0, ..Stages::default() };
        let rows = figure_612(&paper("soup"), 3, &[Built { volume: BoundingVolume::Aabb, mean }]);
        assert!(
            rows.iter().all(|row| row.theirs_ms.is_none() && row.ratio.is_none() && row.model.is_empty())
        );
    }
}
