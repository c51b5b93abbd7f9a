//! A column of figure 6.13: the way to run a frame.

use nearmiss::query::{Continuous, Query};
use nearmiss::research::{
    BoundingVolume, BroadPhase, ContinuousSolver, FrontShape, Precision, QueryExt, Refit, Search, Traversal,
    WithSolver,
};

/// One way to run a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Way {
    /// Whether the query is continuous; else discrete.
    pub moves: bool,
    /// The volume.
    pub volume: BoundingVolume,
    /// Whether the walk starts from the last frame's front.
    pub front: bool,
}

impl Way {
    /// Without a front, and with one.
    pub const FRONTS: [bool; 2] = [false, true];

    /// Returns every way with these volumes, in the order of the thesis's columns: without the
    /// front first.
    pub fn every(volumes: &[BoundingVolume]) -> Vec<Way> {
        let mut ways = Vec::new();
        for front in Way::FRONTS {
            for moves in [false, true] {
                ways.extend(volumes.iter().map(|&volume| Way { moves, volume, front }));
            }
        }
        ways
    }

    /// Returns the query. A continuous one uses the thesis's own solver, the cubic. With `walk` it
    /// uses that walk and one launch per level, as in the thesis; otherwise the fastest. A front's
    /// own descents use native queues.
    pub fn query(self, walk: Option<Traversal>) -> Query {
        let refit = walk.map(|_| Refit::Levels);
        let traversal = if self.front { Some(Traversal::Front(FrontShape::native())) } else { walk };
        let search = Search {
            broad_phase: Some(BroadPhase::Tree),
            volume: Some(self.volume),
            refit,
            traversal,
            ..Search::default()
        };
        if self.moves {
            // The thesis does not test the start of a step either.
            let solver = ContinuousSolver::Cubic(Precision::F64);
            Continuous::by(solver).with_search(search).assuming_free(true).into()
        } else {
            Query::discrete().with_search(search)
        }
    }

    /// Returns `discrete` or `continuous`.
    pub fn asked(self) -> &'static str {
        if self.moves { "continuous" } else { "discrete" }
    }
}

impl std::fmt::Display for Way {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        write!(f, "{} {}", self.asked(), self.volume.name().to_uppercase())?;
        if self.front { write!(f, ", front") } else { Ok(()) }
    }
}
