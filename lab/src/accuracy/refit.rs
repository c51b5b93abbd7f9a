//! The cost of refitting in quality: candidates of a tree built at the first frame and refitted
//! since, compared with those of a tree rebuilt for each frame.

use crate::OneQuery;
use crate::tables::{Frames, Printed, digits};
use nearmiss::device::Device;
use nearmiss::error::Error;
use nearmiss::query::Query;
use nearmiss::research::{BoundingVolume, QueryExt};
use serde::Serialize;

/// A frame of an animation.
#[derive(Clone, Debug, Serialize)]
pub struct RefitRow {
    /// The scene.
    pub input: String,
    /// The volume.
    pub bv: &'static str,
    /// Frames since the tree was built.
    pub frame: usize,
    /// Triangle pairs that pass the refitted volumes.
    pub refitted_pairs: u64,
    /// Triangle pairs that pass rebuilt volumes.
    pub fresh_pairs: u64,
    /// Overlap tests of the refitted tree.
    pub refitted_tests: u64,
    /// Overlap tests of the rebuilt tree.
    pub fresh_tests: u64,
    /// Milliseconds of refit, traversal and narrow stage with the refitted tree.
    pub refitted_ms: f64,
    /// The same with the rebuilt tree.
    pub fresh_ms: f64,
    /// Milliseconds of the rebuild.
    pub build_ms: f64,
    /// Milliseconds of traversal that all frames since the build have lost without a rebuild. It is
    /// the refitted tree's additional tests, times the fresh tree's time per test. Test counts have
    /// no noise; times do.
    pub lost_ms: f64,
    /// Whether that exceeds the cost of a build: the best time to rebuild.
    pub rebuild: bool,
}

/// Runs every frame with the first frame's tree and with its own. After a frame with `rebuild` the
/// count restarts.
///
/// # Errors
/// Device errors.
pub fn refit(
    device: &Device,
    name: &str,
    frames: &Frames,
    volume: BoundingVolume,
) -> Result<Vec<RefitRow>, Error> {
    let bodies = frames.bodies(true)?;
    let query = Query::continuous().with_volume(volume);
    let mut old = OneQuery::new(device.clone(), vec![bodies[0].clone()], query)?;
    let mut fresh = OneQuery::new(device.clone(), vec![bodies[0].clone()], query)?;
    let (mut rows, mut since, mut lost) = (Vec::new(), 0, 0.0);
    for body in bodies {
        old.move_to(0, body.clone())?;
        fresh.move_to(0, body)?;
        fresh.rebuild()?;
        // The first run of a frame grows its lists; the second is measured.
        old.detect()?;
        fresh.detect()?;
        let (a, b) = (old.detect()?, fresh.detect()?);
        let (tests, fresh_tests) = (a.stats.overlap_tests(), b.stats.overlap_tests());
        let traverse = b.stats.stages.traverse + b.stats.stages.balance;
        lost += traverse * (tests as f64 / fresh_tests.max(1) as f64 - 1.0);
        let rebuild = lost > b.stats.stages.construct;
        rows.push(RefitRow {
            input: name.into(),
            bv: volume.name(),
            frame: since,
            refitted_pairs: a.stats.triangle_pairs,
            fresh_pairs: b.stats.triangle_pairs,
            refitted_tests: tests,
            fresh_tests,
            refitted_ms: a.stats.stages.total,
            fresh_ms: b.stats.stages.total,
            build_ms: b.stats.stages.construct,
            lost_ms: lost,
            rebuild,
        });
        since += 1;
        if rebuild {
            old.rebuild()?;
            (since, lost) = (0, 0.0);
        }
    }
    Ok(rows)
}

/// Returns the conclusion from the rows of one scene, as a sentence.
pub fn advice(rows: &[RefitRow]) -> String {
    let Some(last) = rows.last() else { return String::new() };
    let more = |row: &RefitRow| row.refitted_tests as f64 / row.fresh_tests.max(1) as f64;
    let most = rows.iter().map(more).fold(1.0, f64::max);
    let when = match rows.iter().find(|row| row.rebuild) {
        Some(row) => format!("a rebuild pays after {} frames", row.frame + 1),
        None => {
            format!("a rebuild ({} ms) does not pay within {} frames", digits(last.build_ms), rows.len())
        }
    };
    format!(
        "{} {}: refitted trees take up to {most:.2} times the tests of fresh ones; {when}.",
        last.input, last.bv
    )
}

impl Printed for RefitRow {
    const CAPTION: &'static str = "A refitted tree against a fresh one, frame by frame";
    const HEADS: &'static [&'static str] = &[
        "input", "volume", "frame", "pairs", "fresh", "tests", "fresh", "ms", "fresh", "build ms", "lost ms",
        "rebuild",
    ];
    fn row(&self) -> Vec<String> {
        vec![
            self.input.clone(),
            self.bv.into(),
            self.frame.to_string(),
            self.refitted_pairs.to_string(),
            self.fresh_pairs.to_string(),
            self.refitted_tests.to_string(),
            self.fresh_tests.to_string(),
            digits(self.refitted_ms),
            digits(self.fresh_ms),
            digits(self.build_ms),
            format!("{:.1}", self.lost_ms),
            if self.rebuild { "yes" } else { "" }.into(),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_advice_is_of_the_first_frame_that_pays() {
        let row = |frame, lost_ms, refitted_tests| RefitRow {
            input: "a scene".into(),
            bv: "aabb",
            frame,
            refitted_pairs: 1,
            fresh_pairs: 1,
            refitted_tests,
            fresh_tests: 100,
            refitted_ms: 1.0,
            fresh_ms: 1.0,
            build_ms: 5.0,
            lost_ms,
            rebuild: lost_ms > 5.0,
        };
        let rows = [row(0, 0.0, 100), row(1, 3.0, 130), row(2, 6.0, 180), row(0, 0.0, 100)];
        assert!(advice(&rows).contains("1.80 times") && advice(&rows).contains("after 3 frames"));
        assert!(advice(&rows[..2]).contains("does not pay within 2 frames"));
        assert!(advice(&[]).is_empty());
    }
}
